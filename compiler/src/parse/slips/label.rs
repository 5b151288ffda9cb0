//! Labels without a name, and events as they are named elsewhere.

use super::body::unwrapped;
use super::{around, bare, unexpected};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, clip, write};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::words::usage;

const LABEL: &str = usage("label");
const BETWEEN: &str = usage("between");
const EVENT: &str = usage("start");

/// A `label` with nothing in it.
pub(in crate::parse) fn no_name(operator: &Form) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, operator.span, "this label has no name")
        .primary("in this form")
        .help(LABEL)
}

/// A `label` with nothing after the name.
pub(in crate::parse) fn nothing_named(operator: &Form) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, operator.span, "this label names nothing")
        .primary("a body form was expected after the name")
        .help(LABEL)
}

/// Reports what is no name.
pub(in crate::parse) fn bad_name(head: &Form, problems: &mut Problems) {
    if head.is_error() {
        return;
    }
    let problem = unexpected(head, "the name of the label", LABEL);
    problems.push(match bare(head) {
        Some(edit) => problem.suggest("Write the plain name", [edit]),
        None => problem,
    });
}

/// A `between` that has not two events and a constraint.
pub(in crate::parse) fn no_between(operator: &Form, rest: &[Form]) -> Diagnostic {
    let missing = |message: &str| {
        Diagnostic::error(Code::WrongShape, operator.span, message)
            .primary("two events and a constraint were expected")
            .help(BETWEEN)
    };
    match rest {
        [] => missing("this `between` is empty"),
        [_] => missing("a `between` with one event"),
        [_, _] => missing("a `between` without a constraint"),
        [_, _, given @ ..] if given[0].keyword().is_some() => unwrapped(given),
        [_, _, _, extra @ ..] => unexpected(extra.first().unwrap_or(operator), "`)`", BETWEEN),
    }
}

/// Reports what is no event.
pub(in crate::parse) fn no_event(form: &Form, problems: &mut Problems) {
    let problem = match form.list() {
        _ if form.is_error() => return,
        Some([first, what @ ..]) if matches!(first.word(), Some("start" | "end")) => {
            match of_what(form, first, what) {
                Some(problem) => problem,
                None => return,
            }
        }
        Some([first, ..]) if first.word().is_some() => no_side(first),
        _ => no_list(form),
    };
    problems.push(problem);
}

/// `(start)`, `(end 5)`, `(end a 1)`; `None` if that has been reported.
fn of_what(form: &Form, first: &Form, what: &[Form]) -> Option<Diagnostic> {
    let word = first.word().unwrap_or_default();
    Some(match what {
        [] => Diagnostic::error(Code::WrongShape, form.span, format!("the `{word}` of what?"))
            .primary("a label or the name of a program is missing")
            .help(EVENT),
        [what] if what.is_error() => return None,
        [what] => {
            let problem = unexpected(what, "a label or the name of a program", EVENT);
            match bare(what) {
                Some(edit) => problem.suggest("Write the plain name", [edit]),
                None => problem,
            }
        }
        [what, .., last] => {
            let problem = unexpected(form, "an event", EVENT);
            match what.symbol() {
                Some(symbol) => problem
                    .help(format!(
                        "The name and its arguments stand in a list of their own: `({word} ({} ...))`.",
                        clip(&symbol.name)
                    ))
                    .suggest("Put them into a list", around(what, last, "(", ")")),
                None => problem,
            }
        }
    })
}

/// `(begin a)`.
fn no_side(first: &Form) -> Diagnostic {
    let word = first.word().unwrap_or_default();
    let meant = match word {
        "begin" | "begins" | "from" | "starts" => Some("start"),
        "finish" | "stop" | "ends" | "until" => Some("end"),
        _ => nearest(word, ["start", "end"]),
    };
    Diagnostic::error(Code::WrongShape, first.span, format!("`{}` is not an event", clip(word)))
        .primary("`start` or `end` was expected")
        .help(EVENT)
        .meant(first.span, meant)
}

/// A name alone.
fn no_list(form: &Form) -> Diagnostic {
    let problem = unexpected(form, "an event", EVENT);
    let Some(symbol) = form.symbol() else { return problem };
    let side = symbol.name.as_str();
    match &symbol.package {
        // `drive:end`, as events are named elsewhere.
        Some(name) if matches!(side, "start" | "end") => problem
            .help(format!("Inside a program, the event is written `({side} {})`.", clip(name)))
            .change(form.span, format!("({side} {name})")),
        _ => {
            let name = clip(&symbol.name);
            let written = write(form);
            let split = symbol.name.split_once('-').filter(|_| symbol.package.is_none());
            if let Some((side @ ("start" | "end"), of)) = split {
                return problem
                    .help(format!("The event is written `({side} {})`.", clip(of)))
                    .change(form.span, format!("({side} {of})"));
            }
            problem
                .help(format!("Say which end of it is meant: `(start {name})` or `(end {name})`."))
                .change(form.span, format!("(start {written})"))
                .change(form.span, format!("(end {written})"))
        }
    }
}
