//! What happens in a mission, for those who watch: the stream of `GET /events`, the live timetable, the lines on a terminal.

use kirk_network::Time;
use kirk_runtime::{Execution, Row, Why};
use serde::Serialize;

/// One thing that happened.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Happening {
    /// An event was handed over to the driver.
    Sent {
        /// When, in seconds after the start.
        at: Time,
        /// The event.
        event: String,
        /// The dispatch.
        id: String,
        /// When it was due.
        due: Time,
        /// 1 for the first.
        attempt: u32,
    },
    /// An event was fixed: dispatched (and confirmed), observed, buffered, imagined. One row for each name.
    Fixed {
        /// When it was known, in seconds after the start.
        at: Time,
        /// As in the record of the execution.
        rows: Vec<Row>,
    },
    /// The driver failed to execute an event; it is tried again while its window is open.
    Failed {
        /// When, in seconds after the start.
        at: Time,
        /// The event; in JSON the dispatch says which.
        #[serde(skip)]
        event: String,
        /// The dispatch.
        id: String,
        /// Why.
        reason: String,
    },
    /// Something a person should know: not all is as it should be.
    Warning {
        /// When, in seconds after the start.
        at: Time,
        /// A sentence.
        text: String,
    },
    /// Something a person may want to know: how news was taken.
    Note {
        /// When, in seconds after the start.
        at: Time,
        /// A sentence.
        text: String,
    },
    /// News was of no use. The same is told once.
    Ignored {
        /// When it arrived, in seconds after the start.
        at: Time,
        /// The event, as it was called.
        event: String,
        /// Why.
        why: Why,
    },
    /// The mission is over.
    Over {
        /// When, in seconds after the start.
        at: Time,
        /// The record.
        execution: Execution,
    },
}
