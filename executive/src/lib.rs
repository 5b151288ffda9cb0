//! Executes a mission in real time: the shell around [`kirk_runtime::Executive`], with a clock, a driver, news and a journal.
//!
//! ```
//! use kirk_executive::{Assignment, Options, begin};
//! use kirk_runtime::{Plan, Scope, Speed, handovers};
//!
//! let network = kirk_network::json::read(
//!     r#"{"format": "kirk-network/1", "origin": "go", "events": ["go", "drive:start", "drive:end"],
//!         "requirements": [{"from": "go", "to": "drive:start", "lower": 2, "upper": 4}],
//!         "contingents": [{"from": "drive:start", "to": "drive:end", "lower": 1, "upper": 9}]}"#,
//! )
//! .expect("a valid network");
//! let plan = Plan::new(&network).expect("a controllable network");
//! let handovers = handovers(plan.network(), None, Scope::Starts);
//! let mission = Assignment { program: "a drive".into(), network, plan, handovers };
//! // A hundred times as fast as the world, without a driver, a journal, or a port for news.
//! let speed = Speed::try_from(100.0).expect("a speed");
//! let options = Options { speed, ..Options::default() };
//! // Nobody listens to what commands of a driver print.
//! let (said, _) = std::sync::mpsc::channel();
//! let ready = begin(mission, options, None, said).expect("nothing to open");
//! // Nobody says that the drive is over, so at 11 it must be.
//! let ended = ready.run(false);
//! assert_eq!(ended.execution.makespan.to_string(), "11");
//! ```
//!
//! # The way through
//!
//! [`begin`] and [`resume()`] open everything that can fail; [`Ready::run`] is the loop. It sleeps until the next decision or the
//! next message, and waits for nothing else: the disk is synced, plans are made, events are driven and news is heard on
//! other threads, which leave their messages at the [`Desk`].
//!
//! # Invariants
//!
//! - Whatever happens to the executive goes through the loop, with its time, and is written to the journal in that order.
//! - Nothing that comes of it leaves (no dispatch, no answer to news) before the record of it is on the disk.
//! - What is certainly of no use never reaches the loop.
//! - A dispatch has the same id at every attempt and after every restart.
//!
//! # Absent on purpose
//!
//! Decisions: what is executed when, what news means, what is tried again is up to [`kirk_runtime`], which knows no clock.

mod clock;
mod desk;
mod driver;
mod failure;
mod file;
mod happening;
mod http;
mod lateness;
mod lock;
mod mission;
mod resume;
mod run;
mod seconds;
mod signals;
mod snapshot;

pub use clock::{Clock, clocks};
pub use desk::{Acknowledgement, Desk, Ignored, Reply};
pub use driver::{Driver, Said};
pub use happening::Happening;
pub use http::read_observations;
pub use lateness::Lateness;
pub use mission::{Assignment, Http, Options, Ready, Screen, Zero, begin};
pub use resume::{Resumption, resume};
pub use run::Ended;
pub use signals::stop_on_signals;
pub use snapshot::{Next, Possible, Snapshot, Waits};
