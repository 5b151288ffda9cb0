//! An order: one event in the hands of the driver, from the first attempt to the confirmation.

use std::collections::{BTreeMap, HashSet};

use kirk_network::{Duration, EventId, Time};
use serde::{Deserialize, Serialize};

use crate::activity::Handover;
use crate::checkpoint::micros;

/// All that is or was in the hands of the driver. What is looked at again and again is only what is open: a long mission
/// has handed over many times more.
#[derive(Clone, Debug, Default)]
pub(crate) struct Orders {
    /// Of events that are not carried out yet under all of their names, in the order in which they were handed over.
    pub(crate) open: Vec<Order>,
    /// Of events that are, until a checkpoint has them.
    done: Vec<Order>,
    /// How many there have been.
    count: u32,
}

/// An event that is handed over under one of its names.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    /// Its place among all of them.
    number: u32,
    pub(crate) id: String,
    pub(crate) event: EventId,
    pub(crate) companion: Option<String>,
    pub(crate) course: Course,
    /// A checkpoint has it as done: nothing will change any more.
    kept: bool,
}

/// How it went with an order so far. The names and the order of its fields are what checkpoints are written with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Course {
    /// The event, under the name under which it is handed over.
    pub(crate) name: String,
    #[serde(with = "micros")]
    pub(crate) due: Time,
    /// When it is too late, if the event is fixed already (Nature's, and the origin).
    #[serde(with = "micros")]
    pub(crate) closes: Time,
    #[serde(with = "micros")]
    pub(crate) first_sent: Time,
    /// When the attempt that counts began.
    #[serde(with = "micros")]
    pub(crate) started: Time,
    pub(crate) attempts: u32,
    pub(crate) state: State,
    /// Why the last attempt failed.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(crate) reason: String,
    /// An attempt may have succeeded without our hearing of it: then the first one counts.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) doubtful: bool,
}

/// Where an order is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum State {
    /// With the driver.
    Sent,
    /// To be tried again then.
    Waiting(#[serde(with = "micros")] Time),
    /// Confirmed.
    Done,
}

/// How long to wait before something is tried again: twice as long each time, up to a limit; and when it has failed for long,
/// a hundredth of that time. Whoever has waited for a day can wait for a quarter of an hour more, and what is recorded of a
/// driver that fails for days stays small: the number of attempts grows with the logarithm of the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// After the first attempt.
    pub first: Duration,
    /// At most.
    pub most: Duration,
}

impl Patience {
    /// How long to wait after so many attempts, of which the first was so long ago.
    pub fn wait(self, attempts: u32, failing: Duration) -> Duration {
        let doubled = self.first.saturating_mul(1 << attempts.saturating_sub(1).min(30));
        doubled.min(self.most.max(Duration::from_micros(failing.as_micros() / 100)))
    }
}

impl State {
    pub(crate) fn wakes(self) -> Option<Time> {
        if let State::Waiting(again) = self { Some(again) } else { None }
    }
}

impl Orders {
    /// What a checkpoint knew of each: who begins the ids, and what is handed over under each name.
    ///
    /// # Errors
    /// A sentence: nothing is handed over under such a name.
    pub(crate) fn recall(
        courses: &BTreeMap<u32, Course>,
        run: &str,
        handover: impl Fn(&str) -> Option<Handover>,
    ) -> Result<Orders, String> {
        let mut orders = Orders::default();
        for course in courses.values() {
            let name = &course.name;
            let handover = handover(name).ok_or(format!("`{name}` is not handed over"))?;
            let order = orders.add(run, handover, course.clone());
            order.kept = order.is_done();
        }
        let open = |order: &&Order| !order.is_done();
        let open: HashSet<EventId> = orders.open.iter().filter(open).map(|order| order.event).collect();
        orders.open.retain(|order| open.contains(&order.event));
        Ok(orders)
    }

    /// One more is handed over.
    pub(crate) fn add(&mut self, run: &str, handover: Handover, course: Course) -> &mut Order {
        let Handover { event, name, companion } = handover;
        let (id, number) = (format!("{run}/{name}"), self.count);
        self.count += 1;
        self.open.push(Order { number, id, event, companion, course, kept: false });
        let last = self.open.len() - 1;
        &mut self.open[last]
    }

    /// If an event is carried out under all of its names, when it was under the last: then it is open no more.
    pub(crate) fn close(&mut self, event: EventId) -> Option<Time> {
        let of_event = || self.open.iter().filter(|order| order.event == event);
        if !of_event().all(Order::is_done) {
            return None;
        }
        let started = of_event().map(|order| order.course.started).max();
        self.done.extend(self.open.extract_if(.., |order| order.event == event));
        started
    }

    /// What has changed since the last checkpoint, by number.
    pub(crate) fn checkpoint(&mut self) -> BTreeMap<u32, Course> {
        let all = || self.done.iter().chain(&self.open);
        let changed = all().filter(|order| !order.kept).map(|order| (order.number, order.course.clone()));
        let changed = changed.collect();
        self.done.clear();
        for order in &mut self.open {
            order.kept = order.is_done();
        }
        changed
    }
}

impl Order {
    pub(crate) fn is_done(&self) -> bool {
        self.course.state == State::Done
    }

    pub(crate) fn is_sent(&self) -> bool {
        self.course.state == State::Sent
    }

    pub(crate) fn failed(&mut self, now: Time, reason: &str, patience: Patience) {
        let course = &mut self.course;
        let wait = patience.wait(course.attempts, now.saturating_since(course.first_sent));
        course.reason = reason.to_string();
        course.state = State::Waiting(now.saturating_add(wait));
    }
}
