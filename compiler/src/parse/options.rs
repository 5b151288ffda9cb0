//! Keyword arguments: `:lower-bound 15 :upper-bound 20`.

use super::slips;
use crate::form::Form;
use crate::problem::Problems;

/// The values of the known keywords, in the order of `known`; everything else in `forms` is reported.
pub(super) fn options<'a, const N: usize>(
    forms: &'a [Form],
    known: [&str; N],
    owner: &str,
    problems: &mut Problems,
) -> [Option<&'a Form>; N] {
    pairs(forms, known).unwrap_or_else(|| slips::options::guessed(forms, known, owner, problems))
}

/// The values, if these are known keywords, each there once and with its value.
pub(super) fn pairs<'a, const N: usize>(
    forms: &'a [Form],
    known: [&str; N],
) -> Option<[Option<&'a Form>; N]> {
    let slot = |form: &Form| known.iter().position(|name| form.keyword() == Some(name));
    let mut values = [None; N];
    for pair in forms.chunks(2) {
        let [keyword, value] = pair else { return None };
        let place = &mut values[slot(keyword)?];
        if place.is_some() || slot(value).is_some() {
            return None;
        }
        *place = Some(value);
    }
    Some(values)
}

/// `t` or `nil`; what cannot be understood is taken for the more permissive `t`.
pub(super) fn flag(form: &Form, keyword: &str, problems: &mut Problems) -> bool {
    match form.word() {
        Some("t") => true,
        Some("nil") => false,
        _ => {
            slips::options::no_flag(form, keyword, problems);
            true
        }
    }
}
