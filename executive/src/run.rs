//! The loop: sleeps until the next decision or the next message, and does nothing else.
//!
//! What happens to the executive is in the journal, on disk, before anything that comes of it leaves the process. As the
//! disk takes its time, what is due next is written ahead, shortly before.

use std::collections::HashSet;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration as Real;

use kirk_network::json::{Seconds, seconds};
use kirk_network::{Duration, EventId, Time};
use kirk_runtime::journal::{Line, Record};
use kirk_runtime::{Answer, Execution, Executive, How, Output, Sending};

use crate::clock::Clock;
use crate::desk::{AnswerNews, Desk, Ignored, Message, Reply};
use crate::driver::Running;
use crate::failure;
use crate::file::JournalFile;
use crate::happening::Happening;
use crate::lateness::Lateness;
use crate::mission::Ready;

/// What became of a mission.
#[derive(Clone, Debug)]
pub struct Ended {
    /// The record.
    pub execution: Execution,
    /// How late its dispatches were.
    pub lateness: Lateness,
    /// Why it was stopped from outside, if it was. Its journal can be resumed.
    pub stopped: Option<String>,
}

/// How long before it is due, really, the next dispatch is written to the journal: from, and at the latest.
const AHEAD: (Real, Real) = (Real::from_millis(100), Real::from_millis(15));
/// How long news may wait for its answer while dispatches keep the loop busy.
const LONGEST_ANSWER: Real = Real::from_millis(50);
/// A machine that slept does not count its sleep as waiting: look at the clock now and then.
const LONGEST_SLEEP: Real = Real::from_secs(1);

impl Ready {
    /// Executes the mission to its end.
    pub fn run(self, internal: bool) -> Ended {
        let Ready { executive, options, desk, inbox, journal, driver, server } = self;
        let clock = *desk.clock();
        let mut work = Loop {
            executive,
            clock,
            desk,
            journal,
            driver,
            ahead: HashSet::new(),
            ahead_of: None,
            ignored: HashSet::new(),
            lateness: Lateness::default(),
            stopped: None,
            unsynced: None,
            replies: Vec::new(),
        };
        work.write_ahead_now(Time::ZERO);
        std::thread::sleep(clock.until_anchor());
        work.go(&inbox);
        work.answer();
        let now = clock.now();
        let mut execution = work.executive.execution(now, internal);
        if let Some(reason) = &work.stopped {
            execution.outcome = kirk_runtime::Outcome::Failed;
            execution.failure = Some(failure::stopped(&execution, now, reason));
        }
        work.desk.tell(Happening::Over { at: at(now), execution: execution.clone() });
        if let Some(driver) = work.driver.take() {
            driver.end(execution.clone());
        }
        if let (Some(command), Some(failed)) = (&options.on_failure, &execution.failure) {
            failure::tell(command, &execution.program, failed);
        }
        if let Some(server) = server {
            server.stop();
        }
        Ended { execution, lateness: work.lateness, stopped: work.stopped }
    }
}

struct Loop {
    executive: Executive,
    clock: Clock,
    desk: Desk,
    journal: Option<JournalFile>,
    driver: Option<Running>,
    /// Dispatches that are on disk already.
    ahead: HashSet<String>,
    /// For which state and time that was done.
    ahead_of: Option<(u64, Time)>,
    /// News of no use that was recorded: by event and reason.
    ignored: HashSet<(String, String)>,
    lateness: Lateness,
    stopped: Option<String>,
    /// Since when there is something that is to be on the disk soon.
    unsynced: Option<Time>,
    /// Who is answered once it is.
    replies: Vec<(AnswerNews, Reply<AnswerNews>)>,
}

impl Loop {
    fn go(&mut self, inbox: &Receiver<Message>) {
        self.perform();
        while !self.executive.is_over() && self.stopped.is_none() {
            let now = self.clock.now();
            let next = self.executive.poll_timeout();
            if next.is_some_and(|next| next <= now) {
                self.timeout(now);
                continue;
            }
            self.sync_if_idle(now, next);
            self.write_ahead(now, next);
            let wait = next.map_or(LONGEST_SLEEP, |next| self.wait(now, next));
            match inbox.recv_timeout(wait.min(LONGEST_SLEEP)) {
                Ok(message) => self.take(message),
                Err(RecvTimeoutError::Timeout) => {}
                // The loop has a desk itself.
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
    }

    fn timeout(&mut self, now: Time) {
        let before = self.executive.version();
        self.executive.handle_timeout(now);
        if self.executive.version() != before {
            self.record(now, Record::Timeout {});
        }
        self.perform();
    }

    fn take(&mut self, message: Message) {
        let mut now = self.clock.now();
        match message {
            Message::News { arrived, events, answer, reply } => {
                self.news(arrived, events, answer, reply);
                now = arrived;
            }
            Message::Executed { id, ago } => {
                let ago = ago.map(|ago| Duration::from_micros(self.clock.mission_micros((ago * 1e6) as i64)));
                self.record(now, Record::Executed { id: id.clone(), ago: ago.map(seconds) });
                self.executive.handle_executed(now, &id, ago);
                self.unsynced.get_or_insert(now);
                self.perform();
            }
            Message::Failed { id, reason } => {
                self.record(now, Record::Failed { id: id.clone(), reason: reason.clone() });
                self.executive.handle_failed(now, &id, &reason);
                self.desk.tell(Happening::Failed { at: at(now), id, reason });
                self.perform();
            }
            Message::Warning(text) => {
                self.record(now, Record::Warning { text: text.clone() });
                self.desk.tell(Happening::Warning { at: at(now), text });
                self.perform();
            }
            Message::Rebuilt { from, rebuilt } => {
                let before = self.executive.version();
                let current = self.executive.handle_rebuilt(now, rebuilt);
                if current {
                    self.record(now, Record::Rebuilt { from: at(from) });
                } else if self.executive.version() != before {
                    self.record(now, Record::Timeout {});
                }
                self.perform();
            }
            Message::State { reply } => reply(self.state(now)),
            Message::Stop { reason } => self.stopped = Some(reason),
        }
        self.plan_anew(now);
    }

    fn news(
        &mut self,
        arrived: Time,
        events: Vec<(String, EventId)>,
        mut answer: AnswerNews,
        reply: Reply<AnswerNews>,
    ) {
        for (name, event) in events {
            let label = self.executive.network().label(event).to_string();
            match self.executive.handle_news(arrived, event) {
                Answer::Accepted => {
                    self.record(arrived, Record::News { event: label });
                    self.desk.set_heard(event);
                    answer.accepted.push(name);
                }
                Answer::Ignored(why) => {
                    if self.ignored.insert((label, why.clone())) {
                        self.record(arrived, Record::Ignored { event: name.clone(), why: why.clone() });
                    }
                    answer.ignored.push(Ignored { event: name, why });
                }
            }
        }
        self.unsynced.get_or_insert(arrived);
        self.replies.push((answer, reply));
        self.perform();
    }

    /// News is answered when it is on the disk, which takes a moment: not while something is about to be due, unless
    /// somebody has waited long for it.
    fn sync_if_idle(&mut self, now: Time, next: Option<Time>) {
        let Some(since) = self.unsynced else { return };
        let idle = next.is_none_or(|next| self.clock.real(now, next) > AHEAD.1);
        if self.journal.is_none() || idle || self.clock.real(since, now) > LONGEST_ANSWER {
            self.commit(true);
            self.answer();
        }
    }

    fn answer(&mut self) {
        for (answer, reply) in self.replies.drain(..) {
            reply(answer);
        }
    }

    /// Has what news calls for planned anew, elsewhere.
    fn plan_anew(&mut self, now: Time) {
        if let Some(rebuild) = self.executive.poll_rebuild(now) {
            let (from, desk) = (rebuild.now(), self.desk.clone());
            std::thread::spawn(move || desk.rebuilt(from, rebuild.run()));
        }
    }

    /// Records what has come of it all, and when that is safe lets it leave.
    fn perform(&mut self) {
        let now = self.clock.now();
        let mut sends: Vec<Sending> = Vec::new();
        let mut sync = false;
        while let Some(output) = self.executive.poll_output() {
            match output {
                Output::Send(sending) => {
                    let Sending { id, due, attempt, .. } = &sending;
                    sync |= !(*attempt == 1 && self.ahead.contains(id));
                    let (id, due, attempt) = (id.clone(), at(*due), *attempt);
                    self.record(now, Record::Dispatch { id, due, attempt });
                    sends.push(sending);
                }
                Output::Fixed(event) => {
                    let known = *self.executive.dispatcher().known(event);
                    if let (Some((time, How::Dispatched)), None) = (known.fixed, &self.driver) {
                        self.lateness.add(now, time);
                    }
                    let rows = self.executive.rows(event);
                    if !rows.is_empty() {
                        self.desk.tell(Happening::Fixed { at: at(now), rows });
                    }
                }
                Output::Warning(text) => {
                    self.record(now, Record::Warning { text: text.clone() });
                    self.desk.tell(Happening::Warning { at: at(now), text });
                }
                Output::Over => {
                    let execution = self.executive.execution(now, false);
                    self.record(now, Record::End { execution });
                    sync = true;
                }
            }
        }
        self.commit(sync);
        if self.unsynced.is_none() || self.journal.is_none() {
            self.answer();
        }
        for sending in sends {
            self.send(sending);
        }
        self.commit(false);
        self.desk.set_version(self.executive.version());
    }

    fn send(&mut self, sending: Sending) {
        if self.executive.failure().is_some() {
            return;
        }
        let now = self.clock.now();
        let Sending { id, name, due, attempt, .. } = &sending;
        if *attempt == 1 {
            self.lateness.add(now, *due);
        }
        let (id, event, due, attempt) = (id.clone(), name.clone(), at(*due), *attempt);
        self.record(now, Record::Sent { id: id.clone() });
        self.desk.tell(Happening::Sent { at: at(now), event, id, due, attempt });
        if let Some(driver) = &self.driver {
            driver.send(sending);
        }
    }

    /// If something is to leave soon, puts it on the disk now.
    fn write_ahead(&mut self, now: Time, next: Option<Time>) {
        let Some(next) = next else { return };
        let gap = self.clock.real(now, next);
        if self.journal.is_none() || gap > AHEAD.0 || gap < AHEAD.1 {
            return;
        }
        let state = (self.executive.version(), next);
        if self.ahead_of != Some(state) {
            self.ahead_of = Some(state);
            self.write_ahead_now(next);
        }
    }

    fn write_ahead_now(&mut self, next: Time) {
        if self.journal.is_none() || self.driver.is_none() {
            return;
        }
        let mut ahead = self.executive.clone();
        ahead.handle_timeout(next);
        let mut ids = Vec::new();
        while let Some(output) = ahead.poll_output() {
            if let Output::Send(sending) = output {
                ids.push(sending.id);
            }
        }
        ids.retain(|id| !self.ahead.contains(id));
        if !ids.is_empty() {
            self.ahead.extend(ids.iter().cloned());
            self.record(self.clock.now(), Record::Ahead { due: at(next), ids });
            self.commit(true);
        }
    }

    /// How long to sleep: until it is due, or until it is to be written ahead.
    fn wait(&self, now: Time, next: Time) -> Real {
        let gap = self.clock.real(now, next);
        if self.journal.is_some() && gap > AHEAD.0 { gap - AHEAD.0 } else { gap }
    }

    fn record(&mut self, time: Time, record: Record) {
        if let Some(journal) = &mut self.journal {
            journal.push(&Line::new(time, record));
        }
    }

    /// A mission whose journal cannot be written ends: nothing leaves that is not recorded.
    fn commit(&mut self, sync: bool) {
        let Some(journal) = &mut self.journal else {
            self.unsynced = None;
            return;
        };
        if sync {
            self.unsynced = None;
        }
        if let Err(error) = journal.commit(sync) {
            self.journal = None;
            let detail = format!("the journal cannot be written: {error}");
            self.executive.handle_stopped(self.clock.now(), "journal-failed", &detail);
        }
    }

    fn state(&self, now: Time) -> String {
        serde_json::to_string(&self.executive.execution(now, false))
            .unwrap_or_else(|error| unreachable!("a record has only strings and numbers: {error}"))
    }
}

fn at(time: Time) -> Seconds {
    seconds(Duration::from_micros(time.as_micros()))
}
