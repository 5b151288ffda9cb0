//! Events that leave no choice: ours to execute, and possible only a fixed time after another event.
//!
//! Nobody wrote that time down: it comes about because a lower and an upper bound meet. A plan with such an event holds
//! on paper and breaks with the smallest latency, since no moment after the earliest one will do.

use std::collections::BTreeMap;

use petgraph::unionfind::UnionFind;

use crate::conflict::{Part, Share};
use crate::controllability::{negative_cycle, solve};
use crate::dispatchable::Rigid;
use crate::merge::{Merged, merge};
use crate::model::{EventId, Network};
use crate::reduce::{ReduceError, Reduction, Source, reduce};
use crate::stnu::{Edge, NONE, TooLarge, add};
use crate::time::{Bound, Duration};

/// The events of a controllable network that can never be executed late.
#[derive(Debug)]
pub struct Punctuality {
    merged: Merged,
    reduction: Reduction,
    rigid: Rigid,
    /// What holds each other at fixed distances, the earliest first; only those that leave no choice.
    pub groups: Vec<Group>,
}

/// Events at fixed distances from a first one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The first event: the events of the network, not merged, that are it.
    pub first: Vec<EventId>,
    /// True if the first event is the moment of acting on the news of a contingent event.
    pub news: bool,
    /// The others that are ours to execute and whose distance nobody wrote down, in time order.
    pub others: Vec<Exact>,
    first_node: u32,
}

/// An event that can be executed only so long after the first of its group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exact {
    /// The events of the network, not merged, that are it.
    pub events: Vec<EventId>,
    /// How long after the first event.
    pub after: Duration,
    node: u32,
}

/// Finds them; `None` if the network is not controllable.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn punctual(network: &Network) -> Result<Option<Punctuality>, TooLarge> {
    let merged = merge(network);
    let reduction = match reduce(&merged.network) {
        Ok(reduction) => reduction,
        Err(ReduceError::TooLarge) => return Err(TooLarge),
        Err(ReduceError::Never(_)) => return Ok(None),
    };
    let stnu = &reduction.stnu;
    let Some(solution) = solve(stnu)? else { return Ok(None) };
    let mut edges = stnu.edges.clone();
    edges.extend(solution.derived);
    let rigid = Rigid::new(stnu, &edges, &solution.potential);
    let mut by_leader: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for node in 0..stnu.nodes {
        by_leader.entry(rigid.leader[node as usize]).or_default().push(node);
    }
    by_leader.retain(|_, nodes| nodes.len() > 1);
    let mut written = written(&merged.network, &reduction);
    let ending = stnu.link_ending_at();
    let is_ours = |node: u32| node != 0 && ending[node as usize] == NONE;
    let mut originals: Vec<Vec<EventId>> = vec![Vec::new(); merged.network.events().len()];
    if !by_leader.is_empty() {
        for event in network.event_ids() {
            originals[merged.event_of[event.index()].index()].push(event);
        }
    }
    let events_at = |node: u32| originals[reduction.event_of[node as usize].index()].clone();
    let mut groups = Vec::new();
    for (leader, mut nodes) in by_leader {
        nodes.sort_by_key(|&node| (rigid.offset[node as usize], node != leader, node));
        let mut others = Vec::new();
        for &node in nodes.iter().filter(|&&node| node != leader) {
            // What is at a written distance from what was said already goes without saying.
            if written.union(leader, node) && is_ours(node) {
                let after = Duration::from_micros(rigid.offset[node as usize]);
                others.push(Exact { events: events_at(node), after, node });
            }
        }
        if !others.is_empty() {
            let news = ending[leader as usize] != NONE;
            groups.push(Group { first: events_at(leader), news, others, first_node: leader });
        }
    }
    Ok(Some(Punctuality { merged, reduction, rigid, groups }))
}

impl Punctuality {
    /// The bounds that together leave the event no choice; their amounts add up to 0. In terms of `network`, which
    /// must be the one this was found in. `None` if that is so in the worst case only: if news of varying delay, which
    /// has to be reckoned with at its worst, may say more in time.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub fn because(
        &self,
        group: &Group,
        event: &Exact,
        network: &Network,
    ) -> Result<Option<Vec<Share>>, TooLarge> {
        let (first, node, after) = (group.first_node, event.node, event.after.as_micros());
        // To come a moment later, or a moment earlier, is impossible: why?
        let later = Edge { from: node, to: first, weight: add(-after, -1)? };
        let earlier = Edge { from: first, to: node, weight: add(after, -1)? };
        let mut shares: BTreeMap<Part, Share> = BTreeMap::new();
        for edge in [later, earlier] {
            let mut tried = self.reduction.clone();
            tried.stnu.edges.push(edge);
            tried.sources.push(Source::AfterOrigin);
            let Some(cycle) = negative_cycle(&tried.stnu)? else { return Ok(None) };
            let conflict = self.merged.unmerge(&tried.conflict(&self.merged.network, &cycle)?, network);
            for share in conflict.members {
                let known =
                    shares.entry(share.part).or_insert(Share { times: 0, amount: Duration::ZERO, ..share });
                known.times += share.times;
                known.amount =
                    Duration::from_micros(add(known.amount.as_micros(), share.amount.as_micros())?);
            }
        }
        let shares: Vec<Share> = shares.into_values().collect();
        Ok((!shares.iter().any(|share| self.may_be_told(share, node, network))).then_some(shares))
    }

    /// True if the share speaks of an end that may be known better, by the time of the node, than at the worst.
    fn may_be_told(&self, share: &Share, node: u32, network: &Network) -> bool {
        let Some(index) = share.part.link() else { return false };
        let link = network.contingents()[index];
        let start = self.reduction.places[self.merged.event_of[link.from.index()].index()].node;
        let rigid = |node: u32| (self.rigid.leader[node as usize], self.rigid.offset[node as usize]);
        let begins_later = rigid(start).0 == rigid(node).0 && rigid(start).1 >= rigid(node).1;
        link.delay.max != Bound::Finite(link.delay.min) && !begins_later
    }
}

/// Classes of nodes at distances that a single constraint says.
fn written(merged: &Network, reduction: &Reduction) -> UnionFind<u32> {
    let mut written = UnionFind::new(reduction.stnu.nodes as usize);
    let node = |event: EventId| reduction.places[event.index()].node;
    for requirement in merged.requirements() {
        if requirement.lower.finite().is_some() && requirement.lower == requirement.upper {
            written.union(node(requirement.from), node(requirement.to));
        }
    }
    written
}
