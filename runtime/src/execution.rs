//! The record of an execution: what was fixed when, and why, as `kirk-execution/1` says it.

use kirk_network::{Duration, Interval, Time};
use serde::{Deserialize, Serialize};

use crate::input::Reason;

/// The `format` of the record written and read here.
pub const FORMAT: &str = "kirk-execution/1";

/// True if a file looks like a record, of whatever version: it says so, in one of its first fields.
pub fn is_record(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_string();
    let name = FORMAT.trim_end_matches(char::is_numeric);
    head.trim_start_matches('\u{feff}').trim_start().starts_with('{') && head.contains(&format!("\"{name}"))
}

/// A finished (or failed) execution. All times are seconds after the origin, exact to a microsecond.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Execution {
    /// Always [`FORMAT`].
    pub format: String,
    /// The control program, or the name of the network.
    pub program: String,
    /// Did it come to its end?
    pub outcome: Outcome,
    /// What ended it, if it failed, or broke the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<Failure>,
    /// When the last event was over.
    pub makespan: Time,
    /// The seed of a simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// What became of the requirements, if Nature broke the model in a rehearsal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub what_if: Option<Box<Aftermath>>,
    /// One row for each name, in time order.
    pub rows: Vec<Row>,
}

/// What becomes of the bounds of the requirements once news has come that the model rules out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Aftermath {
    /// All that is not decided yet is kept, if Nature keeps to the model from now on.
    pub guaranteed: bool,
    /// The bounds that are broken.
    pub violated: Vec<Lost>,
    /// The bounds that were kept or broken: what was heard leaves it open.
    pub in_doubt: Vec<Lost>,
    /// The bounds that have to be given up so that all others can be kept.
    pub given_up: Vec<Lost>,
    /// How many bounds are kept, or can be.
    pub kept: usize,
}

/// A bound of a requirement that is not kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lost {
    /// The event it is measured from.
    pub from: String,
    /// The event it is measured to.
    pub to: String,
    /// Which bound.
    pub bound: Side,
    /// Its value.
    pub value: Duration,
    /// How long it was from one to the other, as far as that is known: of what is broken at best, of what is in doubt at worst.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<Duration>,
}

/// A bound of a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// At least.
    Lower,
    /// At most.
    Upper,
}

/// How an execution ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Every event was executed, and every requirement holds.
    Completed,
    /// Something made it impossible to go on.
    Failed,
    /// It is not over.
    Running,
    /// Nature did not keep to the model, in a rehearsal: `failure` says whether the rest could be guaranteed.
    #[serde(rename = "broken-model")]
    BrokenModel,
}

/// Why an execution failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// The event at which it failed.
    pub event: String,
    /// When it failed.
    pub time: Time,
    /// Why, in one word.
    pub reason: Reason,
    /// A sentence for people.
    pub detail: String,
}

/// What became of one event, under one of its names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The name.
    pub event: String,
    /// When the executive fixed the event; `null` if it never needed to.
    pub time: Option<Time>,
    /// How it came to be fixed.
    pub how: How,
    /// For contingent events: when the news arrived, `null` if it never did.
    #[serde(default, with = "given", skip_serializing_if = "Option::is_none")]
    pub observed: Option<Option<Time>>,
    /// For contingent events: the interval in which it must have happened, given all that was heard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub happened: Option<Interval>,
    /// When it really happened, if that is known (in simulations).
    #[serde(default, rename = "true", skip_serializing_if = "Option::is_none")]
    pub truth: Option<Time>,
    /// What decided its time, for people, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because: Option<String>,
}

/// How an event came to be fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum How {
    /// Our decision.
    Dispatched,
    /// Acted on when the news came.
    Observed,
    /// Acted on without hearing it.
    Imagined,
    /// Heard early, held until it was safe to act on.
    Buffered,
    /// Not heard, and not needed.
    Never,
}

impl How {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            How::Dispatched => "dispatched",
            How::Observed => "observed",
            How::Imagined => "imagined",
            How::Buffered => "buffered",
            How::Never => "never",
        }
    }
}

/// A field that tells `null` from absent.
mod given {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<T: Serialize, S: Serializer>(
        value: &Option<Option<T>>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.as_ref().and_then(|inner| inner.as_ref()).serialize(serializer)
    }

    pub(super) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Option<T>>, D::Error> {
        Option::<T>::deserialize(deserializer).map(Some)
    }
}
