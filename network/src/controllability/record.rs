//! How a negative cycle came about, in terms of the edges the network was given with.

use std::collections::BTreeMap;

use super::{Ahead, EdgeId, Move, Purpose, Search, Step};
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
        // In progress are l1..ln, and the search of each ended at the activation of the next: its way, then its upper-case
        // edge. From the last back to the first they join; ln closes the cycle, having come upon the activation of l1.
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
    pub(super) fn count(&self, moves: &[Move]) -> Result<Vec<(Step, i64)>, TooLarge> {
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
        tally(moves, 1, &mut edges)?;
        // A derived edge is made of older ones.
        for edge in (self.derived_from..self.edges.len()).rev() {
            let times = edges[edge];
            if times > 0 {
                tally(&self.derivations[edge - self.derived_from], times, &mut edges)?;
            }
        }
        let mut steps = Vec::new();
        for (edge, &times) in edges[..self.derived_from].iter().enumerate().filter(|&(_, &times)| times > 0) {
            steps.push((self.step(edge as EdgeId), times));
        }
        steps.extend(
            uppers
                .iter()
                .enumerate()
                .filter(|&(_, &times)| times > 0)
                .map(|(link, &times)| (Step::Upper(link as u32), times)),
        );
        Ok(steps)
    }

    /// For each lower-case edge of a cycle, of a link whose upper-case edge is on it too, the shortest negative way on. None of
    /// a cycle that is very long.
    pub(super) fn ahead(&self, cycle: &[Move]) -> Vec<Ahead> {
        const LONGEST: usize = 2000;
        let Some(steps) = self.in_order_of_steps(cycle, LONGEST) else { return Vec::new() };
        let weight = |step: Step| match step {
            Step::Edge(edge) => self.edges[edge as usize].weight,
            Step::Lower(link) => self.stnu.links[link as usize].lower,
            Step::Upper(link) => -self.stnu.links[link as usize].upper,
        };
        let mut all = Vec::new();
        for (at, &step) in steps.iter().enumerate() {
            let Step::Lower(link) = step else { continue };
            if !steps.contains(&Step::Upper(link)) {
                continue;
            }
            let mut sum = 0;
            let mut way = BTreeMap::new();
            for &next in steps[at + 1..].iter().chain(&steps[..at]) {
                if next == Step::Upper(link) {
                    break;
                }
                sum += weight(next);
                *way.entry(next).or_insert(0) += 1;
                if sum < 0 {
                    all.push(way.into_iter().collect());
                    break;
                }
            }
        }
        all.sort();
        all.dedup();
        all
    }

    /// The steps of a cycle one after the other, with derived edges expanded; `None` if there are too many.
    fn in_order_of_steps(&self, cycle: &[Move], most: usize) -> Option<Vec<Step>> {
        let mut steps = Vec::new();
        let mut open: Vec<Move> = cycle.iter().rev().copied().collect();
        while let Some(step) = open.pop() {
            match step {
                Move::Along(edge) if edge as usize >= self.derived_from => {
                    open.extend(self.derivations[edge as usize - self.derived_from].iter().rev());
                }
                Move::Along(edge) => steps.push(self.step(edge)),
                Move::Upper(link) => steps.push(Step::Upper(link)),
            }
            if steps.len() + open.len() > most {
                return None;
            }
        }
        Some(steps)
    }

    /// An edge that is not derived, as a step.
    fn step(&self, edge: EdgeId) -> Step {
        match (edge as usize).checked_sub(self.lower_from) {
            None => Step::Edge(edge),
            Some(link) => Step::Lower(link as u32),
        }
    }
}
