//! Which amounts of a conflict are enough by themselves, and at which value: proven, not read off the sum.

use kirk_network::least::{could_settle, least_changes};
use kirk_network::time::Bound;
use kirk_network::vary::{Change, Knob};
use kirk_network::{Conflict, Duration, Network, Part};

use crate::diagnostic::Suggestion;
use crate::origins::Origins;
use crate::repair::change_of_source;
use crate::source::{Source, Span};

/// Each value is found by asking for the verdict again and again: of large missions that would keep the reader waiting.
const LARGE: usize = 4_000;

/// In words and as a change of the source, every amount with the least change that alone makes the program controllable: what is
/// ours and the news, and only if none of that is enough, what Nature decides. `None` if the mission is too large to look.
pub(super) fn enough_alone(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Option<Vec<(String, Option<Suggestion>)>> {
    let mut knobs: Vec<Knob> = Vec::new();
    for part in could_settle(network, conflict) {
        let knob = knob(part, network, origins);
        knobs.extend(knob.filter(|knob| !knobs.contains(knob)));
    }
    if knobs.len() * network.events().len() > LARGE {
        return None;
    }
    let changes: Vec<Change> = least_changes(network, &knobs).ok()?.into_iter().flatten().collect();
    let (natures, ours): (Vec<&Change>, Vec<&Change>) =
        changes.iter().partition(|change| is_natures(change.knob.parts()[0]));
    let told = if ours.is_empty() { natures } else { ours };
    Some(told.into_iter().filter_map(|change| change_of_source(change, network, origins, sources)).collect())
}

fn is_natures(part: Part) -> bool {
    matches!(part, Part::LinkLower(_) | Part::LinkUpper(_))
}

/// All bounds that are written where this one is, as they can only change together. `None` for what is no amount in the
/// source, and for what is written once and has several values.
fn knob(part: Part, network: &Network, origins: &Origins) -> Option<Knob> {
    let place = place(part, origins)?;
    let requirements = (0..network.requirements().len())
        .flat_map(|index| [Part::RequirementLower(index), Part::RequirementUpper(index)]);
    let links = (0..network.contingents().len())
        .flat_map(|index| [Part::LinkLower(index), Part::LinkUpper(index), Part::DelayMax(index)]);
    let alike = |other: &Part| std::mem::discriminant(other) == std::mem::discriminant(&part);
    let parts =
        requirements.chain(links).filter(alike).filter(|other| self::place(*other, origins) == Some(place));
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
    let values_agree =
        |part: &Part| Knob::of(*part).is_some_and(|one| one.value(network) == knob.value(network));
    knob.parts().iter().all(values_agree).then_some(knob)
}

/// Where an amount is written.
fn place(part: Part, origins: &Origins) -> Option<Span> {
    let (origin, which) = origins.of(part)?;
    origin.kind.is_amount().then(|| origin.places[which])
}
