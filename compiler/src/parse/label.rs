//! Names for occurrences, and constraints between them: `(label x form)`, `(between (end x) (start y) ...)`.

use super::body::{arguments, bodies, bounds, unwrapped, warn_of_no_bounds};
use super::{ident, unexpected};
use crate::ast::{Argument, Between, Body, EventOf, Ident, Labelled};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;

/// Parses `label`.
#[inline(never)]
pub(super) fn label(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    const SHAPE: &str = "Write `(label first (drive))`, or `(label (drive i) (drive))` to tell the repetitions of a `dotimes` apart.";
    let Some((head, body)) = rest.split_first() else {
        let problem = Diagnostic::error(Code::WrongShape, operator.span, "this label has no name");
        problems.push(problem.primary("in this form").help(SHAPE));
        return None;
    };
    if body.is_empty() {
        problems.lose(head);
        problems.push(
            Diagnostic::error(Code::WrongShape, operator.span, "this label names nothing")
                .primary("a body form was expected after the name")
                .help(SHAPE),
        );
    }
    let body = bodies(body, problems);
    let Some((name, arguments)) = name(head, problems) else {
        if !head.is_error() {
            problems.push(unexpected(head, "the name of the label", SHAPE));
        }
        return None;
    };
    if name.name.contains('#') {
        let plain = name.name.replace('#', "-");
        problems.push(
            Diagnostic::error(
                Code::ReservedName,
                name.span,
                format!("a label cannot be called `{}`", clip(&name.name)),
            )
            .primary("`#` numbers occurrences: `a#2` is the second of `a`")
            .help(format!("Give it another name, such as `{}`, here and wherever it is used.", clip(&plain))),
        );
    }
    let arguments = arguments.unwrap_or_default();
    Some(Body::Label(Labelled { name, arguments, body, operator: operator.span, span: form.span }))
}

/// Parses `between`.
#[inline(never)]
pub(super) fn between(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    const SHAPE: &str = "Write `(between (end a) (start b) (simple-temporal :lower-bound 5 :upper-bound 10))`: b starts 5 to 10 s after a ends.";
    let (from, to, limits) = match rest {
        [from, to, limits] => (from, to, limits),
        [_, _] | [_] | [] => {
            let missing = match rest.len() {
                2 => "a `between` without a constraint",
                1 => "a `between` with one event",
                _ => "this `between` is empty",
            };
            let problem = Diagnostic::error(Code::WrongShape, operator.span, missing);
            problems.push(problem.primary("two events and a constraint were expected").help(SHAPE));
            return None;
        }
        [_, _, first, ..] if first.keyword().is_some() => {
            problems.push(unwrapped(first, &rest[2..]));
            return None;
        }
        [_, _, _, extra, ..] => {
            problems.push(unexpected(extra, "`)`", SHAPE));
            return None;
        }
    };
    let from = event(from, problems);
    let to = event(to, problems);
    let limits =
        bounds(limits, "simple-temporal", problems).inspect(|_| warn_of_no_bounds(limits, SHAPE, problems));
    let (from, to, bounds) = (from?, to?, limits?);
    let between = Between { from, to, bounds, operator: operator.span, span: form.span };
    Some(Body::Between(Box::new(between)))
}

/// `(start x)`, `(end (confirm i j))`.
fn event(form: &Form, problems: &mut Problems) -> Option<EventOf> {
    const SHAPE: &str =
        "An event is `(start x)` or `(end x)`, where `x` is a label or the name of a program.";
    if form.is_error() {
        return None;
    }
    let problem = match form.list() {
        Some([first, what]) if matches!(first.word(), Some("start" | "end")) => match name(what, problems) {
            Some((name, arguments)) => {
                return Some(EventOf { end: first.word() == Some("end"), name, arguments, span: form.span });
            }
            None if what.is_error() => return None,
            None => unexpected(what, "a label or the name of a program", SHAPE),
        },
        Some([first, what, ..]) if matches!(first.word(), Some("start" | "end")) => {
            let word = first.word().unwrap_or_default();
            let problem = unexpected(form, "an event", SHAPE);
            match what.symbol() {
                Some(symbol) => problem.help(format!(
                    "The name and its arguments stand in a list of their own: `({word} ({} ...))`.",
                    clip(&symbol.name)
                )),
                None => problem,
            }
        }
        Some([first]) if matches!(first.word(), Some("start" | "end")) => {
            let word = first.word().unwrap_or_default();
            Diagnostic::error(Code::WrongShape, form.span, format!("the `{word}` of what?"))
                .primary("a label or the name of a program is missing")
                .help(SHAPE)
        }
        Some([first, ..]) if first.word().is_some() => {
            let word = first.word().unwrap_or_default();
            let meant = match word {
                "begin" | "begins" | "from" | "starts" => Some("start"),
                "finish" | "stop" | "ends" | "until" => Some("end"),
                _ => nearest(word, ["start", "end"]),
            };
            Diagnostic::error(Code::WrongShape, first.span, format!("`{}` is not an event", clip(word)))
                .primary("`start` or `end` was expected")
                .help(SHAPE)
                .meant(first.span, meant)
        }
        _ => {
            let problem = unexpected(form, "an event", SHAPE);
            match form.symbol() {
                // `drive:end`, as events are named elsewhere.
                Some(symbol)
                    if matches!(symbol.name.as_str(), "start" | "end") && symbol.package.is_some() =>
                {
                    let name = clip(symbol.package.as_deref().unwrap_or_default());
                    problem
                        .help(format!("Inside a program, the event is written `({} {name})`.", symbol.name))
                }
                Some(symbol) => {
                    let name = clip(&symbol.name);
                    problem.help(format!("Say which end of it is meant: `(start {name})` or `(end {name})`."))
                }
                None => problem,
            }
        }
    };
    problems.push(problem);
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
