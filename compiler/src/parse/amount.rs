//! Durations and other numbers: `15`, `1.5`, `1/2`, `1d0`, `(minutes 5)`, `:infinity`, `*name*`, `(+ x 1)`.

use kirk_network::{Duration, ParseDurationError};

use super::{head, ident};
use crate::ast::{Amount, AmountKind};
use crate::calculate::Operator;
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;

const UNITS: [(&str, i64); 5] = [
    ("microseconds", 1),
    ("seconds", 1_000_000),
    ("minutes", 60_000_000),
    ("hours", 3_600_000_000),
    ("days", 86_400_000_000),
];

/// Reads a duration or another number. `what` names it in messages.
pub(super) fn amount(form: &Form, what: &str, problems: &mut Problems) -> Amount {
    Amount { kind: kind(form, what, 1_000_000, problems), span: form.span }
}

/// True if this is a calculation or a number with a unit: a list that stands for a number.
pub(super) fn is_calculation(form: &Form) -> bool {
    form.call().is_some_and(|(word, _)| Operator::of(word).is_some() || unit(word).is_some())
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

fn kind(form: &Form, what: &str, unit: i64, problems: &mut Problems) -> AmountKind {
    match &form.kind {
        FormKind::Number(text) => match number(text, i128::from(unit)) {
            Ok(value) => return AmountKind::Number(value),
            Err(error) => problems.push(inexact(form, what, text, error)),
        },
        FormKind::Keyword(word) if matches!(word.as_str(), "infinity" | "inf" | "+infinity") => {
            return AmountKind::Infinite;
        }
        FormKind::Symbol(symbol) if !matches!(symbol.name.as_str(), "t" | "nil") => {
            let help = symbol
                .package
                .as_deref()
                .map_or_else(|| suffix(&symbol.name), |hours| clock(hours, &symbol.name));
            match (help, ident(form)) {
                (Some(help), _) => problems.push(not_a_number(form, what).help(help)),
                (None, Some(name)) => return AmountKind::Named(name),
                (None, None) => {}
            };
        }
        FormKind::List(_) => return list(form, what, problems),
        FormKind::Error => {}
        _ => problems.push(not_a_number(form, what)),
    }
    AmountKind::Error
}

/// `(minutes 5)`, `(+ x 1)`.
fn list(form: &Form, what: &str, problems: &mut Problems) -> AmountKind {
    let Some((word, rest)) = form.call() else {
        problems.push(not_a_number(form, what).maybe_help(infix(form)));
        return AmountKind::Error;
    };
    let (least, most, example) = match (Operator::of(word), unit(word)) {
        (Some(operator), _) => {
            let (least, most) = operator.takes();
            (least, most, format!("({word} x{})", if most > 1 { " 1" } else { "" }))
        }
        (None, Some(_)) => (1, 1, format!("({word} 5)")),
        (None, None) => {
            let near = UNITS.iter().map(|(name, _)| *name).chain(Operator::ALL.map(Operator::word));
            let message = format!("`{}` is neither a unit of time nor arithmetic", clip(word));
            problems.push(
                Diagnostic::error(Code::UnknownUnit, form.span, message)
                    .primary(format!("{what} was expected"))
                    .help("The units are `(microseconds 250)`, `(seconds 90)`, `(minutes 5)`, `(hours 1.5)` and `(days 1)`; arithmetic is `+`, `-`, `*`, `/`, `1+`, `1-`, `min`, `max` and `mod`.")
                    .meant(head(form), match word {
                        "mins" | "m" => Some("minutes"),
                        _ => nearest(word, near),
                    }),
            );
            return AmountKind::Error;
        }
    };
    if rest.len() < least || rest.len() > most {
        let number = match (least, most) {
            (1, 1) => "one number",
            (2, 2) => "two numbers",
            (2, _) => "two numbers or more",
            _ => "at least one number",
        };
        let message = format!("`{word}` takes {number}, not {}", rest.len());
        problems.push(
            Diagnostic::error(Code::WrongShape, head(form), message)
                .primary("in this calculation")
                .help(format!("Write `{example}`."))
                .maybe_help((word == "min").then(|| "Minutes are written `(minutes 5)`.".to_string())),
        );
        return AmountKind::Error;
    }
    match (Operator::of(word), unit(word), rest) {
        (Some(operator), ..) => {
            let part = |part: &Form| amount(part, "part of this calculation", problems);
            AmountKind::Calculation(operator, rest.iter().map(part).collect())
        }
        (None, Some((name, micros)), [inner]) => match kind(inner, what, micros, problems) {
            found @ (AmountKind::Named(_) | AmountKind::Unit(..) | AmountKind::Calculation(..)) => {
                AmountKind::Unit(name, micros, Box::new(Amount { kind: found, span: inner.span }))
            }
            known => known,
        },
        _ => AmountKind::Error,
    }
}

/// True for the name of a unit of time.
pub(super) fn is_unit(word: &str) -> bool {
    unit(word).is_some()
}

/// The unit of this name, in the plural or in the singular.
fn unit(word: &str) -> Option<(&'static str, i64)> {
    UNITS.into_iter().find(|(name, _)| *name == word || name.strip_suffix('s') == Some(word))
}

fn not_a_number(form: &Form, what: &str) -> Diagnostic {
    let unquoted = match &form.kind {
        FormKind::String(text)
            if text.starts_with(|c: char| c.is_ascii_digit()) && number(text, 1_000_000).is_ok() =>
        {
            Some(format!("Take the quotation marks out: `{}`.", clip(text)))
        }
        _ => None,
    };
    Diagnostic::error(Code::NotANumber, form.span, format!("{what} is not a number"))
        .primary(format!("a duration was expected, not {}", form.describe()))
        .help("Write seconds (`15`, `1.5`, `1/2`), a unit (`(minutes 5)`), a named number (`*wait*`) or `:infinity`.")
        .maybe_help(unquoted)
}

/// Advice for `(5 + 3)`.
fn infix(form: &Form) -> Option<String> {
    let [left, operator, right] = form.list()? else { return None };
    let word = operator.word().filter(|word| Operator::of(word).is_some())?;
    Some(format!("The operator comes first: `({word} {} {})`.", super::text_of(left), super::text_of(right)))
}

/// Advice for `1:30`, which is read as a name in a package.
fn clock(before: &str, after: &str) -> Option<String> {
    let (minutes, seconds): (u32, u32) = (before.parse().ok()?, after.parse().ok()?);
    (seconds < 60).then(|| {
        format!("Write `(+ (minutes {minutes}) {seconds})` for minutes and seconds, `(+ (hours {minutes}) (minutes {seconds}))` for hours and minutes.")
    })
}

fn inexact(form: &Form, what: &str, text: &str, error: ParseDurationError) -> Diagnostic {
    let text = clip(text);
    match error {
        ParseDurationError::TooPrecise => Diagnostic::error(
            Code::NotExact,
            form.span,
            format!("{what} is not a whole number of microseconds"),
        )
        .primary(format!("{text} would have to be rounded"))
        .help("Kirk counts in microseconds and never rounds a bound: write it with at most six decimals."),
        ParseDurationError::TooLarge => {
            Diagnostic::error(Code::TooLarge, form.span, format!("{what} is too large"))
                .primary("more than 10 billion seconds")
                .help("For \"no limit\" leave the bound out or write `:infinity`.")
        }
        ParseDurationError::NotANumber => not_a_number(form, what),
    }
}

/// Advice for `15s`, `5min` and the like.
fn suffix(name: &str) -> Option<String> {
    let other = |c: char| !c.is_ascii_digit() && c != '.';
    let at = name.find("..").or_else(|| name.find(other)).filter(|at| *at > 0)?;
    let (digits, unit) = name.split_at(at);
    Some(match unit {
        "s" | "sec" | "secs" | "second" | "seconds" => {
            format!("A plain number is seconds: write `{digits}`.")
        }
        "m" | "min" | "mins" | "minute" | "minutes" => format!("Write `(minutes {digits})`."),
        "h" | "hr" | "hour" | "hours" => format!("Write `(hours {digits})`."),
        "d" | "day" | "days" => format!("Write `(days {digits})`."),
        range if range.trim_start_matches(['-', '.']).starts_with(|c: char| c.is_ascii_digit()) => {
            let most = range.trim_start_matches(['-', '.']);
            format!("The shortest and the longest time are two numbers: `{digits}` and `{}`.", clip(most))
        }
        _ => "Write seconds (`15`), a unit (`(minutes 5)`), a named number (`*wait*`) or `:infinity`."
            .to_string(),
    })
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
