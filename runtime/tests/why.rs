//! What is said to have decided a time comes to just that time, by the record and the network alone.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

#[path = "../../network/tests/oracle/mod.rs"]
mod oracle;

use std::cell::RefCell;
use std::collections::BTreeMap;

use kirk_network::{Duration, EventId, Name, Network, Time};
use kirk_runtime::{Cause, Explained, How, Plan, Row, Simulation, Strategy, Temper, explained};
use oracle::random::{self, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// An execution, event by event.
struct Record<'a> {
    network: &'a Network,
    rows: Vec<Option<&'a Row>>,
}

impl Record<'_> {
    fn time(&self, event: EventId) -> Option<Time> {
        self.rows[event.index()]?.time
    }

    fn heard(&self, event: EventId) -> Option<Time> {
        self.rows[event.index()]?.observed.flatten()
    }

    fn is_at(&self, time: Time, event: EventId, distance: Duration) -> bool {
        self.time(event).is_some_and(|at| at.checked_add(distance) == Some(time))
    }

    /// A requirement that `to` comes so long after `from` at least.
    fn requires(&self, from: EventId, to: EventId, distance: Duration) -> bool {
        self.network.requirements().iter().any(|r| {
            let forth = (r.from, r.to) == (from, to) && r.lower.finite() == Some(distance);
            forth || (r.to, r.from) == (from, to) && r.upper.finite() == Some(-distance)
        })
    }

    /// The same of any event at a time: one that nobody wrote is not named.
    fn requires_then(&self, from: EventId, time: Time, distance: Duration) -> bool {
        let mut then = self.network.event_ids().filter(|&event| self.time(event) == Some(time));
        then.any(|event| self.requires(from, event, distance))
    }

    /// What is wrong with what is said to have decided the time of an event.
    fn problem(&self, event: EventId, cause: Cause) -> Option<&'static str> {
        let row = self.rows[event.index()].unwrap();
        let time = row.time.unwrap();
        let ours = row.how == How::Dispatched;
        let checks: Vec<(bool, &str)> = match cause {
            Cause::Start => vec![(time == Time::ZERO, "not at the start")],
            Cause::After { event: other, distance } => vec![
                (ours, "only events of ours wait for others"),
                (other != event, "it waits for itself"),
                (distance >= Duration::ZERO, "it comes before what it waits for"),
                (self.is_at(time, other, distance), "the distance is another"),
            ],
            Cause::Surely { event: other, latest, distance } => vec![
                (latest.checked_add(distance) == Some(time), "the distance is another"),
                (self.rows[other.index()].unwrap().truth <= Some(latest), "it happened later"),
                (self.requires_then(other, time, distance), "nothing keeps them apart"),
            ],
            Cause::Order { event: other } => {
                vec![(self.is_at(time, other, Duration::ZERO), "what it waits for was at another time")]
            }
            Cause::Unobserved { event: of, since, distance } => vec![
                (self.is_at(time, since, distance), "the distance is another"),
                (self.heard(of).is_none_or(|heard| heard >= time), "it was heard before"),
                (ours || (of == event && row.how == How::Imagined), "it was not imagined"),
                (self.network.link_of(of).is_some(), "nobody waits for news of it"),
            ],
            Cause::Observed => vec![
                (row.how == How::Observed, "it was not observed"),
                (self.heard(event) == Some(time), "the news was at another time"),
            ],
            Cause::Held { since, distance } => vec![
                (row.how == How::Buffered, "it was not held"),
                (self.is_at(time, since, distance), "the distance is another"),
                (self.heard(event) < Some(time), "it came in time"),
            ],
            Cause::Anew { news } => {
                vec![(news.is_some_and(|news| self.heard(news) <= Some(time)), "the plan is of later")]
            }
            Cause::Late { .. } | Cause::Closed { .. } => vec![(false, "nothing is late in a simulation")],
        };
        checks.into_iter().find(|(holds, _)| !holds).map(|(_, problem)| problem)
    }
}

/// The network with some events that nobody wrote, every other time.
fn partly_internal(seed: u64, network: Network) -> Network {
    let mut random = random::Random::new(seed);
    let mut events = network.events().to_vec();
    for event in events.iter_mut().skip(1) {
        let mut flagged =
            |name: &Name| Name { internal: seed % 8 >= 4 && random.within(0..=1) == 0, ..name.clone() };
        event.names = event.names.iter().map(&mut flagged).collect();
    }
    let (requirements, contingents) = (network.requirements().to_vec(), network.contingents().to_vec());
    Network::new(network.name().to_string(), network.origin(), events, requirements, contingents).unwrap()
}

fn kind(cause: Cause) -> &'static str {
    match cause {
        Cause::Start => "start",
        Cause::After { .. } => "after",
        Cause::Surely { .. } => "surely",
        Cause::Order { .. } => "order",
        Cause::Unobserved { .. } => "no news",
        Cause::Observed => "news",
        Cause::Held { .. } => "held",
        Cause::Anew { .. } => "anew",
        Cause::Late { .. } => "late",
        Cause::Closed { .. } => "closed",
    }
}

/// How often each kind of cause was met.
type Counts = RefCell<BTreeMap<&'static str, u64>>;

fn wrong(plan: &Plan, simulation: &Simulation, counts: &Counts) -> Option<String> {
    let network = plan.network();
    let Explained { execution, dispatcher } = explained(plan, "random", simulation).unwrap();
    let row = |event| execution.rows.iter().find(|row| row.event == network.id(event));
    let record = Record { network, rows: network.event_ids().map(row).collect() };
    network.event_ids().find_map(|event| {
        let problem = match (record.time(event), dispatcher.why(event)) {
            (None, None) => return None,
            (Some(_), Some(cause)) => {
                *counts.borrow_mut().entry(kind(cause)).or_default() += 1;
                record.problem(event, cause)?
            }
            _ => "a time without a cause, or the other way round",
        };
        let label = network.label(event);
        Some(format!("{label}: {problem}: {:?}\n{:#?}", dispatcher.why(event), execution.rows))
    })
}

#[test]
fn every_cause_comes_to_the_time_it_is_said_to_have_decided() {
    let counts = Counts::default();
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    for seed in 0..cases(2000) {
        let network = partly_internal(seed, random::network(seed, &shapes[(seed % 4) as usize]));
        let broken = |network: &Network| {
            let plan = Plan::new(network).ok()?;
            let natures =
                [(Temper::Upper, 0), (Temper::Lower, 0), (Temper::Random, seed), (Temper::Random, !seed)];
            let strategies = [Strategy::Buffer, Strategy::Optimistic];
            strategies.into_iter().flat_map(|strategy| natures.map(|nature| (strategy, nature))).find_map(
                |(strategy, (nature, seed))| {
                    let simulation =
                        Simulation { strategy, nature, seed, internal: true, ..Simulation::default() };
                    wrong(&plan, &simulation, &counts)
                        .map(|problem| format!("{strategy:?} {nature:?} {seed}: {problem}"))
                },
            )
        };
        if broken(&network).is_some() {
            let small = random::shrunk(&network, |candidate| broken(candidate).is_some());
            let problem = broken(&small).unwrap_or_default();
            panic!("seed {seed} shrinks to\n{}\n{problem}", random::describe(&small));
        }
    }
    let counts = counts.into_inner();
    for known in ["start", "after", "surely", "no news", "news", "held", "anew"] {
        assert!(counts.get(known).is_some_and(|&count| count > 20), "hardly any `{known}`: {counts:?}");
    }
}
