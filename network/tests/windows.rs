//! Windows of events against all shortest paths in the labelled closure, and against what is really executed.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::promise::promises;
use kirk_network::windows::{Window, windows};
use kirk_network::{EventId, Network, Time, Verdict, check, json};
use oracle::closure;
use oracle::random::{self, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// Everything that follows from a network without delays, once Nature has chosen: Floyd and Warshall on the closure.
fn distances(network: &Network, choice: impl Fn(usize) -> i64) -> Option<Vec<Vec<i64>>> {
    let closure::Closed { ordinary, upper } = closure::closed(network)?;
    let mut distance = ordinary;
    let count = distance.len();
    for (index, link) in network.contingents().iter().enumerate() {
        let (from, to, chosen) = (link.from.index(), link.to.index(), choice(index));
        distance[from][to] = distance[from][to].min(chosen);
        distance[to][from] = distance[to][from].min(-chosen);
        for (event, &wait) in upper[index].iter().enumerate() {
            if wait < closure::NONE {
                distance[event][from] = distance[event][from].min(wait.max(-chosen));
            }
        }
    }
    for middle in 0..count {
        for from in 0..count {
            for to in 0..count {
                if distance[from][middle] < closure::NONE && distance[middle][to] < closure::NONE {
                    distance[from][to] =
                        distance[from][to].min(distance[from][middle] + distance[middle][to]);
                }
            }
        }
    }
    Some(distance)
}

fn oracle(network: &Network) -> Option<Vec<Window>> {
    let least = distances(network, |link| network.contingents()[link].lower.as_micros())?;
    let most = distances(network, |link| network.contingents()[link].upper.as_micros())?;
    let origin = network.origin().index();
    let window = |event: usize| Window {
        earliest: Time::from_micros(-least[event][origin]),
        latest: Some(most[origin][event]).filter(|far| *far < closure::NONE).map(Time::from_micros),
    };
    Some((0..network.events().len()).map(window).collect())
}

#[test]
fn windows_are_the_shortest_paths_of_the_closure_for_the_least_and_the_most() {
    let shapes = [Shape::tiny(), Shape::tiny().chained(), Shape::medium(), Shape::medium().chained()];
    let mut possible = 0;
    for seed in 0..cases(1_000) {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let found = windows(&network);
        assert_eq!(found, oracle(&network), "seed {seed}:\n{}", random::describe(&network));
        possible += u64::from(found.is_some());
    }
    assert!(possible > cases(1_000) / 10, "{possible} networks have windows");
}

/// No choice of Nature makes a window wider than its extremes do.
#[test]
fn every_other_choice_of_nature_stays_within_the_windows() {
    let shapes = [Shape::tiny(), Shape::medium()];
    for seed in 0..cases(600) {
        let network = random::network(seed, &shapes[(seed % 2) as usize]);
        let Some(windows) = windows(&network) else { continue };
        let random = &mut random::Random::new(seed);
        let choices: Vec<i64> = network
            .contingents()
            .iter()
            .map(|link| random.within(link.lower.as_micros()..=link.upper.as_micros()))
            .collect();
        let distance = distances(&network, |link| choices[link]).unwrap();
        let origin = network.origin().index();
        for (event, window) in windows.iter().enumerate() {
            let early = -distance[event][origin];
            let late = Some(distance[origin][event]).filter(|far| *far < closure::NONE);
            let within = window.earliest.as_micros() <= early
                && window.latest.is_none_or(|latest| late.is_some_and(|late| late <= latest.as_micros()));
            assert!(within, "seed {seed}, event {event}:\n{}", random::describe(&network));
        }
    }
}

/// Late news leaves less: what can be promised is within what can happen.
#[test]
fn promises_are_within_the_windows() {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let mut compared = 0;
    for seed in 0..cases(800) {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let events: Vec<EventId> = network.event_ids().collect();
        let (Some(windows), Some(promises)) = (windows(&network), promises(&network, &events).unwrap())
        else {
            assert_ne!(check(&network).unwrap(), Verdict::Controllable);
            continue;
        };
        for (event, (window, promise)) in windows.iter().zip(&promises).enumerate() {
            compared += 1;
            let within = promise.by.is_none_or(|by| window.earliest <= by)
                && window.latest.is_none_or(|latest| promise.from.is_some_and(|from| from <= latest));
            assert!(
                within,
                "seed {seed}, event {event}, {window:?}, {promise:?}:\n{}",
                random::describe(&network)
            );
        }
    }
    assert!(compared > 500, "{compared} events");
}

#[test]
fn the_window_of_an_event_is_what_the_guarantee_leaves_it() {
    let text = r#"{"format": "kirk-network/1", "origin": "start", "events": ["start", "scanned", "act", "free"],
        "requirements": [{"from": "scanned", "to": "act", "lower": 2}, {"from": "start", "to": "act", "upper": 40}],
        "contingents": [{"from": "start", "to": "scanned", "lower": 15, "upper": 30, "delay": [5, 15]}]}"#;
    let network = json::read(text).unwrap();
    assert_eq!(check(&network).unwrap(), Verdict::Controllable);
    let seconds =
        |window: &Window| (window.earliest.to_string(), window.latest.map(|latest| latest.to_string()));
    let shown: Vec<_> = windows(&network).unwrap().iter().map(seconds).collect();
    let at = |earliest: &str, latest: Option<&str>| (earliest.to_string(), latest.map(str::to_string));
    assert_eq!(
        shown,
        [at("0", Some("0")), at("15", Some("30")), at("20", Some("40")), at("0", None)],
        "acting at 17 s would do only if it were known at 15 s that the scan is done; it is heard 5 s later"
    );
}
