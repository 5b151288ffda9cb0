//! The dispatchable form of a controllable STNU: a network that can be executed by looking at direct neighbours only.
//!
//! N. Muscettola, P. Morris, I. Tsamardinos, *Reformulating temporal plans for efficient execution*, 1998, carried over
//! to STNUs: P. Morris, *Dynamic controllability and dispatchability relationships*, 2014; L. Hunsberger, R. Posenato,
//! *A faster algorithm for converting STNUs into dispatchable form*, 2023. In three steps:
//! 1. the check leaves the edges to activations and the waits ([`crate::controllability`]);
//! 2. an event that must come before a contingent one must come before it even if Nature takes the least;
//! 3. of the all-pairs shortest paths only those stay that no other edge makes needless, rigid groups first.

use std::collections::VecDeque;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::controllability::{Solution, Wait, solve};
use crate::radix::RadixQueue;
use crate::stnu::{Edge, Link, NONE, Rows, Stnu, TooLarge, add, within_limit};

/// A dispatchable network: ordinary edges, and waits for contingent events.
///
/// Executing X at t, each edge X -> Y of weight w >= 0 says Y comes at `t + w` at the latest, each edge Y -> X of
/// weight w < 0 says Y comes at `t - w` at the earliest, and not before X (see also [`Dispatchable::holds`]). A wait (Y, C:w, A) says Y comes after A, and
/// until C has happened not before `A - w`.
#[derive(Clone, Debug)]
pub struct Dispatchable {
    /// The number of nodes; node 0 is the origin.
    pub nodes: u32,
    /// The contingent links, those of the network it was made from.
    pub links: Vec<Link>,
    /// The ordinary edges, by source, then target.
    pub edges: Vec<Edge>,
    /// The waits.
    pub waits: Vec<Wait>,
    /// For each node the node at whose time it is always executed, and after which; [`NONE`] for most.
    pub simultaneous: Vec<u32>,
}

impl Dispatchable {
    /// True if the source of the edge must not be executed before its target: its weight is negative, or the two are
    /// simultaneous and the target leads.
    pub fn holds(&self, edge: &Edge) -> bool {
        edge.weight < 0 || self.simultaneous[edge.from as usize] == edge.to
    }
}

/// Makes a network dispatchable; `None` if it is not controllable. No edge is needless.
pub fn dispatchable(stnu: &Stnu) -> Result<Option<Dispatchable>, TooLarge> {
    make(stnu, Effort::Minimal)
}

/// The same in less time: a form to be executed, with some needless edges.
pub fn dispatchable_quickly(stnu: &Stnu) -> Result<Option<Dispatchable>, TooLarge> {
    make(stnu, Effort::Quick)
}

#[derive(Clone, Copy, PartialEq)]
enum Effort {
    Minimal,
    Quick,
}

fn make(stnu: &Stnu, effort: Effort) -> Result<Option<Dispatchable>, TooLarge> {
    let Some(Solution { derived, waits, potential }) = solve(stnu)? else { return Ok(None) };
    let mut edges = stnu.edges.clone();
    edges.extend(derived);
    let before = before_the_least(stnu, &edges, &potential)?;
    edges.extend(before);
    let rigid = Rigid::new(stnu, &edges, &potential);
    // What Nature keeps by herself helps to make other edges needless, and is needless itself.
    let nature = rigid.contracted(&nature_keeps(stnu))?;
    edges.extend(nature_keeps(stnu));
    let mut kept = undominated(&rigid.contracted(&edges)?, potential, effort)?;
    kept.retain(|edge| {
        nature.binary_search_by_key(&(edge.from, edge.to), |known| (known.from, known.to)).is_err()
    });
    kept.extend(rigid.spokes());
    kept.sort_unstable_by_key(|edge| (edge.from, edge.to));
    // The others are held at their distance from their leader, which waits for them; and what comes after a contingent
    // event in any case does not wait for it.
    let needed = |wait: &Wait| {
        let comes_after = wait.weight < -stnu.links[wait.link as usize].upper;
        rigid.leader[wait.waiter as usize] == wait.waiter && !comes_after
    };
    let waits = waits.into_iter().filter(needed).collect();
    let simultaneous = rigid.simultaneous();
    Ok(Some(Dispatchable { nodes: stnu.nodes, links: stnu.links.clone(), edges: kept, waits, simultaneous }))
}

/// `C - A` is in `[x, y]` for each link (A, x, y, C).
fn nature_keeps(stnu: &Stnu) -> Vec<Edge> {
    let both = |link: &Link| {
        [
            Edge { from: link.activation, to: link.contingent, weight: link.upper },
            Edge { from: link.contingent, to: link.activation, weight: -link.lower },
        ]
    };
    stnu.links.iter().flat_map(both).collect()
}

/// Lowers potentials until they fit all edges: Bellman-Ford from what is almost right. There must be no negative cycle.
fn fit(edges: &[Edge], mut potential: Vec<i64>) -> Result<Vec<i64>, TooLarge> {
    let incoming = Rows::new(potential.len() as u32, edges.iter().map(|edge| edge.to));
    let mut open: VecDeque<u32> = (0..potential.len() as u32).collect();
    let mut queued = vec![true; potential.len()];
    while let Some(node) = open.pop_front() {
        queued[node as usize] = false;
        let here = within_limit(potential[node as usize])?;
        for &edge in incoming.of(node) {
            let Edge { from, weight, .. } = edges[edge as usize];
            if weight + here < potential[from as usize] {
                potential[from as usize] = weight + here;
                if !std::mem::replace(&mut queued[from as usize], true) {
                    open.push_back(from);
                }
            }
        }
    }
    Ok(potential)
}

/// For each link (A, x, y, C), from C forward to the first nodes X at a negative distance d: they come before C, so at
/// the latest at `A + x + d`.
fn before_the_least(stnu: &Stnu, edges: &[Edge], potential: &[i64]) -> Result<Vec<Edge>, TooLarge> {
    let mut all = edges.to_vec();
    all.extend(stnu.links.iter().map(|l| Edge { from: l.activation, to: l.contingent, weight: l.lower }));
    let outgoing = Outgoing::new(&all, potential);
    let mut queue = RadixQueue::new();
    let mut least = vec![i64::MAX; potential.len()];
    let mut found = Vec::new();
    for link in &stnu.links {
        queue.restart(0);
        least.fill(i64::MAX);
        queue.push(0, link.contingent);
        least[link.contingent as usize] = 0;
        let base = potential[link.contingent as usize];
        while let Some((key, node)) = queue.pop() {
            if key > least[node as usize] {
                continue;
            }
            let distance = within_limit(key - potential[node as usize] + base)?;
            if distance < 0 {
                let weight = add(link.lower, distance)?;
                if node != link.activation {
                    found.push(Edge { from: link.activation, to: node, weight });
                }
                continue;
            }
            for &(to, reduced) in outgoing.of(node) {
                let candidate = key + reduced;
                if candidate < least[to as usize] {
                    least[to as usize] = candidate;
                    queue.push(candidate, to);
                }
            }
        }
    }
    Ok(found)
}

/// Edges by source, in one piece, their weights reduced by the potentials: none is negative.
struct Outgoing {
    start: Vec<u32>,
    edges: Vec<(u32, i64)>,
}

impl Outgoing {
    fn new(edges: &[Edge], potential: &[i64]) -> Outgoing {
        let nodes = potential.len() as u32;
        let rows = Rows::new(nodes, edges.iter().map(|edge| edge.from));
        let mut outgoing = Outgoing { start: vec![0], edges: Vec::with_capacity(edges.len()) };
        for node in 0..nodes {
            outgoing.edges.extend(rows.of(node).iter().map(|&edge| {
                let Edge { from, to, weight } = edges[edge as usize];
                (to, weight + potential[to as usize] - potential[from as usize])
            }));
            outgoing.start.push(outgoing.edges.len() as u32);
        }
        outgoing
    }

    #[inline]
    fn of(&self, node: u32) -> &[(u32, i64)] {
        &self.edges[self.start[node as usize] as usize..self.start[node as usize + 1] as usize]
    }
}

/// Groups of nodes at fixed distances from one another, each with a leader: its earliest node.
#[derive(Debug)]
pub(crate) struct Rigid {
    pub(crate) leader: Vec<u32>,
    /// How long after its leader a node comes.
    pub(crate) offset: Vec<i64>,
}

impl Rigid {
    pub(crate) fn new(stnu: &Stnu, edges: &[Edge], potential: &[i64]) -> Rigid {
        // On a cycle of weight 0 every edge is tight, and every cycle of tight edges has weight 0.
        let tight = edges
            .iter()
            .filter(|edge| potential[edge.from as usize] == edge.weight + potential[edge.to as usize]);
        let mut graph: DiGraph<(), ()> = DiGraph::with_capacity(stnu.nodes as usize, 0);
        for _ in 0..stnu.nodes {
            graph.add_node(());
        }
        for edge in tight {
            graph.add_edge(NodeIndex::new(edge.from as usize), NodeIndex::new(edge.to as usize), ());
        }
        let ending = stnu.link_ending_at();
        let mut rigid = Rigid { leader: (0..stnu.nodes).collect(), offset: vec![0; stnu.nodes as usize] };
        for group in kosaraju_scc(&graph) {
            let nodes = group.iter().map(|node| node.index());
            // t_v - t_leader = potential(leader) - potential(v). A contingent event leads before what is simultaneous.
            let leader =
                nodes.clone().max_by_key(|&node| (potential[node], ending[node] != NONE, usize::MAX - node));
            let Some(leader) = leader else { continue };
            for node in nodes {
                rigid.leader[node] = leader as u32;
                rigid.offset[node] = potential[leader] - potential[node];
            }
        }
        rigid
    }

    /// The edges between leaders, sorted, the tightest of each pair.
    fn contracted(&self, edges: &[Edge]) -> Result<Vec<Edge>, TooLarge> {
        let mut contracted = Vec::with_capacity(edges.len());
        for edge in edges {
            let (from, to) = (self.leader[edge.from as usize], self.leader[edge.to as usize]);
            if from != to {
                let shift = self.offset[edge.from as usize] - self.offset[edge.to as usize];
                contracted.push(Edge { from, to, weight: add(edge.weight, shift)? });
            }
        }
        contracted.sort_unstable_by_key(|edge| (edge.from, edge.to, edge.weight));
        contracted.dedup_by_key(|edge| (edge.from, edge.to));
        Ok(contracted)
    }

    fn simultaneous(&self) -> Vec<u32> {
        let leads = |node: usize| self.leader[node] as usize != node && self.offset[node] == 0;
        (0..self.leader.len()).map(|node| if leads(node) { self.leader[node] } else { NONE }).collect()
    }

    /// The edges that hold each node at its distance from its leader.
    fn spokes(&self) -> impl Iterator<Item = Edge> {
        self.leader.iter().zip(&self.offset).enumerate().flat_map(|(node, (&leader, &offset))| {
            let node = node as u32;
            let both = [
                Edge { from: leader, to: node, weight: offset },
                Edge { from: node, to: leader, weight: -offset },
            ];
            both.into_iter().filter(move |_| node != leader)
        })
    }
}

/// Of all shortest paths those that no other makes needless. There must be no cycle of weight 0.
///
/// From a source u, a node v at a distance d(v) >= 0 is needless if a shortest path to it passes a node w with
/// d(w) <= d(v); one at a distance < 0 if a shortest path to it passes a node w with d(w) < 0.
fn undominated(edges: &[Edge], potential: Vec<i64>, effort: Effort) -> Result<Vec<Edge>, TooLarge> {
    /// What the search from one source knows of a node.
    #[derive(Clone, Copy)]
    struct Reached {
        /// The reduced distance.
        key: i64,
        /// The least distance of a node between the source and this one on a shortest path.
        between: i64,
        source: u32,
        /// Its edges have been followed with this `between`.
        settled: bool,
    }
    let potential = fit(edges, potential)?;
    let outgoing = Outgoing::new(edges, &potential);
    let mut queue = RadixQueue::new();
    let mut nodes =
        vec![Reached { key: 0, between: i64::MAX, source: NONE, settled: false }; potential.len()];
    let mut reached = Vec::new();
    let mut kept = Vec::new();
    for source in 0..potential.len() as u32 {
        if outgoing.of(source).is_empty() {
            continue;
        }
        queue.restart(0);
        reached.clear();
        nodes[source as usize] = Reached { key: 0, between: i64::MAX, source, settled: false };
        queue.push(0, source);
        let base = potential[source as usize];
        while let Some((key, node)) = queue.pop() {
            let here = &mut nodes[node as usize];
            if here.settled || key > here.key {
                continue;
            }
            here.settled = true;
            let real = within_limit(key - potential[node as usize] + base)?;
            // Whatever is reached through a node before the source is needless, unless a way around is longer.
            if real < 0 && effort == Effort::Quick {
                continue;
            }
            let least = if node == source { i64::MAX } else { here.between.min(real) };
            for &(to, reduced) in outgoing.of(node) {
                let candidate = key + reduced;
                let there = &mut nodes[to as usize];
                if there.source != source {
                    reached.push(to);
                } else if candidate > there.key || candidate == there.key && least >= there.between {
                    continue;
                }
                // At the same distance a node can be settled before all shortest paths to it are known; then it is
                // settled again. There is no cycle of weight 0 on which that could go on for ever.
                *there = Reached { key: candidate, between: least, source, settled: false };
                queue.push(candidate, to);
            }
        }
        for &node in reached.iter().filter(|&&node| node != source) {
            let Reached { key, between, .. } = nodes[node as usize];
            let real = key - potential[node as usize] + base;
            let dominated = if real >= 0 { between <= real } else { between < 0 };
            if !dominated {
                kept.push(Edge { from: source, to: node, weight: real });
            }
        }
    }
    Ok(kept)
}
