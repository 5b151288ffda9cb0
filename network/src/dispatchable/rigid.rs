//! Groups of nodes at fixed distances from one another.

use std::cmp::Reverse;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::stnu::{Edge, NONE, Stnu};

/// Groups of nodes at fixed distances from one another, each with a leader: its earliest node.
#[derive(Debug)]
pub(crate) struct Rigid {
    pub(crate) leader: Vec<u32>,
    /// How long after its leader a node comes.
    pub(crate) offset: Vec<i64>,
}

impl Rigid {
    /// The groups of these edges; the potentials must fit.
    pub(crate) fn new(stnu: &Stnu, edges: &[Edge], potential: &[i64]) -> Rigid {
        // On a cycle of weight 0 every edge is tight, and every cycle of tight edges has weight 0.
        let tight = edges
            .iter()
            .filter(|edge| potential[edge.from as usize] == edge.weight + potential[edge.to as usize]);
        let mut graph: DiGraph<(), ()> = DiGraph::with_capacity(stnu.nodes as usize, 0);
        for _ in 0..stnu.nodes {
            graph.add_node(());
        }
        for edge in tight {
            graph.add_edge(NodeIndex::new(edge.from as usize), NodeIndex::new(edge.to as usize), ());
        }
        let ending = stnu.link_ending_at();
        let mut rigid = Rigid { leader: (0..stnu.nodes).collect(), offset: vec![0; stnu.nodes as usize] };
        for group in kosaraju_scc(&graph) {
            let nodes = group.iter().map(|node| node.index());
            // t_v - t_leader = potential(leader) - potential(v). A contingent event leads before what is simultaneous.
            let leader =
                nodes.clone().max_by_key(|&node| (potential[node], ending[node] != NONE, Reverse(node)));
            let Some(leader) = leader else { continue };
            for node in nodes {
                rigid.leader[node] = leader as u32;
                rigid.offset[node] = potential[leader] - potential[node];
            }
        }
        rigid
    }

    /// Of the nodes that could lead a group, one of Nature's still does, else that of the least rank.
    pub(super) fn lead_by<R: Ord>(&mut self, rank: impl Fn(u32) -> R, stnu: &Stnu) {
        let ending = stnu.link_ending_at();
        let mut first: Vec<u32> = (0..stnu.nodes).collect();
        for node in 0..stnu.nodes {
            let leader = self.leader[node as usize];
            if self.offset[node as usize] == 0 && ending[leader as usize] == NONE {
                let first = &mut first[leader as usize];
                let less = (rank(node), node) < (rank(*first), *first);
                *first = if less { node } else { *first };
            }
        }
        self.leader.iter_mut().for_each(|leader| *leader = first[*leader as usize]);
    }

    /// True if a node is the leader of its group, as are nodes that are alone.
    pub(super) fn leads(&self, node: u32) -> bool {
        self.leader[node as usize] == node
    }

    /// The edges between leaders, sorted, the tightest of each pair.
    pub(super) fn contracted(&self, edges: &[Edge]) -> Vec<Edge> {
        let mut contracted = Vec::with_capacity(edges.len());
        for edge in edges {
            let (from, to) = (self.leader[edge.from as usize], self.leader[edge.to as usize]);
            if from != to {
                let shift = self.offset[edge.from as usize] - self.offset[edge.to as usize];
                contracted.push(Edge { from, to, weight: edge.weight + shift });
            }
        }
        contracted.sort_unstable_by_key(|edge| (edge.from, edge.to, edge.weight));
        contracted.dedup_by_key(|edge| (edge.from, edge.to));
        contracted
    }

    /// For each node its leader, if that comes at the same time.
    pub(super) fn simultaneous(&self) -> Vec<u32> {
        let leads = |node: usize| self.leader[node] as usize != node && self.offset[node] == 0;
        (0..self.leader.len()).map(|node| if leads(node) { self.leader[node] } else { NONE }).collect()
    }

    /// The edges that hold each node at its distance from its leader.
    pub(super) fn spokes(&self) -> impl Iterator<Item = Edge> {
        self.leader.iter().zip(&self.offset).enumerate().flat_map(|(node, (&leader, &offset))| {
            let node = node as u32;
            let both = [
                Edge { from: leader, to: node, weight: offset },
                Edge { from: node, to: leader, weight: -offset },
            ];
            both.into_iter().filter(move |_| node != leader)
        })
    }
}
