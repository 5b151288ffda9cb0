//! Slack, promises and budgets: "yes" at every figure, "no" a microsecond beyond it.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-network --release --test slack` runs as many networks as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use kirk_network::merge::merge;
use kirk_network::promise::{promises, put_off_to, stretch};
use kirk_network::slack::{Factor, Slack, beyond, bounds, common_factor, slack};
use kirk_network::windows::windows;
use kirk_network::{
    Bound, Conflict, ContingentLink, Duration, EventId, Network, Part, Requirement, Time, Verdict, check,
    json,
};
use oracle::closure;
use oracle::random::{self, Random, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

fn controllable(network: &Network) -> bool {
    check(network).unwrap() == Verdict::Controllable
}

fn micros(count: i64) -> Duration {
    Duration::from_micros(count)
}

/// Controllable networks of a few shapes, each with its seed and how to describe it.
fn controllables(usual: u64, shapes: &[Shape], mut with: impl FnMut(u64, &Network, &dyn Fn() -> String)) {
    let mut count = 0;
    for seed in 0..cases(usual) {
        let network = random::network(seed, &shapes[(seed % shapes.len() as u64) as usize]);
        if controllable(&network) {
            count += 1;
            with(seed, &network, &|| format!("seed {seed}:\n{}", random::describe(&network)));
        }
    }
    assert!(count > cases(usual) / 10, "{count} networks were controllable");
}

fn too_careful(network: &Network) -> bool {
    matches!(check(network).unwrap(), Verdict::Uncontrollable(conflict) if conflict.conservative)
}

fn shapes() -> [Shape; 4] {
    [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()]
}

#[test]
fn slack_is_tight_on_both_sides() {
    let mut limits = 0;
    controllables(600, &shapes(), |seed, network, describe| {
        let random = &mut Random::new(seed);
        let knobs = bounds(network);
        let found = slack(network, &knobs).unwrap().unwrap();
        assert_eq!(found.len(), knobs.len());
        for Slack { knob, value, least, most, room, loses } in found {
            let yes = |value: Bound| {
                // Turned below the shortest delay, the longest takes that along; here all else is as it is.
                let same_shortest = match (knob.parts()[0], value) {
                    (Part::DelayMax(index), Bound::Finite(max)) => {
                        network.contingents()[index].delay.min <= max
                    }
                    _ => true,
                };
                knob.at(network, value).filter(|_| same_shortest).map(|varied| controllable(&varied))
            };
            let about = || format!("{:?} {value:?} in {least:?} to {most:?}, {}", knob.parts(), describe());
            for (end, outward) in [(least, -1), (most, 1)] {
                let Some(end) = end.finite() else { continue };
                assert_eq!(yes(end.into()), Some(true), "at {end}: {}", about());
                let beyond = yes(end.checked_add(micros(outward)).unwrap().into());
                assert_ne!(beyond, Some(true), "beyond {end}: {}", about());
                limits += 1;
                // Between here and there, too.
                let Some(value) = value.finite() else { continue };
                let (low, high) = (value.min(end), value.max(end));
                let between = micros(random.within(low.as_micros()..=high.as_micros()));
                // In a delayed chain a "no" may be too careful, and then it says so: it is none.
                let careful = knob.at(network, between.into()).is_some_and(|varied| too_careful(&varied));
                assert!(careful || yes(between.into()) == Some(true), "at {between}: {}", about());
            }
            let is_harder_if_less =
                matches!(knob.parts()[0], Part::RequirementUpper(_) | Part::LinkLower(_) | Part::DelayMin(_));
            let end = if is_harder_if_less { least } else { most };
            let distance = |a: Duration, b: Duration| micros((a.as_micros() - b.as_micros()).abs());
            let expected = end.finite().zip(value.finite()).map(|(end, value)| distance(end, value));
            assert_eq!(room, expected, "{}", about());
            // It loses the guarantee where there is a bound a microsecond further, and not where it is none any more.
            let further =
                end.finite().and_then(|end| end.checked_add(micros(if is_harder_if_less { -1 } else { 1 })));
            assert_eq!(loses, further.and_then(|value| yes(value.into())) == Some(false), "{}", about());
            let far = if is_harder_if_less { least } else { most } == Bound::Infinite;
            if far && matches!(knob.parts()[0], Part::DelayMax(_)) {
                assert_eq!(yes(Bound::Infinite), Some(true), "{}", about());
            }
        }
    });
    assert!(limits > 500, "{limits} limits");
}

#[test]
fn what_stops_a_bound_adds_up_to_what_is_left() {
    let (mut exact, mut all) = (0, 0);
    controllables(400, &shapes(), |_, network, describe| {
        for found in slack(network, &bounds(network)).unwrap().unwrap() {
            let about = || format!("{:?}, {}", found.knob.parts(), describe());
            let conflict = beyond(network, &found).unwrap();
            assert_eq!(conflict.is_some(), found.loses, "{}", about());
            let Some(Conflict { members, total, .. }) = conflict else { continue };
            let sum: i64 = members.iter().map(|share| share.amount.as_micros()).sum();
            assert_eq!(sum, total.as_micros(), "{}", about());
            // The chain is a lack a microsecond further, and may have been one before if it holds only there.
            let own = members.iter().find(|share| share.part == found.knob.parts()[0]);
            let times = own.map_or(0, |share| i64::from(share.times));
            let room = found.room.unwrap().as_micros();
            assert!(sum < room * times + times, "{sum} of {times} times {room}: {}", about());
            all += 1;
            exact += u32::from(times == 1 && sum == room);
        }
    });
    assert!(all > 300 && exact * 2 > all, "{exact} of {all}");
}

#[test]
fn without_delays_the_closure_sees_the_same_slack() {
    controllables(500, &[Shape::tiny(), Shape::tiny().chained()], |_, network, describe| {
        for Slack { knob, least, most, .. } in slack(network, &bounds(network)).unwrap().unwrap() {
            if matches!(knob.parts()[0], Part::DelayMin(_) | Part::DelayMax(_)) {
                continue;
            }
            for (end, outward) in [(least, -1), (most, 1)] {
                let Some(end) = end.finite() else { continue };
                let judged = |value: Duration| {
                    // What becomes [0, 0] is merged by us and not by the closure.
                    let varied = knob.at(network, value.into())?;
                    let same = merge(&varied).network.events().len() == merge(network).network.events().len();
                    same.then(|| closure::dynamically_controllable(&varied))
                };
                assert_ne!(judged(end), Some(false), "{:?} at {end}: {}", knob.parts(), describe());
                let further = end.checked_add(micros(outward)).unwrap();
                assert_ne!(judged(further), Some(true), "{:?} beyond {end}: {}", knob.parts(), describe());
            }
        }
    });
}

/// The network with one more requirement from the origin to an event.
fn timed(network: &Network, event: EventId, lower: Bound, upper: Bound) -> Network {
    let mut requirements = network.requirements().to_vec();
    // [0, 0] would say that the event is the origin.
    requirements.push(Requirement { from: network.origin(), to: event, lower, upper });
    random::with(network, requirements, network.contingents().to_vec())
}

#[test]
fn promises_are_kept_and_no_better_ones_can_be() {
    let (mut ours, mut natures) = (0, 0);
    controllables(600, &shapes(), |_, network, describe| {
        let events: Vec<EventId> = network.event_ids().collect();
        let (merged, windows) = (merge(network), windows(network).unwrap());
        let origin = merged.event_of[network.origin().index()];
        for (event, promise) in events.iter().zip(promises(network, &events).unwrap().unwrap()) {
            if merged.event_of[event.index()] == origin {
                assert_eq!((promise.by, promise.from), (Some(Time::ZERO), Some(Time::ZERO)));
                continue;
            }
            let window = windows[event.index()];
            let is_possible =
                |from: Time| window.earliest <= from && window.latest.is_none_or(|latest| from <= latest);
            assert!(promise.from.is_none_or(is_possible), "{promise:?} in {window:?}, {}", describe());
            let alone = put_off_to(network, *event).unwrap().unwrap().finite();
            assert_eq!(alone.map(Duration::as_micros), promise.from.map(Time::as_micros));
            let about = || format!("{promise:?} of {}, {}", network.id(*event), describe());
            let bound = |time: i64| Bound::Finite(micros(time));
            let by = |time: i64| controllable(&timed(network, *event, Bound::Infinite, bound(time)));
            let from = |time: i64| controllable(&timed(network, *event, bound(time), Bound::Infinite));
            let latest = promise.by.expect("everything happens in the end").as_micros();
            assert!(by(latest), "{}", about());
            assert!(latest == 0 || !by(latest - 1), "{}", about());
            if let Some(time) = promise.from.map(Time::as_micros) {
                assert!(from(time) && !from(time + 1), "{}", about());
            } else {
                assert!(from(1 << 50), "{}", about());
            }
            *(if promise.from.is_some_and(|from| from.as_micros() < latest) {
                &mut natures
            } else {
                &mut ours
            }) += 1;
        }
    });
    assert!(ours > 100 && natures > 100, "{ours} can be put off, {natures} cannot");
}

#[test]
fn a_duration_stretches_so_far_and_no_further() {
    let mut limited = 0;
    controllables(300, &shapes(), |_, network, describe| {
        for index in 0..network.requirements().len() {
            let requirement = network.requirements()[index];
            let with = |lower: Duration| {
                let mut requirements = network.requirements().to_vec();
                requirements[index] =
                    Requirement { lower: lower.into(), upper: Bound::Infinite, ..requirement };
                controllable(&random::with(network, requirements, network.contingents().to_vec()))
            };
            let about = || format!("requirements[{index}], {}", describe());
            match stretch(network, index).unwrap().unwrap() {
                Bound::Finite(longest) if Bound::Finite(longest) != requirement.lower => {
                    limited += 1;
                    assert!(with(longest) && !with(longest.checked_add(micros(1)).unwrap()), "{}", about());
                }
                Bound::Finite(_) => {}
                Bound::Infinite => assert!(with(micros(1 << 50)), "{}", about()),
            }
        }
    });
    assert!(limited > 100, "{limited} have a limit");
}

#[test]
fn all_delays_grow_by_the_common_factor_and_not_by_more() {
    let mut factors = 0;
    controllables(2500, &shapes()[..2], |_, network, describe| {
        let scaled = |millionths: i64| {
            let links = network.contingents().iter().map(|link| {
                let max = link.delay.max.finite().map_or(Bound::Infinite, |max| {
                    micros((i128::from(max.as_micros()) * i128::from(millionths) / 1_000_000) as i64).into()
                });
                ContingentLink { delay: kirk_network::Delay { max, ..link.delay }, ..*link }
            });
            controllable(&random::with(network, network.requirements().to_vec(), links.collect()))
        };
        match common_factor(network).unwrap() {
            Some(Factor::Millionths(factor)) => {
                factors += 1;
                assert!(scaled(factor) && !scaled(factor + 1), "{factor}: {}", describe());
            }
            Some(Factor::Unlimited) => assert!(scaled(1 << 40), "{}", describe()),
            None => assert!(
                network.contingents().iter().all(|link| link
                    .delay
                    .max
                    .finite()
                    .is_none_or(|max| max == Duration::ZERO)),
                "{}",
                describe()
            ),
        }
    });
    assert!(factors > 25, "{factors} factors");
}

/// C 0 to 10 s after its news, which is 2 to 5 s late, and everything within 45 s.
fn mission() -> Network {
    json::read(
        r#"{"format": "kirk-network/1", "origin": "start", "events": ["start", "scanned", "act", "free"],
        "requirements": [{"from": "scanned", "to": "act", "lower": 0, "upper": 10}, {"from": "start", "to": "act", "upper": 45},
                         {"from": "act", "to": "free", "lower": 0}],
        "contingents": [{"from": "start", "to": "scanned", "lower": 15, "upper": 30, "delay": [2, 5]}]}"#,
    )
    .unwrap()
}

#[test]
fn the_slack_of_a_mission() {
    let network = mission();
    let seconds = |bound: Bound| bound.finite().map(|finite| finite.to_string());
    let all = slack(&network, &bounds(&network)).unwrap().unwrap();
    let shown: Vec<(Part, Option<String>, Option<String>)> =
        all.iter().map(|it| (it.knob.parts()[0], seconds(it.least), seconds(it.most))).collect();
    let at = |text: &str| Some(text.to_string());
    assert_eq!(
        shown,
        [
            (Part::RequirementLower(0), None, at("7")),
            (Part::RequirementUpper(0), at("5"), None),
            (Part::RequirementUpper(1), at("30"), None),
            (Part::RequirementLower(2), None, None),
            (Part::LinkLower(0), at("0"), at("30")),
            (Part::LinkUpper(0), at("15"), at("45")),
            (Part::DelayMin(0), at("0"), at("5")),
            (Part::DelayMax(0), at("2"), at("10")),
        ]
    );
    assert_eq!(common_factor(&network).unwrap(), Some(Factor::Millionths(2_000_000)));
    let critical = beyond(&network, &all[7]).unwrap().unwrap();
    assert!(critical.members.iter().any(|share| share.part == Part::LinkUpper(0)), "{critical:?}");
    let events: Vec<EventId> = network.event_ids().collect();
    let shown: Vec<(Option<String>, Option<String>)> = promises(&network, &events)
        .unwrap()
        .unwrap()
        .iter()
        .map(|it| (it.by.map(|time| time.to_string()), it.from.map(|time| time.to_string())))
        .collect();
    let expected = [(at("0"), at("0")), (at("30"), at("15")), (at("30"), at("25")), (at("30"), None)];
    assert_eq!(shown, expected);
}

#[test]
fn of_what_is_not_controllable_there_is_no_slack() {
    let mut requirements = mission().requirements().to_vec();
    requirements[0].upper = Duration::from_secs(4).into();
    let network = random::with(&mission(), requirements, mission().contingents().to_vec());
    let events: Vec<EventId> = network.event_ids().collect();
    assert_eq!(slack(&network, &bounds(&network)).unwrap(), None);
    assert_eq!(promises(&network, &events).unwrap(), None);
    assert_eq!(stretch(&network, 0).unwrap(), None);
    assert_eq!(common_factor(&network).unwrap(), None);
}
