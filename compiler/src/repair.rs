//! What would make a mission controllable, as changes of its source.
//!
//! The bounds that somebody has written are what may be turned (`levers`); which of them, and how far, is found by
//! [`kirk_network::repair`]; what that is in the source is an [`Edit`] (`edit`). Where no amount is enough, slack in a form whose
//! parts have to meet, or an order less, is tried. What is proposed is proven of the network. That the edit says the same is for
//! whoever can read the edited source to prove.

mod edit;
mod structure;

use std::collections::{BTreeMap, BTreeSet};

use kirk_network::conflicts::conflicts;
use kirk_network::least::could_settle;
use kirk_network::repair::{Allowed, Extent, Options, Repair, Repairs, repairs};
use kirk_network::stnu::TooLarge;
use kirk_network::vary::{Change, Knob};
use kirk_network::{Bound, Duration, Network, Part};

use crate::diagnostic::{Edit, Suggestion};
use crate::origins::{Origin, OriginKind, Origins, Side};
use crate::source::{Source, Span};
pub use crate::wording::repair::what;
use crate::written::{Written, written};
pub(crate) use edit::unit;
pub use edit::{Unit, written_unit};
use structure::Restructured;
pub use structure::slack;

/// What is wanted of a repair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wishes {
    /// Nature's durations may change, too.
    pub nature: bool,
    /// What is to stay as it is, by its names.
    pub keep: Vec<String>,
    /// What is to change first.
    pub prefer: Option<Preference>,
    /// How many times as dear a change of something is as it would be, in millionths.
    pub weights: Vec<(String, u64)>,
    /// So many proposals at most.
    pub limit: usize,
    /// How long to look: so many verdicts at most, times the events each is about.
    pub effort: usize,
}

impl Default for Wishes {
    /// What is ours may change, nothing rather than anything else, and there are five proposals at most.
    fn default() -> Wishes {
        let effort = 8_000_000;
        Wishes { nature: false, keep: Vec::new(), prefer: None, weights: Vec::new(), limit: 5, effort }
    }
}

/// What is rather changed than all else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preference {
    /// By when news is here.
    News,
    /// Bounds between events, and around forms.
    Deadlines,
    /// How long activities of ours take.
    Durations,
}

/// A proposal: with all its changes the network is controllable, and without any one of them it is not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposal {
    /// What is changed.
    pub changes: Vec<Changed>,
}

/// One change. The words for it are in `wording/repair.rs`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changed {
    /// What it is.
    pub change: ChangeKind,
    /// What is changed.
    pub origin: Origin,
    /// Where.
    pub place: Span,
    /// The change of the source; nothing if what is read there is nothing to edit.
    pub edits: Vec<Edit>,
}

/// What is changed of a constraint, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangeKind {
    /// A bound gets another amount, which is told in the unit that is written.
    Amount {
        /// The bound.
        part: Part,
        /// What it is.
        from: Bound,
        /// What it becomes.
        to: Bound,
        /// The unit.
        unit: Unit,
    },
    /// What it says is no more said, or less of it.
    Loosened(Loosening),
}

/// How a constraint of which no amount is written is made looser.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Loosening {
    /// The form it comes from has slack.
    Slack,
    /// It is an order, and is left out.
    Order,
}

impl Changed {
    fn amount(
        change: &Change,
        origin: &Origin,
        place: Span,
        edits: Vec<Edit>,
        sources: &[Source],
    ) -> Changed {
        let Change { from, to, .. } = *change;
        let part = change.knob.parts()[0];
        let change = ChangeKind::Amount { part, from, to, unit: edit::unit(place, sources) };
        Changed { change, origin: origin.clone(), place, edits }
    }

    /// From which amount to which; nothing if it is no amount.
    pub fn amounts(&self) -> Option<(Bound, Bound)> {
        match self.change {
            ChangeKind::Amount { from, to, .. } => Some((from, to)),
            ChangeKind::Loosened(_) => None,
        }
    }

    /// By how much an amount changes, in words; nothing if that is without end, or it is no amount.
    pub(crate) fn amount_changed(&self) -> Option<String> {
        let ChangeKind::Amount { from, to, unit, .. } = self.change else { return None };
        Some(unit.say(to.finite()?.checked_sub(from.finite()?)?.abs()))
    }

    /// The change of the source, if it can be made there.
    pub(crate) fn suggestion(&self) -> Option<Suggestion> {
        self.is_editable().then(|| Suggestion { title: self.title(), edits: self.edits.clone() })
    }

    /// True if it can be made in the source.
    pub fn is_editable(&self) -> bool {
        !self.edits.is_empty()
    }
}

impl Proposal {
    /// True if it can be made in the source: each of its changes can be.
    pub fn is_applicable(&self) -> bool {
        self.changes.iter().all(Changed::is_editable)
    }
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposals {
    /// The cheapest first: what costs more changes more, each for its size.
    pub proposals: Vec<Proposal>,
    /// What cannot make it controllable alone: which bound of what, and where it is written.
    pub not_alone: Vec<(Part, Origin, Span)>,
    /// True if the search was given up before it was at its end.
    pub gave_up: bool,
}

/// So many programs and verdicts at most for the amounts beside each change of the structure.
const FEW: usize = 100;

/// A bound that somebody has written, or several that are written once.
struct Lever<'a> {
    allowed: Allowed,
    origin: &'a Origin,
    place: Span,
}

/// What would make a network controllable; `None` if it is. `sources` are the texts the origins point into.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn proposals(
    network: &Network,
    origins: &Origins,
    sources: &[Source],
    wishes: &Wishes,
) -> Result<Option<Proposals>, TooLarge> {
    let levers = levers(network, origins, sources, wishes);
    let allowed: Vec<Allowed> = levers.values().map(|lever| lever.allowed.clone()).collect();
    let Options { rounds, patience, .. } = Options::default();
    let verdicts = wishes.effort / network.events().len().max(1);
    let options =
        Options { limit: wishes.limit, rounds: rounds.min(verdicts), patience: patience.min(verdicts) };
    let Some(Repairs { repairs, not_alone, extent }) = repairs(network, &allowed, &options)? else {
        return Ok(None);
    };
    let changed = |change: &Change| {
        let Lever { origin, place, .. } = levers.get(&change.knob)?;
        let edits = edit::edits(change, network, origin, sources);
        Some(Changed::amount(change, origin, *place, edits, sources))
    };
    let proposal = |changes: &[Change]| {
        let changes: Option<Vec<Changed>> = changes.iter().map(changed).collect();
        changes.map(|changes| Proposal { changes })
    };
    // That something takes no time at all is the last thing to propose.
    let (nothing, some): (Vec<&Repair>, Vec<&Repair>) = repairs.iter().partition(|it| takes_no_time(it));
    let of_amounts = |repairs: Vec<&Repair>| -> Vec<Proposal> {
        repairs.into_iter().filter_map(|it| proposal(&it.changes)).collect()
    };
    // One change first.
    let (single, joint) = some.into_iter().partition(|it| it.changes.len() == 1);
    let mut found = of_amounts(single);
    found.extend(of_amounts(joint));
    let amounts = |loose: &Network, limit: usize| -> Result<Vec<Repair>, TooLarge> {
        let options = Options { limit, rounds: options.rounds.min(FEW), patience: options.patience.min(FEW) };
        Ok(kirk_network::repair::repairs(loose, &allowed, &options)?.map_or(Vec::new(), |it| it.repairs))
    };
    for Restructured { mut changes, amounts } in
        structure::found(network, origins, sources, wishes, found.len(), amounts)?
    {
        let amounts: Option<Vec<Changed>> = amounts.iter().map(changed).collect();
        changes.extend(amounts.unwrap_or_default());
        found.push(Proposal { changes });
    }
    found.extend(of_amounts(nothing));
    found.truncate(wishes.limit);
    // What has no part in the conflicts cannot settle them, which goes without saying.
    let mut blamed: BTreeSet<Part> = BTreeSet::new();
    for conflict in conflicts(network, wishes.limit)? {
        blamed.extend(could_settle(network, &conflict));
    }
    let alone = |knob: &Knob| {
        let lever = levers.get(knob).filter(|_| knob.parts().iter().any(|part| blamed.contains(part)))?;
        Some((knob.parts()[0], lever.origin.clone(), lever.place))
    };
    let not_alone = not_alone.iter().filter_map(alone).collect();
    Ok(Some(Proposals { proposals: found, not_alone, gave_up: extent == Extent::OutOfRounds }))
}

/// True if something that takes time is to take none.
fn takes_no_time(repair: &Repair) -> bool {
    let is_least = |change: &Change| matches!(change.knob.parts()[0], Part::RequirementLower(_));
    repair.changes.iter().any(|change| change.to == Bound::ZERO && is_least(change))
}

/// An amount in the unit that is written at a place.
pub(crate) fn amount(amount: Duration, place: Span, sources: &[Source]) -> String {
    edit::unit(place, sources).say(amount)
}

/// A change, as what it is in the source if it can be made there.
pub(crate) fn change_of_source(
    change: &Change,
    network: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Option<Changed> {
    let part = change.knob.parts()[0];
    let (origin, side) = origins.of(part)?;
    let place = origin.place(side);
    let edits = match is_changeable(part, network, origin, sources) {
        true => edit::edits(change, network, origin, sources),
        false => Vec::new(),
    };
    Some(Changed::amount(change, origin, place, edits, sources))
}

/// All names by which bounds can be kept or weighed.
pub fn names(origins: &Origins) -> impl Iterator<Item = &str> {
    let all = origins.requirements.iter().chain(&origins.contingents);
    all.flat_map(|origin| &origin.names).map(String::as_str)
}

/// The bounds that may be turned. What is written once is turned as one.
fn levers<'a>(
    network: &Network,
    origins: &'a Origins,
    sources: &[Source],
    wishes: &Wishes,
) -> BTreeMap<Knob, Lever<'a>> {
    let is_meant = |part: Part, origin: &Origin| {
        let may_change = match part {
            Part::DelayMin(_) => false,
            Part::LinkLower(_) | Part::LinkUpper(_) => wishes.nature,
            _ => true,
        };
        may_change && is_changeable(part, network, origin, sources)
    };
    let is_kept = |origin: &Origin| wishes.keep.iter().any(|name| is_called(origin, name));
    let lever = |written: Written<'a>| {
        // What is written once is all that is read there, to keep and to weigh.
        let all: Vec<&Origin> = written.parts.iter().filter_map(|part| origins.constraint(*part)).collect();
        if !written.has_one_value(network) || all.iter().any(|origin| is_kept(origin)) {
            return None;
        }
        let (part, place, origin) = (written.parts[0], written.place(), written.origin);
        let knob = Knob::together(written.parts)?.in_its_sense(network);
        let unit = edit::step(place, knob.value(network), sources);
        let mut allowed = Allowed::relative(network, knob.clone(), unit);
        allowed.weight = weight(allowed.weight, part, &all, wishes);
        Some((knob, Lever { allowed, origin, place }))
    };
    written(network, origins, is_meant).into_iter().filter_map(lever).collect()
}

/// True if a bound is there and is written by itself.
fn is_changeable(part: Part, network: &Network, origin: &Origin, sources: &[Source]) -> bool {
    let Some(knob) = Knob::of(part) else { return false };
    let is_there = match part {
        // News that comes at once cannot come sooner.
        Part::DelayMax(_) => knob.value(network) != Bound::ZERO,
        _ => knob.value(network) != Bound::Infinite,
    };
    let by_itself = match origin.kind {
        OriginKind::Requirement | OriginKind::Link => true,
        _ => match part {
            Part::DelayMax(_) => origin.place(Side::MaxDelay) != origin.span,
            _ => origin.place(Side::Lower) != origin.place(Side::Upper) || edit::says_both(origin),
        },
    };
    is_there && by_itself && edit::is_written(part, origin, sources)
}

fn is_called(origin: &Origin, name: &str) -> bool {
    origin.names.iter().any(|known| known.eq_ignore_ascii_case(name))
}

/// What a microsecond costs.
fn weight(relative: u64, part: Part, origins: &[&Origin], wishes: &Wishes) -> u64 {
    const DEAR: u128 = 10;
    let is_preferred = match wishes.prefer {
        None => true,
        Some(Preference::News) => matches!(part, Part::DelayMax(_)),
        Some(Preference::Durations) => origins[0].kind == OriginKind::Duration,
        Some(Preference::Deadlines) => {
            let between = matches!(
                origins[0].kind,
                OriginKind::Constraint | OriginKind::Between | OriginKind::Requirement
            );
            between && !matches!(part, Part::DelayMax(_))
        }
    };
    let mut weight = u128::from(relative) * if is_preferred { 1 } else { DEAR };
    let concerns = |name: &str| origins.iter().any(|origin| is_called(origin, name));
    for (_, millionths) in wishes.weights.iter().filter(|(name, _)| concerns(name)) {
        weight = weight.saturating_mul(u128::from(*millionths)) / 1_000_000;
    }
    u64::try_from(weight).unwrap_or(u64::MAX).max(1)
}
