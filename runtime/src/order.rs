//! An order: one event in the hands of the driver, from the first attempt to the confirmation.

use kirk_network::{Duration, EventId, Time};

/// An event that is handed over under one of its names.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    pub(crate) id: String,
    pub(crate) event: EventId,
    pub(crate) name: String,
    pub(crate) companion: Option<String>,
    pub(crate) due: Time,
    /// When it is too late, if the event is fixed already (Nature's, and the origin).
    pub(crate) closes: Time,
    pub(crate) first_sent: Time,
    /// When the attempt that counts began.
    pub(crate) started: Time,
    pub(crate) attempts: u32,
    pub(crate) state: State,
    /// Why the last attempt failed.
    pub(crate) reason: String,
    /// An attempt may have succeeded without our hearing of it: then the first one counts.
    pub(crate) doubtful: bool,
    /// A checkpoint has it as done: nothing will change any more.
    pub(crate) kept: bool,
}

/// Where an order is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    /// With the driver.
    Sent,
    /// To be tried again then.
    Waiting(Time),
    /// Confirmed.
    Done,
}

/// How long to wait before an order is tried again: twice as long each time, up to a limit; and when it has failed for long,
/// a hundredth of that time. Whoever has waited for a day can wait for a quarter of an hour more, and what is recorded of a
/// driver that fails for days stays small: the number of attempts grows with the logarithm of the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// After the first attempt.
    pub first: Duration,
    /// At most.
    pub most: Duration,
}

impl State {
    pub(crate) fn wakes(self) -> Option<Time> {
        if let State::Waiting(again) = self { Some(again) } else { None }
    }
}

impl Order {
    pub(crate) fn failed(&mut self, now: Time, reason: &str, patience: Patience) {
        let doubled = patience.first.as_micros().saturating_mul(1 << (self.attempts - 1).min(30));
        let failing = now.as_micros().saturating_sub(self.first_sent.as_micros());
        let wait = doubled.min(patience.most.as_micros().max(failing / 100));
        self.reason = reason.to_string();
        self.state = State::Waiting(Time::from_micros(now.as_micros().saturating_add(wait)));
    }
}
