//! The verdict: is a network variable-delay controllable, and if not, why not.

use std::collections::BTreeSet;

use crate::conflict::{Conflict, Part, Share};
use crate::controllability::{is_controllable, negative_cycle};
use crate::merge::merge;
use crate::model::{ContingentLink, Delay, Event, EventId, Network, Requirement};
use crate::reduce::{ReduceError, Reduction, reduce};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};

/// The answer of [`check`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Whatever Nature does, there is always something to do that keeps every requirement.
    Controllable,
    /// There is not, and these constraints prove it.
    Uncontrollable(Conflict),
}

/// Decides variable-delay controllability: merge, reduce, search; a conflict in terms of `network` for every "no".
///
/// Strong controllability is the case of infinite delays, dynamic controllability that of none.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn check(network: &Network) -> Result<Verdict, TooLarge> {
    let merged = merge(network);
    Ok(match reduce(&merged.network) {
        Err(ReduceError::TooLarge) => return Err(TooLarge),
        Ok(reduction) if is_controllable(&reduction.stnu)? => Verdict::Controllable,
        reduction => match explain(&merged.network, reduction)? {
            Some(conflict) => Verdict::Uncontrollable(merged.unmerge(&conflict, network)),
            None => unreachable!("the search that explains agrees with the one that only decides"),
        },
    })
}

/// A minimal conflict of a merged network, `None` if it is controllable.
pub fn conflict(merged: &Network) -> Result<Option<Conflict>, TooLarge> {
    explain(merged, reduce(merged))
}

/// Some conflict of a merged network as it was found, not minimal, and its `conservative` not settled; `None` if the network is
/// controllable. What it says of the bounds is as true as what a minimal one says, and is had at the price of the verdict.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn any_conflict(merged: &Network) -> Result<Option<Conflict>, TooLarge> {
    first_conflict(merged, &reduce(merged))
}

fn explain(
    network: &Network,
    reduction: Result<Reduction, ReduceError>,
) -> Result<Option<Conflict>, TooLarge> {
    let Some(found) = first_conflict(network, &reduction)? else { return Ok(None) };
    let mut conflict = minimise(network, found)?;
    conflict.conservative = match &reduction {
        Ok(reduction) => rests_on_a_delayed_chain(network, reduction, &conflict)?,
        Err(_) => false,
    };
    Ok(Some(conflict))
}

/// Some conflict of the network, its `conservative` not yet settled.
fn first_conflict(
    network: &Network,
    reduction: &Result<Reduction, ReduceError>,
) -> Result<Option<Conflict>, TooLarge> {
    match reduction {
        Err(ReduceError::TooLarge) => Err(TooLarge),
        Err(ReduceError::Never(violation)) => Ok(Some(violation.conflict(network)?)),
        Ok(reduction) => {
            negative_cycle(&reduction.stnu)?.map(|cycle| reduction.conflict(network, &cycle)).transpose()
        }
    }
}

/// True if a member was placed by the news of a delayed chain, where the reduction does not know all that could be
/// known, and news at once would make the members controllable.
fn rests_on_a_delayed_chain(
    network: &Network,
    reduction: &Reduction,
    conflict: &Conflict,
) -> Result<bool, TooLarge> {
    let inexact = |event: EventId| reduction.places[event.index()].inexact;
    let touches_one = members(conflict).into_iter().any(|member| match member {
        Member::Upper(index) | Member::Lower(index) => {
            inexact(network.requirements()[index].from) || inexact(network.requirements()[index].to)
        }
        Member::Link(index) => inexact(network.contingents()[index].to),
    });
    if !touches_one {
        return Ok(false);
    }
    let at_once = Restriction::new(network, &members(conflict), Some(Delay::NONE)).network;
    Ok(first_conflict(&at_once, &reduce(&at_once))?.is_none())
}

/// Beyond this many members a conflict is left as it was found; trying each one out would take long.
const MOST_MEMBERS_TO_TRY: usize = 200;

/// One thing that can be taken out of a conflict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Member {
    Upper(usize),
    Lower(usize),
    Link(usize),
}

fn members(conflict: &Conflict) -> BTreeSet<Member> {
    let member = |share: &Share| match share.part {
        Part::RequirementUpper(index) => Some(Member::Upper(index)),
        Part::RequirementLower(index) => Some(Member::Lower(index)),
        part => part.link().map(Member::Link),
    };
    conflict.members.iter().filter_map(member).collect()
}

/// Takes out members one by one as long as the rest is still a conflict.
fn minimise(network: &Network, found: Conflict) -> Result<Conflict, TooLarge> {
    let mut kept = members(&found);
    // In a chain it takes all the links before to say when an event can be and how its news is to be used.
    for member in kept.clone() {
        let Member::Link(index) = member else { continue };
        let mut at = network.contingents()[index].from;
        while let Some(above) = network.link_of(at) {
            kept.insert(Member::Link(above));
            at = network.contingents()[above].from;
        }
    }
    let Some(mut smallest) = restricted_conflict(network, &kept)? else { return Ok(found) };
    // Deletion filter (J. W. Chinneck, E. W. Dravnieks, Locating minimal infeasible constraint sets in linear programs,
    // 1991). One pass is enough: with less to keep nothing gets harder, so what could not be left out of more cannot be
    // left out of less. The last conflict found is kept, since the cycle may have become another one.
    if kept.len() <= MOST_MEMBERS_TO_TRY {
        for member in kept.clone().into_iter().rev() {
            kept.remove(&member);
            match restricted_conflict(network, &kept)? {
                Some(conflict) => smallest = conflict,
                None => {
                    kept.insert(member);
                }
            }
        }
    }
    // Links that must be there although the cycle takes nothing from their bounds.
    for member in kept.difference(&members(&smallest)) {
        if let Member::Link(index) = *member {
            let share = Share { part: Part::LinkUpper(index), times: 0, amount: Duration::ZERO };
            smallest.members.push(share);
        }
    }
    smallest.members.sort_by_key(|share| share.part);
    Ok(smallest)
}

fn restricted_conflict(network: &Network, members: &BTreeSet<Member>) -> Result<Option<Conflict>, TooLarge> {
    let restriction = Restriction::new(network, members, None);
    let conflict = first_conflict(&restriction.network, &reduce(&restriction.network))?;
    Ok(conflict.map(|conflict| restriction.back(conflict)))
}

/// A network of some members only, over the events they touch.
struct Restriction {
    network: Network,
    requirement_of: Vec<usize>,
    contingent_of: Vec<usize>,
}

impl Restriction {
    fn new(network: &Network, members: &BTreeSet<Member>, delay: Option<Delay>) -> Restriction {
        let mut new_id = vec![None; network.events().len()];
        let mut events: Vec<Event> = Vec::new();
        let mut id = |event: EventId| {
            *new_id[event.index()].get_or_insert_with(|| {
                events.push(network.events()[event.index()].clone());
                EventId(events.len() as u32 - 1)
            })
        };
        let origin = id(network.origin());
        let mut requirements = Vec::new();
        let mut requirement_of = Vec::new();
        let mut contingents = Vec::new();
        let mut contingent_of = Vec::new();
        for &member in members {
            match member {
                Member::Upper(index) | Member::Lower(index) => {
                    let whole = network.requirements()[index];
                    let (mut lower, mut upper) = (Bound::Infinite, Bound::Infinite);
                    match member {
                        Member::Upper(_) => upper = whole.upper,
                        _ => lower = whole.lower,
                    }
                    requirements.push(Requirement { from: id(whole.from), to: id(whole.to), lower, upper });
                    requirement_of.push(index);
                }
                Member::Link(index) => {
                    let link = network.contingents()[index];
                    contingents.push(ContingentLink {
                        from: id(link.from),
                        to: id(link.to),
                        delay: delay.unwrap_or(link.delay),
                        ..link
                    });
                    contingent_of.push(index);
                }
            }
        }
        let network = Network::new(network.name().to_string(), origin, events, requirements, contingents)
            .unwrap_or_else(|errors| unreachable!("part of a valid network is valid: {errors:?}"));
        Restriction { network, requirement_of, contingent_of }
    }

    fn back(&self, conflict: Conflict) -> Conflict {
        let part = |part| match part {
            Part::RequirementUpper(index) => Part::RequirementUpper(self.requirement_of[index]),
            Part::RequirementLower(index) => Part::RequirementLower(self.requirement_of[index]),
            Part::LinkLower(index) => Part::LinkLower(self.contingent_of[index]),
            Part::LinkUpper(index) => Part::LinkUpper(self.contingent_of[index]),
            Part::DelayMin(index) => Part::DelayMin(self.contingent_of[index]),
            Part::DelayMax(index) => Part::DelayMax(self.contingent_of[index]),
            other => other,
        };
        let mut members: Vec<Share> =
            conflict.members.iter().map(|share| Share { part: part(share.part), ..*share }).collect();
        members.sort_by_key(|share| share.part);
        Conflict { members, ..conflict }
    }
}
