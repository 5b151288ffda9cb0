//! The executive: the dispatcher and what stands between it and the world, still without a clock.
//!
//! It hands events over to a driver, under an id that stays the same, until the driver confirms them or their window
//! closes; it answers news; it says when the model is broken, when the mission is over and why it failed. Everything that
//! happens to it is an [`Input`] with its time, so the list of them is the whole execution: the [`journal`](crate::journal) is
//! that list.

mod checkpoints;
mod observations;
mod orders;

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use kirk_network::{Duration, EventId, Network, Time};

use crate::activity::Handover;
use crate::checkpoint::Checkpoint;
use crate::dispatcher::{Adoption, Dispatch, Dispatcher, Settings};
use crate::execution::{Execution, Failure, How, Outcome, Row};
use crate::input::{Answer, Handled, Input, Reason, Why};
use crate::knowledge::Fixed;
use crate::order::{Order, Orders, Patience};
use crate::plan::Plan;
use crate::rebuild::{Rebuild, Rebuilt};
use crate::record::{all_over, and_fails, missed_window, record, row};
use crate::replay::names;

/// An executive in the middle of its mission.
#[derive(Clone, Debug)]
pub struct Executive {
    dispatcher: Dispatcher,
    /// Every name of every event.
    names: Arc<BTreeMap<String, EventId>>,
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
    orders: Orders,
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
            names: Arc::new(names(network).map(|(name, event)| (name.to_string(), event)).collect()),
            dispatcher,
            program,
            run,
            patience,
            handovers,
            handovers_of,
            orders: Orders::default(),
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

    /// Takes what happens, and does everything that is due by then.
    ///
    /// The times of all inputs are in order, but news and confirmations may be of a time shortly before something else was done.
    pub fn handle(&mut self, now: Time, input: Input) -> Handled {
        let before = self.version();
        let mut record = input;
        let answer = match &mut record {
            _ if self.over => Answer::Ignored(Why::Over),
            Input::Timeout {} => {
                self.timeout(now);
                Answer::Accepted
            }
            Input::Observed { event } => match self.names.get(event.as_str()) {
                Some(&event) => self.observed(now, event),
                None => Answer::Ignored(Why::UnknownEvent),
            },
            Input::Sent { id } => self.sent(now, id),
            Input::Executed { id, ago } => self.executed(now, id, *ago),
            Input::Failed { id, reason, doubt } => self.failed(now, id, reason, *doubt),
            Input::Rebuilt { from, known, made } => {
                let made = made.take().map(|made| *made);
                let rebuilt = made.or_else(|| self.rebuild_from(*from).map(Rebuild::run));
                let answer = self.rebuilt(now, rebuilt, known);
                if answer != Answer::Accepted {
                    record = Input::Timeout {};
                }
                answer
            }
            Input::Resumed { unsent } => {
                self.resumed(now, unsent);
                Answer::Accepted
            }
            Input::Stopped { reason, detail } => {
                self.fail(self.network().origin(), now, *reason, detail.clone());
                Answer::Accepted
            }
        };
        // That there is no plan changes nothing, but it is not to be asked again.
        let changed = self.version() != before
            || matches!((&answer, &record), (Answer::Accepted, Input::Rebuilt { .. }));
        Handled { answer, record: changed.then_some(record) }
    }

    fn timeout(&mut self, now: Time) {
        if self.over {
            return;
        }
        self.dispatcher.handle_timeout(now);
        self.settle(now);
        if !self.held.is_empty() && !self.over {
            self.hear_held(now);
        }
    }

    /// What is to be planned anew because of news, if anything is.
    pub fn poll_rebuild(&mut self, now: Time) -> Option<Rebuild> {
        if self.over { None } else { self.dispatcher.poll_rebuild(now) }
    }

    /// What was to be planned anew at a time, as a journal says: the clock may have gone on before the plan was there.
    pub(crate) fn rebuild_from(&mut self, from: Time) -> Option<Rebuild> {
        if self.over { None } else { self.dispatcher.rebuild_from(from) }
    }

    /// Goes on with a new plan, if it is of use, and puts down what was known.
    fn rebuilt(
        &mut self,
        now: Time,
        rebuilt: Option<Rebuilt>,
        record: &mut Option<Box<Checkpoint>>,
    ) -> Answer {
        let Some(rebuilt) = rebuilt else { return Answer::Ignored(Why::NoSuchPlan) };
        let current = self.dispatcher.is_current(&rebuilt);
        // What is known before anything follows from the plan.
        let known = (current && rebuilt.is_plan()).then(|| Box::new(self.checkpoint()));
        let adoption = self.dispatcher.handle_rebuilt(rebuilt);
        *record = known.filter(|_| adoption == Adoption::Followed);
        match adoption {
            Adoption::Followed => self.mend(),
            Adoption::TooLate => {}
            Adoption::NoPlan => {
                if let Some(Broken { event, arrived, said }) = self.broken.pop() {
                    self.fail(event, arrived, Reason::BrokenModel, and_fails(&said));
                }
            }
        }
        self.timeout(now);
        if adoption == Adoption::TooLate { Answer::Ignored(Why::NoSuchPlan) } else { Answer::Accepted }
    }

    /// What is to be done or told next.
    pub fn poll_output(&mut self) -> Option<Output> {
        self.outputs.pop_front()
    }

    /// When [`Input::Timeout`] is to be handled if nothing is heard before.
    pub fn poll_timeout(&mut self) -> Option<Time> {
        if self.over {
            return None;
        }
        let retry = self.orders.open.iter().filter_map(|order| order.course.state.wakes());
        let surely = self.unannounced.iter().filter_map(|&event| surely(&self.dispatcher, event));
        // One microsecond more than is allowed, and it is lost.
        let lost = self
            .awaited
            .iter()
            .filter_map(|(by, _)| by.checked_add(self.slack)?.checked_add(Duration::SHORTEST));
        let soonest =
            retry.chain(surely).chain(lost).min().into_iter().chain(self.dispatcher.poll_timeout()).min();
        // When nothing else is to come.
        soonest.or_else(|| self.overdue(self.dispatcher.now())?.checked_add(Duration::SHORTEST))
    }

    /// What the driver was told of and has not confirmed, in the order in which it was told first.
    pub fn pending(&self) -> Vec<Pending> {
        let open = self.orders.open.iter().filter(|order| !order.is_done());
        let pending = |Order { event, course, .. }: &Order| Pending {
            name: course.name.clone(),
            latest: self.dispatcher.latest(*event),
            attempts: course.attempts,
            again: course.state.wakes(),
            reason: course.reason.clone(),
        };
        open.map(pending).collect()
    }

    /// The events of ours that the driver was told of and has not confirmed, and from when on each may count as executed.
    pub(crate) fn begun(&self) -> Vec<(EventId, Time)> {
        let open = self.orders.open.iter().filter(|order| self.dispatcher.is_in_flight(order.event));
        open.map(|order| (order.event, order.course.due)).collect()
    }

    /// News that waits until nothing that it follows is in flight, and when it came.
    pub(crate) fn held(&self) -> &[(Time, EventId)] {
        &self.held
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
            let open = |order: &Order| !order.is_done() && order.course.name == row.event;
            row.how == How::Dispatched && self.orders.open.iter().any(open)
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
        let names = self.network().written(event);
        names.map(|name| Row { event: name.to_string(), ..row.clone() }).collect()
    }

    /// When the last thing happened, or surely had.
    fn end(&self) -> Time {
        if let Some(failure) = &self.failure {
            return failure.time;
        }
        all_over(&self.dispatcher)
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
        for at in 0..self.orders.open.len() {
            if !self.over {
                self.look_after(at, now);
            }
        }
        self.miss_news(now);
        if self.over {
            return;
        }
        if let Some(missed) = self.dispatcher.missed() {
            let failure = missed_window(self.network(), missed);
            self.fail(missed.event, missed.time, failure.reason, failure.detail);
        } else if self.unannounced.is_empty()
            && self.held.is_empty()
            && self.orders.open.is_empty()
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
            if let Some(Fixed { how: How::Imagined, .. }) = self.dispatcher.known(event).fixed {
                self.awaited.extend(self.dispatcher.observed_by(event).map(|by| (by, event)));
            }
        }
    }

    fn fail(&mut self, event: EventId, now: Time, reason: Reason, detail: String) {
        self.failure =
            Some(Failure { event: self.network().label(event).to_string(), time: now, reason, detail });
        self.over = true;
        self.changes += 1;
        self.outputs.push_back(Output::Over);
    }
}

/// When a contingent event that starts an activity counts as happened: when it is taken, and if it is not waited for, when
/// it surely has.
fn surely(dispatcher: &Dispatcher, event: EventId) -> Option<Time> {
    let latest = || dispatcher.happened(event).map(|within| within.latest);
    match dispatcher.known(event).fixed {
        Some(fixed) => Some(fixed.time),
        None => latest().filter(|_| dispatcher.is_hidden(event)),
    }
}
