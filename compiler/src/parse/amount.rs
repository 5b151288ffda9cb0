//! Durations and other numbers: `15`, `1.5`, `1/2`, `1d0`, `(minutes 5)`, `:infinity`, `*name*`, `(+ x 1)`.

use kirk_network::{Duration, ParseDurationError};

use super::{ident, slips};
use crate::ast::{Amount, AmountKind};
use crate::calculate::Operator;
use crate::form::{Form, FormKind, Symbol};
use crate::problem::Problems;
use crate::words::unit;

/// Reads a duration or another number. `what` names it in messages.
pub(super) fn amount(form: &Form, what: &str, problems: &mut Problems) -> Amount {
    Amount { kind: kind(form, what, 1_000_000, problems), span: form.span }
}

/// True if this is a calculation or a number with a unit: a list that stands for a number.
pub(super) fn is_calculation(form: &Form) -> bool {
    form.call().is_some_and(|(word, _)| Operator::of(word).is_some() || unit(word).is_some())
}

fn kind(form: &Form, what: &str, unit: i64, problems: &mut Problems) -> AmountKind {
    match &form.kind {
        FormKind::Number(text) => match number(text, i128::from(unit)) {
            Ok(value) => return AmountKind::Number(value),
            Err(error) => problems.push(slips::amount::inexact(form, what, text, error)),
        },
        FormKind::Keyword(word) if matches!(word.as_str(), "infinity" | "inf" | "+infinity") => {
            return AmountKind::Infinite;
        }
        FormKind::Symbol(symbol) if is_name(symbol) => {
            if let Some(name) = ident(form) {
                return AmountKind::Named(name);
            }
        }
        FormKind::List(_) => match calculation(form, what, problems) {
            Some(kind) => return kind,
            None => problems.push(slips::amount::no_calculation(form, what)),
        },
        FormKind::Error => {}
        _ => problems.push(slips::amount::no_number(form, what)),
    }
    AmountKind::Error
}

/// `(minutes 5)`, `(+ x 1)`; `None` if it is neither.
fn calculation(form: &Form, what: &str, problems: &mut Problems) -> Option<AmountKind> {
    let (word, rest) = form.call()?;
    if let Some(operator) = Operator::of(word) {
        let (least, most) = operator.takes();
        let part = |part: &Form| amount(part, "part of this calculation", problems);
        return (least..=most)
            .contains(&rest.len())
            .then(|| AmountKind::Calculation(operator, rest.iter().map(part).collect()));
    }
    let (name, micros) = unit(word)?;
    let [inner] = rest else { return None };
    Some(match kind(inner, what, micros, problems) {
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

/// The number of microseconds of a number as written, in units of `unit` microseconds.
pub(super) fn number(text: &str, unit: i128) -> Result<Duration, ParseDurationError> {
    // Exact: numerator and denominator as integers, as long as they are of a sensible length.
    let (negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (top, bottom) = match text.split_once('/') {
        Some((top, bottom)) => (integer(top)?, integer(bottom)?),
        None => {
            let at = text.find(['e', 'd', 'f', 's', 'l']);
            let (mantissa, exponent) = at.map_or((text, "0"), |at| (&text[..at], &text[at + 1..]));
            let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
            let fraction = fraction.trim_end_matches('0');
            let digits = integer(&format!("0{whole}{fraction}"))?;
            if digits == 0 {
                return Ok(Duration::ZERO);
            }
            let exponent = exponent.strip_prefix('+').unwrap_or(exponent);
            let exponent: i64 =
                exponent.parse().unwrap_or(if exponent.starts_with('-') { -1_000 } else { 1_000 });
            let power = exponent.saturating_sub(fraction.len() as i64);
            match u32::try_from(power.unsigned_abs()).ok().and_then(|n| 10_i128.checked_pow(n)) {
                Some(scale) if power < 0 => (digits, scale),
                Some(scale) => (digits.checked_mul(scale).ok_or(ParseDurationError::TooLarge)?, 1),
                None if power < 0 => return Err(ParseDurationError::TooPrecise),
                None => return Err(ParseDurationError::TooLarge),
            }
        }
    };
    let micros = top.checked_mul(unit).ok_or(ParseDurationError::TooLarge)?;
    if bottom == 0 {
        return Err(ParseDurationError::NotANumber);
    }
    if micros / bottom > i128::from(Duration::MAX.as_micros()) {
        return Err(ParseDurationError::TooLarge);
    }
    if micros % bottom != 0 {
        return Err(ParseDurationError::TooPrecise);
    }
    let micros = (micros / bottom) as i64;
    Ok(Duration::from_micros(if negative { -micros } else { micros }))
}

fn integer(text: &str) -> Result<i128, ParseDurationError> {
    match text.trim_start_matches('0') {
        "" => Ok(0),
        digits => digits.parse().map_err(|_| ParseDurationError::TooLarge),
    }
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
