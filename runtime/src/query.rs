//! What if: an execution in the middle of it, and what can still become of it.
//!
//! A [`Situation`] is what is known at a time: of a mission of which nothing was heard, of what a record says, or a journal. Time may
//! pass in it, news may be heard, and nothing of that happens in the execution it was made from. The time of events still to come is
//! that of [`kirk_network::left`].

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use kirk_network::left::{Left, Seen, SoFar, left, promise_left};
use kirk_network::promise::Promise;
use kirk_network::{Bound, Duration, EventId, Interval, Network, Time};

use crate::aftermath::aftermath;
use crate::cause::Cause;
use crate::dispatcher::{Dispatcher, Reception, Settings, Strategy, Taken};
use crate::execution::{Aftermath, Execution, Failure, How, Outcome, Row};
use crate::input::Input;
use crate::journal::{BadJournal, Journal};
use crate::knowledge::{Fixed, Knowledge, heard_now};
use crate::plan::Plan;
use crate::record::missed_window;
use crate::replay::{Replay, recover};

/// An execution at a time.
#[derive(Clone, Debug)]
pub struct Situation {
    dispatcher: Dispatcher,
    now: Time,
    /// What is with the driver, and since when it may count as executed.
    begun: Vec<(EventId, Time)>,
    /// Why nothing goes on.
    ended: Option<Ended>,
}

/// Why nothing goes on.
#[derive(Clone, Debug)]
pub enum Ended {
    /// The mission was completed.
    Completed,
    /// It failed.
    Failed(Failure),
    /// From here on nothing is sure: there is no plan for the rest.
    NoPlan,
}

/// What becomes of news.
#[derive(Clone, Debug)]
pub enum Heard {
    /// The model allows it.
    Possible,
    /// The model rules it out: what is wrong with it and whether the mission goes on, in a sentence; and what becomes of the
    /// requirements.
    Broken(String, Aftermath),
}

/// Why news cannot be heard at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unheard {
    /// It is later already.
    Past,
    /// What it begins with has not been executed by then.
    NotBegun {
        /// What that is.
        start: EventId,
    },
    /// It was heard then.
    Before(Time),
    /// The event is ours.
    NotNatures,
    /// Nothing goes on by then.
    Over,
}

/// What an event waits for, if nothing more is heard.
#[derive(Clone, Debug)]
pub struct Waits {
    /// The event, what decides its time, what decides the time of that, and so on to what has happened.
    pub events: Vec<EventId>,
    /// The execution ahead, which knows the times and why they are these ([`Dispatcher::why`]).
    pub ahead: Dispatcher,
}

impl Situation {
    /// A mission at its start.
    pub fn of_mission(plan: &Plan) -> Situation {
        let dispatcher = Dispatcher::new(plan.clone(), Settings::of(Strategy::Optimistic));
        let mut situation = Situation { dispatcher, now: Time::ZERO, begun: Vec::new(), ended: None };
        situation.go_on(Time::ZERO);
        situation
    }

    /// What a journal leads to, up to a time if one is given, else up to its last record.
    ///
    /// # Errors
    /// A record that does not follow from those before it.
    pub fn of_journal(journal: &Journal, until: Option<Time>) -> Result<Situation, BadJournal> {
        let mut journal = journal.clone();
        if let Some(until) = until {
            let later = journal.lines.iter().position(|line| line.at > until);
            journal.lines.truncate(later.unwrap_or(journal.lines.len()));
        }
        let Replay { mut executive, at, .. } = recover(&journal)?;
        // What is still being planned is planned now: without, nobody knows whether the rest can be kept.
        while let Some(rebuild) = executive.poll_rebuild(at) {
            executive.handle(at, Input::rebuilt(rebuild.run()));
        }
        let ended = match executive.failure() {
            Some(failure) => Some(Ended::Failed(failure.clone())),
            None => executive.is_over().then_some(Ended::Completed),
        };
        let (dispatcher, begun) = (executive.dispatcher().clone(), executive.begun());
        let mut situation = Situation { dispatcher, now: at, begun, ended };
        situation.hear_held(executive.held());
        if let Some(until) = until {
            situation.pass(until);
        }
        Ok(situation)
    }

    /// What a record says of the execution of a plan, up to a time if one is given, else up to its end.
    ///
    /// # Errors
    /// A sentence: it is of another mission.
    pub fn of_record(plan: &Plan, execution: &Execution, until: Option<Time>) -> Result<Situation, String> {
        let network = &plan.network;
        let now = until.map_or(execution.makespan, |until| until.min(execution.makespan));
        let knowledge = recorded(network, execution, now)?;
        let settings = Settings::of(Strategy::Optimistic);
        let restored = Dispatcher::restored(network, settings.clone(), knowledge.clone(), 0, now);
        let mut ended = restored.is_none().then_some(Ended::NoPlan);
        match (execution.outcome, &execution.failure) {
            (Outcome::Failed, Some(failure)) if until.is_none_or(|until| until >= failure.time) => {
                ended = Some(Ended::Failed(failure.clone()));
            }
            (Outcome::Completed, _) if until.is_none_or(|until| until >= execution.makespan) => {
                ended = Some(Ended::Completed);
            }
            _ => {}
        }
        let dispatcher = restored.unwrap_or_else(|| Dispatcher::knowing(plan.clone(), settings, knowledge));
        let mut situation = Situation { dispatcher, now, begun: Vec::new(), ended };
        if let Some(until) = until {
            situation.pass(until);
        }
        Ok(situation)
    }

    /// The network that is executed.
    pub fn network(&self) -> &Network {
        self.dispatcher.network()
    }

    /// The time.
    pub fn now(&self) -> Time {
        self.now
    }

    /// Why nothing goes on, if nothing does.
    pub fn ended(&self) -> Option<&Ended> {
        self.ended.as_ref()
    }

    /// When one of our events was executed, or Nature's was acted on.
    pub fn fixed(&self, event: EventId) -> Option<(Time, How)> {
        self.dispatcher.known(event).fixed.map(|fixed| (fixed.time, fixed.how))
    }

    /// When an event of Nature's was heard of.
    pub fn heard_of(&self, event: EventId) -> Option<Time> {
        self.dispatcher.known(event).observed
    }

    /// Since when an event is with the driver.
    pub fn with_driver(&self, event: EventId) -> Option<Time> {
        self.begun.iter().find(|begun| begun.0 == event).map(|begun| begun.1)
    }

    /// The place of an event among those of one time.
    pub fn order(&self, event: EventId) -> u32 {
        self.dispatcher.order(event)
    }

    /// When each event can still happen, as long as all can be kept.
    pub fn left(&self) -> Vec<Left> {
        let so_far = self.so_far();
        let mut left = left(self.network(), &so_far);
        let all_exact = left.iter().all(|left| left.earliest_is_exact);
        if self.ended.is_none() && !all_exact && self.network().contingents().len() <= MOST_TO_TRY {
            // What is done in one course of Nature can be done.
            for (left, truth) in left.iter_mut().zip(early(self.dispatcher.clone(), &so_far)) {
                left.earliest_is_exact |= truth == Some(left.window.earliest);
            }
        }
        left
    }

    /// True if whatever Nature does, as the model says, all that is not decided yet can be kept: there is a plan, or nothing to plan.
    pub fn can_be_kept(&self) -> bool {
        matches!(self.ended, None | Some(Ended::Completed))
    }

    /// What can be promised of the time of an event of ours that is to come.
    pub fn promise(&self, event: EventId) -> Option<Promise> {
        // Too large to be computed with is no promise.
        promise_left(self.network(), &self.so_far(), event).ok().flatten()
    }

    /// When news of an event of Nature's can come that has begun and was not heard of: from when on, and if there is such a time until
    /// when.
    pub fn news(&self, left: &Left, event: EventId) -> Option<(Time, Option<Time>)> {
        let link = self.network().contingents()[self.network().link_of(event)?];
        let earliest = left.window.earliest.saturating_add(link.delay.min).max(self.now);
        let latest = match (left.window.latest, link.delay.max) {
            (Some(latest), Bound::Finite(max)) => Some(latest.saturating_add(max)),
            _ => None,
        };
        Some((earliest, latest))
    }

    /// Time passes up to then, and nothing is heard. What is with a driver is confirmed at once.
    pub fn pass(&mut self, until: Time) {
        if until > self.now {
            self.go_on(until);
        }
    }

    /// Does what is due by then.
    fn go_on(&mut self, until: Time) {
        if self.ended.is_none() {
            pass(&mut self.dispatcher, self.now, Some(until));
            self.begun.clear();
            let missed = self.dispatcher.missed();
            self.ended = missed.map(|missed| Ended::Failed(missed_window(self.network(), missed)));
        }
        self.now = until;
    }

    /// Nothing is heard up to then, and then news of an event.
    ///
    /// # Errors
    /// It cannot be heard then, whatever the model says.
    pub fn hear(&mut self, event: EventId, at: Time) -> Result<Heard, Unheard> {
        if at < self.now {
            return Err(Unheard::Past);
        }
        if self.network().link_of(event).is_none() {
            return Err(Unheard::NotNatures);
        }
        if let Some(before) = self.heard_of(event) {
            return Err(Unheard::Before(before));
        }
        // At one time Nature comes first.
        if at > self.now {
            self.pass(at.saturating_sub(Duration::SHORTEST));
        }
        if self.ended.is_some() {
            return Err(Unheard::Over);
        }
        confirm(&mut self.dispatcher, self.now);
        self.begun.clear();
        self.now = at;
        self.take(event, at)
    }

    /// Takes the news that an executive holds until the driver has confirmed what was in flight when it came: that it came says
    /// that this was executed, when it was due.
    fn hear_held(&mut self, held: &[(Time, EventId)]) {
        if held.is_empty() || self.ended.is_some() {
            return;
        }
        for (event, since) in std::mem::take(&mut self.begun) {
            self.dispatcher.handle_executed(self.now, event, since);
        }
        for &(arrived, event) in held {
            if self.ended.is_none() {
                // What it is of the model is told by what can be kept.
                let _ = self.take(event, arrived);
            }
        }
    }

    /// News of an event that arrived by now, with nothing in flight.
    fn take(&mut self, event: EventId, at: Time) -> Result<Heard, Unheard> {
        match self.dispatcher.hear_and_plan(at, event) {
            Taken::NotBegun => Err(Unheard::NotBegun { start: self.dispatcher.root(event) }),
            Taken::Broken { said, goes_on } => {
                let aftermath = aftermath(&self.dispatcher, &self.so_far(), &[]);
                if goes_on {
                    self.go_on(at);
                } else {
                    self.ended = Some(Ended::NoPlan);
                }
                Ok(Heard::Broken(said, aftermath))
            }
            Taken::Possible => {
                self.go_on(at);
                Ok(Heard::Possible)
            }
        }
    }

    /// What an event waits for if nothing more is heard.
    pub fn waits(&self, event: EventId) -> Waits {
        let mut ahead = self.dispatcher.clone();
        if self.ended.is_none() {
            pass(&mut ahead, self.now, None);
        }
        let mut events = vec![event];
        let mut at = event;
        while self.fixed(at).is_none()
            && let Some(next) = waits_for(&ahead, at).filter(|next| !events.contains(next))
        {
            events.push(next);
            at = next;
        }
        Waits { events, ahead }
    }

    fn so_far(&self) -> SoFar {
        self.dispatcher.so_far(self.now, &self.begun)
    }
}

/// With more links than that, planning anew with each news would take long.
const MOST_TO_TRY: usize = 300;

/// When all happens from here on if Nature takes the least, and news comes as early as it can.
fn early(mut dispatcher: Dispatcher, so_far: &SoFar) -> Vec<Option<Time>> {
    let network = dispatcher.network().clone();
    let least = |event: EventId| Some(network.contingents()[network.link_of(event)?].delay.min);
    let mut truth: Vec<Option<Time>> = vec![None; network.events().len()];
    let mut news: BinaryHeap<Reverse<(Time, EventId)>> = BinaryHeap::new();
    for event in network.event_ids() {
        if let (Seen::Nature { happened, heard: false, .. }, Some(delay)) =
            (so_far.events[event.index()], least(event))
        {
            truth[event.index()] = Some(happened.earliest);
            news.push(Reverse((happened.earliest.saturating_add(delay).max(so_far.now), event)));
        }
    }
    let mut now = so_far.now;
    loop {
        while let Some(&Reverse((time, event))) = news.peek().filter(|Reverse((time, _))| *time <= now) {
            news.pop();
            if let Reception::Impossible { .. } = dispatcher.handle_observation(time, event) {
                // The least of each does not go together here: it shows nothing.
                return vec![None; truth.len()];
            }
            dispatcher.plan_at_once(time);
        }
        dispatcher.handle_timeout(now);
        for begun in confirm(&mut dispatcher, now) {
            let Some(Fixed { time, how: How::Dispatched, .. }) = dispatcher.known(begun).fixed else {
                continue;
            };
            truth[begun.index()] = Some(time);
            let mut open = vec![begun];
            while let Some(from) = open.pop() {
                for link in network.contingents().iter().filter(|link| link.from == from) {
                    let happens = truth[from.index()].map(|start| start.saturating_add(link.lower));
                    truth[link.to.index()] = happens;
                    news.extend(happens.map(|time| Reverse((time.saturating_add(link.delay.min), link.to))));
                    open.push(link.to);
                }
            }
        }
        let next = news.peek().map(|&Reverse((time, _))| time);
        now = match (next, dispatcher.poll_timeout()) {
            (Some(next), Some(timeout)) => next.min(timeout),
            (Some(next), None) => next,
            (None, Some(timeout)) => timeout,
            (None, None) => return truth,
        }
        .max(now);
    }
}

/// What decides the time of an event.
fn waits_for(ahead: &Dispatcher, event: EventId) -> Option<EventId> {
    let network = ahead.network();
    if let Some(link) = network.link_of(event) {
        // Whatever news it is known by, Nature begins with it there.
        return Some(network.contingents()[link].from);
    }
    match ahead.why(event)? {
        Cause::After { event, .. }
        | Cause::Surely { event, .. }
        | Cause::Order { event }
        | Cause::Unobserved { event, .. } => Some(event),
        Cause::Held { since, .. } => Some(since),
        Cause::Anew { news } => news,
        Cause::Start | Cause::Observed | Cause::Late { .. } | Cause::Closed { .. } => None,
    }
}

/// Nothing is heard up to a time, or to the end; what is to be confirmed is, at once.
fn pass(dispatcher: &mut Dispatcher, now: Time, until: Option<Time>) {
    let mut now = now;
    confirm(dispatcher, now);
    loop {
        dispatcher.handle_timeout(now);
        confirm(dispatcher, now);
        dispatcher.plan_at_once(now);
        match dispatcher.poll_timeout() {
            Some(next) if until.is_none_or(|until| next <= until) => now = next,
            _ => break,
        }
    }
    if let Some(until) = until {
        dispatcher.handle_timeout(until.max(now));
        confirm(dispatcher, until.max(now));
    }
}

/// What is to be confirmed is confirmed now. Returns what was fixed meanwhile.
fn confirm(dispatcher: &mut Dispatcher, now: Time) -> Vec<EventId> {
    while dispatcher.poll_dispatch().is_some() {}
    let in_flight: Vec<EventId> =
        dispatcher.network().event_ids().filter(|&event| dispatcher.is_unconfirmed(event)).collect();
    for event in in_flight {
        dispatcher.handle_executed(now, event, now);
    }
    std::iter::from_fn(|| dispatcher.poll_fixed()).collect()
}

/// What is known at a time, by a record.
fn recorded(network: &Arc<Network>, execution: &Execution, now: Time) -> Result<Knowledge, String> {
    let mut knowledge = Knowledge::new(network);
    let mut rows: Vec<(EventId, &Row)> = Vec::new();
    for row in &execution.rows {
        let event =
            network.find(&row.event).ok_or(format!("there is no event `{}` in the mission", row.event))?;
        rows.push((event, row));
    }
    for &(event, row) in &rows {
        let due = row.time.filter(|time| *time <= now);
        // What was held or imagined by then is not heard yet in the plan that is made now.
        if let Some(time) = due {
            knowledge.fix(event, time, row.how);
        }
    }
    fix_unrecorded(network, &mut knowledge, now);
    let heard = rows.iter().filter_map(|(event, row)| Some((row.observed.flatten()?, *event)));
    let mut heard: Vec<(Time, EventId)> = heard.filter(|(time, _)| *time <= now).collect();
    heard.sort_unstable();
    heard.dedup();
    for (time, event) in heard {
        let link = network.link_of(event).map(|link| network.contingents()[link]);
        let link = link.ok_or(format!("`{}` is not Nature's to decide", network.label(event)))?;
        if knowledge.happened(network, event).is_none() {
            let (event, from) = (network.label(event), network.label(link.from));
            return Err(format!("`{event}` is heard at {time} s, and `{from}` is not recorded before that"));
        }
        if knowledge.rules_out(network, event, time) {
            knowledge.hear_against(network, event, time);
        } else {
            knowledge.hear(event, time);
            knowledge.add_evidence(event, heard_now(&link, time));
        }
    }
    for &(event, row) in &rows {
        let acted = row.time.filter(|time| *time <= now && row.how == How::Imagined);
        if let (Some(time), Some(link), None) = (acted, network.link_of(event), knowledge.of(event).observed)
        {
            // Had it happened earlier, its news would have come.
            let max = network.contingents()[link].delay.max.finite();
            let earliest = max.map_or(Time::MIN, |max| time.saturating_sub(max));
            knowledge.add_evidence(event, Interval::new(earliest, Time::MAX));
        }
    }
    Ok(knowledge)
}

/// Records leave out what nobody wrote. Such an event of ours happens when it can: when all that is to come before it has.
fn fix_unrecorded(network: &Network, knowledge: &mut Knowledge, now: Time) {
    // What each event comes after, and by how much: `to - from <= weight`, and that is negative, or zero for what follows at once.
    let mut after: Vec<Vec<(EventId, Duration)>> = vec![Vec::new(); network.events().len()];
    for (from, to, weight) in network.requirements().iter().flat_map(|it| it.edges()).flatten() {
        if weight <= Duration::ZERO && from != to {
            after[from.index()].push((to, weight));
        }
    }
    let unwritten = |event: &EventId| {
        network.written(*event).next().is_none()
            && network.link_of(*event).is_none()
            && knowledge.of(*event).fixed.is_none()
    };
    let mut open: Vec<EventId> = network.event_ids().filter(unwritten).collect();
    loop {
        // Nature's events may follow from what was fixed in the round before.
        let mut happened = knowledge.all_happened(network);
        let before = open.len();
        open.retain(|&event| {
            let comes_after = after[event.index()]
                .iter()
                .map(|&(to, weight)| Some(happened[to.index()]?.latest.saturating_sub(weight)));
            let Some(time) = comes_after
                .chain([Some(Time::ZERO)])
                .try_fold(Time::ZERO, |last, time| Some(last.max(time?)))
            else {
                return true;
            };
            if time <= now {
                knowledge.fix(event, time, How::Dispatched);
                happened[event.index()] = Some(Interval::at(time));
            }
            time > now
        });
        if open.len() == before {
            return;
        }
    }
}
