//! What can be wrong with the shape of forms. The words for it are in `wording/parse.rs`.
//!
//! Forms and names are as they are written. What was probably meant in the place of something is called `near`.

use super::slips::elsewhere::Instead;
use crate::ast::{Ident, Role};
use crate::calculate::Operator;
use crate::form::Form;
use crate::source::Span;

/// What is wrong with a form.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Problem<'a> {
    /// Something stands where something else belongs.
    Unexpected { found: &'a Form, expected: Expected },
    /// Something is missing in a form, which begins here.
    Missing { at: Span, what: Missing },
    /// A thing is said a second time; all of it, if one of the two can be taken out.
    Twice { what: Twice<'a>, first: Span, again: Span, whole: Option<[Span; 2]> },
    /// Two parameters or two variables have one name.
    Repeated { what: Named, name: &'a str, first: Span, again: Span },
    /// A program or a parameter with the name of something else.
    Reserved { what: Named, name: &'a str, at: Span },
    /// A word that is no operator.
    UnknownOperator { at: Span, word: &'a str, near: &'static str },
    /// `&optional` and the like among the parameters.
    ParameterMark { at: Span, word: &'a str },
    /// A condition that is none.
    Condition { at: Span, slip: ConditionSlip<'a> },
    /// A constraint without bounds around a body.
    NoBounds { constraint: Span },
    /// The same between two events.
    OnlyOrder { constraint: Span },
    /// An option of a package that is none.
    PackageOption { at: Span, word: &'a str, near: Option<&'static str> },
    /// An option of a slot that is none.
    SlotOption { at: Span, word: &'a str, near: Option<&'static str> },
    /// An option of a slot with nothing after it.
    SlotOptionAlone { at: Span, word: &'a str },
    /// A package that is entered and not defined.
    UnknownPackage { form: Span, at: Span, name: &'a str, near: Option<&'a str> },
    /// Something that is no number. What it is for is known.
    Number { form: &'a Form, role: Role, slip: NumberSlip<'a> },
    /// A slip in a `let` or `dotimes`.
    Binding(BindingSlip<'a>),
    /// A slip in a body.
    Body(BodySlip<'a>),
    /// A slip among the declarations.
    Declaration(DeclarationSlip<'a>),
    /// A slip in a definition.
    Definition(DefinitionSlip<'a>),
    /// A slip in a `label` or `between`.
    Label(LabelSlip<'a>),
    /// A slip among the keywords of a form.
    Keyword(KeywordSlip<'a>),
}

/// What belongs in a place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Expected {
    NumberName,
    ClassName,
    Superclasses,
    Superclass,
    Slots,
    ClassOption,
    SlotName,
    SlotOption,
    Documentation,
    Type,
    PackageName,
    PackageOption,
    PackageKeyword,
    LocalNickname,
    Designator,
    ProgramName,
    Parameter,
    Binding,
    /// A list, where there is a keyword.
    List,
    /// Nothing more in `(primitive)`.
    EndOfPrimitive,
    EndOfBetween,
    LabelName,
    Event,
    /// A label or a program.
    Occurrence,
    TeamName,
    /// `(agent ...)` or `(link ...)`.
    PartOfTeam,
    /// One end of a link.
    AgentOfLink,
    /// The agent after `:observed-by`.
    Observer,
}

/// What is missing in a form.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Missing {
    NameAndNumber,
    PartsOfClass,
    PackageName,
    PackageToEnter,
    ProgramName,
    Duration,
    PartsOfLet,
    BodyOfLet,
    PartsOfDotimes,
    BodyOfDotimes,
    LabelName,
    Labelled,
    Wait,
    Constraint,
    Constrained,
    /// The parts of a `between`.
    Between,
    SecondEvent,
    ConstraintBetween,
    PartsOfTeam,
    /// Both ends of a link.
    Linked,
    /// The agent of a `with-agent`, or its body.
    PartsOfWithAgent,
    /// The one agent of an `(agent ...)`.
    Agent,
}

/// What may be given once.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Twice<'a> {
    Duration,
    Agent,
    Keyword(&'a str),
}

/// What a name may be for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Named {
    Program,
    Parameter,
    /// A name of a `let`.
    Variable,
    Label,
}

/// What is wrong with a condition.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ConditionSlip<'a> {
    /// This is none.
    No(&'a Form),
    /// What this compares is no slot.
    NoSlot(&'a str),
    /// This has the wrong number of parts.
    Parts(&'a str),
    /// Neither `at :start`, `at :end` nor `over :all`.
    Time { word: &'a str, near: Option<&'static str> },
}

/// What stands in the place of a number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum NumberSlip<'a> {
    /// Something else altogether.
    Other,
    /// `"15"`.
    Quoted(&'a str),
    /// `1:30`.
    Clock(u32, u32),
    /// `15s`.
    Suffixed(Suffixed<'a>),
    /// `5-10`, where two numbers belong.
    Range(&'a str, &'a str),
    /// `(5 + 3)`.
    Infix { left: &'a Form, operator: &'a Form, right: &'a Form },
    /// A calculation with too few numbers, or too many.
    Count { of: Calculation<'a>, given: usize },
    /// `(min 5)`.
    Min(&'a Form),
    /// A word that is no unit and no arithmetic.
    Unit { word: &'a str, near: Option<&'a str> },
    /// A number that would have to be rounded.
    NotExact(&'a str),
    /// More than a duration can be.
    TooLarge,
}

/// A number with something right behind it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Suffixed<'a> {
    /// `15s`.
    Seconds(&'a str),
    /// `5min` and the like.
    Unit(&'static str, &'a str),
    /// `250ms`.
    Milliseconds(&'a str),
    /// `5-10`.
    Range(&'a str, &'a str),
}

/// What takes numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Calculation<'a> {
    Arithmetic(Operator),
    Unit(&'a str),
}

/// What is wrong with names for values and repetitions.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BindingSlip<'a> {
    /// `(let (x 5) ...)`: the name, and both of them if that is all.
    BarePair { name: Span, both: Option<Span> },
    /// `(let x 5 ...)`: what is no list, and it with its value.
    NoNames { found: &'a Form, both: Option<Span> },
    /// `(dotimes (3 i) ...)`: both, if they can change places.
    CountFirst { head: &'a Form, swapped: Option<[Span; 2]> },
    /// `(dotimes i 3 ...)`: what is no list, and it with its number.
    NoCount { head: &'a Form, both: Option<Span> },
}

/// What is wrong with body forms.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BodySlip<'a> {
    /// It is no list.
    NoList { found: &'a Form },
    /// `drive(5)`.
    CallElsewhere { name: &'a Form, arguments: &'a Form },
    /// `declare`, which is no body form.
    Declare { at: Span },
    /// `((shower))`.
    Parentheses { form: Span, inner: &'a Form },
    /// `((shower) (breakfast))`.
    NoSequence { first: &'a Form },
    /// `(:slack t)` in the place of a form.
    Options { found: &'a Form },
    /// `("shower")`.
    Quoted { found: &'a Form, name: &'a str },
    /// It begins neither with an operator nor with a name.
    NoCall { found: &'a Form },
    /// `(sequence :slack t ...)`: the keyword, it with its value, and the operator.
    BareOptions { keyword: Span, all: Span, operator: &'a str },
    /// The constraint after the body, which is this if it is one form.
    ConstraintLast { constraint: Span, body: Option<Span> },
    /// `:upper-bound 5` without `simple-temporal`.
    BareBounds { given: &'a [Form] },
    /// What is no constraint, though perhaps called nearly like one.
    NoConstraint { found: &'a Form, near: Option<&'static str> },
    /// `(delay (simple-temporal ...))`.
    WaitInForm { at: Span, delay: Span, bounds: Option<[Option<&'a Form>; 2]> },
    /// `(delay :lower-bound 5)`.
    WaitByKeywords { at: Span, delay: Span, bounds: Option<[Option<&'a Form>; 2]> },
    /// `(delay 1 2 3)`.
    WaitCount { at: Span, given: usize },
}

/// What is wrong with declarations.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DeclarationSlip<'a> {
    /// A word that begins none.
    Unknown { at: Span, word: &'a str, near: Option<&'static str> },
    /// Something else than a list; the word of a declaration, if it is one.
    NoList { found: &'a Form, word: Option<&'a str> },
    /// Declarations without their `declare`: the word of the first, and all of them.
    Bare { first: Span, all: Span },
    /// A `requires` or `effect` with none or several conditions.
    Conditions { at: Span, word: &'a str },
    /// The second of them.
    SecondConditions { at: Span, word: &'a str },
    /// A keyword behind the duration; that, and the list in it that the keyword belongs to.
    FallenOut { keyword: Span, meant: &'static str, value: Option<&'a Form>, from: Option<(Span, Span)> },
    /// `:contingent t` inside of `simple`.
    TooFarIn { keyword: Span, value: &'a Form, simple: Span },
    /// A bound behind the `)` of `simple`, and where the last of those bounds ends.
    ClosedEarly { keyword: Span, word: &'a str, simple: Span, last: Option<Span> },
    /// Something else than `(simple ...)`, perhaps by a word that is nearly the right one.
    NoSimple { found: &'a Form, near: Option<&'static str> },
    /// `(duration 5 10)`: the bounds, and all of it if nothing else is there.
    BareNumbers { found: &'a Form, bounds: [&'a Form; 2], all: Option<Span> },
    /// `(duration simple :lower-bound 5)` and `(duration :lower-bound 5)`: the bounds, and where they end.
    BareBounds { first: &'a Form, rest: &'a [Form], last: Option<Span> },
}

/// What is wrong with definitions.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DefinitionSlip<'a> {
    /// A body form or a call at the top level.
    BodyOutside { at: Span, word: &'a str },
    /// A declaration at the top level.
    DeclarationOutside { at: Span, word: &'a str },
    /// Something that does not even begin with a word.
    No { found: &'a Form },
    /// A word that begins no definition.
    Unknown { form: &'a Form, word: &'a str, near: Option<&'static str> },
    /// A word of another language.
    Foreign { form: &'a Form, word: &'a str, instead: Instead },
    /// A name that is no plain one: the parameters that are with it, and whether there is a list of them besides.
    DressedName { found: &'a Form, plain: &'a str, heading: Option<&'a [Form]>, listed: bool },
    /// No list of parameters.
    NoParameters { name: &'a Ident },
}

/// What is wrong with labels and events.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LabelSlip<'a> {
    /// `(start)`.
    OfNothing { event: Span, word: &'a str },
    /// `(start drive 1)`: what begins with a name has arguments.
    Arguments { event: &'a Form, side: &'a str, name: &'a str, all: Span },
    /// `(begin drive)`.
    NoSide { at: Span, word: &'a str, near: Option<&'static str> },
    /// `drive:end` and `end-drive`.
    Joined { event: &'a Form, side: &'a str, name: &'a str, outside: bool },
    /// `drive`.
    WhichSide { event: &'a Form, name: &'a str },
}

/// What is wrong with keywords and their values.
#[derive(Clone, Copy, Debug)]
pub(crate) enum KeywordSlip<'a> {
    /// The colon is missing.
    NoColon { at: Span, word: &'a str },
    /// It is the last thing there is.
    NoValue { at: Span, word: &'a str, flag: bool },
    /// Neither `t` nor `nil`.
    NoFlag { found: &'a Form, keyword: &'a str, near: Option<&'static str> },
    /// The form has no such keyword: what may be meant, and what of that is worth writing.
    Unknown { at: Span, word: &'a str, owner: Owner<'a>, near: &'a [&'a str], cures: &'a [&'a str] },
    /// Something stands where a keyword belongs.
    NoKeyword { found: &'a Form, owner: Owner<'a>, is: Stray<'a> },
}

/// A form with keywords.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owner<'a> {
    /// What it begins with.
    pub(crate) word: &'a str,
    /// The keywords.
    pub(crate) known: &'a [&'a str],
}

/// What stands where a keyword belongs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stray<'a> {
    Other,
    /// `5 minutes`.
    Unit {
        number: &'a Form,
        unit: &'a str,
    },
    /// A call after a value.
    Call,
    /// A number after a value, and the bound it may be.
    Bound(&'static str),
    /// Numbers alone, as bounds, and all of them if there are no more.
    Bounds {
        bounds: [&'a Form; 2],
        all: Option<Span>,
    },
}
