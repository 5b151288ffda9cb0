//! Numbers with a unit behind them, in quotation marks, as a range or a time of day; calculations written as in a book.

use kirk_network::ParseDurationError;

use crate::ast::Role;
use crate::calculate::Operator;
use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::parse::amount::number;
use crate::parse::problem::{Calculation, NumberSlip, Problem, Suffixed};
use crate::words::UNITS;
use crate::words::unit;

/// Something that is no number.
pub(in crate::parse) fn no_number(form: &Form, role: Role) -> Problem<'_> {
    let slip = match &form.kind {
        FormKind::String(text)
            if text.starts_with(|c: char| c.is_ascii_digit()) && number(text, 1_000_000).is_ok() =>
        {
            NumberSlip::Quoted(text)
        }
        FormKind::Symbol(symbol) => match &symbol.package {
            // `1:30` is read as a name in a package.
            Some(large) => match (large.parse(), symbol.name.parse()) {
                (Ok(large), Ok(small)) => NumberSlip::Clock(large, small),
                _ => NumberSlip::Other,
            },
            None => suffixed(&symbol.name).map_or(NumberSlip::Other, NumberSlip::Suffixed),
        },
        _ => NumberSlip::Other,
    };
    Problem::Number { form, role, slip }
}

/// A list that is neither a calculation nor a number with a unit.
pub(in crate::parse) fn no_calculation(form: &Form, role: Role) -> Problem<'_> {
    let slip = match form.call() {
        None => infix(form).unwrap_or(NumberSlip::Other),
        Some(("min", [minutes])) => NumberSlip::Min(minutes),
        Some((word, rest)) => match (Operator::of(word), unit(word)) {
            (Some(operator), _) => {
                NumberSlip::Count { of: Calculation::Arithmetic(operator), given: rest.len() }
            }
            (None, Some(_)) => NumberSlip::Count { of: Calculation::Unit(word), given: rest.len() },
            (None, None) => NumberSlip::Unit { word, near: near(word) },
        },
    };
    Problem::Number { form, role, slip }
}

/// The unit or the operator that is meant by a word.
fn near(word: &str) -> Option<&'static str> {
    match word {
        "mins" | "m" => Some("minutes"),
        "secs" | "sec" | "s" => Some("seconds"),
        "hrs" | "hr" | "h" => Some("hours"),
        _ => nearest(word, UNITS.map(|(name, _)| name).into_iter().chain(Operator::ALL.map(Operator::word))),
    }
}

/// `(5 + 3)`.
fn infix(form: &Form) -> Option<NumberSlip<'_>> {
    let [left, operator, right] = form.list()? else { return None };
    operator.word().and_then(Operator::of).map(|_| NumberSlip::Infix { left, operator, right })
}

/// `15s`, `5min`, `5-10` and the like.
pub(crate) fn suffixed(name: &str) -> Option<Suffixed<'_>> {
    let (digits, rest) = split(name)?;
    Some(match rest {
        "s" | "sec" | "secs" | "second" | "seconds" => Suffixed::Seconds(digits),
        "m" | "min" | "mins" | "minute" | "minutes" => Suffixed::Unit("minutes", digits),
        "h" | "hr" | "hrs" | "hour" | "hours" => Suffixed::Unit("hours", digits),
        "d" | "day" | "days" => Suffixed::Unit("days", digits),
        "ms" => Suffixed::Milliseconds(digits),
        _ => Suffixed::Range(digits, upper(rest)?),
    })
}

/// A name that begins like a number: that number, and what follows.
fn split(name: &str) -> Option<(&str, &str)> {
    let other = |c: char| !c.is_ascii_digit() && c != '.';
    let at = name.find("..").or_else(|| name.find(other)).filter(|at| *at > 0)?;
    Some(name.split_at(at)).filter(|(digits, _)| digits.starts_with(|c: char| c.is_ascii_digit()))
}

/// What follows the dash or the points of a range.
fn upper(rest: &str) -> Option<&str> {
    let most = rest.trim_start_matches(['-', '.', '\u{2013}']);
    (most.len() < rest.len() && most.starts_with(|c: char| c.is_ascii_digit())).then_some(most)
}

/// A range such as `5-10`, where two numbers are expected.
pub(super) fn range(form: &Form) -> Option<NumberSlip<'_>> {
    match suffixed(&form.symbol().filter(|symbol| symbol.package.is_none())?.name)? {
        Suffixed::Range(least, most) if number(most, 1_000_000).is_ok() => {
            Some(NumberSlip::Range(least, most))
        }
        _ => None,
    }
}

/// True for a time of day, `14:00`, which is read as a name in a package.
pub(in crate::parse) fn is_clock(form: &Form) -> bool {
    let number = |text: &str| text.parse::<u32>().is_ok();
    form.symbol().is_some_and(|symbol| symbol.package.as_deref().is_some_and(number) && number(&symbol.name))
}

/// A number that would have to be rounded, or is larger than a duration can be.
pub(in crate::parse) fn inexact<'a>(
    form: &'a Form,
    role: Role,
    text: &'a str,
    error: ParseDurationError,
) -> Problem<'a> {
    let slip = match error {
        ParseDurationError::TooPrecise => NumberSlip::NotExact(text),
        ParseDurationError::TooLarge => NumberSlip::TooLarge,
        ParseDurationError::NotANumber => return no_number(form, role),
    };
    Problem::Number { form, role, slip }
}
