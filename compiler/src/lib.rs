//! From RMPL source to a delay STNU, or diagnostics.
//!
//! ```text
//!         read         parse       analyse         expand            lower
//!  text ---------> forms -----> ast -----> typed ----------> episodes -----> network + origins
//!    grammar/rmpl.pest                                                              |
//!                                             conflict (from kirk-network) ---> explain ---> diagnostic
//! ```
//!
//! Each phase is one function in a file of its own. All but the last two take a program however broken, return
//! what can be made of it, and append what is wrong to one [`problem::Problems`]; `expand` and `lower` run only on a
//! program without errors. [`front`](fn@front) is the phases up to `analyse`, [`unfold`](fn@unfold) the rest, and [`compile`] is both:
//!
//! ```
//! use kirk_compiler::{Options, Source, compile};
//!
//! let text = "
//! (define-control-program eat ()
//!   (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))
//! (define-control-program drive ()
//!   (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
//! (define-control-program main ()
//!   (with-temporal-constraint (simple-temporal :upper-bound 60)
//!     (sequence (:slack t) (eat) (drive))))";
//! let compilation = compile(&[Source::new("morning.rmpl", text)], &Options::default());
//! assert_eq!(compilation.diagnostics, []);
//!
//! let lowered = compilation.lowered.expect("no errors, so there is a network");
//! assert_eq!(lowered.network.contingents().len(), 1);
//! assert_eq!(lowered.origins.contingents[0].text(), "`drive` takes 15 to 20 s, Nature decides");
//! assert_eq!(lowered.network.id(lowered.network.origin()), "main:start");
//!
//! // A slip: the message knows what was meant, and there is no network.
//! let compilation = compile(&[Source::new("morning.rmpl", text.replace("(eat)", "(eta)"))], &Options::default());
//! assert_eq!(compilation.diagnostics[0].help.as_deref(), Some("Did you mean `eat`?"));
//! assert!(compilation.lowered.is_none());
//! ```
//!
//! # Words
//!
//! - A **form** is an s-expression with its place. A **program** is what `define-control-program` defines: **primitive** if
//!   it is an activity, else it has a **body**.
//! - An **episode** is one occurrence of a program or of a body form, from its start event to its end event.
//! - A **label** is a name for an episode. A **scope** is how far such a name reaches: one call of a program, or one
//!   repetition of a `dotimes`, with everything called from there.
//! - The **origin** of a constraint is the place and the sentence it comes from. (The origin of a network, an event, is
//!   another thing: the start of the entry program.)
//! - A **diagnostic** has a stable [`Code`], a page for which [`explain`](fn@explain) gives, and places in the sources.
//!
//! # Invariants
//!
//! - Any text gives a result: no panic, no recursion deeper than the limits of the reader and of `expand`, time and
//!   memory linear in the text and in the number of episodes, both bounded.
//! - There is a network exactly if no diagnostic is an error. Every place lies inside its source, on character boundaries.
//! - `origins.requirements[i]` belongs to `network.requirements()[i]`, and so for the contingent links. The network is not
//!   merged: every "at the same time" is a requirement [0, 0], so that a conflict can point at it.
//! - Event names are unique, lower case, and depend on nothing but the source. Two runs give the same bytes.
//! - Nothing a user wrote is ignored silently.
//! - [`format`](fn@format) knows the tokens and not the language: what it returns is read as the same forms.
//!
//! # Deliberately absent
//!
//! Files, colours and exit statuses (the command line has them), merging and every verdict (`kirk-network`), planning with
//! conditions and effects, macros and functions of Lisp.

mod analyse;
pub mod ast;
mod calculate;
pub mod code;
mod companions;
mod diagnostic;
pub mod episode;
mod evaluate;
mod expand;
mod explain;
pub mod form;
mod format;
mod front;
mod lower;
mod notes;
mod origins;
mod parse;
mod problem;
pub mod read;
pub mod repair;
mod sexpr;
mod source;
mod team;
mod typed;
mod unfold;
mod wording;
pub mod words;
mod written;

pub use analyse::symbols::{Mention, Symbol, SymbolKind, Symbols, Uses};
pub use code::{Code, explain};
pub use companions::{Companion, companions};
pub use diagnostic::{Diagnostic, Edit, Label, Severity, Suggestion, Text};
pub use episode::{MAX_DEPTH, MAX_EPISODES};
pub use explain::{Explain, StoryStep, Told};
pub use format::format;
pub use front::{Front, front, front_in_order};
pub use kirk_network::nearest;
pub use lower::{Lowered, events_of};
pub use origins::{Origin, OriginKind, Origins, Point, Side, Statement, Subject};
pub use problem::Problems;
pub use sexpr::to_sexpr;
pub use source::{LineIndex, Source, Span};
pub use team::{Link, Team};
pub use typed::{Model, Work};
pub use unfold::{Unfolded, unfold};
pub use wording::conflict::too_large;
pub use written::{Written, measurable, usual_unit, written};

/// What to compile of the sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The package whose program is started; needed only if there are several.
    pub package: Option<String>,
    /// The program to start from.
    pub entry: String,
}

/// Everything that compiling yields, as far as it got.
#[derive(Clone, Debug)]
pub struct Compilation {
    /// The program as written.
    pub ast: ast::Program,
    /// The program unfolded.
    pub episodes: Option<episode::Episode>,
    /// The network and where it comes from; `None` if there was an error.
    pub lowered: Option<Lowered>,
    /// What there is to say, sorted by place.
    pub diagnostics: Vec<Diagnostic>,
}

impl Default for Options {
    fn default() -> Options {
        Options { package: None, entry: "main".to_string() }
    }
}

/// Compiles the sources as one program.
pub fn compile(sources: &[Source], options: &Options) -> Compilation {
    let Front { program: ast, model, mut problems, .. } = front(sources, options);
    let unfolded = if problems.has_errors() { None } else { unfold(&model, &mut problems) };
    let (episodes, lowered) = unfolded.map_or((None, None), |it| (Some(it.episodes), it.lowered));
    Compilation { ast, episodes, lowered, diagnostics: problems.into_sorted() }
}
