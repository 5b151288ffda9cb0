//! The oracles against each other, and against networks whose verdict can be worked out by hand.
//!
//! The game is checked against a version of itself so naive that it can hardly be wrong (see [`naive`]), the closure and
//! a strong-controllability test against the game. Networks are small enough to be judged thousands of times, and
//! `KIRK_CASES=100000 cargo test -p kirk-network --release --test oracles_agree` judges as many as one likes.

mod oracle;

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement};
use oracle::closure::dynamically_controllable;
use oracle::game::{Rules, controllable, controllable_under};
use oracle::random::{self, Random, Shape};

/// All kinds of networks the game can play.
fn tiny_shapes() -> [Shape; 4] {
    [Shape::tiny(), Shape::tiny().chained(), Shape::tiny_delayed(), Shape::tiny_delayed().chained()]
}

/// How many seeds to try of each shape.
fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// Fails with the smallest network found on which the two judges differ.
fn agree(seed: u64, shape: &Shape, one: impl Fn(&Network) -> bool, other: impl Fn(&Network) -> bool) -> bool {
    let network = random::network(seed, shape);
    let verdict = one(&network);
    if verdict != other(&network) {
        let small = random::shrunk(&network, |network| one(network) != other(network));
        let (one, text) = (one(&small), random::describe(&small));
        panic!("seed {seed}: the first judge says {one}, the other {}, in\n{text}\n{shape:?}", !one);
    }
    verdict
}

#[test]
fn the_closure_and_the_game_agree() {
    for shape in [Shape::tiny(), Shape::tiny().chained()] {
        for seed in 0..cases(20_000) {
            agree(seed, &shape, dynamically_controllable, controllable);
        }
    }
}

#[test]
fn the_game_and_the_naive_game_agree() {
    let small = Shape { executables: 1..=2, horizon: 3, lower: 2, spread: 2, slack: 3, ..Shape::tiny() };
    let small = Shape { links: 1..=2, delay: 2, ..small };
    let delayed = Shape { fixed: 20, variable: 40, infinite: 10, ..small.clone() };
    for shape in [small.clone(), small.chained(), delayed.clone(), delayed.chained()] {
        for seed in 0..cases(1_000) {
            agree(seed, &shape, controllable, naive::controllable);
        }
    }
}

#[test]
fn without_news_controllable_is_strongly_controllable() {
    for shape in [Shape::tiny(), Shape::tiny().chained()] {
        for seed in 0..cases(5_000) {
            let deaf = |network: &Network| {
                let delay = Delay { min: Duration::ZERO, max: Bound::Infinite };
                controllable(&random::with_delays(network, delay))
            };
            agree(seed, &shape, deaf, strongly_controllable);
        }
    }
}

/// What the game takes as not mattering: how fine time is, and finite delays where the delay may be infinite.
#[test]
fn neither_finer_time_nor_late_news_changes_the_game() {
    for shape in tiny_shapes() {
        let shape = Shape { executables: 1..=3, links: 1..=2, ..shape };
        for seed in 0..cases(1_000) {
            let finer = Rules { steps: 2, late_news: Vec::new() };
            agree(seed, &shape, controllable, |network| controllable_under(network, &finer));
            let late = Rules { steps: 1, late_news: vec![0, 1, 4] };
            agree(seed, &shape, controllable, |network| controllable_under(network, &late));
        }
    }
}

#[test]
fn scale_and_order_do_not_matter() {
    for shape in tiny_shapes() {
        for seed in 0..cases(1_000) {
            agree(seed, &shape, controllable, |network| controllable(&random::scaled(network, 1_000)));
            agree(seed, &shape, controllable, |network| {
                controllable(&random::reordered(&mut Random::new(seed), network))
            });
        }
    }
    for shape in [Shape::medium(), Shape::medium().chained()] {
        for seed in 0..100 {
            agree(seed, &shape, dynamically_controllable, |network| {
                dynamically_controllable(&random::reordered(
                    &mut Random::new(seed),
                    &random::scaled(network, 7),
                ))
            });
        }
    }
}

#[test]
fn a_harder_network_is_never_easier() {
    for shape in tiny_shapes() {
        for seed in 0..cases(4_000) {
            let random = &mut Random::new(!seed);
            let mut network = random::network(seed, &shape);
            let mut could = controllable(&network);
            for _ in 0..4 {
                let harder = random::harder(random, &network, shape.unit);
                let can = controllable(&harder);
                let (before, after) = (random::describe(&network), random::describe(&harder));
                assert!(could || !can, "seed {seed}: uncontrollable\n{before}\nbut controllable\n{after}");
                (network, could) = (harder, can);
            }
        }
    }
}

/// The random networks are worth judging: of both kinds, and with verdicts that depend on the news.
#[test]
fn random_networks_are_mixed() {
    for shape in tiny_shapes() {
        let (mut yes, mut with_news, mut with_prompt_news) = (0, 0, 0);
        for seed in 0..1_000 {
            let network = random::network(seed, &shape);
            let never = Delay { min: Duration::ZERO, max: Bound::Infinite };
            let (can, deaf) = (controllable(&network), controllable(&random::with_delays(&network, never)));
            let prompt = controllable(&random::with_delays(&network, Delay::NONE));
            yes += u32::from(can);
            with_news += u32::from(can && !deaf);
            with_prompt_news += u32::from(prompt && !can);
        }
        let delayed = shape.fixed > 0;
        assert!((250..750).contains(&yes), "{yes} controllable: {shape:?}");
        assert!(with_news > 50, "{with_news} that need the news: {shape:?}");
        assert!(!delayed || with_prompt_news > 20, "{with_prompt_news} need the news at once: {shape:?}");
    }
    for shape in [Shape::medium(), Shape::medium().chained()] {
        let judge = |&seed: &u64| dynamically_controllable(&random::network(seed, &shape));
        let yes = (0..400).filter(judge).count();
        assert!((100..300).contains(&yes), "{yes} controllable: {shape:?}");
    }
}

#[test]
fn networks_worked_out_by_hand() {
    for (controllable, what, text) in CLASSICS {
        let network = written(text);
        let described = random::describe(&network);
        assert_eq!(oracle::game::controllable(&network), *controllable, "{what}\n{described}");
        if network.events().len() - network.contingents().len() <= 2 {
            assert_eq!(naive::controllable(&network), *controllable, "naive: {what}\n{described}");
        }
        if network.contingents().iter().all(|link| link.delay == Delay::NONE) {
            assert_eq!(dynamically_controllable(&network), *controllable, "closure: {what}\n{described}");
        }
    }
}

/// Verdict, the reason, and the network: `A =[l,u]=> B` is a link, with a delay `+[min,max]`; `A -[l,u]-> B` a requirement.
/// T is the thesis of C. Pittman (MIT, 2023).
const CLASSICS: &[(bool, &str, &str)] = &[
    // Plain networks.
    (true, "a link alone", "a =[1,3]=> b"),
    (false, "a requirement narrower than the link it is on", "a =[1,3]=> b; a -[1,2]-> b"),
    (true, "a requirement as wide as the link", "a =[1,3]=> b; a -[1,3]-> b"),
    (false, "two contingent ends forced equal", "a =[1,3]=> b; a =[1,3]=> c; b -[0,0]-> c"),
    (true, "contingent ends that cannot be far apart", "a =[1,3]=> b; a =[1,3]=> c; b -[-2,2]-> c"),
    (
        true,
        "contingent ends after different starts",
        "a =[1,3]=> b; x =[1,1]=> c; b -[0,3]-> c; a -[2,inf]-> x",
    ),
    (true, "a link started by the end of another", "a =[1,3]=> b; x =[1,1]=> c; b -[0,1]-> c"),
    (false, "too uncertain for that", "a =[1,3]=> b; x =[1,2]=> c; b -[0,1]-> c"),
    (true, "reaction the moment it happens", "a =[1,7]=> b; b -[0,0]-> x"),
    (false, "an event that must come before Nature's", "a =[1,7]=> b; b -[-1,-1]-> x"),
    (true, "the least Nature may take is enough time", "a =[1,7]=> b; x -[1,7]-> b; a -[0,0]-> x"),
    (true, "waiting for b, but not beyond 6", "a =[1,10]=> b; x -[-inf,4]-> b; a -[-inf,6]-> x"),
    (false, "waiting is not allowed long enough", "a =[1,10]=> b; x -[-inf,4]-> b; a -[-inf,5]-> x"),
    (false, "waiting, and being in time if b is late", "a =[1,10]=> b; x -[-inf,4]-> b; b -[-inf,-1]-> x"),
    (
        true,
        "a wait ended by b, then a second one counted from b",
        "a =[1,4]=> b; c -[-inf,1]-> b; a -[-inf,3]-> c; c =[1,3]=> d; d -[0,0]-> e; b -[-inf,3]-> e",
    ),
    (
        false,
        "the same with no second to spare",
        "a =[1,4]=> b; c -[-inf,1]-> b; a -[-inf,3]-> c; c =[1,3]=> d; d -[0,0]-> e; b -[-inf,1]-> e",
    ),
    (true, "nested follow-up", "a =[1,3]=> b; b -[0,0]-> c; c =[2,4]=> d; d -[1,2]-> e; a -[5,8]-> e"),
    (
        false,
        "too little time if all is slow",
        "a =[1,3]=> b; b -[0,0]-> c; c =[2,4]=> d; d -[1,2]-> e; a -[5,7]-> e",
    ),
    (
        false,
        "too much time if all is fast",
        "a =[1,3]=> b; b -[0,0]-> c; c =[2,4]=> d; d -[1,2]-> e; a -[6,8]-> e",
    ),
    (
        true,
        "a slack start evens out b",
        "a =[1,3]=> b; b -[0,2]-> c; a -[3,3]-> c; c =[2,4]=> d; a -[5,7]-> d",
    ),
    (false, "no executable event before the origin", "a =[4,6]=> b; x -[7,inf]-> b; b -[0,inf]-> y"),
    // Reactions to reactions, all in one instant.
    (true, "links of length 0", "a =[0,2]=> b; b -[0,0]-> c; c =[0,2]=> d; d -[0,0]-> e"),
    // Chains.
    (true, "a chain, followed at once", "a =[1,3]=> p; p =[1,2]=> q; q -[0,0]-> x"),
    (true, "a chain within its sum", "a =[1,3]=> p; p =[1,2]=> q; a -[2,5]-> q; p -[1,2]-> q"),
    (false, "a chain beyond its sum", "a =[1,3]=> p; p =[1,2]=> q; a -[2,4]-> q"),
    (true, "between the two ends of a chain", "a =[1,3]=> p; p =[2,4]=> q; p -[0,2]-> x; x -[0,4]-> q"),
    (
        false,
        "an exact time before the end of a chain",
        "a =[1,3]=> p; p =[2,4]=> q; p -[0,2]-> x; x -[2,3]-> q",
    ),
    (true, "unheard, but its follow-up tells", "a =[1,3]=> p +[0,inf]; p =[1,1]=> q; p -[1,1]-> x"),
    (false, "unheard, and its follow-up is vague", "a =[1,3]=> p +[0,inf]; p =[1,2]=> q; p -[1,1]-> x"),
    (true, "vague by a second, with a second to spare", "a =[1,3]=> p +[0,inf]; p =[1,2]=> q; p -[1,2]-> x"),
    (true, "a promptly heard start corrects a late end", "a =[1,3]=> p; p =[1,2]=> q +[0,inf]; q -[1,2]-> x"),
    (
        true,
        "between the two, the end heard before the start",
        "a =[0,1]=> p +[1,1]; p =[0,1]=> q; p -[0,inf]-> x; x -[0,inf]-> q",
    ),
    (
        true,
        "one vague piece of news is enough",
        "a =[0,2]=> p +[2,2]; p =[0,1]=> q +[0,1]; p -[0,inf]-> x; q -[-inf,1]-> x",
    ),
    (
        false,
        "the same with later news",
        "a =[0,2]=> p +[2,2]; p =[0,1]=> q +[1,2]; p -[0,inf]-> x; q -[-inf,1]-> x",
    ),
    // Fixed delays, T 4.2: none is dynamic, infinite is strong controllability.
    (true, "followed as soon as heard", "a =[1,7]=> b +[2,2]; b -[2,2]-> x"),
    (false, "followed before it is heard", "a =[1,7]=> b +[2,2]; b -[1,1]-> x"),
    (true, "strongly controllable", "a =[1,3]=> b +[0,inf]; b -[2,4]-> x"),
    (false, "not strongly controllable", "a =[1,3]=> b +[0,inf]; b -[2,3]-> x"),
    (true, "only dynamically", "a =[1,3]=> b; b -[2,3]-> x"),
    (true, "a wait does not mind a delay", "a =[1,10]=> b +[1,1]; x -[-inf,4]-> b; a -[-inf,6]-> x"),
    // Variable delays: T section 4.3.1 after lemma 13, and the plain network it is turned into.
    (true, "T 4.3.1", "a =[2,5]=> b +[1,2]; b -[11,20]-> x"),
    (true, "T 4.3.1, transformed", "a =[4,6]=> b; b -[10,18]-> x"),
    (true, "T 4.3.1, just wide enough", "a =[2,5]=> b +[1,2]; b -[11,12]-> x"),
    (false, "T 4.3.1, too narrow", "a =[2,5]=> b +[1,2]; b -[11,11]-> x"),
    (true, "T appendix C", "a =[1,7]=> b +[1,3]; b -[5,9]-> x"),
    (true, "T appendix C, just wide enough", "a =[1,7]=> b +[1,3]; b -[5,7]-> x"),
    (false, "T appendix C, too narrow", "a =[1,7]=> b +[1,3]; b -[5,6]-> x"),
    (true, "T 8.1: hidden, x in [8, 10]", "a =[1,3]=> b +[3,8]; b -[5,9]-> x; a -[8,8]-> x"),
    (false, "T 8.1: not earlier", "a =[1,3]=> b +[3,8]; b -[5,9]-> x; a -[7,7]-> x"),
    (false, "T 8.1: not later", "a =[1,3]=> b +[3,8]; b -[5,9]-> x; a -[11,11]-> x"),
    // A delay as uncertain as the link hides it; one less uncertain does not.
    (true, "less uncertain: heard", "a =[1,3]=> b +[3,4]; b -[5,6]-> x"),
    (false, "as uncertain: hidden", "a =[1,3]=> b +[3,5]; b -[5,6]-> x"),
    (true, "as uncertain, but wide enough blindly", "a =[1,3]=> b +[3,5]; b -[5,7]-> x; a -[8,8]-> x"),
    (false, "more uncertain", "a =[1,3]=> b +[3,6]; b -[5,6]-> x"),
];

/// Reads a network in the form of [`CLASSICS`]; the first event is the origin.
fn written(text: &str) -> Network {
    let mut names: Vec<&str> = Vec::new();
    let mut event = |name| {
        let known = names.iter().position(|&known| known == name);
        EventId(known.unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        }) as u32)
    };
    let bounds = |text: &str| {
        let (_, inner) = text.split_once('[').expect("a bracket");
        let (low, high) = inner.split_once(']').expect("a bracket").0.split_once(',').expect("two bounds");
        let bound = |text: &str| match text {
            "inf" | "-inf" => Bound::Infinite,
            seconds => Duration::parse_seconds(seconds).expect("seconds").into(),
        };
        (bound(low), bound(high))
    };
    let (mut requirements, mut contingents) = (Vec::new(), Vec::new());
    for part in text.split("; ") {
        let words: Vec<&str> = part.split(' ').collect();
        let (from, to, (lower, upper)) = (event(words[0]), event(words[2]), bounds(words[1]));
        if words[1].starts_with('=') {
            let delay = words.get(3).map_or(Delay::NONE, |delay| {
                let (min, max) = bounds(delay);
                Delay { min: min.finite().expect("a least delay"), max }
            });
            let (lower, upper) = (lower.finite().expect("a bound"), upper.finite().expect("a bound"));
            contingents.push(ContingentLink { from, to, lower, upper, delay });
        } else {
            requirements.push(Requirement { from, to, lower, upper });
        }
    }
    let named = |name: &&str| Event { names: [Name { text: name.to_string(), internal: false }].into() };
    let events = names.iter().map(named).collect();
    Network::new("classic".to_string(), EventId(0), events, requirements, contingents)
        .expect("a valid network")
}

/// True if one schedule of the executable events satisfies all requirements whatever Nature picks (T. Vidal,
/// H. Fargier 1999): each requirement must hold between the executable events the two chains of links start from, for
/// the least and the most Nature may put between those and the ends.
fn strongly_controllable(network: &Network) -> bool {
    /// The events from `event` back to its root, and the least and the most from each of them to `event`.
    fn line(network: &Network, event: EventId) -> Vec<(EventId, i64, i64)> {
        let mut line = vec![(event, 0, 0)];
        while let Some(link) = network.link_of(line[line.len() - 1].0) {
            let (link, (_, least, most)) = (&network.contingents()[link], line[line.len() - 1]);
            line.push((link.from, least + link.lower.as_micros(), most + link.upper.as_micros()));
        }
        line
    }
    let mut edges: Vec<(EventId, EventId, i64)> =
        network.event_ids().map(|event| (event, network.origin(), 0)).collect();
    for requirement in network.requirements() {
        for (from, to, weight) in [
            (requirement.from, requirement.to, requirement.upper.finite().map(|upper| upper.as_micros())),
            (requirement.to, requirement.from, requirement.lower.finite().map(|lower| -lower.as_micros())),
        ] {
            let Some(weight) = weight else { continue };
            let (from, to) = (line(network, from), line(network, to));
            // What the two have in common cancels out: go back to where they meet, or else to the two roots.
            let meeting = from.iter().find_map(|a| to.iter().find(|b| a.0 == b.0).map(|b| (*a, *b)));
            let (a, b) = meeting.unwrap_or((from[from.len() - 1], to[to.len() - 1]));
            edges.push((a.0, b.0, weight + a.1 - b.2));
        }
    }
    let mut latest = vec![0; network.events().len()];
    for _ in 0..=latest.len() {
        let before = latest.clone();
        for &(from, to, weight) in &edges {
            latest[to.index()] = latest[to.index()].min(latest[from.index()] + weight);
        }
        if latest == before {
            return true;
        }
    }
    false
}

/// The game again, this time with nothing clever in it: all worlds are listed at the start, true times and times of news
/// are worked out from the world whenever they are needed, and every set of events is tried at every second.
mod naive {
    use super::{Bound, Duration, EventId, Network};
    use std::collections::BTreeMap;

    /// Duration and delay of each link, in seconds. No delay: the news never comes.
    type World = Vec<(i64, Option<i64>)>;

    /// When we executed each event, if we did.
    type Done = Vec<Option<i64>>;

    /// True if there is a strategy that satisfies all requirements whatever Nature picks.
    pub(crate) fn controllable(network: &Network) -> bool {
        let mut worlds: Vec<World> = vec![Vec::new()];
        let mut end = 0;
        for link in network.contingents() {
            let delays: Vec<Option<i64>> = match link.delay.max {
                Bound::Finite(max) => (seconds(link.delay.min)..=seconds(max)).map(Some).collect(),
                Bound::Infinite => vec![None],
            };
            end += seconds(link.upper) + delays.iter().flatten().max().unwrap_or(&0);
            let durations = seconds(link.lower)..=seconds(link.upper);
            let choices: Vec<_> =
                durations.flat_map(|duration| delays.iter().map(move |&delay| (duration, delay))).collect();
            worlds = worlds
                .iter()
                .flat_map(|world| choices.iter().map(|&choice| [&world[..], &[choice]].concat()))
                .collect();
        }
        for requirement in network.requirements() {
            let sizes =
                [requirement.lower, requirement.upper].map(|bound| bound.finite().map_or(0, seconds).abs());
            end += sizes[0].max(sizes[1]);
        }
        let mut done = vec![None; network.events().len()];
        done[network.origin().index()] = Some(0);
        let parts = parts(network, &done, 0, &worlds);
        parts.into_iter().all(|worlds| win(network, &done, 0, end, &worlds))
    }

    /// True if we win from `now` on, in all these worlds, which have all given the same news so far.
    fn win(network: &Network, done: &Done, now: i64, end: i64, worlds: &[World]) -> bool {
        if worlds.iter().any(|world| lost(network, done, now, world)) {
            return false;
        }
        let free = |event: &EventId| network.link_of(*event).is_none() && done[event.index()].is_none();
        let left: Vec<EventId> = network.event_ids().filter(free).collect();
        if left.is_empty() {
            return true;
        }
        let execute = |set: u32| {
            let mut done = done.clone();
            for (bit, event) in left.iter().enumerate() {
                if set >> bit & 1 == 1 {
                    done[event.index()] = Some(now);
                }
            }
            let parts = parts(network, &done, now, worlds);
            parts.into_iter().all(|worlds| win(network, &done, now, end, &worlds))
        };
        let wait = || {
            let parts = parts(network, done, now + 1, worlds);
            parts.into_iter().all(|worlds| win(network, done, now + 1, end, &worlds))
        };
        (1..1 << left.len()).any(execute) || now < end && wait()
    }

    /// The worlds, sorted by the news up to `now`.
    fn parts(network: &Network, done: &Done, now: i64, worlds: &[World]) -> Vec<Vec<World>> {
        let mut parts: BTreeMap<Vec<Option<i64>>, Vec<World>> = BTreeMap::new();
        for world in worlds {
            let news = |(index, link): (usize, &kirk_network::ContingentLink)| {
                let arrives = time(network, done, world, link.to)? + world[index].1?;
                (arrives <= now).then_some(arrives)
            };
            let heard = network.contingents().iter().enumerate().map(news).collect();
            parts.entry(heard).or_default().push(world.clone());
        }
        parts.into_values().collect()
    }

    /// True if a requirement is violated in this world, whatever happens from now on.
    fn lost(network: &Network, done: &Done, now: i64, world: &World) -> bool {
        network.requirements().iter().any(|requirement| {
            match (time(network, done, world, requirement.from), time(network, done, world, requirement.to)) {
                (Some(from), Some(to)) => {
                    requirement.lower.finite().is_some_and(|lower| to - from < seconds(lower))
                        || requirement.upper.finite().is_some_and(|upper| to - from > seconds(upper))
                }
                // What has no time yet will have a time from now on.
                (Some(from), None) => {
                    requirement.upper.finite().is_some_and(|upper| now - from > seconds(upper))
                }
                (None, Some(to)) => requirement.lower.finite().is_some_and(|lower| to - now < seconds(lower)),
                (None, None) => false,
            }
        })
    }

    /// The true time of an event in this world, past or future, if it follows from what has been executed.
    fn time(network: &Network, done: &Done, world: &World, event: EventId) -> Option<i64> {
        match network.link_of(event) {
            None => done[event.index()],
            Some(link) => Some(time(network, done, world, network.contingents()[link].from)? + world[link].0),
        }
    }

    fn seconds(duration: Duration) -> i64 {
        assert_eq!(duration.as_micros() % 1_000_000, 0, "whole seconds");
        duration.as_micros() / 1_000_000
    }
}
