//! Intervals with their numbers: variables are replaced by what they stand for, and the result is checked.

use kirk_network::{Bound, Duration};

use super::problem::Problem;
use super::{Expander, Frame};
use crate::ast::{Limits, Role, Value, ValueKind};
use crate::episode::Range;
use crate::evaluate::{self, Reversed, Written};
use crate::source::Span;
use crate::typed::{Amount, AmountValue, Bounds, Expression, ExpressionKind};

impl Expander<'_> {
    /// The numbers of an interval of durations, which are not negative.
    pub(super) fn interval(&mut self, bounds: &Bounds, frame: &Frame<'_>, limits: Limits) -> Range {
        let mut interval = self.signed_interval(bounds, frame, limits);
        let both = [
            (&bounds.lower, Some(interval.lower), Role::Lower(limits)),
            (&bounds.upper, interval.upper.finite(), Role::Upper(limits)),
        ];
        for (amount, value, role) in both {
            // What was known before has been reported before.
            if let (Some(value), AmountValue::Computed(expression)) = (value, &amount.value)
                && value < Duration::ZERO
            {
                let span = argument(expression, frame, amount.span);
                self.wrong(evaluate::Problem::Negative { role, value, span, defined: Vec::new() }, frame);
            }
        }
        interval.lower = interval.lower.max(Duration::ZERO);
        if let Bound::Finite(upper) = interval.upper {
            interval.upper = Bound::Finite(upper.max(interval.lower));
        }
        interval
    }

    /// The numbers of an interval.
    pub(super) fn signed_interval(&mut self, bounds: &Bounds, frame: &Frame<'_>, limits: Limits) -> Range {
        let low = Role::Lower(limits);
        let lower = match self.bound(&bounds.lower, frame, low) {
            Some(Bound::Finite(lower)) => lower,
            Some(Bound::Infinite) => {
                self.wrong(evaluate::Problem::InfiniteLower { role: low, span: bounds.lower.span }, frame);
                Duration::ZERO
            }
            None => Duration::ZERO,
        };
        let mut upper = self.bound(&bounds.upper, frame, Role::Upper(limits)).unwrap_or(Bound::Finite(lower));
        let (lower_span, upper_span) = (bounds.lower.span, bounds.upper.span);
        if let Bound::Finite(most) = upper
            && lower > most
        {
            let problem = Reversed {
                limits,
                least: lower,
                most,
                lower: lower_span,
                upper: upper_span,
                written: Written::Computed,
                defined: Vec::new(),
            };
            self.wrong(evaluate::Problem::Reversed(problem), frame);
            upper = Bound::Finite(lower);
        }
        Range { lower, upper, lower_span, upper_span, span: bounds.span }
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

    fn bound(&mut self, amount: &Amount, frame: &Frame<'_>, role: Role) -> Option<Bound> {
        match &amount.value {
            AmountValue::Known(bound) => Some(*bound),
            AmountValue::Error => None,
            AmountValue::Computed(expression) => {
                let bound = evaluate::bound(expression, &frame.variables, role);
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
            self.wrong(*problem, frame);
        }
    }

    fn wrong(&mut self, problem: evaluate::Problem, frame: &Frame<'_>) {
        self.problems.push(Problem::Amount { problem, call: frame.call });
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
