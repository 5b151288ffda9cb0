//! Controllability as the game it is defined by: whole steps of time, imperfect information, exhaustive search.
//!
//! **The game.** Nature secretly picks every duration and every delay. We see when news arrives, of which event, and
//! what we did ourselves; nothing else. At each instant the news due arrives, then we may execute an event, which may
//! bring more news at once (a link of length 0 heard without delay), to which we may react again, and so on until we let
//! time pass. We win if in all the cases Nature may have picked, every requirement holds between the *true* times.
//!
//! **Prospects.** What we do not know is a set of prospects: possible futures that agree with all the news so far. A
//! prospect says when the news of each started link will come, and in which window each event we have not executed must
//! be executed because of the events that already have their time. All times are relative to now. Two prospects with
//! the same news to come will never be told apart, so they become one, with the intersection of their windows.
//!
//! **Trees.** Whatever Nature picks, a contingent event is a constant after the executable event its chain of links
//! starts from, its *root*. Nature may as well pick the durations and delays of the links that hang on a root when the
//! root is executed: until then they show nowhere. So until then they are all possible, and a requirement between them
//! and the events already executed must hold for the worst of them.
//!
//! **Never.** An infinite delay is played as "the news never comes". More choices for Nature change nothing: who wins
//! when it never comes wins anyway, by not listening; who loses then loses anyway, as Nature may pick "never".
//!
//! **Whole steps.** A step is the greatest common divisor of all bounds. Halving it changes no verdict on any network
//! tried, as one would expect from shortest paths, whose lengths are whole steps too.
//!
//! **How long to wait.** When no news is to come and no window opens later than now, waiting is pointless: all moves of a
//! strategy that waits can be made that much earlier, which keeps every distance between them and every lower bound.

pub mod reach;

use std::collections::{BTreeMap, HashMap};

use kirk_network::{Bound, Duration, EventId, Network};

/// The most roots, and the most links, that can be played.
const MOST: usize = 8;
/// No upper bound; and as a time of news: none will come (the link has not started, or is never heard).
const NEVER: i16 = i16::MAX;

/// What may be varied to see whether it matters (it must not).
pub struct Rules {
    /// How many steps of the game make up the greatest common divisor of all bounds.
    pub steps: i64,
    /// Finite delays, in steps above the least, that Nature may also pick where the delay is infinite.
    pub late_news: Vec<i16>,
}

/// True if there is a strategy that satisfies all requirements whatever Nature picks.
///
/// A step of the game is the greatest common divisor of all bounds. Keep networks tiny: half a dozen events, bounds of
/// up to half a dozen steps.
pub fn controllable(network: &Network) -> bool {
    controllable_under(network, &Rules { steps: 1, late_news: Vec::new() })
}

/// [`controllable`] in finer steps, or with late news from links with an infinite delay.
pub fn controllable_under(network: &Network, rules: &Rules) -> bool {
    match Game::new(network, rules) {
        None => false,
        Some(mut game) => game.play(),
    }
}

/// An event: its root, and the link it ends if it is not the root itself.
#[derive(Clone, Copy)]
struct Place {
    root: usize,
    link: Option<usize>,
}

/// `to - from <= weight`.
struct Edge {
    from: Place,
    to: Place,
    weight: i16,
}

/// One way Nature may pick for all links of a tree; entries of other links are 0 and [`NEVER`].
struct Fate {
    /// True time of the end of each link after the root.
    offset: [i16; MOST],
    /// When news of it arrives after the root is executed.
    news: [i16; MOST],
}

/// One possible future, see the top of the file. `low` and `high` of executed roots are 0.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Prospect {
    /// Steps until the news of each link comes; 0 once it has come.
    news: [i16; MOST],
    /// Earliest step from now at which each root may be executed.
    low: [i16; MOST],
    /// Latest step from now.
    high: [i16; MOST],
}

struct Game {
    /// Requirements between different trees.
    edges: Vec<Edge>,
    /// All ways Nature may pick, by root. Root 0 is the origin.
    fates: Vec<Vec<Fate>>,
    /// By root and root: what `to - from` never exceeds in any case, if anything.
    loosest: [[i16; MOST]; MOST],
    /// The set of roots (as bits) that matter at all.
    roots: u8,
    /// Positions already judged: roots to execute, prospects.
    judged: HashMap<(u8, Vec<Prospect>), bool>,
}

impl Game {
    /// Sets the game up; `None` if Nature wins without a move of ours, by a requirement within one tree.
    fn new(network: &Network, rules: &Rules) -> Option<Game> {
        let step = step(network) / rules.steps;
        assert!(step * rules.steps > 0 && step > 0, "a step of the game would be less than a microsecond");
        let steps = |duration: Duration| {
            assert_eq!(duration.as_micros() % step, 0);
            i16::try_from(duration.as_micros() / step).ok().filter(|&n| n.abs() < 3000).expect("small bounds")
        };

        let mut root_number = vec![None; network.events().len()];
        root_number[network.origin().index()] = Some(0);
        let mut count = 1;
        for event in network.event_ids() {
            if event != network.origin() && network.link_of(event).is_none() {
                root_number[event.index()] = Some(count);
                count += 1;
            }
        }
        assert!(count <= MOST && network.contingents().len() <= MOST, "too large to be played");
        let place = |event: EventId| {
            let mut first = event;
            while let Some(link) = network.link_of(first) {
                first = network.contingents()[link].from;
            }
            Place { root: root_number[first.index()].expect("a root"), link: network.link_of(event) }
        };

        let mut edges = Vec::new();
        for requirement in network.requirements() {
            let (from, to) = (place(requirement.from), place(requirement.to));
            if let Bound::Finite(upper) = requirement.upper {
                edges.push(Edge { from, to, weight: steps(upper) });
            }
            if let Bound::Finite(lower) = requirement.lower {
                edges.push(Edge { from: to, to: from, weight: -steps(lower) });
            }
        }

        // Parents before children, so that the offset of the parent is there to add to.
        let mut order: Vec<usize> = Vec::new();
        while order.len() < network.contingents().len() {
            for (index, link) in network.contingents().iter().enumerate() {
                let ready = network.link_of(link.from).is_none_or(|parent| order.contains(&parent));
                if ready && !order.contains(&index) {
                    order.push(index);
                }
            }
        }
        let mut fates: Vec<Vec<Fate>> =
            (0..count).map(|_| vec![Fate { offset: [0; MOST], news: [NEVER; MOST] }]).collect();
        for index in order {
            let link = &network.contingents()[index];
            let parent = place(link.from);
            let least = steps(link.delay.min);
            let mut delays: Vec<Option<i16>> = match link.delay.max {
                Bound::Finite(most) => (least..=steps(most)).map(Some).collect(),
                Bound::Infinite => rules.late_news.iter().map(|&more| Some(least + more)).collect(),
            };
            if link.delay.max == Bound::Infinite {
                delays.push(None);
            }
            let mut longer = Vec::new();
            for fate in &fates[parent.root] {
                for duration in steps(link.lower)..=steps(link.upper) {
                    for &delay in &delays {
                        let (mut offset, mut news) = (fate.offset, fate.news);
                        offset[index] = parent.link.map_or(0, |parent| offset[parent]) + duration;
                        news[index] = delay.map_or(NEVER, |delay| offset[index] + delay);
                        longer.push(Fate { offset, news });
                    }
                }
            }
            fates[parent.root] = longer;
        }

        let (within, edges): (Vec<Edge>, Vec<Edge>) =
            edges.into_iter().partition(|edge| edge.from.root == edge.to.root);
        for edge in within {
            let holds = |fate: &Fate| fate.offset_of(edge.to) - fate.offset_of(edge.from) <= edge.weight;
            if !fates[edge.from.root].iter().all(holds) {
                return None;
            }
        }

        // A tree no requirement joins to another may be executed at any time and tells nothing about the others.
        let mut roots = 1;
        let mut loosest = [[NEVER; MOST]; MOST];
        let mut game = Game { edges, fates, loosest, roots, judged: HashMap::new() };
        for edge in &game.edges {
            roots |= 1 << edge.from.root | 1 << edge.to.root;
            let weight = edge.weight + game.most(edge.from) - game.least(edge.to);
            let entry = &mut loosest[edge.from.root][edge.to.root];
            *entry = weight.min(*entry);
        }
        game.roots = roots;
        game.loosest = loosest;
        Some(game)
    }

    /// Starts with the origin, now.
    fn play(&mut self) -> bool {
        let mut start = Prospect { news: [NEVER; MOST], low: [0; MOST], high: [0; MOST] };
        for root in members(self.roots & !1) {
            start.high[root] = NEVER;
        }
        self.execute(0, self.roots, &[start])
    }

    /// True if we win from here, with these roots to execute and these prospects, which share all news up to now.
    fn win(&mut self, left: u8, prospects: Vec<Prospect>) -> bool {
        if left == 0 {
            return true;
        }
        let position = (left, prospects);
        if let Some(&won) = self.judged.get(&position) {
            return won;
        }
        let prospects = &position.1;
        let allowed = |root: usize| prospects.iter().all(|prospect| prospect.low[root] == 0);
        let won = members(left).any(|root| allowed(root) && self.execute(root, left, prospects))
            || self.wait(left, prospects);
        self.judged.insert(position, won);
        won
    }

    /// True if we win by executing `root` now. Its window contains now in all prospects.
    fn execute(&mut self, root: usize, left: u8, prospects: &[Prospect]) -> bool {
        let outcomes = self.executed(root, left, prospects);
        self.win_all(left & !(1 << root), outcomes)
    }

    /// What may come of executing `root` now: the set of news that arrives at once, with the prospect it belongs to.
    fn executed(&self, root: usize, left: u8, prospects: &[Prospect]) -> Vec<(u8, Prospect)> {
        let left = left & !(1 << root);
        let mut outcomes = Vec::new();
        for prospect in prospects {
            for fate in &self.fates[root] {
                let mut next = *prospect;
                (next.low[root], next.high[root]) = (0, 0);
                let mut arrived = 0_u8;
                for (link, &news) in fate.news.iter().enumerate() {
                    if news != NEVER {
                        next.news[link] = news;
                        arrived |= u8::from(news == 0) << link;
                    }
                }
                for edge in &self.edges {
                    if edge.from.root == root && left >> edge.to.root & 1 == 1 {
                        let latest = edge.weight + fate.offset_of(edge.from) - self.most(edge.to);
                        next.high[edge.to.root] = next.high[edge.to.root].min(latest);
                    }
                    if edge.to.root == root && left >> edge.from.root & 1 == 1 {
                        let earliest = fate.offset_of(edge.to) - self.least(edge.from) - edge.weight;
                        next.low[edge.from.root] = next.low[edge.from.root].max(earliest);
                    }
                }
                outcomes.push((arrived, next));
            }
        }
        outcomes
    }

    /// True if we win by doing nothing until the next step.
    fn wait(&mut self, left: u8, prospects: &[Prospect]) -> bool {
        let more_to_come = |prospect: &Prospect| {
            prospect.news.iter().any(|&news| news != 0 && news != NEVER)
                || members(left).any(|root| prospect.low[root] > 0)
        };
        let too_late = |prospect: &Prospect| members(left).any(|root| prospect.high[root] == 0);
        if prospects.iter().any(too_late) || !prospects.iter().any(more_to_come) {
            return false;
        }
        self.win_all(left, waited(left, prospects))
    }

    /// True if we win whichever news arrives. `outcomes`: the set of news that arrives, with the prospect it belongs to.
    fn win_all(&mut self, left: u8, outcomes: Vec<(u8, Prospect)>) -> bool {
        let mut positions = Vec::new();
        for prospects in parts(left, outcomes).into_values() {
            if !prospects.iter().all(|prospect| self.possible(left, prospect)) {
                return false;
            }
            positions.push(prospects);
        }
        // Little uncertainty is judged quickly; and one lost part is enough.
        positions.sort_by_key(Vec::len);
        positions.into_iter().all(|prospects| self.win(left, prospects))
    }

    /// False if the windows contradict what must hold between the roots left in any case, that is, if we have lost.
    fn possible(&self, left: u8, prospect: &Prospect) -> bool {
        let mut prospect = *prospect;
        for _ in 0..=MOST {
            let mut changed = false;
            for from in members(left) {
                for to in members(left) {
                    let weight = self.loosest[from][to];
                    if weight == NEVER {
                        continue;
                    }
                    if prospect.high[from] != NEVER && prospect.high[from] + weight < prospect.high[to] {
                        prospect.high[to] = prospect.high[from] + weight;
                        changed = true;
                    }
                    if prospect.low[to] - weight > prospect.low[from] {
                        prospect.low[from] = prospect.low[to] - weight;
                        changed = true;
                    }
                }
            }
            if members(left).any(|root| prospect.low[root] > prospect.high[root]) {
                return false;
            }
            if !changed {
                return true;
            }
        }
        false // Still changing after as many rounds as there are roots: a negative cycle.
    }

    /// The latest an event can be after its root.
    fn most(&self, place: Place) -> i16 {
        self.fates[place.root].iter().map(|fate| fate.offset_of(place)).max().expect("a fate")
    }

    /// The earliest an event can be after its root.
    fn least(&self, place: Place) -> i16 {
        self.fates[place.root].iter().map(|fate| fate.offset_of(place)).min().expect("a fate")
    }
}

impl Fate {
    /// True time of an event of this tree after its root.
    fn offset_of(&self, place: Place) -> i16 {
        place.link.map_or(0, |link| self.offset[link])
    }
}

/// What may come of doing nothing until the next step: the set of news that arrives then, with the prospect it belongs to.
fn waited(left: u8, prospects: &[Prospect]) -> Vec<(u8, Prospect)> {
    let mut outcomes = Vec::new();
    for prospect in prospects {
        let mut next = *prospect;
        let mut arrived = 0_u8;
        for (link, news) in next.news.iter_mut().enumerate() {
            if *news != 0 && *news != NEVER {
                *news -= 1;
                arrived |= u8::from(*news == 0) << link;
            }
        }
        for root in members(left) {
            next.low[root] = (next.low[root] - 1).max(0);
            if next.high[root] != NEVER {
                next.high[root] -= 1;
            }
        }
        outcomes.push((arrived, next));
    }
    outcomes
}

/// The prospects that remain with each set of news that may arrive.
fn parts(left: u8, outcomes: Vec<(u8, Prospect)>) -> BTreeMap<u8, Vec<Prospect>> {
    let mut parts: BTreeMap<u8, BTreeMap<[i16; MOST], Prospect>> = BTreeMap::new();
    for (arrived, prospect) in outcomes {
        let merged = parts.entry(arrived).or_default().entry(prospect.news).or_insert(prospect);
        for root in members(left) {
            merged.low[root] = merged.low[root].max(prospect.low[root]);
            merged.high[root] = merged.high[root].min(prospect.high[root]);
        }
    }
    parts.into_iter().map(|(arrived, part)| (arrived, part.into_values().collect())).collect()
}

/// The numbers in a set of bits.
fn members(set: u8) -> impl Iterator<Item = usize> {
    (0..MOST).filter(move |&bit| set >> bit & 1 == 1)
}

/// The greatest common divisor of all bounds, in microseconds; a second if all are zero.
fn step(network: &Network) -> i64 {
    let mut bounds = Vec::new();
    for requirement in network.requirements() {
        bounds.extend([requirement.lower, requirement.upper]);
    }
    for link in network.contingents() {
        bounds.extend([link.lower.into(), link.upper.into(), link.delay.min.into(), link.delay.max]);
    }
    let divisor = bounds.iter().filter_map(|bound| bound.finite()).fold(0, |divisor, duration| {
        let (mut a, mut b) = (divisor, duration.as_micros().abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    });
    if divisor == 0 { Duration::from_secs(1).as_micros() } else { divisor }
}
