//! Temporal networks with uncertainty and observation delay: what can be executed whatever Nature does, and why not.
//!
//! A [`Network`] has events, requirements between them, and contingent links whose durations Nature picks and whose news
//! may be late. [`check()`] decides whether there is always a way to keep the requirements; [`dispatchable()`] makes the
//! form in which a controllable network is executed.
//!
//! ```
//! use kirk_network::{Verdict, check, json};
//!
//! // Scanning takes 15 to 30 s, and its end is heard 5 to 15 s late. Something must happen within 3 s of that end.
//! let mission = |within: u32| {
//!     let text = format!(
//!         r#"{{"format": "kirk-network/1", "origin": "start", "events": ["start", "scanned", "act"],
//!             "requirements": [{{"from": "scanned", "to": "act", "lower": 0, "upper": {within}}}],
//!             "contingents": [{{"from": "start", "to": "scanned", "lower": 15, "upper": 30, "delay": [5, 15]}}]}}"#
//!     );
//!     json::read(&text).expect("a valid network")
//! };
//! assert_eq!(check(&mission(15)), Ok(Verdict::Controllable));
//! let Ok(Verdict::Uncontrollable(conflict)) = check(&mission(3)) else { panic!("heard too late") };
//! assert_eq!(conflict.total.to_string(), "-7"); // the shares of the bounds to blame add up: seven seconds are missing
//! ```
//!
//! # The way through
//!
//! | step | module | from | to |
//! | --- | --- | --- | --- |
//! | merge | [`merge`] | network | network in which [0, 0]-joined events are one |
//! | reduce | [`reduce`] | merged network | plain STNU, and where each event is in it |
//! | decide | [`controllability`] | plain STNU | yes, or a negative cycle |
//! | blame | [`mod@check`] | negative cycle | minimal [`Conflict`] in terms of the network |
//! | compile | [`mod@dispatchable`] | plain STNU | [`Dispatchable`] |
//!
//! Around the verdict, each asking for it at other values of the bounds ([`vary`]): [`least`] finds the least change of a
//! bound that turns a "no" into a "yes", [`mod@slack`] how far a bound can move before a "yes" is lost, [`promise`] by when and
//! how long something can be promised. [`repair`] finds the cheapest changes of several bounds, by linear
//! programs ([`program`]). [`mod@walk`] tells a conflict as a
//! walk over events.
//!
//! [`mod@punctual`] finds the events of a controllable network that can never be executed late.
//! [`mod@windows`] says between which times each event can happen, [`mod@left`] between which it still can in the middle of an
//! execution, [`news`] what becomes of late news.
//!
//! [`json`], [`graphml`], [`plain`], [`dot`] and [`text`] are the formats, [`generate`] makes networks to measure with.
//!
//! # Words
//!
//! *Executable* events are ours, *contingent* ones Nature's; a contingent link leads from its *activation* to its
//! contingent event; the *origin* is executed first, at time 0. *Chains* are links that start at a contingent event.
//!
//! # Invariants
//!
//! - An edge `a -> b` of weight `w` says `b - a <= w` (`target - source <= weight`).
//! - Seconds outside, 64-bit microseconds inside; sums beyond [`stnu::LIMIT`] are [`stnu::TooLarge`], never wrong.
//! - Nothing depends on the order of the input but the order of the output; the same input gives the same output.
//! - No recursion over the input, no clock, no files, no threads.
//!
//! # Absent on purpose
//!
//! Spans and sentences (the compiler has them), the state of an execution (the runtime has it), choices between
//! alternatives, probabilities.

pub mod assume;
mod blame;
pub mod check;
mod conflict;
pub mod conflicts;
pub mod controllability;
pub mod dispatchable;
pub mod dot;
pub mod generate;
pub mod graphml;
mod hierarchy;
pub mod json;
pub mod kinds;
pub mod least;
pub mod left;
pub mod merge;
pub mod model;
pub mod nearest;
pub mod news;
pub mod plain;
pub mod precedence;
pub mod program;
pub mod promise;
pub mod punctual;
mod radix;
pub mod reduce;
pub mod repair;
pub mod rmpl;
pub mod slack;
mod source_map;
pub mod stnu;
pub mod text;
pub mod time;

mod trees;
pub mod vary;
pub mod walk;
pub mod windows;
pub mod witness;

pub use check::{Verdict, check};
pub use conflict::{Conflict, Part, Share};
pub use dispatchable::{Dispatchable, dispatchable};
pub use model::{ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement};
pub use nearest::nearest;
pub use source_map::SourceMap;
pub use time::{Bound, Duration, Interval, ParseDurationError, Time};
