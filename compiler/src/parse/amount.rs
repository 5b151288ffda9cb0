//! Durations and other numbers: `15`, `1.5`, `1/2`, `1d0`, `(minutes 5)`, `:infinity`, `*name*`, `(+ x 1)`.

use kirk_network::{Duration, ParseDurationError};

use super::{ident, slips};
use crate::ast::{Amount, AmountKind, Role};
use crate::calculate::Operator;
use crate::form::{Form, FormKind, Symbol};
use crate::problem::Problems;
use crate::words::unit;

/// Reads a duration or another number.
pub(super) fn amount(form: &Form, role: Role, problems: &mut Problems) -> Amount {
    Amount { kind: kind(form, role, 1_000_000, problems), span: form.span }
}

/// True if this is a calculation or a number with a unit: a list that stands for a number.
pub(super) fn is_calculation(form: &Form) -> bool {
    form.call().is_some_and(|(word, _)| Operator::of(word).is_some() || unit(word).is_some())
}

fn kind(form: &Form, role: Role, unit: i64, problems: &mut Problems) -> AmountKind {
    match &form.kind {
        FormKind::Number(text) => match number(text, unit) {
            Ok(value) => return AmountKind::Number(value),
            Err(error) => problems.push(slips::amount::inexact(form, role, text, error)),
        },
        FormKind::Keyword(word) if matches!(word.as_str(), "infinity" | "inf" | "+infinity") => {
            return AmountKind::Infinite;
        }
        FormKind::Symbol(symbol) if is_name(symbol) => {
            if let Some(name) = ident(form) {
                return AmountKind::Named(name);
            }
        }
        FormKind::List(_) => match calculation(form, role, problems) {
            Some(kind) => return kind,
            None => problems.push(slips::amount::no_calculation(form, role)),
        },
        FormKind::Error => {}
        _ => problems.push(slips::amount::no_number(form, role)),
    }
    AmountKind::Error
}

/// `(minutes 5)`, `(+ x 1)`; `None` if it is neither.
fn calculation(form: &Form, role: Role, problems: &mut Problems) -> Option<AmountKind> {
    let (word, rest) = form.call()?;
    if let Some(operator) = Operator::of(word) {
        let (least, most) = operator.takes();
        let part = |part: &Form| amount(part, Role::Operand, problems);
        return (least..=most)
            .contains(&rest.len())
            .then(|| AmountKind::Calculation(operator, rest.iter().map(part).collect()));
    }
    let (name, micros) = unit(word)?;
    let [inner] = rest else { return None };
    Some(match kind(inner, role, micros, problems) {
        found @ (AmountKind::Named(_) | AmountKind::Unit(..) | AmountKind::Calculation(..)) => {
            AmountKind::Unit(name, micros, Box::new(Amount { kind: found, span: inner.span }))
        }
        known => known,
    })
}

/// True for what may be the name of a number: nothing that begins like a number, and no time of day.
pub(super) fn is_name(symbol: &Symbol) -> bool {
    let digit = |text: &str| text.starts_with(|c: char| c.is_ascii_digit());
    let name = symbol.name.as_str();
    match &symbol.package {
        _ if matches!(name, "t" | "nil") => false,
        Some(package) => !(digit(package) && digit(name)),
        None => !digit(name.trim_start_matches('.')) && !name.contains(".."),
    }
}

/// A number as written, in units of so many microseconds.
pub(super) fn number(text: &str, unit: i64) -> Result<Duration, ParseDurationError> {
    let Some((top, bottom)) = text.split_once('/') else {
        return Duration::parse(&text.replace(['d', 'f', 's', 'l'], "e"), unit);
    };
    let integer = |text: &str| text.parse::<i128>().map_err(|_| ParseDurationError::TooLarge);
    let top = integer(top)?.checked_mul(i128::from(unit)).ok_or(ParseDurationError::TooLarge)?;
    Duration::exactly(top, integer(bottom)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_exact_or_refused() {
        let micros = |text: &str, unit| number(text, unit).map(Duration::as_micros);
        assert_eq!(micros("15", 1_000_000), Ok(15_000_000));
        assert_eq!(micros("15.", 1_000_000), Ok(15_000_000));
        assert_eq!(micros(".5", 1_000_000), Ok(500_000));
        assert_eq!(micros("-1.5d0", 1_000_000), Ok(-1_500_000));
        assert_eq!(micros("1e3", 1_000_000), Ok(1_000_000_000));
        assert_eq!(micros("25e-1", 1_000_000), Ok(2_500_000));
        assert_eq!(micros("1/2", 1_000_000), Ok(500_000));
        assert_eq!(micros("1/3", 60_000_000), Ok(20_000_000));
        assert_eq!(micros("1/3", 1_000_000), Err(ParseDurationError::TooPrecise));
        assert_eq!(micros("1/0", 1_000_000), Err(ParseDurationError::NotANumber));
        assert_eq!(micros("0.0000001", 1_000_000), Err(ParseDurationError::TooPrecise));
        assert_eq!(micros("1e-99999999999999999999", 1_000_000), Err(ParseDurationError::TooPrecise));
        assert_eq!(micros("1e99999999999999999999", 1_000_000), Err(ParseDurationError::TooLarge));
        assert_eq!(micros("0e99999999999999999999", 1_000_000), Ok(0));
        assert_eq!(micros("10000000000", 1_000_000), Ok(10_000_000_000_000_000));
        assert_eq!(micros("10000000000.000001", 1_000_000), Err(ParseDurationError::TooLarge));
        assert_eq!(micros("1000000", 86_400_000_000), Err(ParseDurationError::TooLarge));
    }
}
