//! Generated networks are the same every time, keep to their distributions, and are not all alike.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use kirk_network::generate::{
    Bounds, Exponential, GenerateError, Lambda, LaneOptions, Link, MOST_EVENTS, RepeaterOptions,
    SamplingOptions, controllable, lanes, repeaters, sampling,
};
use kirk_network::{Bound, Duration, Network, Requirement, Verdict, check, json};

fn is_controllable(network: &Network) -> bool {
    check(network) == Ok(Verdict::Controllable)
}

/// How many of the seeds 0 to 99 give a controllable network.
fn yes(make: impl Fn(u64) -> Result<Network, GenerateError>) -> usize {
    (0..100).filter(|&seed| is_controllable(&make(seed).unwrap())).count()
}

fn seconds(duration: Duration) -> i64 {
    assert_eq!(duration.as_micros() % 1_000_000, 0, "{duration}");
    duration.as_micros() / 1_000_000
}

fn finite(bound: Bound) -> i64 {
    seconds(bound.finite().unwrap())
}

fn requirement<'n>(network: &'n Network, from: &str, to: &str) -> &'n Requirement {
    let (from, to) = (network.find(from).unwrap(), network.find(to).unwrap());
    network.requirements().iter().find(|r| (r.from, r.to) == (from, to)).unwrap()
}

#[test]
fn the_same_seed_gives_the_same_network_and_another_seed_another() {
    let make: [fn(u64) -> Network; 3] = [
        |seed| repeaters(3, 4, seed, &RepeaterOptions::default()).unwrap(),
        |seed| sampling(3, 4, seed, &SamplingOptions::default()).unwrap(),
        |seed| lanes(3, 4, seed, &LaneOptions::default()).unwrap(),
    ];
    for make in make {
        assert_eq!(make(17), make(17));
        assert_ne!(make(17).contingents(), make(18).contingents());
        assert_eq!(json::read(&json::write(&make(17))).unwrap(), make(17));
    }
}

#[test]
fn a_seed_gives_the_same_network_on_every_machine() {
    insta::assert_snapshot!(json::write(&repeaters(1, 2, 1, &RepeaterOptions::default()).unwrap()), @r#"{"format":"kirk-network/1","name":"repeaters 1x2 seed 1","time_unit":"s","origin":"start","events":[{"id":"start"},{"id":"traverse.1.1:start"},{"id":"traverse.1.1:end"},{"id":"test.1.1:start"},{"id":"test.1.1:end"},{"id":"traverse.1.2:start"},{"id":"traverse.1.2:end"},{"id":"test.1.2:start"},{"id":"test.1.2:end"}],"requirements":[{"from":"start","to":"traverse.1.1:start","lower":0},{"from":"traverse.1.1:end","to":"test.1.1:start","lower":0,"upper":14},{"from":"test.1.1:end","to":"traverse.1.2:start","lower":9,"upper":16},{"from":"traverse.1.2:end","to":"test.1.2:start","lower":0,"upper":11},{"from":"start","to":"test.1.2:end","lower":0,"upper":112}],"contingents":[{"from":"traverse.1.1:start","to":"traverse.1.1:end","lower":0,"upper":14},{"from":"test.1.1:start","to":"test.1.1:end","lower":0,"upper":8,"delay":[0,1.332794]},{"from":"traverse.1.2:start","to":"traverse.1.2:end","lower":0,"upper":5},{"from":"test.1.2:start","to":"test.1.2:end","lower":0,"upper":8,"delay":[0,9.197881]}]}"#);
    insta::assert_snapshot!(json::write(&sampling(1, 2, 1, &SamplingOptions::default()).unwrap()), @r#"{"format":"kirk-network/1","name":"sampling 1x2 seed 1","time_unit":"s","origin":"start","events":[{"id":"start"},{"id":"scan.1.1:start"},{"id":"scan.1.1:end"},{"id":"message.1.1:start"},{"id":"message.1.1:end"},{"id":"stow.1.1:end"},{"id":"scan.1.2:start"},{"id":"scan.1.2:end"},{"id":"message.1.2:start"},{"id":"message.1.2:end"},{"id":"stow.1.2:end"}],"requirements":[{"from":"start","to":"scan.1.1:start","lower":0},{"from":"scan.1.1:end","to":"message.1.1:start","lower":0,"upper":14},{"from":"message.1.1:end","to":"stow.1.1:end","lower":4,"upper":12},{"from":"scan.1.2:end","to":"message.1.2:start","lower":0,"upper":10},{"from":"message.1.2:end","to":"stow.1.2:end","lower":3,"upper":11},{"from":"start","to":"stow.1.2:end","lower":0,"upper":98}],"contingents":[{"from":"scan.1.1:start","to":"scan.1.1:end","lower":9,"upper":19,"delay":[0,3.754697]},{"from":"message.1.1:start","to":"message.1.1:end","lower":3,"upper":10,"delay":[0,1.060158]},{"from":"stow.1.1:end","to":"scan.1.2:start","lower":10,"upper":10},{"from":"scan.1.2:start","to":"scan.1.2:end","lower":5,"upper":10,"delay":[0,0.246218]},{"from":"message.1.2:start","to":"message.1.2:end","lower":3,"upper":14,"delay":[0,0.087497]}]}"#);
    insta::assert_snapshot!(json::write(&lanes(2, 2, 1, &LaneOptions { links: 60, delay: 3, ..LaneOptions::default() }).unwrap()), @r#"{"format":"kirk-network/1","name":"lanes 2x2 seed 1","time_unit":"s","origin":"start","events":[{"id":"start"},{"id":"task.1.1:start"},{"id":"task.1.1:end"},{"id":"task.1.2:start"},{"id":"task.1.2:end"},{"id":"task.2.1:start"},{"id":"task.2.1:end"},{"id":"task.2.2:start"},{"id":"task.2.2:end"}],"requirements":[{"from":"start","to":"task.1.1:start","lower":0},{"from":"task.1.1:end","to":"task.1.2:start","lower":250,"upper":644},{"from":"task.1.2:start","to":"task.1.2:end","lower":285,"upper":463},{"from":"start","to":"task.2.1:start","lower":0},{"from":"task.2.1:start","to":"task.2.1:end","lower":232,"upper":555},{"from":"task.2.1:end","to":"task.2.2:start","lower":255,"upper":544},{"from":"start","to":"task.1.2:end","lower":0,"upper":1047},{"from":"start","to":"task.2.2:end","lower":0,"upper":1047},{"from":"task.1.2:start","to":"task.2.1:end","lower":-91,"upper":-51},{"from":"task.1.2:end","to":"task.2.2:end","lower":-42,"upper":-38},{"from":"task.2.2:start","to":"task.1.2:end","lower":22,"upper":70}],"contingents":[{"from":"task.1.1:start","to":"task.1.1:end","lower":12,"upper":22,"delay":[0,1]},{"from":"task.2.2:start","to":"task.2.2:end","lower":3,"upper":10,"delay":[0,3]}]}"#);
}

#[test]
fn repeaters_keep_to_their_distributions() {
    repeaters_are_drawn_from(Bounds::Tables, [(0, 19), (0, 19), (0, 14), (0, 10), (4, 10)]);
    repeaters_are_drawn_from(Bounds::Text, [(0, 20), (0, 20), (0, 15), (10, 20), (4, 10)]);
}

fn repeaters_are_drawn_from(bounds: Bounds, ranges: [(i64, i64); 5]) {
    let options = RepeaterOptions { bounds, ..RepeaterOptions::default() };
    let mut delays = Vec::new();
    let mut uppers = [Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new()];
    for seed in 0..200 {
        let network = repeaters(4, 5, seed, &options).unwrap();
        assert_eq!(network.events().len(), 1 + 4 * 5 * 4);
        assert_eq!(network.contingents().len(), 2 * 4 * 5);
        // Per task B -> C, per pair of rovers D -> C, cleaning up between tasks, and the two of each rover.
        assert_eq!(network.requirements().len(), 4 * 5 + 3 * 5 + 4 * 4 + 2 * 4);
        for link in network.contingents() {
            assert_eq!(link.lower, Duration::ZERO);
            assert_eq!(link.delay.min, Duration::ZERO);
            let delay = link.delay.max.finite().unwrap().as_micros();
            if network.id(link.to).starts_with("test.") {
                delays.push(delay as f64 / 1e6);
                uppers[1].push(seconds(link.upper));
            } else {
                assert_eq!(delay, 0);
                uppers[0].push(seconds(link.upper));
            }
        }
        for rover in 1..=4 {
            for task in 1..=5 {
                let name = |what: &str| format!("{what}.{rover}.{task}");
                let install = requirement(
                    &network,
                    &format!("{}:end", name("traverse")),
                    &format!("{}:start", name("test")),
                );
                uppers[2].push(finite(install.upper));
                if task < 5 {
                    let next = format!("traverse.{rover}.{}:start", task + 1);
                    let clean = requirement(&network, &format!("{}:end", name("test")), &next);
                    uppers[3].push(finite(clean.lower));
                    uppers[4].push(finite(clean.upper) - finite(clean.lower));
                }
                if rover < 4 {
                    let order = requirement(
                        &network,
                        &format!("{}:end", name("test")),
                        &format!("test.{}.{task}:start", rover + 1),
                    );
                    assert_eq!((order.lower, order.upper), (Bound::Finite(Duration::ZERO), Bound::Infinite));
                }
            }
            let limit = requirement(&network, "start", &format!("test.{rover}.5:end"));
            assert!((250..=300).contains(&finite(limit.upper)) && finite(limit.upper) % 5 == 0);
        }
    }
    for (found, (least, most)) in uppers.iter().zip(ranges) {
        assert_eq!((found.iter().min(), found.iter().max()), (Some(&least), Some(&most)));
        let mean = found.iter().sum::<i64>() as f64 / found.len() as f64;
        let middle = (least + most) as f64 / 2.0;
        assert!((mean - middle).abs() < 0.03 * middle, "the mean is {mean}, not {middle}");
    }
    let mean = delays.iter().sum::<f64>() / delays.len() as f64;
    assert!((2.9..3.1).contains(&mean), "{mean}");
}

#[test]
fn lambda_is_an_average_or_a_rate() {
    let longest = |lambda_is| {
        let delay = Exponential { lambda: 4.0, lambda_is };
        let options = RepeaterOptions { delay, ..RepeaterOptions::default() };
        let network = repeaters(2, 2, 5, &options).unwrap();
        let delays: Vec<i64> = network
            .contingents()
            .iter()
            .filter_map(|link| link.delay.max.finite())
            .map(|max| max.as_micros())
            .collect();
        delays
    };
    for (mean, rate) in longest(Lambda::Mean).into_iter().zip(longest(Lambda::Rate)) {
        assert!((mean - 16 * rate).abs() <= 16, "{mean} is not 16 times {rate}");
    }
}

#[test]
fn the_link_to_the_next_task_is_either_kind() {
    let options =
        RepeaterOptions { last_link: Link::Contingent, clean_up_at_end: true, ..RepeaterOptions::default() };
    let network = repeaters(2, 3, 1, &options).unwrap();
    assert_eq!(network.contingents().len(), 2 * 3 * 3);
    assert!(network.find("clean-up.2.3:end").is_some());
    let options = SamplingOptions { traverse: Link::Requirement, ..SamplingOptions::default() };
    assert_eq!(sampling(2, 3, 1, &options).unwrap().contingents().len(), 2 * 3 * 2);
    assert_eq!(sampling(2, 3, 1, &SamplingOptions::default()).unwrap().contingents().len(), 2 * (3 * 2 + 2));
}

#[test]
fn some_networks_of_each_family_are_controllable_and_some_are_not() {
    let found = [
        yes(|seed| repeaters(4, 5, seed, &RepeaterOptions::default())),
        yes(|seed| sampling(4, 5, seed, &SamplingOptions::default())),
        yes(|seed| lanes(5, 20, seed, &LaneOptions::default())),
        yes(|seed| lanes(5, 20, seed, &LaneOptions { delay: 10, ..LaneOptions::default() })),
    ];
    assert!(found.iter().all(|&yes| yes > 0 && yes < 100), "{found:?}");
}

#[test]
fn a_controllable_network_is_found_by_trying_seeds() {
    let make = |seed| repeaters(4, 5, seed, &RepeaterOptions::default());
    let (seed, network) = controllable(make, 3).unwrap().unwrap();
    assert!(is_controllable(&network));
    assert!((3..seed).all(|seed| !is_controllable(&make(seed).unwrap())));
    // Contingent cleaning up leaves no room within the consumables.
    let hopeless =
        RepeaterOptions { last_link: Link::Contingent, bounds: Bounds::Text, ..RepeaterOptions::default() };
    assert_eq!(controllable(|seed| repeaters(4, 5, seed, &hopeless), u64::MAX - 5), Ok(None));
    assert_eq!(controllable(|seed| repeaters(0, 5, seed, &hopeless), 0), Err(GenerateError::NoAgents));
}

#[test]
fn arguments_that_make_no_sense_are_refused() {
    let delay = |lambda, lambda_is| RepeaterOptions {
        delay: Exponential { lambda, lambda_is },
        ..RepeaterOptions::default()
    };
    let defaults = RepeaterOptions::default();
    assert_eq!(repeaters(0, 1, 0, &defaults), Err(GenerateError::NoAgents));
    assert_eq!(repeaters(1, 0, 0, &defaults), Err(GenerateError::NoTasks));
    let error = repeaters(u32::MAX, u32::MAX, 0, &defaults).unwrap_err();
    assert!(matches!(error, GenerateError::TooLarge { events } if events > MOST_EVENTS), "{error:?}");
    for lambda in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
        for lambda_is in [Lambda::Mean, Lambda::Rate] {
            assert_eq!(repeaters(1, 1, 0, &delay(lambda, lambda_is)), Err(GenerateError::Lambda), "{lambda}");
        }
    }
    let error = lanes(1, 1, 0, &LaneOptions { cross: 101, ..LaneOptions::default() }).unwrap_err();
    assert_eq!(error.to_string(), "cross is 101 percent; it must be from 0 to 100");
    // The smallest and the oddest that do.
    for seed in 0..20 {
        repeaters(1, 1, seed, &delay(1e6, Lambda::Mean)).unwrap();
        sampling(1, 1, seed, &SamplingOptions::default()).unwrap();
        let most = LaneOptions { links: 100, cross: 100, slack: u32::MAX, delay: u32::MAX };
        lanes(3, 4, seed, &most).unwrap();
        lanes(1, 1, seed, &LaneOptions { links: 0, cross: 0, slack: 0, delay: 0 }).unwrap();
    }
}
