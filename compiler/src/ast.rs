//! The program as written: names are not resolved yet. Serialised for `--emit ast`, without the places.

mod serialize;

pub(crate) use serialize::seconds;

use kirk_network::Duration;
use serde::Serialize;

use crate::calculate::Operator;
use crate::source::Span;

/// All definitions, in source order.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Program {
    /// The packages.
    pub packages: Vec<Package>,
    /// The named numbers.
    pub parameters: Vec<NamedNumber>,
    /// The classes of agents and objects.
    pub classes: Vec<Class>,
    /// The team, once for each time that one is defined.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub teams: Vec<Team>,
    /// The control programs.
    pub programs: Vec<ControlProgram>,
}

/// A name as written, in lower case.
#[derive(Clone, Debug)]
pub struct Ident {
    /// The package written before it, if any.
    pub package: Option<String>,
    /// The name.
    pub name: String,
    /// Where.
    pub span: Span,
}

/// `(defpackage ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Package {
    /// Its name.
    pub name: Ident,
    /// The packages whose names it sees.
    pub uses: Vec<Ident>,
    /// Single names it takes from other packages.
    pub imports: Vec<Import>,
    /// Other names of the package itself.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub nicknames: Vec<Ident>,
    /// What it calls other packages, and their names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub local_nicknames: Vec<(Ident, Ident)>,
    /// The names it offers to others. Kirk lets every name be used from everywhere.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub exports: Vec<Ident>,
}

impl Package {
    /// True if this is the name of the package or one of its nicknames.
    pub fn is_called(&self, name: &str) -> bool {
        self.name.name == name || self.nicknames.iter().any(|nickname| nickname.name == name)
    }
}

/// A name that a package takes from another.
#[derive(Clone, Debug)]
pub struct Import {
    /// The other package.
    pub from: Ident,
    /// The name.
    pub name: Ident,
}

/// `(defparameter ...)` or `(defconstant ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct NamedNumber {
    /// The package it belongs to.
    pub home: String,
    /// Its name.
    pub name: Ident,
    /// Its value.
    pub value: Amount,
}

/// `(defclass ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Class {
    /// The package it belongs to.
    pub home: String,
    /// Its name.
    pub name: Ident,
    /// The classes it extends.
    pub supers: Vec<Ident>,
    /// Its slots.
    pub slots: Vec<Slot>,
}

/// A slot of a class.
#[derive(Clone, Debug, Serialize)]
pub struct Slot {
    /// Its name.
    pub name: Ident,
    /// What it may contain.
    #[serde(rename = "type")]
    pub kind: Option<Type>,
    /// The functions that read it.
    pub accessors: Vec<Ident>,
    /// Its value at first.
    pub initform: Option<Value>,
    /// True if it never changes.
    pub finalp: bool,
    /// What it is for.
    pub documentation: Option<String>,
}

/// What a slot may contain.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Type {
    /// One of these values.
    Member(Vec<Value>),
    /// One of these types.
    Or(Vec<Type>),
    /// A type of Lisp or a class.
    Named(Ident),
    /// A type kirk does not check values against.
    Anything,
}

/// `(define-team ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Team {
    /// The package it belongs to.
    pub home: String,
    /// Its name.
    pub name: Ident,
    /// Who belongs to it.
    pub agents: Vec<Ident>,
    /// How news travels between them.
    pub links: Vec<Link>,
    /// The whole definition.
    #[serde(skip)]
    pub span: Span,
}

/// `(link a b :min-delay 5 :max-delay 15)`.
#[derive(Clone, Debug, Serialize)]
pub struct Link {
    /// One agent.
    pub from: Ident,
    /// The other.
    pub to: Ident,
    /// How long a message takes.
    pub delay: Bounds,
    /// True if messages go from the first to the second only.
    pub one_way: bool,
    /// True if messages say when they were sent, by clocks that agree.
    pub stamped: bool,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(define-control-program ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct ControlProgram {
    /// The package it belongs to.
    pub home: String,
    /// Its name.
    pub name: Ident,
    /// Its parameters.
    pub parameters: Vec<Ident>,
    /// What it is for.
    pub documentation: Option<String>,
    /// True if it is declared primitive.
    pub primitive: bool,
    /// The duration declared.
    pub duration: Option<DurationOf>,
    /// Who executes it: an agent of the team, or a parameter that stands for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agent: Option<Ident>,
    /// What has to hold.
    pub requires: Option<Condition>,
    /// What it brings about.
    pub effect: Option<Condition>,
    /// What it does.
    pub body: Vec<Body>,
    /// The whole definition.
    #[serde(skip)]
    pub span: Span,
    /// True if a part of it could not be understood, which has been reported.
    #[serde(skip)]
    pub damaged: bool,
}

/// `(duration (simple ...) :contingent t)`.
#[derive(Clone, Debug, Serialize)]
pub struct DurationOf {
    /// From start to end.
    pub bounds: Bounds,
    /// True if Nature decides.
    pub contingent: bool,
    /// The `nil` of `:contingent nil`.
    #[serde(skip)]
    pub contingent_nil: Option<Span>,
    /// How early and late the news of the end may be, if anything is said about it.
    pub delay: Option<Bounds>,
    /// The agent that hears of the end first, if that is another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observed_by: Option<Ident>,
    /// The declaration.
    #[serde(skip)]
    pub span: Span,
}

/// What two bounds are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limits {
    /// A duration, or the time between two events.
    Duration,
    /// How late the news of an end is.
    ObservationDelay,
    /// A `delay`.
    Wait,
    /// How long a message between agents takes.
    Message,
}

/// What a number is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Lower(Limits),
    Upper(Limits),
    /// Of repetitions.
    Count,
    /// What a name stands for.
    Named,
    /// Part of a calculation.
    Operand,
    Argument,
}

/// An interval of durations.
#[derive(Clone, Debug, Serialize)]
pub struct Bounds {
    /// The least.
    pub lower: Option<Amount>,
    /// The most.
    pub upper: Option<Amount>,
    /// Where it is written.
    #[serde(skip)]
    pub span: Span,
}

/// A duration as written.
#[derive(Clone, Debug)]
pub struct Amount {
    /// Its value.
    pub kind: AmountKind,
    /// Where.
    pub span: Span,
}

/// The ways to write a duration.
#[derive(Clone, Debug)]
pub enum AmountKind {
    /// A number of seconds, or of another unit.
    Number(Duration),
    /// `:infinity`.
    Infinite,
    /// A named number, a parameter, or a name from `let` or `dotimes`.
    Named(Ident),
    /// A unit of so many microseconds: `(minutes x)`.
    Unit(&'static str, i64, Box<Amount>),
    /// `(+ x 1)` and the like.
    Calculation(Operator, Vec<Amount>),
    /// Something that has been reported.
    Error,
}

/// A form of a body.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Body {
    /// `(name arg...)`.
    Call(Call),
    /// `(sequence ...)`.
    Sequence(Group),
    /// `(parallel ...)`.
    Parallel(Group),
    /// `(with-temporal-constraint ...)`.
    WithTemporalConstraint(Within),
    /// `(delay ...)`.
    Delay(Wait),
    /// `(let ...)`.
    Let(Let),
    /// `(dotimes ...)`.
    Dotimes(Dotimes),
    /// `(label ...)`.
    Label(Labelled),
    /// `(between ...)`.
    Between(Box<Between>),
    /// `(with-agent ...)`.
    WithAgent(WithAgent),
}

/// `(name arg...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Call {
    /// The program called.
    pub program: Ident,
    /// What its parameters stand for.
    pub arguments: Vec<Argument>,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// What a parameter or a name of `let` stands for.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Argument {
    /// A value as it is written.
    Value(Value),
    /// A number to calculate.
    Amount(Amount),
}

/// `(delay 5 10)`.
#[derive(Clone, Debug, Serialize)]
pub struct Wait {
    /// How long.
    pub bounds: Bounds,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(let ((x 5)) body...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Let {
    /// The names and what they stand for.
    pub bindings: Vec<(Ident, Argument)>,
    /// True for `let*`: each name is known to those after it.
    pub sequential: bool,
    /// The body.
    pub body: Vec<Body>,
    /// The operator.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(dotimes (i n) body...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Dotimes {
    /// The name that counts from 0.
    pub variable: Ident,
    /// How many times.
    pub count: Amount,
    /// The body.
    pub body: Vec<Body>,
    /// The operator.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(label x form)`.
#[derive(Clone, Debug, Serialize)]
pub struct Labelled {
    /// The name.
    pub name: Ident,
    /// What distinguishes it from others of the name: `(label (confirm i j) ...)`.
    pub arguments: Vec<Argument>,
    /// What it names.
    pub body: Vec<Body>,
    /// The operator.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(with-agent robot body...)`.
#[derive(Clone, Debug, Serialize)]
pub struct WithAgent {
    /// Who executes what is in it and names nobody else.
    pub agent: Ident,
    /// The body.
    pub body: Vec<Body>,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(between (end a) (start b) (simple-temporal ...))`.
#[derive(Clone, Debug, Serialize)]
pub struct Between {
    /// Where the interval begins.
    pub from: EventOf,
    /// Where it ends.
    pub to: EventOf,
    /// From the one to the other.
    pub bounds: Bounds,
    /// The operator.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(start x)`, `(end (confirm i j))`.
#[derive(Clone, Debug, Serialize)]
pub struct EventOf {
    /// True for the end.
    pub end: bool,
    /// A label, or the name of a program.
    pub name: Ident,
    /// Its arguments, if any are written.
    pub arguments: Option<Vec<Argument>>,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(sequence ...)` or `(parallel ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// True if time may pass between the parts.
    pub slack: bool,
    /// The parts.
    pub body: Vec<Body>,
    /// The word `sequence` or `parallel`.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// `(with-temporal-constraint ...)`.
#[derive(Clone, Debug, Serialize)]
pub struct Within {
    /// From start to end of the body.
    pub bounds: Bounds,
    /// The body.
    pub body: Vec<Body>,
    /// The operator.
    #[serde(skip)]
    pub operator: Span,
    /// The form.
    #[serde(skip)]
    pub span: Span,
}

/// A value as written: an argument, or something a slot may contain.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct Value {
    /// What it is.
    pub kind: ValueKind,
    /// Where.
    #[serde(skip)]
    pub span: Span,
}

/// The kinds of values.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueKind {
    /// A number.
    Number(Duration),
    /// A string.
    Text(String),
    /// `t`.
    True,
    /// `nil`.
    Nil,
    /// A keyword, or a quoted symbol.
    Symbol(String),
    /// A name that stands for something.
    Name(Option<String>, String),
    /// Anything else, carried along as it is written.
    Other(String),
}

/// A condition or an effect.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Condition {
    /// All of these.
    And(Vec<Condition>),
    /// One of these.
    Or(Vec<Condition>),
    /// Not this.
    Not(Box<Condition>),
    /// At the start.
    AtStart(Box<Condition>),
    /// At the end.
    AtEnd(Box<Condition>),
    /// All the while.
    OverAll(Box<Condition>),
    /// `(= (accessor object) value)`.
    Equal(SlotOf, Value),
    /// `(accessor object)`.
    Holds(SlotOf),
}

/// `(accessor object)`.
#[derive(Clone, Debug, Serialize)]
pub struct SlotOf {
    /// The accessor.
    pub accessor: Ident,
    /// Whose slot.
    pub object: Value,
}

impl ControlProgram {
    /// How it is called.
    pub fn shape(&self) -> String {
        let parameters = self.parameters.iter().map(|parameter| format!(" {}", parameter.name));
        format!("({}{})", self.name.name, parameters.collect::<String>())
    }
}

impl Argument {
    /// Where it is written.
    pub fn span(&self) -> Span {
        match self {
            Argument::Value(value) => value.span,
            Argument::Amount(amount) => amount.span,
        }
    }
}

impl Body {
    /// Where it is written.
    pub fn span(&self) -> Span {
        match self {
            Body::Call(call) => call.span,
            Body::Sequence(group) | Body::Parallel(group) => group.span,
            Body::WithTemporalConstraint(within) => within.span,
            Body::Delay(wait) => wait.span,
            Body::Let(binding) => binding.span,
            Body::Dotimes(dotimes) => dotimes.span,
            Body::Label(labelled) => labelled.span,
            Body::Between(between) => between.span,
            Body::WithAgent(with) => with.span,
        }
    }

    /// The forms inside it.
    pub fn parts(&self) -> &[Body] {
        match self {
            Body::Sequence(group) | Body::Parallel(group) => &group.body,
            Body::WithTemporalConstraint(within) => &within.body,
            Body::Let(binding) => &binding.body,
            Body::Dotimes(dotimes) => &dotimes.body,
            Body::Label(labelled) => &labelled.body,
            Body::WithAgent(with) => &with.body,
            Body::Call(_) | Body::Delay(_) | Body::Between(_) => &[],
        }
    }
}

impl Ident {
    /// Another name, with the package of this one before it.
    pub fn with_name(&self, name: &str) -> String {
        match &self.package {
            Some(package) => format!("{package}:{name}"),
            None => name.to_string(),
        }
    }
}

impl AmountKind {
    /// True if it could not be read, which has been reported.
    pub fn is_error(&self) -> bool {
        matches!(self, AmountKind::Error)
    }
}
