//! Precedence: what must not come before what, as it is written. It orders what may happen at one time.
//!
//! That `later - earlier >= 0` is required says more than times can: at equal times `earlier` still comes first. Events that
//! are written to precede one another, which makes them one moment, have no order among them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::model::{EventId, Network, Requirement};
use crate::stnu::{Rows, Stnu};
use crate::time::Duration;

/// For every event of a network a number, less than that of any other event that must not come before it. Where nothing is
/// written, the one whose `key` is less gets the lesser number, as far as that goes.
pub fn precedence(network: &Network, key: impl Fn(EventId) -> u32) -> Vec<u32> {
    let mut pairs: Vec<(u32, u32)> = written_pairs(network)
        .map(|(later, earlier)| (later.index() as u32, earlier.index() as u32))
        .collect();
    // Nothing comes before the origin, and Nature takes no time back.
    let origin = network.origin().index() as u32;
    pairs.extend((0..network.events().len() as u32).map(|event| (event, origin)));
    pairs.extend(network.contingents().iter().map(|link| (link.to.index() as u32, link.from.index() as u32)));
    ranks(network.events().len() as u32, &pairs, |event| key(EventId(event)))
}

/// The pairs (later, earlier) of events of which a requirement says that one must not come before the other.
pub fn written_pairs(network: &Network) -> impl Iterator<Item = (EventId, EventId)> {
    let edges = network.requirements().iter().flat_map(Requirement::edges).flatten();
    edges.filter(|&(.., weight)| weight <= Duration::ZERO).map(|(later, earlier, _)| (later, earlier))
}

/// The pairs (later, earlier) of nodes of which one must not come before the other.
pub(crate) fn written(stnu: &Stnu) -> Vec<(u32, u32)> {
    let edges = stnu.edges.iter().filter(|edge| edge.weight <= 0).map(|edge| (edge.from, edge.to));
    edges.chain(stnu.links.iter().map(|link| (link.contingent, link.activation))).collect()
}

/// A number for every node, less than that of any later one: a topological order of the strongly connected components, each
/// of which has one number.
pub(crate) fn ranks(nodes: u32, pairs: &[(u32, u32)], key: impl Fn(u32) -> u32) -> Vec<u32> {
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
