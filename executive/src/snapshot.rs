//! The mission at one moment, as a person wants to see it: what was done, what comes next, what may be heard now.

use kirk_network::{Duration, Time};
use kirk_runtime::{Executive, Failure, How, Outcome, Pending, Row};

/// The mission at one moment. It costs one pass over all events, so it is made only for those who ask.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// When it was made.
    pub at: Time,
    /// The control program, or the name of the network.
    pub program: String,
    /// Running, completed or failed.
    pub outcome: Outcome,
    /// Why it failed, if it did.
    pub failure: Option<Failure>,
    /// What was fixed so far, in time order: one row for each name.
    pub rows: Vec<Row>,
    /// What happens next if nothing is heard.
    pub next: Option<Next>,
    /// Nature's events that have begun and are not heard of.
    pub possible: Vec<Possible>,
    /// What the driver was told of and has not confirmed.
    pub pending: Vec<Pending>,
}

/// What happens next if nothing is heard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Next {
    /// When.
    pub at: Time,
    /// The event.
    pub event: String,
    /// How it will be fixed: dispatched, imagined, or released from the buffer.
    pub how: How,
}

/// An event of Nature's that may be heard of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Possible {
    /// The event.
    pub event: String,
    /// The model says that its news comes no earlier.
    pub from: Time,
    /// The model says that its news comes no later; `None` if it may never come.
    pub until: Option<Time>,
}

/// The mission as it stands. `internal` also shows the events that no user wrote.
pub fn snapshot(executive: &mut Executive, now: Time, internal: bool) -> Snapshot {
    let upcoming = executive.upcoming();
    let execution = executive.execution(now, internal);
    let over = executive.is_over();
    let label = |event| executive.network().label(event).to_string();
    Snapshot {
        at: now,
        program: execution.program,
        outcome: execution.outcome,
        failure: execution.failure,
        // Until the end nobody knows what is never heard.
        rows: execution.rows.into_iter().filter(|row| over || row.time.is_some()).collect(),
        next: upcoming.map(|(at, event, how)| Next { at, event: label(event), how }),
        possible: if over { Vec::new() } else { possible(executive) },
        pending: executive.pending(),
    }
}

/// What has begun and is not heard of, the earliest first.
fn possible(executive: &Executive) -> Vec<Possible> {
    let (network, dispatcher) = (executive.network(), executive.dispatcher());
    let happened = dispatcher.all_happened();
    let mut all: Vec<Possible> = network
        .contingents()
        .iter()
        .filter(|link| dispatcher.known(link.to).observed.is_none())
        .filter(|link| dispatcher.known(link.from).fixed.is_some())
        .filter_map(|link| {
            let (low, high) = happened[link.to.index()]?;
            let after = |at: i64, delay: Duration| Time::from_micros(at.saturating_add(delay.as_micros()));
            Some(Possible {
                event: network.label(link.to).to_string(),
                from: after(low, link.delay.min),
                until: link.delay.max.finite().map(|max| after(high, max)),
            })
        })
        .collect();
    all.sort_by_key(|possible| possible.from);
    all
}
