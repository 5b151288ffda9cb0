//! The value of an expression once its variables are known.

use kirk_network::{Bound, Duration};

use crate::ast::{Ident, Limits, Role, Value, ValueKind};
use crate::calculate::{NoResult, scale};
use crate::source::Span;
use crate::typed::{Expression, ExpressionKind};

/// How `:infinity` is carried along as a value.
pub(crate) const INFINITY: &str = ":infinity";

/// How many repetitions one `dotimes` may ask for.
pub(crate) const MAX_COUNT: u64 = crate::episode::MAX_EPISODES;

/// What is wrong with a number or an interval, and what is known about it.
pub(crate) enum Problem {
    /// Something else, where it is used, and the variable it is, whose value was given elsewhere.
    NotANumber { role: Role, used: Span, variable: Option<String>, value: Value },
    /// Nothing can be repeated so many times.
    BadCount { number: Duration, span: Span, why: BadCount },
    /// A calculation without a result.
    NoResult { span: Span, why: NoResult },
    /// A lower bound that is infinite.
    InfiniteLower { role: Role, span: Span },
    /// A negative bound, with the named number that is written there.
    Negative { role: Role, value: Duration, span: Span, defined: Vec<Ident> },
    /// The least is more than the most.
    Reversed(Reversed),
}

/// An interval whose least is more than its most.
pub(crate) struct Reversed {
    pub(crate) limits: Limits,
    pub(crate) least: Duration,
    pub(crate) most: Duration,
    pub(crate) lower: Span,
    pub(crate) upper: Span,
    pub(crate) written: Written,
    /// The named numbers that are written there.
    pub(crate) defined: Vec<Ident>,
}

/// Why something cannot be repeated so many times.
pub(crate) enum BadCount {
    Negative,
    NotWhole,
    TooMany,
}

/// How an interval is written, as far as that says what is wrong with it.
pub(crate) enum Written {
    Both,
    WithoutLower,
    /// With variables, whose values are given elsewhere.
    Computed,
}

/// What is wrong; `None` if that has been reported.
pub(crate) type Wrong = Option<Box<Problem>>;

/// The value, or what is wrong with it.
pub(crate) fn evaluate(expression: &Expression, variables: &[Value]) -> Result<Value, Wrong> {
    let span = expression.span;
    let kind = match &expression.kind {
        ExpressionKind::Value(kind) => kind.clone(),
        ExpressionKind::Variable(index, _) => return variables.get(*index).cloned().ok_or(None),
        ExpressionKind::Error => return Err(None),
        ExpressionKind::Scaled(unit, inner) => ValueKind::Number(
            scale(number(inner, variables, Role::Operand)?, *unit).map_err(no_result(span))?,
        ),
        ExpressionKind::Calculated(operator, parts) => {
            let numbers: Result<Vec<Duration>, _> =
                parts.iter().map(|part| number(part, variables, Role::Operand)).collect();
            ValueKind::Number(operator.apply(&numbers?).map_err(no_result(span))?)
        }
    };
    Ok(Value { kind, span })
}

/// The value as a bound.
pub(crate) fn bound(expression: &Expression, variables: &[Value], role: Role) -> Result<Bound, Wrong> {
    let value = evaluate(expression, variables)?;
    match &value.kind {
        ValueKind::Symbol(name) if name == INFINITY => Ok(Bound::Infinite),
        ValueKind::Number(number) => Ok(Bound::Finite(*number)),
        _ => Err(not_a_number(expression, value, role)),
    }
}

/// The value as a number of repetitions.
pub(crate) fn count(expression: &Expression, variables: &[Value]) -> Result<u64, Wrong> {
    let number = number(expression, variables, Role::Count)?;
    let bad = |why| Err(Some(Problem::BadCount { number, span: expression.span, why }.into()));
    if number < Duration::ZERO {
        return bad(BadCount::Negative);
    }
    match number.whole_seconds().map(i64::unsigned_abs) {
        None => bad(BadCount::NotWhole),
        Some(times) if times > MAX_COUNT => bad(BadCount::TooMany),
        Some(times) => Ok(times),
    }
}

fn number(expression: &Expression, variables: &[Value], role: Role) -> Result<Duration, Wrong> {
    let value = evaluate(expression, variables)?;
    match value.kind {
        ValueKind::Number(number) => Ok(number),
        _ => Err(not_a_number(expression, value, role)),
    }
}

fn not_a_number(expression: &Expression, value: Value, role: Role) -> Wrong {
    let variable = match &expression.kind {
        ExpressionKind::Variable(_, name) => Some(name.clone()),
        _ => None,
    };
    Some(Problem::NotANumber { role, used: expression.span, variable, value }.into())
}

fn no_result(span: Span) -> impl Fn(NoResult) -> Wrong {
    move |why| Some(Problem::NoResult { span, why }.into())
}
