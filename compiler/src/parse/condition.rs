//! Conditions and effects: `(and ...)`, `(at :start ...)`, `(= (accessor object) value)`.

use super::body::value;
use super::ident;
use crate::ast::{Condition, SlotOf};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::Form;
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::words::usage;

/// Parses a condition; `None` if it makes no sense, which is reported.
pub(super) fn condition(form: &Form, problems: &mut Problems) -> Option<Condition> {
    if form.is_error() {
        return None;
    }
    let bad = |problems: &mut Problems, at: &Form, message: String| {
        problems.push(
            Diagnostic::error(Code::BadCondition, at.span, message)
                .primary("a condition was expected")
                .help(usage("=")),
        );
    };
    let Some((word, rest)) = form.call() else {
        bad(problems, form, format!("{} is not a condition", form.describe()));
        return None;
    };
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
                    problems.push(wrong_time(word, when));
                    return None;
                }
            }
        }
        ("=" | "eq" | "eql" | "equal", [slot, right]) => match slot_of(slot) {
            Some(slot) => Condition::Equal(slot, value(right)),
            None => {
                bad(problems, slot, format!("the left side of `{word}` is not a slot of an object"));
                return None;
            }
        },
        ("not" | "at" | "over" | "=", _) => {
            bad(problems, form, format!("`{word}` has the wrong number of parts"));
            return None;
        }
        _ => match slot_of(form) {
            Some(slot) => Condition::Holds(slot),
            None => {
                bad(problems, form, format!("{} is not a condition", form.describe()));
                return None;
            }
        },
    })
}

/// Neither `at :start`, `at :end` nor `over :all`. Not inlined: conditions nest, and the stack is small.
#[inline(never)]
fn wrong_time(word: &str, when: &Form) -> Diagnostic {
    let known: &[&str] = if word == "at" { &["start", "end"] } else { &["all"] };
    let wanted = if word == "at" { "`:start` or `:end`" } else { "`:all`" };
    let near = match (word, when.keyword().unwrap_or_default()) {
        ("at", "begin" | "beginning") => Some("start"),
        ("at", "finish" | "stop") => Some("end"),
        (_, written) => nearest(written, known.iter().copied()),
    };
    let help = known.iter().map(|time| format!("`({word} :{time} ...)`")).collect::<Vec<_>>().join(" or ");
    Diagnostic::error(Code::BadCondition, when.span, format!("`{word}` needs {wanted}"))
        .primary("found this")
        .help(format!("Write {help}."))
        .meant(when.span, near.map(|near| format!(":{near}")))
}

/// `(accessor object)`.
fn slot_of(form: &Form) -> Option<SlotOf> {
    match form.list()? {
        [accessor, object] => Some(SlotOf { accessor: ident(accessor)?, object: value(object) }),
        _ => None,
    }
}
