//! Conditions and effects: `(and ...)`, `(at :start ...)`, `(= (accessor object) value)`.

use super::body::value;
use super::ident;
use super::problem::{ConditionSlip, Problem};
use crate::ast::{Condition, SlotOf};
use crate::form::Form;
use crate::nearest::nearest;
use crate::problem::Problems;

/// Parses a condition; `None` if it makes no sense, which is reported.
pub(super) fn condition(form: &Form, problems: &mut Problems) -> Option<Condition> {
    if form.is_error() {
        return None;
    }
    let bad = |problems: &mut Problems, at: &Form, slip: ConditionSlip| {
        problems.push(Problem::Condition { at: at.span, slip });
        None
    };
    let Some((word, rest)) = form.call() else { return bad(problems, form, ConditionSlip::No(form)) };
    Some(match (word, rest) {
        ("and", parts) => Condition::And(parts.iter().filter_map(|part| condition(part, problems)).collect()),
        ("or", parts) => Condition::Or(parts.iter().filter_map(|part| condition(part, problems)).collect()),
        ("not", [part]) => Condition::Not(Box::new(condition(part, problems)?)),
        ("at" | "over", [when, part]) => {
            let part = condition(part, problems);
            match (word, when.keyword()) {
                ("at", Some("start")) => Condition::AtStart(Box::new(part?)),
                ("at", Some("end")) => Condition::AtEnd(Box::new(part?)),
                ("over", Some("all")) => Condition::OverAll(Box::new(part?)),
                _ => {
                    let near = meant_time(word, when);
                    return bad(problems, when, ConditionSlip::Time { word, near });
                }
            }
        }
        ("=" | "eq" | "eql" | "equal", [slot, right]) => match slot_of(slot) {
            Some(slot) => Condition::Equal(slot, value(right)),
            None => return bad(problems, slot, ConditionSlip::NoSlot(word)),
        },
        ("not" | "at" | "over" | "=", _) => return bad(problems, form, ConditionSlip::Parts(word)),
        _ => match slot_of(form) {
            Some(slot) => Condition::Holds(slot),
            None => return bad(problems, form, ConditionSlip::No(form)),
        },
    })
}

/// What is meant where neither `at :start`, `at :end` nor `over :all` is written. Not inlined: conditions nest, and the stack is
/// small.
#[inline(never)]
fn meant_time(word: &str, when: &Form) -> Option<&'static str> {
    match (word, when.keyword().unwrap_or_default()) {
        ("at", "begin" | "beginning") => Some("start"),
        ("at", "finish" | "stop") => Some("end"),
        ("at", written) => nearest(written, ["start", "end"]),
        (_, written) => nearest(written, ["all"]),
    }
}

/// `(accessor object)`.
fn slot_of(form: &Form) -> Option<SlotOf> {
    match form.list()? {
        [accessor, object] => Some(SlotOf { accessor: ident(accessor)?, object: value(object) }),
        _ => None,
    }
}
