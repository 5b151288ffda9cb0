//! The bounds that somebody has written: several of a network that are written once are one to whoever changes them.

use std::collections::{BTreeMap, BTreeSet};

use kirk_network::slack::bounds;
use kirk_network::vary::Knob;
use kirk_network::{Bound, Duration, Network, Part};

use crate::origins::{Origin, OriginKind, Origins, Side};
use crate::repair::{Unit, written_unit};
use crate::source::{Source, Span};

/// A bound as it is written, with all that is read there.
#[derive(Clone, Debug)]
pub struct Written<'a> {
    /// The bounds of the network; at least one.
    pub parts: Vec<Part>,
    /// Where the first of them comes from.
    pub origin: &'a Origin,
    /// Which of its amounts it is.
    pub side: Side,
}

impl Written<'_> {
    /// Where it is written.
    pub fn place(&self) -> Span {
        self.origin.place(self.side)
    }

    /// The unit in which it is written; `usual`, if that cannot be seen there.
    pub fn unit(&self, usual: Unit, sources: &[Source]) -> Unit {
        written_unit(self.place(), sources).unwrap_or(usual)
    }

    /// The least and the greatest value that is read there.
    pub fn values(&self, network: &Network) -> (Bound, Bound) {
        let value = |part: &Part| Knob::of(*part).map_or(Bound::Infinite, |knob| knob.value(network));
        let size = |bound: &Bound| bound.finite().map_or(i64::MAX, Duration::as_micros);
        let all = || self.parts.iter().map(value);
        let first = value(&self.parts[0]);
        (all().min_by_key(size).unwrap_or(first), all().max_by_key(size).unwrap_or(first))
    }

    /// True if all that is read there has one value. An argument gives it several, and no one text says them all.
    pub fn has_one_value(&self, network: &Network) -> bool {
        let (least, most) = self.values(network);
        least == most
    }
}

/// The unit in which most amounts of a mission are written: in it its times are told.
pub fn usual_unit(origins: &Origins, sources: &[Source]) -> Unit {
    let places: BTreeSet<Span> =
        origins.requirements.iter().chain(&origins.contingents).flat_map(|origin| origin.places).collect();
    let mut counts: BTreeMap<i64, (usize, Unit)> = BTreeMap::new();
    for unit in places.into_iter().filter_map(|place| written_unit(place, sources)) {
        counts.entry(unit.micros).or_insert((0, unit)).0 += 1;
    }
    counts.into_values().max_by_key(|(count, _)| *count).map_or(Unit::SECONDS, |(_, unit)| unit)
}

/// Those whose slack is worth a word: what is written by itself, and not what a form leaves open; news that comes at once, or may
/// be early, only if somebody says so.
pub fn measurable<'a>(network: &Network, origins: &'a Origins) -> Vec<Written<'a>> {
    let is_by_itself = |part: Part, origin: &Origin| {
        let is_entry = matches!(origin.kind, OriginKind::Requirement | OriginKind::Link);
        let is_written = Side::of(part).is_some_and(|side| origin.place(side) != origin.span);
        is_entry || is_written || matches!(part, Part::LinkUpper(_) | Part::DelayMax(_))
    };
    let is_worth_it = |part: Part| match part {
        Part::DelayMin(index) => network.contingents()[index].delay.min > Duration::ZERO,
        _ => true,
    };
    written(network, origins, |part, origin| is_by_itself(part, origin) && is_worth_it(part))
}

/// Those of a network for which something holds, in the order of their places.
pub fn written<'a>(
    network: &Network,
    origins: &'a Origins,
    is_meant: impl Fn(Part, &Origin) -> bool,
) -> Vec<Written<'a>> {
    let mut written: BTreeMap<(Span, Side), Written<'a>> = BTreeMap::new();
    for part in bounds(network).iter().map(|knob| knob.parts()[0]) {
        let Some((origin, side)) = origins.of(part) else { continue };
        if origin.kind.is_amount() && is_meant(part, origin) {
            let first = || Written { parts: Vec::new(), origin, side };
            written.entry((origin.place(side), side)).or_insert_with(first).parts.push(part);
        }
    }
    written.into_values().collect()
}
