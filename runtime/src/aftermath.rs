//! What becomes of the requirements once Nature has broken the model: what is broken, what has to be given up, what is kept.

use kirk_network::left::{Seen, SoFar, can_be_kept, given_up};
use kirk_network::{Duration, EventId, Interval, Network, Part, Time};

use crate::dispatcher::Dispatcher;
use crate::execution::{Aftermath, Lost, Side};

/// What becomes of the bounds of all requirements, from how far an execution has got. `truth`: when events truly happened, where
/// that is known.
pub(crate) fn aftermath(dispatcher: &Dispatcher, so_far: &SoFar, truth: &[Option<Time>]) -> Aftermath {
    let network = dispatcher.network();
    let guaranteed = can_be_kept(network, so_far);
    // Where that is too large to be computed with, nothing is sure.
    let parts = if guaranteed { Some(Vec::new()) } else { given_up(network, so_far).ok() };
    let judge = Judge { dispatcher, so_far, truth };
    let mut all =
        Aftermath { guaranteed, violated: Vec::new(), in_doubt: Vec::new(), given_up: Vec::new(), kept: 0 };
    for index in 0..network.requirements().len() {
        for part in [Part::RequirementLower(index), Part::RequirementUpper(index)] {
            // An infinite bound is none.
            let Some(at_first) = lost(network, part, None) else { continue };
            match judge.length(part) {
                Some((nearest, farthest)) if !keeps(at_first.bound, at_first.value, farthest) => {
                    if keeps(at_first.bound, at_first.value, nearest) {
                        all.in_doubt.extend(lost(network, part, Some(farthest)));
                    } else {
                        all.violated.extend(lost(network, part, Some(nearest)));
                    }
                }
                _ if parts.as_ref().is_none_or(|parts| parts.contains(&part)) => all.given_up.push(at_first),
                _ => all.kept += 1,
            }
        }
    }
    all
}

fn keeps(side: Side, bound: Duration, length: Duration) -> bool {
    match side {
        Side::Lower => length >= bound,
        Side::Upper => length <= bound,
    }
}

fn lost(network: &Network, part: Part, found: Option<Duration>) -> Option<Lost> {
    let (bound, index) = match part {
        Part::RequirementLower(index) => (Side::Lower, index),
        Part::RequirementUpper(index) => (Side::Upper, index),
        _ => return None,
    };
    let requirement = network.requirements()[index];
    let value = if bound == Side::Lower { requirement.lower } else { requirement.upper }.finite()?;
    let name = |event: EventId| network.label(event).to_string();
    Some(Lost { from: name(requirement.from), to: name(requirement.to), bound, value, found })
}

struct Judge<'a> {
    dispatcher: &'a Dispatcher,
    so_far: &'a SoFar,
    truth: &'a [Option<Time>],
}

impl Judge<'_> {
    /// How long it was between the events of a requirement, at best and at worst for one of its bounds; `None` if that is still to be
    /// decided, or is as the model says.
    fn length(&self, part: Part) -> Option<(Duration, Duration)> {
        let network = self.dispatcher.network();
        let (Part::RequirementLower(index) | Part::RequirementUpper(index)) = part else { return None };
        let requirement = network.requirements()[index];
        let (from, to) = (requirement.from, requirement.to);
        let (root, other) = (self.dispatcher.root(from), self.dispatcher.root(to));
        let alone = root == other;
        if alone && !self.is_broken(root) {
            return None;
        }
        let (from, to) = (self.happened(from, alone)?, self.happened(to, alone)?);
        let shortest = to.earliest.checked_since(from.latest)?;
        let longest = to.latest.checked_since(from.earliest)?;
        Some(if part == Part::RequirementUpper(index) { (shortest, longest) } else { (longest, shortest) })
    }

    /// True if news of the tree of links that begins there has broken the model.
    fn is_broken(&self, root: EventId) -> bool {
        let mut events = self.dispatcher.network().event_ids();
        events.any(|event| self.dispatcher.root(event) == root && self.dispatcher.is_overruled(event))
    }

    /// Where an event was, or if Nature alone decides, will be.
    fn happened(&self, event: EventId, alone: bool) -> Option<Interval> {
        match (self.so_far.events[event.index()], self.truth.get(event.index()).copied().flatten()) {
            (Seen::Executed(time), _) => Some(Interval::at(time)),
            (Seen::Nature { .. }, Some(truth)) if truth <= self.so_far.now || self.is_decided(event) => {
                Some(Interval::at(truth))
            }
            (Seen::Nature { happened, .. }, None) if alone || self.is_decided(event) => Some(happened),
            _ => None,
        }
    }

    /// True if nothing that is still to come moves an event: it has happened as far as the plan is concerned, or will at a fixed
    /// distance from what has.
    fn is_decided(&self, event: EventId) -> bool {
        let network = self.dispatcher.network();
        let mut at = event;
        loop {
            match (self.so_far.events[at.index()], network.link_of(at)) {
                (Seen::Executed(_) | Seen::Nature { settled: true, .. }, _) => return true,
                (Seen::Nature { .. }, Some(link)) => {
                    let link = network.contingents()[link];
                    if link.lower < link.upper {
                        return false;
                    }
                    at = link.from;
                }
                _ => return false,
            }
        }
    }
}
