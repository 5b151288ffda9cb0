//! Pages.

use super::Page;

pub(super) const UNCLOSED_FORM: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const STRAY_CLOSE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNCLOSED_STRING: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNCLOSED_COMMENT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const TOO_DEEP: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_TEXT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNREADABLE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NOT_RMPL: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const EMPTY_SOURCE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const STRAY_TEXT: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const TOO_MANY_PROBLEMS: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const TOO_LONG: Page = Page { meaning: "", wrong: "", right: "" };
