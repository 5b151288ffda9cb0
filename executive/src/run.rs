//! The loop: sleeps until the next decision or the next message, and does nothing else.
//!
//! What happens to the executive is in the journal, on the disk, before anything that comes of it leaves the process. As the
//! disk takes its time, what is due next is written ahead, and the loop goes on while the disk is at work.

mod zero;

use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration as Real, Instant};

use kirk_network::{EventId, Time};
use kirk_runtime::journal::{Line, Record, Trace};
use kirk_runtime::{
    Answer, Execution, Executive, Handled, Input, Output, Reason, Rebuild, Rebuilt, Sending, Why,
};

use crate::clock::Clock;
use crate::desk::{Acknowledgement, Desk, Ignored, Message, Reply, Ticket};
use crate::driver::Running;
use crate::failure;
use crate::file::JournalFile;
use crate::happening::Happening;
use crate::lateness::Lateness;
use crate::mission::Ready;
use crate::snapshot::{Waits, snapshot};

/// What became of a mission.
#[derive(Clone, Debug)]
pub struct Ended {
    /// The record.
    pub execution: Execution,
    /// The executive at its end, which knows why.
    pub executive: Executive,
    /// How late its dispatches were.
    pub lateness: Lateness,
    /// Why it was stopped from outside, if it was. Its journal can be resumed.
    pub stopped: Option<String>,
}

/// How long before it is due, really, the next dispatch is written to the journal.
const AHEAD: Real = Real::from_millis(100);
/// How many messages are taken before it is looked at what is due.
const AT_ONCE: usize = 64;
/// How much longer than an attempt may take we wait to hear how it ended.
const MARGIN: Real = Real::from_secs(1);
/// So many warnings of the driver are recorded; one that fails for days does not fill the disk with them.
const MOST_WARNINGS: u32 = 100;
/// A machine that slept does not count its sleep as waiting: look at the clock now and then.
const LONGEST_SLEEP: Real = Real::from_secs(1);

impl Ready {
    /// Executes the mission to its end.
    pub fn run(self, internal: bool) -> Ended {
        let Ready { executive, options, desk, inbox, journal, driver, server } = self;
        let (clock, zero) = (desk.clock().clone(), options.zero);
        let mut work = Loop {
            executive,
            clock: clock.clone(),
            desk,
            journal,
            driver,
            ahead: HashMap::new(),
            ahead_of: None,
            synced: 0,
            outbox: VecDeque::new(),
            with_driver: BTreeMap::new(),
            answers_within: options.driver_timeout + MARGIN,
            ignored: HashSet::new(),
            warnings: 0,
            lateness: Lateness::default(),
            stopped: None,
            hurried: false,
            lost: None,
            replies: VecDeque::new(),
            waits: None,
            begun_by: None,
        };
        work.write_ahead_now(clock.now());
        work.wait_for_zero(zero, &inbox);
        if work.stopped.is_none() {
            work.go(&inbox);
        }
        if work.executive.is_over() {
            // It has come to its end just so.
            work.stopped = None;
            // A dispatch that could not leave in time ends the mission, and that is to be on record.
            work.perform();
        }
        // Whoever still wants to hand something in is not to wait for somebody to take it.
        drop(inbox);
        work.finish_journal();
        let now = clock.now();
        let mut execution = work.executive.execution(now, internal);
        if let Some(reason) = &work.stopped {
            execution.outcome = kirk_runtime::Outcome::Failed;
            execution.failure = Some(failure::stopped(&execution, now, reason));
        }
        if let (Some(detail), None) = (&work.lost, &execution.failure) {
            execution.outcome = kirk_runtime::Outcome::Failed;
            execution.failure = Some(failure::unrecorded(&execution, detail));
        }
        work.desk.tell(Happening::Over { at: now, execution: execution.clone() });
        if let Some(driver) = work.driver.take() {
            driver.end(execution.clone());
        }
        if let (Some(command), Some(failed)) = (&options.on_failure, &execution.failure) {
            failure::tell(command, &execution.program, failed);
        }
        if let Some(server) = server {
            server.stop();
        }
        Ended { execution, executive: work.executive, lateness: work.lateness, stopped: work.stopped }
    }
}

struct Loop {
    executive: Executive,
    clock: Clock,
    desk: Desk,
    journal: Option<JournalFile>,
    driver: Option<Running>,
    /// Dispatches that were written ahead.
    ahead: HashMap<String, Ticket>,
    /// For which state and time that was done.
    ahead_of: Option<(u64, Time)>,
    /// What is on the disk.
    synced: Ticket,
    /// What leaves when it is.
    outbox: VecDeque<(Ticket, Sending)>,
    /// What the driver was told and has not answered: names by dispatch.
    with_driver: BTreeMap<String, String>,
    /// How long that can take, really.
    answers_within: Real,
    /// News of no use that was recorded: by event and reason.
    ignored: HashSet<(String, Why)>,
    /// How many warnings of the driver were recorded.
    warnings: u32,
    lateness: Lateness,
    stopped: Option<String>,
    /// Somebody has said twice that it is to stop.
    hurried: bool,
    /// Why the journal could not be written, if it could not.
    lost: Option<String>,
    /// Who is answered when it is.
    replies: VecDeque<(Ticket, Vec<EventId>, Acknowledgement, Reply<Acknowledgement>)>,
    /// What is waited for before the clock runs.
    waits: Option<Waits>,
    /// The dispatch that the driver has confirmed before it was time zero.
    begun_by: Option<String>,
}

impl Loop {
    fn go(&mut self, inbox: &Receiver<Message>) {
        self.perform();
        while !self.executive.is_over() && self.stopped.is_none() {
            // News that waits may be older than what is due by now.
            for message in inbox.try_iter().take(AT_ONCE) {
                self.take(message);
            }
            let now = self.clock.now();
            self.plan_anew(now);
            let next = self.executive.poll_timeout();
            if next.is_some_and(|next| next <= now) {
                self.timeout(now);
                continue;
            }
            self.write_ahead(now, next);
            let wait = next.map_or(LONGEST_SLEEP, |next| self.wait(now, next));
            match inbox.recv_timeout(wait.min(LONGEST_SLEEP)) {
                Ok(message) => self.take(message),
                Err(RecvTimeoutError::Timeout) => {}
                // The loop has a desk itself.
                Err(RecvTimeoutError::Disconnected) => break,
            }
            self.check_journal();
        }
        if self.stopped.is_some() {
            self.hear_out(inbox);
        }
    }

    /// The mission was stopped: nothing more leaves, but what the driver is at is waited for, so that what comes of it is on
    /// record, and whoever goes on does not begin it again.
    fn hear_out(&mut self, inbox: &Receiver<Message>) {
        self.outbox.clear();
        let until = Instant::now() + self.answers_within;
        if !self.with_driver.is_empty() {
            let names: Vec<&str> = self.with_driver.values().map(String::as_str).collect();
            let text = format!(
                "stopping as soon as the driver has answered for {}; stop again to leave at once",
                names.join(", ")
            );
            self.desk.tell(Happening::Warning { at: self.clock.now(), text });
        }
        while !self.with_driver.is_empty() && !self.hurried && !self.executive.is_over() {
            match inbox.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(message) => self.take(message),
                Err(_) => break,
            }
        }
    }

    fn timeout(&mut self, now: Time) {
        self.happens(now, Input::Timeout {});
        self.perform();
    }

    /// Something happens to the executive, and what belongs in the journal of it is put there. Says whether it was of use, and
    /// whether anything has changed.
    fn happens(&mut self, at: Time, input: Input) -> (Answer, bool) {
        let Handled { answer, record } = self.executive.handle(at, input);
        let has_changed = record.is_some();
        if let Some(input) = record {
            self.record(at, Record::In(input));
        }
        (answer, has_changed)
    }

    fn take(&mut self, message: Message) {
        let mut now = self.clock.now();
        match message {
            Message::Observed { arrived, events, answer, reply } => {
                self.observed(arrived, events, answer, reply);
                now = arrived;
            }
            Message::Executed { id, ago } => {
                let ago = ago.map(|ago| self.clock.mission(ago).min(now.since_origin()));
                self.with_driver.remove(&id);
                // A driver may say what it likes; said again it is no news.
                let (_, is_news) = self.happens(now, Input::Executed { id, ago });
                if is_news {
                    self.perform();
                    self.sync();
                }
            }
            Message::Failed { id, reason, doubt } => {
                let event = self.with_driver.remove(&id).unwrap_or_else(|| id.clone());
                let failed = Input::Failed { id: id.clone(), reason: reason.clone(), doubt };
                let (_, is_news) = self.happens(now, failed);
                if is_news {
                    self.desk.tell(Happening::Failed { at: now, event, id, reason });
                    self.perform();
                }
            }
            Message::Warning(text) => {
                self.warnings += 1;
                if self.warnings <= MOST_WARNINGS {
                    self.trace(now, Trace::Warning { text: text.clone() });
                }
                self.desk.tell(Happening::Warning { at: now, text });
                self.perform();
            }
            Message::Rebuilt(rebuilt) => {
                self.happens(now, Input::rebuilt(rebuilt));
                self.perform();
            }
            Message::Synced { ticket, result: Ok(()) } => {
                self.synced = self.synced.max(ticket);
                self.let_leave();
            }
            Message::Synced { result: Err(lost), .. } => self.lose_journal(lost),
            Message::State { reply } => reply(self.state(now)),
            Message::Look { reply } => {
                let snapshot = snapshot(&mut self.executive, now, false);
                reply(match self.waits.clone() {
                    Some(waits) => snapshot.before(waits),
                    None => snapshot,
                });
            }
            Message::Stop { .. } if self.stopped.is_some() => self.hurried = true,
            Message::Stop { reason } => self.stopped = Some(reason),
        }
        self.plan_anew(now);
    }

    fn observed(
        &mut self,
        arrived: Time,
        events: Vec<(String, EventId)>,
        mut answer: Acknowledgement,
        reply: Reply<Acknowledgement>,
    ) {
        let mut heard = Vec::new();
        for (name, event) in events {
            let input = Input::observed(self.executive.network(), event);
            let (became, _) = self.happens(arrived, input);
            match became {
                Answer::Accepted => {
                    heard.push(event);
                    answer.accepted.push(name);
                }
                Answer::Ignored(why) => {
                    // What was heard a moment ago may not be on the disk either.
                    heard.extend((why == Why::ObservedBefore).then_some(event));
                    answer.ignored.push(self.ignored(arrived, name, why));
                }
            }
        }
        self.perform();
        if self.lost.is_some() {
            // It is not recorded, so nobody is told that it was heard.
            return;
        }
        let ticket = if heard.is_empty() { 0 } else { self.sync() };
        self.replies.push_back((ticket, heard, answer, reply));
        self.let_leave();
    }

    /// Records that news was of no use, of every event and reason once.
    fn ignored(&mut self, arrived: Time, event: String, why: Why) -> Ignored {
        if self.ignored.insert((event.to_lowercase(), why.clone())) {
            self.trace(arrived, Trace::Ignored { event: event.clone(), why: why.to_string() });
        }
        Ignored { event, why }
    }

    /// Has what news calls for planned anew, elsewhere.
    fn plan_anew(&mut self, now: Time) {
        if let Some(rebuild) = self.executive.poll_rebuild(now) {
            let (desk, work) = (self.desk.clone(), rebuild.clone());
            let planning = move || desk.rebuilt(planned(work));
            if std::thread::Builder::new().spawn(planning).is_err() {
                // The machine has no more threads: late is better than never, and by the desk it might never come, as only this
                // thread takes from it.
                let rebuilt = planned(rebuild);
                self.happens(self.clock.now(), Input::rebuilt(rebuilt));
                self.perform();
            }
        }
    }

    /// Records what has come of it all, and when that is safe lets it leave.
    fn perform(&mut self) {
        if self.waits.is_some() {
            return self.write();
        }
        let now = self.clock.now();
        // Whoever is told of something and asks for the state at once is to see it there.
        self.desk.set_version(self.executive.version());
        let mut sends: Vec<Sending> = Vec::new();
        while let Some(output) = self.executive.poll_output() {
            match output {
                Output::Send(sending) => {
                    let Sending { id, due, attempt, .. } = &sending;
                    let (id, due, attempt) = (id.clone(), *due, *attempt);
                    self.trace(now, Trace::Dispatch { id, due, attempt });
                    sends.push(sending);
                }
                Output::Fixed { event, due } => {
                    if let (Some(due), None) = (due, &self.driver) {
                        self.lateness.add(now, due);
                    }
                    let rows = self.executive.rows(event);
                    if !rows.is_empty() {
                        self.desk.tell(Happening::Fixed { at: now, rows });
                    }
                }
                Output::Warning(text) => {
                    self.trace(now, Trace::Warning { text: text.clone() });
                    self.desk.tell(Happening::Warning { at: now, text });
                }
                Output::Note(text) => self.desk.tell(Happening::Note { at: now, text }),
                Output::Over => {
                    let execution = self.executive.execution(now, false);
                    self.trace(now, Trace::End { execution });
                }
            }
        }
        self.write();
        if self.stopped.is_some() {
            // What has not left is for whoever goes on.
            sends.clear();
        }
        let mut new = None;
        for sending in sends {
            let ticket = match self.ahead.get(&sending.id) {
                Some(&ticket) => ticket,
                None => *new.get_or_insert_with(|| self.sync()),
            };
            self.outbox.push_back((ticket, sending));
        }
        self.let_leave();
    }

    /// Lets go what is recorded for good.
    fn let_leave(&mut self) {
        let safe = if self.journal.is_some() { self.synced } else { Ticket::MAX };
        for _ in 0..self.outbox.len() {
            match self.outbox.pop_front() {
                Some((ticket, sending)) if ticket <= safe => self.send(sending),
                later => self.outbox.extend(later),
            }
        }
        while self.replies.front().is_some_and(|(ticket, ..)| *ticket <= safe) {
            if let Some((_, heard, answer, reply)) = self.replies.pop_front() {
                // From now on the desk answers by itself that it was heard: that is true of what is safe only.
                heard.into_iter().for_each(|event| self.desk.set_observed(event));
                reply(answer);
            }
        }
    }

    fn send(&mut self, sending: Sending) {
        let now = self.clock.now();
        let (became, _) = self.happens(now, Input::Sent { id: sending.id.clone() });
        let leaves = became == Answer::Accepted;
        // The record is there before the driver is told: who resumes knows.
        self.write();
        if !leaves || self.lost.is_some() {
            return;
        }
        let Sending { id, name, due, attempt, .. } = &sending;
        if *attempt == 1 {
            self.lateness.add(now, *due);
        }
        let (id, event, due, attempt) = (id.clone(), name.clone(), *due, *attempt);
        let known = self.begun_by.as_ref() == Some(&id);
        self.desk.tell(Happening::Sent { at: now, event, id, due, attempt });
        if let Some(driver) = self.driver.as_ref().filter(|_| !known) {
            self.with_driver.insert(sending.id.clone(), sending.name.clone());
            driver.send(sending);
        }
    }

    /// If something is to leave soon, puts it on the disk now.
    fn write_ahead(&mut self, now: Time, next: Option<Time>) {
        let Some(next) = next else { return };
        let gap = self.clock.real(now, next);
        if self.journal.is_none() || gap > AHEAD {
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
        // The executive is a value: what will be due is found by trying it on a copy. To announce what then does not happen
        // does no harm; only what has a record of its own counts.
        let mut ahead = self.executive.clone();
        ahead.handle(next, Input::Timeout {});
        let mut ids = Vec::new();
        while let Some(output) = ahead.poll_output() {
            if let Output::Send(sending) = output {
                ids.push(sending.id);
            }
        }
        ids.retain(|id| !self.ahead.contains_key(id));
        if !ids.is_empty() {
            self.trace(self.clock.now(), Trace::Ahead { due: next, ids: ids.clone() });
            self.write();
            let ticket = self.sync();
            self.ahead.extend(ids.into_iter().map(|id| (id, ticket)));
        }
    }

    /// How long to sleep: until it is due, or until it is to be written ahead.
    fn wait(&self, now: Time, next: Time) -> Real {
        let gap = self.clock.real(now, next);
        if self.journal.is_some() && gap > AHEAD { gap - AHEAD } else { gap }
    }

    fn trace(&mut self, time: Time, trace: Trace) {
        self.record(time, Record::Out(trace));
    }

    fn record(&mut self, time: Time, record: Record) {
        if let Some(journal) = &mut self.journal {
            journal.push(&Line::new(time, record));
        }
    }

    fn write(&mut self) {
        if let Some(Err(lost)) = self.journal.as_mut().map(JournalFile::write) {
            self.lose_journal(lost);
        }
    }

    /// Somebody may delete it while nothing is written.
    fn check_journal(&mut self) {
        if let Some(Err(lost)) = self.journal.as_ref().map(JournalFile::check) {
            self.lose_journal(lost);
        }
    }

    fn sync(&mut self) -> Ticket {
        self.journal.as_mut().map_or(0, JournalFile::sync)
    }

    /// A mission whose journal is lost ends: nothing leaves that is not recorded.
    fn lose_journal(&mut self, detail: String) {
        self.journal = None;
        self.outbox.clear();
        self.replies.clear();
        let stopped = Input::Stopped { reason: Reason::JournalFailed, detail: detail.clone() };
        self.executive.handle(self.clock.now(), stopped);
        self.lost = Some(detail);
    }

    fn finish_journal(&mut self) {
        if let Some(Err(lost)) = self.journal.take().map(JournalFile::finish) {
            self.lose_journal(lost);
        }
        self.let_leave();
    }

    fn state(&self, now: Time) -> String {
        let mut execution = self.executive.execution(now, false);
        if self.waits.is_some() {
            execution.rows.clear();
        }
        serde_json::to_string(&execution)
            .unwrap_or_else(|error| unreachable!("a record has only strings and numbers: {error}"))
    }
}

/// The plan, or that there is none: a mission does not wait for ever for one that cannot be made.
fn planned(rebuild: Rebuild) -> Rebuilt {
    let work = AssertUnwindSafe(|| rebuild.clone().run());
    catch_unwind(work).unwrap_or_else(|_| rebuild.without_plan())
}
