//! Bounds and durations: names to numbers, and whether the numbers make sense together.

use kirk_network::{Bound, Duration};

use super::expression::Resolver;
use super::problem::Problem;
use super::{Analyser, Variable};
use crate::ast::{self, Ident, Limits, Role};
use crate::evaluate::{self, Reversed, Written};
use crate::source::Span;
use crate::typed::{Amount, AmountValue, Bounds, Timing};

impl Analyser<'_> {
    /// How long the primitive program at hand takes.
    pub(super) fn timing(&mut self) -> Timing {
        let definition = self.definition;
        let nothing = |span| Amount { value: AmountValue::Known(Bound::ZERO), span };
        let Some(duration) = &definition.duration else {
            let span = definition.name.span;
            let upper = Amount { value: AmountValue::Known(Bound::Infinite), span };
            let delay = Bounds { lower: nothing(span), upper: nothing(span), span };
            let bounds = Bounds { lower: nothing(span), upper, span };
            return Timing { bounds, contingent: false, delay, observed_by: None };
        };
        let bounds = self.resolver().bounds(&duration.bounds, Limits::Duration);
        let program = || definition.name.clone();
        if duration.contingent && bounds.upper.value.is(Bound::Infinite) {
            let upper = duration.bounds.upper.as_ref().map_or(duration.bounds.span, |upper| upper.span);
            self.problems.push(Problem::ContingentUnbounded { program: program(), upper });
        }
        let span = duration.bounds.span;
        let mut delay = Bounds { lower: nothing(span), upper: nothing(span), span };
        if let Some(written) = &duration.delay {
            if !duration.contingent {
                self.problems.push(Problem::DelayNotContingent {
                    program: program(),
                    delay: written.span,
                    duration: duration.span,
                    bounds: duration.bounds.span,
                    nil: duration.contingent_nil,
                });
            }
            delay = self.resolver().delay(written, Limits::ObservationDelay);
        }
        if let (Some(observer), false) = (&duration.observed_by, duration.contingent) {
            let observer = observer.span;
            self.problems.push(Problem::ObserverNotContingent { program: program(), observer });
        }
        let observed_by =
            duration.observed_by.as_ref().and_then(|agent| self.resolver().agent(agent)).map(Box::new);
        Timing { bounds, contingent: duration.contingent, delay, observed_by }
    }
}

impl Resolver<'_> {
    /// Resolves both bounds, which are not negative; a missing lower bound is 0, a missing upper bound none.
    pub(super) fn bounds(&mut self, written: &ast::Bounds, limits: Limits) -> Bounds {
        let bounds = self.signed_bounds(written, limits);
        let both = [
            (&bounds.lower, &written.lower, Role::Lower(limits)),
            (&bounds.upper, &written.upper, Role::Upper(limits)),
        ];
        for (amount, written, role) in both {
            if let Some(value) = amount.value.seconds().filter(|value| *value < Duration::ZERO) {
                let defined = self.definition_of(written).into_iter().collect();
                self.wrong(evaluate::Problem::Negative { role, value, span: amount.span, defined });
            }
        }
        bounds
    }

    /// Resolves both bounds.
    pub(super) fn signed_bounds(&mut self, written: &ast::Bounds, limits: Limits) -> Bounds {
        let (zero, low) = (Bound::ZERO, Role::Lower(limits));
        let lower = self.bound(written.lower.as_ref(), zero, written.span, low);
        let upper = self.bound(written.upper.as_ref(), Bound::Infinite, written.span, Role::Upper(limits));
        let bounds = Bounds { lower, upper, span: written.span };
        if bounds.lower.value.is(Bound::Infinite) {
            self.wrong(evaluate::Problem::InfiniteLower { role: low, span: bounds.lower.span });
        } else if let (Some(least), Some(most)) = (bounds.lower.value.seconds(), bounds.upper.value.seconds())
            && least > most
        {
            let defined = [&written.lower, &written.upper].map(|amount| self.definition_of(amount));
            self.wrong(evaluate::Problem::Reversed(Reversed {
                limits,
                least,
                most,
                lower: bounds.lower.span,
                upper: bounds.upper.span,
                written: if written.lower.is_some() { Written::Both } else { Written::WithoutLower },
                defined: defined.into_iter().flatten().collect(),
            }));
        }
        bounds
    }

    fn wrong(&mut self, problem: evaluate::Problem) {
        self.problems.push(Problem::Amount(problem));
    }

    /// The name where it is defined, if a named number is what is written.
    fn definition_of(&self, written: &Option<ast::Amount>) -> Option<Ident> {
        let Some(ast::Amount { kind: ast::AmountKind::Named(name), .. }) = written else { return None };
        let is_variable = |variable: &Variable| name.package.is_none() && variable.name == name.name;
        if self.scope.iter().any(is_variable) {
            return None;
        }
        let index = self.names.number(name, self.home)?;
        Some(self.program.parameters[index].name.clone())
    }

    /// How late news or a message is. Without bounds it is not late at all; if it is, it has to be said how late at the most.
    pub(super) fn delay(&mut self, written: &ast::Bounds, limits: Limits) -> Bounds {
        let mut bounds = self.bounds(written, limits);
        if written.upper.is_none() {
            bounds.upper.value = AmountValue::Known(Bound::ZERO);
            if !bounds.lower.value.is(Bound::ZERO) {
                self.problems.push(Problem::NoLongestDelay { limits, delay: written.span });
            }
        }
        bounds
    }

    fn bound(&mut self, written: Option<&ast::Amount>, absent: Bound, around: Span, role: Role) -> Amount {
        let Some(written) = written else {
            return Amount { value: AmountValue::Known(absent), span: around };
        };
        let expression = self.amount(written);
        Amount { value: self.known(&expression, role), span: written.span }
    }
}
