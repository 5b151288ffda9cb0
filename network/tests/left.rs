//! What is left of an execution against the game, in which both sides do all they can without our losing anything.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::left::{Seen, can_be_kept, given_up, left, promise_left};
use kirk_network::merge::merge;
use kirk_network::promise::Promise;
use kirk_network::{Bound, Duration, EventId, Network, Part, Requirement, Time};
use oracle::game::reach::Middle;
use oracle::random::{self, Random, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

fn shapes() -> [Shape; 4] {
    let small =
        |shape: Shape| Shape { executables: 1..=3, links: 1..=2, lower: 3, spread: 3, delay: 3, ..shape };
    [
        small(Shape::tiny()),
        Shape { variable: 0, infinite: 0, fixed: 60, ..small(Shape::tiny_delayed()) },
        small(Shape::tiny_delayed()),
        small(Shape::tiny_delayed().chained()),
    ]
}

/// The middle of a game that is won, from a seed.
fn middle(network: &Network, seed: u64) -> Option<Middle> {
    let mut random = Random::new(seed);
    let mut middle = Middle::start(network, &mut random)?;
    for _ in 0..random.within(0..=12) {
        middle.go_on(&mut random);
    }
    middle.pause(&mut random);
    Some(middle)
}

/// Merging makes chains as well.
fn is_chained(network: &Network) -> bool {
    network.contingents().iter().any(|link| network.link_of(link.from).is_some())
}

#[test]
fn nothing_happens_outside_of_what_is_left_and_what_is_exact_is_reached() {
    const HORIZON: i16 = 40;
    let (mut compared, mut exact, mut tight) = (0_u64, 0_u64, 0_u64);
    for seed in 0..cases(3_000) {
        let shape = &shapes()[(seed % 4) as usize];
        let network = merge(&random::network(seed, shape)).network;
        let Some(mut middle) = middle(&network, seed) else { continue };
        let so_far = middle.so_far(&network);
        let described = || format!("seed {seed}: {so_far:#?}\n{}", random::describe(&network));
        let kept = can_be_kept(&network, &so_far);
        assert!(kept || is_chained(&network), "only in chains the plan may be too careful: {}", described());
        let left = left(&network, &so_far);
        let Some(reach) = middle.reachable(HORIZON) else { continue };
        for (event, (first, last)) in reach {
            let time = |steps: i16| Time::from_micros(i64::from(steps) * middle.step);
            let found = left[event.index()];
            let last = Some(time(last)).filter(|last| *last < time(HORIZON));
            let what =
                || format!("{} is {found:?}, {first} to {last:?}, {}", network.label(event), described());
            let latest = found.window.latest.filter(|latest| *latest < time(HORIZON));
            assert!(found.window.earliest <= time(first), "too early: {}", what());
            assert!(
                latest.is_none_or(|latest| last.is_some_and(|last| last <= latest)),
                "too late: {}",
                what()
            );
            assert!(!found.earliest_is_exact || found.window.earliest == time(first), "{}", what());
            assert!(!found.latest_is_exact || latest == last, "{}", what());
            if seed % 4 < 2 && !is_chained(&network) {
                assert!(
                    found.earliest_is_exact && found.latest_is_exact,
                    "exact without late news: {}",
                    what()
                );
            }
            compared += 2;
            exact += u64::from(found.earliest_is_exact) + u64::from(found.latest_is_exact);
            tight += u64::from(found.window.earliest == time(first)) + u64::from(latest == last);
        }
    }
    assert!(compared * 3 > cases(3_000), "only {compared} compared");
    assert!(exact * 10 > compared * 9 && tight >= exact, "of {compared} {exact} are exact, {tight} reached");
}

/// The network with one more requirement on the time of an event, in steps.
fn with(network: &Network, event: EventId, lower: Option<i64>, upper: Option<i64>) -> Network {
    let bound =
        |micros: Option<i64>| micros.map_or(Bound::Infinite, |micros| Duration::from_micros(micros).into());
    let more = Requirement { from: network.origin(), to: event, lower: bound(lower), upper: bound(upper) };
    let requirements = network.requirements().iter().copied().chain([more]).collect();
    changed(network, requirements)
}

fn changed(network: &Network, requirements: Vec<Requirement>) -> Network {
    let (events, contingents) = (network.events().to_vec(), network.contingents().to_vec());
    Network::new(network.name().to_string(), network.origin(), events, requirements, contingents).unwrap()
}

#[test]
fn what_is_promised_can_be_kept_and_no_more_can() {
    let mut promised = 0;
    for seed in 0..cases(1_500) {
        let network = merge(&random::network(seed, &shapes()[(seed % 3) as usize])).network;
        let Some(middle) = middle(&network, seed).filter(|_| !is_chained(&network)) else { continue };
        let so_far = middle.so_far(&network);
        let to_come = middle.roots[1..].iter().filter(|event| so_far.events[event.index()] == Seen::ToCome);
        for &event in to_come {
            let described = || {
                format!("seed {seed}, {}: {so_far:#?}\n{}", network.label(event), random::describe(&network))
            };
            let wins = |lower, upper| middle.is_won_under(&with(&network, event, lower, upper));
            let Promise { by, from } =
                promise_left(&network, &so_far, event).unwrap().unwrap_or_else(|| panic!("{}", described()));
            let (micros, step) = (|time: Time| time.as_micros(), middle.step);
            let by_holds = match by.map(micros) {
                Some(by) => wins(None, Some(by)) && !wins(None, Some(by - step)),
                None => !wins(None, Some(200 * step)),
            };
            assert!(by_holds, "by {by:?}, {}", described());
            let from_holds = match from.map(micros) {
                Some(from) => wins(Some(from), None) && !wins(Some(from + step), None),
                None => wins(Some(200 * step), None),
            };
            assert!(from_holds, "from {from:?}, {}", described());
            promised += 1;
        }
    }
    assert!(promised * 3 > cases(1_500), "only {promised} promises");
}

#[test]
fn what_is_given_up_is_needed_and_enough() {
    let mut given = 0;
    for seed in 0..cases(1_500) {
        let network = merge(&random::network(seed, &shapes()[(seed % 3) as usize])).network;
        let Some(middle) = middle(&network, seed).filter(|_| !is_chained(&network)) else { continue };
        let so_far = middle.so_far(&network);
        let ours = middle.roots[1..].iter().find(|event| so_far.events[event.index()] == Seen::ToCome);
        let Some(&event) = ours else { continue };
        // A step less than can be promised.
        let Some(Promise { by: Some(by), .. }) = promise_left(&network, &so_far, event).unwrap() else {
            continue;
        };
        let network = with(&network, event, None, Some(by.as_micros() - middle.step));
        let described = || format!("seed {seed}: {so_far:#?}\n{}", random::describe(&network));
        assert!(!can_be_kept(&network, &so_far), "{}", described());
        let parts = given_up(&network, &so_far).unwrap();
        let without = |parts: &[Part]| {
            let mut requirements = network.requirements().to_vec();
            for part in parts {
                match *part {
                    Part::RequirementLower(index) => requirements[index].lower = Bound::Infinite,
                    Part::RequirementUpper(index) => requirements[index].upper = Bound::Infinite,
                    _ => panic!("{part:?} is not ours to give up"),
                }
            }
            changed(&network, requirements)
        };
        assert!(middle.is_won_under(&without(&parts)), "{parts:?} are not enough, {}", described());
        for kept in &parts {
            let fewer: Vec<Part> = parts.iter().copied().filter(|part| part != kept).collect();
            assert!(
                !middle.is_won_under(&without(&fewer)),
                "{kept:?} of {parts:?} can be kept, {}",
                described()
            );
        }
        given += 1;
    }
    assert!(given * 4 > cases(1_500), "only {given} cases");
}
