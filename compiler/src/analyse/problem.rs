//! What can be wrong with names, declarations and calls.

use crate::ast::{Ident, Limits, Value, ValueKind};
use crate::evaluate;
use crate::parse::Instead;
use crate::source::Span;

/// How much of a circle or a list is told.
pub(crate) const MOST_TOLD: usize = 8;
/// How many values of a list are told.
pub(crate) const MOST_VALUES: usize = 12;

/// What is wrong, and what is known about it. What a name was probably meant to be is called `near`.
pub(crate) enum Problem {
    /// A number or an interval that is wrong.
    Amount(evaluate::Problem),
    /// A program that is declared primitive and has a body.
    PrimitiveWithBody { program: Ident, body: Span },
    /// A program with a body and a duration, which may limit the body.
    DurationOfBody { program: Ident, duration: Span, limit: Option<Limit> },
    /// A program with a duration that is not primitive and has no body.
    OnlyADuration { program: Ident, duration: Span },
    /// A program without a body, and no primitive one.
    NoBody { program: Ident, definition: Span },
    /// Nature could take forever.
    ContingentUnbounded { program: Ident, upper: Span },
    /// An observation delay of what Nature does not decide, in words or by default.
    DelayNotContingent { program: Ident, delay: Span, duration: Span, bounds: Span, nil: Option<Span> },
    /// Somebody is to hear first of an end that Nature does not decide.
    ObserverNotContingent { program: Ident, observer: Span },
    /// A delay of news or of a message without a longest one.
    NoLongestDelay { limits: Limits, delay: Span },
    /// The second definition of a name.
    DefinedTwice { what: Defined, name: Ident, first: Span },
    /// A package that nothing defines.
    UnknownPackage { name: String, span: Span, near: Option<String> },
    /// A package before a name that nothing defines.
    UnknownPackageOf { name: Ident, near: Option<String> },
    /// The package to start from is none of those defined.
    NoSuchPackage { name: String, defined: Vec<String>, near: Option<String> },
    /// A name that is imported from a package, or exported, and is not there.
    NotInPackage { package: String, name: Ident, is_imported: bool, near: Option<String> },
    /// Programs to start from in several packages; what is outside any package counts as one.
    SeveralEntries { name: String, places: Vec<(String, Span)> },
    /// Several packages, and none is chosen.
    NoPackageChosen { second: Span, defined: Vec<String> },
    /// The program to start from is none of these, of which the last is there.
    NoEntry { name: String, last: Span, candidates: Vec<String>, near: Option<String> },
    /// A call of nothing; perhaps another package has what is meant.
    UnknownProgram { name: Ident, elsewhere: Option<String>, near: Option<String>, create: Missing },
    /// A word of another language, and what to write in its place, if that is certain.
    ForeignOperator { name: Ident, instead: Instead, cure: Option<&'static str> },
    /// A word that is nearly an operator.
    UnknownOperator { name: Ident, near: String },
    /// The event of nothing; perhaps an occurrence of this program by a number it has not.
    UnknownEvent { name: Ident, occurrence_of: Option<String>, near: Option<String> },
    /// A call with too many arguments, or too few.
    WrongArguments { call: Span, given: usize, program: Ident, parameters: Vec<Ident> },
    /// A named number that is defined only below.
    UsedBeforeDefined { name: Ident, definition: Span },
    /// A value that nothing is called.
    UnknownName { name: Ident, near: Option<String> },
    /// A unit after its number.
    StrayUnit { name: Ident, unit: &'static str },
    /// A mark that looks like the quote before a name.
    CurlyQuote { name: Ident, mark: char, quoted: String },
    /// A name in a condition that is no parameter.
    UnknownParameter { name: String, span: Span, program: Ident, near: Option<String> },
    /// A superclass that nothing defines.
    UnknownClass { name: Ident, near: Option<String> },
    /// A type of a slot that is neither a class nor one of Lisp.
    UnknownType { name: Ident, near: Option<String> },
    /// What reads no slot; perhaps it is the name of one.
    UnknownAccessor { name: Ident, is_slot: bool, near: Option<String> },
    /// A value that a slot cannot have.
    WrongType { slot: Ident, allowed: Allowed, value: Value, near: Option<String> },
    /// A program with conditions or effects.
    NotPlannedWith { program: Ident },
    /// A class that extends itself. Of the circle no more than is told.
    CircularClass { circle: Vec<Ident>, at: Span },
    /// A program that calls itself. The same, and how long the circle is.
    Recursion { circle: Vec<Ident>, length: usize, call: Span },
    /// A program that nothing leads to, with its package if it is another than that of the program started.
    NeverCalled { program: Ident, entry: String, package: Option<String> },
    /// A parameter that nothing in the body means.
    UnusedParameter { name: String, span: Span, program: Ident },
    /// A label that no `between` means.
    UnusedLabel { name: String, span: Span },
    /// A second team.
    SecondTeam { team: Ident, first: Span },
    /// A team that nobody belongs to.
    EmptyTeam { team: Ident },
    /// A name of nobody in the team, or of anybody where there is none.
    UnknownAgent { name: Ident, team: Option<Ident>, near: Option<String> },
    /// A link from an agent to itself.
    LinkToItself { agent: Ident, link: Span },
}

/// The one form of a body, and the bounds that can be put around it.
pub(crate) struct Limit {
    pub(crate) form: Span,
    pub(crate) lower: Option<Span>,
    pub(crate) upper: Option<Span>,
}

/// The kinds of definitions that there may be only one of.
#[derive(Clone, Copy)]
pub(crate) enum Defined {
    Package,
    Program,
    NamedNumber,
    Class,
    Agent,
}

/// A definition that is missing: how many parameters it has, and after what it could stand.
pub(crate) struct Missing {
    pub(crate) parameters: usize,
    pub(crate) after: Span,
}

/// What a slot may contain.
pub(crate) enum Allowed {
    /// One of these, and perhaps others.
    OneOf(Vec<ValueKind>),
    OfType(Ident),
    Other,
}
