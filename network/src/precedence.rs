//! Precedence: what must not come before what, as it is written. It orders what may happen at one time.
//!
//! That `later - earlier >= 0` is required says more than times can: at equal times `earlier` still comes first. Events that
//! are written to precede one another, which makes them one moment, have no order among them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::model::{EventId, Network, Requirement};
use crate::stnu::Rows;
use crate::time::Duration;

/// What must not come before what. It is found once for a network, and holds for whatever is left of its execution.
#[derive(Clone, Debug)]
pub struct Precedence {
    /// For every event its place among those of one time, as in a record.
    order: Vec<u32>,
    /// For every event a number, less than that of any other event that must not come before it, and the same for events
    /// that are written to be one moment. As if nothing were said of the origin, so that what has to be at time zero is in
    /// order too.
    pub(crate) rank: Vec<u32>,
    /// Pairs (later, earlier) of executable events: the later one is not begun before the earlier one is done. Without what
    /// follows from other pairs.
    pub(crate) follows: Vec<(EventId, EventId)>,
}

impl Precedence {
    /// What is written in a network, and that no link ends before it begins.
    pub fn new(network: &Network) -> Precedence {
        let origin = network.origin().index() as u32;
        let mut pairs = pairs(network);
        pairs.retain(|&(later, earlier)| later != origin && earlier != origin);
        let rank = ranks(network.events().len() as u32, &pairs, |event| event);
        let follows = follows(network, pairs, &rank);
        Precedence { order: precedence(network, |event| event.0), rank, follows }
    }

    /// A number for an event, less than that of any other that must not come before it.
    pub fn order(&self, event: EventId) -> u32 {
        self.order[event.index()]
    }
}

/// Nature cannot be held: what follows an event of hers follows what should have come before that too.
fn follows(network: &Network, mut pairs: Vec<(u32, u32)>, rank: &[u32]) -> Vec<(EventId, EventId)> {
    let natures = |event: u32| network.link_of(EventId(event)).is_some();
    pairs.retain(|&(later, earlier)| rank[later as usize] != rank[earlier as usize]);
    // All that comes before an event is known when it is its turn.
    pairs.sort_unstable_by_key(|&(later, earlier)| (rank[later as usize], later, earlier));
    pairs.dedup();
    // What follows an event follows all that are one moment with it.
    let moments = Rows::new(rank.len() as u32, rank.iter().copied());
    let mut follows = Vec::new();
    // For each event of Nature's what should have come before.
    let mut behind: Vec<Vec<u32>> = vec![Vec::new(); rank.len()];
    let mut before = Vec::new();
    for (later, earlier) in pairs {
        before.clear();
        for &at in moments.of(rank[earlier as usize]) {
            before.extend_from_slice(&behind[at as usize]);
            before.push(at);
        }
        before.retain(|&at| !natures(at));
        if natures(later) {
            behind[later as usize].extend_from_slice(&before);
        } else {
            follows.extend(before.iter().map(|&at| (EventId(later), EventId(at))));
        }
    }
    follows.sort_unstable();
    follows.dedup();
    follows
}

/// For every event of a network a number, less than that of any other event that must not come before it. Where nothing is
/// written, the one whose `key` is less gets the lesser number, as far as that goes.
pub fn precedence(network: &Network, key: impl Fn(EventId) -> u32) -> Vec<u32> {
    let mut pairs = pairs(network);
    // Nothing comes before the origin.
    let origin = network.origin().index() as u32;
    pairs.extend((0..network.events().len() as u32).map(|event| (event, origin)));
    ranks(network.events().len() as u32, &pairs, |event| key(EventId(event)))
}

/// The pairs (later, earlier) of events of which a requirement says that one must not come before the other.
pub fn written_pairs(network: &Network) -> impl Iterator<Item = (EventId, EventId)> {
    let edges = network.requirements().iter().flat_map(Requirement::edges).flatten();
    edges.filter(|&(.., weight)| weight <= Duration::ZERO).map(|(later, earlier, _)| (later, earlier))
}

/// The same, and that Nature takes no time back.
fn pairs(network: &Network) -> Vec<(u32, u32)> {
    let links = network.contingents().iter().map(|link| (link.to, link.from));
    written_pairs(network).chain(links).map(|(later, earlier)| (later.0, earlier.0)).collect()
}

/// A number for every node, less than that of any later one: a topological order of the strongly connected components, each
/// of which has one number.
fn ranks(nodes: u32, pairs: &[(u32, u32)], key: impl Fn(u32) -> u32) -> Vec<u32> {
    let graph: DiGraph<(), ()> = {
        let mut graph = DiGraph::with_capacity(nodes as usize, pairs.len());
        (0..nodes).for_each(|_| {
            graph.add_node(());
        });
        pairs.iter().for_each(|&(later, earlier)| {
            graph.add_edge(NodeIndex::new(earlier as usize), NodeIndex::new(later as usize), ());
        });
        graph
    };
    let mut component = vec![0; nodes as usize];
    let mut first = Vec::new();
    for (index, members) in kosaraju_scc(&graph).into_iter().enumerate() {
        let nodes = members.iter().map(|node| node.index());
        nodes.clone().for_each(|node| component[node] = index as u32);
        first.push(nodes.map(|node| key(node as u32)).min().unwrap_or(u32::MAX));
    }
    let between: Vec<(u32, u32)> = pairs
        .iter()
        .map(|&(later, earlier)| (component[later as usize], component[earlier as usize]))
        .filter(|(later, earlier)| later != earlier)
        .collect();
    // A. B. Kahn, 1962; the heap makes the order depend on the keys alone, not on how the components are numbered.
    let following = Rows::new(first.len() as u32, between.iter().map(|&(_, earlier)| earlier));
    let mut behind = vec![0_u32; first.len()];
    between.iter().for_each(|&(later, _)| behind[later as usize] += 1);
    let entry = |component: usize| Reverse((first[component], component as u32));
    let mut open: BinaryHeap<_> =
        (0..first.len()).filter(|&component| behind[component] == 0).map(entry).collect();
    let mut rank = vec![0; first.len()];
    let mut next = 0;
    while let Some(Reverse((_, component))) = open.pop() {
        rank[component as usize] = next;
        next += 1;
        for &pair in following.of(component) {
            let later = between[pair as usize].0 as usize;
            behind[later] -= 1;
            if behind[later] == 0 {
                open.push(entry(later));
            }
        }
    }
    component.into_iter().map(|component| rank[component as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::ranks;

    #[test]
    fn what_is_later_has_the_greater_rank_and_keys_decide_the_rest() {
        assert_eq!(ranks(4, &[], |node| 3 - node), [3, 2, 1, 0]);
        assert_eq!(ranks(4, &[(0, 3), (1, 0)], |node| node), [2, 3, 0, 1]);
        // One moment has one rank.
        assert_eq!(ranks(4, &[(0, 1), (1, 0), (3, 1), (0, 2)], |node| node), [1, 1, 0, 2]);
    }
}
