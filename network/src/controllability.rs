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

mod potential;
mod record;

use crate::radix::RadixQueue;
use crate::stnu::{Edge, LIMIT, NONE, Rows, Stnu, TooLarge, within_limit};

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

/// A negative way on from a contingent event on a cycle that takes both cases of its link: the steps, counted. Without such a
/// way the lower case must not be taken, and the cycle would not be semi-reducible.
pub(crate) type Ahead = Vec<(Step, i64)>;

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
    Ok(Search::new(stnu, Purpose::Decide).run()?.is_none())
}

/// A semi-reducible negative cycle, `None` if the network is controllable. The same one on every run.
pub fn negative_cycle(stnu: &Stnu) -> Result<Option<Cycle>, TooLarge> {
    let mut search = Search::new(stnu, Purpose::Explain);
    Ok(match search.run()? {
        None => None,
        Some(cycle) => Some(Cycle { steps: search.count(&cycle)? }),
    })
}

/// The same, with what else makes the cycle a reason.
pub(crate) fn negative_cycle_ahead(stnu: &Stnu) -> Result<Option<(Cycle, Vec<Ahead>)>, TooLarge> {
    let mut search = Search::new(stnu, Purpose::Explain);
    Ok(match search.run()? {
        None => None,
        Some(cycle) => Some((Cycle { steps: search.count(&cycle)? }, search.ahead(&cycle))),
    })
}

/// The derived edges, waits and potentials of a controllable network, `None` if it is not controllable.
pub(crate) fn solve(stnu: &Stnu) -> Result<Option<Solution>, TooLarge> {
    let mut search = Search::new(stnu, Purpose::Solve);
    Ok(match search.run()? {
        None => {
            let derived = search.edges.split_off(search.derived_from);
            let potential = search.nodes.iter().map(|node| node.potential).collect();
            Some(Solution { derived, waits: search.waits, potential })
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

/// The places in `incoming` of the ordinary edges into a node.
#[inline]
fn incoming_of(incoming_at: &[u32], node: u32) -> std::ops::Range<usize> {
    incoming_at[node as usize] as usize..incoming_at[node as usize + 1] as usize
}

/// What a search is for, and so what it keeps.
#[derive(Clone, Copy, PartialEq)]
enum Purpose {
    /// Yes or no.
    Decide,
    /// A negative cycle: how each derived edge came about.
    Explain,
    /// What there is to wait for.
    Solve,
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

/// What the searches know of a node, side by side in memory.
#[derive(Clone, Copy)]
struct Node {
    /// See [`Solution::potential`].
    potential: i64,
    /// The backward search: best known distance to C and the edge it goes by, valid if `reached` is the current round.
    distance: i64,
    via: EdgeId,
    reached: u32,
    /// The round in which the search went on from here.
    expanded: u32,
    /// The link that ends here, or [`NONE`].
    ending: u32,
}

/// An ordinary edge as seen from its target.
#[derive(Clone, Copy)]
struct Incoming {
    weight: i64,
    from: u32,
    edge: EdgeId,
}

struct Search<'a> {
    stnu: &'a Stnu,
    /// Ordinary and lower-case edges, to decide also the ordinary edge that each link implies, and derived edges.
    edges: Vec<Edge>,
    lower_from: usize,
    derived_from: usize,
    /// Ordinary edges by target, in one piece; those into node v are `incoming[incoming_at[v]..incoming_at[v + 1]]`.
    incoming: Vec<Incoming>,
    incoming_at: Vec<u32>,
    outgoing: Rows,
    /// Derived edges as linked lists: the last one into and out of each node, and the one before each.
    derived_in: Vec<EdgeId>,
    derived_out: Vec<EdgeId>,
    before_in: Vec<EdgeId>,
    before_out: Vec<EdgeId>,
    starting: Rows,
    /// How many links that start at each node are not done.
    undone: Vec<u32>,
    state: Vec<State>,
    nodes: Vec<Node>,
    queue: RadixQueue,
    round: u32,
    reached: Vec<u32>,
    improved: Vec<(u32, EdgeId)>,
    waits: Vec<Wait>,
    purpose: Purpose,
    /// How each derived edge came about, to explain it.
    derivations: Vec<Vec<Move>>,
}

impl<'a> Search<'a> {
    fn new(stnu: &'a Stnu, purpose: Purpose) -> Search<'a> {
        let count = stnu.nodes as usize;
        let mut edges = stnu.edges.clone();
        let lower_from = edges.len();
        edges.extend(stnu.links.iter().map(|l| Edge {
            from: l.activation,
            to: l.contingent,
            weight: l.lower,
        }));
        if purpose == Purpose::Decide {
            // For the first potentials alone; see there.
            edges.extend(stnu.links.iter().map(|l| Edge {
                from: l.contingent,
                to: l.activation,
                weight: -l.lower,
            }));
        }
        let by_target = Rows::new(stnu.nodes, stnu.edges.iter().map(|e| e.to));
        let mut incoming = Vec::with_capacity(stnu.edges.len());
        let mut incoming_at = Vec::with_capacity(count + 1);
        for node in 0..stnu.nodes {
            incoming_at.push(incoming.len() as u32);
            incoming.extend(by_target.of(node).iter().map(|&edge| {
                let Edge { from, weight, .. } = edges[edge as usize];
                Incoming { weight, from, edge }
            }));
        }
        incoming_at.push(incoming.len() as u32);
        let mut undone = vec![0; count];
        for link in &stnu.links {
            undone[link.activation as usize] += 1;
        }
        let node = |ending| Node { potential: 0, distance: 0, via: NONE, reached: 0, expanded: 0, ending };
        Search {
            stnu,
            lower_from,
            derived_from: edges.len(),
            edges,
            incoming,
            incoming_at,
            outgoing: Rows::new(stnu.nodes, stnu.edges.iter().map(|e| e.from)),
            derived_in: vec![NONE; count],
            derived_out: vec![NONE; count],
            before_in: Vec::new(),
            before_out: Vec::new(),
            starting: Rows::new(stnu.nodes, stnu.links.iter().map(|l| l.activation)),
            undone,
            state: vec![State::Untouched; stnu.links.len()],
            nodes: stnu.link_ending_at().into_iter().map(node).collect(),
            queue: RadixQueue::new(),
            round: 0,
            reached: Vec::new(),
            improved: Vec::new(),
            waits: Vec::new(),
            purpose,
            derivations: Vec::new(),
        }
    }

    /// Does the backward search of every link, those it needs first. A cycle if the network is not controllable.
    ///
    /// What holds all the time: the potentials fit every ordinary, lower-case and derived edge (so the reduced lengths
    /// Dijkstra's algorithm works on are not negative), and a link that is done has derived all the edges to its
    /// activation that follow from it. That is why a search that comes upon an activation waits for the links that start
    /// there: it must go on by their edges too.
    fn run(&mut self) -> Result<Option<Vec<Move>>, TooLarge> {
        self.stnu.horizon()?;
        if let Some(cycle) = self.initial_potential()? {
            return Ok(Some(cycle));
        }
        // Late links first: then the links a search meets are usually done.
        let mut order: Vec<u32> = (0..self.stnu.links.len() as u32).collect();
        order.sort_by_key(|&link| (self.node(self.stnu.links[link as usize].activation).potential, link));
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
                        self.undone[self.stnu.links[link as usize].activation as usize] -= 1;
                        progress.pop();
                    }
                    // Each link in progress needs the next, and the last one needs this one: a circle of ways from an
                    // activation to a contingent event that is less than the width `y - x` away, then back to the
                    // activation of that by its upper-case edge of weight `-y`. Each piece is less than `-x <= 0`.
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

    #[inline]
    fn node(&self, node: u32) -> &Node {
        &self.nodes[node as usize]
    }

    /// The number of the lower-case edge into `node`, if it is contingent.
    #[inline]
    fn lower_into(&self, node: u32) -> Option<EdgeId> {
        let link = self.node(node).ending;
        (link != NONE).then(|| self.lower_from as u32 + link)
    }

    /// The backward search from the contingent event C of one link (A, x, y, C).
    ///
    /// A node X at a distance d from C (`C - X <= d`) has to come at `A + y - d` at the earliest as long as C has not
    /// happened: Nature may still take the most (the upper-case rule). If `d < y - x`, C may happen before that and set X
    /// free: X has to wait for C, and whatever is close to X has too, so the search goes on. If `d >= y - x`, that moment
    /// comes before C can: an edge from X to A like any other (the rule that removes labels), and the search ends there,
    /// because what leads to X leads on to A by that edge.
    ///
    /// C itself met again on the way is a cycle to be looked into when all distances are known: `loops_back`.
    fn propagate(&mut self, link: u32) -> Result<Found, TooLarge> {
        let here = self.stnu.links[link as usize];
        let width = here.upper - here.lower;
        self.round += 1;
        self.reached.clear();
        let source = here.contingent;
        let mut loops_back = false;
        let node = &mut self.nodes[source as usize];
        (node.distance, node.via, node.reached) = (0, NONE, self.round);
        let key = -node.potential;
        self.reached.push(source);
        self.queue.restart(key);
        self.queue.push(key, source);
        while let Some((_, node)) = self.queue.pop() {
            let Node { distance, expanded, ending, .. } = self.nodes[node as usize];
            if expanded == self.round {
                continue;
            }
            let distance = within_limit(distance)?;
            self.nodes[node as usize].expanded = self.round;
            if self.undone[node as usize] > 0 {
                let undone = |link: &&u32| self.state[**link as usize] != State::Done;
                if let Some(&first) = self.starting.of(node).iter().find(undone) {
                    return Ok(Found::DoFirst(first));
                }
            }
            // One step: `from` is at this distance from the source by `edge`.
            let mut relax = |from: u32, edge: EdgeId, distance: i64| {
                if from == source {
                    loops_back |= distance < width;
                    return;
                }
                let node = &mut self.nodes[from as usize];
                if node.reached == self.round {
                    if distance >= node.distance {
                        return;
                    }
                } else {
                    node.reached = self.round;
                    self.reached.push(from);
                }
                node.distance = distance;
                node.via = edge;
                if distance < width {
                    // Reduced by the potentials, every edge is non-negative; see `Solution::potential`.
                    self.queue.push(distance - node.potential, from);
                }
            };
            if ending != NONE && node != source {
                // Out of a contingent event the search goes on by its lower-case edge alone: what else is close to it
                // has an edge to its activation, or waits for it.
                let lower = self.lower_from as u32 + ending;
                let Edge { from, weight, .. } = self.edges[lower as usize];
                relax(from, lower, weight + distance);
                continue;
            }
            for &Incoming { from, edge, weight } in &self.incoming[incoming_of(&self.incoming_at, node)] {
                relax(from, edge, weight + distance);
            }
            let mut edge = self.derived_in[node as usize];
            while edge != NONE {
                let Edge { from, weight, .. } = self.edges[edge as usize];
                relax(from, edge, weight + distance);
                edge = self.before_in[edge as usize - self.derived_from];
            }
        }
        if loops_back && let Some(cycle) = self.negative_from_contingent(link) {
            return Ok(Found::Cycle(cycle));
        }
        self.derive(link)
    }

    /// C lies on a cycle shorter than the width of its link. If a node on the way round comes before C, then knowing
    /// C is needed before C happens: a negative cycle.
    ///
    /// The way on from C begins with the lower-case edge, which supposes that Nature takes the least. A path may begin
    /// so only if it comes to a node before C (P. Morris, *A structural characterization of temporal dynamic
    /// controllability*, 2006: a cycle is semi-reducible if each of its lower-case edges is followed by such a path);
    /// later the truth is known. So the search forward from C ends at the first node at a negative distance, among the
    /// nodes the backward search went on from: those are the ones that are close enough to wait for C.
    fn negative_from_contingent(&mut self, link: u32) -> Option<Vec<Move>> {
        let source = self.stnu.links[link as usize].contingent;
        let base = self.node(source).potential;
        let mut via = vec![NONE; self.nodes.len()];
        let mut done = vec![false; self.nodes.len()];
        let mut keys = vec![i64::MAX; self.nodes.len()];
        self.queue.restart(0);
        self.queue.push(0, source);
        while let Some((key, node)) = self.queue.pop() {
            if std::mem::replace(&mut done[node as usize], true) {
                continue;
            }
            // key = distance from C, reduced: distance + potential(node) - potential(C).
            let distance = key - self.node(node).potential + base;
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
                return Some(moves);
            }
            let mut relax = |search: &mut Search<'a>, edge: EdgeId| {
                let Edge { to, weight, .. } = search.edges[edge as usize];
                // From beyond the limit no way leads back: no distance is below it on the other side.
                if to != source && search.node(to).expanded == search.round && distance + weight <= LIMIT {
                    let key = key + weight + search.node(to).potential - search.node(node).potential;
                    if key < keys[to as usize] {
                        keys[to as usize] = key;
                        via[to as usize] = edge;
                        search.queue.push(key, to);
                    }
                }
            };
            for at in 0..self.outgoing.of(node).len() {
                relax(self, self.outgoing.of(node)[at]);
            }
            for at in 0..self.starting.of(node).len() {
                relax(self, self.lower_from as u32 + self.starting.of(node)[at]);
            }
            let mut edge = self.derived_out[node as usize];
            while edge != NONE {
                relax(self, edge);
                edge = self.before_out[edge as usize - self.derived_from];
            }
        }
        None
    }

    /// Adds what the finished search implies: an edge to the activation from every node at a distance of at least the
    /// width, a wait for every node that is closer. Then repairs the potentials.
    fn derive(&mut self, link: u32) -> Result<Found, TooLarge> {
        let here = self.stnu.links[link as usize];
        let activation = here.activation;
        self.improved.clear();
        // Only now: these edges lead to A, and a search that passes A never gets here, so none of them could have served
        // it. Expanded nodes are those closer than the width. Nature's own do not wait; the search went on by their lower-
        // case edge. An edge from A to A that is not negative says nothing.
        for at in 0..self.reached.len() {
            let node = self.reached[at];
            let Node { distance, expanded, ending, potential, .. } = *self.node(node);
            let weight = distance - here.upper;
            if expanded == self.round {
                if self.purpose == Purpose::Solve && node != here.contingent && ending == NONE {
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
            if weight > LIMIT {
                // Beyond the horizon: it says nothing.
                continue;
            }
            if self.purpose == Purpose::Explain {
                let mut derivation = self.way_to_contingent(node, link);
                derivation.push(Move::Upper(link));
                self.derivations.push(derivation);
            }
            let edge = self.edges.len() as u32;
            self.edges.push(Edge { from: node, to: activation, weight });
            self.before_in.push(std::mem::replace(&mut self.derived_in[activation as usize], edge));
            self.before_out.push(std::mem::replace(&mut self.derived_out[node as usize], edge));
            if weight + self.node(activation).potential < potential {
                self.improved.push((node, edge));
            }
        }
        self.repair_potential(activation)
    }
}
