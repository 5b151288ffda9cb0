//! Bounds and durations: names to numbers, and whether the numbers make sense together.

use kirk_network::{Bound, Duration};

use super::Analyser;
use crate::ast::{self, AmountKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::problem::Problems;
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
        let bounds = self.bounds(&duration.bounds, "the lower bound", "the upper bound");
        let name = clip(&definition.name.name);
        if duration.contingent && bounds.upper.value == AmountValue::Known(Bound::Infinite) {
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
                self.problems.push(
                    Diagnostic::error(
                        Code::DelayNotContingent,
                        written.span,
                        format!("the end of `{name}` has an observation delay but is not contingent"),
                    )
                    .primary("only what Nature decides has to be observed")
                    .label(duration.span, "`:contingent t` is missing in this duration")
                    .help("Add `:contingent t` after `(simple ...)`, or take the delay out."),
                );
            }
            delay = self.delay(written);
        }
        Timing { bounds, contingent: duration.contingent, delay }
    }

    /// Resolves both bounds; a missing lower bound is 0, a missing upper bound none.
    pub(super) fn bounds(&mut self, written: &ast::Bounds, low: &str, high: &str) -> Bounds {
        let lower = self.amount(written.lower.as_ref(), Bound::Finite(Duration::ZERO), written.span);
        let upper = self.amount(written.upper.as_ref(), Bound::Infinite, written.span);
        let bounds = Bounds { lower, upper, span: written.span };
        if lower.value == AmountValue::Known(Bound::Infinite) {
            self.problems.push(
                Diagnostic::error(Code::InfiniteLower, lower.span, format!("{low} is infinite"))
                    .primary("this would never be over")
                    .help("Only an upper bound may be `:infinity`."),
            );
        } else if let (Some(least), Some(most)) = (lower.value.seconds(), upper.value.seconds())
            && let Some(problem) = reversed(least, most, bounds, low, high)
        {
            self.problems.push(problem);
        }
        bounds
    }

    fn delay(&mut self, written: &ast::Bounds) -> Bounds {
        let (low, high) = ("the shortest observation delay", "the longest observation delay");
        let mut bounds = self.bounds(written, low, high);
        if written.upper.is_none() {
            bounds.upper.value = AmountValue::Known(Bound::Finite(Duration::ZERO));
            if bounds.lower.value != AmountValue::Known(Bound::Finite(Duration::ZERO)) {
                self.problems.push(
                    Diagnostic::error(Code::DelayReversed, written.span, format!("{high} is missing"))
                        .primary("only the shortest one is given")
                        .help("Add `:max-observation-delay`; `:infinity` says that the news may never come."),
                );
            }
        }
        bounds
    }

    fn amount(&mut self, written: Option<&ast::Amount>, absent: Bound, around: Span) -> Amount {
        let Some(written) = written else {
            return Amount { value: AmountValue::Known(absent), span: around };
        };
        let value = match &written.kind {
            AmountKind::Number(number) => AmountValue::Known(Bound::Finite(*number)),
            AmountKind::Infinite => AmountValue::Known(Bound::Infinite),
            AmountKind::Error => AmountValue::Error,
            AmountKind::Named(name) => match self.parameter(name) {
                Some(index) => AmountValue::Parameter(index),
                None => match self.names.number(name, &self.definition.home) {
                    Some(number) => match &self.program.parameters[number].value.kind {
                        AmountKind::Number(number) => AmountValue::Known(Bound::Finite(*number)),
                        AmountKind::Infinite => AmountValue::Known(Bound::Infinite),
                        AmountKind::Named(other) => {
                            not_a_number(other.span, &name.name, self.problems);
                            AmountValue::Error
                        }
                        AmountKind::Error => AmountValue::Error,
                    },
                    None => {
                        self.unknown_name(name);
                        AmountValue::Error
                    }
                },
            },
        };
        Amount { value, span: written.span }
    }
}

/// Says that the least is more than the most, if it is.
pub(crate) fn reversed(
    least: Duration,
    most: Duration,
    bounds: Bounds,
    low: &str,
    high: &str,
) -> Option<Diagnostic> {
    let code = if low.contains("delay") { Code::DelayReversed } else { Code::LowerAboveUpper };
    (least > most).then(|| {
        Diagnostic::error(code, bounds.lower.span, format!("{low} ({least} s) is above {high} ({most} s)"))
            .primary("this is the larger one")
            .label(bounds.upper.span, "this is the smaller one")
            .help("No duration is as long as the one and as short as the other: are they swapped?")
    })
}

fn not_a_number(span: Span, name: &str, problems: &mut Problems) {
    problems.push(
        Diagnostic::error(Code::NotANumber, span, format!("the value of `{}` is not a number", clip(name)))
            .primary("a number was expected")
            .help("A named number is given by a number, not by another name."),
    );
}
