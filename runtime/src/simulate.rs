//! Simulation: the dispatcher, Nature, and a clock that jumps from one thing to the next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use kirk_network::{EventId, Time};

use crate::aftermath::aftermath;
use crate::dispatcher::{Dispatcher, Settings, Strategy, Taken};
use crate::execution::{Execution, Failure, Outcome};
use crate::input::Reason;
use crate::nature::{Impossible, Nature, Temper};
use crate::plan::Plan;
use crate::record::{all_over, record};

/// What to simulate.
#[derive(Clone, Debug, Default)]
pub struct Simulation {
    /// How early news is treated.
    pub strategy: Strategy,
    /// How Nature chooses.
    pub nature: Temper,
    /// The seed of a random Nature.
    pub seed: u64,
    /// News that arrives at given times, by event of the plan's network.
    pub observations: Vec<(EventId, Time)>,
    /// Also record the events no user wrote.
    pub internal: bool,
    /// News that the model rules out is heard all the same, and dealt with as in real time: the rehearsal of an overrun.
    pub what_if: bool,
}

/// Executes a plan against a simulated Nature, in virtual time.
///
/// # Errors
/// An observation that the model says cannot happen.
pub fn simulate(plan: &Plan, program: &str, simulation: &Simulation) -> Result<Execution, Impossible> {
    explained(plan, program, simulation).map(|explained| explained.execution)
}

/// An execution, and beside it what knows why.
#[derive(Clone, Debug)]
pub struct Explained {
    /// The record.
    pub execution: Execution,
    /// The dispatcher at its end, which knows what decided each time ([`Dispatcher::why`]).
    pub dispatcher: Dispatcher,
}

/// The same, with what knows why each event was executed when it was.
///
/// # Errors
/// An observation that the model says cannot happen; with `what_if`, one of what has not begun by then.
pub fn explained(plan: &Plan, program: &str, simulation: &Simulation) -> Result<Explained, Impossible> {
    let network = plan.network();
    let nature = Nature::new(network, simulation.nature, simulation.seed, &simulation.observations);
    let mut run = Run {
        nature: if simulation.what_if { nature.beyond_the_model() } else { nature },
        dispatcher: Dispatcher::new(plan.clone(), Settings::of(simulation.strategy)),
        truth: vec![None; network.events().len()],
        news: BinaryHeap::new(),
        broken: None,
    };
    let mut stopped = run.go_through()?;
    // Nothing is left to do, and news is heard until all is over, and all that was asked for: silence until then says something.
    let asked = simulation.observations.iter().map(|&(_, time)| time).max().unwrap_or_default();
    while let (None, Some(Reverse((time, event)))) = (stopped, run.news.pop()) {
        if time <= run.over().max(asked) && !run.hear(time, event) {
            stopped = Some(time);
        }
    }
    let end = stopped.unwrap_or_else(|| run.over());
    let Run { dispatcher, truth, broken, .. } = run;
    let mut execution = record(&dispatcher, program, end, simulation.internal, &truth);
    execution.seed = Some(simulation.seed);
    if let Some(failure) = broken {
        execution.outcome = Outcome::BrokenModel;
        execution.failure = Some(failure);
        let so_far = dispatcher.so_far(end, &[]);
        execution.what_if = Some(Box::new(aftermath(&dispatcher, &so_far, &truth)));
    }
    Ok(Explained { execution, dispatcher })
}

/// An execution on its way.
struct Run<'a> {
    nature: Nature<'a>,
    dispatcher: Dispatcher,
    /// When events truly happen, as far as Nature has decided.
    truth: Vec<Option<Time>>,
    /// News on its way.
    news: BinaryHeap<Reverse<(Time, EventId)>>,
    /// How the model was broken: first, or so that the rest cannot be guaranteed.
    broken: Option<Failure>,
}

impl Run<'_> {
    /// Goes on until nothing is left to do, or nothing can be: then that is returned as the time.
    fn go_through(&mut self) -> Result<Option<Time>, Impossible> {
        let mut now = Time::ZERO;
        loop {
            // Acting and hearing take no time, so at one moment they may take turns until nothing more happens.
            loop {
                while let Some((time, event)) = self.next_news().filter(|(time, _)| *time <= now) {
                    self.news.pop();
                    if !self.hear(time, event) {
                        return Ok(Some(time));
                    }
                }
                self.dispatcher.handle_timeout(now);
                while let Some(dispatch) = self.dispatcher.poll_dispatch() {
                    self.truth[dispatch.event.index()] = Some(dispatch.time);
                    for deed in self.nature.begin(dispatch.event, dispatch.time)? {
                        self.truth[deed.event.index()] = Some(deed.truth);
                        self.news.extend(deed.observed.map(|time| Reverse((time, deed.event))));
                    }
                }
                if self.next_news().is_none_or(|(time, _)| time > now) {
                    break;
                }
            }
            let Some(timeout) = self.dispatcher.poll_timeout() else { return Ok(None) };
            now = match self.next_news() {
                Some((time, _)) if time < timeout => time,
                _ => timeout,
            };
        }
    }

    /// When all is over: what Nature has done against the model may be later than anybody believes.
    fn over(&self) -> Time {
        let truly = self.truth.iter().flatten().copied().max().filter(|_| self.broken.is_some());
        all_over(&self.dispatcher).max(truly.unwrap_or_default())
    }

    fn next_news(&self) -> Option<(Time, EventId)> {
        self.news.peek().map(|&Reverse(news)| news)
    }

    /// Takes news. False if the model does not allow it and the rest cannot be guaranteed: then the mission has failed.
    fn hear(&mut self, time: Time, event: EventId) -> bool {
        match self.dispatcher.hear_and_plan(time, event) {
            // Nature begins nothing that is not executed, so nothing is heard of it.
            Taken::NotBegun | Taken::Possible => true,
            Taken::Broken { said, goes_on } => {
                if self.broken.is_none() || !goes_on {
                    let event = self.dispatcher.network().label(event).to_string();
                    self.broken = Some(Failure { event, time, reason: Reason::BrokenModel, detail: said });
                }
                goes_on
            }
        }
    }
}
