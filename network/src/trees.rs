//! The contingent links of a network as trees: which events only Nature places relative to one another.

use crate::model::{ContingentLink, EventId, Network};
use crate::stnu::{TooLarge, add};
use crate::time::Duration;

/// The contingent links as trees: the root of each is executable.
#[derive(Clone, Debug)]
pub(crate) struct Trees {
    /// Contingent events, every one after its activation.
    pub(crate) parents_first: Vec<EventId>,
    root: Vec<EventId>,
    depth: Vec<u32>,
    /// Children at a fixed distance, in order.
    twins: Vec<Vec<EventId>>,
}

impl Trees {
    /// The trees of the links of a network.
    pub(crate) fn new(network: &Network) -> Result<Trees, TooLarge> {
        let count = network.events().len();
        let mut trees = Trees {
            parents_first: Vec::with_capacity(network.contingents().len()),
            root: network.event_ids().collect(),
            depth: vec![0; count],
            twins: vec![Vec::new(); count],
        };
        let mut done: Vec<bool> = network.event_ids().map(|event| network.link_of(event).is_none()).collect();
        let mut longest = 0_i64;
        for link in network.contingents() {
            longest = add(longest, link.upper.as_micros())?;
            let mut path = Vec::new();
            let mut event = link.to;
            while !done[event.index()] {
                path.push(event);
                event = link_to(network, event).from;
            }
            for event in path.into_iter().rev() {
                let link = link_to(network, event);
                let parent = link.from;
                done[event.index()] = true;
                trees.parents_first.push(event);
                trees.root[event.index()] = trees.root[parent.index()];
                trees.depth[event.index()] = trees.depth[parent.index()] + 1;
                if network.link_of(parent).is_some() && link.lower == link.upper {
                    trees.twins[parent.index()].push(event);
                }
            }
        }
        Ok(trees)
    }

    /// The group of `root`: itself and all that follow it at a fixed distance, with that distance.
    pub(crate) fn twins_of(&self, network: &Network, root: EventId) -> Vec<(EventId, i64)> {
        let mut group = vec![(root, 0)];
        let mut at = 0;
        while at < group.len() {
            let (event, offset) = group[at];
            for &child in &self.twins[event.index()] {
                group.push((child, offset + link_to(network, child).lower.as_micros()));
            }
            at += 1;
        }
        group
    }

    /// The lowest common ancestor of two events of one tree.
    pub(crate) fn lowest_common_ancestor(
        &self,
        network: &Network,
        mut a: EventId,
        mut b: EventId,
    ) -> EventId {
        while a != b {
            if self.depth[a.index()] < self.depth[b.index()] {
                std::mem::swap(&mut a, &mut b);
            }
            a = link_to(network, a).from;
        }
        a
    }

    /// The most `to` can come after `from`, if that is Nature's choice alone: both in one tree of links.
    pub(crate) fn nature_alone(
        &self,
        network: &Network,
        from: EventId,
        to: EventId,
    ) -> Result<Option<i64>, TooLarge> {
        if self.root[from.index()] != self.root[to.index()] {
            return Ok(None);
        }
        let meet = self.lowest_common_ancestor(network, from, to);
        let sum = |mut event: EventId, bound: fn(&ContingentLink) -> Duration| {
            let mut sum = 0;
            while event != meet {
                let link = link_to(network, event);
                sum = add(sum, bound(link).as_micros())?;
                event = link.from;
            }
            Ok(sum)
        };
        Ok(Some(add(sum(to, |link| link.upper)?, -sum(from, |link| link.lower)?)?))
    }
}

pub(crate) fn link_index(network: &Network, contingent: EventId) -> usize {
    match network.link_of(contingent) {
        Some(index) => index,
        None => unreachable!("only contingent events are asked for their link"),
    }
}

pub(crate) fn link_to(network: &Network, contingent: EventId) -> &ContingentLink {
    &network.contingents()[link_index(network, contingent)]
}
