//! What a program does: calls, `sequence`, `parallel`, `with-temporal-constraint`, `delay`.

use super::amount::{amount, is_calculation, is_name, number};
use super::options::{flag, options};
use super::problem::Problem;
use super::{binding, ident, label, slips, team};
use crate::ast::{Argument, Body, Bounds, Call, Group, Limits, Role, Value, ValueKind, Wait, Within};
use crate::form::{Form, FormKind, text_of};
use crate::problem::Problems;
use crate::source::Span;
use crate::words::{Position, keywords};

/// Parses the forms of a body.
pub(super) fn bodies(forms: &[Form], problems: &mut Problems) -> Vec<Body> {
    let mut found = Vec::new();
    let mut rest = forms;
    while let Some((form, after)) = rest.split_first() {
        rest = after;
        match form.list().and_then(|items| items.split_first()) {
            Some((first, inside)) => found.extend(body(form, first, inside, problems)),
            None => rest = slips::body::no_body(form, rest, problems),
        }
    }
    found
}

/// Parses one body form; `None` if it makes no sense, which is reported.
fn body(form: &Form, first: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let known = first.word().filter(|word| Position::Body.has(word));
    match known.or_else(|| slips::body::misspelt(first, rest, problems)) {
        Some("sequence") => Some(Body::Sequence(group(form, first, rest, problems))),
        Some("parallel") => Some(Body::Parallel(group(form, first, rest, problems))),
        Some("with-temporal-constraint") => Some(within(form, first, rest, problems)),
        Some("delay") => delay(form, first, rest, problems),
        Some(word @ ("let" | "let*")) => binding::binding(form, first, rest, word == "let*", problems),
        Some("dotimes") => binding::dotimes(form, first, rest, problems),
        Some("label") => label::label(form, first, rest, problems),
        Some("between") => label::between(form, first, rest, problems),
        Some("with-agent") => team::with_agent(form, rest, problems),
        _ => call(form, first, rest, problems),
    }
}

#[inline(never)]
fn call(form: &Form, first: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    match ident(first).filter(|_| first.word() != Some("declare")) {
        Some(program) => {
            let arguments = arguments(rest, problems);
            Some(Body::Call(Call { program, arguments, span: form.span }))
        }
        None => {
            slips::body::no_call(form, first, rest, problems);
            None
        }
    }
}

/// The arguments of a call or of a label.
pub(super) fn arguments(forms: &[Form], problems: &mut Problems) -> Vec<Argument> {
    forms.iter().map(|form| argument(form, problems)).collect()
}

/// An argument: a number to calculate, or a value.
pub(super) fn argument(form: &Form, problems: &mut Problems) -> Argument {
    match form.is_error() || is_calculation(form) || slips::amount::is_clock(form) {
        true => Argument::Amount(amount(form, Role::Argument, problems)),
        false => Argument::Value(value(form)),
    }
}

/// A value as an argument or in a class.
pub(super) fn value(form: &Form) -> Value {
    let kind = match &form.kind {
        FormKind::Number(text) => {
            number(text, 1_000_000).map_or_else(|_| ValueKind::Other(text.clone()), ValueKind::Number)
        }
        FormKind::String(text) => ValueKind::Text(text.clone()),
        FormKind::Keyword(name) => ValueKind::Symbol(format!(":{name}")),
        FormKind::Symbol(symbol) => match symbol.name.as_str() {
            "t" => ValueKind::True,
            "nil" => ValueKind::Nil,
            _ => ValueKind::Name(symbol.package.clone(), symbol.name.clone()),
        },
        FormKind::Quote(inner) => match &inner.kind {
            FormKind::Symbol(symbol) => ValueKind::Symbol(symbol.name.clone()),
            _ => value(inner).kind,
        },
        FormKind::List(items) if items.is_empty() => ValueKind::Nil,
        _ => ValueKind::Other(text_of(form)),
    };
    Value { kind, span: form.span }
}

#[inline(never)]
fn group(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Group {
    let (slack, rest) = match rest.split_first() {
        Some((list, rest)) if is_option_list(list) || slips::body::is_option_list(list) => {
            let word = operator.word().unwrap_or_default();
            let [slack] = options(list.list().unwrap_or_default(), OPTIONS, word, problems);
            (slack.is_some_and(|form| flag(form, "slack", problems)), rest)
        }
        Some((first, _)) if first.keyword().is_some() => {
            (true, slips::body::bare_options(operator, rest, problems))
        }
        _ => (false, rest),
    };
    let body = bodies(rest, problems);
    Group { slack, body, operator: operator.span, span: form.span }
}

/// True for `()` and lists that begin with a keyword.
fn is_option_list(form: &Form) -> bool {
    form.list().is_some_and(|items| items.first().is_none_or(|first| first.keyword().is_some()))
}

#[inline(never)]
fn within(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Body {
    let (limits, rest) = match rest.split_first() {
        Some((constraint, body)) if is_constraint(constraint) && !body.is_empty() => {
            warn_of_no_bounds(constraint, problems);
            (bounds(constraint, problems), body)
        }
        _ => slips::body::within(operator, rest, problems),
    };
    let limits = limits.unwrap_or(Bounds { lower: None, upper: None, span: operator.span });
    let body = bodies(rest, problems);
    Body::WithTemporalConstraint(Within { bounds: limits, body, operator: operator.span, span: form.span })
}

/// True for `(simple-temporal ...)`.
pub(super) fn is_constraint(form: &Form) -> bool {
    form.call().is_some_and(|(word, _)| word == CONSTRAINT)
}

const CONSTRAINT: &str = "simple-temporal";

/// The keywords of a constraint.
pub(super) const LIMITS: [&str; 2] = keywords(CONSTRAINT);

/// The keywords in the options of a `sequence` or `parallel`.
const OPTIONS: [&str; 1] = keywords("sequence");

/// `(simple-temporal :lower-bound l :upper-bound u)`.
pub(super) fn bounds(form: &Form, problems: &mut Problems) -> Option<Bounds> {
    match form.call() {
        Some((CONSTRAINT, rest)) => Some(limits(rest, form.span, problems)),
        _ => {
            slips::body::no_constraint(form, problems);
            None
        }
    }
}

/// `:lower-bound l :upper-bound u`.
pub(super) fn limits(forms: &[Form], span: Span, problems: &mut Problems) -> Bounds {
    let given = options(forms, LIMITS, CONSTRAINT, problems);
    interval(given, Limits::Duration, span, problems)
}

/// The bounds that are given, as far as they are.
pub(super) fn interval(
    [lower, upper]: [Option<&Form>; 2],
    limits: Limits,
    span: Span,
    problems: &mut Problems,
) -> Bounds {
    let lower = lower.map(|form| amount(form, Role::Lower(limits), problems));
    let upper = upper.map(|form| amount(form, Role::Upper(limits), problems));
    Bounds { lower, upper, span }
}

/// Says that `(simple-temporal)` means nothing around a body.
fn warn_of_no_bounds(form: &Form, problems: &mut Problems) {
    if form.list().is_some_and(|items| items.len() == 1) {
        problems.push(Problem::NoBounds { constraint: form.span });
    }
}

#[inline(never)]
fn delay(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let (lower, upper) = match rest {
        [both] if is_amount(both) => (both, both),
        [lower, upper] if lower.keyword().is_none() => (lower, upper),
        _ => {
            slips::body::no_delay(form, operator, rest, problems);
            return None;
        }
    };
    let bounds = interval([Some(lower), Some(upper)], Limits::Wait, form.span, problems);
    Some(Body::Delay(Wait { bounds, span: form.span }))
}

/// True for what may stand for a number.
fn is_amount(form: &Form) -> bool {
    match &form.kind {
        FormKind::Number(_) | FormKind::Error => true,
        FormKind::Symbol(symbol) => is_name(symbol),
        _ => is_calculation(form),
    }
}
