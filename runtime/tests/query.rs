//! What is said of executions in the middle of them, against what then happens.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

#[path = "../../network/tests/oracle/mod.rs"]
mod oracle;

use std::collections::BTreeSet;

use kirk_network::{EventId, Network, Time};
use kirk_runtime::query::Unheard;
use kirk_runtime::{
    Cause, Execution, Heard, How, Lost, Outcome, Plan, Row, Side, Simulation, Situation, Temper, simulate,
};
use oracle::random::{self, Random, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

fn shapes() -> [Shape; 4] {
    [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()]
}

fn is_chained(network: &Network) -> bool {
    network.contingents().iter().any(|link| network.link_of(link.from).is_some())
}

fn truth(network: &Network, execution: &Execution, event: EventId) -> Option<Time> {
    execution.rows.iter().find(|row| row.event == network.id(event)).and_then(|row| row.truth)
}

fn run(plan: &Plan, simulation: &Simulation) -> Execution {
    simulate(plan, "random", simulation).unwrap()
}

#[test]
fn whatever_happens_then_was_possible_before() {
    let (mut compared, mut reached) = (0_u64, 0_u64);
    for seed in 0..cases(600) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        let network = plan.network();
        let temper = [Temper::Random, Temper::Lower, Temper::Random, Temper::Upper][(seed / 4 % 4) as usize];
        let execution =
            run(&plan, &Simulation { nature: temper, seed, internal: true, ..Simulation::default() });
        let mut random = Random::new(seed);
        let now = Time::from_micros(random.within(0..=execution.makespan.as_micros()));
        let described =
            || format!("seed {seed} at {now}: {:#?}\n{}", execution.rows, random::describe(network));
        let situation = Situation::of_record(&plan, &execution, Some(now)).unwrap();
        assert!(situation.can_be_kept() || is_chained(network), "{}", described());
        let left = situation.left();
        for event in network.event_ids() {
            let Some(truth) = truth(network, &execution, event) else { continue };
            let left = left[event.index()];
            let early = left.window.earliest;
            let within = early <= truth && left.window.latest.is_none_or(|latest| truth <= latest);
            assert!(within, "{} is {left:?}, {}", network.label(event), described());
            // As much as a person would ask: what can be heard of is heard in time.
            let heard = execution.rows.iter().find(|row| row.event == network.id(event)).unwrap().observed;
            if let (Some(Some(heard)), None, Some((from, to))) =
                (heard, situation.heard_of(event), situation.news(&left, event))
            {
                assert!(
                    from <= heard && to.is_none_or(|to| heard <= to),
                    "news {from} to {to:?}, {}",
                    described()
                );
            }
            compared += 1;
            reached += u64::from(left.earliest_is_exact);
        }
    }
    assert!(compared > cases(600), "only {compared} events");
    assert!(
        reached * 10 > compared * 8,
        "of {compared} only {reached} are known to be possible at the earliest"
    );
}

/// What decides a time is before it, and the chain ends with what has happened, or with nothing to wait for.
#[test]
fn a_chain_goes_back_to_what_has_happened() {
    let mut links = 0;
    for seed in 0..cases(600) {
        let network = random::network(seed, &shapes()[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&network) else { continue };
        let network = plan.network();
        let mut situation = Situation::of_mission(&plan);
        situation.pass(Time::from_micros(Random::new(seed).within(0..=20_000_000)));
        for event in network.event_ids() {
            let waits = situation.waits(event);
            let described = || format!("seed {seed}: {waits:?}\n{}", random::describe(network));
            let time = |event: EventId| waits.ahead.known(event).fixed.map(|fixed| fixed.time);
            for pair in waits.events.windows(2) {
                // Of Nature's, news may not be waited for so long.
                let ours = network.link_of(pair[1]).is_none();
                if let (Some(later), Some(earlier), true) = (time(pair[0]), time(pair[1]), ours) {
                    assert!(earlier <= later, "{}", described());
                }
                assert!(situation.fixed(pair[0]).is_none(), "{}", described());
                links += 1;
            }
            let last = *waits.events.last().unwrap();
            let cause = waits.ahead.why(last);
            let ends = situation.fixed(last).is_some()
                || cause.is_none_or(|cause| matches!(cause, Cause::Start | Cause::Anew { .. }));
            assert!(ends, "{}", described());
        }
    }
    assert!(links as u64 > cases(600), "only {links} links");
}

/// A requirement's bound that does not hold in true time.
fn broken(network: &Network, execution: &Execution) -> BTreeSet<String> {
    let mut broken = BTreeSet::new();
    for requirement in network.requirements() {
        let (Some(from), Some(to)) =
            (truth(network, execution, requirement.from), truth(network, execution, requirement.to))
        else {
            continue;
        };
        let length = to.as_micros() - from.as_micros();
        let (from, to) = (network.label(requirement.from), network.label(requirement.to));
        if requirement.lower.finite().is_some_and(|lower| length < lower.as_micros()) {
            broken.insert(format!("{from} {to} {:?} {:?}", Side::Lower, requirement.lower.finite()));
        }
        if requirement.upper.finite().is_some_and(|upper| length > upper.as_micros()) {
            broken.insert(format!("{from} {to} {:?} {:?}", Side::Upper, requirement.upper.finite()));
        }
    }
    broken
}

fn names<'a>(lost: impl IntoIterator<Item = &'a Lost>) -> BTreeSet<String> {
    let name =
        |Lost { from, to, bound, value, .. }: &Lost| format!("{from} {to} {bound:?} {:?}", Some(value));
    lost.into_iter().map(name).collect()
}

/// A random mission, one of Nature's events, and when it is said to be heard.
fn rumour(seed: u64) -> Option<(Plan, EventId, Time, Random)> {
    let plan = Plan::new(&random::network(seed, &shapes()[(seed % 4) as usize])).ok()?;
    let mut random = Random::new(seed);
    let event = plan.network().contingents().get(random.within(0..=3) as usize)?.to;
    let time = Time::from_micros(random.within(0..=40) * 1_000_000);
    Some((plan, event, time, random))
}

/// Nature may do what she likes once; what is said to be kept then is kept, and what is broken is named.
#[test]
fn a_rehearsal_breaks_what_it_says_and_nothing_else() {
    let (mut mended, mut failed) = (0, 0);
    for seed in 0..cases(1_200) {
        let Some((plan, event, time, mut random)) = rumour(seed) else { continue };
        let network = plan.network();
        let simulation = Simulation {
            nature: [Temper::Upper, Temper::Lower, Temper::Random][random.within(0..=2) as usize],
            seed,
            observations: vec![(event, time)],
            internal: true,
            what_if: true,
            ..Simulation::default()
        };
        // News of what has not begun is refused.
        let Ok(execution) = simulate(&plan, "random", &simulation) else { continue };
        let described = || format!("seed {seed}: {execution:#?}\n{}", random::describe(network));
        let really = broken(network, &execution);
        // What Nature does against the model and nobody has heard of, nobody can know.
        let is_heard =
            |row: &Row| network.find(&row.event) == Some(event) && row.observed.flatten().is_some();
        for row in execution.rows.iter().filter(|_| execution.rows.iter().any(is_heard)) {
            if let (Some(happened), Some(truth)) = (row.happened, row.truth) {
                assert!(happened.contains(truth), "{}: {}", row.event, described());
            }
        }
        if execution.outcome != Outcome::BrokenModel {
            assert_eq!((execution.outcome, really), (Outcome::Completed, BTreeSet::new()), "{}", described());
            continue;
        }
        let told = execution.what_if.as_ref().unwrap_or_else(|| panic!("{}", described()));
        assert!(really.is_superset(&names(&told.violated)), "{}", described());
        if told.guaranteed {
            assert_eq!(names(&told.violated), really, "{}", described());
            mended += 1;
        } else {
            // What would have to be given up may be broken already.
            let is_lost = !told.given_up.is_empty() || !told.violated.is_empty();
            assert!(is_chained(network) || is_lost, "{}", described());
            failed += 1;
        }
    }
    assert!(mended * 20 > cases(1_200) && failed * 200 > cases(1_200), "{mended} mended, {failed} failed");
}

/// A question is answered as the rehearsal goes.
#[test]
fn what_if_something_is_heard_is_what_a_rehearsal_does() {
    let (mut possible, mut beyond) = (0, 0);
    for seed in 0..cases(1_200) {
        // Nothing but this is ever heard.
        let Some((plan, event, time, _)) = rumour(seed) else { continue };
        let network = plan.network();
        let mut situation = Situation::of_mission(&plan);
        let described =
            || format!("seed {seed}, {} at {time}\n{}", network.label(event), random::describe(network));
        match situation.hear(event, time) {
            Err(Unheard::NotBegun { start }) => assert!(situation.fixed(start).is_none(), "{}", described()),
            Err(unheard) => panic!("{unheard:?}, {}", described()),
            Ok(heard) => {
                assert_eq!(situation.heard_of(event), Some(time), "{}", described());
                match heard {
                    Heard::Possible => {
                        assert!(situation.can_be_kept() || is_chained(network), "{}", described());
                        possible += 1;
                    }
                    Heard::Broken(_, aftermath) => {
                        // In a chain a plan may be too careful.
                        let agrees = aftermath.guaranteed == situation.can_be_kept();
                        assert!(agrees || is_chained(network), "{}", described());
                        let how = situation.fixed(event).map(|(_, how)| how);
                        assert_ne!(how, Some(How::Dispatched), "{}", described());
                        beyond += 1;
                    }
                }
            }
        }
    }
    assert!(
        possible * 25 > cases(1_200) && beyond * 25 > cases(1_200),
        "{possible} possible, {beyond} beyond"
    );
}
