//! What decided when an event was fixed.

use kirk_network::{Duration, EventId, Time};

/// What an event waited for last: nothing allowed it to be fixed before, and nothing held it after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// For nothing: it is fixed at time zero.
    Start,
    /// Until so long after another event was fixed; for one of Nature's at no distance, for its news.
    After {
        /// The other event.
        event: EventId,
        /// How long after it.
        distance: Duration,
    },
    /// Until so long after the latest that another event, known only roughly, can have happened.
    Surely {
        /// The other event.
        event: EventId,
        /// The latest it can have happened.
        latest: Time,
        /// How long after that.
        distance: Duration,
    },
    /// For another event, which it must not come before.
    Order {
        /// The other event.
        event: EventId,
    },
    /// For the news of another event, or of itself, which had not come by then.
    Unobserved {
        /// The event not heard of.
        event: EventId,
        /// The event from which the time is measured.
        since: EventId,
        /// How long after that.
        distance: Duration,
    },
    /// For its own news.
    Observed,
    /// Its own news came early, and counts from then on.
    Held {
        /// The event from which the time is measured.
        since: EventId,
        /// How long after that.
        distance: Duration,
    },
    /// For a plan that was made anew of all that was known, with this news as the last.
    Anew {
        /// The event last heard of, if there was one.
        news: Option<EventId>,
    },
    /// For whoever carries it out: it was due before.
    Late {
        /// When it was due.
        due: Time,
    },
    /// It was handed over early and executed then, and news closed its window before it was due.
    Closed {
        /// When it was due.
        due: Time,
    },
}
