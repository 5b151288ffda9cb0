//! The oracles against each other, and against networks whose verdict can be worked out by hand.
//!
//! The game is checked against a version of itself so naive that it can hardly be wrong (see [`naive`]), the closure and
//! a strong-controllability test against the game. Networks are small enough to be judged thousands of times.

mod oracle;

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement};
use oracle::closure::dynamically_controllable;
use oracle::game::{Rules, controllable, controllable_under};
use oracle::random::{self, Random, Shape};

/// All kinds of networks the game can play.
fn tiny_shapes() -> [Shape; 4] {
    [Shape::tiny(), Shape::tiny().chained(), Shape::tiny_delayed(), Shape::tiny_delayed().chained()]
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
    for (shape, count) in [(Shape::tiny(), 20_000), (Shape::tiny().chained(), 20_000)] {
        let yes =
            (0..count).filter(|&seed| agree(seed, &shape, dynamically_controllable, controllable)).count();
        assert!(yes as u64 * 4 > count && (yes as u64) * 4 < count * 3, "{yes} of {count}: {shape:?}");
    }
}

#[test]
fn the_game_and_the_naive_game_agree() {
    let small = Shape { executables: 1..=2, horizon: 3, lower: 2, spread: 2, slack: 3, ..Shape::tiny() };
    let small = Shape { links: 1..=2, delay: 2, ..small };
    let delayed = Shape { fixed: 20, variable: 40, infinite: 10, ..small.clone() };
    for shape in [small.clone(), small.chained(), delayed.clone(), delayed.chained()] {
        for seed in 0..1000 {
            agree(seed, &shape, controllable, naive::controllable);
        }
    }
}

#[test]
fn without_news_controllable_is_strongly_controllable() {
    for shape in [Shape::tiny(), Shape::tiny().chained()] {
        for seed in 0..5_000 {
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
        for seed in 0..1_000 {
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
        for seed in 0..1_000 {
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
        for seed in 0..4_000 {
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
        "a =[1,3]=> b; x =[1,1]=> c; b -[-4,0]-> c; a -[2,inf]-> x",
    ),
    (false, "one second apart in the worst case", "a =[1,3]=> b; x =[1,1]=> c; b -[0,1]-> c; a -[0,inf]-> x"),
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
        let inner = text.trim_matches(['=', '-', '>', '[', ']', '+']);
        let (low, high) = inner.split_once(',').expect("two bounds");
        let bound =
            |text: &str| text.parse().map_or(Bound::Infinite, |seconds| Duration::from_secs(seconds).into());
        (bound(low), bound(high))
    };
    let (mut requirements, mut contingents) = (Vec::new(), Vec::new());
    for part in text.split("; ") {
        let words: Vec<&str> = part.split(' ').collect();
        // `-[-3,-1]->`: only the arrow goes, not the signs.
        let arrow = words[1].trim_start_matches(['=', '-']).trim_end_matches(['=', '-', '>']);
        let (from, to, (lower, upper)) = (event(words[0]), event(words[2]), bounds_in(arrow, bounds));
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
    let named = |name: &&str| Event { names: vec![Name { text: name.to_string(), internal: false }] };
    let events = names.iter().map(named).collect();
    Network::new("classic".to_string(), EventId(0), events, requirements, contingents)
        .expect("a valid network")
}
