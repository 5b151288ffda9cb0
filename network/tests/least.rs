//! Least changes against plain bisection, with the labelled closure and the game as judges.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-network --release --test least` runs as many networks as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::least::{could_settle, least_changes};
use kirk_network::merge::merge;
use kirk_network::slack::bounds;
use kirk_network::vary::{Change, Knob};
use kirk_network::witness::witness;
use kirk_network::{Bound, Delay, Duration, Network, Part, Verdict, check, json};
use oracle::random::{self, Random, Shape};
use oracle::{closure, game};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

const MICRO: Duration = Duration::from_micros(1);

fn controllable(network: &Network) -> bool {
    check(network).unwrap() == Verdict::Controllable
}

/// True if a larger value of this bound is easier.
fn more_is_easier(knob: &Knob) -> bool {
    matches!(knob.parts()[0], Part::RequirementUpper(_) | Part::LinkLower(_) | Part::DelayMin(_))
}

/// The value so much easier, or harder if `by` is negative.
fn easier(knob: &Knob, value: Bound, by: Duration) -> Option<Bound> {
    let value = value.finite()?;
    let moved = if more_is_easier(knob) { value.checked_add(by) } else { value.checked_sub(by) };
    moved.map(Bound::Finite)
}

/// The easiest value that the network allows.
fn easiest(network: &Network, knob: &Knob) -> Bound {
    match knob.parts()[0] {
        Part::LinkLower(index) => network.contingents()[index].upper.into(),
        Part::LinkUpper(index) => network.contingents()[index].lower.into(),
        Part::DelayMin(index) => match network.contingents()[index].delay {
            Delay { max: Bound::Finite(max), .. } => max.into(),
            Delay { min, .. } => min.into(),
        },
        Part::DelayMax(_) => Duration::ZERO.into(),
        _ => Bound::Infinite,
    }
}

/// Where a judge says "yes" for the first time on the way to the easiest value: by halving, and nothing else.
fn bisected(network: &Network, knob: &Knob, yes: impl Fn(&Network) -> bool) -> Option<Bound> {
    const FAR: i64 = 1 << 40;
    let from = knob.value(network);
    let sign = if more_is_easier(knob) { 1 } else { -1 };
    let start = from.finite().map_or(sign * -FAR, Duration::as_micros);
    let end = easiest(network, knob).finite().map_or(sign * FAR, Duration::as_micros);
    let at = |micros: i64| knob.at(network, Duration::from_micros(micros).into()).unwrap();
    if !yes(&knob.at(network, easiest(network, knob)).unwrap()) {
        return None;
    }
    let (mut no, mut found) = (start, end);
    while (found - no).abs() > 1 {
        let middle = no + (found - no) / 2;
        *(if yes(&at(middle)) { &mut found } else { &mut no }) = middle;
    }
    Some(Duration::from_micros(found).into())
}

/// The least changes of all bounds of an uncontrollable network.
fn changes(network: &Network) -> Vec<(Knob, Option<Change>)> {
    let knobs = bounds(network);
    let changes = least_changes(network, &knobs).unwrap();
    knobs.into_iter().zip(changes).collect()
}

#[test]
fn without_delays_the_least_change_is_that_of_plain_bisection_with_the_closure() {
    let shapes = [Shape::tiny(), Shape::tiny().chained()];
    let (mut helped, mut not_alone) = (0, 0);
    for seed in 0..cases(1600) {
        let network = random::network(seed, &shapes[(seed % 2) as usize]);
        if closure::dynamically_controllable(&network) {
            continue;
        }
        for (knob, change) in changes(&network) {
            let expected = bisected(&network, &knob, closure::dynamically_controllable);
            assert_eq!(
                change.as_ref().map(|change| change.to),
                expected,
                "seed {seed}, {:?} of\n{}",
                knob.parts(),
                random::describe(&network)
            );
            *(if expected.is_some() { &mut helped } else { &mut not_alone }) += 1;
        }
    }
    assert!(helped > 800 && not_alone > 800, "{helped} helped, {not_alone} did not");
}

#[test]
fn a_change_is_just_enough() {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let mut helped = 0;
    for seed in 0..cases(1500) {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        if controllable(&network) {
            continue;
        }
        for (knob, change) in changes(&network) {
            let describe = || format!("seed {seed}, {:?} of\n{}", knob.parts(), random::describe(&network));
            let Some(change) = change else {
                let far = knob.at(&network, easiest(&network, &knob));
                assert!(far.is_some_and(|far| !controllable(&far)), "it would help: {}", describe());
                continue;
            };
            helped += 1;
            assert!(controllable(&knob.at(&network, change.to).unwrap()), "too little: {}", describe());
            let before = easier(&knob, change.to, Duration::from_micros(-1)).unwrap();
            let before = knob.at(&network, before).unwrap();
            assert!(!controllable(&before), "more than needed, {change:?}: {}", describe());
        }
    }
    assert!(helped > 500, "{helped} changes");
}

/// Delays and chains are played: at whole seconds, as the game has no less.
#[test]
fn the_game_agrees_on_both_sides_of_the_least_change() {
    let (mut agreed, mut careful) = (0, 0);
    for seed in 0..cases(2000) {
        let shape = if seed % 2 == 0 { Shape::tiny_delayed() } else { Shape::tiny_delayed().chained() };
        let network = random::network(seed, &shape);
        let merged = merge(&network).network;
        if controllable(&network) {
            continue;
        }
        let chained = merged.contingents().iter().any(|link| merged.link_of(link.from).is_some());
        let random = &mut Random::new(seed);
        let all = changes(&network);
        let (knob, change) = random.choose(&all);
        let Some(Change { to: Bound::Finite(to), .. }) = change else { continue };
        let second = Duration::from_secs(1).as_micros();
        let (down, up) = (to.as_micros().div_euclid(second), (to.as_micros() - 1).div_euclid(second) + 1);
        let (enough, too_little) = if more_is_easier(knob) { (up, up - 1) } else { (down, down + 1) };
        let won = |seconds: i64| {
            let varied = knob.at(&network, Duration::from_secs(seconds).into());
            varied.map(|varied| game::controllable(&merge(&varied).network))
        };
        let describe =
            || format!("seed {seed}, {:?} {change:?} of\n{}", knob.parts(), random::describe(&network));
        assert_ne!(won(enough), Some(false), "too little: {}", describe());
        match won(too_little) {
            Some(true) if chained => careful += 1,
            Some(true) => panic!("more than needed: {}", describe()),
            _ => agreed += 1,
        }
    }
    assert!(agreed > 80 && careful < agreed / 10, "{agreed} agreed, {careful} were too careful");
}

#[test]
fn what_could_settle_a_conflict_is_all_that_can_settle_it_alone() {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let (mut helps, mut left_out) = (0, 0);
    for seed in 0..cases(1500) {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let Verdict::Uncontrollable(conflict) = check(&network).unwrap() else { continue };
        let candidates = could_settle(&network, &conflict);
        for (knob, change) in changes(&network) {
            if change.is_some() {
                helps += 1;
                let is_candidate = candidates.contains(&knob.parts()[0]);
                assert!(is_candidate, "seed {seed}, {change:?} of\n{}", random::describe(&network));
            } else {
                left_out += usize::from(!candidates.contains(&knob.parts()[0]));
            }
        }
    }
    assert!(helps > 500 && left_out > 500, "{helps} help, {left_out} are no candidates");
}

#[test]
fn a_witness_lacks_what_the_change_is_and_its_members_alone_are_a_conflict() {
    let shapes = [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium()];
    let (mut changed, mut found) = (0, 0);
    for seed in 0..cases(1500) {
        let network = random::network(seed, &shapes[(seed % 3) as usize]);
        if controllable(&network) {
            continue;
        }
        for change in changes(&network).into_iter().filter_map(|(_, change)| change) {
            let Some(amount) = change.amount() else { continue };
            changed += 1;
            let Some(it) = witness(&network, &change).unwrap() else { continue };
            found += 1;
            let describe = || format!("seed {seed}, {change:?}, {it:?} of\n{}", random::describe(&network));
            let sum: i64 = it.conflict.members.iter().map(|share| share.amount.as_micros()).sum();
            assert_eq!(sum, it.conflict.total.as_micros(), "{}", describe());
            for share in it.conflict.members.iter().filter(|share| share.times > 0) {
                let bound = share.part.bound(&network).as_micros() * i64::from(share.times);
                assert_eq!(share.amount.as_micros().abs(), bound.abs(), "{}", describe());
            }
            let (times, missing) = (i64::from(it.times), -sum);
            assert_eq!((missing + times - 1) / times, amount.as_micros(), "{}", describe());
            // What is no member may leave all the time there is.
            let mut rest = network.clone();
            for knob in bounds(&network) {
                let part = knob.parts()[0];
                let is_ours = matches!(part, Part::RequirementLower(_) | Part::RequirementUpper(_));
                let is_member = it.conflict.members.iter().any(|share| match share.part {
                    Part::Join(index) => {
                        part == Part::RequirementLower(index) || part == Part::RequirementUpper(index)
                    }
                    member => member == part,
                });
                if is_ours && !is_member {
                    rest = knob.at(&rest, Bound::Infinite).unwrap();
                }
            }
            assert!(!controllable(&rest), "{}", describe());
        }
    }
    assert!(found > 300 && found * 2 > changed, "{found} of {changed}");
}

#[test]
fn knobs_of_several_bounds_move_together() {
    let text = |upper: &str| {
        format!(
            r#"{{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b", "c"],
            "requirements": [{{"from": "z", "to": "a", "lower": 10, "upper": 20}},
                             {{"from": "a", "to": "b", "lower": 30, "upper": 40}},
                             {{"from": "z", "to": "b", "upper": {upper}}}]}}"#
        )
    };
    let network = json::read(&text("30")).unwrap();
    let both = Knob::together(vec![Part::RequirementLower(0), Part::RequirementLower(1)]).unwrap();
    let least = |knob: &Knob| least_changes(&network, std::slice::from_ref(knob)).unwrap().remove(0);
    let change = least(&both).unwrap();
    assert_eq!((change.from, change.to), (Duration::from_secs(10).into(), Duration::from_secs(5).into()));
    // One of them alone would have to go below nothing.
    let one = Knob::of(Part::RequirementLower(0)).unwrap();
    assert_eq!(least(&one).unwrap().to, Duration::ZERO.into());
    assert_eq!(least(&one.limited(MICRO)), None);
    assert_eq!(Knob::together(vec![Part::RequirementLower(0), Part::RequirementUpper(1)]), None);
}

#[test]
fn a_knob_whose_other_bound_is_farther_out_has_a_least_change_too() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a"],
        "requirements": [{"from": "a", "to": "z", "lower": 0, "upper": 0},
                         {"from": "a", "to": "z", "lower": -3, "upper": -1}]}"#;
    let network = json::read(text).unwrap();
    let both = Knob::together(vec![Part::RequirementLower(0), Part::RequirementLower(1)]).unwrap();
    let change = least_changes(&network, &[both]).unwrap().remove(0).unwrap();
    assert_eq!(change.to, Duration::from_secs(-1).into());
}

#[test]
fn news_that_may_never_come_is_named_with_the_delay_it_would_need() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "c", "x"],
        "requirements": [{"from": "c", "to": "x", "lower": 0, "upper": 5}],
        "contingents": [{"from": "a", "to": "c", "lower": 0, "upper": 10, "delay": [0, null]}]}"#;
    let network = json::read(text).unwrap();
    let news = Knob::of(Part::DelayMax(0)).unwrap();
    let change = least_changes(&network, &[news]).unwrap().remove(0).unwrap();
    assert_eq!((change.from, change.to), (Bound::Infinite, Duration::from_secs(5).into()));
}

#[test]
fn more_may_be_needed_than_the_first_conflict_lacks() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "c", "x"],
        "requirements": [{"from": "c", "to": "x", "lower": -0.5, "upper": 0.5}],
        "contingents": [{"from": "z", "to": "c", "lower": 2, "upper": 7, "delay": [1, 4]}]}"#;
    let network = json::read(text).unwrap();
    let knobs = bounds(&network);
    let changes = least_changes(&network, &knobs).unwrap();
    let shown = |change: &Option<Change>| change.as_ref().map(|it| it.to.finite().unwrap().to_string());
    let shown: Vec<Option<String>> = changes.iter().map(shown).collect();
    // Lower, upper of the requirement; lower, upper of the link; shortest, longest delay. The first conflict lacks 2 s;
    // but x cannot be up to 2.5 s after c before c is known, as it is only 4 s after it.
    let expected = [Some("-4.5"), Some("4"), Some("6"), Some("3"), None, Some("0.5")];
    assert_eq!(shown, expected.map(|text| text.map(str::to_string)));
}
