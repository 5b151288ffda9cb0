//! Repairs against exhaustive search on small networks, and what they promise on larger ones.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-network --release --test repair` runs as many networks as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use std::collections::BTreeSet;

use kirk_network::least::could_settle;
use kirk_network::merge::merge;
use kirk_network::repair::{Allowed, Extent, ONE, Options, Repair, Repairs, ours, repairs};
use kirk_network::slack::bounds;
use kirk_network::vary::{Change, Knob, changed};
use kirk_network::{Bound, Delay, Duration, EventId, Network, Part, Requirement, Verdict, check, json};
use oracle::closure;
use oracle::random::{self, Random, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

const SECOND: i64 = 1_000_000;

fn controllable(network: &Network) -> bool {
    check(network).unwrap() == Verdict::Controllable
}

fn delayed(network: &Network) -> bool {
    network.contingents().iter().any(|link| link.delay != Delay::NONE)
}

/// The verdict of the closure, which shares nothing with the engine, where there are no delays.
fn judge(network: &Network) -> bool {
    if delayed(network) { controllable(network) } else { closure::dynamically_controllable(network) }
}

/// True if a larger value of this bound is easier.
fn more_is_easier(knob: &Knob) -> bool {
    matches!(knob.parts()[0], Part::RequirementUpper(_) | Part::LinkLower(_) | Part::DelayMin(_))
}

/// A knob made easier by so many microseconds.
fn turned(network: &Network, knob: &Knob, micros: i64) -> Change {
    let from = knob.value(network);
    let sign = if more_is_easier(knob) { 1 } else { -1 };
    let to = Duration::from_micros(from.finite().unwrap().as_micros() + sign * micros);
    Change { knob: knob.clone(), from, to: to.into() }
}

/// By how many seconds all bounds of a knob can be made easier, and never more than `most`.
fn room(network: &Network, knob: &Knob, most: i64) -> i64 {
    let seconds = |duration: Duration| duration.as_micros() / SECOND;
    let room = |part: &Part| match *part {
        Part::LinkLower(index) | Part::LinkUpper(index) => {
            let link = network.contingents()[index];
            seconds(link.upper) - seconds(link.lower)
        }
        Part::DelayMin(index) => {
            let delay = network.contingents()[index].delay;
            delay.max.finite().map_or(most, |max| seconds(max) - seconds(delay.min))
        }
        Part::DelayMax(index) => network.contingents()[index].delay.max.finite().map_or(0, seconds),
        _ => most,
    };
    knob.parts().iter().map(room).min().unwrap().min(most)
}

/// Some knobs of a network with finite values that are whole seconds, at random costs.
fn some_knobs(random: &mut Random, network: &Network, most: usize) -> Vec<Allowed> {
    let mut knobs: Vec<Knob> =
        bounds(network).into_iter().filter(|knob| knob.value(network) != Bound::Infinite).collect();
    random.shuffle(&mut knobs);
    // One conflict is mostly settled by one of its own bounds.
    if let Verdict::Uncontrollable(conflict) = check(network).unwrap()
        && random.percent(60)
    {
        let own = could_settle(network, &conflict);
        knobs.sort_by_key(|knob| !own.contains(&knob.parts()[0]));
    }
    // What is written once moves together.
    if random.percent(40)
        && let Some(alike) = (1..knobs.len()).find_map(|at| {
            Knob::together([knobs[0].parts(), knobs[at].parts()].concat()).map(|knob| (at, knob))
        })
    {
        knobs[0] = alike.1;
        knobs.remove(alike.0);
    }
    knobs.truncate(random.within(2..=most as i64) as usize);
    random.shuffle(&mut knobs);
    let allowed =
        |knob| Allowed { knob, weight: random.within(1..=5) as u64, unit: Duration::from_micros(SECOND) };
    knobs.into_iter().map(allowed).collect()
}

/// True if turning a knob parts an event from something heard late: that is another model.
fn parts_from_late(network: &Network, knob: &Knob) -> bool {
    let zero = Bound::Finite(Duration::ZERO);
    let class_of = merge(network).event_of;
    let late = |class: EventId| {
        let mut links = network.contingents().iter();
        links.any(|link| link.delay != Delay::NONE && class_of[link.to.index()] == class)
    };
    knob.parts().iter().any(|part| match *part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => {
            let Requirement { from, lower, upper, .. } = network.requirements()[index];
            lower == zero && upper == zero && late(class_of[from.index()])
        }
        _ => false,
    })
}

/// Amounts in whole seconds that cost less than `most` and make it controllable, if there are any.
fn exhausted(network: &Network, allowed: &[Allowed], most: u128) -> Option<Vec<i64>> {
    const FAR: i64 = 12;
    fn go(
        network: &Network,
        allowed: &[Allowed],
        rooms: &[i64],
        amounts: &mut Vec<i64>,
        left: u128,
    ) -> Option<Vec<i64>> {
        let at = amounts.len();
        if at == allowed.len() {
            let changes: Vec<Change> = amounts
                .iter()
                .zip(allowed)
                .filter(|(amount, _)| **amount > 0)
                .map(|(amount, it)| turned(network, &it.knob, amount * SECOND))
                .collect();
            return changed(network, &changes).is_some_and(|it| judge(&it)).then(|| amounts.clone());
        }
        for amount in 0..=rooms[at] {
            let cost = u128::from(allowed[at].weight) * (amount * SECOND) as u128;
            if cost >= left {
                break;
            }
            amounts.push(amount);
            let found = go(network, allowed, rooms, amounts, left - cost);
            amounts.pop();
            if found.is_some() {
                return found;
            }
        }
        None
    }
    let rooms: Vec<i64> = allowed.iter().map(|it| room(network, &it.knob, FAR)).collect();
    go(network, allowed, &rooms, &mut Vec::new(), most)
}

fn shown(repair: &Repair) -> String {
    let change = |change: &Change| {
        let text = |bound: Bound| bound.finite().map_or("never".to_string(), |finite| finite.to_string());
        format!("{:?} {} -> {}", change.knob.parts(), text(change.from), text(change.to))
    };
    let changes: Vec<String> = repair.changes.iter().map(change).collect();
    format!("{} for {}", changes.join(", "), repair.cost)
}

fn turned_by(repair: &Repair) -> BTreeSet<Knob> {
    repair.changes.iter().map(|change| change.knob.clone()).collect()
}

/// The change made less by a microsecond, or by what there is to the next whole unit; `None` if nothing is left of it.
fn less(change: &Change, unit: Duration) -> Option<Change> {
    let (from, to) = (change.from.finite()?.as_micros(), change.to.finite()?.as_micros());
    let unit = unit.as_micros();
    let step = if to % unit == 0 { unit } else { 1 };
    let to = to + (from - to).signum() * step;
    ((to - from).signum() == (change.to.finite()?.as_micros() - from).signum())
        .then(|| Change { to: Duration::from_micros(to).into(), ..change.clone() })
}

/// Everything that is promised of every list of repairs.
fn hold_to_promises(network: &Network, allowed: &[Allowed], limit: usize, found: &Repairs, context: &str) {
    let context = || format!("{context}\n{}", random::describe(network));
    let mut sets = BTreeSet::new();
    let rank = |repair: &Repair| (repair.cost, repair.changes.len());
    assert!(found.repairs.is_sorted_by_key(rank), "not in order: {}", context());
    for repair in &found.repairs {
        let it = || format!("{}: {}", shown(repair), context());
        assert!(sets.insert(turned_by(repair)), "twice: {}", it());
        assert!(!repair.changes.is_empty(), "nothing: {}", it());
        let repaired = changed(network, &repair.changes).unwrap();
        assert!(controllable(&repaired) && judge(&repaired), "not enough: {}", it());
        let mut cost = 0;
        for (index, change) in repair.changes.iter().enumerate() {
            let own = allowed.iter().find(|it| it.knob == change.knob).unwrap();
            if let Some(amount) = change.amount() {
                cost += u128::from(own.weight) * amount.as_micros() as u128;
            }
            let mut fewer = repair.changes.clone();
            match less(change, own.unit) {
                Some(less) => fewer[index] = less,
                None => _ = fewer.remove(index),
            }
            assert!(
                !changed(network, &fewer).is_some_and(|it| controllable(&it)),
                "{change:?} is not needed: {}",
                it()
            );
        }
        if repair.changes.iter().all(|change| change.from != Bound::Infinite) {
            assert_eq!(cost, repair.cost, "{}", it());
        }
    }
    let alone: BTreeSet<Knob> = found
        .repairs
        .iter()
        .filter(|repair| repair.changes.len() == 1)
        .map(|repair| repair.changes[0].knob.clone())
        .collect();
    assert!(found.not_alone.iter().all(|knob| !alone.contains(knob)), "{}", context());
    let could: BTreeSet<&Knob> =
        allowed.iter().map(|it| &it.knob).filter(|knob| !found.not_alone.contains(knob)).collect();
    assert!(
        found.extent == Extent::OutOfRounds || found.repairs.len() >= could.len().min(limit),
        "{}",
        context()
    );
}

const WELL: Options = Options { limit: 5, rounds: 2000, patience: 1000 };

/// Small, and with several conflicts more often than not.
fn tight() -> Shape {
    Shape { density: 100..=200, slack: 4, horizon: 6, ..Shape::tiny() }
}

/// The first repair is the cheapest of all. Every set of knobs that can make it controllable has in it those of a repair.
#[test]
fn no_repair_in_whole_seconds_is_cheaper() {
    let shapes = [
        Shape { executables: 1..=3, links: 1..=2, ..tight() },
        Shape { executables: 1..=2, links: 2..=3, chain: 50, ..tight() },
        Shape {
            executables: 1..=3,
            links: 1..=2,
            fixed: 20,
            variable: 40,
            infinite: 10,
            delay: 4,
            ..tight()
        },
    ];
    let (mut one, mut several, mut none) = (0, 0, 0);
    for seed in 0..cases(1600) {
        let network = random::network(seed, &shapes[(seed % 3) as usize]);
        let random = &mut Random::new(seed);
        let mut allowed = some_knobs(random, &network, 4);
        allowed.retain(|it| !parts_from_late(&network, &it.knob));
        if controllable(&network) {
            assert_eq!(repairs(&network, &allowed, &WELL).unwrap(), None, "seed {seed}");
            continue;
        }
        let found = repairs(&network, &allowed, &WELL).unwrap().unwrap();
        let context = format!(
            "seed {seed}, {:?}",
            allowed.iter().map(|it| (it.knob.parts(), it.weight)).collect::<Vec<_>>()
        );
        hold_to_promises(&network, &allowed, WELL.limit, &found, &context);
        assert_eq!(found.extent, Extent::Complete, "{context}");
        if let Some(repair) = found.repairs.first()
            && let Some(amounts) = exhausted(&network, &allowed, repair.cost)
        {
            panic!(
                "{amounts:?} s are enough, not {:?}: {context}\n{}",
                found.repairs.iter().map(shown).collect::<Vec<_>>(),
                random::describe(&network)
            );
        }
        *match found.repairs.first().map_or(0, |repair| repair.changes.len()) {
            0 => &mut none,
            1 => &mut one,
            _ => &mut several,
        } += 1;
        for chosen in 0..1_u32 << allowed.len() {
            let changes: Vec<Change> = (0..allowed.len())
                .filter(|index| chosen >> index & 1 == 1)
                .map(|index| &allowed[index].knob)
                .map(|knob| turned(&network, knob, room(&network, knob, 1000) * SECOND))
                .collect();
            if found.repairs.len() < WELL.limit && changed(&network, &changes).is_some_and(|it| judge(&it)) {
                let set: BTreeSet<Knob> = changes.into_iter().map(|change| change.knob).collect();
                let has = found.repairs.iter().any(|repair| turned_by(repair).is_subset(&set));
                assert!(has, "{set:?} is enough: {context}\n{}", random::describe(&network));
            }
        }
    }
    assert!(one > 150 && several > 50 && none > 100, "{one}, {several}, {none}");
}

/// Where nothing is claimed: chains with late news, and requirements that join events.
#[test]
fn where_the_reduction_switches_the_cheapest_is_nearly_always_found() {
    let shapes = [
        Shape { executables: 1..=3, links: 1..=2, ..Shape::tiny() },
        Shape { executables: 1..=2, links: 2..=3, ..Shape::tiny_delayed().chained() },
    ];
    let (mut cheapest, mut missed) = (0, Vec::new());
    for seed in 0..cases(1200) {
        let network = random::network(seed, &shapes[(seed % 2) as usize]);
        let allowed = some_knobs(&mut Random::new(seed), &network, 4);
        let joined = allowed.iter().any(|it| parts_from_late(&network, &it.knob));
        if !(joined || seed % 2 == 1 && delayed(&network)) || controllable(&network) {
            continue;
        }
        let found = repairs(&network, &allowed, &WELL).unwrap().unwrap();
        hold_to_promises(&network, &allowed, WELL.limit, &found, &format!("seed {seed}"));
        let most = found.repairs.first().map_or(u128::MAX, |repair| repair.cost);
        match exhausted(&network, &allowed, most) {
            None => cheapest += 1,
            Some(_) => missed.push(seed),
        }
    }
    assert!(cheapest > 150 && missed.len() * 50 <= cheapest, "{cheapest}, missed with seeds {missed:?}");
}

/// Of one knob alone: what counting up finds.
#[test]
fn a_single_change_is_what_counting_finds() {
    let shapes = [Shape::tiny(), Shape::tiny().chained(), Shape::tiny_delayed()];
    let (mut helped, mut not_alone) = (0, 0);
    for seed in 0..cases(400) {
        let network = random::network(seed, &shapes[(seed % 3) as usize]);
        if controllable(&network) {
            continue;
        }
        for allowed in some_knobs(&mut Random::new(seed), &network, 12) {
            let found = repairs(&network, std::slice::from_ref(&allowed), &WELL).unwrap().unwrap();
            let knob = &allowed.knob;
            let to = |seconds: i64| turned(&network, knob, seconds * SECOND);
            let counted = (1..=room(&network, knob, 60))
                .find(|seconds| changed(&network, &[to(*seconds)]).is_some_and(|it| judge(&it)));
            let context = || format!("seed {seed}, {:?}\n{}", knob.parts(), random::describe(&network));
            match counted {
                Some(seconds) => {
                    let cost = u128::from(allowed.weight) * (seconds * SECOND) as u128;
                    let expected = Repair { changes: vec![to(seconds)], cost };
                    assert_eq!(found.repairs, [expected], "{}", context());
                    assert_eq!(found.not_alone, [], "{}", context());
                    helped += 1;
                }
                None => {
                    assert_eq!(found.repairs, [], "{}", context());
                    assert_eq!(found.not_alone, std::slice::from_ref(knob), "{}", context());
                    not_alone += 1;
                }
            }
        }
    }
    assert!(helped > 150 && not_alone > 200, "{helped} helped, {not_alone} did not");
}

/// Larger networks, what is ours and what is Nature's, at relative costs, in units that do not fit.
#[test]
fn every_repair_is_proven_and_no_change_in_it_can_be_less() {
    let shapes = [
        Shape::medium(),
        Shape::medium().chained(),
        Shape { fixed: 20, variable: 40, infinite: 10, delay: 6, ..Shape::medium() },
        Shape { fixed: 20, variable: 40, infinite: 10, delay: 6, ..Shape::medium().chained() },
    ];
    let (mut lists, mut joint, mut several, mut gave_up, mut any) = (0, 0, 0, 0, 0);
    for seed in 0..cases(400) {
        let shape = &shapes[(seed % 4) as usize];
        let random = &mut Random::new(seed);
        let unit = Duration::from_micros(*random.choose(&[1, 300_000, SECOND, 7 * SECOND]));
        let network = random::network(seed, shape);
        let mut knobs = ours(&network);
        let natures_too = random.percent(30);
        if natures_too {
            let is_natures = |knob: &Knob| matches!(knob.parts()[0], Part::LinkLower(_) | Part::LinkUpper(_));
            knobs.extend(bounds(&network).into_iter().filter(is_natures));
        }
        let mut allowed: Vec<Allowed> =
            knobs.into_iter().map(|knob| Allowed::relative(&network, knob, unit)).collect();
        let options = Options { limit: 3, rounds: 500, ..WELL };
        let Some(found) = repairs(&network, &allowed, &options).unwrap() else { continue };
        hold_to_promises(&network, &allowed, options.limit, &found, &format!("seed {seed}"));
        random.shuffle(&mut allowed);
        assert_eq!(repairs(&network, &allowed, &options).unwrap().as_ref(), Some(&found), "seed {seed}");
        let hasty = Options { limit: 3, rounds: 2, ..WELL };
        let some = repairs(&network, &allowed, &hasty).unwrap().unwrap();
        hold_to_promises(&network, &allowed, 0, &some, &format!("seed {seed}, in a hurry"));
        // Both ends of Nature's durations cannot go all the way, and nothing is claimed of chains with late news.
        let as_many = some.repairs.is_empty() == found.repairs.is_empty();
        let shown = |found: &Repairs| found.repairs.iter().map(shown).collect::<Vec<_>>();
        assert!(
            as_many || natures_too || seed % 4 == 3,
            "seed {seed}, in a hurry {:?}, with time {:?}\n{}",
            shown(&some),
            shown(&found),
            random::describe(&network)
        );
        any += usize::from(some.repairs.iter().any(|repair| repair.changes.len() > 1));
        lists += 1;
        joint += usize::from(found.repairs.iter().any(|repair| repair.changes.len() > 1));
        several += usize::from(found.repairs.len() == 3);
        gave_up += usize::from(found.extent == Extent::OutOfRounds);
    }
    let counts = format!(
        "{lists} lists, {joint} joint, {several} of three, {gave_up} given up, {any} for want of a cheap one"
    );
    assert!(lists > 100 && joint > 50 && several > 100 && any > 20 && gave_up * 4 < lists, "{counts}");
}

fn second_units(network: &Network, knobs: Vec<Knob>) -> Vec<Allowed> {
    let unit = Duration::from_micros(SECOND);
    knobs.into_iter().map(|knob| Allowed::relative(network, knob, unit)).collect()
}

fn lines(network: &Network, allowed: &[Allowed]) -> Vec<String> {
    let found = repairs(network, allowed, &WELL).unwrap().unwrap();
    assert_eq!(found.extent, Extent::Complete);
    found.repairs.iter().map(shown).collect()
}

#[test]
fn two_deadlines_that_are_too_early_are_both_moved() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b"],
        "requirements": [{"from": "z", "to": "a", "upper": 5}, {"from": "z", "to": "b", "upper": 20}],
        "contingents": [{"from": "z", "to": "a", "lower": 5, "upper": 10},
                        {"from": "z", "to": "b", "lower": 5, "upper": 30}]}"#;
    let network = json::read(text).unwrap();
    let allowed = second_units(&network, ours(&network));
    assert_eq!(
        lines(&network, &allowed),
        [format!("[RequirementUpper(0)] 5 -> 10, [RequirementUpper(1)] 20 -> 30 for {}", ONE + ONE / 2)]
    );
    let found = repairs(&network, &allowed, &WELL).unwrap().unwrap();
    assert_eq!(found.not_alone, ours(&network));
}

#[test]
fn what_has_to_be_broken_twice_is_broken_where_it_is_cheapest() {
    // Both steps are in both deadlines.
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b", "c"],
        "requirements": [{"from": "z", "to": "a", "lower": 30}, {"from": "a", "to": "b", "lower": 20},
                         {"from": "z", "to": "b", "upper": 40}, {"from": "b", "to": "c", "lower": 0},
                         {"from": "z", "to": "c", "upper": 45}]}"#;
    let network = json::read(text).unwrap();
    let allowed = second_units(&network, ours(&network));
    let lines = lines(&network, &allowed);
    let expected = [
        "[RequirementUpper(2)] 40 -> 45, [RequirementLower(0)] 30 -> 25 for ",
        "[RequirementLower(0)] 30 -> 20 for ",
        "[RequirementUpper(2)] 40 -> 50, [RequirementUpper(4)] 45 -> 50 for ",
        "[RequirementUpper(2)] 40 -> 45, [RequirementLower(1)] 20 -> 15 for ",
        "[RequirementLower(1)] 20 -> 10 for ",
    ];
    assert_eq!(lines.len(), expected.len());
    assert!(lines.iter().zip(expected).all(|(line, expected)| line.starts_with(expected)), "{lines:#?}");
}

#[test]
fn news_that_may_never_come_is_given_a_time() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "c", "x"],
        "requirements": [{"from": "c", "to": "x", "lower": 0, "upper": 5}],
        "contingents": [{"from": "a", "to": "c", "lower": 0, "upper": 10, "delay": [0, null]}]}"#;
    let network = json::read(text).unwrap();
    let lines = lines(&network, &second_units(&network, ours(&network)));
    assert_eq!(
        lines,
        [
            format!("[DelayMax(0)] never -> 5 for {}", ONE / 2),
            format!("[RequirementUpper(0)] 5 -> 10 for {ONE}")
        ]
    );
}

#[test]
fn values_are_whole_units_within_the_limit_and_exact_beyond() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a"],
        "requirements": [{"from": "z", "to": "a", "lower": 95}, {"from": "z", "to": "a", "upper": 70}]}"#;
    let network = json::read(text).unwrap();
    let minute = Duration::from_secs(60);
    let knob = Knob::of(Part::RequirementUpper(0)).unwrap();
    assert_eq!(
        repairs(&network, &[Allowed::relative(&network, knob, minute)], &WELL).unwrap().unwrap().repairs,
        []
    );
    let deadline = Knob::of(Part::RequirementUpper(1)).unwrap();
    let to = |knob: Knob| lines(&network, &[Allowed { knob, weight: 1, unit: minute }]);
    assert_eq!(to(deadline.clone()), ["[RequirementUpper(1)] 70 -> 120 for 50000000"]);
    let limited = |seconds| to(deadline.clone().limited(Duration::from_secs(seconds)));
    assert_eq!(limited(120), ["[RequirementUpper(1)] 70 -> 120 for 50000000"]);
    assert_eq!(limited(119), ["[RequirementUpper(1)] 70 -> 95 for 25000000"]);
    assert_eq!(limited(94), Vec::<String>::new());
}

#[test]
fn where_no_knob_has_a_part_in_the_conflict_there_is_nothing_to_propose() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b"],
        "requirements": [{"from": "z", "to": "a", "upper": 5}, {"from": "z", "to": "b", "upper": 5}],
        "contingents": [{"from": "z", "to": "a", "lower": 6, "upper": 10}]}"#;
    let network = json::read(text).unwrap();
    let knob = Knob::of(Part::RequirementUpper(1)).unwrap();
    let found = repairs(&network, &second_units(&network, vec![knob.clone()]), &WELL).unwrap().unwrap();
    assert_eq!(found, Repairs { repairs: vec![], not_alone: vec![knob], extent: Extent::Complete });
}

#[test]
fn of_knobs_with_a_bound_in_common_one_at_a_time_is_turned() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b", "c"],
        "requirements": [{"from": "z", "to": "a", "lower": 30}, {"from": "a", "to": "b", "lower": 30},
                         {"from": "z", "to": "b", "upper": 40}, {"from": "z", "to": "a", "upper": 25}]}"#;
    let network = json::read(text).unwrap();
    let knob = |parts: &[usize]| {
        let parts = parts.iter().map(|index| Part::RequirementLower(*index)).collect();
        Allowed { knob: Knob::together(parts).unwrap(), weight: 1, unit: Duration::from_micros(SECOND) }
    };
    let allowed = [knob(&[1]), knob(&[0, 1]), knob(&[0])];
    let found = repairs(&network, &allowed, &WELL).unwrap().unwrap();
    let second = knob(&[1]).knob;
    assert_eq!(found.not_alone, [second]);
    assert_eq!(
        found.repairs.iter().map(shown).collect::<Vec<_>>(),
        [
            "[RequirementLower(0), RequirementLower(1)] 30 -> 20 for 10000000",
            "[RequirementLower(0)] 30 -> 10 for 20000000",
        ]
    );
}

#[test]
fn no_rounds_are_not_enough_and_that_is_said() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a"],
        "requirements": [{"from": "z", "to": "a", "lower": 95}, {"from": "z", "to": "a", "upper": 70}]}"#;
    let network = json::read(text).unwrap();
    let none = Options { limit: 3, rounds: 0, ..WELL };
    let found = repairs(&network, &second_units(&network, ours(&network)), &none).unwrap().unwrap();
    assert_eq!((found.repairs.len(), found.extent), (2, Extent::OutOfRounds));
}

/// One after the other, each too short by 2 s: `count` of them.
fn windows(count: usize) -> Network {
    let mut events = vec!["\"z\"".to_string()];
    let (mut requirements, mut contingents) = (Vec::new(), Vec::new());
    let mut last = "z".to_string();
    for number in 0..count {
        let [start, end] = ["s", "e"].map(|name| format!("{name}{number}"));
        events.extend([&start, &end].map(|name| format!("\"{name}\"")));
        let require = |from: &str, to: &str, bounds: &str| {
            format!("{{\"from\": \"{from}\", \"to\": \"{to}\", {bounds}}}")
        };
        requirements.push(require(&last, &start, "\"lower\": 0"));
        requirements.push(require(&last, &end, &format!("\"upper\": {}", 10 + number % 5)));
        contingents.push(require(&start, &end, &format!("\"lower\": 5, \"upper\": {}", 12 + number % 5)));
        last = end;
    }
    json::read(&format!(
        "{{\"format\": \"kirk-network/1\", \"origin\": \"z\", \"events\": [{}], \"requirements\": [{}], \"contingents\": [{}]}}",
        events.join(", "),
        requirements.join(", "),
        contingents.join(", ")
    ))
    .unwrap()
}

#[test]
fn what_has_many_conflicts_is_settled_by_as_many_changes_and_by_none_alone() {
    for count in [2, 7, 8, 9, 60, 300] {
        let network = windows(count);
        let allowed = second_units(&network, ours(&network));
        let found = repairs(&network, &allowed, &Options::default()).unwrap().unwrap();
        let first = &found.repairs[0];
        assert_eq!(first.changes.len(), count);
        assert!(
            first.changes.iter().all(|change| change.amount() == Some(Duration::from_secs(2))),
            "{count}"
        );
        assert!(judge(&changed(&network, &first.changes).unwrap()), "{count}");
        assert_eq!(found.not_alone.len(), allowed.len(), "{count}");
        // That no others were looked for is said.
        assert_eq!(found.extent == Extent::OutOfRounds, count > 50, "{count}");
    }
    let network = windows(300);
    let allowed = second_units(&network, ours(&network));
    let hasty = Options { rounds: 40, patience: 40, ..Options::default() };
    let found = repairs(&network, &allowed, &hasty).unwrap().unwrap();
    assert_eq!((found.repairs.len(), found.extent), (0, Extent::OutOfRounds));
}
