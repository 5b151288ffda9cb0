//! Names for occurrences, and constraints between them: `(label x form)`, `(between (end x) (start y) ...)`.

use super::body::{arguments, bodies, bounds};
use super::problem::{Missing, Named, Problem};
use super::{ident, slips};
use crate::ast::{Argument, Between, Body, EventOf, Ident, Labelled};
use crate::form::{Form, FormKind};
use crate::problem::Problems;

/// Parses `label`.
#[inline(never)]
pub(super) fn label(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let Some((head, body)) = rest.split_first() else {
        problems.push(Problem::Missing { at: operator.span, what: Missing::LabelName });
        return None;
    };
    if body.is_empty() {
        problems.lose(head);
        problems.push(Problem::Missing { at: operator.span, what: Missing::Labelled });
    }
    let body = bodies(body, problems);
    let Some((name, arguments)) = name(head, problems) else {
        slips::label::bad_name(head, problems);
        return None;
    };
    if name.name.contains('#') {
        problems.push(Problem::Reserved { what: Named::Label, name: &name.name, at: name.span });
    }
    let arguments = arguments.unwrap_or_default();
    Some(Body::Label(Labelled { name, arguments, body, operator: operator.span, span: form.span }))
}

/// Parses `between`.
#[inline(never)]
pub(super) fn between(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let [from, to, limits] = rest else {
        problems.push(slips::label::no_between(operator, rest));
        return None;
    };
    if limits.keyword().is_some() {
        problems.push(slips::label::no_between(operator, rest));
        return None;
    }
    let from = event(from, problems);
    let to = event(to, problems);
    let bounds = bounds(limits, problems);
    if limits.list().is_some_and(|items| items.len() == 1) && bounds.is_some() {
        problems.push(Problem::OnlyOrder { constraint: limits.span });
    }
    let (from, to, bounds) = (from?, to?, bounds?);
    let between = Between { from, to, bounds, operator: operator.span, span: form.span };
    Some(Body::Between(Box::new(between)))
}

/// `(start x)`, `(end (confirm i j))`.
fn event(form: &Form, problems: &mut Problems) -> Option<EventOf> {
    if let Some([first, what]) = form.list()
        && let Some(word @ ("start" | "end")) = first.word()
        && let Some((name, arguments)) = name(what, problems)
    {
        return Some(EventOf { end: word == "end", name, arguments, span: form.span });
    }
    slips::label::no_event(form, problems);
    None
}

/// `x` or `(x i j)`.
fn name(form: &Form, problems: &mut Problems) -> Option<(Ident, Option<Vec<Argument>>)> {
    match &form.kind {
        FormKind::List(items) => {
            let (name, rest) = items.split_first()?;
            Some((ident(name)?, Some(arguments(rest, problems))))
        }
        _ => Some((ident(form).filter(|name| !matches!(name.name.as_str(), "t" | "nil"))?, None)),
    }
}
