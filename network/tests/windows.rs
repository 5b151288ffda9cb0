//! Windows of events against all shortest paths, and against what has really been executed.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::windows::{Window, windows};
use kirk_network::{Bound, Network, Time, json};
use oracle::random::{self, Shape};

/// Floyd and Warshall on the bounds of everything, with "not before the origin".
fn oracle(network: &Network) -> Option<Vec<Window>> {
    const FAR: i64 = i64::MAX / 4;
    let count = network.events().len();
    let origin = network.origin().index();
    let mut distance = vec![vec![FAR; count]; count];
    for (event, row) in distance.iter_mut().enumerate() {
        row[event] = 0;
        row[origin] = 0;
    }
    let mut edge = |from: usize, to: usize, weight: i64| {
        distance[from][to] = distance[from][to].min(weight);
    };
    for requirement in network.requirements() {
        let (from, to) = (requirement.from.index(), requirement.to.index());
        if let Bound::Finite(upper) = requirement.upper {
            edge(from, to, upper.as_micros());
        }
        if let Bound::Finite(lower) = requirement.lower {
            edge(to, from, -lower.as_micros());
        }
    }
    for link in network.contingents() {
        edge(link.from.index(), link.to.index(), link.upper.as_micros());
        edge(link.to.index(), link.from.index(), -link.lower.as_micros());
    }
    for middle in 0..count {
        for from in 0..count {
            for to in 0..count {
                if distance[from][middle] < FAR && distance[middle][to] < FAR {
                    distance[from][to] =
                        distance[from][to].min(distance[from][middle] + distance[middle][to]);
                }
            }
        }
    }
    let window = |event: usize| Window {
        earliest: Time::from_micros(-distance[event][origin]),
        latest: Some(distance[origin][event]).filter(|far| *far < FAR).map(Time::from_micros),
    };
    (0..count).all(|event| distance[event][event] >= 0).then(|| (0..count).map(window).collect())
}

#[test]
fn windows_are_the_shortest_paths_from_and_to_the_origin() {
    let cases = std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(4_000);
    let shapes = [Shape::tiny(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let mut possible = 0;
    for seed in 0..cases {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let found = windows(&network);
        assert_eq!(found, oracle(&network), "seed {seed}:\n{}", random::describe(&network));
        possible += u64::from(found.is_some());
    }
    assert!(possible > cases / 10 && possible < cases, "{possible} of {cases} networks have windows");
}

#[test]
fn the_window_of_an_event_is_what_its_bounds_leave_it() {
    let text = r#"{"format": "kirk-network/1", "origin": "start", "events": ["start", "scanned", "act", "free"],
        "requirements": [{"from": "scanned", "to": "act", "lower": 2}, {"from": "start", "to": "act", "upper": 40}],
        "contingents": [{"from": "start", "to": "scanned", "lower": 15, "upper": 30, "delay": [5, 15]}]}"#;
    let windows = windows(&json::read(text).unwrap()).unwrap();
    let seconds =
        |window: &Window| (window.earliest.to_string(), window.latest.map(|latest| latest.to_string()));
    let shown: Vec<_> = windows.iter().map(seconds).collect();
    let at = |earliest: &str, latest: Option<&str>| (earliest.to_string(), latest.map(str::to_string));
    assert_eq!(
        shown,
        [at("0", Some("0")), at("15", Some("30")), at("17", Some("40")), at("0", None)],
        "the news of an end does not say when it is possible"
    );
}
