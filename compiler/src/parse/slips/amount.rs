//! Numbers with a unit behind them, in quotation marks, as a range or a time of day; calculations written as in a book.

use kirk_network::ParseDurationError;

use super::{head, text_of};
use crate::calculate::Operator;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::parse::amount::number;
use crate::source::Span;
use crate::words::UNITS;
use crate::words::unit;

/// Something that is no number. `what` it should be is named in the message.
pub(in crate::parse) fn no_number(form: &Form, what: &str) -> Diagnostic {
    let problem = Diagnostic::error(Code::NotANumber, form.span, format!("{what} is not a number"))
        .primary(format!("a duration was expected, not {}", form.describe()))
        .help("Write seconds (`15`, `1.5`, `1/2`), a unit (`(minutes 5)`), a named number (`*wait*`) or `:infinity`.");
    match &form.kind {
        FormKind::String(text)
            if text.starts_with(|c: char| c.is_ascii_digit()) && number(text, 1_000_000).is_ok() =>
        {
            problem.help(format!("Take the quotation marks out: `{}`.", clip(text))).change(form.span, text)
        }
        FormKind::Symbol(symbol) => match &symbol.package {
            Some(hours) => clock(problem, form.span, hours, &symbol.name),
            None => suffixed(problem, form.span, &symbol.name),
        },
        _ => problem,
    }
}

/// A list that is neither a calculation nor a number with a unit.
pub(in crate::parse) fn no_calculation(form: &Form, what: &str) -> Diagnostic {
    let Some((word, rest)) = form.call() else { return infix(form, no_number(form, what)) };
    let example = match (Operator::of(word).map(Operator::takes), unit(word)) {
        (Some((_, most)), _) => format!("({word} x{})", if most > 1 { " 1" } else { "" }),
        (None, Some(_)) => format!("({word} 5)"),
        (None, None) => return no_unit(form, word, what),
    };
    let number = match Operator::of(word).map_or((1, 1), Operator::takes) {
        (1, 1) => "one number",
        (2, 2) => "two numbers",
        (2, _) => "two numbers or more",
        _ => "at least one number",
    };
    let message = format!("`{word}` takes {number}, not {}", rest.len());
    let problem = Diagnostic::error(Code::WrongShape, head(form), message)
        .primary("in this calculation")
        .help(format!("Write `{example}`."));
    match (word, rest) {
        ("min", [minutes]) => problem
            .help(format!("Minutes are written `(minutes {})`.", text_of(minutes)))
            .change(head(form), "minutes"),
        _ => problem,
    }
}

fn no_unit(form: &Form, word: &str, what: &str) -> Diagnostic {
    let near = UNITS.iter().map(|(name, _)| *name).chain(Operator::ALL.map(Operator::word));
    let meant = match word {
        "mins" | "m" => Some("minutes"),
        "secs" | "sec" | "s" => Some("seconds"),
        "hrs" | "hr" | "h" => Some("hours"),
        _ => nearest(word, near),
    };
    let message = format!("`{}` is neither a unit of time nor arithmetic", clip(word));
    Diagnostic::error(Code::UnknownUnit, form.span, message)
        .primary(format!("{what} was expected"))
        .help("The units are `(microseconds 250)`, `(seconds 90)`, `(minutes 5)`, `(hours 1.5)` and `(days 1)`; arithmetic is `+`, `-`, `*`, `/`, `1+`, `1-`, `min`, `max` and `mod`.")
        .meant(head(form), meant)
}

/// `(5 + 3)`.
fn infix(form: &Form, problem: Diagnostic) -> Diagnostic {
    let Some([left, operator, right]) = form.list() else { return problem };
    let Some(word) = operator.word().filter(|word| Operator::of(word).is_some()) else { return problem };
    problem
        .help(format!("The operator comes first: `({word} {} {})`.", text_of(left), text_of(right)))
        .suggest(
            format!("Write `{word}` first"),
            [
                Edit::before(left.span, format!("{word} ")),
                Edit::replace(Span { start: left.span.end, ..operator.span }, ""),
            ],
        )
}

/// `1:30`, which is read as a name in a package.
fn clock(problem: Diagnostic, span: Span, before: &str, after: &str) -> Diagnostic {
    let (Ok(large), Ok(small)) = (before.parse::<u32>(), after.parse::<u32>()) else { return problem };
    let minutes = match small {
        0 => format!("(minutes {large})"),
        _ => format!("(+ (minutes {large}) {small})"),
    };
    let hours = match small {
        0 => format!("(hours {large})"),
        _ => format!("(+ (hours {large}) (minutes {small}))"),
    };
    problem
        .primary("a duration was expected, not a time with a colon")
        .help(format!(
            "Write `{minutes}` for minutes and seconds, `{hours}` for hours and minutes. Kirk counts from the start of the \
             mission and knows no time of day."
        ))
        .change(span, minutes)
        .change(span, hours)
}

/// `15s`, `5min`, `5-10` and the like.
pub(crate) fn suffixed(problem: Diagnostic, span: Span, name: &str) -> Diagnostic {
    let Some((digits, rest)) = split(name) else { return problem };
    let written = match rest {
        "s" | "sec" | "secs" | "second" | "seconds" => {
            return problem
                .help(format!("A plain number is seconds: write `{digits}`."))
                .change(span, digits);
        }
        "m" | "min" | "mins" | "minute" | "minutes" => format!("(minutes {digits})"),
        "h" | "hr" | "hrs" | "hour" | "hours" => format!("(hours {digits})"),
        "d" | "day" | "days" => format!("(days {digits})"),
        "ms" => format!("(microseconds {digits}000)"),
        _ => match upper(rest) {
            Some(most) => {
                let most = clip(most);
                return problem.help(format!(
                    "The shortest and the longest time are two numbers: `{digits}` and `{most}`."
                ));
            }
            None => return problem,
        },
    };
    problem.help(format!("Write `{written}`.")).change(span, written)
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
pub(super) fn range(form: &Form) -> Option<Diagnostic> {
    let (least, rest) = split(&form.symbol().filter(|symbol| symbol.package.is_none())?.name)?;
    let most = upper(rest).filter(|most| number(most, 1_000_000).is_ok())?;
    Some(no_number(form, "the shortest wait").change(form.span, format!("{least} {most}")))
}

/// True for a time of day, `14:00`, which is read as a name in a package.
pub(in crate::parse) fn is_clock(form: &Form) -> bool {
    let number = |text: &str| text.parse::<u32>().is_ok();
    form.symbol().is_some_and(|symbol| symbol.package.as_deref().is_some_and(number) && number(&symbol.name))
}

/// A number that would have to be rounded, or is larger than a duration can be.
pub(in crate::parse) fn inexact(
    form: &Form,
    what: &str,
    text: &str,
    error: ParseDurationError,
) -> Diagnostic {
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
        ParseDurationError::NotANumber => no_number(form, what),
    }
}
