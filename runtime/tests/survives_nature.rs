//! Executions of controllable networks keep every requirement in true time, whatever Nature does.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-runtime --release --test survives_nature` tries as many networks as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

#[path = "../../network/tests/oracle/mod.rs"]
mod oracle;

use kirk_network::time::Interval;
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::{
    Execution, How, Outcome, Plan, Row, Simulation, Strategy, Temper, lucky, simulate, verify,
};
use oracle::order::precedes;
use oracle::random::{self, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

fn shapes() -> [Shape; 4] {
    [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()]
}

fn run(plan: &Plan, strategy: Strategy, nature: Temper, seed: u64) -> Execution {
    let simulation = Simulation { strategy, nature, seed, ..Simulation::default() };
    simulate(plan, "random", &simulation).expect("no observations are prescribed")
}

/// When an event truly happened.
fn truth(network: &Network, execution: &Execution, event: EventId) -> Option<i64> {
    let row = execution.rows.iter().find(|row| row.event == network.id(event));
    row.and_then(|row| row.truth).map(Time::as_micros)
}

/// A requirement that does not hold in true time.
fn broken_requirement(network: &Network, execution: &Execution) -> Option<String> {
    network.requirements().iter().find_map(|requirement| {
        let end = |event| truth(network, execution, event).unwrap();
        let length = end(requirement.to) - end(requirement.from);
        let low = requirement.lower.finite().is_some_and(|lower| length < lower.as_micros());
        let high = requirement.upper.finite().is_some_and(|upper| length > upper.as_micros());
        (low || high).then(|| format!("{requirement:?} has length {length}"))
    })
}

/// What is wrong with an execution, by its true times alone, and by what it claims.
fn violation(network: &Network, execution: &Execution) -> Option<String> {
    if execution.outcome != Outcome::Completed {
        return Some(format!("{:?}", execution.failure));
    }
    if let Some(event) = network.event_ids().find(|&event| truth(network, execution, event).is_none()) {
        return Some(format!("{} never happened", network.id(event)));
    }
    if let Some(broken) = broken_requirement(network, execution) {
        return Some(broken);
    }
    let length = |from, to| truth(network, execution, to).unwrap() - truth(network, execution, from).unwrap();
    for link in network.contingents() {
        let length = length(link.from, link.to);
        assert!(
            (link.lower.as_micros()..=link.upper.as_micros()).contains(&length),
            "Nature cheats: {link:?}"
        );
    }
    for row in &execution.rows {
        let (Some(within), Some(truth)) = (row.happened, row.truth) else { continue };
        if !within.contains(truth) {
            return Some(format!("{} happened outside of what is claimed: {row:?}", row.event));
        }
    }
    if let Some(claim) = false_claim(network, execution) {
        return Some(claim);
    }
    // The verifier finds the same from what was recorded, and from what was heard alone.
    let mut heard = execution.clone();
    heard.rows.iter_mut().for_each(|row| row.truth = None);
    for recorded in [execution, &heard] {
        let text = serde_json::to_string(recorded).unwrap();
        let read: Execution = serde_json::from_str(&text).unwrap();
        assert_eq!(&read, recorded, "a record reads back equal");
        if let Some(violation) = verify(network, &read).first() {
            return Some(format!("verify: {violation:?}"));
        }
    }
    None
}

/// What a record says that is not so, the requirements aside.
fn false_claim(network: &Network, execution: &Execution) -> Option<String> {
    let precedes = precedes(network, None);
    let event = |at: usize| network.find(&execution.rows[at].event).unwrap();
    if network.find(&execution.rows[0].event) != Some(network.origin()) {
        return Some("it does not begin with the origin".to_string());
    }
    for (at, row) in execution.rows.iter().enumerate() {
        let over = row
            .time
            .max(row.truth)
            .max(row.happened.map(|within| within.latest).filter(|_| row.time.is_none()));
        if over > Some(execution.makespan) {
            return Some(format!("{} happened after all was over, at {:?}", row.event, execution.makespan));
        }
        if row.how == How::Buffered && row.observed.flatten() >= row.time {
            return Some(format!("nothing was held back: {row:?}"));
        }
        for later in at + 1..execution.rows.len() {
            let next = &execution.rows[later];
            let tie = row.time.is_some() && row.time == next.time;
            let origin = event(at) == network.origin();
            if tie && !origin && precedes(event(later), event(at)) {
                return Some(format!("{} is listed after {}", next.event, row.event));
            }
        }
    }
    None
}

fn natures(seed: u64) -> Vec<(Temper, u64)> {
    let mut natures = vec![(Temper::Upper, 0), (Temper::Lower, 0)];
    natures.extend((0..4).map(|n| (Temper::Random, seed * 4 + n)));
    natures
}

fn executions_hold(usual: u64, strategy: Strategy) {
    let mut executed = 0;
    for seed in 0..cases(usual) {
        let shape = &shapes()[(seed % 4) as usize];
        let network = random::network(seed, shape);
        let broken = |network: &Network| {
            let plan = Plan::new(network).ok()?;
            natures(seed).into_iter().find_map(|(nature, nature_seed)| {
                let execution = run(&plan, strategy, nature, nature_seed);
                let problem = violation(plan.network(), &execution)?;
                Some(format!("{nature:?} {nature_seed}: {problem}\n{:#?}", execution.rows))
            })
        };
        executed += u64::from(Plan::new(&network).is_ok());
        if let Some(problem) = broken(&network) {
            let small = random::shrunk(&network, |candidate| broken(candidate).is_some());
            let shrunk = broken(&small).unwrap_or_default();
            panic!(
                "seed {seed}:\n{}\n{problem}\nshrinks to\n{}\n{shrunk}",
                random::describe(&network),
                random::describe(&small)
            );
        }
    }
    assert!(executed * 4 > cases(usual), "too few of the networks are controllable: {executed}");
}

#[test]
fn buffering_executions_keep_every_requirement() {
    executions_hold(2000, Strategy::Buffer);
}

#[test]
fn optimistic_executions_keep_every_requirement() {
    executions_hold(2000, Strategy::Optimistic);
}

#[test]
fn optimistic_never_finishes_later_than_buffer_on_the_same_durations_and_delays() {
    for seed in 0..cases(2000) {
        let shape = &shapes()[(seed % 4) as usize];
        let network = random::network(seed, shape);
        let later = |network: &Network| {
            let plan = Plan::new(network).ok()?;
            natures(seed).into_iter().find_map(|(nature, nature_seed)| {
                let buffer = run(&plan, Strategy::Buffer, nature, nature_seed);
                let optimistic = run(&plan, Strategy::Optimistic, nature, nature_seed);
                (optimistic.makespan > buffer.makespan).then(|| {
                    let rows = |e: &Execution| {
                        e.rows
                            .iter()
                            .map(|r| format!("  {} {:?} {:?} {:?}\n", r.event, r.time, r.how, r.observed))
                            .collect::<String>()
                    };
                    format!("{nature:?}\nbuffer\n{}optimistic\n{}", rows(&buffer), rows(&optimistic))
                })
            })
        };
        if later(&network).is_some() {
            let small = random::shrunk(&network, |candidate| later(candidate).is_some());
            panic!(
                "seed {seed} shrinks to\n{}\n{}",
                random::describe(&small),
                later(&small).unwrap_or_default()
            );
        }
    }
}

#[test]
fn the_verifier_finds_every_decision_that_breaks_a_requirement() {
    let mut broken = 0;
    for seed in 0..cases(2000) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        let network = plan.network();
        let mut execution = run(&plan, Strategy::Optimistic, Temper::Random, seed);
        // One event of ours a little earlier or later; what activates a link would change what Nature does.
        let starts = |name: &str| network.contingents().iter().any(|link| network.id(link.from) == name);
        let ours: Vec<usize> = (1..execution.rows.len())
            .filter(|&at| {
                let name = &execution.rows[at].event;
                let alone =
                    network.find(name).is_some_and(|event| network.events()[event.index()].names.len() == 1);
                let last = execution.rows[at].time >= Some(execution.makespan);
                execution.rows[at].how == How::Dispatched && alone && !last && !starts(name)
            })
            .collect();
        if ours.is_empty() {
            continue;
        }
        let mut random = random::Random::new(seed);
        let row = &mut execution.rows[*random.choose(&ours)];
        let time = row.time.map_or(0, |time| time.as_micros());
        let moved = (time + random.within(-5..=5) * 1_000_000).max(0);
        row.time = Some(Time::from_micros(moved));
        row.truth = row.time;
        // Later than that, silence would say more, and the record would have to as well; and at the time of another event its
        // place in the record would matter.
        let when = |row: &Row| row.time.or(row.happened.map(|within| within.latest)).map(Time::as_micros);
        let beside = execution.rows.iter().filter(|row| when(row) == Some(moved)).count();
        if moved > execution.makespan.as_micros() || beside > 1 {
            continue;
        }
        execution.rows.sort_by_key(|row| when(row).unwrap_or(i64::MAX));
        if broken_requirement(network, &execution).is_some() {
            broken += 1;
            assert!(!verify(network, &execution).is_empty(), "seed {seed}: {}", random::describe(network));
        } else {
            assert_eq!(verify(network, &execution), [], "seed {seed}: {}", random::describe(network));
        }
    }
    assert!(broken * 20 > cases(2000), "only {broken} were broken");
}

#[test]
fn every_decision_is_known_to_be_over_in_time_order() {
    for seed in 0..cases(500) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        let execution = run(&plan, Strategy::Optimistic, Temper::Random, seed);
        let times: Vec<_> = execution.rows.iter().filter_map(|row| row.time).collect();
        assert!(times.is_sorted(), "seed {seed}: {:#?}", execution.rows);
        assert!(times.iter().all(|time| *time <= execution.makespan), "seed {seed}");
        for row in execution.rows.iter().filter(|row| row.how == How::Dispatched) {
            assert_eq!(row.time, row.truth, "seed {seed}");
        }
        assert_eq!(execution.rows[0].time.map(Time::as_micros), Some(Time::ZERO.as_micros()));
    }
}

/// What becomes of a record when one thing in it is changed, and what the verifier has to say of that.
type Slip = (&'static str, fn(&mut Execution) -> bool);

const SLIPS: [Slip; 14] = [
    ("not in time order", |execution| {
        let later = (1..execution.rows.len()).find(|&at| {
            let pair = (execution.rows[at - 1].time, execution.rows[at].time);
            matches!(pair, (Some(one), Some(other)) if one < other)
        });
        later.inspect(|&at| execution.rows.swap(at - 1, at)).is_some()
    }),
    ("do not fit `buffered`", |execution| {
        let at_once = |row: &&mut Row| row.how == How::Observed && row.time == row.observed.flatten();
        execution.rows.iter_mut().find(at_once).map(|row| row.how = How::Buffered).is_some()
    }),
    ("does not say when it truly happened", |execution| {
        execution.rows.last_mut().map(|row| row.truth = None).is_some()
    }),
    ("the makespan is said to be", |execution| {
        execution.makespan = later(execution.makespan);
        true
    }),
    ("has no row", |execution| execution.rows.pop().is_some()),
    ("has more than one row", |execution| {
        execution.rows.last().cloned().is_some_and(|row| {
            execution.rows.push(row);
            true
        })
    }),
    ("there is no event", |execution| {
        execution.rows.last_mut().map(|row| row.event.push_str(":never")).is_some()
    }),
    ("its row is not that of a dispatched event", |execution| {
        of(execution, How::Dispatched).map(|row| row.how = How::Observed).is_some()
    }),
    ("is dispatched, but true at another time", |execution| {
        of(execution, How::Dispatched).map(|row| row.truth = row.truth.map(later)).is_some()
    }),
    ("do not fit `dispatched`", |execution| {
        of(execution, How::Observed).map(|row| row.how = How::Dispatched).is_some()
    }),
    ("do not fit `observed`", |execution| {
        of(execution, How::Observed).map(|row| row.observed = Some(None)).is_some()
    }),
    ("is said to have happened in", |execution| {
        // Of one event, all rows say the same.
        let Some(first) = execution.rows.iter().find_map(|row| row.happened) else { return false };
        let alike = execution.rows.iter_mut().filter_map(|row| row.happened.as_mut());
        alike.filter(|claim| **claim == first).for_each(|claim| claim.earliest = later(claim.earliest));
        true
    }),
    ("do not fit `never`", |execution| {
        of(execution, How::Observed).map(|row| row.how = How::Never).is_some()
    }),
    ("is recorded as failed", |execution| {
        execution.outcome = Outcome::Failed;
        true
    }),
];

/// The first row of this kind.
fn of(execution: &mut Execution, how: How) -> Option<&mut Row> {
    execution.rows.iter_mut().find(|row| row.how == how)
}

/// As little later as can be said.
fn later(time: Time) -> Time {
    time.saturating_add(Duration::SHORTEST)
}

#[test]
fn the_verifier_names_every_slip_in_a_record() {
    let mut found = [0_u64; SLIPS.len()];
    for seed in 0..cases(500) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        for (at, (said, slip)) in SLIPS.iter().enumerate() {
            let mut execution = run(&plan, Strategy::Optimistic, Temper::Random, seed);
            if !slip(&mut execution) {
                continue;
            }
            found[at] += 1;
            let messages: Vec<String> =
                verify(plan.network(), &execution).into_iter().map(|violation| violation.message).collect();
            let named = messages.iter().any(|message| message.contains(said));
            assert!(named, "seed {seed}: {said} is not among {messages:#?}\n{:#?}", execution.rows);
        }
    }
    assert!(found.iter().all(|&found| found * 20 > cases(500)), "{found:?}");
}

#[test]
fn what_held_by_luck_alone_is_told() {
    // News of `b` is 0 to 10 s late, and `c` is to come within 1 s of it: nobody could know, but somebody was lucky.
    let network = kirk_network::json::read(
        r#"{"format": "kirk-network/1", "name": "luck", "origin": "a", "events": ["a", "b", "c"],
            "requirements": [{"from": "b", "to": "c", "lower": 0, "upper": 1}],
            "contingents": [{"from": "a", "to": "b", "lower": 1, "upper": 5, "delay": [0, 10]}]}"#,
    )
    .unwrap();
    let row = |event: &str, time: &str, how: &str, truth: &str, rest: &str| {
        format!(r#"{{"event": "{event}", "time": {time}, "how": "{how}", "true": {truth}{rest}}}"#)
    };
    let rows = [
        row("a", "0", "dispatched", "0", ""),
        row("b", "5", "observed", "4", r#", "observed": 5, "happened": [1, 5]"#),
        row("c", "5", "dispatched", "5", ""),
    ];
    let text = format!(
        r#"{{"format": "kirk-execution/1", "program": "luck", "outcome": "completed", "makespan": 5, "rows": [{}]}}"#,
        rows.join(", ")
    );
    let execution: Execution = serde_json::from_str(&text).unwrap();
    assert_eq!(verify(&network, &execution), []);
    let lucky = lucky(&network, &execution);
    assert!(
        lucky.len() == 1 && lucky[0].message.contains("`c` must come at most 1 s after `b`"),
        "{lucky:?}"
    );
}

#[test]
fn the_verifier_finds_every_claim_that_does_not_follow() {
    let mut claims = 0;
    for seed in 0..cases(1000) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        let network = plan.network();
        let execution = run(&plan, Strategy::Optimistic, Temper::Random, seed);
        let mut over = execution.clone();
        over.makespan = over.makespan.saturating_sub(Duration::SHORTEST);
        assert!(
            !verify(network, &over).is_empty(),
            "over too soon, seed {seed}: {}",
            random::describe(network)
        );
        for at in 0..execution.rows.len() {
            let Some(Interval { earliest: low, latest: high }) = execution.rows[at].happened else {
                continue;
            };
            for (by_low, by_high) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let mut claimed = execution.clone();
                let moved = |time: Time, by: i64| Time::from_micros(time.as_micros() + by);
                claimed.rows[at].happened = Some(Interval::new(moved(low, by_low), moved(high, by_high)));
                let what = format!("{:?}, seed {seed}: {}", claimed.rows[at], random::describe(network));
                assert!(!verify(network, &claimed).is_empty(), "{what}");
                claims += 1;
            }
        }
    }
    assert!(claims as u64 > cases(1000), "only {claims} claims");
}
