//! kirk as a library: RMPL or a network in, a proof or a conflict out, and an execution stepped by whoever has the clock.
//!
//! ```
//! use kirk::{Dispatcher, EventId, Plan, Settings, Source, Strategy, Time, compile};
//!
//! // A robot scans for as long as it takes; the news of the end is 5 to 15 s late. Then it stows its arm.
//! let text = "
//! (define-control-program scan ()
//!   (declare (primitive)
//!     (duration (simple :lower-bound 15 :upper-bound 30 :min-observation-delay 5 :max-observation-delay 15)
//!               :contingent t)))
//! (define-control-program stow ()
//!   (declare (primitive) (duration (simple :lower-bound 10 :upper-bound 20))))
//! (define-control-program main ()
//!   (sequence (:slack t) (scan) (stow)))";
//!
//! // From source to network: every problem with its place, or a mission.
//! let compilation = compile(&[Source::new("robot.rmpl", text)], &kirk::Options::default());
//! assert_eq!(compilation.diagnostics, []);
//! let mission = compilation.lowered.expect("no errors, so there is a mission");
//!
//! // From network to proof: `Err` has the constraints that cannot all be honoured.
//! let plan = Plan::new(&mission.network).expect("it can be executed whatever happens");
//! let event = |name: &str| plan.network().find(name).expect("an event of the mission");
//! let (scanned, stow) = (event("scan:end"), event("stow:start"));
//!
//! // From proof to execution. Time is an argument: nothing here sleeps.
//! let mut dispatcher = Dispatcher::new(plan.clone(), Settings::of(Strategy::Optimistic));
//! let mut done: Vec<(EventId, Time)> = Vec::new();
//! let seconds = |seconds: i64| Time::from_micros(seconds * 1_000_000);
//! for now in 0..60 {
//!     if now == 22 {
//!         dispatcher.handle_observation(seconds(now), scanned);
//!         // The news says more than the plan assumed: it is planned with. That may as well be done elsewhere.
//!         while let Some(rebuild) = dispatcher.poll_rebuild(seconds(now)) {
//!             dispatcher.handle_rebuilt(rebuild.run());
//!         }
//!     }
//!     dispatcher.handle_timeout(seconds(now));
//!     while let Some(dispatch) = dispatcher.poll_dispatch() {
//!         done.push((dispatch.event, dispatch.time));
//!     }
//! }
//! assert!(done.contains(&(stow, seconds(22))), "heard at 22 s: it has ended by then, for certain");
//! assert!(dispatcher.is_over());
//! ```
//!
//! `examples/stepped.rs` is the same with a loop that jumps from decision to decision, news that is asked for, and the
//! record of what happened: `cargo run --example stepped`.
//!
//! The crates have a tour each: [`compiler`] (the language), [`network`] (networks, controllability, formats), [`runtime`]
//! and [`team`] (executions without a clock, by one and by several; the clock, drivers and news over HTTP are in the `kirk` command). A library needs none of the
//! command: depend on kirk with `default-features = false`.

pub use kirk_compiler as compiler;
pub use kirk_network as network;
pub use kirk_runtime as runtime;
pub use kirk_team as team;

pub use kirk_compiler::{Compilation, Diagnostic, Explain, Options, Source, compile};
pub use kirk_network::{Conflict, Duration, EventId, Network, Time, Verdict, check};
pub use kirk_runtime::{
    Dispatch, Dispatcher, NoPlan, Plan, Reception, Settings, Simulation, Strategy, simulate, verify,
};
