//! Promises: when an agent will have executed an event, measured from another event.

use kirk_network::{Duration, EventId};

/// That `event` comes between `low` and `high` after `base`. Its owner keeps it; others count on it. Events are those of the team's
/// network with the joins of one owner made one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Promise {
    /// What is promised.
    pub event: EventId,
    /// What it is measured from.
    pub base: EventId,
    /// The least it comes after the base, not negative.
    pub low: Duration,
    /// The most it comes after the base.
    pub high: Duration,
}

/// One end of a promise, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Term {
    Low(u32),
    High(u32),
}

impl Term {
    /// Its place in a list of all ends.
    pub(crate) fn index(self) -> usize {
        match self {
            Term::Low(number) => 2 * number as usize,
            Term::High(number) => 2 * number as usize + 1,
        }
    }

    /// Its value.
    pub(crate) fn of(self, promises: &[Promise]) -> i64 {
        match self {
            Term::Low(number) => promises[number as usize].low.as_micros(),
            Term::High(number) => promises[number as usize].high.as_micros(),
        }
    }
}
