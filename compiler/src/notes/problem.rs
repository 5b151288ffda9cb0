//! What may surprise in a model that is legal.

use kirk_network::{Delay, Duration, Share};

use crate::episode::Episode;
use crate::explain::problem::Stated;
use crate::origins::Subject;
use crate::source::Span;

/// What may surprise, and what is known about it.
pub(crate) enum Problem<'a> {
    /// An activity starts at the true end of one whose end is heard late.
    StartsAtDelayedEnd { activity: &'a Episode, before: &'a Subject, delay: Delay, news: Span },
    /// News whose delay varies by more than what it tells of.
    UselessNews { activity: &'a Episode, delay: (Duration, Span), duration: (Duration, Span) },
    /// An upper bound above the most that is inside.
    NeverBinds { bound: Span, limit: Duration, most: Duration },
    /// An activity that can only start at one moment.
    NeverLate(NeverLate<'a>),
}

/// Activities that can only start at one moment, and the bounds between which no time is left for that.
pub(crate) struct NeverLate<'a> {
    pub(crate) activity: &'a Episode,
    pub(crate) others: Vec<&'a Episode>,
    /// So long after this.
    pub(crate) after: Duration,
    pub(crate) moment: Moment<'a>,
    pub(crate) bounds: Vec<Stated<'a>>,
    pub(crate) amounts: Vec<Share>,
}

/// What happens at a moment.
#[derive(Clone, Copy)]
pub(crate) enum Moment<'a> {
    MissionStarts,
    NewsComes(&'a Episode),
    Starts(&'a Episode),
    Ends(&'a Episode),
    Unknown,
}
