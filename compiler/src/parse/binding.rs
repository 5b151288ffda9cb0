//! Names for values and repetitions: `(let ((x 5)) body...)`, `(dotimes (i 3) body...)`.

use std::collections::BTreeMap;

use super::amount::amount;
use super::body::{argument, bodies};
use super::problem::{Missing, Named, Problem};
use super::{ident, slips};
use crate::ast::{Argument, Body, Dotimes, Ident, Let, Role};
use crate::form::Form;
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
    let (bindings, body) = match rest.split_first() {
        Some((names, body)) if names.list().is_some_and(|pairs| pairs.iter().all(is_pair)) => {
            let pairs = names.list().unwrap_or_default();
            (pairs.iter().filter_map(|pair| one(pair, problems)).collect(), body)
        }
        _ => slips::binding::no_names(operator, rest, problems)?,
    };
    if !sequential {
        names_twice(&bindings, problems);
    }
    if body.is_empty() {
        problems.push(Problem::Missing { at: operator.span, what: Missing::BodyOfLet });
    }
    let body = bodies(body, problems);
    Some(Body::Let(Let { bindings, sequential, body, operator: operator.span, span: form.span }))
}

/// True for `(name value)`.
fn is_pair(form: &Form) -> bool {
    form.list().is_some_and(|pair| matches!(pair, [name, _] if name.symbol().is_some()))
}

/// A name and its value.
pub(super) fn one(pair: &Form, problems: &mut Problems) -> Option<(Ident, Argument)> {
    match pair.list() {
        Some([name, value]) => Some((ident(name)?, argument(value, problems))),
        _ => None,
    }
}

fn names_twice(bindings: &[(Ident, Argument)], problems: &mut Problems) {
    let mut firsts: BTreeMap<&str, Span> = BTreeMap::new();
    for (name, _) in bindings {
        if let Some(first) = firsts.insert(&name.name, name.span) {
            let (what, again) = (Named::Variable, name.span);
            problems.push(Problem::Repeated { what, name: &name.name, first, again });
        }
    }
}

/// Parses `dotimes`.
#[inline(never)]
pub(super) fn dotimes(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let (variable, count, body) = match rest {
        [head, body @ ..] if is_pair(head) => {
            let [variable, count] = head.list()? else { return None };
            (ident(variable)?, count, body)
        }
        _ => {
            slips::binding::no_count(operator, rest, problems);
            return None;
        }
    };
    let count = amount(count, Role::Count, problems);
    if body.is_empty() {
        problems.push(Problem::Missing { at: operator.span, what: Missing::BodyOfDotimes });
    }
    let body = bodies(body, problems);
    Some(Body::Dotimes(Dotimes { variable, count, body, operator: operator.span, span: form.span }))
}
