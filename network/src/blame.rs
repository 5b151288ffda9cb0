//! What a negative cycle of the plain STNU takes from each bound of the network it was reduced from.

use std::collections::BTreeMap;

use crate::conflict::{Conflict, Part, Share};
use crate::controllability::{Cycle, Step};
use crate::model::{EventId, Network};
use crate::reduce::{Reduction, Source, Violation};
use crate::stnu::TooLarge;
use crate::time::Duration;
use crate::trees::{Trees, link_index};

impl Reduction {
    /// What a negative cycle of the plain STNU says of the network it is from. Whether it is conservative is not said.
    ///
    /// # Errors
    /// [`TooLarge`] if what the cycle takes from the bounds adds up to more than 64-bit microseconds can hold.
    pub fn conflict(&self, network: &Network, cycle: &Cycle) -> Result<Conflict, TooLarge> {
        self.tally(network, &cycle.steps).conflict()
    }

    /// What steps of the plain STNU take from the bounds of the network.
    pub(crate) fn tally<'a>(&self, network: &'a Network, steps: &[(Step, i64)]) -> Tally<'a> {
        let mut tally = Tally { network, times: BTreeMap::new() };
        for &(step, times) in steps {
            match step {
                Step::Edge(edge) => tally.edge(self, self.sources[edge as usize], times),
                Step::Lower(link) => tally.link(self, link, &EARLY, times),
                Step::Upper(link) => tally.link(self, link, &LATE, times),
            }
        }
        tally
    }
}

impl Violation {
    /// The conflict between the bound and the links that Nature violates it with.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub(crate) fn conflict(&self, network: &Network) -> Result<Conflict, TooLarge> {
        self.tally(network)?.conflict()
    }

    /// What the bound and the links take from the bounds of the network.
    pub(crate) fn tally<'a>(&self, network: &'a Network) -> Result<Tally<'a>, TooLarge> {
        let mut tally = Tally { network, times: BTreeMap::new() };
        let meet = Trees::new(network)?.lowest_common_ancestor(network, self.from, self.to);
        tally.add(self.source.part(), 1);
        tally.path(meet, self.to, Part::LinkUpper, 1);
        tally.path(meet, self.from, Part::LinkLower, 1);
        Ok(tally)
    }
}

impl Source {
    pub(crate) fn part(self) -> Part {
        match self {
            Source::Upper(index) => Part::RequirementUpper(index),
            Source::Lower(index) => Part::RequirementLower(index),
            Source::AfterOrigin => Part::AfterOrigin,
        }
    }
}

/// The bounds that make up one end of the interval of a place.
struct End {
    /// The bound of a link on the way down to the event, and that of a link gone back.
    link: fn(usize) -> Part,
    back: fn(usize) -> Part,
    /// The delay of the news the event is placed by.
    delay: fn(usize) -> Part,
}

/// `+ earliest`: the links at their least, the news at its latest.
const EARLY: End = End { link: Part::LinkLower, back: Part::LinkUpper, delay: Part::DelayMax };
/// `- latest`: the links at their most, the news at its earliest.
const LATE: End = End { link: Part::LinkUpper, back: Part::LinkLower, delay: Part::DelayMin };

/// Sums up what a cycle takes from each bound of the network.
pub(crate) struct Tally<'a> {
    network: &'a Network,
    /// How often, opposite uses against one another.
    pub(crate) times: BTreeMap<Part, i64>,
}

impl Tally<'_> {
    fn add(&mut self, part: Part, times: i64) {
        *self.times.entry(part).or_default() += times;
    }

    /// All links on the way from `above` down to `below`.
    fn path(&mut self, above: EventId, below: EventId, part: fn(usize) -> Part, times: i64) {
        let mut at = below;
        while at != above {
            let index = link_index(self.network, at);
            self.add(part(index), times);
            at = self.network.contingents()[index].from;
        }
    }

    /// `node_to - node_from <= w - latest_to + earliest_from`.
    fn edge(&mut self, reduction: &Reduction, source: Source, times: i64) {
        self.add(source.part(), times);
        let (from, to) = match source {
            Source::Upper(index) => {
                (self.network.requirements()[index].from, self.network.requirements()[index].to)
            }
            Source::Lower(index) => {
                (self.network.requirements()[index].to, self.network.requirements()[index].from)
            }
            Source::AfterOrigin => return,
        };
        self.offset(reduction, from, &EARLY, times);
        self.offset(reduction, to, &LATE, times);
    }

    /// The lower-case edge of a heard group (`EARLY`) weighs `earliest + max delay`, the upper-case edge (`LATE`)
    /// `- latest - min delay`: the interval before the news, then the delay with the contrary of its usual sign.
    fn link(&mut self, reduction: &Reduction, link: u32, end: &End, times: i64) {
        let node = reduction.stnu.links[link as usize].contingent;
        let place = reduction.places[reduction.event_of[node as usize].index()];
        let Some(news) = place.heard_by else { return };
        self.offset(reduction, place.base, end, times);
        self.path(place.base, news, end.link, times);
        self.add((end.delay)(link_index(self.network, news)), -times);
    }

    fn offset(&mut self, reduction: &Reduction, mut event: EventId, end: &End, times: i64) {
        while self.network.link_of(event).is_some() {
            let place = reduction.places[event.index()];
            let Some(news) = place.heard_by else {
                self.path(place.base, event, end.link, times);
                event = place.base;
                continue;
            };
            // The news tells of the root; from there a fixed way leads down to the event.
            self.path(place.root, event, end.link, times);
            self.path(place.root, news, end.back, times);
            self.add((end.delay)(link_index(self.network, news)), times);
            return;
        }
    }

    /// What is taken in all, in microseconds.
    pub(crate) fn total(&self) -> Result<i64, TooLarge> {
        let mut total = 0_i64;
        for (&part, &times) in &self.times {
            let amount = times.checked_mul(part.signed(self.network).as_micros()).ok_or(TooLarge)?;
            total = total.checked_add(amount).ok_or(TooLarge)?;
        }
        Ok(total)
    }

    fn conflict(self) -> Result<Conflict, TooLarge> {
        let mut members = Vec::new();
        let total = self.total()?;
        for (&part, &times) in &self.times {
            let bound = part.signed(self.network).as_micros();
            let amount = times.checked_mul(bound).ok_or(TooLarge)?;
            // Opposite uses of one bound cancel, and news at once is nobody's fault.
            let at_once = bound == 0 && matches!(part, Part::DelayMin(_) | Part::DelayMax(_));
            if times > 0 && !at_once {
                let (times, amount) =
                    (u32::try_from(times).unwrap_or(u32::MAX), Duration::from_micros(amount));
                members.push(Share { part, times, amount });
            }
        }
        Ok(Conflict { members, total: Duration::from_micros(total), conservative: false })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::Tally;
    use crate::conflict::Part;
    use crate::json;
    use crate::stnu::TooLarge;

    #[test]
    fn a_sum_beyond_what_can_be_held_is_an_error_and_no_other_number() {
        let network = json::read(
            r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b"],
                "requirements": [{"from": "a", "to": "b", "lower": 9999999999}]}"#,
        );
        let network = network.expect("a valid network");
        let tally =
            |times| Tally { network: &network, times: BTreeMap::from([(Part::RequirementLower(0), times)]) };
        assert!(tally(900).conflict().is_ok());
        assert_eq!(tally(1200).conflict(), Err(TooLarge));
    }
}
