//! The network file `kirk-network/1`: seconds in decimal, exact to a microsecond, nothing unknown.

mod element;
mod fields;
mod parse;
mod place;
mod reader;
mod writer;

use crate::model::Network;
use crate::source_map::SourceMap;

pub use parse::parse;
pub use place::amount_in;
pub use writer::{write, write_dispatchable};

/// The `format` of the files read and written here.
pub const FORMAT: &str = "kirk-network/1";

/// What is wrong with a network file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadProblem {
    /// Byte offset into the text.
    pub offset: usize,
    /// What was expected, what is there, and which element it is in (`requirements[3]`).
    pub message: String,
}

/// Reads a network file, or lists everything that is wrong with it.
pub fn read(text: &str) -> Result<Network, Vec<ReadProblem>> {
    read_with_source_map(text).map(|(network, _)| network)
}

/// Reads a network file as [`read`] does, and remembers where its constraints stand.
pub fn read_with_source_map(text: &str) -> Result<(Network, SourceMap), Vec<ReadProblem>> {
    reader::read(text)
}
