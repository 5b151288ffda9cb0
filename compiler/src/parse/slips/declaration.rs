//! Declarations without their `declare`, and what fell out of a duration or never was in one.

use crate::ast::{Amount, AmountKind, ControlProgram, DurationOf};
use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::parse::amount::is_calculation;
use crate::parse::declaration::{BOUNDS, CHOICE, Written};
use crate::parse::options::options;
use crate::parse::problem::{DeclarationSlip, Expected, Missing, Problem};
use crate::problem::Problems;
use crate::words::Position;

/// The keywords of `simple`, and the one that is often put there.
const ANYWHERE: [&str; 5] = [BOUNDS[0], BOUNDS[1], BOUNDS[2], BOUNDS[3], CHOICE[0]];

/// What stands in a `requires` or an `effect` that is not the first or has not just one condition.
pub(in crate::parse) fn not_one_condition<'a>(item: &'a Form, conditions: &[Form]) -> Option<Problem<'a>> {
    let (word, _) = item.call()?;
    Some(Problem::Declaration(match conditions {
        [_] => DeclarationSlip::SecondConditions { at: item.span, word },
        _ => DeclarationSlip::Conditions { at: item.head(), word },
    }))
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
        let near = nearest(word, Position::Declaration.names());
        problems.push(Problem::Declaration(DeclarationSlip::Unknown { at: item.head(), word, near }));
    } else if item.keyword().is_some() {
        return fallen_out(item, rest, program, problems);
    } else if !item.is_error() {
        let word = item.word().filter(|word| Position::Declaration.has(word));
        problems.push(Problem::Declaration(DeclarationSlip::NoList { found: item, word }));
    }
    rest
}

/// Reports declarations that stand where the body belongs.
pub(in crate::parse) fn bare(items: &[Form]) -> Problem<'_> {
    let (first, last) = (&items[0], &items[items.len() - 1]);
    Problem::Declaration(DeclarationSlip::Bare { first: first.head(), all: first.span.to(last.span) })
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
        problems.push(Problem::Unexpected { found: keyword, expected: Expected::List });
        return after;
    };
    let mut from = None;
    if let Some(duration) = &mut program.duration {
        let home = if meant == "contingent" { duration.span } else { duration.bounds.span };
        from = Some((duration.span, home));
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
    let slip = DeclarationSlip::FallenOut { keyword: keyword.span, meant, value, from };
    problems.push(Problem::Declaration(slip));
    after
}

/// Reports what is wrong with a duration; what of it is clear.
pub(in crate::parse) fn no_duration(
    form: &Form,
    items: &[Form],
    problems: &mut Problems,
) -> Option<DurationOf> {
    let Some((simple, rest)) = items.split_first() else {
        problems.push(Problem::Missing { at: form.head(), what: Missing::Duration });
        return None;
    };
    let Some(("simple", bounds)) = simple.call() else {
        if !simple.is_error() {
            problems.push(Problem::Declaration(no_simple(simple, rest, items)));
        }
        return None;
    };
    let inside = options(bounds, ANYWHERE, "simple", problems);
    let is_bound = |form: &Form| form.keyword().is_some_and(|word| BOUNDS.contains(&word));
    let mut observer = None;
    let outside = match rest.iter().position(is_bound) {
        // Bounds after the `)` of `simple`: the first says it for all.
        Some(first) => {
            problems.push(Problem::Declaration(closed_early(simple, rest, first)));
            options(rest, ANYWHERE, "simple", problems)
        }
        None => {
            let [contingent, observed] = options(rest, CHOICE, "duration", problems);
            observer = observed;
            [None, None, None, None, contingent]
        }
    };
    let [.., misplaced] = inside;
    let [.., contingent] = outside;
    if let (Some(value), None) = (misplaced.filter(|form| !form.is_error()), contingent) {
        // `:contingent t` inside of `simple`.
        let keyword = bounds.iter().take_while(|form| form.span != value.span).last().unwrap_or(value).span;
        let slip = DeclarationSlip::TooFarIn { keyword, value, simple: simple.span };
        problems.push(Problem::Declaration(slip));
    }
    let bounds = std::array::from_fn(|slot| inside[slot].or(outside[slot]));
    Some(Written { bounds, choice: [contingent.or(misplaced), observer] }.duration(form, simple, problems))
}

/// A bound behind the `)` of `simple`.
fn closed_early<'a>(simple: &Form, rest: &'a [Form], first: usize) -> DeclarationSlip<'a> {
    let is_bound = |pair: &&[Form]| {
        matches!(pair, [keyword, value] if keyword.keyword().is_some_and(|word| BOUNDS.contains(&word))
            && value.keyword().is_none_or(|word| word == "infinity"))
    };
    DeclarationSlip::ClosedEarly {
        keyword: rest[first].span,
        word: rest[first].keyword().unwrap_or_default(),
        simple: simple.span,
        last: rest.chunks(2).take_while(is_bound).last().map(|pair| pair[1].span),
    }
}

/// What stands in the place of `(simple ...)`.
fn no_simple<'a>(simple: &'a Form, rest: &'a [Form], items: &'a [Form]) -> DeclarationSlip<'a> {
    if let Some((word, _)) = simple.call() {
        return DeclarationSlip::NoSimple { found: simple, near: nearest(word, ["simple"]) };
    }
    // Without its parentheses, it is as clear what is meant.
    if simple.word() == Some("simple") || simple.keyword().is_some() {
        let given = if simple.keyword().is_some() { items } else { rest };
        let is_bound = |pair: &&[Form]| pair[0].keyword().is_some_and(|word| word != "contingent");
        let last = given.chunks(2).take_while(is_bound).last().and_then(<[Form]>::last);
        return DeclarationSlip::BareBounds { first: simple, rest, last: last.map(|last| last.span) };
    }
    let given = simple.list().filter(|_| rest.is_empty()).unwrap_or(items);
    let numbers = given.iter().take_while(|form| matches!(form.kind, FormKind::Number(_))).count();
    let (lower, upper, last) = match (given, numbers) {
        (_, 0) => return DeclarationSlip::NoSimple { found: simple, near: None },
        ([lower, ..], 1) => (lower, lower, Some(lower)),
        ([lower, upper, ..], 2) => (lower, upper, Some(upper)),
        (given, _) => (&given[0], &given[1], None),
    };
    // In a list, all of it is what was meant to be that list.
    let all = last.map(|last| if simple.list().is_some() { simple.span } else { simple.span.to(last.span) });
    DeclarationSlip::BareNumbers { found: simple, bounds: [lower, upper], all }
}
