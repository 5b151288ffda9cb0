//! Names for values and repetitions: `(let ((x 5)) body...)`, `(dotimes (i 3) body...)`.

use std::collections::BTreeMap;

use super::amount::amount;
use super::body::{argument, bodies};
use super::{ident, unexpected};
use crate::ast::{Argument, Body, Dotimes, Ident, Let};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, clip};
use crate::problem::Problems;
use crate::source::Span;

/// Parses `let` and `let*`.
#[inline(never)]
pub(super) fn binding(
    form: &Form,
    operator: &Form,
    rest: &[Form],
    sequential: bool,
    problems: &mut Problems,
) -> Option<Body> {
    const SHAPE: &str = "Write `(let ((x 5) (y (minutes 2))) body...)`.";
    let Some((names, mut body)) = rest.split_first() else {
        problems.push(empty(operator, "this `let` is empty", SHAPE));
        return None;
    };
    let mut bindings: Vec<(Ident, Argument)> = Vec::new();
    let pairs = names.list().unwrap_or_default();
    if let Some(first) = pairs.first().filter(|first| first.symbol().is_some()) {
        // `(let (x 5) ...)`: the usual slip, and what it means is clear.
        let message = "every name of a `let` stands in a list of its own";
        problems.push(
            Diagnostic::error(Code::WrongShape, first.span, message)
                .primary("parentheses are missing around this name and its value")
                .help(SHAPE),
        );
        problems.lose(names);
        if let [name, value] = pairs {
            bindings.extend(ident(name).map(|name| (name, argument(value, problems))));
        }
    } else if names.list().is_none() && names.word() != Some("nil") {
        problems.lose(names);
        if !names.is_error() {
            problems.push(unexpected(names, "a list of names and values", SHAPE));
        }
        // `(let x 5 ...)`: the value belongs to the same slip.
        if let Some((value, after)) =
            body.split_first().filter(|(value, _)| names.symbol().is_some() && value.list().is_none())
        {
            problems.lose(value);
            body = after;
        }
    } else {
        for pair in pairs {
            bindings.extend(one(pair, SHAPE, problems));
        }
    }
    let mut firsts: BTreeMap<&str, Span> = BTreeMap::new();
    for (name, _) in &bindings {
        let first = firsts.insert(&name.name, name.span);
        if let Some(first) = first.filter(|_| !sequential) {
            let message = format!("`{}` is given two values", clip(&name.name));
            problems.push(
                Diagnostic::error(Code::DefinedTwice, name.span, message)
                    .primary("again here")
                    .label(first, "first here"),
            );
        }
    }
    if body.is_empty() {
        problems.push(empty(operator, "this `let` has no body", SHAPE));
    }
    let body = bodies(body, problems);
    Some(Body::Let(Let { bindings, sequential, body, operator: operator.span, span: form.span }))
}

/// Parses `dotimes`.
#[inline(never)]
pub(super) fn dotimes(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    const SHAPE: &str =
        "Write `(dotimes (i 3) body...)`: the body three times, with `i` standing for 0, 1 and 2.";
    let Some((head, body)) = rest.split_first() else {
        problems.push(empty(operator, "this `dotimes` is empty", SHAPE));
        return None;
    };
    let (variable, count) = match head.list() {
        Some([variable, count]) => (ident(variable), count),
        _ => {
            if !head.is_error() {
                problems.push(unexpected(head, "`(name count)`", SHAPE));
            }
            problems.lose(head);
            // What is wrong with the shape of the body is worth saying all the same; in `(dotimes i 3 ...)` it comes after.
            let count = usize::from(
                head.symbol().is_some() && body.first().is_some_and(|count| count.list().is_none()),
            );
            bodies(&body[count..], problems);
            return None;
        }
    };
    let Some(variable) = variable else {
        problems.lose(head);
        problems.push(unexpected(head, "a name before the number of repetitions", SHAPE));
        bodies(body, problems);
        return None;
    };
    let count = amount(count, "the number of repetitions", problems);
    if body.is_empty() {
        problems.push(empty(operator, "this `dotimes` has nothing to repeat", SHAPE));
    }
    let body = bodies(body, problems);
    Some(Body::Dotimes(Dotimes { variable, count, body, operator: operator.span, span: form.span }))
}

fn one(pair: &Form, shape: &str, problems: &mut Problems) -> Option<(Ident, Argument)> {
    match pair.list() {
        Some([name, value]) if name.symbol().is_some() => Some((ident(name)?, argument(value, problems))),
        _ => {
            if !pair.is_error() {
                problems.push(unexpected(pair, "`(name value)`", shape));
            }
            problems.lose(pair);
            None
        }
    }
}

fn empty(operator: &Form, message: &str, shape: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, operator.span, message).primary("in this form").help(shape)
}
