//! What is in the hands of the driver: handed over, sent, tried again while its window is open, given up.

use kirk_network::{EventId, Time};

use super::{Executive, Output, Sending};
use crate::activity::Handover;
use crate::order::{Order, State};

impl Executive {
    /// An attempt leaves for the driver now: from now on it counts. Returns false if its window has closed meanwhile; then it
    /// must not leave.
    pub fn handle_sent(&mut self, now: Time, id: &str) -> bool {
        let Some(at) = self.orders.iter().position(|order| order.id == id) else { return false };
        let closes = self.closes(at);
        let order = &mut self.orders[at];
        if self.over || order.state != State::Sent {
            return false;
        }
        self.changes += 1;
        if closes.is_some_and(|closes| now > closes) {
            order.reason = "it could not be recorded in time".to_string();
            order.state = State::Waiting(now);
            self.settle(now);
            return false;
        }
        if !order.doubtful {
            order.started = now;
        }
        if order.attempts == 1 {
            order.first_sent = now;
        }
        true
    }

    /// The executive was away and is back: whatever was not confirmed is handed over again, under the same id. The driver
    /// is asked, as it were, whether it was done before, so it counts from when the driver was told; `unsent` are the ids of
    /// those of which the driver cannot have heard, which count from now.
    pub fn handle_resumed(&mut self, now: Time, unsent: &[String]) {
        if self.over {
            return;
        }
        self.changes += 1;
        for at in 0..self.orders.len() {
            let order = &mut self.orders[at];
            if order.state == State::Sent {
                if unsent.contains(&order.id) {
                    // It was never tried, and may be too late by now.
                    order.attempts -= 1;
                    order.state = State::Waiting(now);
                    continue;
                }
                order.doubtful = true;
                order.attempts += 1;
                self.send(at);
            }
        }
        self.handle_timeout(now);
    }

    /// Begins to hand an event over, under each name that starts an activity.
    pub(super) fn hand_over(&mut self, event: EventId, due: Time, now: Time) {
        let (start, end) = self.handovers_of[event.index()];
        let window = self.dispatcher.window_end(event).map_or(due, |end| end.max(due));
        let closes = window.checked_add(self.lateness).unwrap_or(window);
        for at in start..end {
            let Handover { name, companion, .. } = &self.handovers[at as usize];
            self.orders.push(Order {
                id: format!("{}/{name}", self.run),
                event,
                name: name.clone(),
                companion: companion.clone(),
                due,
                closes,
                first_sent: now,
                started: now,
                attempts: 1,
                state: State::Sent,
                reason: String::new(),
                doubtful: false,
                kept: false,
            });
            self.send(self.orders.len() - 1);
        }
    }

    fn send(&mut self, at: usize) {
        let Order { id, name, companion, due, attempts, event, .. } = self.orders[at].clone();
        let latest = self.dispatcher.latest(event);
        self.outputs.push_back(Output::Send(Sending { id, name, companion, due, latest, attempt: attempts }));
    }

    /// When it is too late for an order, our lateness allowed for; `None` if it never is.
    pub(super) fn closes(&self, at: usize) -> Option<Time> {
        let order = &self.orders[at];
        match self.dispatcher.latest(order.event) {
            Some(latest) => Some(latest.checked_add(self.lateness).unwrap_or(latest)),
            None if self.dispatcher.is_in_flight(order.event) => None,
            None => Some(order.closes),
        }
    }

    /// Tries again what failed, or gives up when its window has closed.
    pub(super) fn look_after(&mut self, at: usize, now: Time) {
        let State::Waiting(again) = self.orders[at].state else { return };
        let closes = self.closes(at);
        let latest = self.dispatcher.latest(self.orders[at].event);
        if closes.is_some_and(|closes| now > closes) {
            if !self.over {
                self.give_up(at, now);
            }
        } else if now >= again {
            let order = &mut self.orders[at];
            order.attempts += 1;
            if !order.doubtful {
                order.started = now;
            }
            order.state = State::Sent;
            self.changes += 1;
            self.send(at);
        } else if let Some(latest) = latest.filter(|&latest| now < latest && latest < again) {
            // One last time while it is open.
            self.orders[at].state = State::Waiting(latest);
        } else if let Some(closes) = closes.filter(|&closes| closes < again) {
            self.orders[at].state = State::Waiting(Time::from_micros(closes.as_micros().saturating_add(1)));
        }
    }

    fn give_up(&mut self, at: usize, now: Time) {
        let Order { event, name, attempts, reason, .. } = self.orders[at].clone();
        self.dispatcher.handle_failed(now, event);
        if attempts == 0 {
            let detail = format!("`{name}` was not handed over in its window: nobody was there to do it");
            return self.fail(event, now, "missed-window", detail);
        }
        let times = if attempts == 1 { "1 attempt".to_string() } else { format!("{attempts} attempts") };
        let detail = format!("the driver could not execute `{name}` in time, after {times}: {reason}");
        self.fail(event, now, "driver-failed", detail);
    }
}
