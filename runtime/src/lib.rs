//! Executes a proven network: decides what to do when, from what is known when it is known.
//!
//! ```
//! use kirk_network::{Time, json};
//! use kirk_runtime::{Plan, Simulation, simulate, verify};
//!
//! // News of B comes 1 to 3 s late; C must follow B by 5 to 9 s.
//! let network = json::read(
//!     r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
//!         "requirements": [{"from": "b", "to": "c", "lower": 5, "upper": 9}],
//!         "contingents": [{"from": "a", "to": "b", "lower": 1, "upper": 7, "delay": [1, 3]}]}"#,
//! )
//! .expect("a valid network");
//! let plan = Plan::new(&network).expect("a controllable network");
//! let b = plan.network().find("b").expect("an event");
//! // Heard at 2, so B happened at 1, and C may be executed at 6.
//! let news = Simulation { observations: vec![(b, Time::from_micros(2_000_000))], ..Simulation::default() };
//! let execution = simulate(&plan, "example", &news).expect("the news is possible");
//! assert_eq!(execution.makespan.to_string(), "6");
//! assert!(verify(&network, &execution).is_empty());
//! ```
//!
//! # The way through
//!
//! [`Plan::new`] merges, proves and compiles a network. A [`Dispatcher`] executes it; it is a state machine without a
//! clock, and its methods are of three kinds, called in this order:
//!
//! 1. `handle_observation(now, event)`, `handle_timeout(now)`: something happened, or it is time;
//! 2. `poll_dispatch()`: what is to be executed, until there is nothing more;
//! 3. `poll_timeout()`: when to call `handle_timeout` if nothing is heard before.
//!
//! In real time an [`Executive`] stands between the dispatcher and the world: it hands events over to a driver until that
//! confirms them, and answers news. All that happens to it is in a [`journal`], from which [`replay()`] leads to the same
//! state. The clock, the driver and the disk are in the crate `kirk-executive`.
//!
//! [`simulate()`] is the loop around it with a simulated [`nature`] and a clock that jumps; it returns an [`Execution`], the
//! record of what was done and known. [`verify()`] checks such a record and knows nothing of the dispatcher.
//!
//! # Invariants
//!
//! - `now` never goes back; early or repeated timeouts are harmless.
//! - A decision depends only on what was heard, never on what is true.
//! - One decision costs the degree of its event (times the logarithm of the queue), see `agenda.rs`.
//!
//! # Absent on purpose
//!
//! Clocks, threads, sockets and files; names of forms (the compiler has them).

mod activity;
mod aftermath;
mod agenda;
mod cause;
mod checkpoint;
pub mod dispatcher;
pub mod execution;
mod executive;
mod input;
pub mod journal;
mod knowledge;
mod measured;
pub mod nature;
mod order;
mod plan;
pub mod query;
mod rebuild;
mod record;
pub mod replay;
pub mod simulate;
mod speed;
pub mod verify;

pub use activity::{Handover, Scope, handovers, leave_out_natures, merge_companions, original_spelling};
pub use cause::Cause;
pub use checkpoint::Checkpoint;
pub use dispatcher::{Adoption, Dispatch, Dispatcher, Missed, Reception, Settings, Strategy};
pub use execution::{Aftermath, Execution, Failure, How, Lost, Outcome, Row, Side};
pub use executive::{Executive, Output, Pending, Sending, Setup};
pub use input::{Answer, Handled, Input, Reason, Why};
pub use journal::{BadJournal, Clocks, Journal};
pub use knowledge::{Fixed, Known};
pub use nature::{Impossible, Temper};
pub use order::Patience;
pub use plan::{NoPlan, Plan};
pub use query::{Ended, Heard, Situation, Unheard, Waits};
pub use rebuild::{Rebuild, Rebuilt};
pub use replay::{Replay, recover, replay};
pub use simulate::{Explained, Simulation, explained, simulate};
pub use speed::Speed;
pub use verify::{Violation, lucky, verify};
