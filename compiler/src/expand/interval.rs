//! Intervals with their numbers: variables are replaced by what they stand for, and the result is checked.

use kirk_network::{Bound, Duration};

use super::{Expander, Frame};
use crate::analyse::{negative, reversed};
use crate::ast::{Limits, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::Interval;
use crate::evaluate;
use crate::source::Span;
use crate::typed::{Amount, AmountValue, Bounds, Expression, ExpressionKind};

impl Expander<'_> {
    /// The numbers of an interval of durations, which are not negative.
    pub(super) fn interval(&mut self, bounds: &Bounds, frame: &Frame<'_>, limits: Limits) -> Interval {
        let mut interval = self.signed_interval(bounds, frame, limits);
        let [low, high] = limits.words();
        let both =
            [(&bounds.lower, Some(interval.lower), low), (&bounds.upper, interval.upper.finite(), high)];
        for (amount, value, what) in both {
            // What was known before has been reported before.
            if let (Some(value), AmountValue::Computed(expression)) = (value, &amount.value)
                && let Some(problem) = negative(value, argument(expression, frame, amount.span), what)
            {
                self.problems.push(problem.label(frame.call, "with the arguments of this call"));
            }
        }
        interval.lower = interval.lower.max(Duration::ZERO);
        if let Bound::Finite(upper) = interval.upper {
            interval.upper = Bound::Finite(upper.max(interval.lower));
        }
        interval
    }

    /// The numbers of an interval.
    pub(super) fn signed_interval(&mut self, bounds: &Bounds, frame: &Frame<'_>, limits: Limits) -> Interval {
        let [low, high] = limits.words();
        let lower = match self.bound(&bounds.lower, frame, low) {
            Some(Bound::Finite(lower)) => lower,
            Some(Bound::Infinite) => {
                self.problems.push(
                    Diagnostic::error(Code::InfiniteLower, bounds.lower.span, format!("{low} is infinite"))
                        .primary("this would never be over")
                        .label(frame.call, "with the arguments of this call")
                        .help("Only an upper bound may be `:infinity`."),
                );
                Duration::ZERO
            }
            None => Duration::ZERO,
        };
        let mut upper = self.bound(&bounds.upper, frame, high).unwrap_or(Bound::Finite(lower));
        if let Bound::Finite(most) = upper
            && let Some(problem) = reversed(lower, most, bounds, limits)
        {
            self.problems.push(problem.label(frame.call, "with the arguments of this call"));
            upper = Bound::Finite(lower);
        }
        let (lower_span, upper_span) = (bounds.lower.span, bounds.upper.span);
        Interval { lower, upper, lower_span, upper_span, span: bounds.span }
    }

    /// The values of arguments.
    pub(super) fn values(&mut self, expressions: &[Expression], frame: &Frame<'_>) -> Vec<Value> {
        expressions.iter().map(|expression| self.value(expression, frame)).collect()
    }

    fn value(&mut self, expression: &Expression, frame: &Frame<'_>) -> Value {
        evaluate::evaluate(expression, &frame.variables).unwrap_or_else(|problem| {
            self.report(problem, frame);
            Value { kind: ValueKind::Nil, span: expression.span }
        })
    }

    fn bound(&mut self, amount: &Amount, frame: &Frame<'_>, what: &str) -> Option<Bound> {
        match &amount.value {
            AmountValue::Known(bound) => Some(*bound),
            AmountValue::Error => None,
            AmountValue::Computed(expression) => {
                let bound = evaluate::bound(expression, &frame.variables, what);
                bound.map_err(|problem| self.report(problem, frame)).ok()
            }
        }
    }

    /// How many times, as far as that makes sense.
    pub(super) fn count(&mut self, expression: &Expression, frame: &Frame<'_>) -> u64 {
        evaluate::count(expression, &frame.variables).unwrap_or_else(|problem| {
            self.report(problem, frame);
            0
        })
    }

    fn report(&mut self, problem: evaluate::Wrong, frame: &Frame<'_>) {
        if let Some(problem) = problem {
            let here =
                frame.call == problem.span || problem.labels.iter().any(|label| label.span == frame.call);
            self.problems.push(match here {
                true => *problem,
                false => problem.label(frame.call, "with the arguments of this call"),
            });
        }
    }
}

/// Where the value of a variable was given; of anything else, where it stands.
fn argument(expression: &Expression, frame: &Frame<'_>, otherwise: Span) -> Span {
    match &expression.kind {
        ExpressionKind::Variable(index, _) => {
            frame.variables.get(*index).map_or(otherwise, |value| value.span)
        }
        _ => otherwise,
    }
}
