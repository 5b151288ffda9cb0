//! What can be wrong with a program as it is unfolded.

use crate::ast::{Ident, Value, ValueKind};
use crate::evaluate;
use crate::source::Span;

/// How many occurrences are told of those a name may mean.
pub(crate) const MOST_TOLD: usize = 6;

/// What is wrong, and what is known about it.
pub(crate) enum Problem {
    /// A number or an interval is wrong, as the program was called there.
    Amount { problem: evaluate::Problem, call: Span },
    /// The program to start from has parameters.
    FreeParameters { program: Ident, parameters: Vec<Ident> },
    /// Nature could take forever, as the program was called there.
    ContingentUnbounded { program: Ident, upper: Span, call: Span },
    /// The program unfolds to so many, most of them by one call.
    TooManyEpisodes { program: Ident, episodes: u64, most: Option<(Ident, Span)> },
    /// The program unfolds too deeply.
    TooDeep { program: Ident, depth: u64 },
    /// Here is one too many, perhaps as the program was called there.
    TooMany { what: Unfolded, span: Span, call: Option<Span> },
    /// An activity of a team that is nobody's.
    NobodyExecutes { program: Ident, call: Span },
    /// What was given for an agent is none.
    NoAgent { named: Span, value: Value, agents: Vec<String>, call: Span },
    /// A constraint from an event to itself.
    SameEvent { from: Span, to: Span },
    /// One name for two occurrences in one scope.
    LabelTwice { label: String, span: Span, first: Span },
    /// A name of nothing that occurs.
    NoOccurrence { name: Name, there: There },
    /// A name of several occurrences.
    Ambiguous { name: Name, found: Found, apart: Apart },
}

/// What there may be too many of.
pub(crate) enum Unfolded {
    Episodes,
    Repetitions,
    Constraints,
}

/// A name of an occurrence, as it is looked up.
pub(crate) struct Name {
    pub(crate) name: String,
    pub(crate) arguments: Option<Vec<ValueKind>>,
    pub(crate) span: Span,
}

/// What there is in the place of an occurrence that there is not.
pub(crate) enum There {
    Nothing,
    /// The only one of the program.
    Only(String),
    /// The first and the last one of the program.
    Between(String, String),
    /// Some of those with other arguments, and where the first is.
    Others(Vec<Vec<ValueKind>>, Span),
}

/// Occurrences of one name, no more of them than are told.
pub(crate) struct Found {
    pub(crate) count: usize,
    pub(crate) episodes: Vec<String>,
    /// Where they are, each place with the first that is there.
    pub(crate) places: Vec<(Span, String)>,
}

/// What would tell occurrences apart.
pub(crate) enum Apart {
    /// Their arguments: those of the first.
    Arguments(Vec<ValueKind>),
    /// An argument that their label has not yet.
    ArgumentOfLabel,
    /// A label.
    Label,
}
