//! The edges that follow from the contingent links, without those that follow from the others.
//!
//! Most of them say less than what is required anyway. Distances over the requirements show which; that is quicker than
//! to carry them along.

use crate::hierarchy::{Hierarchy, LANES, Searches};
use crate::radix::RadixQueue;
use crate::stnu::{Edge, LIMIT, Link, Rows, Stnu};

/// Edges to the activations, from `derived`, and edges from them. The potentials must fit everything, lower-case edges
/// too.
pub(super) fn implied_by_links(stnu: &Stnu, derived: Vec<Edge>, potential: &[i64]) -> Vec<Edge> {
    let hierarchy = Hierarchy::new(&stnu.edges, potential);
    let mut searches = Searches::default();
    let mut implied = shortest(derived, &hierarchy, potential, &mut searches);
    implied.extend(before_the_least(stnu, &implied, &hierarchy, potential, &mut searches));
    implied
}

/// Leaves out edges to which there is a shorter path that leads over known edges and ends with at most one of these.
///
/// What is left out is on no shortest path, so it does not matter that others that showed it may be left out too.
fn shortest(
    mut derived: Vec<Edge>,
    known: &Hierarchy,
    potential: &[i64],
    searches: &mut Searches,
) -> Vec<Edge> {
    let reduced = |edge: &Edge| edge.weight + potential[edge.to as usize] - potential[edge.from as usize];
    derived.sort_unstable_by_key(|edge| (edge.to, edge.from, edge.weight));
    derived.dedup_by_key(|edge| (edge.to, edge.from));
    let mut kept = Vec::new();
    let by_target: Vec<&[Edge]> = derived.chunk_by(|a, b| a.to == b.to).collect();
    for block in by_target.chunks(LANES) {
        searches.restart(known);
        for (lane, edges) in block.iter().enumerate() {
            searches.start(known, lane, edges[0].to, 0);
            edges.iter().for_each(|edge| searches.start(known, lane, edge.from, reduced(edge)));
        }
        known.lengths_to(searches);
        for (lane, edges) in block.iter().enumerate() {
            kept.extend(edges.iter().filter(|edge| searches.length(known, lane, edge.from) >= reduced(edge)));
        }
    }
    kept
}

/// For each link (A, x, y, C), from C forward to the first nodes X at a negative distance d: they come before C, so at
/// the latest at `A + x + d`.
///
/// The way from C leads over lower-case edges too. It need not go on from a node that is closer to A, by known edges,
/// than if Nature takes the least: what is found from there follows from what is known and what is found of other links.
fn before_the_least(
    stnu: &Stnu,
    derived: &[Edge],
    known: &Hierarchy,
    potential: &[i64],
    searches: &mut Searches,
) -> Vec<Edge> {
    let least = |link: &Link| Edge { from: link.activation, to: link.contingent, weight: link.lower };
    let all: Vec<Edge> =
        stnu.edges.iter().chain(derived).copied().chain(stnu.links.iter().map(least)).collect();
    let outgoing = Outgoing::new(&all, potential);
    let mut queue = RadixQueue::new();
    let mut lengths = vec![i64::MAX; potential.len()];
    let mut found = Vec::new();
    for links in stnu.links.chunks(LANES) {
        searches.restart(known);
        links.iter().enumerate().for_each(|(lane, link)| searches.start(known, lane, link.activation, 0));
        known.lengths_from(searches);
        for (lane, link) in links.iter().enumerate() {
            let base = potential[link.contingent as usize];
            let first = link.lower + base - potential[link.activation as usize];
            queue.restart(0);
            lengths.fill(i64::MAX);
            queue.push(0, link.contingent);
            lengths[link.contingent as usize] = 0;
            while let Some((length, node)) = queue.pop() {
                if length > lengths[node as usize] {
                    continue;
                }
                let by_known = searches.length(known, lane, node);
                if by_known < first + length {
                    continue;
                }
                let distance = length - potential[node as usize] + base;
                if distance < 0 {
                    if by_known > first + length {
                        let weight = link.lower + distance;
                        found.push(Edge { from: link.activation, to: node, weight });
                    }
                    continue;
                }
                if distance > LIMIT {
                    // No way back: no distance is below -LIMIT.
                    continue;
                }
                for &(to, reduced) in outgoing.of(node) {
                    let candidate = length + reduced;
                    if candidate < lengths[to as usize] {
                        lengths[to as usize] = candidate;
                        queue.push(candidate, to);
                    }
                }
            }
        }
    }
    found
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
