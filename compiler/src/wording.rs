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
pub(crate) mod repair;
mod team;
mod written;

use crate::ast::{Limits, Role};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Severity};
use crate::source::Span;

/// What is said at the end about a source with more problems than are kept; `worst` is how bad the worst of those is.
pub(crate) fn too_many(more: usize, most: usize, worst: Severity, at: Span) -> Diagnostic {
    let message = format!("there are {more} more problems in this source");
    Diagnostic { severity: worst, ..Diagnostic::error(Code::TooManyProblems, at, message) }
        .primary(format!("kirk shows the first {most} it finds"))
        .help("Put the first ones right and look again: later problems often follow from earlier ones.")
}

impl Limits {
    /// What the lower and the upper bound are called.
    fn words(self) -> [&'static str; 2] {
        match self {
            Limits::Duration => ["the lower bound", "the upper bound"],
            Limits::ObservationDelay => ["the shortest observation delay", "the longest observation delay"],
            Limits::Wait => ["the shortest wait", "the longest wait"],
            Limits::Message => ["the shortest delay of a message", "the longest delay of a message"],
        }
    }
}

impl Role {
    /// What such a number is called in a sentence.
    fn words(self) -> &'static str {
        match self {
            Role::Lower(limits) => limits.words()[0],
            Role::Upper(limits) => limits.words()[1],
            Role::Count => "the number of repetitions",
            Role::Named => "this value",
            Role::Operand => "part of a calculation",
            Role::Argument => "this argument",
        }
    }
}
