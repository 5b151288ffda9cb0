//! All conflicts of a network that have no bound of ours in common, not only one of them.
//!
//! When the bounds of ours in a conflict leave all the time there is, what is found next is another one: with less to keep, what
//! cannot be kept cannot be kept with more either. A requirement [0, 0] stays, as it makes two events one, which is another
//! model and may be an easier one ([`crate::vary`]). Where a conflict has no other bound of ours, what Nature decides in it is
//! ours instead, and that leaves all the time there is.

use std::collections::BTreeSet;

use crate::check::{Verdict, check};
use crate::conflict::{Conflict, Part};
use crate::model::Network;
use crate::stnu::TooLarge;
use crate::time::Bound;

/// The conflicts, those of fewest members first, at most so many; none if the network is controllable. No bound of a
/// requirement is in two of them, unless it is [0, 0].
///
/// With all of them out of the way the network is controllable, unless there are more than were asked for.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn conflicts(network: &Network, most: usize) -> Result<Vec<Conflict>, TooLarge> {
    let mut found = Vec::new();
    let mut rest = network.clone();
    // It ends: every round makes a finite bound infinite, or an event of Nature's ours, and without either nothing is negative.
    while found.len() < most
        && let Verdict::Uncontrollable(conflict) = check(&rest)?
    {
        loosen(&mut rest, &conflict);
        found.push(conflict);
    }
    found.sort_by_key(|conflict| conflict.members.len());
    Ok(found)
}

/// The network with some conflicts out of the way. Events that were added to it for that are the last.
pub fn without<'a>(network: &Network, conflicts: impl IntoIterator<Item = &'a Conflict>) -> Network {
    let mut rest = network.clone();
    for conflict in conflicts {
        loosen(&mut rest, conflict);
    }
    rest
}

/// Puts the bounds of ours that are in a conflict out of the way, or if there are none, what is Nature's.
fn loosen(network: &mut Network, conflict: &Conflict) {
    let parts = || conflict.members.iter().map(|share| share.part);
    // What joins is known before any of it is changed.
    let ours: Vec<(usize, bool)> = parts()
        .filter_map(|part| match part {
            Part::RequirementLower(index) => Some((index, true)),
            Part::RequirementUpper(index) => Some((index, false)),
            _ => None,
        })
        .filter(|&(index, _)| !network.requirements()[index].is_join())
        .collect();
    for &(index, is_lower) in &ours {
        let requirement = network.requirement_mut(index);
        *(if is_lower { &mut requirement.lower } else { &mut requirement.upper }) = Bound::Infinite;
    }
    if ours.is_empty() {
        let links: BTreeSet<usize> = parts().filter_map(Part::link).collect();
        links.into_iter().for_each(|link| network.take_over_end(link));
    }
}
