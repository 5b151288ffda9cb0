//! What can happen to an executive, as data: the list of it is the whole execution, and its journal.

use std::fmt;

use kirk_network::{Duration, EventId, Network, Time};
use serde::{Deserialize, Serialize, Serializer};

use crate::checkpoint::Checkpoint;
use crate::rebuild::Rebuilt;

/// One thing that happens to an executive at a time, handed to [`Executive::handle`](crate::Executive::handle).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Input {
    /// Something is due, or may be.
    Timeout {},
    /// News arrived: an event was observed.
    #[serde(rename = "news")]
    Observed {
        /// The event, under any of its names.
        event: String,
    },
    /// An attempt leaves for the driver: from now on it counts. It must not leave if the answer is that it is too late.
    Sent {
        /// The dispatch.
        id: String,
    },
    /// The driver confirmed an event.
    Executed {
        /// The dispatch.
        id: String,
        /// How long before it was executed, if the driver says so.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ago: Option<Duration>,
    },
    /// The driver failed to execute an event. It is tried again while that makes sense.
    Failed {
        /// The dispatch.
        id: String,
        /// Why.
        reason: String,
        /// True if it may have executed it all the same.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        doubt: bool,
    },
    /// The answer is there to how to go on with what is known.
    Rebuilt {
        /// The time from which it plans.
        from: Time,
        /// In the record, if that is followed: what was known by then that the last such record did not know. All before it
        /// is of no more use then.
        known: Option<Box<Checkpoint>>,
        /// The plan. One that is not at hand is made: the record does not contain it.
        #[serde(skip)]
        made: Option<Box<Rebuilt>>,
    },
    /// The executive was away and is back. Whatever was not confirmed is handed over again, under the same id: the driver is
    /// asked, as it were, whether it was done before, so it counts from when the driver was told.
    Resumed {
        /// Dispatches that had not left, of which the driver cannot have heard. They count from now.
        unsent: Vec<String>,
    },
    /// Somebody or something outside ends the mission.
    Stopped {
        /// In one word.
        reason: Reason,
        /// In a sentence.
        detail: String,
    },
}

impl Input {
    /// News of an event.
    pub fn observed(network: &Network, event: EventId) -> Input {
        Input::Observed { event: network.label(event).to_string() }
    }

    /// A plan that was made elsewhere.
    pub fn rebuilt(rebuilt: Rebuilt) -> Input {
        Input::Rebuilt { from: rebuilt.now, known: None, made: Some(Box::new(rebuilt)) }
    }
}

/// What became of an input.
#[derive(Clone, Debug)]
pub struct Handled {
    /// Was it of use?
    pub answer: Answer,
    /// What belongs in the journal of it; nothing if nothing has changed.
    pub record: Option<Input>,
}

impl Handled {
    /// True if it was of use.
    pub fn is_accepted(&self) -> bool {
        self.answer == Answer::Accepted
    }
}

/// Was an input of use?
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is known now.
    Accepted,
    /// It is of no use, and why.
    Ignored(Why),
}

/// Why something is of no use.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Why {
    /// There is no such event.
    UnknownEvent,
    /// The event is ours.
    NotNatures,
    /// News of it came before.
    ObservedBefore,
    /// What it begins with has not been executed.
    NotStarted {
        /// What that is.
        start: String,
    },
    /// It is before time zero.
    NotBegun,
    /// The mission is over.
    Over,
    /// Nothing of that id is with the driver.
    NotWithDriver,
    /// What was handed over must not leave any more.
    TooLate,
    /// There was nothing to plan anew, or the plan is out of date.
    NoSuchPlan,
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Why::UnknownEvent => f.write_str("there is no such event in this mission"),
            Why::NotNatures => f.write_str("it is not Nature's to decide: kirk dispatches it"),
            Why::ObservedBefore => f.write_str("it was heard before"),
            Why::NotStarted { start } => {
                write!(f, "it cannot have happened: `{start}` has not been executed")
            }
            Why::NotBegun => f.write_str("the mission has not begun"),
            Why::Over => f.write_str("the mission is over"),
            Why::NotWithDriver => f.write_str("the driver was not told of it, or has answered"),
            Why::TooLate => f.write_str("its window has closed"),
            Why::NoSuchPlan => f.write_str("there is nothing to plan anew here"),
        }
    }
}

/// As the sentence.
impl Serialize for Why {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Why an execution failed, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// What had to be executed in time was not.
    MissedWindow,
    /// There is no way to execute it in every case.
    NotControllable,
    /// The driver could not execute something in time.
    DriverFailed,
    /// News came that the model rules out.
    BrokenModel,
    /// The journal could not be written.
    JournalFailed,
    /// Somebody stopped it.
    Stopped,
}

impl Reason {
    /// The word.
    pub fn word(self) -> &'static str {
        match self {
            Reason::MissedWindow => "missed-window",
            Reason::NotControllable => "not-controllable",
            Reason::DriverFailed => "driver-failed",
            Reason::BrokenModel => "broken-model",
            Reason::JournalFailed => "journal-failed",
            Reason::Stopped => "stopped",
        }
    }
}
