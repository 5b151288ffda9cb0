//! All conflicts of a network that have no bound of ours in common, not only one of them.
//!
//! When the bounds of ours in a conflict leave all the time there is, what is found next is another one: with less to keep, what
//! cannot be kept cannot be kept with more either. A requirement [0, 0] stays, as it makes two events one, which is another
//! model and may be an easier one ([`crate::vary`]).

use crate::check::{Verdict, check};
use crate::conflict::{Conflict, Part};
use crate::model::Network;
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};
use crate::vary::Knob;

/// The conflicts, those of fewest members first, at most so many; none if the network is controllable. No bound of a
/// requirement is in two of them, unless it is [0, 0].
///
/// With the bounds of ours in all of them out of the way the network is controllable, unless there are more than were asked for,
/// or one is left that has none.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn conflicts(network: &Network, most: usize) -> Result<Vec<Conflict>, TooLarge> {
    let mut found = Vec::new();
    let mut rest = network.clone();
    // It ends: every round makes at least one finite bound infinite.
    while found.len() < most
        && let Verdict::Uncontrollable(conflict) = check(&rest)?
    {
        let next = without(&rest, &conflict);
        found.push(conflict);
        match next {
            Some(next) => rest = next,
            None => break,
        }
    }
    found.sort_by_key(|conflict| conflict.members.len());
    Ok(found)
}

/// The network with the bounds of ours that are in a conflict out of the way; `None` if there are none.
pub fn without(network: &Network, conflict: &Conflict) -> Option<Network> {
    let is_free = |part: &Part| match *part {
        Part::RequirementLower(index) | Part::RequirementUpper(index) => {
            let (requirement, zero) = (network.requirements()[index], Bound::Finite(Duration::ZERO));
            (requirement.lower, requirement.upper) != (zero, zero)
        }
        _ => false,
    };
    let parts: Vec<Part> = conflict.members.iter().map(|share| share.part).filter(is_free).collect();
    let loosened = |network: Network, part: &Part| Knob::of(*part)?.at(&network, Bound::Infinite);
    (!parts.is_empty()).then(|| parts.iter().try_fold(network.clone(), loosened))?
}
