//! Executes a mission in real time.
//!
//! mod tour comes here
mod clock;
mod desk;
mod happening;

pub use clock::{Clock, clocks};
pub use desk::{AnswerNews, Desk, Ignored, Reply};
pub use happening::Happening;
