//! What one assumption about delays says of another, on thousands of random networks.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod oracle;

use kirk_network::assume::{Assumption, check_assuming};
use kirk_network::merge::merge;
use kirk_network::{Network, Verdict, check};
use oracle::random::{self, Shape};

const ALL: [Assumption; 7] = [
    Assumption::AsWritten,
    Assumption::Zero,
    Assumption::Minimum,
    Assumption::Mean,
    Assumption::Maximum,
    Assumption::Never,
    Assumption::Elongated,
];

fn verdict(network: &Network, assumption: Assumption) -> Verdict {
    check_assuming(network, assumption).unwrap().verdict
}

fn yes(network: &Network, assumption: Assumption) -> bool {
    verdict(network, assumption) == Verdict::Controllable
}

fn cases() -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(4000)
}

fn networks(shapes: &[Shape]) -> impl Iterator<Item = (u64, Network)> {
    (0..cases())
        .map(move |seed| (seed, random::network(seed, &shapes[(seed % shapes.len() as u64) as usize])))
}

fn delayed() -> [Shape; 2] {
    [Shape::tiny_delayed(), Shape { fixed: 20, variable: 40, infinite: 10, delay: 4, ..Shape::medium() }]
}

fn has_chains(network: &Network) -> bool {
    let merged = merge(network).network;
    merged.contingents().iter().any(|link| merged.link_of(link.from).is_some())
}

/// Thesis, section 4.5: each assumption is a case of what was written, so what works in all cases works in it.
#[test]
fn what_is_controllable_as_written_is_so_under_every_fixed_delay() {
    let mut both = [0; 2];
    for (seed, network) in networks(&delayed()).filter(|(_, network)| !has_chains(network)) {
        let as_written = yes(&network, Assumption::AsWritten);
        both[usize::from(as_written)] += 1;
        for assumption in [Assumption::Zero, Assumption::Minimum, Assumption::Mean, Assumption::Maximum] {
            assert!(!as_written || yes(&network, assumption), "seed {seed}: {assumption:?}");
        }
        // What works without news works with any.
        assert!(!yes(&network, Assumption::Never) || as_written, "seed {seed}: never");
        // And late news is worse than early news.
        let fixed = [Assumption::Maximum, Assumption::Mean, Assumption::Minimum, Assumption::Zero];
        let fixed = fixed.map(|assumption| yes(&network, assumption));
        assert!(fixed.is_sorted(), "seed {seed}: {fixed:?}");
    }
    assert!(both.iter().all(|&count| count > cases() / 10), "{both:?}");
}

/// Thesis, table 4.3: no false positives.
#[test]
fn what_is_controllable_elongated_is_so_as_written() {
    let chained = delayed().map(Shape::chained);
    let mut lost = 0;
    for (seed, network) in networks(&[delayed(), chained].concat()) {
        let as_written = check(&network).unwrap();
        let elongated = yes(&network, Assumption::Elongated);
        lost += u64::from(as_written == Verdict::Controllable && !elongated);
        if let (true, Verdict::Uncontrollable(conflict)) = (elongated, as_written) {
            // In delayed chains the "no" may be too careful, and says so.
            assert!(conflict.conservative, "seed {seed}: {}", random::describe(&network));
        }
    }
    assert!(lost > cases() / 100, "only {lost} networks are lost by elongating");
}

#[test]
fn delays_that_are_known_leave_nothing_to_elongate() {
    let fixed = delayed().map(|shape| Shape { fixed: 60, variable: 0, infinite: 0, ..shape });
    for (seed, network) in networks(&fixed).filter(|(_, network)| !has_chains(network)) {
        assert_eq!(
            yes(&network, Assumption::Elongated),
            yes(&network, Assumption::AsWritten),
            "seed {seed}: {}",
            random::describe(&network)
        );
    }
}

#[test]
fn every_conflict_adds_up_in_the_network_it_speaks_of() {
    let chained = delayed().map(Shape::chained);
    for (seed, network) in networks(&[delayed(), chained].concat()) {
        for assumption in ALL {
            let assumed = check_assuming(&network, assumption).unwrap();
            let Verdict::Uncontrollable(conflict) = assumed.verdict else { continue };
            let sum: i64 = conflict.members.iter().map(|share| share.amount.as_micros()).sum();
            assert_eq!(sum, conflict.total.as_micros(), "seed {seed}: {assumption:?}");
            assert!(sum < 0, "seed {seed}: {assumption:?}");
            for share in &conflict.members {
                let bound = share.bound(&assumed.network).as_micros().abs() * i64::from(share.times);
                assert_eq!(share.amount.as_micros().abs(), bound, "seed {seed}: {assumption:?} {share:?}");
            }
        }
    }
}
