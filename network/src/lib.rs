//! Temporal networks with uncertainty and observation delay.

mod blame;
pub mod check;
pub mod conflict;
pub mod controllability;
mod heap;
pub mod json;
pub mod merge;
pub mod model;
pub mod reduce;
pub mod stnu;
pub mod time;
mod trees;

pub use check::{Verdict, check};
pub use conflict::{Conflict, Part, Share};
pub use model::{ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement};
pub use time::{Bound, Duration, ParseDurationError, Time};
