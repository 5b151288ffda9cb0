//! What is in the hands of the driver: handed over, sent, tried again while its window is open, given up.

use kirk_network::{Duration, EventId, Time};

use super::{Executive, Output, Sending};
use crate::input::{Answer, Reason, Why};
use crate::order::{Course, Order, State};

impl Executive {
    /// An attempt leaves for the driver now, unless its window has closed meanwhile.
    pub(super) fn sent(&mut self, now: Time, id: &str) -> Answer {
        let Some(at) = self.orders.open.iter().position(|order| order.id == id && order.is_sent()) else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        let closes = self.closes(at);
        let course = &mut self.orders.open[at].course;
        self.changes += 1;
        if closes.is_some_and(|closes| now > closes) {
            course.reason = "it could not be recorded in time".to_string();
            course.state = State::Waiting(now);
            self.settle(now);
            return Answer::Ignored(Why::TooLate);
        }
        if !course.doubtful {
            course.started = now;
        }
        if course.attempts == 1 {
            course.first_sent = now;
        }
        Answer::Accepted
    }

    /// The driver has executed what was handed over, `ago` before now if it says so.
    pub(super) fn executed(&mut self, now: Time, id: &str, ago: Option<Duration>) -> Answer {
        let open = |order: &&mut Order| order.id == id && !order.is_done();
        let Some(Order { event, course, .. }) = self.orders.open.iter_mut().find(open) else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        course.state = State::Done;
        if let Some(at) = ago.and_then(|ago| now.checked_sub(ago)) {
            course.started = at.max(course.first_sent);
        }
        self.changes += 1;
        let event = *event;
        if let Some(started) = self.orders.close(event) {
            self.dispatcher.handle_executed(now, event, started);
        }
        self.settle(now);
        self.hear_held(now);
        Answer::Accepted
    }

    /// The driver could not execute what was handed over, or in case of `doubt` nobody knows.
    pub(super) fn failed(&mut self, now: Time, id: &str, reason: &str, doubt: bool) -> Answer {
        let patience = self.patience;
        let sent = |order: &&mut Order| order.id == id && order.is_sent();
        let Some(order) = self.orders.open.iter_mut().find(sent) else {
            return Answer::Ignored(Why::NotWithDriver);
        };
        order.failed(now, reason, patience);
        // One that says no had not done it before either.
        order.course.doubtful = doubt;
        self.changes += 1;
        self.settle(now);
        Answer::Accepted
    }

    /// The executive was away and is back.
    pub(super) fn resumed(&mut self, now: Time, unsent: &[String]) {
        self.changes += 1;
        for at in 0..self.orders.open.len() {
            let Order { id, course, .. } = &mut self.orders.open[at];
            if course.state == State::Sent {
                if unsent.contains(id) {
                    // It was never tried, and may be too late by now.
                    course.attempts -= 1;
                    course.state = State::Waiting(now);
                    continue;
                }
                course.doubtful = true;
                course.attempts += 1;
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
            let handover = self.handovers[at as usize].clone();
            let course = Course {
                name: handover.name.clone(),
                due,
                closes,
                first_sent: now,
                started: now,
                attempts: 1,
                state: State::Sent,
                reason: String::new(),
                doubtful: false,
            };
            self.orders.add(&self.run, handover, course);
            self.send(self.orders.open.len() - 1);
        }
    }

    fn send(&mut self, at: usize) {
        let Order { id, event, companion, course, .. } = &self.orders.open[at];
        let sending = Sending {
            id: id.clone(),
            name: course.name.clone(),
            companion: companion.clone(),
            due: course.due,
            latest: self.dispatcher.latest(*event),
            attempt: course.attempts,
        };
        self.outputs.push_back(Output::Send(sending));
    }

    /// When it is too late for an order, our lateness allowed for; `None` if it never is.
    pub(super) fn closes(&self, at: usize) -> Option<Time> {
        let order = &self.orders.open[at];
        match self.dispatcher.latest(order.event) {
            Some(latest) => Some(latest.saturating_add(self.lateness)),
            None if self.dispatcher.is_in_flight(order.event) => None,
            None => Some(order.course.closes),
        }
    }

    /// Tries again what failed, or gives up when its window has closed.
    pub(super) fn look_after(&mut self, at: usize, now: Time) {
        let State::Waiting(again) = self.orders.open[at].course.state else { return };
        let closes = self.closes(at);
        let latest = self.dispatcher.latest(self.orders.open[at].event);
        if closes.is_some_and(|closes| now > closes) {
            if !self.over {
                self.give_up(at, now);
            }
        } else if now >= again {
            let course = &mut self.orders.open[at].course;
            course.attempts += 1;
            if !course.doubtful {
                course.started = now;
            }
            course.state = State::Sent;
            self.changes += 1;
            self.send(at);
        } else if let Some(latest) = latest.filter(|&latest| now < latest && latest < again) {
            // Not counted as a change, so not recorded: it follows from the order and its window alone, and a repetition
            // comes to the same at the next input.
            // One last time while it is open.
            self.orders.open[at].course.state = State::Waiting(latest);
        } else if let Some(closes) = closes.filter(|&closes| closes < again) {
            let after = closes.saturating_add(Duration::SHORTEST);
            self.orders.open[at].course.state = State::Waiting(after);
        }
    }

    fn give_up(&mut self, at: usize, now: Time) {
        let Order { event, course: Course { name, attempts, reason, .. }, .. } = self.orders.open[at].clone();
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
