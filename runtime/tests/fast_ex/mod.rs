//! FAST-EX: the scheduler of the original Delay Kirk, as a second opinion and as a baseline to measure against.
//!
//! L. Hunsberger, *A faster execution algorithm for dynamically controllable STNUs*, TIME 2013; algorithms 2 and 3 of the
//! thesis. After every event it brings the distances to and from the origin up to date for the whole AllMax graph
//! (ordinary and upper-case edges), by Dijkstra on the distances of before as potentials.

#![allow(dead_code, unreachable_pub, reason = "a test and a benchmark use different parts of it")]

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An edge of the AllMax graph: `to - from <= weight`; with a label, only until that contingent event has happened.
#[derive(Clone, Copy)]
pub struct AllMaxEdge {
    pub from: usize,
    pub to: usize,
    pub weight: i64,
    pub label: Option<usize>,
}

/// An execution in progress. Event `origin` is executed at 0.
pub struct FastEx {
    into: Vec<Vec<AllMaxEdge>>,
    out_of: Vec<Vec<AllMaxEdge>>,
    executed: Vec<Option<i64>>,
    /// D(X, Z): minus the earliest time of X.
    to_origin: Vec<i64>,
    /// D(Z, X): the latest time of X.
    from_origin: Vec<i64>,
}

const FAR: i64 = i64::MAX / 4;

impl FastEx {
    /// Starts with the origin executed.
    pub fn new(events: usize, origin: usize, edges: &[AllMaxEdge]) -> FastEx {
        let mut into = vec![Vec::new(); events];
        let mut out_of = vec![Vec::new(); events];
        for &edge in edges {
            into[edge.to].push(edge);
            out_of[edge.from].push(edge);
        }
        let mut state = FastEx {
            into,
            out_of,
            executed: vec![None; events],
            to_origin: vec![0; events],
            from_origin: vec![FAR; events],
        };
        // The first distances by Bellman-Ford: there is nothing to reduce the weights by yet.
        let mut changed = true;
        while changed {
            changed = false;
            for edge in edges {
                let candidate = edge.weight + state.to_origin[edge.to];
                if candidate < state.to_origin[edge.from] {
                    state.to_origin[edge.from] = candidate;
                    changed = true;
                }
            }
        }
        state.execute(origin, 0);
        state
    }

    /// An event happens; everything is brought up to date.
    pub fn execute(&mut self, event: usize, now: i64) {
        self.executed[event] = Some(now);
        let executed = self.executed.clone();
        let holds = |edge: &AllMaxEdge| edge.label.is_none_or(|label| executed[label].is_none());
        let potential = self.to_origin.clone();
        let reduced = |edge: &AllMaxEdge| edge.weight + potential[edge.to] - potential[edge.from];
        // To the origin: an executed event is at its time, nothing else comes before now.
        let mut distance = vec![FAR; self.executed.len()];
        let mut queue = BinaryHeap::new();
        for at in 0..distance.len() {
            distance[at] = -executed[at].unwrap_or(now);
            queue.push(Reverse((distance[at] - potential[at], at)));
        }
        while let Some(Reverse((key, at))) = queue.pop() {
            if key > distance[at] - potential[at] {
                continue;
            }
            for edge in self.into[at].iter().filter(|edge| holds(edge)) {
                assert!(reduced(edge) >= 0, "Dijkstra has met a negative edge");
                let candidate = distance[at] + edge.weight;
                if executed[edge.from].is_none() && candidate < distance[edge.from] {
                    distance[edge.from] = candidate;
                    queue.push(Reverse((candidate - potential[edge.from], edge.from)));
                }
            }
        }
        // From the origin.
        let mut latest = vec![FAR; self.executed.len()];
        for at in 0..latest.len() {
            if let Some(time) = executed[at] {
                latest[at] = time;
                queue.push(Reverse((time + potential[at], at)));
            }
        }
        while let Some(Reverse((key, at))) = queue.pop() {
            if key > latest[at] + potential[at] {
                continue;
            }
            for edge in self.out_of[at].iter().filter(|edge| holds(edge)) {
                let candidate = latest[at] + edge.weight;
                if executed[edge.to].is_none() && candidate < latest[edge.to] {
                    latest[edge.to] = candidate;
                    queue.push(Reverse((candidate + potential[edge.to], edge.to)));
                }
            }
        }
        self.to_origin = distance;
        self.from_origin = latest;
    }

    /// The real-time execution decision: which of these events is next, and when.
    pub fn next(&self, ours: impl Iterator<Item = usize>) -> Option<(i64, usize)> {
        ours.filter(|&event| self.executed[event].is_none())
            .map(|event| (-self.to_origin[event], event))
            .min()
    }

    /// The latest time an event may be executed.
    pub fn latest(&self, event: usize) -> i64 {
        self.from_origin[event]
    }
}
