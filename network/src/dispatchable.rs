//! The dispatchable form of a controllable STNU: a network that can be executed by looking at direct neighbours only.
//!
//! N. Muscettola, P. Morris, I. Tsamardinos, *Reformulating temporal plans for efficient execution*, 1998, carried over
//! to STNUs: P. Morris, *Dynamic controllability and dispatchability relationships*, 2014; L. Hunsberger, R. Posenato,
//! *A faster algorithm for converting STNUs into dispatchable form*, 2023. In three steps:
//! 1. the check leaves the edges to activations and the waits ([`crate::controllability`]);
//! 2. an event that must come before a contingent one must come before it even if Nature takes the least;
//! 3. of the all-pairs shortest paths (`hierarchy.rs`) only those stay that no other edge makes needless, rigid
//!    groups first.

mod implied;
mod rigid;

use std::collections::VecDeque;

use crate::controllability::{Solution, Wait, solve};
use crate::hierarchy::{Hierarchy, Path};
use crate::model::EventId;
use crate::precedence::Precedence;
use crate::reduce::Reduction;
use crate::stnu::{Edge, Link, Rows, Stnu, TooLarge};
use implied::implied_by_links;
pub(crate) use rigid::Rigid;

/// A dispatchable network: ordinary edges, and waits for contingent events.
///
/// Executing X at t, each edge X -> Y of weight w >= 0 says Y comes at `t + w` at the latest, each edge Y -> X of
/// weight w < 0 says Y comes at `t - w` at the earliest, and not before X (see also [`Dispatchable::holds`]). A wait (Y, C:w, A) says Y comes after A, and
/// until C has happened not before `A - w`.
#[derive(Clone, Debug)]
pub struct Dispatchable {
    /// The number of nodes; node 0 is the origin.
    pub nodes: u32,
    /// The contingent links, those of the network it was made from.
    pub links: Vec<Link>,
    /// The ordinary edges, by source, then target.
    pub edges: Vec<Edge>,
    /// The waits.
    pub waits: Vec<Wait>,
    /// For each node the node at whose time it is always executed, and after which; [`crate::stnu::NONE`] for most.
    pub simultaneous: Vec<u32>,
    /// Pairs (later, earlier), where no edge holds the later one: it is not begun before the other is done, even where their
    /// times may be equal or keep them apart ([`Precedence`]).
    pub follows: Vec<(u32, u32)>,
}

impl Dispatchable {
    /// True if the source of the edge must not be executed before its target: its weight is negative, or the two are
    /// simultaneous and the target leads.
    pub fn holds(&self, edge: &Edge) -> bool {
        edge.weight < 0 || self.simultaneous[edge.from as usize] == edge.to
    }
}

/// Makes a network dispatchable; `None` if it is not controllable. No edge is needless.
///
/// Only the check can find the numbers too large: what follows from a controllable network stays within its horizon or
/// says nothing (`Stnu::horizon`).
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn dispatchable(
    reduction: &Reduction,
    precedence: &Precedence,
) -> Result<Option<Dispatchable>, TooLarge> {
    let stnu = &reduction.stnu;
    let Some(Consequences { mut edges, waits, potential }) = consequences(stnu)? else { return Ok(None) };
    let mut rigid = Rigid::new(stnu, &edges, &potential);
    // The origin is executed first.
    let rank = |node: u32| (node != 0, precedence.rank[reduction.event_of[node as usize].index()]);
    rigid.lead_by(rank, stnu);
    // What Nature keeps by herself helps to make other edges needless, and is needless itself.
    let nature = rigid.contracted(&nature_keeps(stnu));
    edges.extend(nature_keeps(stnu));
    let mut kept = undominated(&rigid.contracted(&edges), &potential);
    kept.retain(|edge| {
        nature.binary_search_by_key(&(edge.from, edge.to), |known| (known.from, known.to)).is_err()
    });
    kept.extend(rigid.spokes());
    kept.sort_unstable_by_key(|edge| (edge.from, edge.to));
    // The others are held at their distance from their leader, which waits for them; and what comes after a contingent
    // event in any case does not wait for it.
    let needed = |wait: &Wait| {
        let comes_after = wait.weight < -stnu.links[wait.link as usize].upper;
        rigid.leads(wait.waiter) && !comes_after
    };
    let waits = waits.into_iter().filter(needed).collect();
    let mut net = Dispatchable {
        nodes: stnu.nodes,
        links: stnu.links.clone(),
        edges: kept,
        waits,
        simultaneous: rigid.simultaneous(),
        follows: Vec::new(),
    };
    net.follows = follows(&net, reduction, precedence);
    Ok(Some(net))
}

/// Of all that follows, what no edge holds. What has been executed has not to be waited for.
///
/// Nothing waits for itself in the end: round a cycle of holds the distances add up to 0 at most, so they are 0 and all its
/// nodes simultaneous; and among those the leader is of the least rank, and ranks order what follows.
fn follows(net: &Dispatchable, reduction: &Reduction, precedence: &Precedence) -> Vec<(u32, u32)> {
    let held = |later: u32, earlier: u32| {
        let known = net.edges.binary_search_by_key(&(later, earlier), |edge| (edge.from, edge.to));
        known.is_ok_and(|at| net.holds(&net.edges[at]))
    };
    let node = |event: EventId| reduction.places[event.index()].node;
    let pairs = precedence.follows.iter().map(|&(later, earlier)| (node(later), node(earlier)));
    pairs.filter(|&(later, earlier)| later != 0 && earlier != 0 && !held(later, earlier)).collect()
}

/// All that follows from a controllable network, with what is in it: nothing else is to be kept in an execution.
pub(crate) struct Consequences {
    /// Ordinary edges, those of the network first.
    pub(crate) edges: Vec<Edge>,
    pub(crate) waits: Vec<Wait>,
    /// Potentials that fit the edges, and the links if each takes its least.
    pub(crate) potential: Vec<i64>,
}

/// What follows from a network; `None` if it is not controllable.
pub(crate) fn consequences(stnu: &Stnu) -> Result<Option<Consequences>, TooLarge> {
    let Some(Solution { derived, waits, potential }) = solve(stnu)? else { return Ok(None) };
    let potential = fit(&when_nature_takes_the_least(stnu, &derived), potential);
    let mut edges = stnu.edges.clone();
    edges.extend(implied_by_links(stnu, derived, &potential));
    Ok(Some(Consequences { edges, waits, potential }))
}

/// All edges if every link takes its least: what fits these fits everything that follows from the network.
fn when_nature_takes_the_least(stnu: &Stnu, derived: &[Edge]) -> Vec<Edge> {
    let both = |link: &Link| {
        [
            Edge { from: link.activation, to: link.contingent, weight: link.lower },
            Edge { from: link.contingent, to: link.activation, weight: -link.lower },
        ]
    };
    stnu.edges.iter().chain(derived).copied().chain(stnu.links.iter().flat_map(both)).collect()
}

/// `C - A` is in `[x, y]` for each link (A, x, y, C).
fn nature_keeps(stnu: &Stnu) -> Vec<Edge> {
    let both = |link: &Link| {
        [
            Edge { from: link.activation, to: link.contingent, weight: link.upper },
            Edge { from: link.contingent, to: link.activation, weight: -link.lower },
        ]
    };
    stnu.links.iter().flat_map(both).collect()
}

/// Lowers potentials until they fit all edges: Bellman-Ford from what is almost right. There must be no negative cycle.
fn fit(edges: &[Edge], mut potential: Vec<i64>) -> Vec<i64> {
    let incoming = Rows::new(potential.len() as u32, edges.iter().map(|edge| edge.to));
    let mut open: VecDeque<u32> = (0..potential.len() as u32).collect();
    let mut queued = vec![true; potential.len()];
    while let Some(node) = open.pop_front() {
        queued[node as usize] = false;
        let here = potential[node as usize];
        for &edge in incoming.of(node) {
            let Edge { from, weight, .. } = edges[edge as usize];
            if weight + here < potential[from as usize] {
                potential[from as usize] = weight + here;
                if !std::mem::replace(&mut queued[from as usize], true) {
                    open.push_back(from);
                }
            }
        }
    }
    potential
}

/// Of all shortest paths those that no other makes needless. There must be no cycle of weight 0.
///
/// From a source u, a node v at a distance d(v) >= 0 is needless if a shortest path to it passes a node w with
/// d(w) <= d(v); one at a distance < 0 if a shortest path to it passes a node w with d(w) < 0.
fn undominated(edges: &[Edge], potential: &[i64]) -> Vec<Edge> {
    let hierarchy = Hierarchy::new(edges, potential);
    let mut kept = Vec::new();
    hierarchy.all_paths(|from, to, Path { distance, least }| {
        let needless = if distance >= 0 { least <= distance } else { least < 0 };
        if !needless {
            kept.push(Edge { from, to, weight: distance });
        }
    });
    kept
}
