//! Pages.

use super::Page;

pub(super) const UNKNOWN_PROGRAM: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const DEFINED_TWICE: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const RECURSION: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const WRONG_ARGUMENTS: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NO_ENTRY: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const NEVER_USED: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const UNKNOWN_NAME: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const STARTS_AT_DELAYED_END: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const TOO_MANY_EPISODES: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const CALLS_TOO_DEEP: Page = Page { meaning: "", wrong: "", right: "" };
pub(super) const FREE_PARAMETERS: Page = Page { meaning: "", wrong: "", right: "" };
