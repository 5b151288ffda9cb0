//! The dispatcher: a state machine that decides, from what is known when it is known, what to execute when.
//!
//! It holds no clock. Call [`Dispatcher::handle_observation`] when news arrives and [`Dispatcher::handle_timeout`] when
//! the time of [`Dispatcher::poll_timeout`] has come (earlier or again is harmless), each with the present time, which
//! never goes back; then take what is to be done from [`Dispatcher::poll_dispatch`].
//!
//! News is mapped as in sections 5.2.2 and appendix C of the thesis. News within the window of the plan is taken at
//! once. Early news is *buffered* to the start of the window, missing news is *imagined* at its end. With
//! [`Strategy::Optimistic`], news that says more than the plan assumed replaces the event by the interval in which it
//! must have happened, and what is left is planned anew. The buffering execution satisfies the new plan too, so there
//! always is one; it only adds freedom.

use std::collections::VecDeque;

use kirk_network::reduce::{Progress, Reduction};
use kirk_network::stnu::{Link, Rows};
use kirk_network::{Duration, EventId, Network, Time};

use crate::agenda::Agenda;
use crate::execution::How;
use crate::knowledge::{Knowledge, Known, heard_now};
use crate::plan::Plan;

/// What to do with news that says more than the plan assumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Strategy {
    /// Hold it until the plan expects it.
    Buffer,
    /// Plan anew with it.
    #[default]
    Optimistic,
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
    /// The latest time at which it could be.
    pub latest: Time,
}

/// The state of an execution.
#[derive(Clone, Debug)]
pub struct Dispatcher {
    plan: Plan,
    strategy: Strategy,
    reduction: Reduction,
    agenda: Agenda,
    /// The links that have started and whose contingent node has not happened: (window start, window end, link).
    active: Vec<(i64, i64, u32)>,
    knowledge: Knowledge,
    /// Events without a node of their own that may not have happened yet: (when they surely have, event).
    unplaced: Vec<(i64, EventId)>,
    /// For every node of the plan the events placed there.
    placed_at: Rows,
    now: i64,
    dispatches: VecDeque<Dispatch>,
    missed: Option<Missed>,
}

impl Dispatcher {
    /// Starts an execution: the origin is dispatched at time 0.
    pub fn new(plan: Plan, strategy: Strategy) -> Dispatcher {
        let mut dispatcher = Dispatcher {
            strategy,
            reduction: plan.reduction.clone(),
            agenda: Agenda::new(&plan.net),
            active: Vec::new(),
            knowledge: Knowledge::new(plan.network()),
            unplaced: Vec::new(),
            placed_at: Rows::new(0, std::iter::empty()),
            now: 0,
            dispatches: VecDeque::new(),
            missed: None,
            plan,
        };
        dispatcher.dispatched(dispatcher.plan.network().origin(), 0);
        dispatcher.activate_from_origin();
        dispatcher
    }

    /// The network that is executed.
    pub fn network(&self) -> &Network {
        self.plan.network()
    }

    /// What is known of an event.
    pub fn known(&self, event: EventId) -> &Known {
        self.knowledge.of(event)
    }

    /// The event that could not be executed in its window, if that has happened. Then nothing more is dispatched.
    pub fn missed(&self) -> Option<Missed> {
        self.missed
    }

    /// Takes news of an event that arrives now.
    pub fn handle_observation(&mut self, now: Time, event: EventId) -> Reception {
        self.now = self.now.max(now.as_micros());
        let now = self.now;
        let Some(link) = self.network().link_of(event) else { return Reception::NotContingent };
        if self.known(event).observed.is_some() {
            return Reception::Repeated;
        }
        let link = self.network().contingents()[link];
        let evidence = heard_now(&link, now);
        let before = self.happened(event);
        let possible =
            before.is_some_and(|(low, high)| low.max(evidence.0) <= high.min(evidence.1) && low <= now);
        if !possible {
            let after =
                |time: i64, delay: Duration| Time::from_micros(time.saturating_add(delay.as_micros()));
            return Reception::Impossible {
                earliest: before.map(|(low, _)| after(low, link.delay.min)),
                latest: before.zip(link.delay.max.finite()).map(|((_, high), max)| after(high, max)),
            };
        }
        self.knowledge.hear(event, now);
        self.knowledge.add_evidence(event, evidence);
        let place = self.reduction.places[event.index()];
        let window = self.active.iter().copied().find(|&(_, _, link)| {
            self.reduction.stnu.links[link as usize].contingent == place.node && place.heard_by == Some(event)
        });
        match window {
            Some((start, end, _)) if (start..=end).contains(&now) => {
                self.happen(place.node, now, How::Observed)
            }
            _ => {
                if self.strategy == Strategy::Optimistic && self.says_more(event, before) {
                    self.replan(event);
                }
                if place.heard_by != Some(event) {
                    self.knowledge.fix(event, now, How::Observed);
                }
            }
        }
        Reception::Accepted
    }

    /// Does everything that is due by now: releases buffered news, imagines missing news, dispatches events.
    pub fn handle_timeout(&mut self, now: Time) {
        self.now = self.now.max(now.as_micros());
        while self.missed.is_none() {
            let link = self.next_link();
            let event = self.agenda.next();
            match (link, event) {
                // At one time Nature comes first, so that we act on all there is to know.
                (Some((time, node, how)), event)
                    if time <= self.now && event.is_none_or(|(due, _)| time <= due) =>
                {
                    self.happen(node, time, how);
                }
                (_, Some((time, node))) if time <= self.now => self.execute(time, node),
                _ => break,
            }
        }
    }

    /// The next event to be dispatched; call until there is none.
    pub fn poll_dispatch(&mut self) -> Option<Dispatch> {
        self.dispatches.pop_front()
    }

    /// When there is something to do next if no news arrives; `None` when the execution is over.
    pub fn poll_timeout(&mut self) -> Option<Time> {
        if self.missed.is_some() {
            return None;
        }
        let link = self.next_link().map(|(time, ..)| time);
        let event = self.agenda.next().map(|(time, _)| time);
        let over = self.last_unheard().filter(|&time| time > self.now);
        link.into_iter().chain(event).chain(over).min().map(|time| Time::from_micros(time.max(self.now)))
    }

    /// The interval (microseconds) in which an event happened or will happen, given all that is known; `None` while its
    /// activation has not been executed.
    pub fn happened(&self, event: EventId) -> Option<(i64, i64)> {
        self.knowledge.happened(self.network(), event)
    }

    /// The same for all events at the end of an execution, when silence also says something: an event that was never
    /// heard of cannot have happened so long ago that its news would have come by `end`.
    pub fn happened_by(&self, end: Time) -> Vec<Option<(i64, i64)>> {
        let network = self.network();
        // Silence about one event says something of the others in its chain, too.
        let mut knowledge = self.knowledge.clone();
        for link in network.contingents().iter().filter(|link| self.known(link.to).observed.is_none()) {
            if let Some(max) = link.delay.max.finite() {
                let earliest = end.as_micros().saturating_sub(max.as_micros());
                knowledge.add_evidence(link.to, (earliest, i64::MAX));
            }
        }
        knowledge.all_happened(network)
    }

    /// True if the news of an event narrowed what was assumed of it or of its ancestors.
    fn says_more(&self, event: EventId, before: Option<(i64, i64)>) -> bool {
        let place = self.reduction.places[event.index()];
        let assumed = match self.agenda.executed(place.node) {
            Some(node) => Some((node.saturating_add(place.earliest), node.saturating_add(place.latest))),
            None => before,
        };
        // Not yet executed: the plan is still to wait for it.
        self.agenda.executed(place.node).is_none() || self.happened(event) != assumed
    }

    /// Puts what is known in place of the links and plans what is left anew.
    fn replan(&mut self, news: EventId) {
        let network = self.plan.network();
        self.knowledge.settle_ancestors(network);
        let happened = self.knowledge.all_happened(network);
        let known = network
            .event_ids()
            .map(|event| match (network.link_of(event), self.knowledge.of(event)) {
                (None, known) => known.fixed.map(|(time, _)| (time, time)),
                (Some(_), known) if known.settled => happened[event.index()]
                    .map(|(low, high)| (Time::from_micros(low), Time::from_micros(high))),
                _ => None,
            })
            .collect();
        let progress = Progress { now: Time::from_micros(self.now), known };
        // In a delayed chain the reduction may be too careful to see that there is a way. Then the old plan stands.
        let Some((reduction, net)) = self.plan.rest(&progress) else { return };
        self.reduction = reduction;
        self.agenda = Agenda::new(&net);
        self.active.clear();
        self.activate_from_origin();
        for event in self.plan.network().event_ids() {
            let known = *self.known(event);
            if known.settled && known.fixed.is_none() {
                let heard = event == news || known.observed.is_some();
                self.knowledge.fix(event, self.now, if heard { How::Observed } else { How::Imagined });
            }
        }
    }

    /// The origin of the plan is executed; what is measured from it has begun.
    fn activate_from_origin(&mut self) {
        self.placed_at =
            Rows::new(self.reduction.stnu.nodes, self.reduction.places.iter().map(|place| place.node));
        self.unplaced.clear();
        self.note_unplaced(0, 0);
        for (index, link) in self.reduction.stnu.links.iter().enumerate() {
            if link.activation == 0 {
                self.active.push((link.lower, link.upper, index as u32));
            }
        }
    }

    /// The next link to end without further news: (time, contingent node, how).
    fn next_link(&self) -> Option<(i64, u32, How)> {
        let ends = self.active.iter().map(|&(start, end, link)| {
            let node = self.reduction.stnu.links[link as usize].contingent;
            let root = self.reduction.event_of[node as usize];
            let heard = self.reduction.places[root.index()]
                .heard_by
                .is_some_and(|event| self.known(event).observed.is_some());
            if heard { (start.max(self.now), node, How::Buffered) } else { (end, node, How::Imagined) }
        });
        ends.min_by_key(|&(time, node, _)| (time, node))
    }

    /// A contingent node happens: the plan goes on as if its news had come now.
    fn happen(&mut self, node: u32, time: i64, how: How) {
        let root = self.reduction.event_of[node as usize];
        let event = self.reduction.places[root.index()].heard_by.unwrap_or(root);
        self.active.retain(|&(_, _, link)| self.reduction.stnu.links[link as usize].contingent != node);
        let place = self.reduction.places[event.index()];
        if how == How::Imagined {
            // Had it happened earlier, its news would have come.
            self.knowledge.add_evidence(
                event,
                (time.saturating_add(place.earliest), time.saturating_add(place.latest)),
            );
        }
        self.knowledge.fix(event, time, how);
        self.start(node, time);
    }

    fn execute(&mut self, time: i64, node: u32) {
        let event = self.reduction.event_of[node as usize];
        let latest = self.agenda.upper(node);
        if time > latest {
            let (time, latest) = (Time::from_micros(time), Time::from_micros(latest));
            self.missed = Some(Missed { event, time, latest });
            return;
        }
        self.dispatched(event, time);
        self.start(node, time);
    }

    /// What happens to everything measured from a node once that is executed.
    fn start(&mut self, node: u32, time: i64) {
        for link in self.agenda.execute(node, time) {
            let Link { lower, upper, .. } = self.reduction.stnu.links[link as usize];
            self.active.push((time.saturating_add(lower), time.saturating_add(upper), link));
        }
        self.note_unplaced(node, time);
    }

    fn note_unplaced(&mut self, node: u32, time: i64) {
        for &event in self.placed_at.of(node) {
            let over = time.saturating_add(self.reduction.places[event as usize].latest);
            if over > time {
                self.unplaced.push((over, EventId(event)));
            }
        }
    }

    fn dispatched(&mut self, event: EventId, time: i64) {
        self.knowledge.fix(event, time, How::Dispatched);
        self.dispatches.push_back(Dispatch { event, time: Time::from_micros(time) });
    }

    /// When the last contingent event that nothing waits for has surely happened.
    fn last_unheard(&self) -> Option<i64> {
        let unheard = |event: &EventId| self.known(*event).observed.is_none();
        self.unplaced.iter().filter(|(_, event)| unheard(event)).map(|&(over, _)| over).max()
    }
}
