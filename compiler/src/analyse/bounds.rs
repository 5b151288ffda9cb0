//! Bounds and durations: names to numbers, and whether the numbers make sense together.

use kirk_network::{Bound, Duration};

use super::Analyser;
use crate::ast::{self, Limits};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::clip;
use crate::source::Span;
use crate::typed::{Amount, AmountValue, Bounds, Timing};

impl Analyser<'_> {
    /// How long the primitive program at hand takes.
    pub(super) fn timing(&mut self) -> Timing {
        let definition = self.definition;
        let nothing = |span| Amount { value: AmountValue::Known(Bound::Finite(Duration::ZERO)), span };
        let Some(duration) = &definition.duration else {
            let span = definition.name.span;
            let upper = Amount { value: AmountValue::Known(Bound::Infinite), span };
            let delay = Bounds { lower: nothing(span), upper: nothing(span), span };
            return Timing { bounds: Bounds { lower: nothing(span), upper, span }, contingent: false, delay };
        };
        let bounds = self.bounds(&duration.bounds, Limits::Duration);
        let name = clip(&definition.name.name);
        if duration.contingent && bounds.upper.value.is(Bound::Infinite) {
            self.problems.push(
                Diagnostic::error(
                    Code::ContingentUnbounded,
                    duration.bounds.upper.as_ref().map_or(duration.bounds.span, |upper| upper.span),
                    format!("the contingent duration of `{name}` has no upper bound"),
                )
                .primary("Nature could take forever")
                .help("Nothing could be promised about what comes after it: give the longest time it may take as `:upper-bound`."),
            );
        }
        let span = duration.bounds.span;
        let mut delay = Bounds { lower: nothing(span), upper: nothing(span), span };
        if let Some(written) = &duration.delay {
            if !duration.contingent {
                let (at, label, help, edit) = match duration.contingent_nil {
                    Some(nil) => (
                        nil,
                        "not contingent, as is said here",
                        "Change `:contingent nil` to `:contingent t`, or take the delay out.",
                        Edit::replace(nil, "t"),
                    ),
                    None => (
                        duration.span,
                        "`:contingent t` is missing in this duration",
                        "Add `:contingent t` after `(simple ...)`, or take the delay out.",
                        Edit::after(duration.bounds.span, " :contingent t"),
                    ),
                };
                self.problems.push(
                    Diagnostic::error(
                        Code::DelayNotContingent,
                        written.span,
                        format!("the end of `{name}` has an observation delay but is not contingent"),
                    )
                    .primary("only what Nature decides has to be observed")
                    .label(at, label)
                    .help(help)
                    .suggest("Let Nature decide: `:contingent t`", [edit]),
                );
            }
            delay = self.delay(written);
        }
        Timing { bounds, contingent: duration.contingent, delay }
    }

    /// Resolves both bounds, which are not negative; a missing lower bound is 0, a missing upper bound none.
    pub(super) fn bounds(&mut self, written: &ast::Bounds, limits: Limits) -> Bounds {
        let bounds = self.signed_bounds(written, limits);
        let [low, high] = limits.words();
        let both = [(&bounds.lower, &written.lower, low), (&bounds.upper, &written.upper, high)];
        for (amount, written, what) in both {
            if let Some(problem) = amount.value.seconds().and_then(|value| negative(value, amount.span, what))
            {
                let problem = self.with_definition(problem, written.as_ref());
                self.problems.push(problem);
            }
        }
        bounds
    }

    /// Resolves both bounds.
    pub(super) fn signed_bounds(&mut self, written: &ast::Bounds, limits: Limits) -> Bounds {
        let [low, high] = limits.words();
        let lower = self.amount(written.lower.as_ref(), Bound::Finite(Duration::ZERO), written.span, low);
        let upper = self.amount(written.upper.as_ref(), Bound::Infinite, written.span, high);
        let bounds = Bounds { lower, upper, span: written.span };
        if bounds.lower.value.is(Bound::Infinite) {
            self.problems.push(
                Diagnostic::error(Code::InfiniteLower, bounds.lower.span, format!("{low} is infinite"))
                    .primary("this would never be over")
                    .help("Only an upper bound may be `:infinity`."),
            );
        } else if let (Some(least), Some(most)) = (bounds.lower.value.seconds(), bounds.upper.value.seconds())
            && let Some(problem) = reversed(least, most, &bounds, limits)
        {
            let help = "Without a `:lower-bound`, it is 0: the first event comes first. For the other way round, swap the two events.";
            let problem = match (&written.lower, &written.upper) {
                (None, _) => problem.primary("no lower bound is given").help(help),
                (Some(lower), Some(upper)) => {
                    let (lower, upper) = (lower.span, upper.span);
                    problem.suggest("Swap the bounds", [Edit::copy(lower, upper), Edit::copy(upper, lower)])
                }
                (Some(_), None) => problem,
            };
            let problem = self.with_definition(problem, written.lower.as_ref());
            let problem = self.with_definition(problem, written.upper.as_ref());
            self.problems.push(problem);
        }
        bounds
    }

    /// Shows where a named number is defined, if that is what is written.
    fn with_definition(&self, problem: Diagnostic, written: Option<&ast::Amount>) -> Diagnostic {
        let Some(ast::Amount { kind: ast::AmountKind::Named(name), .. }) = written else { return problem };
        if name.package.is_none() && self.scope.iter().any(|variable| variable.name == name.name) {
            return problem;
        }
        match self.names.number(name, &self.definition.home) {
            Some(index) => problem.label(
                self.program.parameters[index].name.span,
                format!("`{}` is defined here", clip(&name.name)),
            ),
            None => problem,
        }
    }

    fn delay(&mut self, written: &ast::Bounds) -> Bounds {
        let [_, high] = Limits::ObservationDelay.words();
        let mut bounds = self.bounds(written, Limits::ObservationDelay);
        if written.upper.is_none() {
            bounds.upper.value = AmountValue::Known(Bound::Finite(Duration::ZERO));
            if !bounds.lower.value.is(Bound::Finite(Duration::ZERO)) {
                self.problems.push(
                    Diagnostic::error(Code::DelayReversed, written.span, format!("{high} is missing"))
                        .primary("only the shortest one is given")
                        .help("Add `:max-observation-delay`; `:infinity` says that the news may never come."),
                );
            }
        }
        bounds
    }

    fn amount(&mut self, written: Option<&ast::Amount>, absent: Bound, around: Span, what: &str) -> Amount {
        let Some(written) = written else {
            return Amount { value: AmountValue::Known(absent), span: around };
        };
        let mut resolver = self.resolver();
        let expression = resolver.amount(written);
        Amount { value: resolver.known(&expression, what), span: written.span }
    }
}

/// Says that a duration is negative, if it is.
pub(crate) fn negative(value: Duration, span: Span, what: &str) -> Option<Diagnostic> {
    (value < Duration::ZERO).then(|| {
        Diagnostic::error(Code::Negative, span, format!("{what} is negative"))
            .primary(format!("{value} s"))
            .help("A bound says how much time passes from a start to an end, which is never less than 0.")
    })
}

/// Says that the least is more than the most, if it is.
pub(crate) fn reversed(
    least: Duration,
    most: Duration,
    bounds: &Bounds,
    limits: Limits,
) -> Option<Diagnostic> {
    let code = match limits {
        Limits::ObservationDelay => Code::DelayReversed,
        Limits::Duration | Limits::Wait => Code::LowerAboveUpper,
    };
    let [low, high] = limits.words();
    (least > most).then(|| {
        Diagnostic::error(code, bounds.lower.span, format!("{low} ({least} s) is above {high} ({most} s)"))
            .primary("this is the larger one")
            .label(bounds.upper.span, "this is the smaller one")
            .help("No duration is as long as the one and as short as the other: are they swapped?")
    })
}
