//! Potentials: numbers for the nodes that make every edge non-negative, so that Dijkstra's algorithm applies.

use super::{EdgeId, Found, Incoming, Move, Search, incoming_of};
use crate::stnu::{Edge, LIMIT, NONE, Rows, TooLarge, within_limit};

/// Whether the edges into a node are to be looked at: not until it changes, in this round or the next, or in the order
/// of this round.
#[derive(Clone, Copy, PartialEq)]
enum Scan {
    NotDue,
    Due,
    Ordered,
}

impl Search<'_> {
    /// Potentials over ordinary and lower-case edges, or a negative cycle of them.
    ///
    /// Bellman-Ford in rounds over the nodes that changed, each round in the order of the events as far as it is known:
    /// A. V. Goldberg, T. Radzik, *A heuristic improvement of the Bellman-Ford algorithm*, 1993. A sequence of any length,
    /// whatever the order of its nodes, then takes two rounds; and never are there more than without the order. Now and
    /// then the tree of last improvements is searched for a cycle, so a negative one is found about as soon as it exists.
    ///
    /// A contingent event comes at least its shortest duration after its activation. The searches need no such edge, but
    /// with it the potentials are in the order of the events across links too: links are then rarely begun anew, and
    /// potentials rarely repaired. It is left out where it would show, in an explanation or in the order of what is derived.
    pub(super) fn initial_potential(&mut self) -> Result<Option<Vec<Move>>, TooLarge> {
        let special = Rows::new(self.stnu.nodes, self.edges[self.lower_from..].iter().map(|edge| edge.to));
        let mut changed: Vec<u32> = (0..self.stnu.nodes).collect();
        let mut state = vec![Scan::Due; self.nodes.len()];
        let (mut rounds, mut next_look) = (0, 1);
        while !changed.is_empty() {
            let order = self.in_order(&special, &changed, &mut state);
            changed.clear();
            for to in order {
                state[to as usize] = Scan::NotDue;
                let potential = within_limit(self.node(to).potential)?;
                for at in 0..self.arcs_into(&special, to) {
                    let Incoming { from, edge, weight } = self.arc_into(&special, to, at);
                    let node = &mut self.nodes[from as usize];
                    let candidate = weight + potential;
                    if candidate < node.potential {
                        node.potential = candidate;
                        node.via = edge;
                        if state[from as usize] == Scan::NotDue {
                            state[from as usize] = Scan::Due;
                            changed.push(from);
                        }
                    }
                }
            }
            rounds += 1;
            if rounds == next_look {
                next_look += next_look / 4 + 1;
                if let Some(cycle) = self.cycle_of_improvements() {
                    return Ok(Some(cycle));
                }
            }
        }
        Ok(None)
    }

    /// The nodes that changed, and those they will or may change next, each before what it changes.
    ///
    /// That is a depth-first search along the edges that are tight or too short, which are those of the shortest paths
    /// as known so far. A cycle of such edges is cut somewhere: that costs rounds, not correctness.
    fn in_order(&self, special: &Rows, changed: &[u32], state: &mut [Scan]) -> Vec<u32> {
        let mut order = Vec::with_capacity(changed.len());
        // A node and how many of its edges have been followed.
        let mut open: Vec<(u32, usize)> = Vec::new();
        for &root in changed {
            if state[root as usize] == Scan::Ordered {
                continue;
            }
            state[root as usize] = Scan::Ordered;
            open.push((root, 0));
            while let Some((to, at)) = open.last_mut() {
                if *at == self.arcs_into(special, *to) {
                    order.push(*to);
                    open.pop();
                    continue;
                }
                let Incoming { from, weight, .. } = self.arc_into(special, *to, *at);
                *at += 1;
                let follow = weight + self.node(*to).potential <= self.node(from).potential;
                if follow && state[from as usize] != Scan::Ordered {
                    state[from as usize] = Scan::Ordered;
                    open.push((from, 0));
                }
            }
        }
        order.reverse();
        order
    }

    /// How many edges lead into a node: first the special ones (lower-case edges and those that links imply), then the
    /// ordinary ones.
    #[inline]
    fn arcs_into(&self, special: &Rows, node: u32) -> usize {
        special.of(node).len() + incoming_of(&self.incoming_at, node).len()
    }

    #[inline]
    fn arc_into(&self, special: &Rows, node: u32, at: usize) -> Incoming {
        match special.of(node).get(at) {
            Some(&special) => {
                let edge = self.lower_from as u32 + special;
                let Edge { from, weight, .. } = self.edges[edge as usize];
                Incoming { weight, from, edge }
            }
            None => self.incoming[self.incoming_at[node as usize] as usize + at - special.of(node).len()],
        }
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
