//! Which amounts of a conflict are enough by themselves, and at which value: proven, not read off the sum.

use std::collections::BTreeSet;

use kirk_network::least::{could_settle, least_changes};
use kirk_network::vary::{Change, Knob};
use kirk_network::{Conflict, Network, Part};

use crate::origins::{Origin, Origins};
use crate::repair::{Changed, change_of_source};
use crate::source::Source;
use crate::written::{Written, written};

/// Each value is found by asking for the verdict again and again: of large missions that would keep the reader waiting.
const LARGE: usize = 20_000;

/// As a change of the source, every amount with the least change that alone makes the program controllable: what is
/// ours and the news, and only if none of that is enough, what Nature decides. `rest` is the network with other conflicts out of the way. `None` if the
/// mission is too large to look.
pub(super) fn enough_alone(
    conflict: &Conflict,
    network: &Network,
    rest: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Option<Vec<Changed>> {
    let parts = could_settle(network, conflict);
    if parts.len() * network.events().len() > LARGE {
        return None;
    }
    let parts: BTreeSet<Part> = parts.into_iter().collect();
    let is_meant = |part: Part, _: &Origin| !matches!(part, Part::DelayMin(_));
    let concerned = written(network, origins, is_meant).into_iter().filter(|written| {
        written.parts.iter().any(|part| parts.contains(part)) && written.has_one_value(network)
    });
    // What is out of the way with another conflict need not change with the others.
    let is_there = |part: &Part| {
        let value = |network| Knob::of(*part).map(|knob| knob.value(network));
        value(rest) == value(network)
    };
    let knob = |Written { parts, .. }: Written<'_>| {
        let knob = Knob::together(parts.into_iter().filter(is_there).collect())?;
        Some(knob.in_its_sense(rest))
    };
    let mut knobs: Vec<Knob> = concerned.filter_map(knob).collect();
    // What may be allowed comes before what may be asked for.
    knobs.sort_by_key(|knob| knob.parts()[0]);
    let changes: Vec<Change> = least_changes(rest, &knobs).ok()?.into_iter().flatten().collect();
    let (natures, ours): (Vec<&Change>, Vec<&Change>) =
        changes.iter().partition(|change| is_natures(change.knob.parts()[0]));
    let told = if ours.is_empty() { natures } else { ours };
    Some(told.into_iter().filter_map(|change| change_of_source(change, network, origins, sources)).collect())
}

fn is_natures(part: Part) -> bool {
    matches!(part, Part::LinkLower(_) | Part::LinkUpper(_))
}
