//! Joins the events that a [0, 0] requirement makes one.
//!
//! Merging is a modelling act and comes before everything else: a start merged with the end of a contingent link *is*
//! that end, so it needs no decision. Unmerged, "start exactly at the true end" of something heard late would be
//! impossible. An event that is fixed by someone else (the origin, a contingent event) is never merged with another
//! such event: that requirement stays, and the controllability check says what is wrong with it.

use std::collections::{BTreeMap, BTreeSet};

use petgraph::unionfind::UnionFind;

use crate::conflict::{Conflict, Part, Share};
use crate::model::{ContingentLink, Event, EventId, ModelError, Name, Network, Requirement};
use crate::time::Duration;

/// A network in which no [0, 0] requirement is left that could be merged away, and the way back to the one it is from.
#[derive(Clone, Debug)]
pub struct Merged {
    /// The merged network; its contingent links are those of the original, in the same order.
    pub network: Network,
    /// For every event of the original, the event it became part of.
    pub event_of: Vec<EventId>,
    /// For every requirement of `network`, the index of the requirement it was in the original.
    pub requirement_of: Vec<usize>,
    /// The joins as a forest over the original events: for each event the next one towards the root of its tree.
    joins: Vec<Option<Join>>,
}

#[derive(Clone, Copy, Debug)]
struct Join {
    towards: EventId,
    requirement: usize,
}

/// Merges the events joined by [0, 0] requirements (union-find). Every name is kept.
pub fn merge(network: &Network) -> Merged {
    merge_but(network, &BTreeSet::new())
}

/// The same, but some requirements, by index, are left to be requirements.
pub fn merge_but(network: &Network, apart: &BTreeSet<usize>) -> Merged {
    // A join that would let a contingent link lead back to its own start is left out. Looking for that is quadratic
    // in long chains, and almost no network has one, so look only if the quick way runs into it.
    merge_with(network, apart, Caution::Quick).unwrap_or_else(|_| {
        merge_with(network, apart, Caution::KeepLinksAcyclic)
            .unwrap_or_else(|errors| unreachable!("merging keeps a network valid: {errors:?}"))
    })
}

#[derive(Clone, Copy, PartialEq)]
enum Caution {
    Quick,
    KeepLinksAcyclic,
}

fn merge_with(
    network: &Network,
    apart: &BTreeSet<usize>,
    caution: Caution,
) -> Result<Merged, Vec<ModelError>> {
    let count = network.events().len();
    let mut classes = Classes::new(network);
    let mut tree: Vec<Vec<Join>> = vec![Vec::new(); count];
    for (index, requirement) in network.requirements().iter().enumerate() {
        if requirement.is_join()
            && !apart.contains(&index)
            && (caution == Caution::Quick || !classes.would_close_a_cycle(network, requirement))
            && classes.join(requirement.from, requirement.to)
        {
            let Requirement { from, to, .. } = *requirement;
            tree[from.index()].push(Join { towards: to, requirement: index });
            tree[to.index()].push(Join { towards: from, requirement: index });
        }
    }
    let mut event_of = vec![EventId(u32::MAX); count];
    let mut events: Vec<Event> = Vec::with_capacity(count);
    // The names of those that become one.
    let mut names_of: BTreeMap<usize, Vec<Name>> = BTreeMap::new();
    for event in network.event_ids() {
        let names = &network.events()[event.index()].names;
        let root = classes.root(event).index();
        if event_of[root].0 == u32::MAX {
            event_of[root] = EventId(events.len() as u32);
            events.push(Event { names: names.clone() });
        } else {
            let class = event_of[root].index();
            names_of.entry(class).or_insert_with(|| events[class].names.to_vec()).extend_from_slice(names);
        }
        event_of[event.index()] = event_of[root];
    }
    for (class, names) in names_of {
        events[class].names = names.into();
    }
    let mut requirements = Vec::with_capacity(network.requirements().len());
    let mut requirement_of = Vec::with_capacity(network.requirements().len());
    for (index, requirement) in network.requirements().iter().enumerate() {
        let (from, to) = (event_of[requirement.from.index()], event_of[requirement.to.index()]);
        // Between one event and itself a requirement says nothing, or it contradicts the joins and must stay.
        if from != to || !contains_zero(requirement) {
            requirements.push(Requirement { from, to, ..*requirement });
            requirement_of.push(index);
        }
    }
    let contingents = network
        .contingents()
        .iter()
        .map(|link| ContingentLink {
            from: event_of[link.from.index()],
            to: event_of[link.to.index()],
            ..*link
        })
        .collect();
    let origin = event_of[network.origin().index()];
    let merged =
        Network::with_known_names(network.name().to_string(), origin, events, requirements, contingents)?;
    Ok(Merged { network: merged, event_of, requirement_of, joins: root_forest(&tree) })
}

impl Merged {
    /// The conflict of the merged network in terms of `original`, with the joins it rests on.
    pub fn unmerge(&self, conflict: &Conflict, original: &Network) -> Conflict {
        let mut members = Vec::new();
        // The events of the original at which the constraints of the conflict meet.
        let mut touched: Vec<EventId> = Vec::new();
        for share in &conflict.members {
            let part = match share.part {
                Part::RequirementUpper(index) => Part::RequirementUpper(self.requirement_of[index]),
                Part::RequirementLower(index) => Part::RequirementLower(self.requirement_of[index]),
                other => other,
            };
            match (part, part.ends(original)) {
                (Part::Join(_), _) => {}
                (Part::DelayMin(_) | Part::DelayMax(_), Some((_, to))) => touched.push(to),
                (_, Some((from, to))) => touched.extend([from, to]),
                (_, None) => touched.push(original.origin()),
            }
            members.push(Share { part, ..*share });
        }
        let joins = self.joins_between(&touched);
        members.extend(joins.into_iter().map(|requirement| Share {
            part: Part::Join(requirement),
            times: 1,
            amount: Duration::ZERO,
        }));
        members.sort_by_key(|share| share.part);
        Conflict { members, ..*conflict }
    }

    /// The joins on the paths between those of `events` that became one event, in order.
    fn joins_between(&self, events: &[EventId]) -> Vec<usize> {
        let path_up = |event: EventId| {
            std::iter::successors(self.joins[event.index()], |join| self.joins[join.towards.index()])
                .map(|join| join.requirement)
        };
        // In the union of the paths to the root, a join that every touched event of the class passes leads nowhere.
        let mut used: Vec<usize> = Vec::new();
        let mut sorted: Vec<EventId> = events.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        sorted.sort_by_key(|event| self.event_of[event.index()]);
        for class in sorted.chunk_by(|a, b| self.event_of[a.index()] == self.event_of[b.index()]) {
            let mut passes: Vec<usize> = class.iter().flat_map(|&event| path_up(event)).collect();
            passes.sort_unstable();
            used.extend(
                passes.chunk_by(|a, b| a == b).filter(|run| run.len() < class.len()).map(|run| run[0]),
            );
        }
        used.sort_unstable();
        used
    }
}

fn contains_zero(requirement: &Requirement) -> bool {
    requirement.lower.finite().is_none_or(|lower| lower <= Duration::ZERO)
        && requirement.upper.finite().is_none_or(|upper| upper >= Duration::ZERO)
}

/// Turns an undirected forest into parent pointers.
fn root_forest(tree: &[Vec<Join>]) -> Vec<Option<Join>> {
    let mut parents = vec![None; tree.len()];
    let mut seen = vec![false; tree.len()];
    let mut open = Vec::new();
    for root in 0..tree.len() {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        open.push(root);
        while let Some(event) = open.pop() {
            for join in &tree[event] {
                let child = join.towards.index();
                if !seen[child] {
                    seen[child] = true;
                    parents[child] =
                        Some(Join { towards: EventId(event as u32), requirement: join.requirement });
                    open.push(child);
                }
            }
        }
    }
    parents
}

/// Classes of events, each with at most one that is not ours to place.
struct Classes {
    sets: UnionFind<u32>,
    /// The event of each class (by its root) that is the origin or contingent.
    given: Vec<Option<EventId>>,
}

impl Classes {
    fn new(network: &Network) -> Classes {
        let given = network
            .event_ids()
            .map(|event| (event == network.origin() || network.link_of(event).is_some()).then_some(event))
            .collect();
        Classes { sets: UnionFind::new(network.events().len()), given }
    }

    fn root(&mut self, event: EventId) -> EventId {
        EventId(self.sets.find_mut(event.0))
    }

    /// Joins two classes; false if they are one already or would hold two events that are not ours to place.
    fn join(&mut self, a: EventId, b: EventId) -> bool {
        let given = [self.root(a), self.root(b)].map(|root| self.given[root.index()]);
        if matches!(given, [Some(_), Some(_)]) || !self.sets.union(a.0, b.0) {
            return false;
        }
        let root = self.root(a);
        self.given[root.index()] = given[0].or(given[1]);
        true
    }

    /// True if, with the two ends of `requirement` joined, a contingent link would lead back to its own start.
    fn would_close_a_cycle(&mut self, network: &Network, requirement: &Requirement) -> bool {
        let (a, b) = (self.root(requirement.from), self.root(requirement.to));
        [(a, b), (b, a)].into_iter().any(|(start, other)| {
            let mut class = start;
            while let Some(link) = self.given[class.index()].and_then(|event| network.link_of(event)) {
                class = self.root(network.contingents()[link].from);
                if class == start || class == other {
                    return true;
                }
            }
            false
        })
    }
}
