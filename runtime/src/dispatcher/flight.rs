//! What our events go through: due, dispatched, in flight until a driver has confirmed them, executed; or too late for that.

use std::cmp::Ordering;

use kirk_network::{EventId, Time};

use super::{Dispatch, Dispatcher, Missed};
use crate::cause::Cause;
use crate::execution::How;

/// A dispatched event that nobody has confirmed yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct InFlight {
    pub(super) event: EventId,
    pub(super) node: u32,
    pub(super) due: Time,
    /// What decided when it is due.
    pub(super) cause: Cause,
    /// Since when it is, if it was confirmed before it is due: until then news may still bring it forward.
    pub(super) executed: Option<Time>,
}

impl Dispatcher {
    /// When a node that is due counts as executed, if it is taken in hand now.
    pub(super) fn executed_at(&self, node: u32) -> Time {
        let due = self.agenda.due(node);
        let carried_out = self.is_carried_out(self.reduction.event_of[node as usize]);
        if carried_out { self.recorded(due, self.now, self.agenda.upper(node)) } else { due }
    }

    /// The next event that was confirmed before it is due, and when it counts as executed: then, or when its window closes.
    pub(super) fn next_early(&self) -> Option<(Time, usize)> {
        let early = self.in_flight.iter().enumerate().filter_map(|(index, flight)| {
            let since = flight.executed?;
            Some((flight.due.min(self.agenda.upper(flight.node)).max(since), index))
        });
        early.min()
    }

    /// An event in flight was executed, `at` some time up to now. What follows it can go on. One that was executed before it
    /// was due stays in flight until it is.
    pub fn handle_executed(&mut self, now: Time, event: EventId, at: Time) {
        self.now = self.now.max(now);
        let Some(found) = self.in_flight.iter().position(|flight| flight.event == event) else { return };
        let InFlight { node, due, cause, .. } = self.in_flight[found];
        self.version += 1;
        if due > self.now {
            self.in_flight[found].executed = Some(at);
            return;
        }
        self.in_flight.remove(found);
        let time = self.recorded(due, at, self.agenda.upper(node));
        self.executed(InFlight { event, node, due, cause, executed: None }, time);
    }

    pub(super) fn executed(&mut self, flight: InFlight, time: Time) {
        let InFlight { event, node, due, cause, .. } = flight;
        if self.in_time(due, time, node) {
            self.fix(event, time, How::Dispatched, in_truth(cause, due, time));
            self.start(node, time);
        }
    }

    /// An event in flight cannot be executed any more: the execution has failed.
    pub fn handle_failed(&mut self, now: Time, event: EventId) {
        self.now = self.now.max(now);
        if let Some(found) = self.in_flight.iter().position(|flight| flight.event == event) {
            let InFlight { node, due, .. } = self.in_flight.remove(found);
            self.version += 1;
            self.miss(event, due, self.now, self.agenda.upper(node));
        }
    }

    /// The latest time at which an event in flight can be executed, if there is one.
    pub fn latest(&self, event: EventId) -> Option<Time> {
        let flight = self.in_flight.iter().find(|flight| flight.event == event)?;
        Some(self.agenda.upper(flight.node)).filter(|&upper| upper < Time::MAX)
    }

    /// True if somebody carries an event out.
    pub fn is_carried_out(&self, event: EventId) -> bool {
        self.carried_out[event.index()]
    }

    /// True if anything is in flight.
    pub fn has_in_flight(&self) -> bool {
        !self.in_flight.is_empty()
    }

    /// True from the dispatch of an event until it counts as executed.
    pub fn is_in_flight(&self, event: EventId) -> bool {
        self.in_flight.iter().any(|flight| flight.event == event)
    }

    /// True from the dispatch of an event until somebody says that it was executed.
    pub(crate) fn is_unconfirmed(&self, event: EventId) -> bool {
        self.in_flight.iter().any(|flight| flight.event == event && flight.executed.is_none())
    }

    pub(super) fn execute(&mut self, time: Time, node: u32) {
        let due = self.agenda.due(node);
        if !self.in_time(due, time, node) {
            return;
        }
        let event = self.reduction.event_of[node as usize];
        let cause = self.cause_of_due(node, due);
        self.version += 1;
        self.dispatches.push_back(Dispatch { event, time: due });
        if self.settings.confirmed && self.is_carried_out(event) {
            self.agenda.take(node);
            self.in_flight.push(InFlight { event, node, due, cause, executed: None });
        } else {
            self.fix(event, time, How::Dispatched, in_truth(cause, due, time));
            self.start(node, time);
        }
    }

    /// When an event that was due and is executed `at` some time is recorded: when due, unless that is too long ago. What
    /// is late for its window by no more than is allowed counts as just in time.
    pub(super) fn recorded(&self, due: Time, at: Time, latest: Time) -> Time {
        let lateness = self.settings.lateness;
        if at.saturating_since(due) <= lateness {
            due
        } else if at > latest && at.saturating_since(latest) <= lateness {
            latest
        } else {
            at
        }
    }

    /// False, and the end of it all, if an event would be executed after its window.
    pub(super) fn in_time(&mut self, due: Time, time: Time, node: u32) -> bool {
        let latest = self.agenda.upper(node);
        if time > latest {
            self.miss(self.reduction.event_of[node as usize], due, time, latest);
        }
        time <= latest
    }

    pub(super) fn miss(&mut self, event: EventId, due: Time, time: Time, latest: Time) {
        self.missed = Some(Missed { event, time, due, latest });
    }
}

/// What decided when an event was executed, if something decided when it was due.
fn in_truth(cause: Cause, due: Time, time: Time) -> Cause {
    match due.cmp(&time) {
        Ordering::Equal => cause,
        Ordering::Less => Cause::Late { due },
        Ordering::Greater => Cause::Closed { due },
    }
}
