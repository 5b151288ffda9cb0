//! The elimination: which node goes when, and what takes its place.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::thin::thin;
use super::{FARTHEST, Hierarchy, NOTHING, Way, Ways};
use crate::stnu::{Edge, NONE};

/// Eliminates all nodes that have edges, always one of those that seem to leave the fewest edges behind.
///
/// What holds after every step: between the nodes that are left the shortest paths are as long as in the whole network,
/// and pass inner nodes as early ([`Way::least`]), because a path through the node that went has an edge of its own now.
/// So the ways of a node at its turn, to those left, are all that later searches need to know of it.
///
/// The cost is the product of the numbers of edges in and out, a bound on the fill-in (the Markowitz rule). It is not
/// kept exact: new ways make a node dearer than the queue says, doubled and gone ones make it seem dearer than it is. A
/// node whose turn it seems is tidied, and goes back into the queue if it then costs more than the next.
pub(super) fn eliminate(edges: &[Edge], potential: &[i64]) -> Hierarchy {
    let count = potential.len();
    let mut left = Left::new(edges, potential);
    // The least costs that are known; higher ones come to light when it is a node's turn.
    let mut cost: Vec<usize> = (0..count as u32).map(|node| left.cost(node)).collect();
    let mut queue: BinaryHeap<Reverse<(usize, u32)>> = (0..count as u32)
        .filter(|&node| left.has_edges(node))
        .map(|node| Reverse((cost[node as usize], node)))
        .collect();
    let mut nodes = Vec::with_capacity(queue.len());
    let mut rank = vec![NONE; count];
    let (mut up, mut down) = (Ways::with_capacity(2 * edges.len()), Ways::with_capacity(2 * edges.len()));
    while let Some(Reverse((known, node))) = queue.pop() {
        if rank[node as usize] != NONE || known != cost[node as usize] {
            continue;
        }
        left.tidy(node);
        let now = left.cost(node);
        if queue.peek().is_some_and(|&Reverse(next)| (now, node) > next) {
            cost[node as usize] = now;
            queue.push(Reverse((now, node)));
            continue;
        }
        rank[node as usize] = nodes.len() as u32;
        nodes.push(node);
        let (out, into) = left.take(node);
        left.join_neighbours(&into, &out, potential[node as usize]);
        for way in into.iter().chain(&out) {
            let neighbour = way.end;
            left.tidy_if_grown(neighbour);
            let now = left.cost(neighbour);
            if now < cost[neighbour as usize] {
                cost[neighbour as usize] = now;
                queue.push(Reverse((now, neighbour)));
            }
        }
        up.push(out);
        down.push(into);
    }
    for way in up.ways.iter_mut().chain(&mut down.ways) {
        way.end = rank[way.end as usize];
    }
    thin(&mut up, &mut down);
    let potential = nodes.iter().map(|&node| potential[node as usize]).collect();
    Hierarchy { nodes, rank, potential, up, down }
}

/// What is not eliminated yet. Its lists are tidied now and then only: some ways are in there twice, or lead to nodes that
/// are gone.
struct Left {
    out: Vec<Vec<Way>>,
    into: Vec<Vec<Way>>,
    /// How many ways out of and into a node there were when they were last tidied.
    tidied: Vec<(usize, usize)>,
    gone: Vec<bool>,
    /// For tidying: where a way to a node may be in the list.
    place: Vec<u32>,
}

impl Left {
    fn new(edges: &[Edge], potential: &[i64]) -> Left {
        let count = potential.len();
        let mut left = Left {
            out: vec![Vec::new(); count],
            into: vec![Vec::new(); count],
            tidied: vec![(0, 0); count],
            gone: vec![false; count],
            place: vec![0; count],
        };
        for &Edge { from, to, weight } in edges {
            let length = weight + potential[to as usize] - potential[from as usize];
            debug_assert!(length >= 0, "the potentials fit");
            left.join(from, to, length, NOTHING);
        }
        (0..count as u32).for_each(|node| left.tidy(node));
        left
    }

    fn has_edges(&self, node: u32) -> bool {
        !self.out[node as usize].is_empty() || !self.into[node as usize].is_empty()
    }

    /// How many edges would take the place of a node, at most.
    fn cost(&self, node: u32) -> usize {
        self.out[node as usize].len() * self.into[node as usize].len()
    }

    fn join(&mut self, from: u32, to: u32, length: i64, least: i64) {
        self.out[from as usize].push(Way { end: to, length, least });
        self.into[to as usize].push(Way { end: from, length, least });
    }

    /// Takes a node out.
    fn take(&mut self, node: u32) -> (Vec<Way>, Vec<Way>) {
        self.gone[node as usize] = true;
        (std::mem::take(&mut self.out[node as usize]), std::mem::take(&mut self.into[node as usize]))
    }

    /// Puts edges in place of the paths through a node of this potential.
    fn join_neighbours(&mut self, into: &[Way], out: &[Way], potential: i64) {
        for first in into {
            // The node itself is an inner one.
            let least = first.least.min(first.length - potential);
            // A way back to where it came from is a cycle, never negative, and on no shortest path.
            for second in out.iter().filter(|second| second.end != first.end) {
                let length = first.length + second.length;
                if length <= FARTHEST {
                    self.join(first.end, second.end, length, least.min(first.length + second.least));
                }
            }
        }
    }

    /// Tidies lists that have doubled since they were tidied last, so that tidying costs a constant for each new way.
    fn tidy_if_grown(&mut self, node: u32) {
        let (out, into) = self.tidied[node as usize];
        if self.out[node as usize].len() > 2 * out + 8 || self.into[node as usize].len() > 2 * into + 8 {
            self.tidy(node);
        }
    }

    /// Keeps the best of the ways to each node, and none to those that are gone.
    fn tidy(&mut self, node: u32) {
        for ways in [&mut self.out[node as usize], &mut self.into[node as usize]] {
            let mut kept = 0;
            for at in 0..ways.len() {
                let way = ways[at];
                if self.gone[way.end as usize] {
                    continue;
                }
                let place = self.place[way.end as usize] as usize;
                if place < kept && ways[place].end == way.end {
                    let known = &mut ways[place];
                    // Of equals the one by an earlier node: domination asks for the least over all shortest paths.
                    if (way.length, way.least) < (known.length, known.least) {
                        *known = way;
                    }
                } else {
                    self.place[way.end as usize] = kept as u32;
                    ways[kept] = way;
                    kept += 1;
                }
            }
            ways.truncate(kept);
        }
        self.tidied[node as usize] = (self.out[node as usize].len(), self.into[node as usize].len());
    }
}
