//! `let` and `dotimes` with a pair of parentheses too few, or with something missing.

use super::{around, unexpected};
use crate::ast::{Argument, Ident};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind};
use crate::parse::binding::one;
use crate::parse::body::{argument, bodies};
use crate::parse::ident;
use crate::problem::Problems;
use crate::words::usage;

const LET: &str = usage("let");
const DOTIMES: &str = usage("dotimes");

/// Names with their values, and the forms of the body.
type Bindings<'a> = (Vec<(Ident, Argument)>, &'a [Form]);

/// Reports what is wrong with the names of a `let`; what of them is clear, and the body.
pub(in crate::parse) fn no_names<'a>(
    operator: &Form,
    rest: &'a [Form],
    problems: &mut Problems,
) -> Option<Bindings<'a>> {
    let Some((names, body)) = rest.split_first() else {
        problems.push(empty_let(operator, "this `let` is empty"));
        return None;
    };
    Some(match names.list() {
        Some([first, ..]) if first.symbol().is_some() => (bare_pair(names, problems), body),
        Some(pairs) => {
            let mut pair = |pair: &Form| {
                let found = pair.list().filter(|pair| pair.len() == 2).and_then(|_| one(pair, problems));
                if found.is_none() {
                    if !pair.is_error() {
                        problems.push(unexpected(pair, "`(name value)`", LET));
                    }
                    problems.lose(pair);
                }
                found
            };
            (pairs.iter().filter_map(&mut pair).collect(), body)
        }
        None if names.word() == Some("nil") => (Vec::new(), body),
        None => (Vec::new(), bare_name(names, body, problems)),
    })
}

/// `(let (x 5) ...)`: the usual slip, and what it means is clear.
fn bare_pair(names: &Form, problems: &mut Problems) -> Vec<(Ident, Argument)> {
    let pair = names.list().unwrap_or_default();
    let message = "every name of a `let` stands in a list of its own";
    let problem = Diagnostic::error(Code::WrongShape, pair[0].span, message)
        .primary("parentheses are missing around this name and its value")
        .help(LET);
    let Some(([name, value], name_of)) = <&[Form; 2]>::try_from(pair).ok().zip(ident(&pair[0])) else {
        problems.push(problem);
        problems.lose(names);
        return Vec::new();
    };
    problems.push(problem.suggest("Put parentheses around them", around(name, value, "(", ")")));
    problems.lose(names);
    vec![(name_of, argument(value, problems))]
}

/// `(let x 5 ...)`: the value belongs to the same slip; the forms after it.
fn bare_name<'a>(names: &Form, body: &'a [Form], problems: &mut Problems) -> &'a [Form] {
    problems.lose(names);
    let value = body.split_first().filter(|(value, _)| names.symbol().is_some() && value.list().is_none());
    if !names.is_error() {
        let problem = unexpected(names, "a list of names and values", LET);
        problems.push(match value {
            Some((value, _)) => {
                problem.suggest("Put parentheses around them", around(names, value, "((", "))"))
            }
            None => problem,
        });
    }
    match value {
        Some((value, after)) => {
            problems.lose(value);
            after
        }
        None => body,
    }
}

/// Reports what is wrong with the variable and the number of a `dotimes`, and with its body.
pub(in crate::parse) fn no_count(operator: &Form, rest: &[Form], problems: &mut Problems) {
    let Some((head, body)) = rest.split_first() else {
        problems.push(empty_dotimes(operator, "this `dotimes` is empty"));
        return;
    };
    problems.lose(head);
    let mut counted = 0;
    match head.list() {
        Some([count, variable]) => {
            let problem = unexpected(head, "a name before the number of repetitions", DOTIMES);
            let swapped = matches!(count.kind, FormKind::Number(_)) && variable.symbol().is_some();
            let edits = [Edit::copy(count.span, variable.span), Edit::copy(variable.span, count.span)];
            problems.push(match swapped {
                true => problem.suggest("Put the name first", edits),
                false => problem,
            });
        }
        _ if head.is_error() => {}
        _ => {
            let problem = unexpected(head, "`(name count)`", DOTIMES);
            // In `(dotimes i 3 ...)` the number belongs to the same slip.
            let count = body.first().filter(|count| head.symbol().is_some() && count.list().is_none());
            counted = usize::from(count.is_some());
            problems.push(match count {
                Some(count) => problem.suggest("Put parentheses around them", around(head, count, "(", ")")),
                None => problem,
            });
        }
    }
    // What is wrong with the shape of the body is worth saying all the same.
    bodies(&body[counted..], problems);
}

/// A `let` in which something is missing.
pub(in crate::parse) fn empty_let(operator: &Form, message: &str) -> Diagnostic {
    empty(operator, message, LET)
}

/// A `dotimes` in which something is missing.
pub(in crate::parse) fn empty_dotimes(operator: &Form, message: &str) -> Diagnostic {
    empty(operator, message, DOTIMES)
}

fn empty(operator: &Form, message: &str, shape: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, operator.span, message).primary("in this form").help(shape)
}
