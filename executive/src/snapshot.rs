//! The mission at one moment, as a person wants to see it: what was done, what comes next, what may be heard now.

use kirk_network::Time;
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
    /// What is waited for, if it is not yet time zero.
    pub waits: Option<Waits>,
}

/// What is waited for before time zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Waits {
    /// The hour.
    Hour,
    /// That the driver confirms this event.
    Driver(String),
}

impl Snapshot {
    /// The same before time zero: nothing has happened, and nothing can be heard.
    pub(crate) fn before(self, waits: Waits) -> Snapshot {
        let (rows, possible, pending) = (Vec::new(), Vec::new(), Vec::new());
        Snapshot { rows, possible, pending, next: None, waits: Some(waits), ..self }
    }
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
pub(crate) fn snapshot(executive: &mut Executive, now: Time, internal: bool) -> Snapshot {
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
        waits: None,
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
            let happened = happened[link.to.index()]?;
            Some(Possible {
                event: network.label(link.to).to_string(),
                from: happened.earliest.saturating_add(link.delay.min),
                until: link.delay.max.finite().map(|max| happened.latest.saturating_add(max)),
            })
        })
        .collect();
    all.sort_by_key(|possible| possible.from);
    all
}

#[cfg(test)]
mod tests {
    use kirk_network::{Duration, json};
    use kirk_runtime::{Input, Patience, Plan, Scope, Settings, Setup, handovers};

    use super::*;

    fn executive(text: &str, driver: bool) -> Executive {
        let plan = Plan::new(&json::read(text).unwrap()).unwrap();
        let handovers = handovers(plan.network(), None, Scope::Starts);
        let second = Duration::from_secs(1);
        let patience = Patience { first: second, most: second };
        let settings = Settings { lateness: Duration::from_secs(5), ..Settings::default() };
        let (program, run) = ("mission".to_string(), "run".to_string());
        Executive::new(plan, Setup { program, run, settings, handovers, driver, patience })
    }

    fn second(seconds: i64) -> Time {
        Time::from_micros(seconds * 1_000_000)
    }

    /// One line for each thing there is.
    fn told(snapshot: &Snapshot) -> Vec<String> {
        let rows = snapshot.rows.iter().map(|row| format!("{} {}", row.event, row.how.word()));
        let possible = snapshot.possible.iter().map(|Possible { event, from, until }| {
            let until = until.map_or("never".to_string(), |until| until.to_string());
            format!("{event} may be heard from {from} to {until}")
        });
        let next =
            snapshot.next.iter().map(|next| format!("{} {} at {}", next.event, next.how.word(), next.at));
        let pending =
            snapshot.pending.iter().map(|pending| format!("{} pending, {}", pending.name, pending.attempts));
        rows.chain(possible).chain(pending).chain(next).collect()
    }

    const MISSION: &str = r#"{"format": "kirk-network/1", "origin": "go",
        "events": ["go", "scan:start", "scan:end", "data", "pack"],
        "requirements": [{"from": "go", "to": "scan:start", "lower": 2, "upper": 4},
                         {"from": "scan:end", "to": "pack", "lower": 1, "upper": 30}],
        "contingents": [{"from": "scan:start", "to": "scan:end", "lower": 10, "upper": 20, "delay": [1, 2]},
                        {"from": "scan:end", "to": "data", "lower": 5, "upper": 7, "delay": [0, null]}]}"#;

    #[test]
    fn what_has_begun_may_be_heard_when_the_model_says_so() {
        let mut executive = executive(MISSION, false);
        executive.handle(second(1), Input::Timeout {});
        let waiting = ["go dispatched", "scan:start dispatched at 2"];
        assert_eq!(told(&snapshot(&mut executive, second(1), false)), waiting);

        executive.handle(second(3), Input::Timeout {});
        let rows = ["go dispatched", "scan:start dispatched"];
        let now = told(&snapshot(&mut executive, second(3), false));
        // The data cannot come before the end of the scan, of which nothing is known yet.
        assert_eq!(now[..2], rows);
        assert_eq!(now[2], "scan:end may be heard from 13 to 24");
        assert_eq!(now.len(), 4);
    }

    #[test]
    fn what_was_heard_is_possible_no_more_and_what_follows_it_is() {
        let mut executive = executive(MISSION, false);
        executive.handle(second(3), Input::Timeout {});
        let end = executive.network().find("scan:end").unwrap();
        let news = Input::observed(executive.network(), end);
        assert!(executive.handle(second(16), news).is_accepted());
        if let Some(rebuild) = executive.poll_rebuild(second(16)) {
            executive.handle(second(16), Input::rebuilt(rebuild.run()));
        }
        let possible = snapshot(&mut executive, second(16), false).possible;
        let data = Possible { event: "data".to_string(), from: second(19), until: None };
        assert_eq!(possible, [data]);
    }

    #[test]
    fn what_the_driver_has_is_pending_until_it_is_confirmed() {
        let mut executive = executive(MISSION, true);
        executive.handle(second(2), Input::Timeout {});
        let pending = snapshot(&mut executive, second(2), false).pending;
        let expected = Pending {
            name: "scan:start".to_string(),
            latest: Some(second(4)),
            attempts: 1,
            again: None,
            reason: String::new(),
        };
        assert_eq!(pending, std::slice::from_ref(&expected));

        executive.handle(
            second(2),
            Input::Failed { id: "run/scan:start".into(), reason: "no power".into(), doubt: false },
        );
        let failed = Pending { again: Some(second(3)), reason: "no power".to_string(), ..expected };
        assert_eq!(snapshot(&mut executive, second(2), false).pending, [failed]);

        executive.handle(second(3), Input::Timeout {});
        executive.handle(second(3), Input::Executed { id: "run/scan:start".into(), ago: None });
        let after = snapshot(&mut executive, second(3), false);
        assert_eq!(after.pending, []);
        assert_eq!(after.possible.len(), 1);
    }

    #[test]
    fn at_the_end_what_was_never_heard_is_shown() {
        let mut executive = executive(MISSION, false);
        while let Some(due) = executive.poll_timeout() {
            executive.handle(due, Input::Timeout {});
        }
        let over = snapshot(&mut executive, second(200), false);
        assert_eq!((over.outcome, over.possible.len(), &over.next), (Outcome::Completed, 0, &None));
        assert_eq!(over.rows.iter().filter(|row| row.event == "data").count(), 1);
    }
}
