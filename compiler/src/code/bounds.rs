//! Pages.

use super::Page;

pub(super) const NOT_A_NUMBER: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NEGATIVE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const LOWER_ABOVE_UPPER: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_EXACT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const TOO_LARGE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const DELAY_NOT_CONTINGENT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const DELAY_REVERSED: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const CONTINGENT_UNBOUNDED: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const INFINITE_LOWER: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_UNIT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NO_BOUNDS: Page = Page { meaning: "", wrong: "", right: "" };
