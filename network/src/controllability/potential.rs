//! Potentials: numbers for the nodes that make every edge non-negative, so that Dijkstra's algorithm applies.

use super::{EdgeId, Found, Incoming, Move, Node, Purpose, Search, incoming_of};
use crate::stnu::{Edge, LIMIT, NONE, TooLarge, within_limit};

impl Search<'_> {
    /// Potentials over ordinary and lower-case edges, or a negative cycle of them.
    ///
    /// Bellman-Ford in rounds over the nodes that changed; now and then the tree of last improvements is searched for a
    /// cycle, so a negative one is found about as soon as it exists.
    ///
    /// A contingent event comes at least its shortest duration after its activation. The searches need no such edge, but
    /// with it the potentials are in the order of the events across links too: links are then rarely begun anew, and
    /// potentials rarely repaired. It is left out where it would show, in an explanation or in the order of what is derived.
    pub(super) fn initial_potential(&mut self) -> Result<Option<Vec<Move>>, TooLarge> {
        let mut changed: Vec<u32> = (0..self.stnu.nodes).rev().collect();
        let mut queued = vec![false; self.nodes.len()];
        let mut next = Vec::new();
        let (mut rounds, mut next_look) = (0, 1);
        while !changed.is_empty() {
            for &to in &changed {
                queued[to as usize] = false;
                let potential = within_limit(self.node(to).potential)?;
                let mut relax = |from: u32, edge: EdgeId, weight: i64, node: &mut Node| {
                    let candidate = weight + potential;
                    if candidate < node.potential {
                        node.potential = candidate;
                        node.via = edge;
                        if !std::mem::replace(&mut queued[from as usize], true) {
                            next.push(from);
                        }
                    }
                };
                if let Some(lower) = self.lower_into(to) {
                    let Edge { from, weight, .. } = self.edges[lower as usize];
                    relax(from, lower, weight, &mut self.nodes[from as usize]);
                }
                if self.purpose == Purpose::Decide {
                    for &link in self.starting.of(to) {
                        let edge = (self.lower_from + self.stnu.links.len()) as u32 + link;
                        let Edge { from, weight, .. } = self.edges[edge as usize];
                        relax(from, edge, weight, &mut self.nodes[from as usize]);
                    }
                }
                for &Incoming { from, edge, weight } in &self.incoming[incoming_of(&self.incoming_at, to)] {
                    relax(from, edge, weight, &mut self.nodes[from as usize]);
                }
            }
            rounds += 1;
            if rounds == next_look {
                next_look += next_look / 4 + 1;
                if let Some(cycle) = self.cycle_of_improvements() {
                    return Ok(Some(cycle));
                }
            }
            changed.clear();
            std::mem::swap(&mut changed, &mut next);
        }
        Ok(None)
    }

    fn cycle_of_improvements(&self) -> Option<Vec<Move>> {
        let mut walk_of = vec![NONE; self.nodes.len()];
        for start in 0..self.stnu.nodes {
            let mut node = start;
            while walk_of[node as usize] == NONE && self.node(node).via != NONE {
                walk_of[node as usize] = start;
                node = self.edges[self.node(node).via as usize].to;
            }
            if walk_of[node as usize] == start && self.node(node).via != NONE {
                return Some(self.walk(node, node));
            }
        }
        None
    }

    /// Lowers the potentials until they fit the new edges into `activation`; a negative cycle if that never ends.
    ///
    /// Largest change first, every node changes once: S. Cotton, O. Maler, *Fast and flexible difference constraint
    /// propagation for DPLL(T)*, 2006.
    pub(super) fn repair_potential(&mut self, activation: u32) -> Result<Found, TooLarge> {
        if self.improved.is_empty() {
            return Ok(Found::Done);
        }
        let potential = self.node(activation).potential;
        // From here on `distance` is the change a node is queued for, and `expanded` says that it is made.
        self.round += 1;
        self.queue.restart(-2 * LIMIT);
        for at in 0..self.improved.len() {
            let (node, edge) = self.improved[at];
            let weight = self.edges[edge as usize].weight;
            self.lower_potential(activation, node, edge, weight + potential);
        }
        while let Some((change, node)) = self.queue.pop() {
            if self.node(node).expanded == self.round {
                continue;
            }
            self.nodes[node as usize].expanded = self.round;
            let potential = within_limit(self.node(node).potential + change)?;
            self.nodes[node as usize].potential = potential;
            let mut closes = None;
            for at in incoming_of(&self.incoming_at, node) {
                let Incoming { from, edge, weight } = self.incoming[at];
                closes = closes.or(self.lower_potential(activation, from, edge, weight + potential));
            }
            if let Some(lower) = self.lower_into(node) {
                let Edge { from, weight, .. } = self.edges[lower as usize];
                closes = closes.or(self.lower_potential(activation, from, lower, weight + potential));
            }
            let mut edge = self.derived_in[node as usize];
            while edge != NONE {
                let Edge { from, weight, .. } = self.edges[edge as usize];
                closes = closes.or(self.lower_potential(activation, from, edge, weight + potential));
                edge = self.before_in[edge as usize - self.derived_from];
            }
            if let Some(edge) = closes {
                let mut cycle = vec![Move::Along(edge)];
                cycle.extend(self.walk(node, activation));
                return Ok(Found::Cycle(cycle));
            }
        }
        Ok(Found::Done)
    }

    /// Queues a node whose potential may be no more than `most`, for the sake of this edge. The edge, if the node is
    /// the activation: its own potential need not change.
    #[inline(always)]
    fn lower_potential(&mut self, activation: u32, from: u32, edge: EdgeId, most: i64) -> Option<EdgeId> {
        let node = &mut self.nodes[from as usize];
        let change = most - node.potential;
        if change >= 0 {
            return None;
        }
        if from == activation {
            return Some(edge);
        }
        if node.reached != self.round || change < node.distance {
            node.reached = self.round;
            node.distance = change;
            node.via = edge;
            self.queue.push(change, from);
        }
        None
    }
}
