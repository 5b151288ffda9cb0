//! What can still happen in the middle of a game: all that both sides together can bring about while we lose nothing that is won.

use std::collections::{BTreeMap, HashSet};

use kirk_network::left::{Seen, SoFar};
use kirk_network::time::Interval;
use kirk_network::{EventId, Network, Time};

use super::super::random::Random;
use super::{Fate, Game, MOST, NEVER, Prospect, Rules, members, parts, step, waited};

/// A game that is won, in the middle of it.
pub struct Middle {
    game: Game,
    /// What the numbers of roots stand for, and for each link the number of its root.
    pub roots: Vec<EventId>,
    root_of: Vec<usize>,
    /// A step in microseconds.
    pub step: i64,
    pub time: i16,
    left: u8,
    prospects: Vec<Prospect>,
    executed: [Option<i16>; MOST],
    heard: [Option<i16>; MOST],
    /// What was done, or nothing, and the news that came then.
    moves: Vec<(Option<usize>, u8)>,
}

/// When a root can be executed: the first and the last step.
pub type Reach = BTreeMap<EventId, (i16, i16)>;

impl Middle {
    /// The origin has been executed; `None` if the game is lost.
    pub fn start(network: &Network, random: &mut Random) -> Option<Middle> {
        let mut game = Game::new(network, &Rules { steps: 1, late_news: Vec::new() })?;
        if !game.play() {
            return None;
        }
        let ours = network.event_ids().filter(|&e| e != network.origin() && network.link_of(e).is_none());
        let roots: Vec<EventId> = std::iter::once(network.origin()).chain(ours).collect();
        let root_of = network.contingents().iter().map(|link| {
            let mut at = link.from;
            while let Some(above) = network.link_of(at) {
                at = network.contingents()[above].from;
            }
            roots.iter().position(|&root| root == at).expect("a root")
        });
        let root_of = root_of.collect();
        let start = at_first(&game);
        let mut middle = Middle {
            left: game.roots,
            game,
            roots,
            root_of,
            step: step(network),
            time: 0,
            prospects: vec![start],
            executed: [None; MOST],
            heard: [None; MOST],
            moves: Vec::new(),
        };
        middle.execute(0, random);
        Some(middle)
    }

    fn execute(&mut self, root: usize, random: &mut Random) {
        let outcomes = self.game.executed(root, self.left, &self.prospects);
        self.left &= !(1 << root);
        self.executed[root] = Some(self.time);
        self.happens(Some(root), outcomes, random);
    }

    /// Some news arrives, or none.
    fn happens(&mut self, done: Option<usize>, outcomes: Vec<(u8, Prospect)>, random: &mut Random) {
        let parts: Vec<(u8, Vec<Prospect>)> = parts(self.left, outcomes).into_iter().collect();
        let (arrived, prospects) = random.choose(&parts).clone();
        for link in members(arrived) {
            self.heard[link] = Some(self.time);
        }
        self.prospects = prospects;
        self.moves.push((done, arrived));
    }

    /// True if all is won as well, with the next step to come, if the same has happened under these requirements.
    pub fn is_won_under(&self, network: &Network) -> bool {
        let rules = Rules { steps: step(network) / self.step, late_news: Vec::new() };
        let Some(mut game) = Game::new(network, &rules) else { return false };
        let (mut left, mut prospects) = (game.roots, vec![at_first(&game)]);
        for &(done, arrived) in &self.moves {
            let outcomes = match done {
                Some(root) => game.executed(root, left, &prospects),
                None => waited(left, &prospects),
            };
            left &= !done.map_or(0, |root| 1 << root);
            prospects = parts(left, outcomes).remove(&arrived).expect("the same can happen");
        }
        game.win_all(left, waited(left, &prospects))
    }

    /// A move that loses nothing.
    pub fn go_on(&mut self, random: &mut Random) {
        let mut able = self.able(self.left, &self.prospects.clone());
        random.shuffle(&mut able);
        let may_wait = self.may_wait(self.left, &self.prospects.clone());
        match able.first() {
            Some(&root) if !may_wait || random.percent(40) => self.execute(root, random),
            _ => {
                self.time += 1;
                self.happens(None, waited(self.left, &self.prospects), random);
            }
        }
    }

    /// Does what must be done at once, so that time may pass.
    pub fn pause(&mut self, random: &mut Random) {
        while !self.may_wait(self.left, &self.prospects.clone()) {
            self.go_on(random);
        }
    }

    /// The next step, at which what is to be known and done is not yet known and done.
    fn now(&self) -> i16 {
        self.time + 1
    }

    /// The roots that can be executed now without losing.
    fn able(&mut self, left: u8, prospects: &[Prospect]) -> Vec<usize> {
        let allowed = |root: &usize| prospects.iter().all(|prospect| prospect.low[*root] == 0);
        let allowed: Vec<usize> = members(left).filter(allowed).collect();
        allowed.into_iter().filter(|&root| self.game.execute(root, left, prospects)).collect()
    }

    /// True if nothing is lost by waiting, as long as one likes.
    fn may_wait(&mut self, left: u8, prospects: &[Prospect]) -> bool {
        let too_late = |prospect: &Prospect| members(left).any(|root| prospect.high[root] == 0);
        !prospects.iter().any(too_late) && self.game.win_all(left, waited(left, prospects))
    }

    /// When each root that is to come can be executed from the next step on, up to a step. `None` if there are too many ways. Time may pass.
    pub fn reachable(&mut self, horizon: i16) -> Option<Reach> {
        const MOST_POSITIONS: usize = 20_000;
        let mut reach = Reach::new();
        let mut seen = HashSet::new();
        let next = parts(self.left, waited(self.left, &self.prospects));
        let mut open: Vec<_> =
            next.into_values().map(|prospects| (self.now(), self.left, prospects)).collect();
        while let Some((time, left, prospects)) = open.pop() {
            if !seen.insert((time, left, prospects.clone())) {
                continue;
            }
            if seen.len() > MOST_POSITIONS {
                return None;
            }
            for root in self.able(left, &prospects) {
                let (first, last) = reach.entry(self.roots[root]).or_insert((time, time));
                (*first, *last) = ((*first).min(time), (*last).max(time));
                let outcomes = self.game.executed(root, left, &prospects);
                let left = left & !(1 << root);
                open.extend(parts(left, outcomes).into_values().map(|prospects| (time, left, prospects)));
            }
            if time < horizon && left != 0 && self.may_wait(left, &prospects) {
                let outcomes = waited(left, &prospects);
                open.extend(parts(left, outcomes).into_values().map(|prospects| (time + 1, left, prospects)));
            }
        }
        Some(reach)
    }

    /// What is known of every event when the next step comes: of Nature's, all that agrees with the news up to then.
    pub fn so_far(&self, network: &Network) -> SoFar {
        let time = |steps: i16| Time::from_micros(i64::from(steps) * self.step);
        let agrees = |fate: &&Fate, root: usize, start: i16| {
            (0..self.root_of.len()).filter(|&link| self.root_of[link] == root).all(|link| {
                match self.heard[link] {
                    Some(heard) => fate.news[link] != NEVER && start + fate.news[link] == heard,
                    None => fate.news[link] == NEVER || start + fate.news[link] > self.time,
                }
            })
        };
        let settled = |event: EventId| {
            (0..self.root_of.len()).filter(|&link| self.heard[link].is_some()).any(|link| {
                let mut at = network.contingents()[link].to;
                while at != event
                    && let Some(above) = network.link_of(at)
                {
                    at = network.contingents()[above].from;
                }
                at == event
            })
        };
        let seen = |event: EventId| {
            let Some(link) = network.link_of(event) else {
                let number = self.roots.iter().position(|&root| root == event).expect("a root");
                return self.executed[number].map_or(Seen::ToCome, |at| Seen::Executed(time(at)));
            };
            let root = self.root_of[link];
            let Some(start) = self.executed[root] else { return Seen::ToCome };
            let fates = self.game.fates[root].iter().filter(|fate| agrees(fate, root, start));
            let ends: Vec<i16> = fates.map(|fate| start + fate.offset[link]).collect();
            let happened = Interval::new(
                time(*ends.iter().min().expect("a fate")),
                time(*ends.iter().max().expect("a fate")),
            );
            Seen::Nature { happened, heard: self.heard[link].is_some(), settled: settled(event) }
        };
        SoFar { now: time(self.now()), events: network.event_ids().map(seen).collect() }
    }
}

/// Before anything has happened.
fn at_first(game: &Game) -> Prospect {
    let mut start = Prospect { news: [NEVER; MOST], low: [0; MOST], high: [0; MOST] };
    for root in members(game.roots & !1) {
        start.high[root] = NEVER;
    }
    start
}
