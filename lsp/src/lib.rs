//! What the compiler knows, in the words of the Language Server Protocol.
//!
//! [`serve`] speaks the protocol on two streams. Each feature is one function from a text that has been analysed, or from
//! a [`View`] with the missions in it, and an offset, to plain data; `requests` converts it.
//!
//! # Invariants
//!
//! - Any text gives an answer to every question at every offset. What is no message is answered with an error.
//! - The one who answers waits for nobody: reading, writing and judging have threads of their own.
//! - Diagnostics are those of the newest text. If it has errors, there is no verdict; what is shown of windows then is
//!   that of the last text without.
//! - Types of the protocol are named in `server`, `requests`, `convert`, `feedback`, `lines` and `document`, not in features.
//!
//! # Deliberately absent
//!
//! Files: a document is judged by itself, as in `kirk check`.

mod analysis;
mod convert;
mod definition;
mod document;
mod feedback;
mod hover;
mod lines;
mod mission;
mod requests;
mod server;
mod transport;
mod view;

pub use analysis::{Analysis, Unjudged, analyse};
pub use definition::{definition, references};
pub use hover::{Hover, hover};
pub use lines::{Encoding, Lines};
pub use mission::{Judgement, Mission, Occurrence, judge};
pub use server::serve;
pub use view::{Shift, View};
