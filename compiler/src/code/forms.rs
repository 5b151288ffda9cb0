//! Pages.

use super::Page;

pub(super) const UNKNOWN_TOP_LEVEL: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_OPERATOR: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_KEYWORD: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_DECLARATION: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const WRONG_SHAPE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const KEYWORD_TWICE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const PRIMITIVE_WITH_BODY: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NO_BODY: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const DURATION_OF_BODY: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_YET: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_SLOT_OPTION: Page = Page { meaning: "", wrong: "", right: "" };
