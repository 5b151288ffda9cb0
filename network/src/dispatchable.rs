//! The dispatchable form of a controllable STNU: a network that can be executed by looking at direct neighbours only.
//!
//! N. Muscettola, P. Morris, I. Tsamardinos, *Reformulating temporal plans for efficient execution*, 1998, carried over
//! to STNUs: P. Morris, *Dynamic controllability and dispatchability relationships*, 2014; L. Hunsberger, R. Posenato,
//! *A faster algorithm for converting STNUs into dispatchable form*, 2023. In three steps:
//! 1. the check leaves the edges to activations and the waits ([`crate::controllability`]);
//! 2. an event that must come before a contingent one must come before it even if Nature takes the least;
//! 3. of the all-pairs shortest paths only those stay that no other edge makes needless, rigid groups first.

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::controllability::{Solution, Wait, solve};
use crate::heap::Heap;
use crate::stnu::{Edge, Link, NONE, Rows, Stnu, TooLarge, add};

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

/// Makes a network dispatchable; `None` if it is not controllable.
pub fn dispatchable(stnu: &Stnu) -> Result<Option<Dispatchable>, TooLarge> {
    let Some(Solution { derived, waits, potential }) = solve(stnu)? else { return Ok(None) };
    let mut edges = stnu.edges.clone();
    edges.extend(derived);
    let before = before_the_least(stnu, &edges, &potential)?;
    edges.extend(before);
    let rigid = Rigid::new(stnu, &edges, &potential);
    let mut kept = undominated(&rigid.contracted(&edges)?, &potential)?;
    kept.extend(rigid.spokes());
    kept.sort_unstable_by_key(|edge| (edge.from, edge.to));
    // The others are held at their distance from their leader, which waits for them.
    let waits = waits.into_iter().filter(|wait| rigid.leader[wait.waiter as usize] == wait.waiter).collect();
    let simultaneous = rigid.simultaneous();
    Ok(Some(Dispatchable { nodes: stnu.nodes, links: stnu.links.clone(), edges: kept, waits, simultaneous }))
}

/// For each link (A, x, y, C), from C forward to the first nodes X at a negative distance d: they come before C, so at
/// the latest at `A + x + d`.
fn before_the_least(stnu: &Stnu, edges: &[Edge], potential: &[i64]) -> Result<Vec<Edge>, TooLarge> {
    let mut all = edges.to_vec();
    all.extend(stnu.links.iter().map(|l| Edge { from: l.activation, to: l.contingent, weight: l.lower }));
    let outgoing = Rows::new(stnu.nodes, all.iter().map(|edge| edge.from));
    let mut heap = Heap::new(stnu.nodes);
    let mut found = Vec::new();
    for link in &stnu.links {
        heap.clear();
        heap.push(link.contingent, 0);
        let base = potential[link.contingent as usize];
        while let Some((key, node)) = heap.pop() {
            let distance = key - potential[node as usize] + base;
            if distance < 0 {
                let weight = add(link.lower, distance)?;
                if node != link.activation {
                    found.push(Edge { from: link.activation, to: node, weight });
                }
                continue;
            }
            for &edge in outgoing.of(node) {
                let Edge { to, weight, .. } = all[edge as usize];
                heap.push(to, add(key, weight + potential[to as usize] - potential[node as usize])?);
            }
        }
    }
    Ok(found)
}

/// Groups of nodes at fixed distances from one another, each with a leader: its earliest node.
struct Rigid {
    leader: Vec<u32>,
    /// How long after its leader a node comes.
    offset: Vec<i64>,
}

impl Rigid {
    fn new(stnu: &Stnu, edges: &[Edge], potential: &[i64]) -> Rigid {
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
fn undominated(edges: &[Edge], potential: &[i64]) -> Result<Vec<Edge>, TooLarge> {
    let nodes = potential.len() as u32;
    let outgoing = Rows::new(nodes, edges.iter().map(|edge| edge.from));
    let reduced = |edge: &Edge| edge.weight + potential[edge.to as usize] - potential[edge.from as usize];
    // Nodes in an order in which every tight edge leads forward, so that nodes at the same reduced distance are
    // settled before those that are reached through them.
    let order = tight_order(nodes, edges, potential);
    let mut by_rank = vec![0_u32; nodes as usize];
    for (node, &rank) in order.iter().enumerate() {
        by_rank[rank as usize] = node as u32;
    }
    let mut heap = Heap::new(nodes);
    let mut distance = vec![i64::MAX; nodes as usize];
    // The least distance of a node between u and v on a shortest path.
    let mut between = vec![i64::MAX; nodes as usize];
    let mut kept = Vec::new();
    for source in 0..nodes {
        if outgoing.of(source).is_empty() {
            continue;
        }
        heap.clear();
        distance.fill(i64::MAX);
        heap.push(order[source as usize], 0);
        distance[source as usize] = 0;
        while let Some((key, rank)) = heap.pop() {
            let node = by_rank[rank as usize];
            let real = key - potential[node as usize] + potential[source as usize];
            let least_here = if node == source {
                i64::MAX
            } else {
                let least = between[node as usize];
                let dominated = if real >= 0 { least <= real } else { least < 0 };
                if !dominated {
                    kept.push(Edge { from: source, to: node, weight: real });
                }
                least.min(real)
            };
            for &edge in outgoing.of(node) {
                let edge = &edges[edge as usize];
                let to = edge.to as usize;
                let candidate = add(key, reduced(edge))?;
                if candidate < distance[to] {
                    distance[to] = candidate;
                    between[to] = least_here;
                    heap.push(order[to], candidate);
                } else if candidate == distance[to] && edge.to != source {
                    between[to] = between[to].min(least_here);
                }
            }
        }
    }
    Ok(kept)
}

/// The rank of each node in a topological order of the tight edges.
fn tight_order(nodes: u32, edges: &[Edge], potential: &[i64]) -> Vec<u32> {
    let tight = |edge: &&Edge| potential[edge.from as usize] == edge.weight + potential[edge.to as usize];
    let mut waiting = vec![0_u32; nodes as usize];
    let kept: Vec<Edge> = edges.iter().filter(tight).copied().collect();
    for edge in &kept {
        waiting[edge.to as usize] += 1;
    }
    let outgoing = Rows::new(nodes, kept.iter().map(|edge| edge.from));
    let mut ready: Vec<u32> = (0..nodes).rev().filter(|&node| waiting[node as usize] == 0).collect();
    let mut rank = vec![0; nodes as usize];
    let mut next = 0;
    while let Some(node) = ready.pop() {
        rank[node as usize] = next;
        next += 1;
        for &edge in outgoing.of(node) {
            let to = kept[edge as usize].to;
            waiting[to as usize] -= 1;
            if waiting[to as usize] == 0 {
                ready.push(to);
            }
        }
    }
    debug_assert_eq!(next, nodes, "rigid groups are contracted, so tight edges form no cycle");
    rank
}
