//! `let` and `dotimes` with a pair of parentheses too few, or with something missing.

use crate::ast::{Argument, Ident};
use crate::form::{Form, FormKind};
use crate::parse::binding::one;
use crate::parse::body::{argument, bodies};
use crate::parse::ident;
use crate::parse::problem::{BindingSlip, Expected, Missing, Problem};
use crate::problem::Problems;

/// Names with their values, and the forms of the body.
type Bindings<'a> = (Vec<(Ident, Argument)>, &'a [Form]);

/// Reports what is wrong with the names of a `let`; what of them is clear, and the body.
pub(in crate::parse) fn no_names<'a>(
    operator: &Form,
    rest: &'a [Form],
    problems: &mut Problems,
) -> Option<Bindings<'a>> {
    let Some((names, body)) = rest.split_first() else {
        problems.push(Problem::Missing { at: operator.span, what: Missing::PartsOfLet });
        return None;
    };
    Some(match names.list() {
        Some([first, ..]) if first.symbol().is_some() => (bare_pair(names, problems), body),
        Some(pairs) => {
            let mut pair = |pair: &Form| {
                let found = pair.list().filter(|pair| pair.len() == 2).and_then(|_| one(pair, problems));
                if found.is_none() {
                    if !pair.is_error() {
                        problems.push(Problem::Unexpected { found: pair, expected: Expected::Binding });
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
    let known = <&[Form; 2]>::try_from(pair).ok().zip(ident(&pair[0]));
    let both = known.as_ref().map(|([name, value], _)| name.span.to(value.span));
    problems.push(Problem::Binding(BindingSlip::BarePair { name: pair[0].span, both }));
    problems.lose(names);
    known.into_iter().map(|([_, value], name)| (name, argument(value, problems))).collect()
}

/// `(let x 5 ...)`: the value belongs to the same slip; the forms after it.
fn bare_name<'a>(names: &Form, body: &'a [Form], problems: &mut Problems) -> &'a [Form] {
    problems.lose(names);
    let value = body.split_first().filter(|(value, _)| names.symbol().is_some() && value.list().is_none());
    if !names.is_error() {
        let both = value.map(|(value, _)| names.span.to(value.span));
        problems.push(Problem::Binding(BindingSlip::NoNames { found: names, both }));
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
        problems.push(Problem::Missing { at: operator.span, what: Missing::PartsOfDotimes });
        return;
    };
    problems.lose(head);
    let mut counted = 0;
    match head.list() {
        Some([count, variable]) => {
            let swapped = matches!(count.kind, FormKind::Number(_)) && variable.symbol().is_some();
            let swapped = swapped.then_some([count.span, variable.span]);
            problems.push(Problem::Binding(BindingSlip::CountFirst { head, swapped }));
        }
        _ if head.is_error() => {}
        _ => {
            // In `(dotimes i 3 ...)` the number belongs to the same slip.
            let count = body.first().filter(|count| head.symbol().is_some() && count.list().is_none());
            counted = usize::from(count.is_some());
            let both = count.map(|count| head.span.to(count.span));
            problems.push(Problem::Binding(BindingSlip::NoCount { head, both }));
        }
    }
    // What is wrong with the shape of the body is worth saying all the same.
    bodies(&body[counted..], problems);
}
