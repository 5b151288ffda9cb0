//! Why a network is not controllable: a semi-reducible negative cycle, in terms of the constraints a user wrote.

use crate::model::{EventId, Network};
use crate::time::{Bound, Duration};

/// The constraints that cannot all be honoured, whatever strategy is tried.
///
/// The proof is arithmetic: going round the cycle each member contributes its signed `amount`, and the amounts add up
/// to `total`, which is negative: that much time is missing between them. It is one conflict of
/// perhaps several, not the one that lacks most, so another may remain when this one is settled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// The members in the order of the network: requirements first, then links; each part at most once.
    pub members: Vec<Share>,
    /// The sum of the amounts, always negative (`-21 s` reads: 21 s too little).
    pub total: Duration,
    /// True if a cleverer use of the news of a delayed chain might still find a strategy; see `reduce`.
    pub conservative: bool,
}

/// What one part of one constraint contributes to a conflict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// The constraint.
    pub part: Part,
    /// How many times the cycle uses it. More than once is rare but possible; 0 is a link that only has to be there
    /// (in a chain it says how the news of later events is to be used).
    pub times: u32,
    /// Its contribution in all: `times` times the bound, with the sign given at [`Part`].
    pub amount: Duration,
}

/// One bound of one constraint. Indices are those of [`crate::Network::requirements`] and [`crate::Network::contingents`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The upper bound of a requirement: contributes `+upper`.
    RequirementUpper(usize),
    /// The lower bound of a requirement: contributes `-lower`.
    RequirementLower(usize),
    /// Nature may take the least: contributes `+lower`.
    LinkLower(usize),
    /// Nature may take the most: contributes `-upper`.
    LinkUpper(usize),
    /// The news may be early: contributes `+min`.
    DelayMin(usize),
    /// The news may be late: contributes `-max`.
    DelayMax(usize),
    /// No event comes before the origin: contributes nothing.
    AfterOrigin,
    /// A [0, 0] requirement by which merging made two events one: contributes nothing, but the conflict rests on it.
    Join(usize),
}

impl Share {
    /// The bound itself, without sign: what the network says there.
    pub fn bound(&self, network: &Network) -> Duration {
        self.part.bound(network)
    }
}

impl Part {
    /// The contingent link it is of.
    pub fn link(self) -> Option<usize> {
        match self {
            Part::LinkLower(link) | Part::LinkUpper(link) | Part::DelayMin(link) | Part::DelayMax(link) => {
                Some(link)
            }
            _ => None,
        }
    }

    /// The requirement it is of.
    pub fn requirement(self) -> Option<usize> {
        match self {
            Part::RequirementUpper(index) | Part::RequirementLower(index) | Part::Join(index) => Some(index),
            _ => None,
        }
    }

    /// From where to where the constraint reaches that it is of.
    pub fn ends(self, network: &Network) -> Option<(EventId, EventId)> {
        let requirement = self.requirement().map(|index| network.requirements()[index]);
        let link = self.link().map(|index| network.contingents()[index]);
        requirement.map(|it| (it.from, it.to)).or(link.map(|it| (it.from, it.to)))
    }

    /// True if its bound counts with a minus: less of it is harder to keep, and of the others more.
    pub fn is_subtracted(self) -> bool {
        matches!(self, Part::RequirementLower(_) | Part::LinkUpper(_) | Part::DelayMax(_))
    }

    /// What one use of it contributes: the bound with its sign.
    pub fn signed(self, network: &Network) -> Duration {
        let bound = self.bound(network);
        if self.is_subtracted() { -bound } else { bound }
    }

    /// The bound itself, without sign: what the network says there. Zero for what has no bound.
    pub fn bound(self, network: &Network) -> Duration {
        let finite = |bound: Bound| bound.finite().unwrap_or_default();
        match self {
            Part::RequirementUpper(index) => finite(network.requirements()[index].upper),
            Part::RequirementLower(index) => finite(network.requirements()[index].lower),
            Part::LinkLower(index) => network.contingents()[index].lower,
            Part::LinkUpper(index) => network.contingents()[index].upper,
            Part::DelayMin(index) => network.contingents()[index].delay.min,
            Part::DelayMax(index) => finite(network.contingents()[index].delay.max),
            Part::AfterOrigin | Part::Join(_) => Duration::ZERO,
        }
    }
}
