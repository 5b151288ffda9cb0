//! Keywords misspelt, without a colon, without a value, twice; values without a keyword.

use super::{one_of, text_of, twice, unexpected};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::parse::amount::is_calculation;
use crate::problem::Problems;
use crate::source::Span;
use crate::words::unit;
use crate::words::{Part, keyword};

/// The values of the known keywords as far as they can be guessed; what is wrong is reported.
pub(in crate::parse) fn guessed<'a, const N: usize>(
    forms: &'a [Form],
    known: [&str; N],
    owner: &str,
    problems: &mut Problems,
) -> [Option<&'a Form>; N] {
    let mut values: [Option<&'a Form>; N] = [None; N];
    let mut firsts = [None; N];
    // After a slip nobody knows which keywords are missing: those not given count as given wrongly.
    let mut slipped = false;
    let mut rest = forms.iter().peekable();
    let mut last: Option<&Form> = None;
    while let Some(form) = rest.next() {
        let bare = form.word().filter(|word| known.contains(word));
        if let Some(word) = bare {
            problems.push(no_colon(form, word));
        }
        let Some(word) = form.keyword().or(bare) else {
            slipped = true;
            if !form.is_error() {
                problems.push(no_keyword(form, last, forms, &known, owner));
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
            let meant: Vec<String> = meant.iter().map(|slot| format!(":{}", known[*slot])).collect();
            problems.push(unknown(form, word, &meant, forms, &known, owner));
            continue;
        };
        if let Some(first) = firsts[slot] {
            let mut problem = twice(&format!("`:{word}`"), first, form.span);
            if let (Some(one), Some(other)) = (values[slot].filter(|one| !one.is_error()), value) {
                let pair = |keyword: Span, value: &Form| Span { end: value.span.end, ..keyword };
                problem = problem.take_out("the first one", pair(first, one));
                problem = problem.take_out("the second one", pair(form.span, other));
            }
            problems.push(problem);
            continue;
        }
        firsts[slot] = Some(form.span);
        values[slot] = Some(value.unwrap_or(&MISSING));
        if value.is_none() {
            problems.push(no_value(form, word));
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
    let wanted = format!("`t` or `nil` after `:{keyword}`");
    let meant = match form.word() {
        Some("true" | "yes" | "on") => Some("t"),
        Some("false" | "no" | "off") => Some("nil"),
        _ => None,
    };
    let help = "`t` means yes and `nil` means no.";
    problems.push(unexpected(form, &wanted, help).meant(form.span, meant));
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

/// A keyword that this form does not have.
fn unknown(
    form: &Form,
    word: &str,
    meant: &[String],
    forms: &[Form],
    known: &[&str],
    owner: &str,
) -> Diagnostic {
    let message = format!("`{owner}` has no keyword `:{}`", clip(word));
    let problem = Diagnostic::error(Code::UnknownKeyword, form.span, message)
        .primary("not understood here")
        .help(match meant.is_empty() {
            false => format!("Did you mean `{}`?", meant.join("` or `")),
            true => format!("`{owner}` understands {}.", list(known, owner)),
        });
    // The shortest delay alone says nothing.
    let longest = forms.iter().any(|form| form.keyword() == Some("max-observation-delay"));
    let choices = meant.iter().filter(|name| longest || *name != ":min-observation-delay");
    choices.fold(problem, |problem, name| problem.change(form.span, name))
}

fn no_colon(form: &Form, word: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, form.span, format!("the colon of `:{word}` is missing"))
        .primary("a keyword was expected")
        .help(format!("Write `:{word}`: without the colon it is the name of something else."))
        .change(form.span, format!(":{word}"))
}

fn no_value(form: &Form, word: &str) -> Diagnostic {
    let example = if is_flag(word) { "t" } else { "5" };
    let problem = Diagnostic::error(Code::WrongShape, form.span, format!("`:{word}` has no value"))
        .primary("a value was expected after this keyword")
        .help(format!("Write `:{word} {example}`."));
    match is_flag(word) {
        true => problem.change(form.span, format!(":{word} t")),
        false => problem,
    }
}

/// True for the keywords that are answered by `t` or `nil`.
fn is_flag(word: &str) -> bool {
    keyword(word).is_some_and(|keyword| keyword.value == Part::Flag)
}

/// Something stands where a keyword belongs: numbers without their keywords, or a unit after its number.
fn no_keyword(form: &Form, last: Option<&Form>, forms: &[Form], known: &[&str], owner: &str) -> Diagnostic {
    let problem = unexpected(
        form,
        &format!("a keyword of `{owner}`"),
        &format!("`{owner}` understands {}.", list(known, owner)),
    );
    let is_number = |form: &Form| matches!(form.kind, FormKind::Number(_));
    let numbers: Vec<String> = forms.iter().map_while(|form| is_number(form).then(|| write(form))).collect();
    match (last, form.word(), numbers.as_slice()) {
        (Some(number), Some(word), _) if is_number(number) && unit(word).is_some() => {
            let written = format!("({word} {})", write(number));
            let problem = problem.help(format!("A unit stands before its number: `{}`.", clip(&written)));
            problem.change(number.span.to(form.span), written)
        }
        (Some(_), ..) if form.call().is_some_and(|_| !is_calculation(form)) => {
            problem.help("Is a `)` missing before it?")
        }
        (Some(number), ..) if is_number(number) && is_number(form) => {
            let given = |bound: &&str| forms.iter().any(|form| form.keyword() == Some(*bound));
            let missing = ["lower-bound", "upper-bound"].into_iter().find(|bound| !given(bound));
            match missing.filter(|bound| known.contains(bound)) {
                Some(bound) => {
                    let help = format!("`:{bound}` is missing before it: `:{bound} {}`.", text_of(form));
                    let title = format!("Add `:{bound}` before it");
                    problem.help(help).suggest(title, [Edit::before(form.span, format!(":{bound} "))])
                }
                None => problem,
            }
        }
        (None, _, [first, ..]) if known.contains(&"upper-bound") => {
            let last = numbers.get(1).unwrap_or(first);
            let bounds = format!(":lower-bound {first} :upper-bound {last}");
            let problem =
                problem.help(format!("Every bound has its keyword: `({owner} {})`.", clip(&bounds)));
            match numbers.len() {
                1 => problem.change(form.span, bounds),
                2 => problem.change(form.span.to(forms[1].span), bounds),
                _ => problem,
            }
        }
        _ => problem,
    }
}

/// The keywords to write. `simple` knows `:contingent` only to say that it belongs to `duration`.
fn list(known: &[&str], owner: &str) -> String {
    let wanted = known.iter().filter(|word| owner != "simple" || **word != "contingent");
    one_of(wanted.map(|word| format!(":{word}")))
}
