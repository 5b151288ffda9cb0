//! `(declare (primitive) (duration ...) (requires ...) (effect ...))`.

use super::body::interval;
use super::condition::condition;
use super::options::{flag, pairs};
use super::problem::{Expected, Problem, Twice};
use super::slips;
use super::team;
use crate::ast::{Condition, ControlProgram, DurationOf, Limits};
use crate::form::Form;
use crate::problem::Problems;
use crate::words::keywords;

/// The keywords of `simple`.
pub(super) const BOUNDS: [&str; 4] = keywords("simple");

/// Those of `duration`.
pub(super) const CHOICE: [&str; 2] = keywords("duration");

/// Adds declarations, which stand in a `declare` or should, to the program.
pub(super) fn declare(declarations: &[Form], program: &mut ControlProgram, problems: &mut Problems) {
    let mut rest = declarations;
    while let Some((item, after)) = rest.split_first() {
        rest = after;
        match item.call() {
            Some(("primitive", inside)) => {
                program.primitive = true;
                let extra = |found| Problem::Unexpected { found, expected: Expected::EndOfPrimitive };
                problems.extend(inside.first().map(extra));
            }
            Some(("duration", inside)) => match &program.duration {
                Some(DurationOf { span: first, .. }) => {
                    let (first, again) = (*first, item.span);
                    let whole = Some([first, again]);
                    problems.push(Problem::Twice { what: Twice::Duration, first, again, whole });
                }
                None => {
                    program.duration = duration(item, inside, problems);
                    program.damaged |= program.duration.is_none();
                }
            },
            Some(("agent", inside)) => team::agent(item, inside, &mut program.agent, problems),
            Some(("requires", inside)) => only(&mut program.requires, item, inside, problems),
            Some(("effect", inside)) => only(&mut program.effect, item, inside, problems),
            // Lisp's way to say that a parameter is unused on purpose: nothing follows from it.
            Some(("ignore" | "ignorable", _)) => {}
            _ => rest = slips::declaration::no_declaration(item, rest, program, problems),
        }
    }
}

/// The one condition of `requires` or of `effect`, if there is none yet.
fn only(known: &mut Option<Condition>, item: &Form, inside: &[Form], problems: &mut Problems) {
    match inside {
        [one] if known.is_none() => *known = condition(one, problems),
        _ => problems.extend(slips::declaration::not_one_condition(item, inside)),
    }
}

/// `(duration (simple :lower-bound l :upper-bound u) :contingent t)`.
fn duration(form: &Form, inside: &[Form], problems: &mut Problems) -> Option<DurationOf> {
    if let Some((simple, choice)) = inside.split_first()
        && let Some(("simple", bounds)) = simple.call()
        && let (Some(bounds), Some(choice)) = (pairs(bounds, BOUNDS), pairs(choice, CHOICE))
    {
        return Some(Written { bounds, choice }.duration(form, simple, problems));
    }
    slips::declaration::no_duration(form, inside, problems)
}

/// The values given for a duration.
pub(super) struct Written<'a> {
    pub(super) bounds: [Option<&'a Form>; 4],
    pub(super) choice: [Option<&'a Form>; 2],
}

impl Written<'_> {
    pub(super) fn duration(&self, form: &Form, simple: &Form, problems: &mut Problems) -> DurationOf {
        let [lower, upper, min, max] = self.bounds;
        let is_delayed = [min, max].into_iter().flatten().any(|form| !form.is_error());
        let delayed = min.or(max).map_or(simple.span, |form| form.span);
        let [contingent, observer] = self.choice;
        DurationOf {
            delay: is_delayed.then(|| interval([min, max], Limits::ObservationDelay, delayed, problems)),
            bounds: interval([lower, upper], Limits::Duration, simple.span, problems),
            contingent_nil: contingent.filter(|form| form.word() == Some("nil")).map(|nil| nil.span),
            contingent: contingent.is_some_and(|form| flag(form, CHOICE[0], problems)),
            observed_by: observer.and_then(|form| team::observer(form, problems)),
            span: form.span,
        }
    }
}
