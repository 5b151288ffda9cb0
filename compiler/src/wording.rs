//! The words of messages, and nothing else: each phase reports a problem as what it knows (`problem.rs` next to it), and here
//! it becomes a diagnostic, with its code, its sentences and the changes that put it right.

mod analyse;
pub(crate) mod conflict;
mod evaluate;
mod expand;
mod notes;
mod origins;
mod parse;
mod read;

use crate::ast::Limits;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Severity};
use crate::problem::MAX_PER_SOURCE;
use crate::source::Span;

/// What is said at the end about a source with more problems than are kept; how bad the worst of those is is known.
pub(crate) fn too_many(more: usize, worst: Severity, at: Span) -> Diagnostic {
    let message = format!("there are {more} more problems in this source");
    Diagnostic { severity: worst, ..Diagnostic::error(Code::TooManyProblems, at, message) }
        .primary(format!("kirk shows the first {MAX_PER_SOURCE} it finds"))
        .help("Put the first ones right and look again: later problems often follow from earlier ones.")
}

impl Limits {
    /// What the lower and the upper bound are called.
    fn words(self) -> [&'static str; 2] {
        match self {
            Limits::Duration => ["the lower bound", "the upper bound"],
            Limits::ObservationDelay => ["the shortest observation delay", "the longest observation delay"],
            Limits::Wait => ["the shortest wait", "the longest wait"],
        }
    }
}
