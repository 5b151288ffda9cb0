//! What is in the hands of the driver: handed over, sent, tried again while its window is open, given up.

use kirk_network::{Duration, EventId, Time};

use super::{Executive, MICROSECOND, Output, Sending};
use crate::activity::Handover;
use crate::input::{Answer, Reason, Why};
use crate::order::{Order, State};

impl Executive {
    /// An attempt leaves for the driver now, unless its window has closed meanwhile.
    pub(super) fn sent(&mut self, now: Time, id: &str) -> Answer {
        let Some(at) = self.orders.iter().position(|order| order.id == id && order.state == State::Sent)
        else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        let closes = self.closes(at);
        let order = &mut self.orders[at];
        self.changes += 1;
        if closes.is_some_and(|closes| now > closes) {
            order.reason = "it could not be recorded in time".to_string();
            order.state = State::Waiting(now);
            self.settle(now);
            return Answer::Ignored(Why::TooLate);
        }
        if !order.doubtful {
            order.started = now;
        }
        if order.attempts == 1 {
            order.first_sent = now;
        }
        Answer::Accepted
    }

    /// The driver has executed what was handed over, `ago` before now if it says so.
    pub(super) fn executed(&mut self, now: Time, id: &str, ago: Option<Duration>) -> Answer {
        let open = |order: &&mut Order| order.id == id && order.state != State::Done;
        let Some(order) = self.orders.iter_mut().find(open) else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        order.state = State::Done;
        if let Some(at) = ago.and_then(|ago| now.checked_sub(ago)) {
            order.started = at.max(order.first_sent);
        }
        self.changes += 1;
        let event = order.event;
        let of_event = || self.orders.iter().filter(|order| order.event == event);
        if of_event().all(|order| order.state == State::Done) {
            let started = of_event().map(|order| order.started).max().unwrap_or(now);
            self.dispatcher.handle_executed(now, event, started);
        }
        self.settle(now);
        self.hear_held(now);
        Answer::Accepted
    }

    /// The driver could not execute what was handed over, or in case of `doubt` nobody knows.
    pub(super) fn failed(&mut self, now: Time, id: &str, reason: &str, doubt: bool) -> Answer {
        let patience = self.patience;
        let sent = |order: &&mut Order| order.id == id && order.state == State::Sent;
        let Some(order) = self.orders.iter_mut().find(sent) else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        order.failed(now, reason, patience);
        // One that says no had not done it before either.
        order.doubtful = doubt;
        self.changes += 1;
        self.settle(now);
        Answer::Accepted
    }

    /// The executive was away and is back.
    pub(super) fn resumed(&mut self, now: Time, unsent: &[String]) {
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
        self.timeout(now);
    }

    /// Begins to hand an event over, under each name that starts an activity.
    pub(super) fn hand_over(&mut self, event: EventId, due: Time, now: Time) {
        let (start, end) = self.handovers_of[event.index()];
        let window = self.dispatcher.window_end(event).map_or(due, |end| end.max(due));
        let closes = window.saturating_add(self.lateness);
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
            Some(latest) => Some(latest.saturating_add(self.lateness)),
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
            // Not counted as a change, so not recorded: it follows from the order and its window alone, and a repetition
            // comes to the same at the next input.
            // One last time while it is open.
            self.orders[at].state = State::Waiting(latest);
        } else if let Some(closes) = closes.filter(|&closes| closes < again) {
            self.orders[at].state = State::Waiting(closes.saturating_add(MICROSECOND));
        }
    }

    fn give_up(&mut self, at: usize, now: Time) {
        let Order { event, name, attempts, reason, .. } = self.orders[at].clone();
        self.dispatcher.handle_failed(now, event);
        if attempts == 0 {
            let detail = format!("`{name}` was not handed over in its window: nobody was there to do it");
            return self.fail(event, now, Reason::MissedWindow, detail);
        }
        let times = if attempts == 1 { "1 attempt".to_string() } else { format!("{attempts} attempts") };
        let detail = format!("the driver could not execute `{name}` in time, after {times}: {reason}");
        self.fail(event, now, Reason::DriverFailed, detail);
    }
}
