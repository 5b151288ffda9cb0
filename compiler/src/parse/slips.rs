//! Slips: what people write in the place of the right shape. What is wrong with it is told, with the way out, and what
//! was meant is guessed as far as that is clear, so that one slip costs one message.
//!
//! A form of the right shape never comes here: the grammar is in `parse/`, and this could be left out of it.

pub(super) mod amount;
pub(super) mod binding;
pub(super) mod body;
pub(super) mod declaration;
pub(super) mod definition;
pub(super) mod elsewhere;
pub(super) mod label;
pub(super) mod options;

use std::fmt::Display;

use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::source::Span;

/// Something is missing in a form.
pub(super) fn expected(form: &Form, message: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, head(form), message).primary("in this form").help(help)
}

/// Something is not what belongs here.
pub(super) fn unexpected(form: &Form, wanted: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, form.span, format!("{wanted} was expected, not {}", form.describe()))
        .primary("found this")
        .help(help)
}

/// A thing is said a second time.
pub(super) fn twice(what: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(Code::KeywordTwice, again, format!("{what} is given twice"))
        .primary("again here")
        .label(first, "first here")
        .help("Keep one of them.")
}

/// The place of the first element of a list, which says what the list is.
pub(super) fn head(form: &Form) -> Span {
    form.list().and_then(|items| items.first()).map_or(form.span, |first| first.span)
}

/// `a`, `b` and `c`.
pub(super) fn one_of(words: impl IntoIterator<Item = impl Display>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// The form on one line, for a message.
pub(super) fn text_of(form: &Form) -> String {
    clip(&write(form))
}

/// Edits that put text around what stands from one form to another.
fn around(first: &Form, last: &Form, before: &str, after: &str) -> [Edit; 2] {
    [Edit::before(first.span, before), Edit::after(last.span, after)]
}

/// The edit that takes a quotation mark or a `'` off a name.
fn bare(form: &Form) -> Option<Edit> {
    match &form.kind {
        FormKind::Quote(inner) => Some(Edit::replace(Span { end: inner.span.start, ..form.span }, "")),
        FormKind::String(text) if is_plain_name(text) => Some(Edit::replace(form.span, text)),
        _ => None,
    }
}

/// True if the text would be read as one name.
fn is_plain_name(text: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "-+*/<>=.!?%&$_~^@".contains(c);
    text.starts_with(char::is_alphabetic) && text.chars().all(plain)
}
