//! All conflicts of a network that have no bound of ours in common, not only one of them.
//!
//! When the bounds of ours in a conflict leave all the time there is, what is found next is another one: with less to keep, what
//! cannot be kept cannot be kept with more either. A requirement [0, 0] stays, as it makes two events one, which is another
//! model and may be an easier one ([`crate::vary`]).

use crate::check::{Verdict, check};
use crate::conflict::{Conflict, Part};
use crate::model::{Network, Requirement};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};

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
        let has_bounds = loosen(&mut rest, &conflict);
        found.push(conflict);
        if !has_bounds {
            break;
        }
    }
    found.sort_by_key(|conflict| conflict.members.len());
    Ok(found)
}

/// The network with the bounds of ours that are in some conflicts out of the way.
pub fn without<'a>(network: &Network, conflicts: impl IntoIterator<Item = &'a Conflict>) -> Network {
    let mut rest = network.clone();
    for conflict in conflicts {
        loosen(&mut rest, conflict);
    }
    rest
}

/// Puts the bounds of ours that are in a conflict out of the way; `false` if there are none.
fn loosen(network: &mut Network, conflict: &Conflict) -> bool {
    let zero = Bound::Finite(Duration::ZERO);
    let joins = |it: &Requirement| (it.lower, it.upper) == (zero, zero);
    let parts = conflict.members.iter().map(|share| share.part);
    // What joins is known before any of it is changed.
    let free: Vec<(usize, bool)> = parts
        .filter_map(|part| match part {
            Part::RequirementLower(index) => Some((index, true)),
            Part::RequirementUpper(index) => Some((index, false)),
            _ => None,
        })
        .filter(|&(index, _)| !joins(&network.requirements()[index]))
        .collect();
    for &(index, is_lower) in &free {
        let requirement = network.requirement_mut(index);
        *(if is_lower { &mut requirement.lower } else { &mut requirement.upper }) = Bound::Infinite;
    }
    !free.is_empty()
}
