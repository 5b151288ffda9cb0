//! Before time zero: the clock of the mission stands until its hour has come, or until the driver first confirms.
//!
//! Nothing happens to the executive meanwhile. Whoever asks is told how things are, and news is refused: what has not begun
//! cannot have ended.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration as Real, Instant};

use kirk_network::{Duration, Time};
use kirk_runtime::journal::Trace;
use kirk_runtime::{Input, Output, Reason, Sending, Speed, Why};

use super::{LONGEST_SLEEP, Loop};
use crate::desk::{Acknowledgement, Message, Reply};
use crate::happening::Happening;
use crate::mission::{PATIENCE, Zero};
use crate::snapshot::Waits;

impl Loop {
    /// Waits until the clock runs, or the mission is over or stopped before it does.
    pub(super) fn wait_for_zero(&mut self, zero: Zero, inbox: &Receiver<Message>) {
        match zero {
            // What comes meanwhile is heard when it begins.
            Zero::Soon => std::thread::sleep(self.clock.until_anchor()),
            Zero::DriverConfirms { within } if self.clock.is_standing() => self.ask_driver(within, inbox),
            Zero::DriverConfirms { .. } => {}
            Zero::At(_) => self.wait_for_hour(inbox),
        }
        self.waits = None;
    }

    fn wait_for_hour(&mut self, inbox: &Receiver<Message>) {
        self.waits = Some(Waits::Hour);
        while self.stopped.is_none() && !self.executive.is_over() {
            self.check_journal();
            let left = self.clock.until_anchor();
            if left.is_zero() {
                return;
            }
            match inbox.recv_timeout(left.min(LONGEST_SLEEP)) {
                Ok(message) => self.take_early(message),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Hands the first event over until the driver confirms it; then it is time zero. The executive knows nothing of the
    /// attempts that failed: in its world no time has passed. All of them have the id of the dispatch, which was written ahead.
    fn ask_driver(&mut self, within: Real, inbox: &Receiver<Message>) {
        let Some(first) = self.first_sending() else {
            self.warn(
                "nothing is handed over at time zero, so the clock does not wait for the driver".to_string(),
            );
            return self.clock.start(Duration::ZERO);
        };
        self.waits = Some(Waits::Driver(first.name.clone()));
        let ticket = self.ahead.get(&first.id).copied().unwrap_or_default();
        let begun = Instant::now();
        let deadline = begun + within;
        let (mut attempts, mut asked, mut again, mut last) = (0, false, begun, String::new());
        // Whoever stops it is still told what became of the attempt that is under way.
        while !self.executive.is_over() && (self.stopped.is_none() || asked && !self.hurried) {
            self.check_journal();
            let now = Instant::now();
            if now >= deadline {
                if self.stopped.is_some() {
                    // It can still begin: whoever goes on asks again.
                    return;
                }
                let last = if last.is_empty() { "it has not answered" } else { &last };
                return self.give_up(&first.name, within, last);
            }
            let safe = self.journal.is_none() || ticket <= self.synced;
            if let (true, false, true, Some(driver)) = (safe, asked, now >= again, &self.driver) {
                (attempts, asked) = (attempts + 1, true);
                driver.send(Sending { attempt: attempts, ..first.clone() });
            }
            let wake = if asked || !safe { deadline } else { deadline.min(again) };
            match inbox.recv_timeout((wake - now).min(LONGEST_SLEEP)) {
                Ok(Message::Executed { id, ago }) if asked && id == first.id => return self.begin(id, ago),
                Ok(Message::Failed { id, reason, .. }) if asked && id == first.id => {
                    let wait = PATIENCE.wait(attempts, Duration::ZERO);
                    (asked, again) = (false, Instant::now() + Speed::REAL.real(wait));
                    if reason != last {
                        let text = format!("`{}` is not confirmed: {reason}", first.name);
                        self.trace(Time::ZERO, Trace::Warning { text });
                        self.write();
                        last.clone_from(&reason);
                        self.desk.tell(Happening::Failed {
                            at: Time::ZERO,
                            event: first.name.clone(),
                            id,
                            reason,
                        });
                    }
                }
                Ok(message) => self.take_early(message),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// What is handed over first at time zero, if anything is.
    fn first_sending(&self) -> Option<Sending> {
        let mut ahead = self.executive.clone();
        ahead.handle(Time::ZERO, Input::Timeout {});
        let sending = |output| if let Output::Send(sending) = output { Some(sending) } else { None };
        std::iter::from_fn(|| ahead.poll_output()).find_map(sending)
    }

    /// The driver has confirmed the first event, so long after it was executed if it says so: that was time zero.
    fn begin(&mut self, id: String, ago: Option<Duration>) {
        self.clock.start(ago.unwrap_or(Duration::ZERO));
        self.trace(Time::ZERO, Trace::Began { clocks: self.clock.anchor() });
        self.waits = None;
        self.begun_by = Some(id.clone());
        self.perform();
        self.take(Message::Executed { id, ago });
    }

    fn give_up(&mut self, name: &str, within: Real, last: &str) {
        let within = within.as_secs_f64();
        let detail = format!(
            "the driver did not confirm `{name}` within {within} s, so the mission has not begun: {last}"
        );
        self.happens(Time::ZERO, Input::Stopped { reason: Reason::DriverFailed, detail });
    }

    fn take_early(&mut self, message: Message) {
        match message {
            Message::Observed { events, answer, reply, .. } => {
                self.refuse(events.into_iter().map(|(name, _)| name), answer, reply);
            }
            // Of an attempt that is over.
            Message::Executed { .. } | Message::Failed { .. } => {}
            message => self.take(message),
        }
    }

    fn refuse(
        &mut self,
        names: impl Iterator<Item = String>,
        mut answer: Acknowledgement,
        reply: Reply<Acknowledgement>,
    ) {
        for event in names {
            answer.ignored.push(self.ignored(Time::ZERO, event, Why::NotBegun));
        }
        self.write();
        reply(answer);
    }

    fn warn(&mut self, text: String) {
        self.trace(Time::ZERO, Trace::Warning { text: text.clone() });
        self.desk.tell(Happening::Warning { at: Time::ZERO, text });
    }
}
