//! The program with every name resolved and every bound checked: what `expand` unfolds.

use kirk_network::{Bound, Duration};

use crate::ast::{Condition, Ident, Value};
use crate::source::Span;

/// All programs, and the one to start from.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The programs; calls refer to them by position.
    pub programs: Vec<Program>,
    /// The program to start from.
    pub entry: Option<usize>,
}

/// A control program.
#[derive(Clone, Debug)]
pub struct Program {
    /// Its name and where it is defined.
    pub name: Ident,
    /// Its parameters.
    pub parameters: Vec<Ident>,
    /// What it does.
    pub work: Work,
    /// What has to hold.
    pub requires: Option<Condition>,
    /// What it brings about.
    pub effect: Option<Condition>,
}

/// What a program does.
#[derive(Clone, Debug)]
pub enum Work {
    /// It takes time.
    Primitive(Timing),
    /// It does these one after the other.
    Body(Vec<Body>),
}

/// How long a primitive program takes.
#[derive(Clone, Debug)]
pub struct Timing {
    /// From start to end.
    pub bounds: Bounds,
    /// True if Nature decides.
    pub contingent: bool,
    /// How early and late the news of the end may be.
    pub delay: Bounds,
}

/// An interval of durations, with places for messages.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// The least, and where it is written.
    pub lower: Amount,
    /// The most, and where it is written.
    pub upper: Amount,
    /// The form that says so.
    pub span: Span,
}

/// A duration, known or given by a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Amount {
    /// Its value.
    pub value: AmountValue,
    /// Where it is written, or should be.
    pub span: Span,
}

/// What is known of a duration before programs are unfolded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmountValue {
    /// Its value; `Infinite` only where no upper bound is given.
    Known(Bound),
    /// The argument in this place.
    Parameter(usize),
    /// It was wrong, which has been reported.
    Error,
}

/// A form of a body.
#[derive(Clone, Debug)]
pub enum Body {
    /// A call of a program.
    Call {
        /// Its position in the model.
        program: usize,
        /// The arguments.
        arguments: Vec<Argument>,
        /// The form.
        span: Span,
    },
    /// A sequence, or all at once.
    Group {
        /// True for `parallel`.
        parallel: bool,
        /// True if time may pass between the parts.
        slack: bool,
        /// The parts.
        body: Vec<Body>,
        /// The operator.
        operator: Span,
    },
    /// A constraint around a body.
    Within {
        /// From start to end of the body.
        bounds: Bounds,
        /// The body.
        body: Vec<Body>,
        /// The operator.
        operator: Span,
    },
}

/// An argument of a call.
#[derive(Clone, Debug)]
pub enum Argument {
    /// A value.
    Value(Value),
    /// Whatever the calling program was given in this place.
    Parameter(usize),
}

impl AmountValue {
    /// A number known at once.
    pub fn seconds(self) -> Option<Duration> {
        match self {
            AmountValue::Known(bound) => bound.finite(),
            _ => None,
        }
    }
}
