//! The dispatcher: a state machine that decides, from what is known when it is known, what to execute when.
//!
//! It holds no clock. Call [`Dispatcher::handle_observation`] when news arrives and [`Dispatcher::handle_timeout`] when
//! the time of [`Dispatcher::poll_timeout`] has come (earlier or again is harmless), each with the present time, which
//! never goes back; then take what is to be done from [`Dispatcher::poll_dispatch`].
//!
//! Events that a driver carries out are *in flight* from their dispatch until
//! [`Dispatcher::handle_executed`] confirms them: what must follow them waits for that.
//!
//! Real clocks are late. An event executed no later than [`Settings::lateness`] after it was due is recorded at the time
//! it was due, so that lateness does not add up through the plan (N. Muscettola, P. Morris, B. Pell, B. Smith, *Issues in
//! temporal reasoning for autonomous control systems*, 1998, section 3); one that is later is recorded as late as it is,
//! if its window allows. An event that nobody has to execute (the end of a pause, the join of two branches) happens when it is
//! due by definition, however late we look at the clock, and so do the moments at which buffered news is released and missing
//! news is imagined. Executing at such times afterwards comes to what a clock that is never late would have led to: each was the
//! earliest at which the event could be executed, whatever was executed since.
//!
//! News is mapped as in sections 5.2.2 and appendix C of the thesis. News within the window of the plan is taken at
//! once. Early news is *buffered* to the start of the window, missing news is *imagined* at its end. With
//! [`Strategy::Optimistic`], news that says more than the plan assumed replaces the event by the interval in which it
//! must have happened, and what is left is planned anew: [`Dispatcher::poll_rebuild`] hands out the work, which may take
//! its time elsewhere. The buffering execution satisfies the new plan too, so there always is one; it only adds freedom,
//! and until it is there the old plan stands.

mod flight;
mod replan;
mod so_far;
mod why;

use std::collections::VecDeque;
use std::sync::Arc;

use flight::InFlight;
use kirk_network::precedence::Precedence;
use kirk_network::reduce::{Reduction, Whereabouts};
use kirk_network::stnu::{Link, Rows};
use kirk_network::{Dispatchable, Duration, EventId, Interval, Network, Time};
pub use replan::Adoption;
pub(crate) use replan::Taken;

use crate::agenda::Agenda;
use crate::cause::Cause;
use crate::execution::How;
use crate::knowledge::{Knowledge, Known, heard_now};
use crate::measured::Measured;
use crate::plan::Plan;
use why::Causes;

/// What to do with news that says more than the plan assumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Strategy {
    /// Hold it until the plan expects it.
    Buffer,
    /// Plan anew with it.
    #[default]
    Optimistic,
}

/// How an execution treats news and time.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Settings {
    /// What to do with news that says more than the plan assumed.
    pub strategy: Strategy,
    /// The executable events that somebody carries out, at the earliest when told. All others happen when they are due.
    pub carried_out: Vec<EventId>,
    /// Those count as executed only when [`Dispatcher::handle_executed`] says so.
    pub confirmed: bool,
    /// How long before they are due those are dispatched.
    pub lead: Duration,
    /// Up to how late an event is recorded as executed when it was due.
    pub lateness: Duration,
}

impl Settings {
    /// How long before it is due an event is dispatched.
    fn lead_of(&self, carried_out: bool) -> Duration {
        if carried_out && self.confirmed { self.lead } else { Duration::ZERO }
    }

    /// Nothing is ever late, and every dispatch is its own execution.
    pub fn of(strategy: Strategy) -> Settings {
        Settings { strategy, ..Settings::default() }
    }
}

/// An executable event to be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dispatch {
    /// The event of the merged network.
    pub event: EventId,
    /// When it is due.
    pub time: Time,
}

/// What was done with news.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reception {
    /// It was recorded, and used if it is of use.
    Accepted,
    /// It was heard before.
    Repeated,
    /// The event is ours to execute, not Nature's.
    NotContingent,
    /// The model says it cannot arrive now; it was not recorded.
    Impossible {
        /// The earliest it can arrive, if its activation is known to have happened.
        earliest: Option<Time>,
        /// The latest it can arrive.
        latest: Option<Time>,
    },
}

/// An event that could not be executed in its window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Missed {
    /// The event.
    pub event: EventId,
    /// When it would have been executed.
    pub time: Time,
    /// When it was due.
    pub due: Time,
    /// The latest time at which it could be.
    pub latest: Time,
}

/// The state of an execution.
#[derive(Clone, Debug)]
pub struct Dispatcher {
    network: Arc<Network>,
    settings: Settings,
    precedence: Arc<Precedence>,
    /// For each event: does somebody carry it out?
    carried_out: Vec<bool>,
    reduction: Reduction,
    agenda: Agenda,
    /// The links that have started and whose contingent node has not happened: (window, link).
    active: Vec<(Interval, u32)>,
    knowledge: Knowledge,
    /// Events without a node of their own that may not have happened yet: (when they surely have, event).
    unplaced: Vec<(Time, EventId)>,
    /// For every node of the plan the events placed there.
    placed_at: Rows,
    measured: Measured,
    now: Time,
    in_flight: Vec<InFlight>,
    dispatches: VecDeque<Dispatch>,
    fixed: VecDeque<EventId>,
    /// For each event what decided when it was fixed.
    causes: Causes,
    /// What it means to be held by the origin, if the plan that is followed is not the first.
    anew: Option<Cause>,
    /// News came that is not planned with yet, and a plan with it has been asked for.
    stale: bool,
    asked: bool,
    /// News came that the model rules out: nothing is done before it is known whether there is a plan with it.
    broken: bool,
    /// Changes whenever anything happens.
    version: u64,
    missed: Option<Missed>,
}

impl Dispatcher {
    /// Starts an execution: the origin is dispatched, and executed, at time 0.
    pub fn new(plan: Plan, settings: Settings) -> Dispatcher {
        let knowledge = Knowledge::new(plan.network());
        let mut dispatcher = Dispatcher::following(plan, settings, knowledge);
        let origin = dispatcher.network().origin();
        dispatcher.dispatches.push_back(Dispatch { event: origin, time: Time::ZERO });
        dispatcher.fix(origin, Time::ZERO, How::Dispatched, Cause::Start);
        dispatcher.activate_from_origin();
        dispatcher
    }

    /// All that is known, beside a plan that does not fit it: to be looked at, not to go on with.
    pub(crate) fn knowing(plan: Plan, settings: Settings, knowledge: Knowledge) -> Dispatcher {
        Dispatcher::following(plan, settings, knowledge)
    }

    /// Nothing of the plan is executed yet, not even its origin.
    fn following(plan: Plan, settings: Settings, knowledge: Knowledge) -> Dispatcher {
        let Plan { network, reduction, net, precedence } = plan;
        let mut carried_out = vec![false; network.events().len()];
        for event in &settings.carried_out {
            carried_out[event.index()] = true;
        }
        Dispatcher {
            agenda: agenda(&reduction, &net, |event| settings.lead_of(carried_out[event.index()])),
            settings,
            precedence,
            carried_out,
            reduction,
            active: Vec::new(),
            knowledge,
            unplaced: Vec::new(),
            placed_at: Rows::new(0, std::iter::empty()),
            measured: Measured::new(&network),
            now: Time::ZERO,
            in_flight: Vec::new(),
            dispatches: VecDeque::new(),
            fixed: VecDeque::new(),
            causes: Causes(vec![None; network.events().len()]),
            anew: None,
            stale: false,
            asked: false,
            broken: false,
            version: 0,
            missed: None,
            network,
        }
    }

    /// The network that is executed.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// The place of an event among those of one time in a record.
    pub(crate) fn order(&self, event: EventId) -> u32 {
        self.precedence.order(event)
    }

    /// The latest time that anything was done.
    pub(crate) fn now(&self) -> Time {
        self.now
    }

    /// What is known of an event.
    pub fn known(&self, event: EventId) -> &Known {
        self.knowledge.of(event)
    }

    /// The event that could not be executed in its window, if that has happened. Then nothing more is dispatched.
    pub fn missed(&self) -> Option<Missed> {
        self.missed
    }

    /// Takes news of an event that arrived at a time, usually now. News that is outside of what the model allows by no more
    /// than the lead and the lateness of dispatches counts as if it had come when it may.
    pub fn handle_observation(&mut self, arrived: Time, event: EventId) -> Reception {
        self.now = self.now.max(arrived);
        let Some(link) = self.network().link_of(event) else { return Reception::NotContingent };
        if self.known(event).observed.is_some() {
            return Reception::Repeated;
        }
        let link = self.network().contingents()[link];
        let Some(before) = self.happened(event) else {
            return Reception::Impossible { earliest: None, latest: None };
        };
        let earliest = before.earliest.saturating_add(link.delay.min);
        let latest = link.delay.max.finite().map(|max| before.latest.saturating_add(max));
        let nearest = arrived.max(earliest).min(latest.unwrap_or(Time::MAX));
        let slack = self.settings.lead.saturating_add(self.settings.lateness);
        let heard = if nearest.saturating_since(arrived).abs() <= slack { nearest } else { arrived };
        if self.knowledge.rules_out(&self.network, event, heard) {
            // Who was told when it was to come, and that it has not, is told the same again.
            let by_model = self.knowledge.observed_by(&self.network, event).filter(|&by| by < arrived);
            return Reception::Impossible { earliest: Some(earliest), latest: by_model.or(latest) };
        }
        self.version += 1;
        self.knowledge.hear(event, heard);
        self.knowledge.add_evidence(event, heard_now(&link, heard));
        let place = self.reduction.places[event.index()];
        let window = self.active.iter().copied().find(|&(_, link)| {
            self.reduction.stnu.links[link as usize].contingent == place.node && place.heard_by == Some(event)
        });
        match window {
            Some((window, _)) if window.contains(heard) => self.happen(place.node, heard, How::Observed),
            _ if self.settings.strategy == Strategy::Optimistic && self.says_more(event) => self.stale = true,
            _ if place.heard_by != Some(event) => self.fix(event, heard, How::Observed, Cause::Observed),
            _ => {}
        }
        Reception::Accepted
    }

    /// Takes news, arrived at a time, that the model rules out: the event happened when its delay or its link says, one of
    /// which is wrong. It has to be planned anew with that, and until there is an answer nothing is done. An event whose
    /// activation has not happened is not taken. Nothing may be in flight.
    pub fn handle_impossible(&mut self, arrived: Time, event: EventId) {
        self.now = self.now.max(arrived);
        if self.network.link_of(event).is_none()
            || !self.knowledge.hear_against(&self.network, event, arrived)
        {
            return;
        }
        self.version += 1;
        (self.stale, self.broken) = (true, true);
    }

    /// Does everything that is due by now: releases buffered news, imagines missing news, dispatches events.
    pub fn handle_timeout(&mut self, now: Time) {
        self.now = self.now.max(now);
        while self.missed.is_none() && !self.broken {
            let link = self.next_link().filter(|&(time, ..)| time <= self.now);
            let early = self.next_early().filter(|&(time, _)| time <= self.now);
            let event = self.agenda.next().filter(|&(action, _)| action <= self.now);
            let event = event.map(|(_, node)| (self.executed_at(node), node));
            // At one time Nature comes first, so that we act on all there is to know.
            let first = early.map(|(time, _)| time).into_iter().chain(event.map(|(time, _)| time)).min();
            match (link, early, event) {
                (Some((time, node, how)), ..) if first.is_none_or(|first| time <= first) => {
                    self.happen(node, time, how);
                }
                (_, Some((time, at)), _) if Some(time) == first => {
                    let flight = self.in_flight.remove(at);
                    self.version += 1;
                    self.executed(flight, time);
                }
                (.., Some((time, node))) => self.execute(time, node),
                _ => break,
            }
        }
    }

    /// The next event to be fixed, however it came to be; call until there is none.
    pub fn poll_fixed(&mut self) -> Option<EventId> {
        self.fixed.pop_front()
    }

    /// Until when the moment of acting on a contingent event could have been: the end of its window, if it has one.
    pub fn window_end(&self, event: EventId) -> Option<Time> {
        let node = self.reduction.places[event.index()].node;
        let link = self.reduction.stnu.links.iter().find(|link| link.contingent == node)?;
        Some(window(link, self.agenda.executed(link.activation)?).latest)
    }

    /// True if no news of an event is waited for.
    pub fn is_hidden(&self, event: EventId) -> bool {
        self.reduction.places[event.index()].heard_by != Some(event)
    }

    /// The executable event at which the tree of links that an event belongs to begins; itself if it is executable.
    pub fn root(&self, event: EventId) -> EventId {
        self.knowledge.root(event)
    }

    /// Changes whenever anything has happened.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// True when nothing is left to be done, or nothing can be.
    pub fn is_over(&mut self) -> bool {
        self.missed.is_some() || !self.broken && self.in_flight.is_empty() && self.poll_timeout().is_none()
    }

    /// The next event to be dispatched; call until there is none.
    pub fn poll_dispatch(&mut self) -> Option<Dispatch> {
        self.dispatches.pop_front()
    }

    /// When there is something to do next if nothing is heard; `None` when the execution is over or all depends on what is in
    /// flight, or on a new plan.
    pub fn poll_timeout(&mut self) -> Option<Time> {
        if self.missed.is_some() || self.broken {
            return None;
        }
        let link = self.next_link().map(|(time, ..)| time);
        let event = self.agenda.next().map(|(time, _)| time);
        let over = self.last_unheard().filter(|&time| time > self.now);
        let early = self.next_early().map(|(time, _)| time);
        link.into_iter().chain(early).chain(event).chain(over).min().map(|time| time.max(self.now))
    }

    /// What will be done next if nothing is heard: when, with which event, and how. `None` when nothing is left or all
    /// depends on what is in flight, or on a new plan.
    pub fn upcoming(&mut self) -> Option<(Time, EventId, How)> {
        if self.missed.is_some() || self.broken {
            return None;
        }
        let link = self.next_link().map(|(time, node, how)| (time, self.acted_on(node), how));
        let event = self.agenda.next().map(|(_, node)| {
            (self.agenda.due(node), self.reduction.event_of[node as usize], How::Dispatched)
        });
        let next = link.into_iter().chain(event).min_by_key(|&(time, ..)| time);
        next.map(|(time, event, how)| (time.max(self.now), event, how))
    }

    /// The interval in which an event happened or will happen, given all that is known; `None` while its
    /// activation has not been executed.
    pub fn happened(&self, event: EventId) -> Option<Interval> {
        self.knowledge.happened(self.network(), event)
    }

    /// When news of a contingent event comes at the latest, by the model; `None` if it may never, or what it follows has not
    /// begun.
    pub fn observed_by(&self, event: EventId) -> Option<Time> {
        self.knowledge.observed_by(&self.network, event)
    }

    /// The same for all events.
    pub fn all_happened(&self) -> Vec<Option<Interval>> {
        self.knowledge.all_happened(self.network())
    }

    /// The same for all events at the end of an execution, when silence also says something: an event that was never
    /// heard of cannot have happened so long ago that its news would have come by `end`.
    pub fn happened_by(&self, end: Time) -> Vec<Option<Interval>> {
        let network = self.network();
        // Silence about one event says something of the others in its chain, too.
        let mut knowledge = self.knowledge.clone();
        for link in network.contingents().iter().filter(|link| self.known(link.to).observed.is_none()) {
            if let Some(max) = link.delay.max.finite() {
                let earliest = end.saturating_sub(max);
                // If it was to be heard long ago its news is lost, and silence says nothing.
                if self.happened(link.to).is_some_and(|within| within.latest >= earliest) {
                    knowledge.add_evidence(link.to, Interval::new(earliest, Time::MAX));
                }
            }
        }
        let (silent, all) = (knowledge.all_happened(network), self.all_happened());
        let possible = |interval: &Option<Interval>| interval.is_some_and(|interval| !interval.is_empty());
        silent
            .into_iter()
            .zip(all)
            .map(|(silent, known)| if possible(&silent) { silent } else { known })
            .collect()
    }

    /// The origin of the plan is executed; what is measured from it has begun.
    fn activate_from_origin(&mut self) {
        self.placed_at =
            Rows::new(self.reduction.stnu.nodes, self.reduction.places.iter().map(|place| place.node));
        self.unplaced.clear();
        self.note_unplaced(0, Time::ZERO);
        for (index, link) in self.reduction.stnu.links.iter().enumerate() {
            if link.activation == 0 {
                self.active.push((window(link, Time::ZERO), index as u32));
            }
        }
    }

    /// The next link to end without further news: (time, contingent node, how).
    fn next_link(&self) -> Option<(Time, u32, How)> {
        let ends = self.active.iter().map(|&(Interval { earliest, latest }, link)| {
            let node = self.reduction.stnu.links[link as usize].contingent;
            let root = self.reduction.event_of[node as usize];
            let heard = self.reduction.places[root.index()]
                .heard_by
                .is_some_and(|event| self.known(event).observed.is_some());
            if heard { (earliest.min(latest), node, How::Buffered) } else { (latest, node, How::Imagined) }
        });
        ends.min_by_key(|&(time, node, _)| (time, node))
    }

    /// The event whose news a contingent node of the plan stands for.
    fn acted_on(&self, node: u32) -> EventId {
        let root = self.reduction.event_of[node as usize];
        self.reduction.places[root.index()].heard_by.unwrap_or(root)
    }

    /// A contingent node happens: the plan goes on as if its news had come now.
    fn happen(&mut self, node: u32, time: Time, how: How) {
        let event = self.acted_on(node);
        self.active.retain(|&(_, link)| self.reduction.stnu.links[link as usize].contingent != node);
        let place = self.reduction.places[event.index()];
        if how == How::Imagined {
            // Had it happened earlier, its news would have come. That it did not happen later is the model's, which may yet be broken.
            let Interval { earliest, .. } = whereabouts(&place, time);
            self.knowledge.add_evidence(event, Interval::new(earliest, Time::MAX));
        }
        self.fix(event, time, how, self.cause_of_acting(node, event, time, how));
        self.start(node, time);
    }

    /// What happens to everything measured from a node once that is executed.
    fn start(&mut self, node: u32, time: Time) {
        for link in self.agenda.execute(node, time) {
            self.active.push((window(&self.reduction.stnu.links[link as usize], time), link));
        }
        self.note_unplaced(node, time);
    }

    fn note_unplaced(&mut self, node: u32, time: Time) {
        for &event in self.placed_at.of(node) {
            let over = whereabouts(&self.reduction.places[event as usize], time).latest;
            if over > time {
                self.unplaced.push((over, EventId(event)));
            }
        }
    }

    fn fix(&mut self, event: EventId, time: Time, how: How, cause: Cause) {
        // At the moment of its own news nothing is held back.
        let heard_then = self.known(event).observed == Some(time);
        let (how, cause) =
            if how == How::Buffered && heard_then { (How::Observed, Cause::Observed) } else { (how, cause) };
        if self.knowledge.fix(event, time, how) {
            self.version += 1;
            self.causes.0[event.index()] = Some(cause);
            self.fixed.push_back(event);
        }
    }

    /// When the last contingent event that nothing waits for has surely happened.
    fn last_unheard(&self) -> Option<Time> {
        let unheard = |event: &EventId| self.known(*event).observed.is_none();
        self.unplaced.iter().filter(|(_, event)| unheard(event)).map(|&(over, _)| over).max()
    }
}

/// The agenda of a plan, with the lead of its events.
fn agenda(reduction: &Reduction, net: &Dispatchable, lead: impl Fn(EventId) -> Duration) -> Agenda {
    Agenda::new(net, |node| lead(reduction.event_of[node as usize]))
}

/// When the contingent node of a link may happen whose activation is executed at a time.
fn window(link: &Link, activated: Time) -> Interval {
    let [lower, upper] = [link.lower, link.upper].map(Duration::from_micros);
    Interval::at(activated).later(lower, upper)
}

/// When an event happens whose node of the plan is executed at a time.
fn whereabouts(place: &Whereabouts, executed: Time) -> Interval {
    Interval::at(executed).later(place.earliest, place.latest)
}
