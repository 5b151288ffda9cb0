//! The conflict that lacks exactly what the least change of a bound is: the one that is left just before it is enough.
//!
//! Of the conflicts of a network some lack more than others, and the one that is found first is any of them. What stands in the
//! way to the last microsecond is the one that tells how much has to change: all others are settled before.

use crate::check::{Verdict, check};
use crate::conflict::{Conflict, Part, Share};
use crate::model::{Network, Requirement};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};
use crate::vary::Change;

/// A conflict with what it has to do with a change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Witness {
    /// With the amounts that the bounds have before the change.
    pub conflict: Conflict,
    /// How often the bound that changes counts in it: what is missing is so many times the amount of the change.
    pub times: u32,
}

/// The conflict of a network that lacks what a least change of it ([`crate::least`]) is. `None` if there is none: where the change
/// makes it another model, as news is of use again, what is missing before is not what settles it.
///
/// Its members alone are no more controllable than the network is.
///
/// ```
/// use kirk_network::least::least_changes;
/// use kirk_network::vary::Knob;
/// use kirk_network::witness::witness;
/// use kirk_network::{Part, json};
///
/// // Steps of 100 s and 70 s within 60 s: of the second alone 10 s are missing, of both 110 s.
/// let network = json::read(r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
///     "requirements": [{"from": "a", "to": "b", "lower": 100}, {"from": "b", "to": "c", "lower": 70},
///                      {"from": "a", "to": "c", "upper": 60}]}"#).unwrap();
/// let deadline = Knob::of(Part::RequirementUpper(2)).unwrap();
/// let change = least_changes(&network, &[deadline]).unwrap().remove(0).unwrap();
/// let found = witness(&network, &change).unwrap().unwrap();
/// assert_eq!((found.conflict.total.to_string().as_str(), found.conflict.members.len()), ("-110", 3));
/// ```
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn witness(network: &Network, change: &Change) -> Result<Option<Witness>, TooLarge> {
    let (Some(amount), Some(value)) = (change.amount(), change.just_before()) else { return Ok(None) };
    let Some(before) = change.knob.at(network, value) else { return Ok(None) };
    let Verdict::Uncontrollable(found) = check(&before)? else { return Ok(None) };
    let Some(conflict) = restated(found, network) else { return Ok(None) };
    let is_turned = |share: &&Share| change.knob.parts().contains(&share.part);
    let times: u32 = conflict.members.iter().filter(is_turned).map(|share| share.times).sum();
    let (amount, missing) = (i128::from(amount.as_micros()), -i128::from(conflict.total.as_micros()));
    let is_exact = missing <= amount * i128::from(times) && missing > (amount - 1) * i128::from(times);
    let is_proven = is_exact && check(&only(network, &conflict))? != Verdict::Controllable;
    Ok(is_proven.then_some(Witness { conflict, times }))
}

/// A conflict with the amounts that the bounds have in another network.
fn restated(conflict: Conflict, network: &Network) -> Option<Conflict> {
    let mut total = Duration::ZERO;
    let mut members = Vec::new();
    for share in conflict.members {
        let amount = share.part.signed(network).as_micros().checked_mul(i64::from(share.times))?;
        let amount = Duration::from_micros(amount);
        total = total.checked_add(amount)?;
        members.push(Share { amount, ..share });
    }
    Some(Conflict { members, total, ..conflict })
}

/// The network of the members of a conflict and nothing else.
fn only(network: &Network, conflict: &Conflict) -> Network {
    let has = |part: Part| conflict.members.iter().any(|share| share.part == part);
    let kept = |(index, requirement): (usize, &Requirement)| {
        let is_join = has(Part::Join(index));
        let bound = |is_kept: bool, bound: Bound| if is_kept || is_join { bound } else { Bound::Infinite };
        Requirement {
            lower: bound(has(Part::RequirementLower(index)), requirement.lower),
            upper: bound(has(Part::RequirementUpper(index)), requirement.upper),
            ..*requirement
        }
    };
    let is_there = |link: usize| conflict.members.iter().any(|share| share.part.link() == Some(link));
    let requirements = network.requirements().iter().enumerate().map(kept).collect();
    let links = network.contingents().iter().enumerate().filter(|(index, _)| is_there(*index));
    let links = links.map(|(_, link)| *link).collect();
    Network::new(network.name().to_string(), network.origin(), network.events().to_vec(), requirements, links)
        .unwrap_or_else(|errors| unreachable!("part of a valid network is valid: {errors:?}"))
}
