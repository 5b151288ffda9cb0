//! `(declare (primitive) (duration ...) (requires ...) (effect ...))`.

use super::amount::{amount, is_calculation};
use super::condition::condition;
use super::options::{flag, options};
use super::{expected, head, one_of, text_of, twice, unexpected};
use crate::ast::{Amount, AmountKind, Bounds, ControlProgram, DurationOf};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::source::Span;

pub(super) const DECLARATIONS: [&str; 4] = ["primitive", "duration", "requires", "effect"];
const SHAPE: &str = "A duration is `(duration (simple :lower-bound 15 :upper-bound 20))`, with `:contingent t` at its end if Nature decides.";

const BOUNDS: [&str; 5] =
    ["lower-bound", "upper-bound", "min-observation-delay", "max-observation-delay", "contingent"];

/// Adds declarations, which stand in a `declare` or should, to the program.
pub(super) fn declare(declarations: &[Form], program: &mut ControlProgram, problems: &mut Problems) {
    let mut items = declarations.iter();
    while let Some(item) = items.next() {
        let Some((word, rest)) = item.call() else {
            if item.keyword().is_some() {
                let value = items.as_slice().first().filter(|value| value.list().is_none());
                items = items.as_slice()[usize::from(value.is_some())..].iter();
                fallen_out(item, value, program, problems);
            } else if !item.is_error() {
                let help = match item.word().filter(|word| DECLARATIONS.contains(word)) {
                    Some(word) => format!(
                        "A declaration is a list: `({word}{})`.",
                        if word == "primitive" { "" } else { " ..." }
                    ),
                    None => "A declaration is a list: `(primitive)`.".to_string(),
                };
                problems.push(unexpected(item, "a declaration", &help));
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
                let at = head(item);
                problems.push(
                    Diagnostic::error(
                        Code::UnknownDeclaration,
                        at,
                        format!("`{}` is not a declaration kirk knows", clip(word)),
                    )
                    .primary("not understood here")
                    .help(format!("The declarations are {}.", one_of(&DECLARATIONS)))
                    .meant(at, nearest(word, DECLARATIONS)),
                );
            }
        }
    }
}

/// True if what stands where the body belongs are declarations without their `declare`.
pub(super) fn are_bare(items: &[Form], has_duration: bool) -> bool {
    // A call has no such lists for arguments; `(primitive)` alone may call a program of that name.
    let certain = |item: &Form| match item.call() {
        Some(("duration", [simple, ..])) => simple.call().is_some_and(|(word, _)| word == "simple"),
        Some(("requires" | "effect", [one])) => one.list().is_some() && !is_calculation(one),
        _ => false,
    };
    let is_primitive = |item: &Form| matches!(item.call(), Some(("primitive", [])));
    let any = has_duration && !items.is_empty() || items.iter().any(certain);
    any && items.iter().all(|item| certain(item) || is_primitive(item))
}

/// A keyword and its value that stand outside of the duration: a parenthesis before them closes too much.
pub(super) fn fallen_out(
    keyword: &Form,
    value: Option<&Form>,
    program: &mut ControlProgram,
    problems: &mut Problems,
) {
    let word = keyword.keyword().unwrap_or_default();
    let Some(meant) = nearest(word, BOUNDS) else {
        problems.push(unexpected(keyword, "a list", "Keywords stand inside of the form they belong to."));
        return;
    };
    let (owner, help) = match meant {
        "contingent" => ("duration", "Write `(duration (simple ...) :contingent t)`.".to_string()),
        _ => ("simple", format!("Write `(duration (simple ... :{meant} 5))`.")),
    };
    let message = format!("`:{meant}` belongs to `{owner}`, which is closed before it");
    let mut problem = Diagnostic::error(Code::WrongShape, keyword.span, message)
        .primary("a parenthesis too far out")
        .help(help);
    if let Some(duration) = &mut program.duration {
        let end = Span { start: duration.span.end - 1, ..duration.span };
        problem = problem.label(end, "the duration already ends here");
        let unknown = || Some(Amount { kind: AmountKind::Error, span: keyword.span });
        match meant {
            "contingent" => {
                duration.contingent_nil =
                    value.filter(|value| value.word() == Some("nil")).map(|nil| nil.span);
                duration.contingent = duration.contingent_nil.is_none();
            }
            "upper-bound" => duration.bounds.upper = duration.bounds.upper.take().or_else(unknown),
            _ => {}
        }
    }
    problems.push(problem);
}

fn duration(form: &Form, items: &[Form], problems: &mut Problems) -> Option<DurationOf> {
    let number = |form: &Form| matches!(form.kind, FormKind::Number(_)).then(|| text_of(form));
    let Some((simple, mut rest)) = items.split_first() else {
        problems.push(expected(form, "this duration is empty", SHAPE));
        return None;
    };
    let inside = match simple.call() {
        Some(("simple", inside)) => inside,
        // Without its parentheses, it is as clear what is meant.
        None if simple.word() == Some("simple") || simple.keyword().is_some() => {
            let bounds: Vec<String> = rest.iter().map(text_of).collect();
            let first = if simple.keyword().is_some() { text_of(simple) + " " } else { String::new() };
            problems.push(
                Diagnostic::error(
                    Code::WrongShape,
                    simple.span,
                    "the bounds of a duration stand in a form of their own",
                )
                .primary("`(simple` was expected here, and a `)` after the bounds")
                .help(format!(
                    "Write `(duration (simple {first}{}))`; `:contingent t` comes after that form.",
                    clip(&bounds.join(" "))
                )),
            );
            return None;
        }
        _ => {
            if !simple.is_error() {
                let given = simple.list().filter(|_| rest.is_empty()).unwrap_or(items);
                let numbers: Vec<String> = given.iter().map_while(number).collect();
                let help = match (simple.call(), numbers.as_slice()) {
                    (Some(_), _) => None,
                    (None, [both]) => {
                        Some(format!("Write `(duration (simple :lower-bound {both} :upper-bound {both}))`."))
                    }
                    (None, [lower, upper, ..]) => Some(format!(
                        "Write `(duration (simple :lower-bound {lower} :upper-bound {upper}))`."
                    )),
                    (None, []) => None,
                };
                let near = simple.call().and_then(|(word, _)| nearest(word, ["simple"]));
                problems.push(
                    unexpected(simple, "`(simple ...)`", SHAPE).maybe_help(help).meant(head(simple), near),
                );
            }
            return None;
        }
    };
    let [mut lower, mut upper, mut min, mut max, misplaced] = options(inside, BOUNDS, "simple", problems);
    // Bounds after the `)` of `simple`: the first says it for all.
    let early = rest.iter().position(|form| form.keyword().is_some_and(|word| BOUNDS[..4].contains(&word)));
    let mut contingent = None;
    if let Some(first) = early {
        let word = rest[first].keyword().unwrap_or_default();
        let message = format!("`:{word}` belongs to `simple`, which is closed before it");
        problems.push(
            Diagnostic::error(Code::WrongShape, rest[first].span, message)
                .primary("a parenthesis too far out")
                .label(Span { start: simple.span.end - 1, ..simple.span }, "`simple` already ends here")
                .help("Write `(duration (simple :lower-bound 15 :upper-bound 20) :contingent t)`."),
        );
        let [low, high, least, most, rests] = options(rest, BOUNDS, "simple", problems);
        (lower, upper, min, max) = (lower.or(low), upper.or(high), min.or(least), max.or(most));
        contingent = rests;
        rest = &[];
    }
    let [given] = options(rest, ["contingent"], "duration", problems);
    let contingent = contingent.or(given);
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
    let contingent = contingent.or(misplaced);
    let contingent_nil = contingent.filter(|form| form.word() == Some("nil")).map(|nil| nil.span);
    let contingent = contingent.is_some_and(|form| flag(form, "contingent", problems));
    Some(DurationOf { bounds, contingent, contingent_nil, delay, span: form.span })
}
