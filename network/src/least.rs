//! The least change of one bound that makes a network controllable, all else as it is.
//!
//! The question of P. Yu and B. Williams, *Continuously relaxing over-constrained conditional temporal problems*, IJCAI 2013,
//! for one bound at a time. What a conflict lacks is no answer to it, only a guess: there may be another conflict, and a cycle
//! may cease to be semi-reducible before its sum is mended. The verdict itself is asked instead (`vary.rs`).

use std::collections::BTreeSet;
use std::iter::successors;

use crate::conflict::{Conflict, Part};
use crate::merge::merge;
use crate::model::{EventId, Network};
use crate::stnu::TooLarge;
use crate::vary::{Change, Knob, Probe};

/// For each knob the least change that makes the network controllable, all else as it is; `None` if no value of it does.
/// Of a network that is controllable each knob is left where it is.
///
/// At the value of a change the verdict is "yes", a microsecond before it "no". A shortest delay follows a longest one that
/// becomes less.
///
/// ```
/// use kirk_network::least::least_changes;
/// use kirk_network::vary::Knob;
/// use kirk_network::{Part, json};
///
/// // C must come within 3 s of B, whose news is up to 5 s late.
/// let network = json::read(r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
///     "requirements": [{"from": "b", "to": "c", "lower": 0, "upper": 3}],
///     "contingents": [{"from": "a", "to": "b", "lower": 10, "upper": 20, "delay": [0, 5]}]}"#).unwrap();
/// let knobs = [Part::RequirementUpper(0), Part::RequirementLower(0), Part::DelayMax(0)].map(|part| Knob::of(part).unwrap());
/// let changes = least_changes(&network, &knobs).unwrap();
/// let to = |index: usize| changes[index].as_ref().map(|change| change.to.finite().unwrap().to_string());
/// assert_eq!([to(0), to(1), to(2)], ["5", "-7", "3"].map(|to| Some(to.to_string())));
/// ```
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn least_changes(network: &Network, knobs: &[Knob]) -> Result<Vec<Option<Change>>, TooLarge> {
    let mut probe = Probe::new(network);
    let controllable = probe.as_is()?;
    let least = |knob: &Knob| {
        let dial = probe.dial(knob);
        if controllable {
            return Some(dial.change(dial.here));
        }
        let far = dial.easiest_followed;
        let helps = far != dial.here && probe.is_yes(&dial, far);
        helps.then(|| dial.change(probe.boundary(&dial, dial.here, far)))
    };
    Ok(knobs.iter().map(least).collect())
}

/// The bounds of which one alone might settle a conflict: those of its members, all four of a link. How late the news of it is
/// decides whether it is of any use, whatever share it has. What is not in a conflict leaves it as it is, but for one
/// thing: events that follow from the same activation may tell of one another.
pub fn could_settle(network: &Network, conflict: &Conflict) -> Vec<Part> {
    let merged = merge(network).network;
    let root = |link: usize| {
        let parent = |event: &EventId| Some(merged.contingents()[merged.link_of(*event)?].from);
        successors(Some(merged.contingents()[link].to), parent).last()
    };
    let (mut parts, mut roots) = (BTreeSet::new(), BTreeSet::new());
    for share in &conflict.members {
        match share.part {
            Part::RequirementUpper(_) | Part::RequirementLower(_) => {
                parts.insert(share.part);
            }
            Part::Join(index) => parts.extend([Part::RequirementUpper(index), Part::RequirementLower(index)]),
            part => roots.extend(part.link().map(root)),
        }
    }
    for link in (0..merged.contingents().len()).filter(|link| roots.contains(&root(*link))) {
        parts.extend([
            Part::LinkLower(link),
            Part::LinkUpper(link),
            Part::DelayMin(link),
            Part::DelayMax(link),
        ]);
    }
    parts.into_iter().collect()
}
