//! The value of an expression once its variables are known.

use kirk_network::{Bound, Duration};

use crate::ast::{Value, ValueKind};
use crate::calculate::{NoResult, scale};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::source::Span;
use crate::typed::{Expression, ExpressionKind};

/// How `:infinity` is carried along as a value.
pub(crate) const INFINITY: &str = ":infinity";

/// How many repetitions one `dotimes` may ask for.
pub(crate) const MAX_COUNT: u64 = crate::episode::MAX_EPISODES;

/// What a number inside of a calculation is called.
const NUMBER: &str = "part of a calculation";

/// What is wrong; `None` if that has been reported.
pub(crate) type Wrong = Option<Box<Diagnostic>>;

/// The value, or what is wrong with it.
pub(crate) fn evaluate(expression: &Expression, variables: &[Value]) -> Result<Value, Wrong> {
    let span = expression.span;
    let kind = match &expression.kind {
        ExpressionKind::Value(kind) => kind.clone(),
        ExpressionKind::Variable(index, _) => return variables.get(*index).cloned().ok_or(None),
        ExpressionKind::Error => return Err(None),
        ExpressionKind::Scaled(unit, inner) => {
            let number = number(inner, variables, NUMBER)?;
            ValueKind::Number(scale(number, *unit).map_err(|why| Some(no_result(span, why).into()))?)
        }
        ExpressionKind::Calculated(operator, parts) => {
            let numbers: Result<Vec<Duration>, _> =
                parts.iter().map(|part| number(part, variables, NUMBER)).collect();
            ValueKind::Number(operator.apply(&numbers?).map_err(|why| Some(no_result(span, why).into()))?)
        }
    };
    Ok(Value { kind, span })
}

/// The value as a bound, called `what` in messages.
pub(crate) fn bound(expression: &Expression, variables: &[Value], what: &str) -> Result<Bound, Wrong> {
    let value = evaluate(expression, variables)?;
    match &value.kind {
        ValueKind::Symbol(name) if name == INFINITY => Ok(Bound::Infinite),
        ValueKind::Number(number) => Ok(Bound::Finite(*number)),
        _ => Err(Some(not_a_number(expression, &value, what).into())),
    }
}

/// The value as a number of repetitions.
pub(crate) fn count(expression: &Expression, variables: &[Value]) -> Result<u64, Wrong> {
    let what = "the number of repetitions";
    let number = number(expression, variables, what)?;
    let bad = |code, problem: &str| {
        Diagnostic::error(code, expression.span, format!("{what} is {number}, which is {problem}"))
            .primary("a whole number was expected, and not a large one")
    };
    if number < Duration::ZERO {
        let help = "To leave the body out, repeat it 0 times.";
        return Err(Some(bad(Code::BadCount, "negative").help(help).into()));
    }
    if number.as_micros() % 1_000_000 != 0 {
        let help = "A body is repeated 0, 1, 2, ... times. To wait for some time, use `(delay 1.5 1.5)`.";
        return Err(Some(bad(Code::BadCount, "no whole number").help(help).into()));
    }
    let times = (number.as_micros() / 1_000_000).unsigned_abs();
    if times > MAX_COUNT {
        let help = "Every repetition is unfolded before the mission starts. Is this a number of seconds?";
        let problem = bad(Code::TooManyEpisodes, &format!("more than {MAX_COUNT}"));
        return Err(Some(problem.help(help).into()));
    }
    Ok(times)
}

/// The value as a number, called `what` in messages.
fn number(expression: &Expression, variables: &[Value], what: &str) -> Result<Duration, Wrong> {
    let value = evaluate(expression, variables)?;
    match value.kind {
        ValueKind::Number(number) => Ok(number),
        _ => Err(Some(not_a_number(expression, &value, what).into())),
    }
}

fn not_a_number(expression: &Expression, value: &Value, what: &str) -> Diagnostic {
    let message = match (&expression.kind, &value.kind) {
        (_, ValueKind::Name(_, name)) => match what {
            NUMBER => format!("nothing says what `{}` is, so kirk cannot calculate with it", clip(name)),
            _ => format!("nothing says what `{}` is, so {what} is unknown", clip(name)),
        },
        (_, ValueKind::Symbol(name)) if name == INFINITY && what == NUMBER => {
            "`:infinity` is no number to calculate with".into()
        }
        (_, ValueKind::Symbol(name)) if name == INFINITY => format!("{what} cannot be `:infinity`"),
        (ExpressionKind::Variable(_, name), _) => {
            format!("`{}` is not a number here, so it cannot be {what}", clip(name))
        }
        _ if what == NUMBER => "kirk can calculate with numbers only".to_string(),
        _ => format!("{what} is not a number"),
    };
    let problem =
        Diagnostic::error(Code::NotANumber, value.span, message).primary("a number was expected here");
    match &expression.kind {
        ExpressionKind::Variable(_, name) => problem
            .label(expression.span, format!("`{}` is used as {what} here", clip(name)))
            .help("Call the program with a number of seconds."),
        _ => problem
            .help("Write a number (`15`, `1.5`), a unit (`(minutes 5)`), or a name that stands for one."),
    }
}

fn no_result(span: Span, why: NoResult) -> Diagnostic {
    match why {
        NoResult::NotExact => {
            Diagnostic::error(Code::NotExact, span, "the result is not a whole number of microseconds")
                .primary("this would have to be rounded")
                .help(
                    "Kirk calculates exactly and never rounds. Multiply before you divide: `(/ (* 2 x) 3)`.",
                )
        }
        NoResult::TooLarge => Diagnostic::error(Code::TooLarge, span, "the result is too large")
            .primary("more than 10 billion seconds")
            .help("For \"no limit\" leave the bound out or write `:infinity`."),
        NoResult::DividedByZero => {
            Diagnostic::error(Code::NotANumber, span, "this divides by zero").primary("there is no result")
        }
    }
}
