//! The team as one network: events that are one made one, joints of nobody composed away, requirements as single bounds.
//!
//! Events joined by [0, 0] become one only within one owner, or with the origin: across agents that is two requirements, which each
//! agent keeps with what it knows. A joint that nobody executes only says that a moment exists; it exists whenever all ways through
//! it are kept (J. Fourier, 1826; in a temporal network that is the sum of each bound before and each after).

use std::collections::{BTreeMap, BTreeSet};

use kirk_network::merge::{Merged, merge_but};
use kirk_network::stnu::TooLarge;
use kirk_network::{
    Bound, Conflict, ContingentLink, Duration, EventId, Network, Part, Requirement, Share, Verdict, check,
};

use crate::model::{AgentId, Team};

/// `to - from <= weight`, in microseconds.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub(crate) from: EventId,
    pub(crate) to: EventId,
    pub(crate) weight: i64,
    /// The bounds of the merged network that it is the sum of.
    pub(crate) parts: Vec<Part>,
}

/// A team made ready. Events are those of the merged network; joints of nobody are in no side.
#[derive(Clone, Debug)]
pub(crate) struct Whole {
    pub(crate) merged: Merged,
    /// By event; `None` for the origin and for joints of nobody.
    pub(crate) owner: Vec<Option<AgentId>>,
    /// At most one from one event to another, in order.
    pub(crate) sides: Vec<Side>,
}

impl Whole {
    pub(crate) fn new(team: &Team) -> Whole {
        let network = team.network();
        let merged = merge_but(network, &across_agents(team));
        let mut owner = vec![None; merged.network.events().len()];
        for event in network.event_ids() {
            let class = merged.event_of[event.index()];
            if class != merged.network.origin() && team.owner(event).is_some() {
                owner[class.index()] = team.owner(event);
            }
        }
        let sides = sides(&merged.network, &owner);
        Whole { merged, owner, sides }
    }

    pub(crate) fn origin(&self) -> EventId {
        self.merged.network.origin()
    }

    /// The contingent link that ends in an event.
    pub(crate) fn link_to(&self, event: EventId) -> Option<&ContingentLink> {
        Some(&self.merged.network.contingents()[self.merged.network.link_of(event)?])
    }

    /// The executable event at which the links to an event begin.
    pub(crate) fn root(&self, event: EventId) -> EventId {
        let mut at = event;
        while let Some(link) = self.link_to(at) {
            at = link.from;
        }
        at
    }

    /// The whole as one executive with the same observations would have it. No event is a join of two owners' any more.
    pub(crate) fn network(&self) -> Network {
        let merged = &self.merged.network;
        let requirements = self.sides.iter().map(Side::requirement).collect();
        let network = merged.with(requirements, merged.contingents().to_vec());
        network.unwrap_or_else(|errors| unreachable!("the bounds of a valid network make one: {errors:?}"))
    }

    /// True if Nature alone violates no requirement: those that nobody could keep hold by themselves. Only a "no" that is too careful
    /// leaves that to be asked.
    pub(crate) fn nature_is_kind(&self) -> bool {
        let nobody = |event: EventId| {
            let root = self.root(event);
            root == self.origin()
        };
        let merged = &self.merged.network;
        let requirements = self.sides.iter().filter(|side| nobody(side.from) && nobody(side.to));
        let alone = merged.with(requirements.map(Side::requirement).collect(), merged.contingents().to_vec());
        alone.is_ok_and(|alone| check(&alone) == Ok(Verdict::Controllable))
    }

    /// Why the team cannot do it even if everybody heard everything at once, in terms of the team's network.
    pub(crate) fn conflict(&self, original: &Network) -> Result<Option<Conflict>, TooLarge> {
        let Verdict::Uncontrollable(found) = check(&self.network())? else { return Ok(None) };
        let mut times: BTreeMap<Part, u32> = BTreeMap::new();
        for share in &found.members {
            match share.part {
                Part::RequirementUpper(side) => {
                    for &part in &self.sides[side].parts {
                        *times.entry(part).or_default() += share.times;
                    }
                }
                part => *times.entry(part).or_default() += share.times,
            }
        }
        let merged = &self.merged.network;
        let member = |(&part, &times): (&Part, &u32)| Share {
            part,
            times,
            amount: part.signed(merged).saturating_mul(i64::from(times)),
        };
        let members = times.iter().map(member).collect();
        Ok(Some(self.merged.unmerge(&Conflict { members, ..found }, original)))
    }
}

impl Side {
    pub(crate) fn requirement(&self) -> Requirement {
        let upper = Bound::Finite(Duration::from_micros(self.weight));
        Requirement { from: self.from, to: self.to, lower: Bound::Infinite, upper }
    }
}

/// The [0, 0] requirements between events of two owners, neither of which is tied to the origin.
fn across_agents(team: &Team) -> BTreeSet<usize> {
    let network = team.network();
    let joins: Vec<(usize, EventId, EventId)> = (network.requirements().iter().enumerate())
        .filter(|(_, it)| it.is_join())
        .map(|(index, it)| (index, it.from, it.to))
        .collect();
    let mut tied = vec![false; network.events().len()];
    tied[network.origin().index()] = true;
    let mut neighbours: Vec<Vec<EventId>> = vec![Vec::new(); network.events().len()];
    for &(_, from, to) in &joins {
        neighbours[from.index()].push(to);
        neighbours[to.index()].push(from);
    }
    let mut open = vec![network.origin()];
    while let Some(event) = open.pop() {
        for &next in &neighbours[event.index()] {
            if network.link_of(next).is_none() && !std::mem::replace(&mut tied[next.index()], true) {
                open.push(next);
            }
        }
    }
    let is_apart = |&&(_, from, to): &&(usize, EventId, EventId)| {
        let both_tied = tied[from.index()] && tied[to.index()];
        !both_tied && team.owner(from) != team.owner(to)
    };
    joins.iter().filter(is_apart).map(|&(index, ..)| index).collect()
}

/// The sides of all requirements, with the joints of nobody composed away.
fn sides(network: &Network, owner: &[Option<AgentId>]) -> Vec<Side> {
    let mut composer = Composer { ways: vec![BTreeMap::new(); network.events().len()], into: Vec::new() };
    composer.into = vec![BTreeSet::new(); network.events().len()];
    for (index, requirement) in network.requirements().iter().enumerate() {
        let parts = [Part::RequirementUpper(index), Part::RequirementLower(index)];
        for (edge, part) in requirement.edges().into_iter().zip(parts) {
            if let Some((from, to, weight)) = edge {
                composer.add(from, to, weight.as_micros(), vec![part]);
            }
        }
    }
    let is_joint = |event: &EventId| {
        owner[event.index()].is_none() && *event != network.origin() && network.link_of(*event).is_none()
    };
    let mut joints: Vec<EventId> = network.event_ids().filter(is_joint).collect();
    for &joint in &joints {
        composer.add(joint, network.origin(), 0, vec![Part::AfterOrigin]);
    }
    // Those with the fewest ways first: that leaves few sums.
    while let Some(at) = (0..joints.len()).min_by_key(|&at| composer.degree(joints[at])) {
        composer.remove(joints.swap_remove(at), network.origin());
    }
    let sides = composer.ways.into_iter().enumerate().flat_map(|(from, ways)| {
        let side = move |(to, (weight, parts))| Side { from: EventId(from as u32), to, weight, parts };
        ways.into_iter().map(side)
    });
    sides.collect()
}

/// A distance graph with at most one edge from one event to another, from which events are taken out.
struct Composer {
    ways: Vec<BTreeMap<EventId, (i64, Vec<Part>)>>,
    into: Vec<BTreeSet<EventId>>,
}

impl Composer {
    fn add(&mut self, from: EventId, to: EventId, weight: i64, parts: Vec<Part>) {
        // From an event to itself there is something to say only if that cannot be.
        if from == to && weight >= 0 {
            return;
        }
        self.into[to.index()].insert(from);
        let slot = self.ways[from.index()].entry(to);
        slot.and_modify(|known| {
            if weight < known.0 {
                *known = (weight, parts.clone());
            }
        })
        .or_insert((weight, parts));
    }

    fn degree(&self, event: EventId) -> usize {
        self.ways[event.index()].len() * self.into[event.index()].len()
    }

    fn remove(&mut self, joint: EventId, origin: EventId) {
        let onward = std::mem::take(&mut self.ways[joint.index()]);
        for &to in onward.keys() {
            self.into[to.index()].remove(&joint);
        }
        // A contradiction of the joint with itself stays one, at the origin.
        if let Some((weight, parts)) = onward.get(&joint) {
            self.add(origin, origin, *weight, parts.clone());
        }
        for from in std::mem::take(&mut self.into[joint.index()]) {
            let Some((before, parts)) = self.ways[from.index()].remove(&joint) else { continue };
            for (&to, (after, more)) in onward.iter().filter(|(to, _)| **to != joint) {
                // That nothing comes before the origin goes without saying.
                let sum = before.saturating_add(*after);
                if to != origin || sum < 0 {
                    self.add(from, to, sum, [&parts[..], &more[..]].concat());
                }
            }
        }
    }
}
