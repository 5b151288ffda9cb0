//! Random networks from seeds, a readable form of them, and a way to make a failing one smaller.
//!
//! Equal seeds and shapes give equal networks on every machine, so a seed in a failure message is enough to see the
//! failure again. About half of the networks of the shapes given here are controllable: a nominal schedule
//! is drawn first, and most requirements leave some slack around it.

use std::fmt::Write;
use std::ops::RangeInclusive;

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement};

/// A small pseudo-random generator (SplitMix64; Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator that depends on the seed only.
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in the range, all (very nearly) equally likely.
    pub fn within(&mut self, range: RangeInclusive<i64>) -> i64 {
        let count = (range.end() - range.start() + 1) as u64;
        range.start() + (self.bits() % count) as i64
    }

    /// True in so many of 100 cases.
    pub fn percent(&mut self, chance: i64) -> bool {
        self.within(1..=100) <= chance
    }

    /// One of these. There must be one.
    pub fn choose<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.within(0..=from.len() as i64 - 1) as usize]
    }

    /// Puts them in random order.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.within(0..=last as i64) as usize);
        }
    }
}

/// What networks to make. Times are in units of [`Shape::unit`], chances in percent.
#[derive(Clone, Debug)]
pub struct Shape {
    /// How many executable events besides the origin.
    pub executables: RangeInclusive<i64>,
    /// How many contingent links.
    pub links: RangeInclusive<i64>,
    /// How many further requirements for each event but the origin, in percent: 100 is one for each.
    pub density: RangeInclusive<i64>,
    /// The latest nominal time of an executable event.
    pub horizon: i64,
    /// The largest lower bound of a link.
    pub lower: i64,
    /// The largest `upper - lower` of a link.
    pub spread: i64,
    /// How far a requirement may reach below and above its nominal value.
    pub slack: i64,
    /// Chance of an executable event that follows a contingent one within a narrow interval.
    pub follow: i64,
    /// Chance of a link that starts at a contingent event.
    pub chain: i64,
    /// Chance of a fixed delay, not zero.
    pub fixed: i64,
    /// Chance of a variable delay.
    pub variable: i64,
    /// Chance of an infinite delay.
    pub infinite: i64,
    /// The largest least delay, and the largest difference between least and most.
    pub delay: i64,
    /// What one unit of time is.
    pub unit: Duration,
}

impl Shape {
    /// Small enough for the game, without delays and chains.
    pub fn tiny() -> Shape {
        Shape {
            executables: 1..=5,
            links: 1..=3,
            density: 20..=100,
            horizon: 8,
            lower: 4,
            spread: 4,
            slack: 8,
            follow: 50,
            chain: 0,
            fixed: 0,
            variable: 0,
            infinite: 0,
            delay: 0,
            unit: Duration::from_secs(1),
        }
    }

    /// Small enough for the game, with all kinds of delays, without chains.
    pub fn tiny_delayed() -> Shape {
        Shape { fixed: 20, variable: 40, infinite: 10, delay: 4, slack: 9, ..Shape::tiny() }
    }

    /// A few dozen events: too large for the game, not for the closure.
    pub fn medium() -> Shape {
        Shape {
            executables: 6..=16,
            links: 2..=8,
            density: 20..=100,
            horizon: 60,
            lower: 8,
            spread: 8,
            slack: 40,
            ..Shape::tiny()
        }
    }

    /// The same with chains.
    pub fn chained(self) -> Shape {
        Shape { chain: 50, links: *self.links.start().max(&2)..=*self.links.end().max(&2), ..self }
    }
}

/// The network of this seed and shape.
pub fn network(seed: u64, shape: &Shape) -> Network {
    let random = &mut Random::new(seed);
    let executables = random.within(shape.executables.clone()) as usize;
    let links = random.within(shape.links.clone()) as usize;
    let count = 1 + executables + links;

    let mut made_contingent = [vec![false; executables], vec![true; links]].concat();
    random.shuffle(&mut made_contingent);

    // Events by order of making, the origin first; `number` shuffles their ids. All have a nominal time.
    let mut number: Vec<u32> = (0..count as u32).collect();
    random.shuffle(&mut number);
    let id = |index: usize| EventId(number[index]);
    let named = |text: String| Event { names: [Name { text, internal: false }].into() };
    let mut events = vec![named("z".to_string()); count];
    let mut nominal = vec![0];
    let (mut free, mut contingent) = (vec![0], Vec::new());
    let (mut requirements, mut contingents) = (Vec::new(), Vec::new());
    let mut require = |from: usize, to: usize, (lower, upper): (Option<i64>, Option<i64>)| {
        let bound = |value: Option<i64>| value.map_or(Bound::Infinite, |value| units(shape, value).into());
        requirements.push(Requirement {
            from: id(from),
            to: id(to),
            lower: bound(lower),
            upper: bound(upper),
        });
    };
    for (index, is_contingent) in (1..count).zip(made_contingent) {
        let text = if is_contingent {
            let from =
                if !contingent.is_empty() && random.percent(shape.chain) { &contingent } else { &free };
            let from = *random.choose(from);
            let lower = random.within(0..=shape.lower);
            let width = if random.percent(8) { 0 } else { random.within(1..=shape.spread) };
            nominal.push(nominal[from] + lower + random.within(0..=width));
            contingents.push(ContingentLink {
                from: id(from),
                to: id(index),
                lower: units(shape, lower),
                upper: units(shape, lower + width),
                delay: delay(random, shape),
            });
            contingent.push(index);
            format!("c{}", contingent.len())
        } else {
            if !contingent.is_empty() && random.percent(shape.follow) {
                let after = *random.choose(&contingent);
                let centre = random.within(0..=shape.lower.max(shape.delay));
                nominal.push(nominal[after] + centre);
                let (below, above) = (random.within(0..=shape.spread), random.within(0..=shape.spread));
                require(after, index, (Some(centre - below), Some(centre + above)));
            } else {
                nominal.push(random.within(0..=shape.horizon));
            }
            free.push(index);
            format!("x{}", free.len() - 1)
        };
        events[id(index).index()] = named(text);
    }

    // Some networks get tighter requirements than others, or the verdict depends on the number of requirements only.
    let slack = random.within(1..=shape.slack);
    for _ in 0..(count as i64 - 1) * random.within(shape.density.clone()) / 100 {
        let [a, b] = [50, 20].map(|chance| {
            let events = if random.percent(chance) && links > 0 { &contingent } else { &free };
            *random.choose(events)
        });
        let (a, b) = if random.percent(50) { (a, b) } else { (b, a) };
        if a != b {
            let between = interval(random, nominal[b] - nominal[a], slack);
            require(a, b, between);
        }
    }

    random.shuffle(&mut contingents);
    Network::new(format!("random {seed}"), id(0), events, requirements, contingents).expect("a valid network")
}

/// The bounds of a requirement whose nominal value is `centre`.
fn interval(random: &mut Random, centre: i64, slack: i64) -> (Option<i64>, Option<i64>) {
    let low = centre - random.within(0..=slack);
    let high = centre + random.within(0..=slack);
    match random.within(1..=100) {
        1..=15 => (Some(low), None),
        16..=32 => (None, Some(high)),
        33..=36 => (Some(centre), Some(centre)),
        37..=39 => (Some(0), Some(0)),
        // Far from nominal: often a contradiction, sometimes a detour.
        40..=43 => (Some(low + slack), Some(high + slack)),
        _ => (Some(low), Some(high)),
    }
}

/// A delay of a random kind.
fn delay(random: &mut Random, shape: &Shape) -> Delay {
    let kind = random.within(1..=100);
    let (fixed, variable) = (shape.fixed, shape.fixed + shape.variable);
    if kind <= fixed {
        let delay = units(shape, random.within(1..=shape.delay));
        Delay { min: delay, max: delay.into() }
    } else if kind <= variable {
        let min = random.within(0..=shape.delay);
        let max = min + random.within(1..=shape.delay);
        Delay { min: units(shape, min), max: units(shape, max).into() }
    } else if kind <= variable + shape.infinite {
        Delay { min: units(shape, random.within(0..=shape.delay)), max: Bound::Infinite }
    } else {
        Delay::NONE
    }
}

/// So many units of time.
fn units(shape: &Shape, count: i64) -> Duration {
    Duration::from_micros(count * shape.unit.as_micros())
}

/// The network with other requirements and links.
pub fn with(network: &Network, requirements: Vec<Requirement>, contingents: Vec<ContingentLink>) -> Network {
    let (name, events) = (network.name().to_string(), network.events().to_vec());
    Network::new(name, network.origin(), events, requirements, contingents).expect("a valid network")
}

/// The network with all times multiplied.
pub fn scaled(network: &Network, factor: i64) -> Network {
    let times = |duration: Duration| Duration::from_micros(duration.as_micros() * factor);
    let bound = |bound: Bound| bound.finite().map_or(Bound::Infinite, |finite| times(finite).into());
    let mut requirements = network.requirements().to_vec();
    for requirement in &mut requirements {
        (requirement.lower, requirement.upper) = (bound(requirement.lower), bound(requirement.upper));
    }
    let mut contingents = network.contingents().to_vec();
    for link in &mut contingents {
        (link.lower, link.upper) = (times(link.lower), times(link.upper));
        link.delay = Delay { min: times(link.delay.min), max: bound(link.delay.max) };
    }
    with(network, requirements, contingents)
}

/// The network with every delay replaced.
pub fn with_delays(network: &Network, delay: Delay) -> Network {
    let mut contingents = network.contingents().to_vec();
    for link in &mut contingents {
        link.delay = delay;
    }
    with(network, network.requirements().to_vec(), contingents)
}

/// The same network with its events, requirements and links in another order.
pub fn reordered(random: &mut Random, network: &Network) -> Network {
    let mut number: Vec<u32> = (0..network.events().len() as u32).collect();
    random.shuffle(&mut number);
    let id = |event: EventId| EventId(number[event.index()]);
    let mut events = network.events().to_vec();
    for event in network.event_ids() {
        events[id(event).index()] = network.events()[event.index()].clone();
    }
    let mut requirements: Vec<Requirement> = network.requirements().to_vec();
    for requirement in &mut requirements {
        (requirement.from, requirement.to) = (id(requirement.from), id(requirement.to));
    }
    let mut contingents: Vec<ContingentLink> = network.contingents().to_vec();
    for link in &mut contingents {
        (link.from, link.to) = (id(link.from), id(link.to));
    }
    random.shuffle(&mut requirements);
    random.shuffle(&mut contingents);
    Network::new(network.name().to_string(), id(network.origin()), events, requirements, contingents)
        .expect("a valid network")
}

/// A harder network: one link, delay or requirement changed so that Nature can do more, or we may do less.
pub fn harder(random: &mut Random, network: &Network, unit: Duration) -> Network {
    let mut requirements = network.requirements().to_vec();
    let mut contingents = network.contingents().to_vec();
    let plus = |duration: Duration| duration.checked_add(unit).expect("small");
    let minus = |duration: Duration| duration.checked_sub(unit).expect("small");
    let chosen = random.within(0..=contingents.len().max(1) as i64 - 1) as usize;
    let kind = random.within(0..=5);
    match (contingents.get_mut(chosen), kind) {
        (Some(link), 0) => link.upper = plus(link.upper),
        (Some(link), 1) if link.lower >= unit => link.lower = minus(link.lower),
        (Some(link), 2) => {
            link.delay.max = link.delay.max.finite().map_or(Bound::Infinite, |max| plus(max).into())
        }
        (Some(link), 3) if link.delay.min >= unit => link.delay.min = minus(link.delay.min),
        _ if requirements.is_empty() => {}
        _ => {
            let chosen = random.within(0..=requirements.len() as i64 - 1) as usize;
            let requirement = &mut requirements[chosen];
            let room = match (requirement.lower.finite(), requirement.upper.finite()) {
                (Some(lower), Some(upper)) => minus(upper) >= lower,
                _ => true,
            };
            match (requirement.lower, requirement.upper) {
                (Bound::Finite(lower), _) if room && kind == 4 => requirement.lower = plus(lower).into(),
                (_, Bound::Finite(upper)) if room => requirement.upper = minus(upper).into(),
                _ => {}
            }
        }
    }
    with(network, requirements, contingents)
}

/// The smallest network found that still fails, by leaving out parts and moving bounds towards zero.
pub fn shrunk(network: &Network, fails: impl Fn(&Network) -> bool) -> Network {
    let mut best = network.clone();
    while let Some(next) = simpler(&best).into_iter().find(|candidate| fails(candidate)) {
        best = next;
    }
    best
}

/// All networks that are one step simpler.
fn simpler(network: &Network) -> Vec<Network> {
    let mut found = Vec::new();
    let (requirements, contingents) = (network.requirements(), network.contingents());
    for index in 0..contingents.len() {
        let mut fewer = contingents.to_vec();
        fewer.remove(index);
        found.push(with(network, requirements.to_vec(), fewer));
    }
    for index in 0..requirements.len() {
        let mut fewer = requirements.to_vec();
        fewer.remove(index);
        found.push(with(network, fewer, contingents.to_vec()));
    }
    let nearer = |duration: Duration| {
        let (micros, second) = (duration.as_micros(), Duration::from_secs(1).as_micros());
        Duration::from_micros(micros - micros.signum() * micros.abs().min(second))
    };
    let nearer_bound = |bound: Bound| bound.finite().map_or(Bound::Infinite, |finite| nearer(finite).into());
    for (index, requirement) in requirements.iter().enumerate() {
        let (lower, upper) = (nearer_bound(requirement.lower), nearer_bound(requirement.upper));
        for candidate in [
            Requirement { lower: Bound::Infinite, ..*requirement },
            Requirement { upper: Bound::Infinite, ..*requirement },
            Requirement { lower, upper, ..*requirement },
            Requirement { lower, ..*requirement },
            Requirement { upper, ..*requirement },
        ] {
            let ordered = match (candidate.lower.finite(), candidate.upper.finite()) {
                (Some(lower), Some(upper)) => lower <= upper,
                (None, None) => false,
                _ => true,
            };
            if ordered && candidate != *requirement {
                let mut changed = requirements.to_vec();
                changed[index] = candidate;
                found.push(with(network, changed, contingents.to_vec()));
            }
        }
    }
    for (index, link) in contingents.iter().enumerate() {
        let Delay { min, max } = link.delay;
        let (lower, upper) = (nearer(link.lower), nearer(link.upper));
        for candidate in [
            ContingentLink { delay: Delay::NONE, ..*link },
            ContingentLink { from: network.origin(), ..*link },
            ContingentLink { lower, upper, ..*link },
            ContingentLink { upper: upper.max(link.lower), ..*link },
            ContingentLink { delay: Delay { min: nearer(min), max: nearer_bound(max) }, ..*link },
            ContingentLink {
                delay: Delay { min, max: max.finite().map_or(max, |max| nearer(max).max(min).into()) },
                ..*link
            },
        ] {
            if candidate != *link {
                let mut changed = contingents.to_vec();
                changed[index] = candidate;
                found.push(with(network, requirements.to_vec(), changed));
            }
        }
    }
    found
}

/// The network in a few readable lines, for failure messages; events no constraint names are left out.
pub fn describe(network: &Network) -> String {
    let mut text = format!("{}, origin {}", network.name(), network.id(network.origin()));
    let bound = |bound: Bound| bound.finite().map_or("inf".to_string(), |finite| finite.to_string());
    for link in network.contingents() {
        let (from, to) = (network.id(link.from), network.id(link.to));
        write!(text, "\n  {from} =[{},{}]=> {to}", link.lower, link.upper).expect("text");
        if link.delay != Delay::NONE {
            write!(text, " delay [{},{}]", link.delay.min, bound(link.delay.max)).expect("text");
        }
    }
    for requirement in network.requirements() {
        let (from, to) = (network.id(requirement.from), network.id(requirement.to));
        let lower = requirement.lower.finite().map_or("-inf".to_string(), |finite| finite.to_string());
        write!(text, "\n  {from} -[{lower},{}]-> {to}", bound(requirement.upper)).expect("text");
    }
    text
}
