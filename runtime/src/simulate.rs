//! Simulation: the dispatcher, Nature, and a clock that jumps from one thing to the next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use kirk_network::{EventId, Time};

use crate::dispatcher::{Dispatcher, Reception, Settings, Strategy};
use crate::execution::Execution;
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
/// An observation that the model says cannot happen.
pub fn explained(plan: &Plan, program: &str, simulation: &Simulation) -> Result<Explained, Impossible> {
    let network = plan.network();
    let mut nature = Nature::new(network, simulation.nature, simulation.seed, &simulation.observations);
    let mut dispatcher = Dispatcher::new(plan.clone(), Settings::of(simulation.strategy));
    let mut truth: Vec<Option<Time>> = vec![None; network.events().len()];
    let mut news: BinaryHeap<Reverse<(Time, EventId)>> = BinaryHeap::new();
    let mut now = Time::ZERO;
    loop {
        // Acting and hearing take no time, so at one moment they may take turns until nothing more happens.
        loop {
            while let Some(&Reverse((time, event))) = news.peek().filter(|Reverse((time, _))| *time <= now) {
                news.pop();
                let reception = dispatcher.handle_observation(time, event);
                debug_assert_eq!(reception, Reception::Accepted, "Nature keeps to the model");
                plan_anew(&mut dispatcher, time);
            }
            dispatcher.handle_timeout(now);
            while let Some(dispatch) = dispatcher.poll_dispatch() {
                truth[dispatch.event.index()] = Some(dispatch.time);
                for deed in nature.begin(dispatch.event, dispatch.time)? {
                    truth[deed.event.index()] = Some(deed.truth);
                    news.extend(deed.news.map(|time| Reverse((time, deed.event))));
                }
            }
            if news.peek().is_none_or(|Reverse((time, _))| *time > now) {
                break;
            }
        }
        let Some(timeout) = dispatcher.poll_timeout() else { break };
        now = match news.peek() {
            Some(&Reverse((time, _))) if time < timeout => time,
            _ => timeout,
        };
    }
    // News that was asked for is heard even if nothing is left to do with it.
    while let Some(Reverse((time, event))) = news.pop() {
        if simulation.observations.contains(&(event, time)) {
            dispatcher.handle_observation(time, event);
            plan_anew(&mut dispatcher, time);
        }
    }
    let mut execution = record(&dispatcher, program, all_over(&dispatcher), simulation.internal, &truth);
    execution.seed = Some(simulation.seed);
    Ok(Explained { execution, dispatcher })
}

/// Planning anew takes no time here.
fn plan_anew(dispatcher: &mut Dispatcher, now: Time) {
    while let Some(rebuild) = dispatcher.poll_rebuild(now) {
        dispatcher.handle_rebuilt(rebuild.run());
    }
}
