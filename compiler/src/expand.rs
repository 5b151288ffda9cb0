//! Unfolds the program to start from: every call becomes an episode of its own, with a name of its own.

mod agents;
mod interval;
mod labels;
mod limits;
mod name;
pub(crate) mod problem;
mod scope;

use kirk_network::{Bound, Duration};

use crate::ast::{Condition, Ident, Limits, Value, ValueKind};
use crate::episode::{Episode, Kind, MAX_EPISODES, Range};
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Between, Body, EventOf, Expression, Model, Program, Timing, Work};
use name::Occurrences;
use problem::{Problem, Unfolded};
pub(crate) use scope::source;
use scope::{Named, Scopes, Target};

/// The tree of episodes of the program to start from. Expects a model without errors: in particular no recursion.
pub(crate) fn expand(model: &Model, problems: &mut Problems) -> Option<Episode> {
    let entry = model.entry?;
    if !limits::check(model, entry, problems) {
        return None;
    }
    let program = &model.programs[entry];
    if !program.parameters.is_empty() {
        let (program, parameters) = (program.name.clone(), program.parameters.clone());
        problems.push(Problem::FreeParameters { program, parameters });
    }
    let free =
        |name: &crate::ast::Ident| Value { kind: ValueKind::Name(None, name.name.clone()), span: name.span };
    let arguments = program.parameters.iter().map(free).collect();
    let mut expander = Expander {
        model,
        occurrences: Occurrences::new(model),
        scopes: Scopes::default(),
        betweens: Vec::new(),
        episodes: 0,
        repetitions: 0,
        exhausted: false,
        problems,
    };
    let mut root = expander.occurrence(entry, arguments, program.name.span, Around::default());
    labels::give_names(&mut root, &expander.scopes);
    agents::settle(&mut root);
    expander.constrain(&mut root);
    Some(root)
}

struct Expander<'a> {
    model: &'a Model,
    occurrences: Occurrences,
    scopes: Scopes,
    betweens: Vec<Pending<'a>>,
    /// How many episodes and repetitions there are so far.
    episodes: u64,
    repetitions: u64,
    /// True if there are too many, which has been reported: nothing more is unfolded.
    exhausted: bool,
    problems: &'a mut Problems,
}

/// Where in a program the unfolding is, and how the program was called.
struct Frame<'a> {
    name: &'a str,
    program: &'a Program,
    call: Span,
    internal: u32,
    scope: usize,
    /// The values of the parameters, and of the names of `let` and `dotimes` around the place at hand.
    variables: Vec<Value>,
    /// Who executes what names nobody else.
    agent: Option<String>,
}

/// Where an occurrence of a program is: nowhere, if it is the one to start from.
#[derive(Default)]
struct Around {
    scope: Option<usize>,
    agent: Option<String>,
}

/// A `between` whose events are looked up when all episodes are known.
struct Pending<'a> {
    scope: usize,
    from: (&'a EventOf, Option<Vec<Value>>),
    to: (&'a EventOf, Option<Vec<Value>>),
    interval: Range,
}

impl<'a> Expander<'a> {
    #[inline(never)]
    fn occurrence(&mut self, index: usize, arguments: Vec<Value>, span: Span, outside: Around) -> Episode {
        let program = &self.model.programs[index];
        let name = self.occurrences.of(&program.name.name);
        let mut episode = self.blank(name.clone(), Kind::Program, span);
        episode.requires = program.requires.as_ref().map(|c| Box::new(substitute(c, program, &arguments)));
        episode.effect = program.effect.as_ref().map(|c| Box::new(substitute(c, program, &arguments)));
        episode.arguments = arguments.iter().map(|value| value.kind.clone()).collect();
        // The program started from occurs too, outside of everything.
        let around = outside.scope.unwrap_or_else(|| self.scopes.open(None));
        let target = Target::Program(index);
        let given = episode.arguments.clone();
        let named = Named { scope: around, target, arguments: given, episode: episode.name.clone(), span };
        self.scopes.add(named, self.problems);
        let scope = self.scopes.open(Some(around));
        let (call, variables, agent) = (span, arguments, outside.agent);
        let mut frame = Frame { name: &name, program, call, internal: 0, scope, variables, agent };
        if let Some(agent) = &program.agent {
            frame.agent = self.agent(agent, &frame);
        }
        episode.agent = frame.agent.clone();
        match &program.work {
            Work::Primitive(timing) => self.primitive(&mut episode, timing, &frame),
            Work::Body(body) => episode.parts = self.parts(body, &mut frame),
        }
        self.scopes.close(scope);
        if outside.scope.is_none() {
            self.scopes.close(around);
        }
        episode
    }

    fn primitive(&mut self, episode: &mut Episode, timing: &Timing, frame: &Frame<'_>) {
        episode.kind = Kind::Primitive;
        episode.duration = Some(self.interval(&timing.bounds, frame, Limits::Duration));
        episode.contingent = timing.contingent;
        episode.observed_by = timing.observed_by.as_ref().and_then(|agent| self.agent(agent, frame));
        if self.model.team.is_some() && episode.agent.is_none() && frame.program.agent.is_none() {
            let program = frame.program.name.clone();
            self.problems.push(Problem::NobodyExecutes { program, call: frame.call });
        }
        if timing.contingent {
            if episode.duration.as_ref().is_some_and(|duration| duration.upper == Bound::Infinite) {
                self.problems.push(Problem::ContingentUnbounded {
                    program: frame.program.name.clone(),
                    upper: timing.bounds.upper.span,
                    call: frame.call,
                });
            }
            let delay = self.interval(&timing.delay, frame, Limits::ObservationDelay);
            if delay.lower != Duration::ZERO || delay.upper != Bound::ZERO {
                episode.delay = Some(delay);
            }
        }
    }

    fn parts(&mut self, body: &'a [Body], frame: &mut Frame<'_>) -> Vec<Episode> {
        let mut parts = Vec::with_capacity(body.len());
        self.unfold(body, frame, &mut parts);
        parts
    }

    /// Adds what the forms of a body unfold to: one episode for most, none for `between`, several for `dotimes` and `let`.
    fn unfold(&mut self, body: &'a [Body], frame: &mut Frame<'_>, parts: &mut Vec<Episode>) {
        for form in body {
            if self.exhausted {
                return;
            }
            match form {
                Body::Call { program, arguments, span } => {
                    let arguments = self.values(arguments, frame);
                    let outside = Around { scope: Some(frame.scope), agent: frame.agent.clone() };
                    parts.push(self.occurrence(*program, arguments, *span, outside));
                }
                Body::Group { .. } | Body::Within { .. } | Body::Delay { .. } => {
                    parts.push(self.form(form, frame));
                }
                Body::Let { values, body } => self.binding(values, body, frame, parts),
                Body::Repeat { count, variable, body, operator } => {
                    let count = self.count(count, frame);
                    self.repeat(count, (*variable, *operator), body, frame, parts);
                }
                Body::Label { name, arguments, body, operator } => {
                    let arguments = self.values(arguments, frame);
                    parts.push(self.label(name, arguments, body, *operator, frame));
                }
                Body::Between(between) => self.between(between, frame),
                Body::WithAgent { agent, body } => self.with_agent(agent, body, frame, parts),
            }
        }
    }

    /// An episode for a form no user gave a name.
    #[inline(never)]
    fn form(&mut self, form: &'a Body, frame: &mut Frame<'_>) -> Episode {
        match form {
            Body::Group { parallel, slack, body, operator } => {
                let kind = if *parallel { Kind::Parallel } else { Kind::Sequence };
                let mut episode = self.internal(kind, *operator, frame);
                episode.slack = Some(*slack);
                episode.parts = self.parts(body, frame);
                episode
            }
            Body::Within { bounds, body, operator } => {
                let mut episode = self.internal(Kind::WithTemporalConstraint, *operator, frame);
                episode.duration = Some(self.interval(bounds, frame, Limits::Duration));
                episode.parts = self.parts(body, frame);
                episode
            }
            Body::Delay { bounds, span } => {
                let mut episode = self.internal(Kind::Delay, *span, frame);
                episode.duration = Some(self.interval(bounds, frame, Limits::Wait));
                episode
            }
            _ => self.internal(Kind::Sequence, frame.call, frame),
        }
    }

    #[inline(never)]
    fn binding(
        &mut self,
        values: &[Expression],
        body: &'a [Body],
        frame: &mut Frame<'_>,
        parts: &mut Vec<Episode>,
    ) {
        let values = self.values(values, frame);
        let outside = frame.variables.len();
        frame.variables.extend(values);
        self.unfold(body, frame, parts);
        frame.variables.truncate(outside);
    }

    #[inline(never)]
    fn with_agent(
        &mut self,
        agent: &Expression,
        body: &'a [Body],
        frame: &mut Frame<'_>,
        parts: &mut Vec<Episode>,
    ) {
        let agent = self.agent(agent, frame);
        let outside = std::mem::replace(&mut frame.agent, agent);
        self.unfold(body, frame, parts);
        frame.agent = outside;
    }

    #[inline(never)]
    fn repeat(
        &mut self,
        count: u64,
        (variable, operator): (Span, Span),
        body: &'a [Body],
        frame: &mut Frame<'_>,
        parts: &mut Vec<Episode>,
    ) {
        let (outside, around) = (frame.variables.len(), frame.scope);
        for index in 0..count {
            self.repetitions += 1;
            if self.repetitions > MAX_EPISODES {
                self.give_up(Unfolded::Repetitions, operator, Some(frame.call));
            }
            if self.exhausted {
                break;
            }
            frame.scope = self.scopes.open(Some(around));
            let number = i64::try_from(index).unwrap_or(i64::MAX);
            let kind = ValueKind::Number(Duration::from_secs(number));
            frame.variables.push(Value { kind, span: variable });
            self.unfold(body, frame, parts);
            frame.variables.truncate(outside);
            self.scopes.close(frame.scope);
        }
        frame.scope = around;
    }

    #[inline(never)]
    fn label(
        &mut self,
        name: &Ident,
        arguments: Vec<Value>,
        body: &'a [Body],
        operator: Span,
        frame: &mut Frame<'_>,
    ) -> Episode {
        let mut parts = self.parts(body, frame);
        let episode = match parts.pop() {
            Some(only) if parts.is_empty() => only,
            last => {
                parts.extend(last);
                let episode = self.internal(Kind::Sequence, operator, frame);
                Episode { slack: Some(false), parts, ..episode }
            }
        };
        let named = Named {
            scope: frame.scope,
            target: Target::Label(name.name.clone()),
            arguments: arguments.into_iter().map(|value| value.kind).collect(),
            episode: episode.name.clone(),
            span: name.span,
        };
        self.scopes.add(named, self.problems);
        episode
    }

    #[inline(never)]
    fn between(&mut self, between: &'a Between, frame: &Frame<'_>) {
        let Between { from, to, bounds } = between;
        self.repetitions += 1;
        if self.repetitions > MAX_EPISODES {
            self.give_up(Unfolded::Constraints, from.span, Some(frame.call));
        }
        let interval = self.signed_interval(bounds, frame, Limits::Duration);
        let mut arguments =
            |event: &EventOf| event.arguments.as_ref().map(|arguments| self.values(arguments, frame));
        let (from, to) = ((from, arguments(from)), (to, arguments(to)));
        self.betweens.push(Pending { scope: frame.scope, from, to, interval });
    }

    fn internal(&mut self, kind: Kind, span: Span, frame: &mut Frame<'_>) -> Episode {
        let name = self.occurrences.inside(frame.name, &mut frame.internal);
        Episode { internal: true, ..self.blank(name, kind, span) }
    }

    fn blank(&mut self, name: String, kind: Kind, span: Span) -> Episode {
        self.episodes += 1;
        if self.episodes > MAX_EPISODES {
            self.give_up(Unfolded::Episodes, span, None);
        }
        blank(name, kind, span)
    }

    fn give_up(&mut self, what: Unfolded, span: Span, call: Option<Span>) {
        if !std::mem::replace(&mut self.exhausted, true) {
            self.problems.push(Problem::TooMany { what, span, call });
        }
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
        agent: None,
        observed_by: None,
        requires: None,
        effect: None,
        labels: Vec::new(),
        parts: Vec::new(),
        constraints: Vec::new(),
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
