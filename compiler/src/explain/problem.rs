//! What is known of a conflict. The words for it are in `wording/conflict.rs`.

use kirk_network::{Bound, Conflict, Duration, Share};

use super::amounts::Enough;
use super::{Explain, StoryStep};
use crate::origins::Origin;
use crate::source::Span;

/// A conflict, and all that is to be told of it.
pub(crate) struct Problem<'a> {
    pub(crate) explain: Explain<'a>,
    pub(crate) conflict: &'a Conflict,
    pub(crate) kind: Kind,
    /// What it consists of.
    pub(crate) bounds: Vec<Stated<'a>>,
    pub(crate) story: &'a [StoryStep],
    /// What settles it alone; `None` if that was not looked for.
    pub(crate) enough: Option<&'a Enough>,
    /// What might settle it besides.
    pub(crate) remedies: Vec<Remedy>,
    /// There are others.
    pub(crate) is_one_of_several: bool,
}

/// What does not go together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Each comes after the one before.
    Circle,
    /// Ends that are joined.
    Ends,
    Bounds,
}

/// What one part of a conflict says, where, and how often it counts.
pub(crate) struct Stated<'a> {
    pub(crate) says: Says,
    pub(crate) origin: &'a Origin,
    pub(crate) span: Span,
    pub(crate) share: Share,
}

/// What a part of a conflict says.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Says {
    AtLeast(Duration),
    AtMost(Duration),
    NatureAtLeast(Duration),
    NatureAtMost(Duration),
    NewsAtLeast(Duration),
    NewsAtMost(Bound),
    /// What the joins of a `parallel` come to where Nature has no say.
    Joined,
    /// Nothing that would take time is between its events.
    Nothing,
    /// What its origin says.
    Itself,
}

/// What might settle a conflict.
#[derive(Clone, Copy)]
pub(crate) enum Remedy {
    LongerUpperBound,
    /// Where an end that Nature decides has to meet another event.
    SlackForNature,
    SlackInParallel,
    NarrowerContingent,
    SoonerNews,
}
