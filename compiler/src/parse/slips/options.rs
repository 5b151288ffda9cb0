//! Keywords misspelt, without a colon, without a value, twice; values without a keyword.

use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::parse::amount::is_calculation;
use crate::parse::problem::{KeywordSlip, Owner, Problem, Stray, Twice};
use crate::problem::Problems;
use crate::source::Span;
use crate::words::unit;
use crate::words::{Piece, keyword};

/// The values of the known keywords as far as they can be guessed; what is wrong is reported.
pub(in crate::parse) fn guessed<'a, const N: usize>(
    forms: &'a [Form],
    known: [&str; N],
    owner: &str,
    problems: &mut Problems,
) -> [Option<&'a Form>; N] {
    let owner = Owner { word: owner, known: &known };
    let mut values: [Option<&'a Form>; N] = [None; N];
    let mut firsts = [None; N];
    // After a slip nobody knows which keywords are missing: those not given count as given wrongly.
    let mut slipped = false;
    let mut rest = forms.iter().peekable();
    let mut last: Option<&Form> = None;
    while let Some(form) = rest.next() {
        let bare = form.word().filter(|word| known.contains(word));
        if let Some(word) = bare {
            problems.push(Problem::Keyword(KeywordSlip::NoColon { at: form.span, word }));
        }
        let Some(word) = form.keyword().or(bare) else {
            slipped = true;
            if !form.is_error() {
                let is = stray(form, last, forms, &known);
                problems.push(Problem::Keyword(KeywordSlip::NoKeyword { found: form, owner, is }));
            }
            // What comes before the next keyword is the same slip.
            while rest.next_if(|next| next.keyword().is_none()).is_some() {}
            continue;
        };
        let value = rest.next_if(|next| next.keyword().is_none_or(|word| !known.contains(&word)));
        last = value;
        let Some(slot) = known.iter().position(|name| *name == word) else {
            let meant = meant(word, &known);
            match meant.as_slice() {
                [slot] if values[*slot].is_none() => values[*slot] = Some(value.unwrap_or(&MISSING)),
                [_] | [] => slipped = true,
                several => several.iter().for_each(|slot| {
                    values[*slot].get_or_insert(&MISSING);
                }),
            }
            let near: Vec<&str> = meant.iter().map(|slot| known[*slot]).collect();
            let cures = worth_writing(&near, forms);
            let slip = KeywordSlip::Unknown { at: form.span, word, owner, near: &near, cures: &cures };
            problems.push(Problem::Keyword(slip));
            continue;
        };
        if let Some(first) = firsts[slot] {
            let pair = |keyword: Span, value: &Form| Span { end: value.span.end, ..keyword };
            let both = values[slot].filter(|one| !one.is_error()).zip(value);
            let whole = both.map(|(one, other)| [pair(first, one), pair(form.span, other)]);
            problems.push(Problem::Twice { what: Twice::Keyword(word), first, again: form.span, whole });
            continue;
        }
        firsts[slot] = Some(form.span);
        values[slot] = Some(value.unwrap_or(&MISSING));
        if value.is_none() {
            problems.push(Problem::Keyword(KeywordSlip::NoValue {
                at: form.span,
                word,
                flag: is_flag(word),
            }));
        }
    }
    if slipped {
        for value in &mut values {
            value.get_or_insert(&MISSING);
        }
    }
    values
}

/// Stands for a value that was meant and cannot be understood, which has been reported.
static MISSING: Form = Form { span: Span { source: 0, start: 0, end: 0 }, kind: FormKind::Error };

/// Reports what is neither `t` nor `nil`.
pub(in crate::parse) fn no_flag(form: &Form, keyword: &str, problems: &mut Problems) {
    if form.is_error() {
        return;
    }
    let near = match form.word() {
        Some("true" | "yes" | "on") => Some("t"),
        Some("false" | "no" | "off") => Some("nil"),
        _ => None,
    };
    problems.push(Problem::Keyword(KeywordSlip::NoFlag { found: form, keyword, near }));
}

/// The keywords a wrong one may stand for: the nearest one, else those that are longer and have its parts.
fn meant(word: &str, known: &[&str]) -> Vec<usize> {
    let slots =
        |wanted: &dyn Fn(&str) -> bool| (0..known.len()).filter(|slot| wanted(known[*slot])).collect();
    let parts_in = |name: &str| {
        let mut parts = name.split('-');
        word.split(['-', '_']).all(|part| parts.any(|known| known == part))
    };
    let longer: Vec<usize> = slots(&parts_in);
    if longer.len() > 1 {
        return longer;
    }
    let near = nearest(word, known.iter().copied());
    let synonym = match word {
        "max" | "maximum" | "most" | "longest" => Some("upper-bound"),
        "min" | "minimum" | "least" | "shortest" => Some("lower-bound"),
        _ => None,
    };
    // `:min` begins like the name of a delay, and still is a bound.
    match synonym.filter(|bound| known.contains(bound)).or(near) {
        Some(near) if known.contains(&near) => slots(&|name| name == near),
        _ => longer,
    }
}

/// Those of the keywords that may be meant which are worth writing: the shortest delay alone says nothing.
fn worth_writing<'a>(near: &[&'a str], forms: &[Form]) -> Vec<&'a str> {
    let longest = forms.iter().any(|form| form.keyword() == Some("max-observation-delay"));
    near.iter().copied().filter(|name| longest || *name != "min-observation-delay").collect()
}

/// True for the keywords that are answered by `t` or `nil`.
fn is_flag(word: &str) -> bool {
    keyword(word).is_some_and(|keyword| keyword.value == Piece::Flag)
}

/// What stands where a keyword belongs: numbers without their keywords, or a unit after its number.
fn stray<'a>(form: &'a Form, last: Option<&'a Form>, forms: &'a [Form], known: &[&str]) -> Stray<'a> {
    let is_number = |form: &Form| matches!(form.kind, FormKind::Number(_));
    match (last, form.word(), forms) {
        (Some(number), Some(word), _) if is_number(number) && unit(word).is_some() => {
            Stray::Unit { number, unit: word }
        }
        (Some(_), ..) if form.call().is_some_and(|_| !is_calculation(form)) => Stray::Call,
        (Some(number), ..) if is_number(number) && is_number(form) => {
            let given = |bound: &str| forms.iter().any(|form| form.keyword() == Some(bound));
            let missing = ["lower-bound", "upper-bound"].into_iter().find(|bound| !given(bound));
            missing.filter(|bound| known.contains(bound)).map_or(Stray::Other, Stray::Bound)
        }
        (None, _, [lower, ..]) if is_number(lower) && known.contains(&"upper-bound") => {
            let (upper, all) = match forms.iter().take_while(|form| is_number(form)).count() {
                1 => (lower, Some(form.span)),
                2 => (&forms[1], Some(form.span.to(forms[1].span))),
                _ => (&forms[1], None),
            };
            Stray::Bounds { bounds: [lower, upper], all }
        }
        _ => Stray::Other,
    }
}
