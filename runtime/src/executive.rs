//! The executive: the dispatcher and what stands between it and the world, still without a clock.
//!
//! It hands events over to a driver, under an id that stays the same, until the driver confirms them or their window
//! closes; it answers news; it says when the model is broken, when the mission is over and why it failed. Everything that
//! happens to it comes in through a `handle_*` method with its time, so a list of those calls is the whole execution: the
//! [`journal`](crate::journal) is that list.

mod checkpoints;
mod orders;

use std::collections::VecDeque;

use kirk_network::{Duration, EventId, Network, Time};

use crate::activity::Handover;
use crate::checkpoint::Checkpoint;
use crate::dispatcher::{Adoption, Dispatch, Dispatcher, Reception, Settings};
use crate::execution::{Execution, Failure, How, Outcome, Row, at};
use crate::order::{Order, Patience, State};
use crate::plan::Plan;
use crate::rebuild::{Rebuild, Rebuilt};
use crate::record::{all_over, missed_window, record, row};

const MICROSECOND: Duration = Duration::from_micros(1);

/// An executive in the middle of its mission.
#[derive(Clone, Debug)]
pub struct Executive {
    dispatcher: Dispatcher,
    program: String,
    /// What the ids of its dispatches begin with.
    run: String,
    lateness: Duration,
    /// How far news may be outside of what the model allows.
    slack: Duration,
    patience: Patience,
    handovers: Vec<Handover>,
    /// For each event, where its handovers begin and end.
    handovers_of: Vec<(u32, u32)>,
    orders: Vec<Order>,
    /// Contingent events that start activities, which nobody has been told of.
    unannounced: Vec<EventId>,
    /// News of what began with an event that is in flight.
    held: Vec<(Time, EventId)>,
    /// Events that were imagined, and when their news was to come at the latest by the model.
    awaited: Vec<(Time, EventId)>,
    /// News the model rules out, while it is not known whether there is a plan with it.
    broken: Vec<Broken>,
    outputs: VecDeque<Output>,
    failure: Option<Failure>,
    over: bool,
    changes: u64,
}

/// News the model rules out.
#[derive(Clone, Debug)]
struct Broken {
    event: EventId,
    arrived: Time,
    /// What is wrong with it, in words.
    said: String,
}

/// What became of a new plan.
#[derive(Clone, Debug)]
pub enum Replanned {
    /// It is followed from now on. That belongs in the journal with what was known, so that nobody has to make the plans before
    /// it once more.
    Followed(Box<Checkpoint>),
    /// There is none, which belongs in the journal, too.
    NoPlan,
    /// It came too late to be of use.
    TooLate,
}

/// What is to be done, or told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Hand this over to the driver.
    Send(Sending),
    /// An event was fixed: dispatched and confirmed, observed, released from the buffer, imagined.
    Fixed {
        /// The event.
        event: EventId,
        /// When it was due, if somebody is told of it just now and is to carry it out.
        due: Option<Time>,
    },
    /// Something a person should know: not all is as it should be.
    Warning(String),
    /// Something a person may want to know: all is well.
    Note(String),
    /// The mission is over.
    Over,
}

/// One attempt to hand an event over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sending {
    /// The same for every attempt, and after a restart: whoever has seen it does not do it again.
    pub id: String,
    /// The event, under one of its names.
    pub name: String,
    /// The end of the activity it starts.
    pub companion: Option<String>,
    /// When it is due.
    pub due: Time,
    /// Until when it may be executed, if there is such a time.
    pub latest: Option<Time>,
    /// 1 for the first.
    pub attempt: u32,
}

/// An event the driver was told of and has not confirmed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pending {
    /// The event, under one of its names.
    pub name: String,
    /// Until when it may be executed, if there is such a time.
    pub latest: Option<Time>,
    /// How often it was handed over.
    pub attempts: u32,
    /// When it is handed over again, if the last attempt failed.
    pub again: Option<Time>,
    /// Why the last attempt that failed did; empty if none has.
    pub reason: String,
}

/// What became of news.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is known now.
    Accepted,
    /// It is of no use, and why.
    Ignored(String),
}

/// How an executive is set up.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The control program, or the name of the network.
    pub program: String,
    /// What the ids of its dispatches begin with; no two runs share it.
    pub run: String,
    /// Lead and lateness; what is confirmed follows from the handovers.
    pub settings: Settings,
    /// What somebody is to carry out, in the order of the events.
    pub handovers: Vec<Handover>,
    /// A driver is told of that and confirms it. Without one it counts as carried out when it is told.
    pub driver: bool,
    /// How long to wait before trying again.
    pub patience: Patience,
}

impl Setup {
    /// The settings of the dispatcher: what is handed over is to be confirmed.
    fn settings_for(&self, network: &Network) -> Settings {
        let ours = |event: EventId| network.link_of(event).is_none() && event != network.origin();
        let events = self.handovers.iter().map(|handover| handover.event);
        let carried_out = events.filter(|&event| ours(event)).collect();
        Settings { carried_out, confirmed: self.driver, ..self.settings.clone() }
    }
}

impl Executive {
    /// Starts a mission: it is time 0.
    pub fn new(plan: Plan, setup: Setup) -> Executive {
        let settings = setup.settings_for(plan.network());
        let mut executive = Executive::around(Dispatcher::new(plan, settings), setup);
        executive.settle(Time::ZERO);
        executive
    }

    /// Nothing is in the hands of a driver.
    fn around(dispatcher: Dispatcher, setup: Setup) -> Executive {
        let Setup { program, run, settings, handovers, driver, patience } = setup;
        let handovers = if driver { handovers } else { Vec::new() };
        let network = dispatcher.network();
        let unannounced = handovers.iter().map(|handover| handover.event);
        let mut unannounced: Vec<EventId> =
            unannounced.filter(|&event| network.link_of(event).is_some()).collect();
        unannounced.dedup();
        let mut handovers_of = vec![(0, 0); network.events().len()];
        for (index, handover) in handovers.iter().enumerate() {
            let (start, end) = &mut handovers_of[handover.event.index()];
            *start = if *end == 0 { index as u32 } else { *start };
            *end = index as u32 + 1;
        }
        Executive {
            lateness: settings.lateness,
            slack: settings.lead.checked_add(settings.lateness).unwrap_or(settings.lead),
            dispatcher,
            program,
            run,
            patience,
            handovers,
            handovers_of,
            orders: Vec::new(),
            unannounced,
            held: Vec::new(),
            awaited: Vec::new(),
            broken: Vec::new(),
            outputs: VecDeque::new(),
            failure: None,
            over: false,
            changes: 0,
        }
    }

    /// The network that is executed.
    pub fn network(&self) -> &Network {
        self.dispatcher.network()
    }

    /// The dispatcher, to look at.
    pub fn dispatcher(&self) -> &Dispatcher {
        &self.dispatcher
    }

    /// Changes whenever anything has happened; a call that changes nothing need not be recorded.
    pub fn version(&self) -> u64 {
        self.dispatcher.version().wrapping_add(self.changes)
    }

    /// True when the mission is over.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// Why the mission failed, if it did.
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// Does everything that is due by now.
    pub fn handle_timeout(&mut self, now: Time) {
        if self.over {
            return;
        }
        self.dispatcher.handle_timeout(now);
        self.settle(now);
        if !self.held.is_empty() && !self.over {
            self.hear_held(now);
        }
    }

    /// Takes news that arrived at a time, usually now.
    pub fn handle_news(&mut self, arrived: Time, event: EventId) -> Answer {
        let name = self.network().label(event).to_string();
        if self.dispatcher.known(event).observed.is_some() || self.held.iter().any(|held| held.1 == event) {
            return Answer::Ignored(format!("`{name}` was heard before"));
        }
        if self.network().link_of(event).is_none() {
            return Answer::Ignored(format!("`{name}` is not Nature's to decide: kirk dispatches it"));
        }
        if self.over {
            return Answer::Ignored("the mission is over".to_string());
        }
        // What was due before comes before; at one time Nature comes first.
        self.handle_timeout(Time::from_micros(arrived.as_micros() - 1));
        if self.dispatcher.is_in_flight(self.dispatcher.root(event)) {
            self.held.push((arrived, event));
            self.changes += 1;
            return Answer::Accepted;
        }
        let answer = self.hear(arrived, event);
        self.handle_timeout(arrived);
        answer
    }

    /// True if a dispatch is with the driver or was.
    pub fn is_order(&self, id: &str) -> bool {
        self.orders.iter().any(|order| order.id == id)
    }

    /// The driver has executed what was handed over, `ago` before now if it says so.
    pub fn handle_executed(&mut self, now: Time, id: &str, ago: Option<Duration>) {
        let Some(order) = self.orders.iter_mut().find(|order| order.id == id) else { return };
        if self.over || order.state == State::Done {
            return;
        }
        order.state = State::Done;
        if let Some(at) = ago.and_then(|ago| now.as_micros().checked_sub(ago.as_micros())) {
            order.started = Time::from_micros(at).max(order.first_sent);
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
    }

    /// Takes the news that had to wait for what was in flight.
    fn hear_held(&mut self, now: Time) {
        for (arrived, event) in std::mem::take(&mut self.held) {
            if self.dispatcher.is_in_flight(self.dispatcher.root(event)) {
                self.held.push((arrived, event));
            } else {
                self.hear(arrived, event);
            }
        }
        self.dispatcher.handle_timeout(now);
        self.settle(now);
    }

    /// The driver could not execute what was handed over, or in case of `doubt` nobody knows. It is tried again while that
    /// makes sense.
    pub fn handle_failed(&mut self, now: Time, id: &str, reason: &str, doubt: bool) {
        let patience = self.patience;
        let Some(order) = self.orders.iter_mut().find(|order| order.id == id) else { return };
        if self.over || !matches!(order.state, State::Sent) {
            return;
        }
        order.failed(now, reason, patience);
        // One that says no had not done it before either.
        order.doubtful = doubt;
        self.changes += 1;
        self.settle(now);
    }

    /// Somebody or something outside ends the mission.
    pub fn handle_stopped(&mut self, now: Time, reason: &str, detail: &str) {
        if !self.over {
            self.fail(self.network().origin(), now, reason, detail.to_string());
        }
    }

    /// What is to be planned anew because of news, if anything is.
    pub fn poll_rebuild(&mut self, now: Time) -> Option<Rebuild> {
        if self.over { None } else { self.dispatcher.poll_rebuild(now) }
    }

    /// Goes on with a new plan, or says that it is of no use.
    pub fn handle_rebuilt(&mut self, now: Time, rebuilt: Rebuilt) -> Replanned {
        if self.over {
            return Replanned::TooLate;
        }
        let current = self.dispatcher.is_current(&rebuilt);
        // What is known before anything follows from the plan.
        let known = (current && rebuilt.is_plan()).then(|| Box::new(self.checkpoint()));
        let replanned = match (self.dispatcher.handle_rebuilt(rebuilt), known) {
            (Adoption::Followed, Some(known)) => {
                self.mend();
                Replanned::Followed(known)
            }
            (Adoption::TooLate, _) => Replanned::TooLate,
            (Adoption::NoPlan | Adoption::Followed, _) => {
                if let Some(Broken { event, arrived, said }) = self.broken.pop() {
                    let detail = format!("{said}, and the rest cannot be guaranteed any more");
                    self.fail(event, arrived, "broken-model", detail);
                }
                Replanned::NoPlan
            }
        };
        self.handle_timeout(now);
        replanned
    }

    /// There is a plan with all the news, whatever the model says.
    fn mend(&mut self) {
        for Broken { said, .. } in std::mem::take(&mut self.broken) {
            self.outputs.push_back(Output::Warning(format!(
                "{said}; the rest can still be guaranteed, the mission goes on"
            )));
        }
    }

    /// What is to be done or told next.
    pub fn poll_output(&mut self) -> Option<Output> {
        self.outputs.pop_front()
    }

    /// When to call [`Executive::handle_timeout`] if nothing is heard before.
    pub fn poll_timeout(&mut self) -> Option<Time> {
        if self.over {
            return None;
        }
        let retry = self.orders.iter().filter_map(|order| order.state.wakes());
        let surely = self.unannounced.iter().filter_map(|&event| surely(&self.dispatcher, event));
        // One microsecond more than is allowed, and it is lost.
        let lost =
            self.awaited.iter().filter_map(|(by, _)| by.checked_add(self.slack)?.checked_add(MICROSECOND));
        let soonest =
            retry.chain(surely).chain(lost).min().into_iter().chain(self.dispatcher.poll_timeout()).min();
        // When nothing else is to come.
        soonest.or_else(|| self.overdue(self.dispatcher.now())?.checked_add(MICROSECOND))
    }

    /// What the driver was told of and has not confirmed, in the order in which it was told first.
    pub fn pending(&self) -> Vec<Pending> {
        let open = self.orders.iter().filter(|order| order.state != State::Done);
        let pending = |order: &Order| Pending {
            name: order.name.clone(),
            latest: self.dispatcher.latest(order.event),
            attempts: order.attempts,
            again: order.state.wakes(),
            reason: order.reason.clone(),
        };
        open.map(pending).collect()
    }

    /// What will be done next if nothing is heard: when, with which event, and how.
    pub fn upcoming(&mut self) -> Option<(Time, EventId, How)> {
        if self.over { None } else { self.dispatcher.upcoming() }
    }

    /// The execution as it stands.
    pub fn execution(&self, now: Time, internal: bool) -> Execution {
        let end = if self.over { self.end() } else { now };
        let mut execution = record(&self.dispatcher, &self.program, end, internal, &[]);
        if !self.over {
            // What is not known yet may still be heard.
            execution.rows.retain(|row| row.how != How::Never);
        }
        // The origin is time zero whatever the driver does, but an activity that was to start there may not have.
        let unconfirmed = |row: &Row| {
            let open = |order: &Order| order.state != State::Done && order.name == row.event;
            row.how == How::Dispatched && self.orders.iter().any(open)
        };
        execution.rows.retain(|row| !unconfirmed(row));
        execution.failure = self.failure.clone();
        execution.outcome = match (&self.failure, self.over) {
            (Some(_), _) => Outcome::Failed,
            (None, true) => Outcome::Completed,
            (None, false) => Outcome::Running,
        };
        execution
    }

    /// The rows of one event in the record, one for each name a user wrote. Empty if it is not known.
    pub fn rows(&self, event: EventId) -> Vec<Row> {
        let happened = self.dispatcher.happened(event);
        let Some((_, row)) = row(&self.dispatcher, event, happened, None) else { return Vec::new() };
        let names = self.network().events()[event.index()].names.iter().filter(|name| !name.internal);
        names.map(|name| Row { event: name.text.clone(), ..row.clone() }).collect()
    }

    /// When the last thing happened, or surely had.
    fn end(&self) -> Time {
        if let Some(failure) = &self.failure {
            return Time::from_micros(failure.time.0.as_micros());
        }
        all_over(&self.dispatcher)
    }

    fn hear(&mut self, arrived: Time, event: EventId) -> Answer {
        let name = self.network().label(event).to_string();
        match self.dispatcher.handle_observation(arrived, event) {
            Reception::Accepted => {
                self.tell_rounding(arrived, event);
                Answer::Accepted
            }
            Reception::Repeated => Answer::Ignored(format!("`{name}` was heard before")),
            Reception::NotContingent => {
                Answer::Ignored(format!("`{name}` is not Nature's to decide: kirk dispatches it"))
            }
            Reception::Impossible { earliest: None, .. } => {
                let start = self.network().label(self.dispatcher.root(event));
                Answer::Ignored(format!("`{name}` cannot have happened: `{start}` has not been executed"))
            }
            // From where to plan anew is known when nothing is in flight.
            Reception::Impossible { .. } if self.dispatcher.has_in_flight() => {
                self.held.push((arrived, event));
                self.changes += 1;
                Answer::Accepted
            }
            Reception::Impossible { earliest: Some(earliest), latest } => {
                let window = match latest {
                    Some(latest) if arrived > latest => format!("too late: it was to come by {latest} s"),
                    _ => format!("too early: it was to come from {earliest} s on"),
                };
                let said = format!("the model is broken: news of `{name}` at {arrived} s is {window}");
                self.dispatcher.handle_impossible(arrived, event);
                self.broken.push(Broken { event, arrived, said });
                Answer::Accepted
            }
        }
    }

    /// Says so when news counts as if it had come when the model allows it.
    fn tell_rounding(&mut self, arrived: Time, event: EventId) {
        let Some(heard) = self.dispatcher.known(event).observed.filter(|&heard| heard != arrived) else {
            return;
        };
        let (name, slack) = (self.network().label(event), self.slack);
        let first = if heard < arrived { "the latest" } else { "the earliest" };
        let text = format!(
            "news of `{name}` at {arrived} s counts as of {heard} s, {first} the model allows: it is within the tolerance of \
             {slack} s"
        );
        self.outputs.push_back(Output::Note(text));
    }

    /// Turns what the dispatcher has decided into orders and outputs, and looks after the orders there are.
    fn settle(&mut self, now: Time) {
        let mut told = Vec::new();
        while let Some(dispatch) = self.dispatcher.poll_dispatch() {
            self.hand_over(dispatch.event, dispatch.time, now);
            told.push(dispatch);
        }
        self.tell_fixed(&told);
        for event in std::mem::take(&mut self.unannounced) {
            match surely(&self.dispatcher, event) {
                Some(time) if time <= now => self.hand_over(event, time, now),
                _ => self.unannounced.push(event),
            }
        }
        for at in 0..self.orders.len() {
            self.look_after(at, now);
        }
        self.miss_news(now);
        if self.over {
            return;
        }
        if let Some(missed) = self.dispatcher.missed() {
            let failure = missed_window(self.network(), missed);
            self.fail(missed.event, missed.time, &failure.reason, failure.detail);
        } else if self.unannounced.is_empty()
            && self.held.is_empty()
            && self.orders.iter().all(|order| order.state == State::Done)
            && self.dispatcher.is_over()
            && self.overdue(now).is_none()
        {
            // A plan with the last news would have come too late.
            self.dispatcher.fix_heard();
            self.tell_fixed(&[]);
            self.over = true;
            self.changes += 1;
            self.outputs.push_back(Output::Over);
        }
    }

    fn tell_fixed(&mut self, told: &[Dispatch]) {
        while let Some(event) = self.dispatcher.poll_fixed() {
            let told = || told.iter().find(|dispatch| dispatch.event == event).map(|dispatch| dispatch.time);
            let due = if self.dispatcher.is_carried_out(event) { told() } else { None };
            self.outputs.push_back(Output::Fixed { event, due });
            if let Some((_, How::Imagined)) = self.dispatcher.known(event).fixed {
                self.awaited.extend(self.dispatcher.news_by(event).map(|by| (by, event)));
            }
        }
    }

    /// Until when news may still come that is late by no more than is allowed. A mission that ends before that would say of it
    /// that it is lost.
    fn overdue(&self, now: Time) -> Option<Time> {
        let network = self.network();
        let unheard = network.contingents().iter().map(|link| link.to);
        let unheard = unheard.filter(|&event| self.dispatcher.known(event).observed.is_none());
        let late = unheard.filter_map(|event| self.dispatcher.news_by(event)).filter(|&by| by < now);
        late.filter_map(|by| by.checked_add(self.slack)).filter(|&until| until >= now).max()
    }

    /// Says so when news is lost: what was imagined stands, but something is wrong in the world.
    fn miss_news(&mut self, now: Time) {
        for (by, event) in std::mem::take(&mut self.awaited) {
            if self.dispatcher.known(event).observed.is_some() {
                continue;
            }
            if by.checked_add(self.slack).is_none_or(|by| by >= now) {
                self.awaited.push((by, event));
                continue;
            }
            self.changes += 1;
            self.outputs.push_back(Output::Warning(format!(
                "nothing was heard of `{}`, though its news was to come by {by} s: the model is broken, or the news is lost; the \
                 mission goes on as if it had happened",
                self.network().label(event)
            )));
        }
    }

    fn fail(&mut self, event: EventId, now: Time, reason: &str, detail: String) {
        self.failure = Some(Failure {
            event: self.network().label(event).to_string(),
            time: at(now),
            reason: reason.to_string(),
            detail,
        });
        self.over = true;
        self.changes += 1;
        self.outputs.push_back(Output::Over);
    }
}

/// When a contingent event that starts an activity counts as happened: when it is taken, and if it is not waited for, when
/// it surely has.
fn surely(dispatcher: &Dispatcher, event: EventId) -> Option<Time> {
    let high = || dispatcher.happened(event).map(|(_, high)| Time::from_micros(high));
    match dispatcher.known(event).fixed {
        Some((time, _)) => Some(time),
        None => high().filter(|_| dispatcher.is_hidden(event)),
    }
}
