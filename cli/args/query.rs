//! The command line of `kirk query`.

use clap::Args;

use super::{Selection, TextOrJson};

#[derive(Debug, Args)]
pub(crate) struct Query {
    /// A mission or network (several files of RMPL are one program), or a journal (also of a mission that is running), or a record
    /// (`kirk run --format json`, or `GET /state`) and after it the mission it is of. `-` is standard input: a mission, or before a
    /// mission a record.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// Ask of the execution at T seconds [default: 0 for a mission, the last moment of a record or a journal].
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) at: Option<String>,
    /// Say all about this event, instead of a line about each that is to come (repeatable).
    #[arg(long, value_name = "NAME")]
    pub(crate) event: Vec<String>,
    /// What if news of EVENT arrives at T seconds, be it possible or not (repeatable)?
    #[arg(long, value_name = "EVENT@T")]
    pub(crate) heard: Vec<String>,
    /// What does this event wait for (repeatable)?
    #[arg(long, value_name = "NAME")]
    pub(crate) why: Vec<String>,
    /// How to print the answer.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(crate) format: TextOrJson,
}
