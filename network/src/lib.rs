//! Temporal networks with uncertainty and observation delay.

mod blame;
pub mod check;
pub mod conflict;
pub mod controllability;
pub mod dispatchable;
pub mod dot;
pub mod generate;
pub mod graphml;
mod heap;
pub mod json;
pub mod merge;
pub mod model;
pub mod plain;
pub mod reduce;
pub mod stnu;
pub mod text;
pub mod time;
mod trees;

pub use check::{Verdict, check};
pub use conflict::{Conflict, Part, Share};
pub use dispatchable::{Dispatchable, dispatchable};
pub use model::{ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement};
pub use time::{Bound, Duration, ParseDurationError, Time};
