//! From a dispatcher to the record of its execution.

use kirk_network::{EventId, Interval, Network, Time};

use crate::dispatcher::{Dispatcher, Missed};
use crate::execution::{Execution, FORMAT, Failure, How, Outcome, Row};
use crate::input::Reason;
use crate::knowledge::Fixed;

/// The record of an execution up to `end`; `truth` where it is known. At one time what must not come after something else
/// comes before it.
pub(crate) fn record(
    dispatcher: &Dispatcher,
    program: &str,
    end: Time,
    internal: bool,
    truth: &[Option<Time>],
) -> Execution {
    let network = dispatcher.network();
    let sequence = |event: EventId| dispatcher.known(event).fixed.map_or(u32::MAX, |fixed| fixed.sequence);
    let mut rows: Vec<((Time, u32, u32), Row)> = Vec::new();
    let all_happened = dispatcher.happened_by(end);
    for event in network.event_ids() {
        let truth = truth.get(event.index()).copied().flatten();
        let Some((time, row)) = row(dispatcher, event, all_happened[event.index()], truth) else { continue };
        let place = (time, dispatcher.order(event), sequence(event));
        for name in network.events()[event.index()].names.iter() {
            if internal || !name.internal {
                rows.push((place, Row { event: name.text.clone(), ..row.clone() }));
            }
        }
    }
    rows.sort_by_key(|(place, _)| *place);
    let failure = dispatcher.missed().map(|missed| missed_window(network, missed));
    Execution {
        format: FORMAT.to_string(),
        program: program.to_string(),
        outcome: if failure.is_some() { Outcome::Failed } else { Outcome::Completed },
        failure,
        makespan: end,
        seed: None,
        what_if: None,
        rows: rows.into_iter().map(|(_, row)| row).collect(),
    }
}

/// When all was over: the last event was executed or acted on, or had happened in any case.
pub(crate) fn all_over(dispatcher: &Dispatcher) -> Time {
    let happened = dispatcher.all_happened();
    let ends = dispatcher.network().event_ids().filter_map(|event| {
        let fixed = dispatcher.known(event).fixed.map(|fixed| fixed.time);
        fixed.max(happened[event.index()].map(|within| within.latest))
    });
    ends.max().unwrap_or(Time::ZERO)
}

/// The row of an event, still without a name, and its place in time; `None` if it is ours and was not executed.
pub(crate) fn row(
    dispatcher: &Dispatcher,
    event: EventId,
    happened: Option<Interval>,
    truth: Option<Time>,
) -> Option<(Time, Row)> {
    let known = dispatcher.known(event);
    let contingent = dispatcher.network().link_of(event).is_some();
    let (time, how, place) = match known.fixed {
        Some(Fixed { time, how, .. }) => (Some(time), how, time),
        None if contingent => (None, How::Never, happened.map_or(Time::MAX, |within| within.latest)),
        None => return None,
    };
    let row = Row {
        event: String::new(),
        time,
        how,
        observed: contingent.then_some(known.observed),
        happened: happened.filter(|_| contingent),
        truth,
        because: None,
    };
    Some((place, row))
}

pub(crate) fn missed_window(network: &Network, missed: Missed) -> Failure {
    let event = network.label(missed.event).to_string();
    let detail = if missed.due <= missed.latest {
        format!(
            "`{event}` was due at {} s and could be executed until {} s at the latest, but was not by {} s: nobody was there, or \
             not in time",
            missed.due, missed.latest, missed.time
        )
    } else {
        format!(
            "`{event}` could be executed until {} s at the latest, but what it waits for came at {} s",
            missed.latest, missed.due
        )
    };
    Failure { event, time: missed.time, reason: Reason::MissedWindow, detail }
}

/// What is wrong with news that arrived when the model says it cannot.
pub(crate) fn broken_model(
    network: &Network,
    event: EventId,
    arrived: Time,
    earliest: Time,
    latest: Option<Time>,
) -> String {
    let window = match latest {
        Some(latest) if arrived > latest => format!("too late: it was to come by {latest} s"),
        _ => format!("too early: it was to come from {earliest} s on"),
    };
    format!("the model is broken: news of `{}` at {arrived} s is {window}", network.label(event))
}

/// The same when there is a plan with the news, and when there is none.
pub(crate) fn and_goes_on(said: &str) -> String {
    format!("{said}; the rest can still be guaranteed, the mission goes on")
}

pub(crate) fn and_fails(said: &str) -> String {
    format!("{said}, and the rest cannot be guaranteed any more")
}
