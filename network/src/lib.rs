//! Temporal networks with uncertainty and observation delay.

pub mod conflict;
pub mod model;
pub mod time;

pub use conflict::{Conflict, Part, Share};
pub use model::{ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement};
pub use time::{Bound, Duration, ParseDurationError, Time};
