//! An event that can never be executed late cannot be executed a moment later, by the verdict of the check.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::punctual::punctual;
use kirk_network::{Bound, Duration, EventId, Network, Requirement, Verdict, check, json};
use oracle::random::{self, Shape};

/// The network in which `later` also comes at least, and at most, so long after `first`.
fn with(network: &Network, first: EventId, later: EventId, lower: Bound, upper: Bound) -> Network {
    let mut requirements = network.requirements().to_vec();
    requirements.push(Requirement { from: first, to: later, lower, upper });
    let (events, links) = (network.events().to_vec(), network.contingents().to_vec());
    Network::new(network.name().to_string(), network.origin(), events, requirements, links).unwrap()
}

fn controllable(network: &Network) -> bool {
    check(network).unwrap() == Verdict::Controllable
}

#[test]
fn a_moment_later_or_earlier_is_impossible_and_the_bounds_say_why() {
    let mut tried = 0;
    let shapes = [
        Shape::tiny(),
        Shape::tiny_delayed(),
        Shape::tiny().chained(),
        Shape::medium(),
        Shape::medium().chained(),
    ];
    let usual = std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(4000);
    for seed in 0..usual {
        let network = random::network(seed, &shapes[(seed % shapes.len() as u64) as usize]);
        let Some(found) = punctual(&network).unwrap() else {
            assert!(!controllable(&network), "seed {seed}");
            continue;
        };
        for group in &found.groups {
            for exact in &group.others {
                let Some(shares) = found.because(group, exact, &network).unwrap() else { continue };
                let said: i64 = shares.iter().map(|share| share.amount.as_micros()).sum();
                let what = format!("seed {seed}: {exact:?} of {group:?}\n{}", random::describe(&network));
                assert_eq!(said, 0, "{shares:?} {what}");
                // The moment of acting on late news is no event of the network.
                let delayed = |event: EventId| {
                    network
                        .link_of(event)
                        .is_some_and(|link| network.contingents()[link].delay != kirk_network::Delay::NONE)
                };
                if group.news && group.first.iter().any(|event| delayed(*event)) {
                    continue;
                }
                let (first, later) = (group.first[0], exact.events[0]);
                let at = |shift: i64| Bound::Finite(Duration::from_micros(exact.after.as_micros() + shift));
                assert!(controllable(&with(&network, first, later, at(0), at(0))), "exactly then, {what}");
                assert!(
                    !controllable(&with(&network, first, later, at(1), Bound::Infinite)),
                    "later, {what}"
                );
                assert!(
                    !controllable(&with(&network, first, later, Bound::Infinite, at(-1))),
                    "earlier, {what}"
                );
                tried += 1;
            }
        }
    }
    assert!(tried > usual / 200, "only {tried} events were found");
}

fn read(requirements: &str, delay: &str) -> Network {
    json::read(&format!(
        r#"{{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "c", "x"],
            "requirements": [{requirements}],
            "contingents": [{{"from": "a", "to": "c", "lower": 10, "upper": 40{delay}}}]}}"#
    ))
    .unwrap()
}

/// The names of what was found, and after how many seconds.
fn found(network: &Network) -> Vec<String> {
    let found = punctual(network).unwrap().unwrap();
    let mut list = Vec::new();
    for group in &found.groups {
        for exact in &group.others {
            if found.because(group, exact, network).unwrap().is_some() {
                list.push(format!(
                    "{} {} after {}",
                    network.id(exact.events[0]),
                    exact.after,
                    network.id(group.first[0])
                ));
            }
        }
    }
    list
}

#[test]
fn what_a_single_constraint_says_is_not_found_and_what_two_say_is() {
    let written = r#"{"from": "z", "to": "x", "lower": 5, "upper": 5}"#;
    assert_eq!(found(&read(written, "")), Vec::<String>::new());
    let meeting = r#"{"from": "z", "to": "x", "lower": 5}, {"from": "z", "to": "x", "upper": 5}"#;
    assert_eq!(found(&read(meeting, "")), ["x 5 after z"]);
    let with_news = r#"{"from": "c", "to": "x", "lower": 3}, {"from": "c", "to": "x", "upper": 3}"#;
    assert_eq!(found(&read(with_news, "")), ["x 3 after c"]);
}

#[test]
fn what_news_may_relax_in_time_is_not_found() {
    // At the worst, c is at 40 and x has to be exactly then; but whoever hears of c sooner has until 40.
    let deadline = r#"{"from": "z", "to": "a", "lower": 0, "upper": 0}, {"from": "c", "to": "x", "lower": 0},
        {"from": "z", "to": "x", "upper": 40}"#;
    assert_eq!(found(&read(deadline, r#", "delay": [0, null]"#)), Vec::<String>::new());
    // Without the join, `a` has to be at once: no news of c comes before that.
    let deadline = r#"{"from": "c", "to": "x", "lower": 0}, {"from": "z", "to": "x", "upper": 40}"#;
    assert_eq!(found(&read(deadline, r#", "delay": [0, null]"#)), ["a 0 after z"]);
}
