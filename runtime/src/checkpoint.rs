//! What an executive knows when it goes on with a new plan: all there is to it but the plan, which follows from that.
//!
//! Planning is what takes its time when a mission is repeated, and of all plans only the last is needed to go on. So with
//! each plan that is followed the journal says what has become known since the one before; all of that together leads to
//! the executive as it was, with a single plan to make.

use std::collections::BTreeMap;

use kirk_network::Time;
use serde::{Deserialize, Serialize};

use crate::activity::Handover;
use crate::execution::How;
use crate::knowledge::Known;
use crate::order::{Order, State};

/// What has become known since the last checkpoint; several of them, one followed by the other, are
/// all that is known. Events go by name, times are microseconds after the origin.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// How often anything has happened to the dispatcher, and to the executive besides.
    pub(crate) versions: (u64, u64),
    /// What is known of events.
    pub(crate) events: BTreeMap<String, KnownEvent>,
    /// What is or was in the hands of the driver, by number.
    pub(crate) orders: BTreeMap<u32, KnownOrder>,
    /// News that waits for what is in flight.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) held: Vec<(i64, String)>,
    /// Events whose news is still to come, and when it is to at the latest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) awaited: Vec<(i64, String)>,
    /// News the model rules out that nobody was told of, as it was not known whether the mission can go on: when it arrived,
    /// of which event, and what to say.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) broken: Vec<(i64, String, String)>,
}

/// What is known of an event.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct KnownEvent {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fixed: Option<(i64, How, u32)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    observed: Option<i64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    evidence: Option<(i64, i64)>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    settled: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    overruled: bool,
}

/// What is known of an order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct KnownOrder {
    /// The event, under the name under which it is handed over.
    pub(crate) name: String,
    due: i64,
    closes: i64,
    first_sent: i64,
    started: i64,
    attempts: u32,
    state: KnownState,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    reason: String,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    doubtful: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum KnownState {
    Sent,
    Waiting(i64),
    Done,
}

impl Checkpoint {
    /// All that is known once this and then that has become known.
    pub(crate) fn followed_by(&mut self, later: &Checkpoint) {
        let Checkpoint { mut events, mut orders, .. } = std::mem::replace(self, later.clone());
        events.append(&mut self.events);
        orders.append(&mut self.orders);
        (self.events, self.orders) = (events, orders);
    }
}

impl From<&Known> for KnownEvent {
    fn from(known: &Known) -> KnownEvent {
        let Known { fixed, sequence, observed, settled, evidence, overruled } = *known;
        KnownEvent {
            fixed: fixed.map(|(time, how)| (time.as_micros(), how, sequence)),
            observed: observed.map(Time::as_micros),
            evidence,
            settled,
            overruled,
        }
    }
}

impl From<&KnownEvent> for Known {
    fn from(event: &KnownEvent) -> Known {
        let KnownEvent { fixed, observed, evidence, settled, overruled } = *event;
        Known {
            fixed: fixed.map(|(time, how, _)| (Time::from_micros(time), how)),
            sequence: fixed.map_or(0, |(.., sequence)| sequence),
            observed: observed.map(Time::from_micros),
            settled,
            evidence,
            overruled,
        }
    }
}

impl From<&Order> for KnownOrder {
    fn from(order: &Order) -> KnownOrder {
        KnownOrder {
            name: order.name.clone(),
            due: order.due.as_micros(),
            closes: order.closes.as_micros(),
            first_sent: order.first_sent.as_micros(),
            started: order.started.as_micros(),
            attempts: order.attempts,
            state: match order.state {
                State::Sent => KnownState::Sent,
                State::Waiting(again) => KnownState::Waiting(again.as_micros()),
                State::Done => KnownState::Done,
            },
            reason: order.reason.clone(),
            doubtful: order.doubtful,
        }
    }
}

impl KnownOrder {
    /// The order again: who begins the ids, and what is handed over.
    pub(crate) fn order(&self, run: &str, handover: &Handover) -> Order {
        let Handover { event, name, companion } = handover.clone();
        Order {
            id: format!("{run}/{name}"),
            event,
            name,
            companion,
            due: Time::from_micros(self.due),
            closes: Time::from_micros(self.closes),
            first_sent: Time::from_micros(self.first_sent),
            started: Time::from_micros(self.started),
            attempts: self.attempts,
            state: match self.state {
                KnownState::Sent => State::Sent,
                KnownState::Waiting(again) => State::Waiting(Time::from_micros(again)),
                KnownState::Done => State::Done,
            },
            reason: self.reason.clone(),
            doubtful: self.doubtful,
            kept: self.state == KnownState::Done,
        }
    }
}
