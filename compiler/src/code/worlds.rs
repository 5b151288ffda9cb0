//! Pages.

use super::Page;

pub(super) const UNKNOWN_PACKAGE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const PACKAGE_NOT_CHOSEN: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_CLASS: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_ACCESSOR: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const WRONG_TYPE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const BAD_CONDITION: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_PLANNED_WITH: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_TYPE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_CONTROLLABLE: Page = Page { meaning: "", wrong: "", right: "" };
