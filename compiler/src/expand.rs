//! Unfolds the program to start from: every call becomes an episode of its own, with a name of its own.

mod limits;
mod name;

use kirk_network::{Bound, Duration};

use crate::analyse::reversed;
use crate::ast::{Condition, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{Episode, Interval, Kind};
use crate::form::clip;
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Amount, AmountValue, Argument, Body, Bounds, Model, Program, Timing, Work};
use name::Occurrences;

pub use limits::{MAX_DEPTH, MAX_EPISODES};

/// The tree of episodes of the program to start from. Expects a model without errors: in particular no recursion.
pub fn expand(model: &Model, problems: &mut Problems) -> Option<Episode> {
    let entry = model.entry?;
    if !limits::check(model, entry, problems) {
        return None;
    }
    let program = &model.programs[entry];
    if !program.parameters.is_empty() {
        let names: Vec<String> = program.parameters.iter().map(|p| format!("`{}`", clip(&p.name))).collect();
        problems.push(
            Diagnostic::note(
                Code::FreeParameters,
                program.name.span,
                format!("`{}` is started without arguments", clip(&program.name.name)),
            )
            .primary(format!("nothing is known about {}", names.join(" and ")))
            .help("The times do not depend on them. To start with arguments, call it from a program `main`."),
        );
    }
    let free =
        |name: &crate::ast::Ident| Value { kind: ValueKind::Name(None, name.name.clone()), span: name.span };
    let arguments = program.parameters.iter().map(free).collect();
    let mut expander = Expander { model, occurrences: Occurrences::new(model), problems };
    Some(expander.occurrence(entry, arguments, program.name.span))
}

struct Expander<'a> {
    model: &'a Model,
    occurrences: Occurrences,
    problems: &'a mut Problems,
}

/// The program a body belongs to, as it was called.
struct Caller<'a> {
    name: &'a str,
    program: &'a Program,
    arguments: &'a [Value],
    call: Span,
    internal: u32,
}

impl Expander<'_> {
    fn occurrence(&mut self, index: usize, arguments: Vec<Value>, span: Span) -> Episode {
        let program = &self.model.programs[index];
        let mut episode = blank(self.occurrences.of(&program.name.name), Kind::Program, span);
        episode.requires = program.requires.as_ref().map(|c| Box::new(substitute(c, program, &arguments)));
        episode.effect = program.effect.as_ref().map(|c| Box::new(substitute(c, program, &arguments)));
        let name = episode.name.clone();
        let mut caller = Caller { name: &name, program, arguments: &arguments, call: span, internal: 0 };
        match &program.work {
            Work::Primitive(timing) => self.primitive(&mut episode, timing, &caller),
            Work::Body(body) => episode.parts = self.parts(body, &mut caller),
        }
        episode.arguments = arguments.into_iter().map(|value| value.kind).collect();
        episode
    }

    fn primitive(&mut self, episode: &mut Episode, timing: &Timing, caller: &Caller<'_>) {
        episode.kind = Kind::Primitive;
        episode.duration = Some(self.interval(timing.bounds, caller, "the lower bound", "the upper bound"));
        episode.contingent = timing.contingent;
        if timing.contingent {
            let delay = self.interval(
                timing.delay,
                caller,
                "the shortest observation delay",
                "the longest observation delay",
            );
            if delay.lower != Duration::ZERO || delay.upper != Bound::Finite(Duration::ZERO) {
                episode.delay = Some(delay);
            }
        }
    }

    fn parts(&mut self, body: &[Body], caller: &mut Caller<'_>) -> Vec<Episode> {
        body.iter().map(|part| self.part(part, caller)).collect()
    }

    fn part(&mut self, body: &Body, caller: &mut Caller<'_>) -> Episode {
        match body {
            Body::Call { program, arguments, span } => {
                let arguments = arguments.iter().map(|argument| match argument {
                    Argument::Value(value) => value.clone(),
                    Argument::Parameter(index) => caller.arguments[*index].clone(),
                });
                self.occurrence(*program, arguments.collect(), *span)
            }
            Body::Group { parallel, slack, body, operator } => {
                let kind = if *parallel { Kind::Parallel } else { Kind::Sequence };
                let mut episode = self.internal(kind, *operator, caller);
                episode.slack = Some(*slack);
                episode.parts = self.parts(body, caller);
                episode
            }
            Body::Within { bounds, body, operator } => {
                let mut episode = self.internal(Kind::WithTemporalConstraint, *operator, caller);
                episode.duration = Some(self.interval(*bounds, caller, "the lower bound", "the upper bound"));
                episode.parts = self.parts(body, caller);
                episode
            }
        }
    }

    fn internal(&mut self, kind: Kind, span: Span, caller: &mut Caller<'_>) -> Episode {
        let name = self.occurrences.inside(caller.name, &mut caller.internal);
        Episode { internal: true, ..blank(name, kind, span) }
    }

    /// The numbers of an interval; parameters are replaced by what the program was called with, and checked.
    fn interval(&mut self, bounds: Bounds, caller: &Caller<'_>, low: &str, high: &str) -> Interval {
        let lower = self.bound(bounds.lower, caller, low).finite().unwrap_or(Duration::ZERO);
        let mut upper = self.bound(bounds.upper, caller, high);
        if let Bound::Finite(most) = upper
            && let Some(problem) = reversed(lower, most, bounds, low, high)
        {
            self.problems.push(problem.label(caller.call, "with the arguments of this call"));
            upper = Bound::Finite(lower);
        }
        let (lower_span, upper_span) = (bounds.lower.span, bounds.upper.span);
        Interval { lower, upper, lower_span, upper_span, span: bounds.span }
    }

    fn bound(&mut self, amount: Amount, caller: &Caller<'_>, what: &str) -> Bound {
        let index = match amount.value {
            AmountValue::Known(bound) => return bound,
            AmountValue::Error => return Bound::Finite(Duration::ZERO),
            AmountValue::Parameter(index) => index,
        };
        let parameter = clip(&caller.program.parameters[index].name);
        let value = &caller.arguments[index];
        let (code, message) = match &value.kind {
            ValueKind::Number(number) if *number >= Duration::ZERO => return Bound::Finite(*number),
            ValueKind::Number(number) => {
                (Code::Negative, format!("`{parameter}` is {number} here, which is negative"))
            }
            ValueKind::Name(..) => {
                (Code::NotANumber, format!("nothing says what `{parameter}` is, so {what} is unknown"))
            }
            _ => (Code::NotANumber, format!("`{parameter}` is not a number here, so it cannot be {what}")),
        };
        self.problems.push(
            Diagnostic::error(code, value.span, message)
                .primary("a duration was expected")
                .label(amount.span, format!("`{parameter}` is used as {what} here"))
                .help("Call the program with a number of seconds."),
        );
        Bound::Finite(Duration::ZERO)
    }
}

fn blank(name: String, kind: Kind, span: Span) -> Episode {
    Episode {
        name,
        kind,
        internal: false,
        arguments: Vec::new(),
        slack: None,
        duration: None,
        contingent: false,
        delay: None,
        requires: None,
        effect: None,
        parts: Vec::new(),
        span,
    }
}

/// A condition with the parameters replaced by what the program was called with.
fn substitute(condition: &Condition, program: &Program, arguments: &[Value]) -> Condition {
    let again = |part: &Condition| Box::new(substitute(part, program, arguments));
    let all = |parts: &[Condition]| parts.iter().map(|part| substitute(part, program, arguments)).collect();
    let value = |value: &Value| match &value.kind {
        ValueKind::Name(None, name) => {
            let index = program.parameters.iter().position(|parameter| parameter.name == *name);
            index.and_then(|index| arguments.get(index)).unwrap_or(value).clone()
        }
        _ => value.clone(),
    };
    let slot = |slot: &crate::ast::SlotOf| crate::ast::SlotOf {
        accessor: slot.accessor.clone(),
        object: value(&slot.object),
    };
    match condition {
        Condition::And(parts) => Condition::And(all(parts)),
        Condition::Or(parts) => Condition::Or(all(parts)),
        Condition::Not(part) => Condition::Not(again(part)),
        Condition::AtStart(part) => Condition::AtStart(again(part)),
        Condition::AtEnd(part) => Condition::AtEnd(again(part)),
        Condition::OverAll(part) => Condition::OverAll(again(part)),
        Condition::Equal(left, right) => Condition::Equal(slot(left), value(right)),
        Condition::Holds(left) => Condition::Holds(slot(left)),
    }
}
