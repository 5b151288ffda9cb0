//! When each event can happen at all: the window of its times in the schedules that keep every bound.
//!
//! The network is read as an STN, Nature's bounds like ours and news as if it came at once (R. Dechter, I. Meiri,
//! J. Pearl, *Temporal constraint networks*, 1991): the windows are shortest paths from and to the origin. Nothing that
//! can be executed lies outside of them; not every time inside need be reachable, as Nature has a say.

use std::collections::VecDeque;

use crate::model::Network;
use crate::stnu::{Rows, add};
use crate::time::{Bound, Time};

/// The times at which an event can happen, from the origin on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Not before this.
    pub earliest: Time,
    /// Not after this; `None` if nothing limits it.
    pub latest: Option<Time>,
}

/// The window of every event; `None` if no schedule keeps every bound, or the numbers are too large.
pub fn windows(network: &Network) -> Option<Vec<Window>> {
    let edges = edges(network);
    let origin = network.origin().index();
    let count = network.events().len();
    // From an event back to the origin: no event comes before it, which is a path of length 0.
    let earliest = shortest(count, &edges, vec![Some(0); count], Direction::Backward)?;
    let mut start = vec![None; count];
    start[origin] = Some(0);
    let latest = shortest(count, &edges, start, Direction::Forward)?;
    // Every event leads back to the origin, so a cycle is found on the way there, also one that needs "not before it".
    if earliest[origin] != Some(0) {
        return None;
    }
    let window = |(early, late): (&Option<i64>, &Option<i64>)| Window {
        earliest: early.map_or(Time::ZERO, |distance| Time::from_micros(-distance)),
        latest: late.map(Time::from_micros),
    };
    Some(earliest.iter().zip(&latest).map(window).collect())
}

/// `to - from <= weight`.
struct Edge {
    from: u32,
    to: u32,
    weight: i64,
}

fn edges(network: &Network) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(2 * (network.requirements().len() + network.contingents().len()));
    for requirement in network.requirements() {
        let (from, to) = (requirement.from.0, requirement.to.0);
        if let Bound::Finite(upper) = requirement.upper {
            edges.push(Edge { from, to, weight: upper.as_micros() });
        }
        if let Bound::Finite(lower) = requirement.lower {
            edges.push(Edge { from: to, to: from, weight: -lower.as_micros() });
        }
    }
    for link in network.contingents() {
        let (from, to) = (link.from.0, link.to.0);
        edges.push(Edge { from, to, weight: link.upper.as_micros() });
        edges.push(Edge { from: to, to: from, weight: -link.lower.as_micros() });
    }
    edges
}

#[derive(Clone, Copy, PartialEq)]
enum Direction {
    Forward,
    Backward,
}

/// Bellman-Ford with a queue; `None` if a cycle is negative or a sum too large.
fn shortest(
    count: usize,
    edges: &[Edge],
    mut distance: Vec<Option<i64>>,
    direction: Direction,
) -> Option<Vec<Option<i64>>> {
    let ends = |edge: &Edge| match direction {
        Direction::Forward => (edge.from, edge.to),
        Direction::Backward => (edge.to, edge.from),
    };
    let outgoing = Rows::new(count as u32, edges.iter().map(|edge| ends(edge).0));
    let mut open: VecDeque<u32> =
        (0..count as u32).filter(|&event| distance[event as usize].is_some()).collect();
    let mut queued: Vec<bool> = distance.iter().map(Option::is_some).collect();
    // How many edges the path has that led here: as many as there are events is a cycle.
    let mut length = vec![0_u32; count];
    while let Some(event) = open.pop_front() {
        queued[event as usize] = false;
        let Some(here) = distance[event as usize] else { continue };
        for &edge in outgoing.of(event) {
            let edge = &edges[edge as usize];
            let next = ends(edge).1 as usize;
            let there = add(here, edge.weight).ok()?;
            if distance[next].is_none_or(|known| there < known) {
                distance[next] = Some(there);
                length[next] = length[event as usize] + 1;
                if length[next] as usize > count {
                    return None;
                }
                if !std::mem::replace(&mut queued[next], true) {
                    open.push_back(next as u32);
                }
            }
        }
    }
    Some(distance)
}
