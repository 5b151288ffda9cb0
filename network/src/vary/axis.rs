//! The values of a bound as positions on an axis on which larger is easier for us.

use crate::conflict::Part;
use crate::model::Network;
use crate::time::{Bound, Duration};

/// The position of no bound at all, where that is easiest; negated, where it is hardest.
pub(crate) const INFINITE: i64 = i64::MAX;

/// The largest finite position, and, negated, the least.
pub(crate) const FARTHEST: i64 = Duration::MAX.as_micros();

/// The position of a value, in microseconds.
pub(super) fn position(part: Part, value: Bound) -> i64 {
    match value {
        // Less is easier of what is subtracted.
        Bound::Finite(value) if part.is_subtracted() => -value.as_micros(),
        Bound::Finite(value) => value.as_micros(),
        Bound::Infinite if matches!(part, Part::DelayMax(_)) => -INFINITE,
        Bound::Infinite => INFINITE,
    }
}

/// The value at a position.
pub(super) fn value_at(part: Part, position: i64) -> Bound {
    match position {
        INFINITE => Bound::Infinite,
        _ if position == -INFINITE => Bound::Infinite,
        _ if part.is_subtracted() => Bound::Finite(Duration::from_micros(-position)),
        _ => Bound::Finite(Duration::from_micros(position)),
    }
}

/// What a network says there.
pub(super) fn value(network: &Network, part: Part) -> Bound {
    match part {
        Part::RequirementUpper(index) => network.requirements()[index].upper,
        Part::RequirementLower(index) => network.requirements()[index].lower,
        Part::DelayMax(index) => network.contingents()[index].delay.max,
        _ => Bound::Finite(part.bound(network)),
    }
}

/// Puts a value there, whatever it is.
pub(super) fn set(network: &mut Network, part: Part, value: Bound) {
    let finite = value.finite().unwrap_or_default();
    match part {
        Part::RequirementUpper(index) => network.requirement_mut(index).upper = value,
        Part::RequirementLower(index) => network.requirement_mut(index).lower = value,
        Part::LinkUpper(index) => network.link_mut(index).upper = finite,
        Part::LinkLower(index) => network.link_mut(index).lower = finite,
        Part::DelayMin(index) => network.link_mut(index).delay.min = finite,
        Part::DelayMax(index) => {
            let delay = &mut network.link_mut(index).delay;
            delay.max = value;
            if let Bound::Finite(max) = value {
                delay.min = delay.min.min(max);
            }
        }
        Part::AfterOrigin | Part::Join(_) => {}
    }
}

/// True if the bounds of the constraints that these are parts of are in order.
pub(super) fn in_order(network: &Network, parts: &[Part]) -> bool {
    parts.iter().all(|part| match *part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => {
            let requirement = network.requirements()[index];
            requirement.lower.finite().zip(requirement.upper.finite()).is_none_or(|(low, high)| low <= high)
        }
        Part::LinkUpper(index) | Part::LinkLower(index) => {
            let link = network.contingents()[index];
            Duration::ZERO <= link.lower && link.lower <= link.upper
        }
        Part::DelayMin(index) | Part::DelayMax(index) => {
            let delay = network.contingents()[index].delay;
            Duration::ZERO <= delay.min && delay.max.finite().is_none_or(|max| delay.min <= max)
        }
        Part::AfterOrigin | Part::Join(_) => false,
    })
}

/// The hardest and the easiest position of a bound, all else as it is.
pub(super) fn range(network: &Network, part: Part) -> (i64, i64) {
    let at = |value: Duration| position(part, Bound::Finite(value));
    match part {
        Part::RequirementUpper(index) => {
            (network.requirements()[index].lower.finite().map_or(-FARTHEST, at), INFINITE)
        }
        Part::RequirementLower(index) => {
            (network.requirements()[index].upper.finite().map_or(-FARTHEST, at), INFINITE)
        }
        Part::LinkUpper(index) => (-FARTHEST, at(network.contingents()[index].lower)),
        Part::LinkLower(index) => (0, at(network.contingents()[index].upper)),
        Part::DelayMin(index) => {
            let delay = network.contingents()[index].delay;
            (0, at(delay.max.finite().unwrap_or(Duration::MAX)))
        }
        Part::DelayMax(index) => (-INFINITE, at(network.contingents()[index].delay.min)),
        Part::AfterOrigin | Part::Join(_) => (0, 0),
    }
}
