//! Declarations without their `declare`, and what fell out of a duration or never was in one.

use super::{around, expected, head, one_of, text_of, twice, unexpected};
use crate::ast::{Amount, AmountKind, ControlProgram, DurationOf};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::parse::amount::is_calculation;
use crate::parse::declaration::{BOUNDS, CHOICE, Written};
use crate::parse::options::options;
use crate::problem::Problems;
use crate::source::Span;
use crate::words::{Position, usage};

const SHAPE: &str = usage("duration");

/// The keywords of `simple`, and the one that is often put there.
const ANYWHERE: [&str; 5] = [BOUNDS[0], BOUNDS[1], BOUNDS[2], BOUNDS[3], CHOICE[0]];

/// `(primitive t)`.
pub(in crate::parse) fn primitive_with(extra: &Form) -> Diagnostic {
    unexpected(extra, "`)`", "`(primitive)` stands alone; the duration is a declaration of its own.")
}

/// A duration when there is one already.
pub(in crate::parse) fn second_duration(first: Span, again: Span) -> Diagnostic {
    let problem = twice("the duration", first, again);
    problem.take_out("the first one", first).take_out("the second one", again)
}

/// What stands in a `requires` or an `effect` that is not the first or has not just one condition.
pub(in crate::parse) fn not_one_condition(item: &Form, conditions: &[Form]) -> Option<Diagnostic> {
    let (word, _) = item.call()?;
    Some(match conditions {
        [_] => Diagnostic::error(Code::KeywordTwice, item.span, format!("`{word}` is given twice"))
            .primary("again here")
            .help("Put the conditions into one: `(and ... ...)`."),
        _ => expected(
            item,
            &format!("`{word}` takes one condition"),
            "Several conditions are joined by `(and ... ...)`.",
        ),
    })
}

/// Reports what is no declaration; the forms after what belongs to it.
pub(in crate::parse) fn no_declaration<'a>(
    item: &Form,
    rest: &'a [Form],
    program: &mut ControlProgram,
    problems: &mut Problems,
) -> &'a [Form] {
    program.damaged = true;
    if let Some((word, _)) = item.call() {
        let message = format!("`{}` is not a declaration kirk knows", clip(word));
        problems.push(
            Diagnostic::error(Code::UnknownDeclaration, head(item), message)
                .primary("not understood here")
                .help(format!("The declarations are {}.", one_of(Position::Declaration.names())))
                .meant(head(item), nearest(word, Position::Declaration.names())),
        );
    } else if item.keyword().is_some() {
        return fallen_out(item, rest, program, problems);
    } else if !item.is_error() {
        let (help, bare) = match item.word().filter(|word| Position::Declaration.has(word)) {
            Some("primitive") | None => {
                ("A declaration is a list: `(primitive)`.".to_string(), item.word() == Some("primitive"))
            }
            Some(word) => (format!("A declaration is a list: `({word} ...)`."), false),
        };
        let problem = unexpected(item, "a declaration", &help);
        problems.push(match bare {
            true => problem.change(item.span, "(primitive)"),
            false => problem,
        });
    }
    rest
}

/// Reports declarations that stand where the body belongs.
pub(in crate::parse) fn bare(items: &[Form]) -> Diagnostic {
    expected(
        &items[0],
        "this declaration stands outside of `(declare ...)`",
        "Write `(declare (primitive) (duration (simple ...)))` after the parameter list.",
    )
    .suggest("Put `(declare ...)` around it", around(&items[0], &items[items.len() - 1], "(declare ", ")"))
}

/// True if what stands where the body belongs are declarations without their `declare`.
pub(in crate::parse) fn are_bare(items: &[Form], has_duration: bool) -> bool {
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

/// A keyword that stands outside of the duration, as a parenthesis before it closes too much; the forms after its value.
pub(in crate::parse) fn fallen_out<'a>(
    keyword: &Form,
    rest: &'a [Form],
    program: &mut ControlProgram,
    problems: &mut Problems,
) -> &'a [Form] {
    let value = rest.first().filter(|value| value.list().is_none());
    let after = &rest[usize::from(value.is_some())..];
    let word = keyword.keyword().unwrap_or_default();
    let Some(meant) = nearest(word, ANYWHERE) else {
        problems.push(unexpected(keyword, "a list", "Keywords stand inside of the form they belong to."));
        return after;
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
        problem = problem.label(last_byte(duration.span), "the duration already ends here");
        let home = if meant == "contingent" { duration.span } else { duration.bounds.span };
        if let Some(value) = value {
            problem = problem.suggest(format!("Move it into `{owner}`"), moved(meant, keyword, value, home));
        }
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
    after
}

/// The edits that move a keyword and its value to the end of another list.
fn moved(name: &str, keyword: &Form, value: &Form, list: Span) -> [Edit; 2] {
    [
        Edit::before(last_byte(list), format!(" :{name} {}", write(value))),
        Edit::replace(keyword.span.to(value.span), ""),
    ]
}

fn last_byte(span: Span) -> Span {
    Span { start: span.end - 1, ..span }
}

/// Reports what is wrong with a duration; what of it is clear.
pub(in crate::parse) fn no_duration(
    form: &Form,
    items: &[Form],
    problems: &mut Problems,
) -> Option<DurationOf> {
    let Some((simple, rest)) = items.split_first() else {
        problems.push(expected(form, "this duration is empty", SHAPE));
        return None;
    };
    let Some(("simple", bounds)) = simple.call() else {
        if !simple.is_error() {
            problems.push(no_simple(simple, rest, items));
        }
        return None;
    };
    let inside = options(bounds, ANYWHERE, "simple", problems);
    let is_bound = |form: &Form| form.keyword().is_some_and(|word| BOUNDS.contains(&word));
    let outside = match rest.iter().position(is_bound) {
        // Bounds after the `)` of `simple`: the first says it for all.
        Some(first) => {
            problems.push(closed_early(simple, rest, first));
            options(rest, ANYWHERE, "simple", problems)
        }
        None => {
            let [contingent] = options(rest, CHOICE, "duration", problems);
            [None, None, None, None, contingent]
        }
    };
    let [.., misplaced] = inside;
    let [.., contingent] = outside;
    if let (Some(value), None) = (misplaced.filter(|form| !form.is_error()), contingent) {
        problems.push(too_far_in(simple, bounds, value));
    }
    let bounds = std::array::from_fn(|slot| inside[slot].or(outside[slot]));
    Some(Written { bounds, contingent: contingent.or(misplaced) }.duration(form, simple, problems))
}

/// `:contingent t` inside of `simple`.
fn too_far_in(simple: &Form, inside: &[Form], value: &Form) -> Diagnostic {
    let keyword = inside.iter().take_while(|form| form.span != value.span).last().unwrap_or(value);
    let after = Edit::after(simple.span, format!(" :contingent {}", write(value)));
    Diagnostic::error(
        Code::WrongShape,
        keyword.span.to(value.span),
        "`:contingent` belongs to `duration`, not to `simple`",
    )
    .primary("a parenthesis too far in")
    .help("Write `(duration (simple ...) :contingent t)`.")
    .suggest("Move it out of `simple`", [Edit::replace(keyword.span.to(value.span), ""), after])
}

/// A bound behind the `)` of `simple`.
fn closed_early(simple: &Form, rest: &[Form], first: usize) -> Diagnostic {
    let word = rest[first].keyword().unwrap_or_default();
    let message = format!("`:{word}` belongs to `simple`, which is closed before it");
    let problem = Diagnostic::error(Code::WrongShape, rest[first].span, message)
        .primary("a parenthesis too far out")
        .label(last_byte(simple.span), "`simple` already ends here")
        .help("Write `(duration (simple :lower-bound 15 :upper-bound 20) :contingent t)`.");
    let is_bound = |pair: &&[Form]| {
        matches!(pair, [keyword, value] if keyword.keyword().is_some_and(|word| BOUNDS.contains(&word))
            && value.keyword().is_none_or(|word| word == "infinity"))
    };
    let count = rest.chunks(2).take_while(is_bound).count() * 2;
    let Some(last) = count.checked_sub(1).map(|last| &rest[last]) else { return problem };
    problem.suggest(
        "Close `simple` after it",
        [Edit::replace(last_byte(simple.span), ""), Edit::after(last.span, ")")],
    )
}

/// What stands in the place of `(simple ...)`.
fn no_simple(simple: &Form, rest: &[Form], items: &[Form]) -> Diagnostic {
    // Without its parentheses, it is as clear what is meant.
    if simple.call().is_none() && (simple.word() == Some("simple") || simple.keyword().is_some()) {
        return unwrapped(simple, rest, items);
    }
    let number = |form: &Form| matches!(form.kind, FormKind::Number(_)).then(|| write(form));
    let given = simple.list().filter(|_| rest.is_empty()).unwrap_or(items);
    let numbers: Vec<String> = given.iter().map_while(number).collect();
    let near = simple.call().and_then(|(word, _)| nearest(word, ["simple"]));
    let problem = unexpected(simple, "`(simple ...)`", SHAPE).meant(head(simple), near);
    let (Some(lower), None) = (numbers.first(), simple.call()) else { return problem };
    let upper = numbers.get(1).unwrap_or(lower);
    let written = format!("(simple :lower-bound {lower} :upper-bound {upper})");
    let problem = problem.help(format!("Write `(duration {})`.", clip(&written)));
    match (simple.list(), numbers.len()) {
        (Some(_), 1 | 2) => problem.change(simple.span, written),
        (None, count @ (1 | 2)) => problem.change(simple.span.to(items[count - 1].span), written),
        _ => problem,
    }
}

/// `(duration simple :lower-bound 1 ...)` or `(duration :lower-bound 1 ...)`.
fn unwrapped(simple: &Form, rest: &[Form], items: &[Form]) -> Diagnostic {
    let bounds: Vec<String> = rest.iter().map(text_of).collect();
    let first = if simple.keyword().is_some() { text_of(simple) + " " } else { String::new() };
    let problem = Diagnostic::error(
        Code::WrongShape,
        simple.span,
        "the bounds of a duration stand in a form of their own",
    )
    .primary("`(simple` was expected here, and a `)` after the bounds")
    .help(format!(
        "Write `(duration (simple {first}{}))`; `:contingent t` comes after that form.",
        clip(&bounds.join(" "))
    ));
    let (opening, given) = match simple.keyword() {
        Some(_) => ("(simple ", items),
        None => ("(", rest),
    };
    let is_bound = |pair: &&[Form]| pair[0].keyword().is_some_and(|word| word != "contingent");
    let count = given.chunks(2).take_while(is_bound).map(<[Form]>::len).sum::<usize>();
    match count.checked_sub(1) {
        Some(last) => {
            problem.suggest("Put the bounds into `(simple ...)`", around(simple, &given[last], opening, ")"))
        }
        None => problem,
    }
}
