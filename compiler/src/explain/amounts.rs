//! Which amounts of a conflict are enough by themselves, and at which value: proven, not read off the sum.

use kirk_network::least::{could_settle, least_changes};
use kirk_network::time::Bound;
use kirk_network::vary::{Change, Knob};
use kirk_network::{Conflict, Duration, Network, Part};

use crate::lower::{Origin, OriginKind, Origins};
use crate::source::Span;

/// Each value is found by asking for the verdict again and again: of large missions that would keep the reader waiting.
const LARGE: usize = 4_000;

/// In words, every amount with the least change that alone makes the program controllable: what is ours and the news, and
/// only if none of that is enough, what Nature decides. `None` if the mission is too large to look.
pub(super) fn enough_alone(conflict: &Conflict, network: &Network, origins: &Origins) -> Option<Vec<String>> {
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
    Some(told.into_iter().filter_map(|change| say(change, origins)).collect())
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
    // Nothing takes less than no time, and no news comes before what it tells.
    let knob = match part {
        Part::RequirementLower(_) | Part::DelayMax(_) => knob.limited(Duration::ZERO),
        _ => knob,
    };
    let values_agree =
        |part: &Part| Knob::of(*part).is_some_and(|one| one.value(network) == knob.value(network));
    knob.parts().iter().all(values_agree).then_some(knob)
}

/// Where an amount is written.
fn place(part: Part, origins: &Origins) -> Option<Span> {
    let (origin, which) = origin(part, origins)?;
    let is_amount = !matches!(origin.kind, OriginKind::Join | OriginKind::Order);
    is_amount.then(|| origin.places[which])
}

fn origin(part: Part, origins: &Origins) -> Option<(&Origin, usize)> {
    match part {
        Part::RequirementLower(index) => Some((origins.requirements.get(index)?, 0)),
        Part::RequirementUpper(index) => Some((origins.requirements.get(index)?, 1)),
        Part::LinkLower(index) => Some((origins.contingents.get(index)?, 0)),
        Part::LinkUpper(index) => Some((origins.contingents.get(index)?, 1)),
        Part::DelayMax(index) => Some((origins.contingents.get(index)?, 3)),
        Part::DelayMin(_) | Part::Join(_) | Part::AfterOrigin => None,
    }
}

/// A change, as part of a sentence: "at most 45 s instead of 40 s for `drive`".
fn say(change: &Change, origins: &Origins) -> Option<String> {
    let part = change.knob.parts()[0];
    let (origin, _) = origin(part, origins)?;
    let subject = &origin.subject;
    let to = change.to.finite()?;
    let instead = match change.from {
        Bound::Finite(from) => format!(" instead of {from} s"),
        Bound::Infinite => String::new(),
    };
    let named = subject.strip_prefix("this ").map_or_else(|| subject.clone(), |form| format!("the {form}"));
    let of = if origin.kind == OriginKind::Between { named.clone() } else { format!("for {named}") };
    Some(match part {
        Part::RequirementLower(_) => format!("at least {to} s{instead} {of}"),
        Part::RequirementUpper(_) => format!("at most {to} s{instead} {of}"),
        Part::LinkLower(_) => format!("Nature taking at least {to} s{instead} {of}"),
        Part::LinkUpper(_) => format!("Nature taking at most {to} s{instead} {of}"),
        _ => format!("news of the end of {named} within {to} s{instead}"),
    })
}
