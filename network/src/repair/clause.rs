//! What a conflict says of the amounts by which knobs are turned: one of a few inequalities must hold.
//!
//! The sum of the cycle must not be negative: that is the first. There are other ways to be rid of it. A cycle that rests on a
//! negative way on from a contingent event (`Ahead`) is no reason when that is not negative any more. News that
//! tells nothing may be made to tell something, and uncertainty so small that late news tells nothing of it. An event that is
//! one with something heard late may be parted from it. Each of these is a linear inequality, too, and necessary for the way it stands for:
//! so the clause holds for every network that is controllable, wherever the conflict was found, as far as the reduction is exact.

use std::collections::{BTreeMap, BTreeSet};

use crate::blame::Tally;
use crate::conflict::Part;
use crate::controllability::negative_cycle_ahead;
use crate::merge::{Merged, merge, merge_but};
use crate::model::{ContingentLink, Delay, EventId, Network, Requirement};
use crate::program::Inequality;
use crate::reduce::{ReduceError, Reduction, reduce};
use crate::stnu::TooLarge;

use super::Turns;
use super::lever::{joins, roots, spread, way_to};

/// Alternatives: at least one holds.
pub(super) type Clause = Vec<Inequality>;

/// That a form grows by at least so much from a plan on.
fn beyond(plan: &Turns, terms: BTreeMap<usize, i64>, by: i64) -> Inequality {
    let here = Inequality { terms, least: 0 };
    Inequality { least: i128::from(by) - here.lacks(plan), ..here }
}

/// Which knob turns which bound.
pub(super) struct Levers {
    by_part: BTreeMap<Part, usize>,
    /// The links whose bounds or delays some knob turns.
    links: BTreeSet<usize>,
    /// The requirements of which some knob turns a bound, and that make events one. Where one of these is heard late, it is
    /// another model when they are parted.
    joins: BTreeSet<usize>,
    /// All others: what is heard at once can be followed at once, so they need not be made one.
    apart: BTreeSet<usize>,
}

impl Levers {
    /// Of a network and the bounds of each knob. A knob with a bound of one before has no part in clauses.
    pub(super) fn new<'a>(network: &Network, knobs: impl Iterator<Item = &'a [Part]>) -> Levers {
        let mut by_part = BTreeMap::new();
        for (number, parts) in knobs.enumerate() {
            if parts.iter().all(|part| !by_part.contains_key(part)) {
                by_part.extend(parts.iter().map(|part| (*part, number)));
            }
        }
        let links = by_part.keys().filter_map(|part| part.link()).collect();
        let class_of = merge(network).event_of;
        let late = |link: &&ContingentLink| link.delay != Delay::NONE;
        let late: BTreeSet<EventId> =
            network.contingents().iter().filter(late).map(|link| class_of[link.to.index()]).collect();
        let turned: BTreeSet<usize> = by_part.keys().filter_map(|part| requirement_of(*part)).collect();
        let (joins, apart) = turned.into_iter().filter(|index| joins(network, *index)).partition(|index| {
            let Requirement { from, to, .. } = network.requirements()[*index];
            let class = class_of[from.index()];
            class == class_of[to.index()] && late.contains(&class)
        });
        Levers { by_part, links, joins, apart }
    }

    /// True if turning knobs may make another model of the network.
    pub(super) fn part_events(&self) -> bool {
        !self.joins.is_empty()
    }

    /// That bounds of one link or delay stay in order. A shortest delay that is not changed follows the longest.
    pub(super) fn order(&self, network: &Network) -> Vec<Clause> {
        let mut order = Vec::new();
        for &index in &self.links {
            let link = network.contingents()[index];
            let both = |ends: [(Part, i64); 2], room: i64| {
                let are_turned = ends.iter().all(|(part, _)| self.by_part.contains_key(part));
                are_turned.then(|| Inequality { terms: self.terms(ends), least: -i128::from(room) })
            };
            let width = link.upper.as_micros() - link.lower.as_micros();
            order.extend(both(narrower(index), width).map(|row| vec![row]));
            // What is added to no end stays without end.
            let Some(max) = link.delay.max.finite() else { continue };
            let delay = [(Part::DelayMin(index), -1), (Part::DelayMax(index), -1)];
            let unchanged = Inequality { terms: self.terms([delay[0]]), least: 0 };
            let vary = max.as_micros() - link.delay.min.as_micros();
            order.extend(both(delay, vary).map(|row| vec![row, unchanged]));
        }
        order
    }

    /// What moving bounds to the easier side by so much each comes to, for the knobs that turn them.
    fn terms(&self, factors: impl IntoIterator<Item = (Part, i64)>) -> BTreeMap<usize, i64> {
        let mut terms = BTreeMap::new();
        for (part, factor) in factors {
            if let Some(&knob) = self.by_part.get(&part) {
                *terms.entry(knob).or_default() += factor;
            }
        }
        terms.retain(|_, factor| *factor != 0);
        terms
    }
}

/// What is known of a network with a plan carried out.
pub(super) enum Answer {
    Controllable,
    /// Of the plans of controllable networks; this one violates it.
    Not(Clause),
}

/// Asks for the verdict on `changed`, which is `original` with the plan carried out.
pub(super) fn ask(
    original: &Network,
    changed: &Network,
    levers: &Levers,
    plan: &Turns,
) -> Result<Answer, TooLarge> {
    let merged = merge_but(changed, &levers.apart);
    let site = Site { original, changed, merged: &merged, levers, plan };
    let alternatives = match reduce(&merged.network) {
        Err(ReduceError::TooLarge) => return Err(TooLarge),
        Err(ReduceError::Never(violation)) => {
            let tally = violation.tally(&merged.network)?;
            let mut clause = vec![site.not_negative(&tally)?];
            clause.extend(site.joined_otherwise(&tally));
            clause
        }
        Ok(reduction) => {
            let Some((cycle, ahead)) = negative_cycle_ahead(&reduction.stnu)? else {
                return Ok(Answer::Controllable);
            };
            let tally = reduction.tally(&merged.network, &cycle.steps);
            let mut clause = vec![site.not_negative(&tally)?];
            for way in &ahead {
                clause.push(site.not_negative(&reduction.tally(&merged.network, way))?);
            }
            clause.dedup();
            clause.extend(site.heard_otherwise(&tally, &reduction));
            clause.extend(site.joined_otherwise(&tally));
            clause
        }
    };
    // What holds already is no way out.
    let is_open = |it: &Inequality| !it.terms.is_empty() && it.lacks(plan) > 0;
    Ok(Answer::Not(alternatives.into_iter().filter(is_open).collect()))
}

/// Where a conflict was found.
struct Site<'a> {
    original: &'a Network,
    changed: &'a Network,
    merged: &'a Merged,
    levers: &'a Levers,
    plan: &'a Turns,
}

impl Site<'_> {
    /// That what is taken in all is not negative.
    fn not_negative(&self, tally: &Tally<'_>) -> Result<Inequality, TooLarge> {
        let mut factors: Vec<(Part, i64)> = Vec::new();
        for (&part, &times) in &tally.times {
            let part = match part {
                Part::RequirementUpper(index) => Part::RequirementUpper(self.merged.requirement_of[index]),
                Part::RequirementLower(index) => Part::RequirementLower(self.merged.requirement_of[index]),
                other => other,
            };
            factors.push((part, times));
            // A shortest delay follows the longest down.
            if let Part::DelayMin(link) = part
                && self.follows(link)
            {
                factors.push((Part::DelayMax(link), -times));
            }
        }
        Ok(beyond(self.plan, self.levers.terms(factors), tally.total()?.saturating_neg()))
    }

    /// True if the shortest delay of a link is moved by the longest one, or would be if that were any less.
    fn follows(&self, link: usize) -> bool {
        let is_changed =
            self.levers.by_part.get(&Part::DelayMin(link)).is_some_and(|it| self.plan.contains_key(it));
        let shortest = self.original.contingents()[link].delay.min;
        self.changed.contingents()[link]
            .delay
            .max
            .finite()
            .is_some_and(|longest| !is_changed && longest <= shortest)
    }

    /// That some news of the trees of links that are touched tells something where it does not, or nothing where it does.
    fn heard_otherwise(&self, tally: &Tally<'_>, reduction: &Reduction) -> Vec<Inequality> {
        if self.levers.links.is_empty() {
            return Vec::new();
        }
        let network = &self.merged.network;
        let roots = roots(network);
        let touched: BTreeSet<EventId> =
            tally.times.keys().filter_map(|part| part.link()).map(|link| roots[link]).collect();
        let mut alternatives = Vec::new();
        for &index in self.levers.links.iter().filter(|link| touched.contains(&roots[**link])) {
            let link = network.contingents()[index];
            let own = narrower(index);
            let news = [(Part::DelayMin(index), 1), (Part::DelayMax(index), 1)];
            let width = link.upper.as_micros() - link.lower.as_micros();
            let Some(max) = link.delay.max.finite() else {
                let terms = self.levers.terms([(Part::DelayMax(index), 1)]);
                alternatives.push(beyond(self.plan, terms, 1));
                continue;
            };
            // What Nature can choose between, less what the news leaves open.
            let vary = max.as_micros() - link.delay.min.as_micros();
            if reduction.places[link.to.index()].heard_by == Some(link.to) {
                // News at once tells everything there is to tell.
                if vary > 0 && own.iter().any(|(part, _)| self.levers.by_part.contains_key(part)) {
                    let terms = own.into_iter().chain(news).map(|(part, by)| (part, -by));
                    let terms = self.levers.terms(terms);
                    alternatives.push(beyond(self.plan, terms, width - vary));
                }
            } else {
                // A longest delay with the shortest at its heels leaves no less open.
                let varies = news.into_iter().filter(|_| !self.follows(index));
                let narrows = way_to(network, index).flat_map(narrower);
                let terms = self.levers.terms(varies.chain(narrows));
                alternatives.push(beyond(self.plan, terms, 1 - (spread(network, index) - vary)));
            }
        }
        alternatives
    }

    /// That events at which the conflict is are parted where they are one, or one where they were parted.
    fn joined_otherwise(&self, tally: &Tally<'_>) -> Vec<Inequality> {
        if self.levers.joins.is_empty() {
            return Vec::new();
        }
        let touched = touched(&self.merged.network, tally);
        let class = |event: EventId| self.merged.event_of[event.index()];
        let mut alternatives = Vec::new();
        for &index in &self.levers.joins {
            let requirement = self.original.requirements()[index];
            if ![requirement.from, requirement.to].iter().any(|event| touched.contains(&class(*event))) {
                continue;
            }
            let ends = [Part::RequirementLower(index), Part::RequirementUpper(index)];
            let is_one = joins(self.changed, index);
            let sign = if is_one { 1 } else { -1 };
            let terms = self.levers.terms(ends.map(|part| (part, sign)));
            alternatives.push(Inequality { terms, least: i128::from(is_one) });
        }
        alternatives
    }
}

/// The events of a merged network between which the bounds that are taken from hold.
fn touched(network: &Network, tally: &Tally<'_>) -> BTreeSet<EventId> {
    let mut touched = BTreeSet::new();
    for &part in tally.times.keys() {
        if let Some(index) = requirement_of(part) {
            let requirement = network.requirements()[index];
            touched.extend([requirement.from, requirement.to]);
        } else if let Some(index) = part.link() {
            let link = network.contingents()[index];
            touched.extend([link.from, link.to]);
        } else {
            touched.insert(network.origin());
        }
    }
    touched
}

/// How the width of a link changes when its ends become easier.
fn narrower(link: usize) -> [(Part, i64); 2] {
    [(Part::LinkLower(link), -1), (Part::LinkUpper(link), -1)]
}

fn requirement_of(part: Part) -> Option<usize> {
    match part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => Some(index),
        _ => None,
    }
}
