//! Executes a proven network.

mod agenda;
pub mod dispatcher;
pub mod execution;
pub mod nature;
pub mod plan;
pub mod simulate;
pub mod verify;

pub use dispatcher::{Dispatch, Dispatcher, Missed, Reception, Strategy};
pub use execution::{Execution, Failure, How, Outcome, Row};
pub use nature::{Impossible, Temper};
pub use plan::{NoPlan, Plan};
pub use simulate::{Simulation, simulate};
pub use verify::{Violation, verify};
