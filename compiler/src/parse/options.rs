//! Keyword arguments: `:lower-bound 15 :upper-bound 20`.

use super::{twice, unexpected};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::source::Span;

/// The values of the known keywords, in the order of `known`; everything else in `forms` is reported.
pub(super) fn options<'a, const N: usize>(
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
    while let Some(form) = rest.next() {
        let Some(word) = form.keyword() else {
            slipped = true;
            if !form.is_error() {
                let wanted = format!("a keyword of `{owner}`");
                problems.push(unexpected(form, &wanted, &format!("`{owner}` understands {}.", list(&known))));
            }
            continue;
        };
        let value = rest.next_if(|next| next.keyword().is_none_or(|word| !known.contains(&word)));
        let Some(slot) = known.iter().position(|name| *name == word) else {
            let meant = nearest(word, known).and_then(|near| known.iter().position(|name| *name == near));
            match meant.filter(|slot| values[*slot].is_none()) {
                Some(slot) => values[slot] = Some(value.unwrap_or(&MISSING)),
                None => slipped = true,
            }
            problems.push(
                Diagnostic::error(
                    Code::UnknownKeyword,
                    form.span,
                    format!("`{owner}` has no keyword `:{}`", clip(word)),
                )
                .primary("not understood here")
                .help(match nearest(word, known) {
                    Some(near) => format!("Did you mean `:{near}`?"),
                    None => format!("`{owner}` understands {}.", list(&known)),
                }),
            );
            continue;
        };
        if let Some(first) = firsts[slot] {
            problems.push(twice(&format!("`:{word}`"), first, form.span));
            continue;
        }
        firsts[slot] = Some(form.span);
        match value {
            Some(value) => values[slot] = Some(value),
            None => {
                values[slot] = Some(&MISSING);
                problems.push(
                    Diagnostic::error(Code::WrongShape, form.span, format!("`:{word}` has no value"))
                        .primary("a value was expected after this keyword"),
                );
            }
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

/// `t` or `nil`; what cannot be understood is taken for the more permissive `t`.
pub(super) fn flag(form: &Form, keyword: &str, problems: &mut Problems) -> bool {
    match form.word() {
        Some("t") => true,
        Some("nil") => false,
        _ => {
            if !form.is_error() {
                let wanted = format!("`t` or `nil` after `:{keyword}`");
                problems.push(unexpected(form, &wanted, "`t` means yes and `nil` means no."));
            }
            true
        }
    }
}

fn list(known: &[&str]) -> String {
    let words: Vec<String> = known.iter().map(|word| format!(":{word}")).collect();
    super::one_of(&words.iter().map(String::as_str).collect::<Vec<_>>())
}
