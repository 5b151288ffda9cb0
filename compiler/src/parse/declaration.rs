//! `(declare (primitive) (duration ...) (requires ...) (effect ...))`.

use super::amount::amount;
use super::condition::condition;
use super::options::{flag, pairs};
use super::slips::{self, expected, twice};
use crate::ast::{Bounds, ControlProgram, DurationOf, Limits};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::Form;
use crate::problem::Problems;
use crate::words::keywords;

/// The keywords of `simple`.
pub(super) const BOUNDS: [&str; 4] = keywords("simple");

/// Those of `duration`.
pub(super) const CHOICE: [&str; 1] = keywords("duration");

/// Adds declarations, which stand in a `declare` or should, to the program.
pub(super) fn declare(declarations: &[Form], program: &mut ControlProgram, problems: &mut Problems) {
    let mut rest = declarations;
    while let Some((item, after)) = rest.split_first() {
        rest = after;
        match item.call() {
            Some(("primitive", extra)) => {
                program.primitive = true;
                if let Some(extra) = extra.first() {
                    problems.push(slips::declaration::primitive_with(extra));
                }
            }
            Some(("duration", inside)) => match &program.duration {
                Some(first) => {
                    let problem = twice("the duration", first.span, item.span);
                    problems.push(
                        problem.take_out("the first one", first.span).take_out("the second one", item.span),
                    );
                }
                None => {
                    program.duration = duration(item, inside, problems);
                    program.damaged |= program.duration.is_none();
                }
            },
            Some((word @ ("requires" | "effect"), conditions)) => {
                let slot = if word == "requires" { &mut program.requires } else { &mut program.effect };
                match conditions {
                    [one] if slot.is_none() => *slot = condition(one, problems),
                    [_] => problems.push(
                        Diagnostic::error(Code::KeywordTwice, item.span, format!("`{word}` is given twice"))
                            .primary("again here")
                            .help("Put the conditions into one: `(and ... ...)`."),
                    ),
                    _ => problems.push(expected(
                        item,
                        &format!("`{word}` takes one condition"),
                        "Several conditions are joined by `(and ... ...)`.",
                    )),
                }
            }
            // Lisp's way to say that a parameter is unused on purpose: nothing follows from it.
            Some(("ignore" | "ignorable", _)) => {}
            _ => rest = slips::declaration::no_declaration(item, rest, program, problems),
        }
    }
}

/// `(duration (simple :lower-bound l :upper-bound u) :contingent t)`.
fn duration(form: &Form, items: &[Form], problems: &mut Problems) -> Option<DurationOf> {
    if let Some((simple, rest)) = items.split_first()
        && let Some(("simple", inside)) = simple.call()
        && let (Some(bounds), Some([contingent])) = (pairs(inside, BOUNDS), pairs(rest, CHOICE))
    {
        return Some(Written { bounds, contingent }.duration(form, simple, problems));
    }
    slips::declaration::no_duration(form, items, problems)
}

/// The values given for a duration.
pub(super) struct Written<'a> {
    pub(super) bounds: [Option<&'a Form>; 4],
    pub(super) contingent: Option<&'a Form>,
}

impl Written<'_> {
    pub(super) fn duration(&self, form: &Form, simple: &Form, problems: &mut Problems) -> DurationOf {
        let [lower, upper, min, max] = self.bounds;
        let [shortest, longest] = Limits::Duration.words();
        let [soonest, latest] = Limits::ObservationDelay.words();
        let given = |form: Option<&Form>| form.is_some_and(|form| !form.is_error());
        let delay = (given(min) || given(max)).then(|| Bounds {
            lower: min.map(|form| amount(form, soonest, problems)),
            upper: max.map(|form| amount(form, latest, problems)),
            span: min.or(max).map_or(simple.span, |form| form.span),
        });
        let bounds = Bounds {
            lower: lower.map(|form| amount(form, shortest, problems)),
            upper: upper.map(|form| amount(form, longest, problems)),
            span: simple.span,
        };
        let contingent_nil = self.contingent.filter(|form| form.word() == Some("nil")).map(|nil| nil.span);
        let contingent = self.contingent.is_some_and(|form| flag(form, "contingent", problems));
        DurationOf { bounds, contingent, contingent_nil, delay, span: form.span }
    }
}
