//! What is said about numbers that are none.

use super::{described, wrong};
use crate::ast::Role;
use crate::calculate::Operator;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, clip, text_of};
use crate::parse::problem::{Calculation, NumberSlip, Suffixed};
use crate::source::Span;

pub(super) fn told(form: &Form, role: Role, slip: NumberSlip) -> Diagnostic {
    let what = if role == Role::Operand { "part of this calculation" } else { role.words() };
    let at = form.span;
    match slip {
        NumberSlip::Other => no_number(form, what),
        NumberSlip::Quoted(text) => no_number(form, what)
            .help(format!("Take the quotation marks out: `{}`.", clip(text)))
            .change(at, text),
        NumberSlip::Clock(large, small) => clock(no_number(form, what), at, large, small),
        NumberSlip::Suffixed(number) => suffixed(no_number(form, what), at, number),
        NumberSlip::Range(least, most) => suffixed(no_number(form, what), at, Suffixed::Range(least, most))
            .change(at, format!("{least} {most}")),
        NumberSlip::Infix { left, operator, right } => {
            let word = operator.word().unwrap_or_default();
            no_number(form, what)
                .help(format!("The operator comes first: `({word} {} {})`.", text_of(left), text_of(right)))
                .suggest(
                    format!("Write `{word}` first"),
                    [
                        Edit::before(left.span, format!("{word} ")),
                        Edit::replace(Span { start: left.span.end, ..operator.span }, ""),
                    ],
                )
        }
        NumberSlip::Count { of, given } => wrong_count(form, of, given),
        NumberSlip::Min(minutes) => wrong_count(form, Calculation::Arithmetic(Operator::Minimum), 1)
            .help(format!("Minutes are written `(minutes {})`.", text_of(minutes)))
            .change(form.head(), "minutes"),
        NumberSlip::Unit { word, near } => {
            let message = format!("`{}` is neither a unit of time nor arithmetic", clip(word));
            Diagnostic::error(Code::UnknownUnit, at, message)
                .primary(format!("{what} was expected"))
                .help("The units are `(microseconds 250)`, `(seconds 90)`, `(minutes 5)`, `(hours 1.5)` and `(days 1)`; arithmetic is `+`, `-`, `*`, `/`, `1+`, `1-`, `min`, `max` and `mod`.")
                .meant(form.head(), near)
        }
        NumberSlip::NotExact(text) => Diagnostic::error(
            Code::NotExact,
            at,
            format!("{what} is not a whole number of microseconds"),
        )
        .primary(format!("{} would have to be rounded", clip(text)))
        .help("Kirk counts in microseconds and never rounds a bound: write it with at most six decimals."),
        NumberSlip::TooLarge => Diagnostic::error(Code::TooLarge, at, format!("{what} is too large"))
            .primary("more than 10 billion seconds")
            .help("For \"no limit\" leave the bound out or write `:infinity`."),
    }
}

fn no_number(form: &Form, what: &str) -> Diagnostic {
    Diagnostic::error(Code::NotANumber, form.span, format!("{what} is not a number"))
        .primary(format!("a duration was expected, not {}", described(form)))
        .help("Write seconds (`15`, `1.5`, `1/2`), a unit (`(minutes 5)`), a named number (`*wait*`) or `:infinity`.")
}

fn wrong_count(form: &Form, of: Calculation, given: usize) -> Diagnostic {
    let (word, takes, example) = match of {
        Calculation::Arithmetic(operator) => {
            let example = if operator.takes().1 > 1 { "x 1" } else { "x" };
            (operator.word(), operator.takes(), example)
        }
        Calculation::Unit(word) => (word, (1, 1), "5"),
    };
    let number = match takes {
        (1, 1) => "one number",
        (2, 2) => "two numbers",
        (2, _) => "two numbers or more",
        _ => "at least one number",
    };
    let message = format!("`{word}` takes {number}, not {given}");
    wrong(form.head(), message, "in this calculation", format!("Write `({word} {example})`."))
}

/// `1:30`.
fn clock(problem: Diagnostic, at: Span, large: u32, small: u32) -> Diagnostic {
    let (minutes, hours) = match small {
        0 => (format!("(minutes {large})"), format!("(hours {large})")),
        _ => (format!("(+ (minutes {large}) {small})"), format!("(+ (hours {large}) (minutes {small}))")),
    };
    problem
        .primary("a duration was expected, not a time with a colon")
        .help(format!(
            "Write `{minutes}` for minutes and seconds, `{hours}` for hours and minutes. Kirk counts from the start of the \
             mission and knows no time of day."
        ))
        .change(at, minutes)
        .change(at, hours)
}

/// What to write for `15s`, `5min`, `5-10` and the like.
pub(crate) fn suffixed(problem: Diagnostic, at: Span, number: Suffixed) -> Diagnostic {
    let written = match number {
        Suffixed::Seconds(digits) => {
            return problem.help(format!("A plain number is seconds: write `{digits}`.")).change(at, digits);
        }
        Suffixed::Range(least, most) => {
            return problem.help(format!(
                "The shortest and the longest time are two numbers: `{least}` and `{}`.",
                clip(most)
            ));
        }
        Suffixed::Unit(unit, digits) => format!("({unit} {digits})"),
        Suffixed::Milliseconds(digits) => format!("(microseconds {digits}000)"),
    };
    problem.help(format!("Write `{written}`.")).change(at, written)
}
