//! `(declare (primitive) (duration ...) (requires ...) (effect ...))`.

use super::amount::amount;
use super::condition::condition;
use super::options::{flag, options};
use super::{expected, one_of, twice, unexpected};
use crate::ast::{Bounds, ControlProgram, DurationOf};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, clip};
use crate::nearest::did_you_mean;
use crate::problem::Problems;

pub(super) const DECLARATIONS: [&str; 4] = ["primitive", "duration", "requires", "effect"];
const SHAPE: &str = "A duration is `(duration (simple :lower-bound 15 :upper-bound 20))`, with `:contingent t` at its end if Nature decides.";

/// Adds the declarations of one `declare` form to the program.
pub(super) fn declare(form: &Form, program: &mut ControlProgram, problems: &mut Problems) {
    for item in form.list().unwrap_or_default().iter().skip(1) {
        let Some((word, rest)) = item.call() else {
            if !item.is_error() {
                problems.push(unexpected(item, "a declaration", "A declaration is a list: `(primitive)`."));
            }
            program.damaged = true;
            continue;
        };
        match word {
            "primitive" => {
                if let Some(extra) = rest.first() {
                    problems.push(unexpected(
                        extra,
                        "`)`",
                        "`(primitive)` stands alone; the duration is a declaration of its own.",
                    ));
                }
                program.primitive = true;
            }
            "duration" => {
                if let Some(first) = &program.duration {
                    problems.push(twice("the duration", first.span, item.span));
                } else {
                    program.duration = duration(item, rest, problems);
                    program.damaged |= program.duration.is_none();
                }
            }
            "requires" | "effect" => {
                let slot = if word == "requires" { &mut program.requires } else { &mut program.effect };
                match rest {
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
            "ignore" | "ignorable" => {}
            _ => {
                program.damaged = true;
                let at = item.list().and_then(|items| items.first()).map_or(item.span, |first| first.span);
                problems.push(
                    Diagnostic::error(
                        Code::UnknownDeclaration,
                        at,
                        format!("`{}` is not a declaration kirk knows", clip(word)),
                    )
                    .primary("not understood here")
                    .help(format!("The declarations are {}.", one_of(&DECLARATIONS)))
                    .maybe_help(did_you_mean(word, DECLARATIONS)),
                );
            }
        }
    }
}

fn duration(form: &Form, rest: &[Form], problems: &mut Problems) -> Option<DurationOf> {
    let Some((simple, rest)) = rest.split_first() else {
        problems.push(expected(form, "this duration is empty", SHAPE));
        return None;
    };
    let Some(("simple", inside)) = simple.call() else {
        if !simple.is_error() {
            let near = simple.call().and_then(|(word, _)| did_you_mean(word, ["simple"]));
            problems.push(unexpected(simple, "`(simple ...)`", SHAPE).maybe_help(near));
        }
        return None;
    };
    const BOUNDS: [&str; 5] =
        ["lower-bound", "upper-bound", "min-observation-delay", "max-observation-delay", "contingent"];
    let [lower, upper, min, max, misplaced] = options(inside, BOUNDS, "simple", problems);
    let [contingent] = options(rest, ["contingent"], "duration", problems);
    if let (Some(misplaced), None) = (misplaced.filter(|form| !form.is_error()), contingent) {
        problems.push(
            Diagnostic::error(
                Code::WrongShape,
                misplaced.span,
                "`:contingent` belongs to `duration`, not to `simple`",
            )
            .primary("a parenthesis too far in")
            .help("Write `(duration (simple ...) :contingent t)`."),
        );
    }
    let given = |form: Option<&Form>| form.is_some_and(|form| !form.is_error());
    let delay = (given(min) || given(max)).then(|| Bounds {
        lower: min.map(|form| amount(form, "the shortest observation delay", problems)),
        upper: max.map(|form| amount(form, "the longest observation delay", problems)),
        span: min.or(max).map_or(simple.span, |form| form.span),
    });
    let bounds = Bounds {
        lower: lower.map(|form| amount(form, "the lower bound", problems)),
        upper: upper.map(|form| amount(form, "the upper bound", problems)),
        span: simple.span,
    };
    let contingent = contingent.or(misplaced).is_some_and(|form| flag(form, "contingent", problems));
    Some(DurationOf { bounds, contingent, delay, span: form.span })
}
