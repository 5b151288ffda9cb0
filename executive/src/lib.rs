//! Executes a mission in real time.
//!
//! mod tour comes here
mod clock;
mod desk;
mod driver;
mod failure;
mod file;
mod happening;
mod http;
mod lateness;
mod mission;
mod run;
mod signals;
mod snapshot;

pub use clock::{Clock, clocks};
pub use desk::{AnswerNews, Desk, Ignored, Reply};
pub use driver::Driver;
pub use happening::Happening;
pub use lateness::Lateness;
pub use mission::{Http, Mission, Options, Ready, Resumption, begin, resume};
pub use run::Ended;
pub use signals::stop_on_signals;
pub use snapshot::{Next, Possible, Snapshot};
