//! Which amounts of a conflict are enough by themselves, and at which value: proven, not read off the sum.

use std::collections::HashMap;
use std::mem::{Discriminant, discriminant};

use kirk_network::least::{could_settle, least_changes};
use kirk_network::time::Bound;
use kirk_network::vary::{Change, Knob};
use kirk_network::{Conflict, Duration, Network, Part};

use crate::diagnostic::Suggestion;
use crate::origins::Origins;
use crate::repair::change_of_source;
use crate::source::{Source, Span};

/// Each value is found by asking for the verdict again and again: of large missions that would keep the reader waiting.
const LARGE: usize = 20_000;

/// In words and as a change of the source, every amount with the least change that alone makes the program controllable: what is
/// ours and the news, and only if none of that is enough, what Nature decides. `rest` is the network with other conflicts out of the way. `None` if the
/// mission is too large to look.
pub(super) fn enough_alone(
    conflict: &Conflict,
    network: &Network,
    rest: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Option<Vec<(String, Option<Suggestion>)>> {
    let parts = could_settle(network, conflict);
    if parts.len() * network.events().len() > LARGE {
        return None;
    }
    let written = written(network, origins);
    let mut knobs: Vec<Knob> = Vec::new();
    for part in parts {
        let knob = knob(part, network, rest, origins, &written);
        knobs.extend(knob.filter(|knob| !knobs.contains(knob)));
    }
    let changes: Vec<Change> = least_changes(rest, &knobs).ok()?.into_iter().flatten().collect();
    let (natures, ours): (Vec<&Change>, Vec<&Change>) =
        changes.iter().partition(|change| is_natures(change.knob.parts()[0]));
    let told = if ours.is_empty() { natures } else { ours };
    Some(told.into_iter().filter_map(|change| change_of_source(change, network, origins, sources)).collect())
}

fn is_natures(part: Part) -> bool {
    matches!(part, Part::LinkLower(_) | Part::LinkUpper(_))
}

/// The bounds that are written at a place, as one kind of amount.
type Written = HashMap<(Span, Discriminant<Part>), Vec<Part>>;

fn written(network: &Network, origins: &Origins) -> Written {
    let requirements = (0..network.requirements().len())
        .flat_map(|index| [Part::RequirementLower(index), Part::RequirementUpper(index)]);
    let links = (0..network.contingents().len())
        .flat_map(|index| [Part::LinkLower(index), Part::LinkUpper(index), Part::DelayMax(index)]);
    let mut written = Written::new();
    for part in requirements.chain(links) {
        if let Some(place) = place(part, origins) {
            written.entry((place, discriminant(&part))).or_default().push(part);
        }
    }
    written
}

/// All bounds that are written where this one is, as they can only change together; those that are out of the way with another
/// conflict need not. `None` for what is no amount in the source, and for what is written once and has several values.
fn knob(part: Part, network: &Network, rest: &Network, origins: &Origins, written: &Written) -> Option<Knob> {
    let all = written.get(&(place(part, origins)?, discriminant(&part)))?;
    let value = |part: &Part, network: &Network| Knob::of(*part).map(|one| one.value(network));
    if all.iter().any(|other| value(other, network) != value(&part, network)) {
        return None;
    }
    let parts = all.iter().filter(|other| value(other, rest) == value(other, network)).copied();
    let knob = Knob::together(parts.collect())?;
    // Nothing takes less than no time, no news comes before what it tells, and what is to come after something goes on to.
    let is_order = match (part, knob.value(network)) {
        (Part::RequirementLower(_), Bound::Finite(lower)) => lower >= Duration::ZERO,
        (Part::RequirementUpper(index), Bound::Finite(upper)) => {
            upper <= Duration::ZERO && network.requirements()[index].lower == Bound::Infinite
        }
        _ => matches!(part, Part::DelayMax(_)),
    };
    let knob = if is_order { knob.limited(Duration::ZERO) } else { knob };
    Some(knob)
}

/// Where an amount is written.
fn place(part: Part, origins: &Origins) -> Option<Span> {
    let (origin, which) = origins.of(part)?;
    origin.kind.is_amount().then(|| origin.places[which])
}
