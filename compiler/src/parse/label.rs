//! Names for occurrences, and constraints between them: `(label x form)`, `(between (end x) (start y) ...)`.

use super::body::{arguments, bodies, bounds};
use super::{ident, slips};
use crate::ast::{Argument, Between, Body, EventOf, Ident, Labelled};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip};
use crate::problem::Problems;

/// Parses `label`.
#[inline(never)]
pub(super) fn label(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let Some((head, body)) = rest.split_first() else {
        problems.push(slips::label::no_name(operator));
        return None;
    };
    if body.is_empty() {
        problems.lose(head);
        problems.push(slips::label::nothing_named(operator));
    }
    let body = bodies(body, problems);
    let Some((name, arguments)) = name(head, problems) else {
        slips::label::bad_name(head, problems);
        return None;
    };
    if name.name.contains('#') {
        problems.push(reserved(&name));
    }
    let arguments = arguments.unwrap_or_default();
    Some(Body::Label(Labelled { name, arguments, body, operator: operator.span, span: form.span }))
}

/// A label that looks like the name of an occurrence.
fn reserved(name: &Ident) -> Diagnostic {
    let plain = name.name.replace('#', "-");
    Diagnostic::error(
        Code::ReservedName,
        name.span,
        format!("a label cannot be called `{}`", clip(&name.name)),
    )
    .primary("`#` numbers occurrences: `a#2` is the second of `a`")
    .help(format!("Give it another name, such as `{}`, here and wherever it is used.", clip(&plain)))
    .change(name.span, plain)
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
        problems.push(only_order(limits));
    }
    let (from, to, bounds) = (from?, to?, bounds?);
    let between = Between { from, to, bounds, operator: operator.span, span: form.span };
    Some(Body::Between(Box::new(between)))
}

/// Says what `(simple-temporal)` means between two events.
fn only_order(limits: &Form) -> Diagnostic {
    let end = crate::source::Span { start: limits.span.end - 1, ..limits.span };
    Diagnostic::warning(
        Code::NoBounds,
        limits.span,
        "this constraint says only that the first event comes first",
    )
    .primary("neither a lower nor an upper bound: the lower one is 0")
    .help("If that is what is meant, `(simple-temporal :lower-bound 0)` says so.")
    .suggest("Write `:lower-bound 0`", [Edit::before(end, " :lower-bound 0")])
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
