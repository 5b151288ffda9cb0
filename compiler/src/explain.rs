//! A conflict in the words and places of the program: why it cannot be executed in every case.

pub(crate) mod amounts;
pub(crate) mod problem;
mod story;

pub use story::StoryStep;

use std::collections::BTreeSet;

use kirk_network::conflicts::{conflicts, without};
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Duration, Network, Part, Requirement, Share};

use crate::diagnostic::Diagnostic;
use crate::lower::Lowered;
use crate::origins::{OriginKind, Origins, Side};
use crate::repair::{ChangeKind, Changed};
use crate::source::{Source, Span};
use crate::wording;
use amounts::Enough;
use problem::{Kind, Problem, Remedy, Says, Stated};
use story::steps;

/// How many conflicts are told; of more only how many there are.
const MOST: usize = 10;
/// How many are counted.
const COUNTED: usize = 100;
/// With more events than this a verdict takes its time.
const LARGE: usize = 1_000;

/// What is to be explained: a network that is not controllable, where it comes from, and how.
#[derive(Clone, Copy, Debug)]
pub struct Explain<'a> {
    /// The network of the plan, not merged.
    pub network: &'a Network,
    /// Where its constraints come from.
    pub origins: &'a Origins,
    /// The texts they point into.
    pub sources: &'a [Source],
    /// Where what is executed is named, if it is.
    pub program: Option<Span>,
    /// The signed sum as well.
    pub theory: bool,
}

/// A conflict, and all there is to say about it.
#[derive(Clone, Debug)]
pub struct Told {
    /// Its indices are those of the network that was explained.
    pub conflict: Conflict,
    /// In words and places.
    pub diagnostic: Diagnostic,
    /// Step by step, from event to event; nothing if the walk would be too long to tell anything.
    pub story: Vec<StoryStep>,
    /// The changes of one amount each that settle it, each alone; `None` if they were not looked for.
    pub enough: Option<Vec<Changed>>,
}

impl<'a> Explain<'a> {
    /// Of a program that was compiled from these sources.
    pub fn of(lowered: &'a Lowered, sources: &'a [Source]) -> Explain<'a> {
        let Lowered { network, origins, entry, .. } = lowered;
        Explain { network, origins, sources, program: Some(*entry), theory: false }
    }

    /// Every conflict that has no bound of ours in common with another, each with what would settle it; none if the network is
    /// controllable.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub fn each(&self) -> Result<Vec<Told>, TooLarge> {
        // Each costs a verdict: of large missions no more are looked for than are told.
        let counted = if self.network.events().len() > LARGE { MOST + 1 } else { COUNTED };
        let mut found = conflicts(self.network, counted)?;
        let told = found.len().min(MOST);
        let mut all = Vec::new();
        for index in 0..told {
            // What settles one is seen when the others are out of the way.
            let others = found.iter().enumerate().filter(|(other, _)| *other != index);
            let rest = without(self.network, others.map(|(_, other)| other));
            let enough =
                amounts::enough_alone(&found[index], self.network, &rest, self.origins, self.sources);
            // What lacks all that is missing is told, and not what was found first.
            if let Some(witness) = &enough.witness {
                found[index] = witness.conflict.clone();
            }
            all.push(self.told(&found[index], Some(enough), found.len() > 1));
        }
        if found.len() > told
            && let Some(Told { diagnostic: last, .. }) = all.last_mut()
        {
            wording::conflict::and_more(last, found.len() - told, found.len() == counted);
        }
        Ok(all)
    }

    /// The same, of each no more than its diagnostic.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub fn all(&self) -> Result<Vec<Diagnostic>, TooLarge> {
        Ok(self.each()?.into_iter().map(|told| told.diagnostic).collect())
    }

    /// One conflict of it, or of what it is under an assumption. Its indices are those of the network. What would settle it is not
    /// looked for.
    pub fn one(&self, conflict: &Conflict) -> Told {
        self.told(conflict, None, false)
    }

    /// Words a conflict that these changes settle, each alone.
    fn told(&self, conflict: &Conflict, enough: Option<Enough>, is_one_of_several: bool) -> Told {
        let Explain { network, origins, sources, .. } = *self;
        let amounts = |enough: &Enough| -> BTreeSet<Part> {
            let part = |change: &Changed| match change.change {
                ChangeKind::Amount { part, .. } => Some(part),
                ChangeKind::Loosened(_) => None,
            };
            enough.changes.iter().filter_map(part).collect()
        };
        let settling = enough.as_ref().map(amounts).unwrap_or_default();
        let story = steps(conflict, network, origins, sources, &settling).unwrap_or_default();
        let conflict = &with_late_news(conflict, &story);
        let mut bounds: Vec<Stated<'_>> = Vec::new();
        for stated in conflict.members.iter().filter_map(|share| stated(share, network, origins)) {
            // That the parts are joined goes without saying where it is said what is joined.
            let is_bare = stated.says == Says::Joined && stated.share.times <= 1;
            if !is_bare || bounds.iter().all(|known| known.span != stated.span) {
                bounds.push(stated);
            }
        }
        let diagnostic = wording::conflict::told(&Problem {
            explain: *self,
            conflict,
            kind: kind(conflict, network, origins),
            bounds,
            story: &story,
            enough: enough.as_ref(),
            remedies: remedies(conflict, network, origins, enough.is_some()),
            is_one_of_several,
        });
        Told { conflict: conflict.clone(), diagnostic, story, enough: enough.map(|enough| enough.changes) }
    }
}

/// The same with the news as members that is said to be too late: it takes nothing from the sum, and would have to come sooner.
fn with_late_news(conflict: &Conflict, story: &[StoryStep]) -> Conflict {
    let mut conflict = conflict.clone();
    for part in story.iter().map(|step| step.part).filter(|part| matches!(part, Part::DelayMax(_))) {
        if conflict.members.iter().all(|share| share.part != part) {
            conflict.members.push(Share { part, times: 0, amount: Duration::ZERO });
        }
    }
    conflict.members.sort_by_key(|share| share.part);
    conflict
}

/// What does not go together.
fn kind(conflict: &Conflict, network: &Network, origins: &Origins) -> Kind {
    let parts = || conflict.members.iter().map(|share| share.part);
    let of_ours = |part: Part| {
        let bound = part.bound(network) != Duration::ZERO || matches!(part, Part::RequirementUpper(_));
        let is_ours = matches!(part, Part::RequirementUpper(_) | Part::RequirementLower(_));
        bound && is_ours && origins.constraint(part).is_some_and(|origin| origin.kind.is_amount())
    };
    let is_joined = |part: Part| origins.constraint(part).is_some_and(|origin| origin.kind.is_join());
    if is_circle(conflict) {
        Kind::Circle
    } else if !parts().any(of_ours) && parts().any(is_joined) {
        Kind::Ends
    } else {
        Kind::Bounds
    }
}

/// True if every step leads on, and none back. A bound that is below zero leads the other way.
fn is_circle(conflict: &Conflict) -> bool {
    let leads_back = |share: &Share| match share.part {
        Part::RequirementLower(_) => share.amount > Duration::ZERO,
        Part::RequirementUpper(_) => share.amount >= Duration::ZERO,
        Part::LinkLower(_) | Part::DelayMin(_) | Part::Join(_) | Part::AfterOrigin => true,
        Part::LinkUpper(_) | Part::DelayMax(_) => false,
    };
    !conflict.members.iter().any(leads_back)
}

/// What might settle a conflict; of the amounts only if it is not known which are enough.
fn remedies(conflict: &Conflict, network: &Network, origins: &Origins, is_known: bool) -> Vec<Remedy> {
    let has = |wanted: &dyn Fn(Part) -> bool| conflict.members.iter().any(|share| wanted(share.part));
    let is_of = |part: Part, is: &dyn Fn(OriginKind) -> bool| {
        origins.constraint(part).is_some_and(|origin| is(origin.kind))
    };
    let joined = has(&|part| match part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => {
            is_of(part, &OriginKind::is_join) && is_natures(network, network.requirements()[index])
        }
        _ => false,
    });
    let side_by_side =
        has(&|part| matches!(part, Part::Join(_)) && is_of(part, &|kind| kind == OriginKind::SideBySide));
    let bounded =
        has(&|part| matches!(part, Part::RequirementUpper(_)) && is_of(part, &|kind| !kind.is_join()));
    let uncertain = has(&|part| matches!(part, Part::LinkUpper(_) | Part::LinkLower(_)));
    let late = has(&|part| matches!(part, Part::DelayMax(_)));
    let all = [
        (bounded && !is_known, Remedy::LongerUpperBound),
        (joined, Remedy::SlackForNature),
        (side_by_side && !joined, Remedy::SlackInParallel),
        (uncertain && !is_known, Remedy::NarrowerContingent),
        (late && !is_known, Remedy::SoonerNews),
    ];
    all.into_iter().filter_map(|(is_meant, remedy)| is_meant.then_some(remedy)).collect()
}

/// True if Nature decides when one of the events of a requirement is.
fn is_natures(network: &Network, Requirement { from, to, .. }: Requirement) -> bool {
    network.link_of(from).is_some() || network.link_of(to).is_some()
}

/// What one part of the conflict says, and where. `None` for what a user need not know.
pub(crate) fn stated<'a>(share: &Share, network: &Network, origins: &'a Origins) -> Option<Stated<'a>> {
    let origin = origins.constraint(share.part)?;
    if share.times == 0 && !matches!(share.part, Part::Join(_) | Part::DelayMax(_)) {
        return None;
    }
    let requirement = |index: usize| network.requirements().get(index);
    let link = |index: usize| network.contingents().get(index);
    let says = match share.part {
        Part::RequirementUpper(index) => Says::AtMost(requirement(index)?.upper.finite()?),
        Part::RequirementLower(index) => {
            let requirement = requirement(index)?;
            if origin.kind == OriginKind::Order && !is_natures(network, *requirement) {
                return None;
            }
            Says::AtLeast(requirement.lower.finite()?)
        }
        Part::LinkLower(index) => Says::NatureAtLeast(link(index)?.lower),
        Part::LinkUpper(index) => Says::NatureAtMost(link(index)?.upper),
        Part::DelayMin(index) => Says::NewsAtLeast(link(index)?.delay.min),
        Part::DelayMax(index) => Says::NewsAtMost(link(index)?.delay.max),
        // That one follows the other goes without saying; that they run side by side, or that nothing takes time, not.
        Part::Join(index) => match origin.kind {
            OriginKind::SideBySide if is_natures(network, *requirement(index)?) => Says::Itself,
            OriginKind::SideBySide => Says::Joined,
            OriginKind::Empty => Says::Nothing,
            OriginKind::Between | OriginKind::Requirement => Says::Itself,
            _ => return None,
        },
        Part::AfterOrigin => return None,
    };
    let span = Side::of(share.part)
        .filter(|_| origin.kind.is_amount())
        .map_or(origin.span, |side| origin.place(side));
    Some(Stated { says, origin, span, share: *share })
}
