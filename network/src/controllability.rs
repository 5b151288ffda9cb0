//! Dynamic controllability of a plain STNU: algorithm RUL2021.
//!
//! L. Hunsberger, R. Posenato, *Speeding up the RUL- dynamic-controllability-checking algorithm for simple temporal
//! networks with uncertainty*, AAAI 2022. In short: a network is controllable iff no semi-reducible cycle is negative.
//! Bellman-Ford over ordinary and lower-case edges gives potentials (or such a cycle). Then, for each link (A, x, y, C),
//! Dijkstra backwards from C: what comes within `y - x` of C must be able to wait for it, what is farther away gets an
//! edge to A and needs to know nothing of C.
//!
//! Here a link is begun anew when its search meets the activation of a link that has to be done first. That keeps one
//! set of arrays instead of one per suspended search; every link causes at most one new beginning, so it costs a
//! factor of two at worst.

use crate::heap::Heap;
use crate::stnu::{Edge, NONE, Rows, Stnu, TooLarge, add};

/// One step along an edge of a cycle; the numbers are indices into [`Stnu::edges`] and [`Stnu::links`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// An ordinary edge.
    Edge(u32),
    /// From the activation to the contingent event, when Nature takes the least.
    Lower(u32),
    /// From the contingent event to the activation, when Nature takes the most.
    Upper(u32),
}

/// A semi-reducible negative cycle: how often it takes each step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The steps, each once, in order, with the number of times it is taken.
    pub steps: Vec<(Step, i64)>,
}

/// `waiter` must wait for the contingent event of `link` until `-weight` after its activation, and no longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wait {
    /// The node that waits.
    pub waiter: u32,
    /// Index of the link whose contingent event it waits for.
    pub link: u32,
    /// `activation - waiter <= weight` unless the contingent event has happened; `weight < -lower`.
    pub weight: i64,
}

/// What a successful check has found out, the raw material of the dispatchable network.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Edges implied by the links, from anywhere to an activation.
    pub(crate) derived: Vec<Edge>,
    /// The waits.
    pub(crate) waits: Vec<Wait>,
    /// For each node a number such that `potential(from) <= weight + potential(to)` on every ordinary, lower-case
    /// and derived edge.
    pub(crate) potential: Vec<i64>,
}

/// Is the network dynamically controllable?
pub fn is_controllable(stnu: &Stnu) -> Result<bool, TooLarge> {
    Ok(Search::new(stnu, false).run()?.is_none())
}

/// A semi-reducible negative cycle, `None` if the network is controllable. The same one on every run.
pub fn negative_cycle(stnu: &Stnu) -> Result<Option<Cycle>, TooLarge> {
    let mut search = Search::new(stnu, true);
    Ok(match search.run()? {
        None => None,
        Some(cycle) => Some(search.count(cycle)?),
    })
}

/// The derived edges, waits and potentials of a controllable network, `None` if it is not controllable.
pub(crate) fn solve(stnu: &Stnu) -> Result<Option<Solution>, TooLarge> {
    let mut search = Search::new(stnu, false);
    Ok(match search.run()? {
        None => {
            let derived = search.edges.split_off(search.derived_from);
            Some(Solution { derived, waits: search.waits, potential: search.potential })
        }
        Some(_) => None,
    })
}

/// An edge by number: ordinary edges first, then one lower-case edge per link, then derived edges.
type EdgeId = u32;

/// One step of a cycle before derived edges are expanded.
#[derive(Clone, Copy)]
enum Move {
    Along(EdgeId),
    Upper(u32),
}

enum Found {
    Done,
    /// This link must be done first; its activation is reached from the link in progress.
    DoFirst(u32),
    Cycle(Vec<Move>),
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Untouched,
    InProgress,
    Done,
}

struct Search<'a> {
    stnu: &'a Stnu,
    /// Ordinary, lower-case and derived edges.
    edges: Vec<Edge>,
    lower_from: usize,
    derived_from: usize,
    incoming: Rows,
    outgoing: Rows,
    /// Derived edges as linked lists: the last one into and out of each node, and the one before each.
    derived_in: Vec<EdgeId>,
    derived_out: Vec<EdgeId>,
    before_in: Vec<EdgeId>,
    before_out: Vec<EdgeId>,
    /// The link ending at, and the links starting at each node.
    ending: Vec<u32>,
    starting: Rows,
    state: Vec<State>,
    potential: Vec<i64>,
    heap: Heap,
    /// The backward search: best known distance to C, valid where `stamp` is current, and the edge it goes by.
    distance: Vec<i64>,
    via: Vec<EdgeId>,
    stamp: Vec<u32>,
    expanded: Vec<u32>,
    round: u32,
    reached: Vec<u32>,
    waits: Vec<Wait>,
    /// Kept only if asked for: how each derived edge came about, and how links in progress led to one another.
    recording: bool,
    derivations: Vec<Vec<Move>>,
}

impl<'a> Search<'a> {
    fn new(stnu: &'a Stnu, recording: bool) -> Search<'a> {
        let nodes = stnu.nodes as usize;
        let mut edges = stnu.edges.clone();
        let lower_from = edges.len();
        edges.extend(stnu.links.iter().map(|l| Edge {
            from: l.activation,
            to: l.contingent,
            weight: l.lower,
        }));
        Search {
            stnu,
            lower_from,
            derived_from: edges.len(),
            edges,
            incoming: Rows::new(stnu.nodes, stnu.edges.iter().map(|e| e.to)),
            outgoing: Rows::new(stnu.nodes, stnu.edges.iter().map(|e| e.from)),
            derived_in: vec![NONE; nodes],
            derived_out: vec![NONE; nodes],
            before_in: Vec::new(),
            before_out: Vec::new(),
            ending: stnu.link_ending_at(),
            starting: Rows::new(stnu.nodes, stnu.links.iter().map(|l| l.activation)),
            state: vec![State::Untouched; stnu.links.len()],
            potential: vec![0; nodes],
            heap: Heap::new(stnu.nodes),
            distance: vec![0; nodes],
            via: vec![NONE; nodes],
            stamp: vec![0; nodes],
            expanded: vec![0; nodes],
            round: 0,
            reached: Vec::new(),
            waits: Vec::new(),
            recording,
            derivations: Vec::new(),
        }
    }

    fn run(&mut self) -> Result<Option<Vec<Move>>, TooLarge> {
        if let Some(cycle) = self.initial_potential()? {
            return Ok(Some(cycle));
        }
        // Late links first: then the links a search meets are usually done.
        let mut order: Vec<u32> = (0..self.stnu.links.len() as u32).collect();
        order.sort_by_key(|&link| (self.potential[self.stnu.links[link as usize].activation as usize], link));
        // Links in progress, each with the way from the activation of the next one to its own contingent event.
        let mut progress: Vec<(u32, Vec<Move>)> = Vec::new();
        for first in order {
            if self.state[first as usize] == State::Untouched {
                self.state[first as usize] = State::InProgress;
                progress.push((first, Vec::new()));
            }
            while let Some(&(link, _)) = progress.last() {
                match self.propagate(link)? {
                    Found::Done => {
                        self.state[link as usize] = State::Done;
                        progress.pop();
                    }
                    Found::DoFirst(next) if self.state[next as usize] == State::InProgress => {
                        return Ok(Some(self.close_cycle(&progress, next)));
                    }
                    Found::DoFirst(next) => {
                        let way = self.way_to_contingent(self.stnu.links[next as usize].activation, link);
                        if let Some(last) = progress.last_mut() {
                            last.1 = way;
                        }
                        self.state[next as usize] = State::InProgress;
                        progress.push((next, Vec::new()));
                    }
                    Found::Cycle(cycle) => return Ok(Some(cycle)),
                }
            }
        }
        Ok(None)
    }

    /// Potentials over ordinary and lower-case edges, or a negative cycle of them.
    ///
    /// Bellman-Ford in rounds over the nodes that changed; after each round the tree of last improvements is searched
    /// for a cycle, so a negative one is found about as soon as it exists.
    fn initial_potential(&mut self) -> Result<Option<Vec<Move>>, TooLarge> {
        let nodes = self.stnu.nodes;
        let mut changed: Vec<u32> = (0..nodes).rev().collect();
        let mut queued = vec![false; nodes as usize];
        let mut next = Vec::new();
        while !changed.is_empty() {
            for &to in &changed {
                queued[to as usize] = false;
                let potential = self.potential[to as usize];
                let lower = self.lower_into(to);
                for &edge in self.incoming.of(to).iter().chain(lower.as_slice()) {
                    let Edge { from, weight, .. } = self.edges[edge as usize];
                    let candidate = add(weight, potential)?;
                    if candidate < self.potential[from as usize] {
                        self.potential[from as usize] = candidate;
                        self.via[from as usize] = edge;
                        if !std::mem::replace(&mut queued[from as usize], true) {
                            next.push(from);
                        }
                    }
                }
            }
            if let Some(cycle) = self.cycle_of_improvements() {
                return Ok(Some(cycle));
            }
            changed.clear();
            std::mem::swap(&mut changed, &mut next);
        }
        Ok(None)
    }

    fn cycle_of_improvements(&self) -> Option<Vec<Move>> {
        let nodes = self.stnu.nodes as usize;
        let mut walk_of = vec![NONE; nodes];
        for start in 0..nodes as u32 {
            let mut node = start;
            while walk_of[node as usize] == NONE && self.via[node as usize] != NONE {
                walk_of[node as usize] = start;
                node = self.edges[self.via[node as usize] as usize].to;
            }
            if walk_of[node as usize] == start && self.via[node as usize] != NONE {
                return Some(self.walk(node, node, &self.via));
            }
        }
        None
    }

    /// The edges from `node` along `via` up to `end` (at least one edge).
    fn walk(&self, mut node: u32, end: u32, via: &[EdgeId]) -> Vec<Move> {
        let mut moves = Vec::new();
        loop {
            let edge = via[node as usize];
            moves.push(Move::Along(edge));
            node = self.edges[edge as usize].to;
            if node == end {
                return moves;
            }
        }
    }

    /// The number of the lower-case edge into `node`, if it is contingent.
    #[inline]
    fn lower_into(&self, node: u32) -> Option<EdgeId> {
        let link = self.ending[node as usize];
        (link != NONE).then(|| self.lower_from as u32 + link)
    }

    /// The backward search from the contingent event of one link.
    fn propagate(&mut self, link: u32) -> Result<Found, TooLarge> {
        let here = self.stnu.links[link as usize];
        let width = here.upper - here.lower;
        self.round += 1;
        self.heap.clear();
        self.reached.clear();
        let source = here.contingent;
        let mut loops_back = false;
        self.reach(source, 0, NONE);
        self.heap.push(source, 0);
        while let Some((_, node)) = self.heap.pop() {
            let distance = self.distance[node as usize];
            self.expanded[node as usize] = self.round;
            for &started in self.starting.of(node) {
                if self.state[started as usize] != State::Done {
                    return Ok(Found::DoFirst(started));
                }
            }
            // Out of a contingent event the search goes on by its lower-case edge alone: what else is close to it
            // has an edge to its activation, or waits for it.
            let lower = self.lower_into(node);
            let mut relax = |search: &mut Search<'a>, edge: EdgeId| -> Result<(), TooLarge> {
                let Edge { from, weight, .. } = search.edges[edge as usize];
                let candidate = add(weight, distance)?;
                if from == source {
                    loops_back |= candidate < width;
                } else if search.stamp[from as usize] != search.round
                    || candidate < search.distance[from as usize]
                {
                    search.reach(from, candidate, edge);
                    if candidate < width {
                        // Reduced by the potentials, every edge is non-negative; see `Solution::potential`.
                        search.heap.push(from, add(candidate, -search.potential[from as usize])?);
                    }
                }
                Ok(())
            };
            match lower {
                Some(lower) if node != source => relax(self, lower)?,
                _ => {
                    for at in 0..self.incoming.of(node).len() {
                        relax(self, self.incoming.of(node)[at])?;
                    }
                    let mut edge = self.derived_in[node as usize];
                    while edge != NONE {
                        relax(self, edge)?;
                        edge = self.before_in[edge as usize - self.derived_from];
                    }
                }
            }
        }
        if loops_back && let Some(cycle) = self.negative_from_contingent(link)? {
            return Ok(Found::Cycle(cycle));
        }
        self.derive(link)
    }

    #[inline]
    fn reach(&mut self, node: u32, distance: i64, via: EdgeId) {
        if self.stamp[node as usize] != self.round {
            self.stamp[node as usize] = self.round;
            self.reached.push(node);
        }
        self.distance[node as usize] = distance;
        self.via[node as usize] = via;
    }

    /// C lies on a cycle shorter than the width of its link. If a node on the way round comes before C, then knowing
    /// C is needed before C happens: a negative cycle.
    fn negative_from_contingent(&mut self, link: u32) -> Result<Option<Vec<Move>>, TooLarge> {
        let source = self.stnu.links[link as usize].contingent;
        let base = self.potential[source as usize];
        let mut via = vec![NONE; self.stnu.nodes as usize];
        self.heap.clear();
        self.heap.push(source, 0);
        while let Some((key, node)) = self.heap.pop() {
            // key = distance from C, reduced: distance + potential(node) - potential(C).
            let distance = key - self.potential[node as usize] + base;
            if distance < 0 {
                let mut moves: Vec<Move> = Vec::new();
                let mut at = node;
                while at != source {
                    let edge = via[at as usize];
                    moves.push(Move::Along(edge));
                    at = self.edges[edge as usize].from;
                }
                moves.push(Move::Along(self.lower_from as u32 + link));
                moves.reverse();
                moves.extend(self.way_to_contingent(node, link));
                moves.push(Move::Upper(link));
                return Ok(Some(moves));
            }
            let mut relax = |search: &mut Search<'a>, edge: EdgeId| -> Result<(), TooLarge> {
                let Edge { to, weight, .. } = search.edges[edge as usize];
                if to != source && search.expanded[to as usize] == search.round {
                    let reduced =
                        add(weight, search.potential[to as usize])? - search.potential[node as usize];
                    if search.heap.push(to, add(key, reduced)?) {
                        via[to as usize] = edge;
                    }
                }
                Ok(())
            };
            for at in 0..self.outgoing.of(node).len() {
                relax(self, self.outgoing.of(node)[at])?;
            }
            for at in 0..self.starting.of(node).len() {
                relax(self, self.lower_from as u32 + self.starting.of(node)[at])?;
            }
            let mut edge = self.derived_out[node as usize];
            while edge != NONE {
                relax(self, edge)?;
                edge = self.before_out[edge as usize - self.derived_from];
            }
        }
        Ok(None)
    }

    /// Adds what the finished search implies: an edge to the activation from every node at a distance of at least the
    /// width, a wait for every node that is closer. Then repairs the potentials.
    fn derive(&mut self, link: u32) -> Result<Found, TooLarge> {
        let here = self.stnu.links[link as usize];
        let activation = here.activation;
        self.heap.clear();
        let mut improved_by: Vec<(u32, EdgeId)> = Vec::new();
        for at in 0..self.reached.len() {
            let node = self.reached[at];
            let weight = add(self.distance[node as usize], -here.upper)?;
            if self.expanded[node as usize] == self.round {
                if node != here.contingent && self.ending[node as usize] == NONE {
                    self.waits.push(Wait { waiter: node, link, weight });
                }
                continue;
            }
            if node == activation {
                if weight < 0 {
                    let mut cycle = self.way_to_contingent(node, link);
                    cycle.push(Move::Upper(link));
                    return Ok(Found::Cycle(cycle));
                }
                continue;
            }
            if self.recording {
                let mut derivation = self.way_to_contingent(node, link);
                derivation.push(Move::Upper(link));
                self.derivations.push(derivation);
            }
            let edge = self.edges.len() as u32;
            self.edges.push(Edge { from: node, to: activation, weight });
            self.before_in.push(std::mem::replace(&mut self.derived_in[activation as usize], edge));
            self.before_out.push(std::mem::replace(&mut self.derived_out[node as usize], edge));
            let change = add(weight, self.potential[activation as usize])? - self.potential[node as usize];
            if change < 0 {
                improved_by.push((node, edge));
            }
        }
        self.repair_potential(activation, &improved_by)
    }

    /// Lowers the potentials until they fit the new edges into `activation`; a negative cycle if that never ends.
    ///
    /// Largest change first, every node changes once: S. Cotton, O. Maler, *Fast and flexible difference constraint
    /// propagation for DPLL(T)*, 2006.
    fn repair_potential(&mut self, activation: u32, new: &[(u32, EdgeId)]) -> Result<Found, TooLarge> {
        for &(node, edge) in new {
            let change = self.edges[edge as usize].weight + self.potential[activation as usize]
                - self.potential[node as usize];
            if self.heap.push(node, change) {
                self.via[node as usize] = edge;
            }
        }
        while let Some((change, node)) = self.heap.pop() {
            self.potential[node as usize] = add(self.potential[node as usize], change)?;
            let potential = self.potential[node as usize];
            let mut closes = None;
            let mut relax = |search: &mut Search<'a>, edge: EdgeId| -> Result<(), TooLarge> {
                let Edge { from, weight, .. } = search.edges[edge as usize];
                let change = add(weight, potential)? - search.potential[from as usize];
                if change < 0 {
                    if from == activation {
                        closes = Some(edge);
                    } else if search.heap.push(from, change) {
                        search.via[from as usize] = edge;
                    }
                }
                Ok(())
            };
            for at in 0..self.incoming.of(node).len() {
                relax(self, self.incoming.of(node)[at])?;
            }
            if let Some(lower) = self.lower_into(node) {
                relax(self, lower)?;
            }
            let mut edge = self.derived_in[node as usize];
            while edge != NONE {
                relax(self, edge)?;
                edge = self.before_in[edge as usize - self.derived_from];
            }
            if let Some(edge) = closes {
                let mut cycle = vec![Move::Along(edge)];
                cycle.extend(self.walk(node, activation, &self.via));
                return Ok(Found::Cycle(cycle));
            }
        }
        Ok(Found::Done)
    }

    /// The way of the last backward search from `node` to the contingent event of `link`.
    fn way_to_contingent(&self, node: u32, link: u32) -> Vec<Move> {
        if !self.recording {
            return Vec::new();
        }
        let end = self.stnu.links[link as usize].contingent;
        if node == end { Vec::new() } else { self.walk(node, end, &self.via) }
    }

    /// The search of the last link in progress has come back to the activation of an earlier one.
    fn close_cycle(&self, progress: &[(u32, Vec<Move>)], again: u32) -> Vec<Move> {
        let mut cycle = Vec::new();
        let Some(&(last, _)) = progress.last() else { return cycle };
        cycle.extend(self.way_to_contingent(self.stnu.links[again as usize].activation, last));
        cycle.push(Move::Upper(last));
        for (link, way) in progress.iter().rev().skip(1) {
            if self.state_is_before(progress, *link, again) {
                break;
            }
            cycle.extend(way);
            cycle.push(Move::Upper(*link));
        }
        cycle
    }

    fn state_is_before(&self, progress: &[(u32, Vec<Move>)], link: u32, again: u32) -> bool {
        let position = |wanted: u32| progress.iter().position(|&(link, _)| link == wanted);
        position(link) < position(again)
    }

    /// Expands derived edges into what they are made of and counts the steps.
    fn count(&self, cycle: Vec<Move>) -> Result<Cycle, TooLarge> {
        let mut edges = vec![0_i64; self.edges.len()];
        let mut uppers = vec![0_i64; self.stnu.links.len()];
        let mut tally = |moves: &[Move], times: i64, edges: &mut [i64]| -> Result<(), TooLarge> {
            for &step in moves {
                let count = match step {
                    Move::Along(edge) => &mut edges[edge as usize],
                    Move::Upper(link) => &mut uppers[link as usize],
                };
                *count = add(*count, times)?;
            }
            Ok(())
        };
        tally(&cycle, 1, &mut edges)?;
        // A derived edge is made of older ones.
        for edge in (self.derived_from..self.edges.len()).rev() {
            let times = edges[edge];
            if times > 0 {
                tally(&self.derivations[edge - self.derived_from], times, &mut edges)?;
            }
        }
        let lower_from = self.lower_from;
        let mut steps = Vec::new();
        for (edge, &times) in edges[..self.derived_from].iter().enumerate().filter(|&(_, &times)| times > 0) {
            let step = match edge.checked_sub(lower_from) {
                None => Step::Edge(edge as u32),
                Some(link) => Step::Lower(link as u32),
            };
            steps.push((step, times));
        }
        steps.extend(
            uppers
                .iter()
                .enumerate()
                .filter(|&(_, &times)| times > 0)
                .map(|(link, &times)| (Step::Upper(link as u32), times)),
        );
        Ok(Cycle { steps })
    }
}
