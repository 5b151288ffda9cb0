//! From a dispatcher to the record of its execution.

use kirk_network::json::Seconds;
use kirk_network::{Duration, EventId, Network, Time};

use crate::dispatcher::{Dispatcher, Missed};
use crate::execution::{Execution, FORMAT, Failure, How, Outcome, Row, at};

/// The record of an execution up to `end`; `truth` where it is known.
pub(crate) fn record(
    dispatcher: &Dispatcher,
    program: &str,
    end: Time,
    internal: bool,
    truth: &[Option<Time>],
) -> Execution {
    let network = dispatcher.network();
    let mut rows: Vec<((i64, u32), Row)> = Vec::new();
    let all_happened = dispatcher.happened_by(end);
    for event in network.event_ids() {
        let truth = truth.get(event.index()).copied().flatten();
        let Some((order, row)) = row(dispatcher, event, all_happened[event.index()], truth) else { continue };
        for name in &network.events()[event.index()].names {
            if internal || !name.internal {
                rows.push((order, Row { event: name.text.clone(), ..row.clone() }));
            }
        }
    }
    rows.sort_by_key(|(order, _)| *order);
    let failure = dispatcher.missed().map(|missed| missed_window(network, missed));
    Execution {
        format: FORMAT.to_string(),
        program: program.to_string(),
        outcome: if failure.is_some() { Outcome::Failed } else { Outcome::Completed },
        failure,
        makespan: at(end),
        seed: None,
        rows: rows.into_iter().map(|(_, row)| row).collect(),
    }
}

/// The row of an event, still without a name, and its place in time; `None` if it is ours and was not executed.
pub(crate) fn row(
    dispatcher: &Dispatcher,
    event: EventId,
    happened: Option<(i64, i64)>,
    truth: Option<Time>,
) -> Option<((i64, u32), Row)> {
    let known = dispatcher.known(event);
    let contingent = dispatcher.network().link_of(event).is_some();
    let (time, how, order) = match known.fixed {
        Some((time, how)) => (Some(at(time)), how, (time.as_micros(), known.sequence)),
        None if contingent => (None, How::Never, (happened.map_or(i64::MAX, |(_, high)| high), u32::MAX)),
        None => return None,
    };
    let interval = |(low, high): (i64, i64)| (at(Time::from_micros(low)), at(Time::from_micros(high)));
    let row = Row {
        event: String::new(),
        time,
        how,
        observed: contingent.then(|| known.observed.map(at)),
        happened: happened.filter(|_| contingent).map(interval),
        truth: truth.map(at),
    };
    Some((order, row))
}

pub(crate) fn missed_window(network: &Network, missed: Missed) -> Failure {
    let event = network.label(missed.event).to_string();
    let detail = format!(
        "`{event}` could be executed until {} at the latest, but what it waits for came at {}",
        missed.latest, missed.time
    );
    Failure {
        event,
        time: Seconds(Duration::from_micros(missed.time.as_micros())),
        reason: "missed-window".into(),
        detail,
    }
}
