//! What a negative cycle of the plain STNU takes from each bound of the network it was reduced from.

use std::collections::BTreeMap;

use crate::conflict::{Conflict, Part, Share};
use crate::controllability::{Cycle, Step};
use crate::model::{EventId, Network};
use crate::reduce::{News, Place, Reduction, Source};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};
use crate::trees::{Trees, link_index};

impl Source {
    pub(crate) fn part(self) -> Part {
        match self {
            Source::Upper(index) => Part::RequirementUpper(index),
            Source::Lower(index) => Part::RequirementLower(index),
            Source::AfterOrigin => Part::AfterOrigin,
        }
    }
}

impl Reduction {
    /// What a negative cycle of the plain STNU says of the network it is from.
    pub fn conflict(&self, network: &Network, cycle: &Cycle) -> Result<Conflict, TooLarge> {
        let trees = Trees::new(network)?;
        let mut tally = Tally::default();
        let mut conservative = false;
        for &(step, times) in &cycle.steps {
            match step {
                Step::Edge(edge) => {
                    let source = self.sources[edge as usize];
                    conservative |= tally.requirement(network, &self.places, &trees, source, times);
                }
                Step::Lower(link) => {
                    conservative |= self.tally_link(network, &trees, link, true, times, &mut tally)
                }
                Step::Upper(link) => {
                    conservative |= self.tally_link(network, &trees, link, false, times, &mut tally)
                }
            }
        }
        Ok(tally.conflict(network, conservative))
    }

    fn tally_link(
        &self,
        network: &Network,
        trees: &Trees,
        link: u32,
        lower: bool,
        times: i64,
        tally: &mut Tally,
    ) -> bool {
        let root = self.event_of[self.stnu.links[link as usize].contingent as usize];
        let place = self.places[root.index()];
        let driver = self.driver(network, trees, root);
        if lower {
            tally.earliest(network, &self.places, trees, place.base, times);
            tally.path_times(network, place.base, root, Part::LinkLower, times);
            tally.path_times(network, root, driver, Part::LinkLower, times);
            tally.add(Part::DelayMax(link_index(network, driver)), -times);
        } else {
            tally.latest(network, &self.places, trees, place.base, times);
            tally.path_times(network, place.base, root, Part::LinkUpper, times);
            tally.path_times(network, root, driver, Part::LinkUpper, times);
            tally.add(Part::DelayMin(link_index(network, driver)), -times);
        }
        place.inexact
    }

    /// The event whose news stands for the group of `root`.
    pub fn driver(&self, network: &Network, trees: &Trees, root: EventId) -> EventId {
        driver_in(&self.places, network, trees, root)
    }
}

fn driver_in(places: &[Place], network: &Network, trees: &Trees, root: EventId) -> EventId {
    let group = trees.twins_of(network, root);
    group
        .iter()
        .map(|&(event, _)| event)
        .find(|event| places[event.index()].news == News::Drives)
        .unwrap_or(root)
}

/// Sums up what a cycle takes from each bound of the network.
#[derive(Default)]
pub(crate) struct Tally {
    times: BTreeMap<Part, i64>,
}

impl Tally {
    pub(crate) fn add(&mut self, part: Part, times: i64) {
        *self.times.entry(part).or_default() += times;
    }

    /// All links on the way from `above` down to `below`.
    fn path_times(
        &mut self,
        network: &Network,
        above: EventId,
        below: EventId,
        part: fn(usize) -> Part,
        times: i64,
    ) {
        let mut at = below;
        while at != above {
            let index = link_index(network, at);
            self.add(part(index), times);
            at = network.contingents()[index].from;
        }
    }

    pub(crate) fn path(
        &mut self,
        network: &Network,
        above: EventId,
        below: EventId,
        part: fn(usize) -> Part,
    ) {
        self.path_times(network, above, below, part, 1);
    }

    /// A requirement between two places; true if one of them is inexact.
    pub(crate) fn requirement(
        &mut self,
        network: &Network,
        places: &[Place],
        trees: &Trees,
        source: Source,
        times: i64,
    ) -> bool {
        self.add(source.part(), times);
        let (from, to) = match source {
            Source::Upper(index) => (network.requirements()[index].from, network.requirements()[index].to),
            Source::Lower(index) => (network.requirements()[index].to, network.requirements()[index].from),
            Source::AfterOrigin => return false,
        };
        self.earliest(network, places, trees, from, times);
        self.latest(network, places, trees, to, times);
        places[from.index()].inexact || places[to.index()].inexact
    }

    /// `+ earliest` of a place.
    fn earliest(&mut self, network: &Network, places: &[Place], trees: &Trees, event: EventId, times: i64) {
        self.offset(network, places, trees, event, times, [Part::LinkLower, Part::LinkUpper], Part::DelayMax);
    }

    /// `- latest` of a place.
    fn latest(&mut self, network: &Network, places: &[Place], trees: &Trees, event: EventId, times: i64) {
        self.offset(network, places, trees, event, times, [Part::LinkUpper, Part::LinkLower], Part::DelayMin);
    }

    #[expect(clippy::too_many_arguments, reason = "one formula for both ends of the interval")]
    fn offset(
        &mut self,
        network: &Network,
        places: &[Place],
        trees: &Trees,
        mut event: EventId,
        times: i64,
        [forth, back]: [fn(usize) -> Part; 2],
        delay: fn(usize) -> Part,
    ) {
        // Down the links from the base, unless the group has a node of its own: then back from the news.
        while network.link_of(event).is_some() {
            let place = places[event.index()];
            let root = trees.group_root(event);
            let driver = driver_in(places, network, trees, root);
            if places[driver.index()].news == News::Drives && places[driver.index()].node == place.node {
                self.path_times(network, root, event, forth, times);
                self.path_times(network, root, driver, back, times);
                self.add(delay(link_index(network, driver)), times);
                return;
            }
            self.path_times(network, place.base, event, forth, times);
            event = place.base;
        }
    }

    pub(crate) fn conflict(self, network: &Network, conservative: bool) -> Conflict {
        let mut members = Vec::new();
        let mut total = 0;
        for (part, times) in self.times {
            let amount = times * signed_bound(network, part);
            total += amount;
            // Opposite uses of one bound cancel.
            if times > 0 {
                let times = u32::try_from(times).unwrap_or(u32::MAX);
                members.push(Share { part, times, amount: Duration::from_micros(amount) });
            }
        }
        Conflict { members, total: Duration::from_micros(total), conservative }
    }
}

/// What one use of a part contributes, with the sign given at [`Part`].
fn signed_bound(network: &Network, part: Part) -> i64 {
    let finite = |bound: Bound| bound.finite().unwrap_or_default().as_micros();
    match part {
        Part::RequirementUpper(index) => finite(network.requirements()[index].upper),
        Part::RequirementLower(index) => -finite(network.requirements()[index].lower),
        Part::LinkLower(index) => network.contingents()[index].lower.as_micros(),
        Part::LinkUpper(index) => -network.contingents()[index].upper.as_micros(),
        Part::DelayMin(index) => network.contingents()[index].delay.min.as_micros(),
        Part::DelayMax(index) => -finite(network.contingents()[index].delay.max),
        Part::AfterOrigin | Part::Join(_) => 0,
    }
}
