//! What the compiler knows, in the words of the Language Server Protocol.
//!
//! [`serve`] speaks the protocol on two streams. Each feature is one function from a text that has been analysed, or from
//! a [`View`] with the missions in it, and an offset, to plain data; `requests` converts it.
//!
//! # Invariants
//!
//! - Any text gives an answer to every question at every offset. What is no message is answered with an error.
//! - The one who answers waits for nobody: reading, writing and judging have threads of their own, and so have answers that
//!   take a while.
//! - Diagnostics are those of the newest text. If it has errors, there is no verdict; what is shown of windows then is
//!   that of the last text without.
//! - Types of the protocol are named in `server`, `errands`, `requests`, `convert`, `feedback`, `lines` and `document`, not in features.
//!
//! # Deliberately absent
//!
//! Access to files: what is not open in the editor is read by who starts the server. A document is judged by itself, or with
//! the files it names (`;;; kirk: files ...`).

mod actions;
mod analysis;
mod capabilities;
mod companions;
mod completion;
mod convert;
mod cursor;
mod definition;
mod document;
mod errands;
mod feedback;
mod folding;
mod highlight;
mod hints;
mod hover;
mod judged;
mod layout;
mod left;
mod lines;
mod outline;
mod rename;
mod requests;
mod server;
mod signature;
mod transport;
mod view;
mod waits;
mod wording;

pub use actions::{Action, actions};
pub use analysis::{Analysis, Companions, Unjudged, analyse, analyse_among, edited};
pub use companions::ReadFile;
pub use completion::{Completion, CompletionKind, completion, filled_in};
pub use definition::{definition, references};
pub use folding::{Fold, folding};
pub use highlight::{Highlight, HighlightKind, highlight};
pub use hints::{Hint, Lens, hints, lenses};
pub use hover::{Hover, hover};
pub use judged::{Judged, Judgement, Occurrence, judge};
pub use layout::{layout, layout_within};
pub use lines::{Encoding, Lines};
pub use outline::{Outline, OutlineKind, outline};
pub use rename::{prepare_rename, rename};
pub use server::serve;
pub use signature::{Signature, signature};
pub use view::{Shift, View};
