//! What is said about numbers and intervals.

use crate::ast::{Ident, Limits, Role, Value, ValueKind};
use crate::calculate::NoResult;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::evaluate::{BadCount, INFINITY, MAX_COUNT, Problem, Reversed, Written};
use crate::form::clip;
use crate::source::Span;

impl From<Problem> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::NotANumber { role, used, variable, value } => not_a_number(role, used, variable, &value),
            Problem::BadCount { number, span, why } => {
                let (code, what, help) = match why {
                    BadCount::Negative => {
                        (Code::BadCount, "negative".to_string(), "To leave the body out, repeat it 0 times.")
                    }
                    BadCount::NotWhole => (
                        Code::BadCount,
                        "no whole number".to_string(),
                        "A body is repeated 0, 1, 2, ... times. To wait for some time, use `(delay 1.5 1.5)`.",
                    ),
                    BadCount::TooMany => (
                        Code::TooManyEpisodes,
                        format!("more than {MAX_COUNT}"),
                        "Every repetition is unfolded before the mission starts. Is this a number of seconds?",
                    ),
                };
                let message = format!("{} is {number}, which is {what}", Role::Count.words());
                Diagnostic::error(code, span, message)
                    .primary("a whole number was expected, and not a large one")
                    .help(help)
            }
            Problem::NoResult { span, why: NoResult::NotExact } => Diagnostic::error(
                Code::NotExact,
                span,
                "the result is not a whole number of microseconds",
            )
            .primary("this would have to be rounded")
            .help("Kirk calculates exactly and never rounds. Multiply before you divide: `(/ (* 2 x) 3)`."),
            Problem::NoResult { span, why: NoResult::TooLarge } => {
                Diagnostic::error(Code::TooLarge, span, "the result is too large")
                    .primary("more than 10 billion seconds")
                    .help("For \"no limit\" leave the bound out or write `:infinity`.")
            }
            Problem::NoResult { span, why: NoResult::DividedByZero } => {
                Diagnostic::error(Code::NotANumber, span, "this divides by zero")
                    .primary("there is no result")
            }
            Problem::InfiniteLower { role, span } => {
                Diagnostic::error(Code::InfiniteLower, span, format!("{} is infinite", role.words()))
                    .primary("this would never be over")
                    .help("Only an upper bound may be `:infinity`.")
            }
            Problem::Negative { role, value, span, defined } => {
                let problem = Diagnostic::error(
                    Code::Negative,
                    span,
                    format!("{} is negative", role.words()),
                )
                .primary(format!("{value} s"))
                .help(
                    "A bound says how much time passes from a start to an end, which is never less than 0.",
                );
                with_definitions(problem, &defined)
            }
            Problem::Reversed(problem) => reversed(&problem),
        }
    }
}

fn reversed(problem: &Reversed) -> Diagnostic {
    let Reversed { limits, least, most, lower, upper, .. } = *problem;
    let code = match limits {
        Limits::ObservationDelay | Limits::Message => Code::DelayReversed,
        Limits::Duration | Limits::Wait => Code::LowerAboveUpper,
    };
    let [low, high] = limits.words();
    let message = format!("{low} ({least} s) is above {high} ({most} s)");
    let told = Diagnostic::error(code, lower, message)
        .primary("this is the larger one")
        .label(upper, "this is the smaller one")
        .help("No duration is as long as the one and as short as the other: are they swapped?");
    let told = match problem.written {
        Written::WithoutLower => told.primary("no lower bound is given").help(
            "Without a `:lower-bound`, it is 0: the first event comes first. For the other way round, swap the two events.",
        ),
        Written::Both => told.suggest("Swap the bounds", [Edit::copy(lower, upper), Edit::copy(upper, lower)]),
        Written::Computed => told,
    };
    with_definitions(told, &problem.defined)
}

fn not_a_number(role: Role, used: Span, variable: Option<String>, value: &Value) -> Diagnostic {
    let what = role.words();
    let in_calculation = role == Role::Operand;
    let message = match (&variable, &value.kind) {
        (_, ValueKind::Name(_, name)) if in_calculation => {
            format!("nothing says what `{}` is, so kirk cannot calculate with it", clip(name))
        }
        (_, ValueKind::Name(_, name)) => {
            format!("nothing says what `{}` is, so {what} is unknown", clip(name))
        }
        (_, ValueKind::Symbol(name)) if name == INFINITY && in_calculation => {
            "`:infinity` is no number to calculate with".to_string()
        }
        (_, ValueKind::Symbol(name)) if name == INFINITY => format!("{what} cannot be `:infinity`"),
        (Some(name), _) => format!("`{}` is not a number here, so it cannot be {what}", clip(name)),
        _ if in_calculation => "kirk can calculate with numbers only".to_string(),
        _ => format!("{what} is not a number"),
    };
    let problem =
        Diagnostic::error(Code::NotANumber, value.span, message).primary("a number was expected here");
    match &variable {
        Some(name) => problem
            .label(used, format!("`{}` is used as {what} here", clip(name)))
            .help("Call the program with a number of seconds."),
        None => problem
            .help("Write a number (`15`, `1.5`), a unit (`(minutes 5)`), or a name that stands for one."),
    }
}

/// Shows where the named numbers are defined.
fn with_definitions(problem: Diagnostic, names: &[Ident]) -> Diagnostic {
    names.iter().fold(problem, |problem, name| {
        problem.label(name.span, format!("`{}` is defined here", clip(&name.name)))
    })
}
