//! How a negative cycle came about, in terms of the edges the network was given with.

use super::{Cycle, Move, Purpose, Search, Step};
use crate::stnu::{TooLarge, add};

impl Search<'_> {
    /// The edges from `node` along `via` up to `end` (at least one edge).
    pub(super) fn walk(&self, mut node: u32, end: u32) -> Vec<Move> {
        let mut moves = Vec::new();
        loop {
            let edge = self.node(node).via;
            moves.push(Move::Along(edge));
            node = self.edges[edge as usize].to;
            if node == end {
                return moves;
            }
        }
    }

    /// The way of the last backward search from `node` to the contingent event of `link`.
    pub(super) fn way_to_contingent(&self, node: u32, link: u32) -> Vec<Move> {
        if self.purpose != Purpose::Explain {
            return Vec::new();
        }
        let end = self.stnu.links[link as usize].contingent;
        if node == end { Vec::new() } else { self.walk(node, end) }
    }

    /// The search of the last link in progress has come back to the activation of an earlier one.
    pub(super) fn close_cycle(&self, progress: &[(u32, Vec<Move>)], again: u32) -> Vec<Move> {
        let mut cycle = Vec::new();
        let from = progress.iter().position(|&(link, _)| link == again).unwrap_or_default();
        for (at, (link, way)) in progress.iter().enumerate().skip(from).rev() {
            if at + 1 == progress.len() {
                cycle.extend(self.way_to_contingent(self.stnu.links[again as usize].activation, *link));
            } else {
                cycle.extend(way);
            }
            cycle.push(Move::Upper(*link));
        }
        cycle
    }

    /// Expands derived edges into what they are made of and counts the steps.
    pub(super) fn count(&self, cycle: Vec<Move>) -> Result<Cycle, TooLarge> {
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
