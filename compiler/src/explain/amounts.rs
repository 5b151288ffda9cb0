//! Which amounts of a conflict are enough by themselves, and at which value: proven, not read off the sum.

use std::collections::BTreeSet;

use kirk_network::least::{could_settle, least_changes};
use kirk_network::vary::{Change, Knob};
use kirk_network::witness::{Witness, witness};
use kirk_network::{Conflict, Network, Part, Share};

use crate::origins::{Origin, Origins};
use crate::repair::{Changed, change_of_source};
use crate::source::Source;
use crate::written::{Written, written};

/// Each value is found by asking for the verdict again and again. So many events may be looked at in all: a knob that does not
/// help costs a verdict, one that does a few.
const EFFORT: usize = 200_000;
/// So many conflicts are looked for that lack what a change is.
const WITNESSES: usize = 4;

/// What settles a conflict alone.
pub(crate) struct Enough {
    pub(crate) changes: Vec<Changed>,
    /// Others were not tried, as that would keep the reader waiting.
    pub(crate) are_all: bool,
    /// The conflict that lacks what the first of them is.
    pub(crate) witness: Option<Witness>,
}

/// As a change of the source, every amount with the least change that alone makes the program controllable: what is
/// ours and the news, and only if none of that is enough, what Nature decides. `rest` is the network with other conflicts out of
/// the way.
pub(super) fn enough_alone(
    conflict: &Conflict,
    network: &Network,
    rest: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Enough {
    let parts: BTreeSet<Part> = could_settle(network, conflict).into_iter().collect();
    let is_meant = |part: Part, _: &Origin| !matches!(part, Part::DelayMin(_));
    let concerned = written(network, origins, is_meant).into_iter().filter(|written| {
        written.parts.iter().any(|part| parts.contains(part)) && written.has_one_value(network)
    });
    // What is out of the way with another conflict need not change with the others.
    let is_there = |part: &Part| {
        let value = |network| Knob::of(*part).map(|knob| knob.value(network));
        value(rest) == value(network)
    };
    let knob = |Written { parts, .. }: Written<'_>| {
        let knob = Knob::together(parts.into_iter().filter(is_there).collect())?;
        Some(knob.in_its_sense(rest))
    };
    let mut knobs: Vec<Knob> = concerned.filter_map(knob).collect();
    // What may be allowed comes before what may be asked for.
    knobs.sort_by_key(|knob| knob.parts()[0]);
    let most = (EFFORT / rest.events().len().max(1)).max(1);
    let (natures, ours): (Vec<Knob>, Vec<Knob>) =
        knobs.into_iter().partition(|knob| is_natures(knob.parts()[0]));
    let mut changes = least(rest, &ours, most);
    let mut are_all = ours.len() <= most;
    if changes.is_empty() && are_all {
        changes = least(rest, &natures, most);
        are_all = natures.len() <= most;
    }
    let witness = begin_with_a_witness(&mut changes, conflict, rest);
    let changed = |change: &Change| change_of_source(change, network, origins, sources);
    Enough { changes: changes.iter().filter_map(changed).collect(), are_all, witness }
}

/// The least changes of the first of some knobs.
fn least(network: &Network, knobs: &[Knob], most: usize) -> Vec<Change> {
    let tried = &knobs[..knobs.len().min(most)];
    least_changes(network, tried).unwrap_or_default().into_iter().flatten().collect()
}

/// Puts a change first of which there is a conflict that lacks as much, rather one that counts once. The one that was found may be it.
fn begin_with_a_witness(changes: &mut [Change], known: &Conflict, network: &Network) -> Option<Witness> {
    let lacks = |change: &Change| {
        let share = |share: &&Share| change.knob.parts() == [share.part] && share.times == 1;
        let is_once = known.members.iter().any(|it| share(&it));
        is_once && change.amount() == Some(known.total.abs())
    };
    if let Some(at) = changes.iter().position(lacks) {
        changes[..=at].rotate_right(1);
        return Some(Witness { conflict: known.clone(), times: 1 });
    }
    let mut found: Option<(usize, Witness)> = None;
    for (at, change) in changes.iter().enumerate().take(WITNESSES) {
        let Ok(Some(witness)) = witness(network, change) else { continue };
        let is_plain = witness.times == 1;
        if is_plain || found.is_none() {
            found = Some((at, witness));
        }
        if is_plain {
            break;
        }
    }
    let (at, witness) = found?;
    changes[..=at].rotate_right(1);
    Some(witness)
}

fn is_natures(part: Part) -> bool {
    matches!(part, Part::LinkLower(_) | Part::LinkUpper(_))
}
