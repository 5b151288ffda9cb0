//! When each event can happen in an execution that keeps the guarantee: nothing happens outside of its window.
//!
//! An execution may do what the dispatchable network leaves open, and nothing else keeps the guarantee. Once Nature has
//! chosen, that network is a simple temporal network (P. Morris, *Dynamic controllability and dispatchability
//! relationships*, 2014), whose earliest and latest times are shortest paths from and to the origin (R. Dechter, I. Meiri,
//! J. Pearl, *Temporal constraint networks*, 1991). What must come before a contingent event comes so early even if Nature takes
//! the least, and what must come after it so late even if she takes the most. So every event is earliest when all links take
//! their least and nothing is put off, and latest when all take their most and everything is.
//!
//! News that is late by more or less may be used in cleverer ways than the dispatchable network does. But nobody can do more
//! than with news that always comes at its earliest, and of that the network is exact.

use std::collections::VecDeque;

use crate::check::{Verdict, check};
use crate::dispatchable::{Consequences, consequences};
use crate::merge::merge;
use crate::model::{Delay, Network};
use crate::reduce::{Reduction, Whereabouts, reduce};
use crate::stnu::{Edge, Link, Rows, Stnu, add};
use crate::time::Time;

/// The times at which an event can happen while the guarantee is kept.
///
/// Where no news is late, or all is equally late and in no chain, both ends are reached if Nature and we choose so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Not before this.
    pub earliest: Time,
    /// Not after this; `None` if nothing limits it.
    pub latest: Option<Time>,
}

/// The window of every event; `None` if the network is not controllable, or the numbers are too large.
pub fn windows(network: &Network) -> Option<Vec<Window>> {
    if check(network) != Ok(Verdict::Controllable) {
        return None;
    }
    let mut merged = merge(network);
    hear_early(&mut merged.network);
    let windows = of_reduction(&reduce(&merged.network).ok()?)?;
    Some(merged.event_of.iter().map(|event| windows[event.index()]).collect())
}

/// The windows of the events of the network that was reduced; `None` if it is not controllable, or the numbers are too large.
pub(crate) fn of_reduction(reduction: &Reduction) -> Option<Vec<Window>> {
    let stnu = &reduction.stnu;
    let followed = consequences(stnu).ok()??;
    let least = shortest(stnu, &projected(stnu, &followed, |link| link.lower), Direction::ToOrigin)?;
    let most = shortest(stnu, &projected(stnu, &followed, |link| link.upper), Direction::FromOrigin)?;
    let window = |place: &Whereabouts| {
        let earliest = add(-least[place.node as usize]?, place.earliest.as_micros()).ok()?;
        let latest = match most[place.node as usize] {
            Some(latest) => Some(Time::from_micros(add(latest, place.latest.as_micros()).ok()?)),
            None => None,
        };
        Some(Window { earliest: Time::from_micros(earliest), latest })
    };
    reduction.places.iter().map(window).collect()
}

/// All news comes as early as it can; in chains, of which the reduction is not exact, at once.
pub(crate) fn hear_early(network: &mut Network) {
    for (index, chained) in is_chained(network).into_iter().enumerate() {
        let delay = &mut network.link_mut(index).delay;
        *delay = if chained { Delay::NONE } else { Delay { min: delay.min, max: delay.min.into() } };
    }
}

/// For every link: another one starts where it ends, or it starts where another one ends.
pub(crate) fn is_chained(network: &Network) -> Vec<bool> {
    let mut chained = vec![false; network.contingents().len()];
    for (index, link) in network.contingents().iter().enumerate() {
        if let Some(above) = network.link_of(link.from) {
            (chained[index], chained[above]) = (true, true);
        }
    }
    chained
}

/// What is to be kept once Nature has chosen so for every link.
fn projected(stnu: &Stnu, followed: &Consequences, choice: fn(&Link) -> i64) -> Vec<Edge> {
    let chosen = stnu.links.iter().flat_map(|link| {
        let Link { activation, contingent, .. } = *link;
        [
            Edge { from: activation, to: contingent, weight: choice(link) },
            Edge { from: contingent, to: activation, weight: -choice(link) },
        ]
    });
    // A wait ends when its contingent event happens.
    let waits = followed.waits.iter().map(|wait| {
        let link = stnu.links[wait.link as usize];
        Edge { from: wait.waiter, to: link.activation, weight: wait.weight.max(-choice(&link)) }
    });
    followed.edges.iter().copied().chain(chosen).chain(waits).collect()
}

#[derive(Clone, Copy, PartialEq)]
enum Direction {
    FromOrigin,
    ToOrigin,
}

/// Bellman-Ford with a queue; `None` if a sum is too large. Of a controllable network no cycle is negative.
fn shortest(stnu: &Stnu, edges: &[Edge], direction: Direction) -> Option<Vec<Option<i64>>> {
    let ends = |edge: &Edge| match direction {
        Direction::FromOrigin => (edge.from, edge.to),
        Direction::ToOrigin => (edge.to, edge.from),
    };
    let outgoing = Rows::new(stnu.nodes, edges.iter().map(|edge| ends(edge).0));
    let mut distance = vec![None; stnu.nodes as usize];
    let mut queued = vec![false; stnu.nodes as usize];
    let mut open = VecDeque::from([0_u32]);
    distance[0] = Some(0);
    while let Some(node) = open.pop_front() {
        queued[node as usize] = false;
        let Some(here) = distance[node as usize] else { continue };
        for &edge in outgoing.of(node) {
            let edge = &edges[edge as usize];
            let next = ends(edge).1 as usize;
            let there = add(here, edge.weight).ok()?;
            if distance[next].is_none_or(|known| there < known) {
                distance[next] = Some(there);
                if !std::mem::replace(&mut queued[next], true) {
                    open.push_back(next as u32);
                }
            }
        }
    }
    Some(distance)
}
