//! The network of the team read as a simple temporal network: how long after one event another comes, at the least and the most.
//!
//! Potentials once, then one Dijkstra in either direction for each event asked about (D. Johnson, 1977).

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use kirk_network::EventId;
use kirk_network::stnu::Rows;

use crate::whole::Whole;

/// No path.
pub(crate) const FAR: i64 = i64::MAX;

pub(crate) struct Distances {
    /// Those of the sides, then two for each link, then that nothing comes before the origin.
    edges: Vec<(u32, u32, i64)>,
    sides: u32,
    links: u32,
    outgoing: Rows,
    incoming: Rows,
    potential: Vec<i64>,
}

/// A bound that a distance is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    Side(u32),
    LinkUpper(u32),
    LinkLower(u32),
    AfterOrigin,
}

/// Of one event, for every other: `at_most` is how long after the one the other comes at the most, `at_least` at the least (`-FAR`
/// if nothing says so).
pub(crate) struct Around {
    pub(crate) at_least: Vec<i64>,
    pub(crate) at_most: Vec<i64>,
}

impl Distances {
    /// `None` if there is a negative cycle.
    pub(crate) fn new(whole: &Whole) -> Option<Distances> {
        let network = &whole.merged.network;
        let count = network.events().len() as u32;
        let mut edges: Vec<(u32, u32, i64)> =
            whole.sides.iter().map(|side| (side.from.0, side.to.0, side.weight)).collect();
        for link in network.contingents() {
            edges.push((link.from.0, link.to.0, link.upper.as_micros()));
            edges.push((link.to.0, link.from.0, -link.lower.as_micros()));
        }
        let origin = network.origin().0;
        edges.extend((0..count).filter(|&event| event != origin).map(|event| (event, origin, 0)));
        let outgoing = Rows::new(count, edges.iter().map(|&(from, ..)| from));
        let incoming = Rows::new(count, edges.iter().map(|&(_, to, _)| to));
        let potential = potentials(count as usize, &edges, &outgoing)?;
        let (sides, links) = (whole.sides.len() as u32, network.contingents().len() as u32);
        Some(Distances { edges, sides, links, outgoing, incoming, potential })
    }

    /// From an event to all others.
    pub(crate) fn around(&self, event: EventId) -> Around {
        let (at_most, _) = self.shortest(event.0, &self.outgoing, true);
        let (back, _) = self.shortest(event.0, &self.incoming, false);
        let at_least = back.into_iter().map(|length| if length == FAR { -FAR } else { -length }).collect();
        Around { at_least, at_most }
    }

    /// The bounds that make up the shortest way from one event to another.
    pub(crate) fn way(&self, from: EventId, to: EventId) -> Vec<Step> {
        let (_, by) = self.shortest(from.0, &self.outgoing, true);
        let mut steps = Vec::new();
        let mut at = to.0;
        while at != from.0
            && let Some(edge) = by[at as usize]
        {
            steps.push(self.step(edge));
            at = self.edges[edge as usize].0;
        }
        steps
    }

    fn step(&self, edge: u32) -> Step {
        match edge.checked_sub(self.sides) {
            None => Step::Side(edge),
            Some(at) if at >= 2 * self.links => Step::AfterOrigin,
            Some(at) if at % 2 == 0 => Step::LinkUpper(at / 2),
            Some(at) => Step::LinkLower(at / 2),
        }
    }

    /// The lengths, and the edge by which each is reached.
    fn shortest(&self, source: u32, rows: &Rows, forward: bool) -> (Vec<i64>, Vec<Option<u32>>) {
        let mut by = vec![None; self.potential.len()];
        let mut length = vec![FAR; self.potential.len()];
        let mut done = vec![false; self.potential.len()];
        let mut open = BinaryHeap::from([Reverse((0_i64, source))]);
        length[source as usize] = 0;
        while let Some(Reverse((here, node))) = open.pop() {
            if std::mem::replace(&mut done[node as usize], true) {
                continue;
            }
            for &edge in rows.of(node) {
                let (from, to, weight) = self.edges[edge as usize];
                let reduced = weight + self.potential[from as usize] - self.potential[to as usize];
                let next = if forward { to } else { from };
                let there = here.saturating_add(reduced);
                if there < length[next as usize] {
                    length[next as usize] = there;
                    by[next as usize] = Some(edge);
                    open.push(Reverse((there, next)));
                }
            }
        }
        let own = self.potential[source as usize];
        for (node, length) in length.iter_mut().enumerate().filter(|(_, length)| **length < FAR) {
            let other = self.potential[node];
            *length += if forward { other - own } else { own - other };
        }
        (length, by)
    }
}

/// Numbers with which no edge is negative: the shortest paths from anywhere.
fn potentials(count: usize, edges: &[(u32, u32, i64)], outgoing: &Rows) -> Option<Vec<i64>> {
    let mut potential = vec![0_i64; count];
    let mut steps = vec![0_usize; count];
    let mut queued = vec![true; count];
    let mut open: VecDeque<u32> = (0..count as u32).collect();
    while let Some(node) = open.pop_front() {
        queued[node as usize] = false;
        for &edge in outgoing.of(node) {
            let (_, to, weight) = edges[edge as usize];
            let there = potential[node as usize].saturating_add(weight);
            if there < potential[to as usize] {
                potential[to as usize] = there;
                steps[to as usize] = steps[node as usize] + 1;
                if steps[to as usize] > count {
                    return None;
                }
                if !std::mem::replace(&mut queued[to as usize], true) {
                    open.push_back(to);
                }
            }
        }
    }
    Some(potential)
}
