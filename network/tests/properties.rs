//! What must hold of every network, tried on thousands of random ones. A failure prints its seed and a small case.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-network --release --test properties` runs as many as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use std::cell::Cell;
use std::collections::BTreeSet;
use std::time::Instant;

use kirk_network::check::conflict;
use kirk_network::conflicts::{conflicts, without};
use kirk_network::controllability::{is_controllable, negative_cycle};
use kirk_network::merge::merge;
use kirk_network::precedence::Precedence;
use kirk_network::reduce::{ReduceError, reduce};
use kirk_network::stnu::{LIMIT, TooLarge};
use kirk_network::{
    Bound, Conflict, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Part, Requirement,
    Verdict, check, dispatchable,
};
use oracle::random::{self, Random, Shape};
use oracle::{closure, game, joined};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// Runs a property on networks of some shapes; on failure shrinks and prints.
fn holds(usual: u64, shapes: &[Shape], property: impl Fn(&Network, u64) -> bool) {
    for seed in 0..cases(usual) {
        let shape = &shapes[(seed % shapes.len() as u64) as usize];
        let network = random::network(seed, shape);
        if !property(&network, seed) {
            let small = random::shrunk(&network, |candidate| !property(candidate, seed));
            panic!(
                "seed {seed}:\n{}\nwhich shrinks to\n{}",
                random::describe(&network),
                random::describe(&small)
            );
        }
    }
}

fn controllable(network: &Network) -> bool {
    check(network).unwrap() == Verdict::Controllable
}

#[test]
fn without_delays_the_verdict_is_that_of_the_labelled_closure() {
    let shapes = [Shape::tiny(), Shape::tiny().chained(), Shape::medium(), Shape::medium().chained()];
    let no_delays = shapes.map(|shape| Shape { fixed: 0, variable: 0, infinite: 0, ..shape });
    holds(4000, &no_delays, |network, _| controllable(network) == closure::dynamically_controllable(network));
}

#[test]
fn deciding_explaining_and_solving_agree() {
    let shapes = [Shape::tiny_delayed(), Shape::medium(), Shape::medium().chained()];
    holds(4000, &shapes, |network, _| match reduce(&merge(network).network) {
        Ok(reduction) => {
            let decided = is_controllable(&reduction.stnu).unwrap();
            decided == negative_cycle(&reduction.stnu).unwrap().is_none()
                && decided
                    == dispatchable(&reduction, &Precedence::new(&merge(network).network)).unwrap().is_some()
        }
        Err(_) => !controllable(network),
    });
}

#[test]
fn deciding_and_compiling_refuse_the_same_networks_as_too_large() {
    let shapes = [Shape::tiny_delayed(), Shape::medium(), Shape::medium().chained()];
    let (accepted, refused) = (Cell::new(0), Cell::new(0));
    holds(4000, &shapes, |network, seed| {
        // Scaled to where sums come near the limit, or go beyond.
        let sum: i64 = bounds(network).map(|bound| bound.abs().as_micros()).sum();
        let factor = LIMIT / (8 * sum.max(1)) * (1 + seed as i64 % 24);
        let large = random::scaled(network, factor);
        let verdict = check(&large).map(|verdict| verdict == Verdict::Controllable);
        let compiled = match reduce(&merge(&large).network) {
            Ok(reduction) => {
                dispatchable(&reduction, &Precedence::new(&merge(&large).network)).map(|form| form.is_some())
            }
            Err(ReduceError::TooLarge) => Err(TooLarge),
            Err(ReduceError::Never(_)) => Ok(false),
        };
        let seen = if verdict.is_ok() { &accepted } else { &refused };
        seen.set(seen.get() + 1);
        match (verdict, compiled) {
            (Ok(true), Ok(true)) => controllable(network),
            (Ok(true), _) | (_, Ok(true)) => false,
            (Ok(false), _) => !controllable(network),
            (Err(TooLarge), _) => true,
        }
    });
    let all = accepted.get() + refused.get();
    assert!(20 * accepted.get().min(refused.get()) > all, "{accepted:?} were accepted, {refused:?} refused");
}

fn bounds(network: &Network) -> impl Iterator<Item = Duration> {
    let required =
        network.requirements().iter().flat_map(|requirement| [requirement.lower, requirement.upper]);
    let natural = network
        .contingents()
        .iter()
        .flat_map(|link| [link.upper.into(), link.delay.min.into(), link.delay.max]);
    required.chain(natural).filter_map(Bound::finite)
}

/// Two rounds of Bellman-Ford in the order of the events, whatever the order of their numbers. One by one against that
/// order it would take as many rounds as there are events: many minutes.
#[test]
#[allow(clippy::disallowed_methods, reason = "a test may look at the clock")]
fn a_sequence_of_any_length_and_order_is_decided_in_time_linear_in_its_length() {
    const ACTIVITIES: u32 = 190_000;
    let mut place: Vec<u32> = (1..=2 * ACTIVITIES).collect();
    for order in ["in order", "backwards", "shuffled"] {
        match order {
            "backwards" => place.reverse(),
            "shuffled" => Random::new(7).shuffle(&mut place),
            _ => {}
        }
        let events = (0..=2 * ACTIVITIES)
            .map(|event| Event { names: [Name { text: format!("event.{event}"), internal: false }].into() });
        let event = |number: u32| EventId(if number == 0 { 0 } else { place[number as usize - 1] });
        let requirement = |number: u32, lower, upper| Requirement {
            from: event(number),
            to: event(number + 1),
            lower: Bound::Finite(Duration::from_secs(lower)),
            upper,
        };
        let sequence = (0..ACTIVITIES).flat_map(|activity| {
            let slack = requirement(2 * activity, 0, Bound::Infinite);
            [slack, requirement(2 * activity + 1, 1, Bound::Finite(Duration::from_secs(2)))]
        });
        let requirements = sequence.collect();
        let network =
            Network::new(String::new(), EventId(0), events.collect(), requirements, Vec::new()).unwrap();
        let start = Instant::now();
        assert!(controllable(&network));
        assert!(start.elapsed().as_secs() < 60, "{order}: {:?}", start.elapsed());
    }
}

#[test]
fn with_delays_the_verdict_is_that_of_the_game() {
    holds(6000, &[Shape::tiny_delayed(), Shape::tiny_delayed().chained()], |network, _| {
        let merged = merge(network).network;
        let chained = merged.contingents().iter().any(|link| merged.link_of(link.from).is_some());
        let won = game::controllable(&merged);
        match check(network).unwrap() {
            Verdict::Controllable => won,
            // In delayed chains a "no" may be too careful, and says so.
            Verdict::Uncontrollable(conflict) if conflict.conservative => chained,
            Verdict::Uncontrollable(_) => !won,
        }
    });
}

/// Only the members of a conflict; without `left_out`, which takes a link out whole.
fn only(network: &Network, conflict: &Conflict, left_out: Option<Part>) -> Network {
    let has = |part: Part| Some(part) != left_out && conflict.members.iter().any(|share| share.part == part);
    let requirements = network.requirements().iter().enumerate().map(|(index, requirement)| {
        let keep =
            |part: Part, bound| if has(part) || has(Part::Join(index)) { bound } else { Bound::Infinite };
        Requirement {
            lower: keep(Part::RequirementLower(index), requirement.lower),
            upper: keep(Part::RequirementUpper(index), requirement.upper),
            ..*requirement
        }
    });
    let links = network.contingents().iter().enumerate().filter(|&(index, _)| {
        let all = [Part::LinkLower, Part::LinkUpper, Part::DelayMin, Part::DelayMax].map(|part| part(index));
        all.into_iter().any(has) && !left_out.is_some_and(|part| all.contains(&part))
    });
    random::with(network, requirements.collect(), links.map(|(_, link)| *link).collect())
}

#[test]
fn a_conflict_adds_up_is_uncontrollable_alone_and_minimal() {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    holds(4000, &shapes, |network, _| {
        let merged = merge(network).network;
        let Some(found) = conflict(&merged).unwrap() else { return true };
        let sum: i64 = found.members.iter().map(|share| share.amount.as_micros()).sum();
        let adds_up = sum == found.total.as_micros() && sum < 0;
        let possible = |network: &Network| conflict(network).unwrap().is_none();
        let alone = !possible(&only(&merged, &found, None));
        let minimal = found.members.iter().all(|share| {
            share.part == Part::AfterOrigin || possible(&only(&merged, &found, Some(share.part)))
        });
        adds_up && alone && minimal && conflict(&merged).unwrap() == Some(found)
    });
}

#[test]
fn each_of_all_conflicts_is_one_alone_and_without_their_bounds_none_is_left() {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let several = Cell::new(0);
    holds(4000, &shapes, |network, _| {
        let merged = merge(network).network;
        let found = conflicts(&merged, 1000).unwrap();
        let possible = |network: &Network| check(network).unwrap() == Verdict::Controllable;
        several.set(several.get() + usize::from(found.len() > 1));
        // With an end of Nature's out of the way, [0, 0] may join what it did not, and then a conflict says that it rests on it.
        let alone = found.iter().all(|it| {
            let joins = it.members.iter().any(|share| matches!(share.part, Part::Join(_)));
            let only = only(&merged, it, None);
            if joins { !possible(&only) } else { conflict(&only).unwrap().is_some() }
        });
        let rest = without(&merged, &found);
        let bounds: Vec<Part> =
            found.iter().flat_map(|conflict| &conflict.members).map(|it| it.part).collect();
        let is_free =
            |part: &&Part| matches!(part, Part::RequirementUpper(_)) && part.bound(&merged) != Duration::ZERO;
        let disjoint = bounds.iter().filter(is_free).count()
            == bounds.iter().filter(is_free).collect::<BTreeSet<_>>().len();
        alone && disjoint && found.is_empty() == possible(&merged) && possible(&rest)
    });
    assert!(several.get() > 20, "{}", several.get());
}

#[test]
fn what_is_harder_is_never_controllable_when_the_easier_is_not() {
    let unit = Duration::from_secs(1);
    let shapes = [Shape::tiny_delayed(), Shape::medium(), Shape::medium().chained()];
    holds(6000, &shapes, |network, seed| {
        // A requirement tightened to [0, 0] must not be merged away: that is another model.
        let merged = merge(network).network;
        let harder = random::harder(&mut Random::new(seed), &merged, unit);
        let possible = |network: &Network| conflict(network).unwrap().is_none();
        possible(&merged) || !possible(&harder)
    });
}

#[test]
fn scaling_and_reordering_change_nothing() {
    let shapes = [Shape::tiny_delayed(), Shape::medium(), Shape::medium().chained()];
    holds(3000, &shapes, |network, seed| {
        let verdict = controllable(network);
        let reordered = random::reordered(&mut Random::new(seed), network);
        verdict == controllable(&random::scaled(network, 7)) && verdict == controllable(&reordered)
    });
}

#[test]
fn zero_delays_are_dynamic_and_infinite_delays_strong_controllability() {
    holds(3000, &[Shape::tiny(), Shape::medium()], |network, _| {
        let never = Delay { min: Duration::ZERO, max: Bound::Infinite };
        let merged = merge(network).network;
        controllable(&random::with_delays(&merged, Delay::NONE))
            == closure::dynamically_controllable(&random::with_delays(&merged, Delay::NONE))
            && controllable(&random::with_delays(&merged, never)) == strongly_controllable(&merged)
    });
}

/// Strong controllability by its definition: one schedule of the executable events that suits every duration, which
/// is Bellman-Ford over requirements in which every contingent event stands at its worst.
fn strongly_controllable(network: &Network) -> bool {
    let link = |event: EventId| network.link_of(event).map(|index| network.contingents()[index]);
    // The executable event a contingent one depends on, and the interval after it.
    let place = |mut event: EventId| {
        let (mut low, mut high) = (0, 0);
        while let Some(ContingentLink { from, lower, upper, .. }) = link(event) {
            (low, high, event) = (low + lower.as_micros(), high + upper.as_micros(), from);
        }
        (event, low, high)
    };
    let ancestors = |event: EventId| {
        std::iter::successors(Some(event), move |&event| link(event).map(|link| link.from))
            .collect::<Vec<_>>()
    };
    let mut edges = Vec::new();
    for event in network.event_ids() {
        if link(event).is_none() {
            edges.push((event, network.origin(), 0));
        }
    }
    for requirement in network.requirements() {
        let upper = requirement.upper.finite().map(|w| (requirement.from, requirement.to, w.as_micros()));
        let lower = requirement.lower.finite().map(|w| (requirement.to, requirement.from, -w.as_micros()));
        for (from, to, weight) in [upper, lower].into_iter().flatten() {
            let ((from_base, low, _), (to_base, _, high)) = (place(from), place(to));
            if from_base == to_base {
                // What they share cancels.
                let shared = *ancestors(to).iter().find(|event| ancestors(from).contains(event)).unwrap();
                let (_, shared_low, shared_high) = place(shared);
                if (high - shared_high) - (low - shared_low) > weight {
                    return false;
                }
            } else {
                edges.push((from_base, to_base, weight - high + low));
            }
        }
    }
    let mut distance = vec![0_i64; network.events().len()];
    for _ in 0..=network.events().len() {
        let mut changed = false;
        for &(from, to, weight) in &edges {
            if distance[from.index()] + weight < distance[to.index()] {
                distance[to.index()] = distance[from.index()] + weight;
                changed = true;
            }
        }
        if !changed {
            return true;
        }
    }
    false
}

#[test]
fn events_are_one_that_are_painted_one() {
    let shapes = [Shape::tiny(), Shape::tiny().chained(), Shape::medium(), Shape::medium().chained()];
    let (joins, refused) = (Cell::new(0), Cell::new(0));
    holds(4000, &shapes, |network, seed| {
        let mut random = Random::new(seed);
        let mut requirements = network.requirements().to_vec();
        for requirement in requirements.iter_mut().filter(|_| random.percent(40)) {
            (requirement.lower, requirement.upper) = (Duration::ZERO.into(), Duration::ZERO.into());
        }
        let network = random::with(network, requirements, network.contingents().to_vec());
        let (merged, colours) = (merge(&network).event_of, joined::joined(&network));
        let alike = |a: usize, b: usize| (merged[a] == merged[b]) == (colours[a] == colours[b]);
        let count = network.events().len();
        let zero = |bound: Bound| bound == Bound::Finite(Duration::ZERO);
        for it in network.requirements().iter().filter(|it| zero(it.lower) && zero(it.upper)) {
            let counted = if merged[it.from.index()] == merged[it.to.index()] { &joins } else { &refused };
            counted.set(counted.get() + 1);
        }
        (0..count).all(|a| (0..count).all(|b| alike(a, b)))
    });
    assert!(joins.get() > 1_000 && refused.get() > 100, "{joins:?} joins, {refused:?} refused");
}
