//! The program with every name resolved and every bound checked: what `expand` unfolds.

use kirk_network::{Bound, Duration};

use crate::ast::{Condition, Ident, ValueKind};
use crate::calculate::Operator;
use crate::source::Span;

/// All programs, and the one to start from.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The programs; calls refer to them by position.
    pub programs: Vec<Program>,
    /// The program to start from.
    pub entry: Option<usize>,
    /// Who executes it together, if it is not one alone.
    pub team: Option<Team>,
}

/// A team.
#[derive(Clone, Debug)]
pub struct Team {
    /// Its name.
    pub name: Ident,
    /// Who belongs to it.
    pub agents: Vec<Ident>,
    /// How news travels between them.
    pub links: Vec<Link>,
}

/// A link between two agents.
#[derive(Clone, Debug)]
pub struct Link {
    /// One agent, by its position in the team.
    pub from: usize,
    /// The other.
    pub to: usize,
    /// How long a message takes.
    pub delay: Bounds,
    /// True if messages go from the first to the second only.
    pub one_way: bool,
    /// True if messages say when what they tell of happened.
    pub stamped: bool,
    /// The form.
    pub span: Span,
}

/// A control program.
#[derive(Clone, Debug)]
pub struct Program {
    /// Its name and where it is defined.
    pub name: Ident,
    /// Its parameters.
    pub parameters: Vec<Ident>,
    /// Who executes it, if that is said.
    pub agent: Option<Expression>,
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
    /// Who hears of the end first, if it is not who executes it.
    pub observed_by: Option<Box<Expression>>,
}

/// An interval of durations, with places for messages.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// The least, and where it is written.
    pub lower: Amount,
    /// The most, and where it is written.
    pub upper: Amount,
    /// The form that says so.
    pub span: Span,
}

/// A duration, known or depending on variables.
#[derive(Clone, Debug)]
pub struct Amount {
    /// Its value.
    pub value: AmountValue,
    /// Where it is written, or should be.
    pub span: Span,
}

/// What is known of a duration before programs are unfolded.
#[derive(Clone, Debug)]
pub enum AmountValue {
    /// Its value; `Infinite` only where no upper bound is given.
    Known(Bound),
    /// To be calculated.
    Computed(Box<Expression>),
    /// It was wrong, which has been reported.
    Error,
}

/// A value, as far as it is known before programs are unfolded.
#[derive(Clone, Debug)]
pub struct Expression {
    /// What it is.
    pub kind: ExpressionKind,
    /// Where.
    pub span: Span,
}

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum ExpressionKind {
    /// A value.
    Value(ValueKind),
    /// What a parameter or a name of `let` or `dotimes` stands for: its position, counted from the outside, and its name.
    Variable(usize, String),
    /// So many units of so many microseconds.
    Scaled(i64, Box<Expression>),
    /// Arithmetic.
    Calculated(Operator, Vec<Expression>),
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
        arguments: Vec<Expression>,
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
    /// A wait.
    Delay {
        /// How long.
        bounds: Bounds,
        /// The form.
        span: Span,
    },
    /// The body with these variables added to those around it.
    Let {
        /// What they stand for.
        values: Vec<Expression>,
        /// The body.
        body: Vec<Body>,
    },
    /// The body again and again, with the number of repetitions before as an added variable.
    Repeat {
        /// How many times.
        count: Expression,
        /// Where the variable is written.
        variable: Span,
        /// The body.
        body: Vec<Body>,
        /// The operator.
        operator: Span,
    },
    /// A name for what the body unfolds to.
    Label {
        /// The name.
        name: Ident,
        /// What distinguishes it from others of the name.
        arguments: Vec<Expression>,
        /// The body.
        body: Vec<Body>,
        /// The operator.
        operator: Span,
    },
    /// A constraint between two events.
    Between(Box<Between>),
    /// The body, executed by this agent.
    WithAgent {
        /// Who.
        agent: Expression,
        /// The body.
        body: Vec<Body>,
    },
}

/// What `between` says.
#[derive(Clone, Debug)]
pub struct Between {
    /// Where the interval begins.
    pub from: EventOf,
    /// Where it ends.
    pub to: EventOf,
    /// From the one to the other.
    pub bounds: Bounds,
}

/// The start or the end of something that has a name.
#[derive(Clone, Debug)]
pub struct EventOf {
    /// True for the end.
    pub end: bool,
    /// The name as written.
    pub name: Ident,
    /// The program of this name, if there is one.
    pub program: Option<usize>,
    /// True if the name is that of one occurrence of the program: `a#2`.
    pub is_occurrence: bool,
    /// The arguments, if any are written.
    pub arguments: Option<Vec<Expression>>,
    /// The form.
    pub span: Span,
}

impl Program {
    /// The programs it calls, with the places of the calls, in source order.
    pub fn calls(&self) -> Vec<(usize, Span)> {
        let Work::Body(body) = &self.work else { return Vec::new() };
        let mut found = Vec::new();
        let mut open: Vec<&Body> = body.iter().rev().collect();
        while let Some(body) = open.pop() {
            if let Body::Call { program, span, .. } = body {
                found.push((*program, *span));
            }
            open.extend(body.parts().iter().rev());
        }
        found
    }
}

impl Body {
    /// True if it becomes an episode of its own, and not only what is in it. A label does if it names several forms.
    pub fn is_episode(&self) -> bool {
        match self {
            Body::Call { .. } | Body::Group { .. } | Body::Within { .. } | Body::Delay { .. } => true,
            Body::Let { .. } | Body::Repeat { .. } | Body::WithAgent { .. } | Body::Between(_) => false,
            Body::Label { body, .. } => body.len() != 1,
        }
    }

    /// The forms inside it.
    pub fn parts(&self) -> &[Body] {
        match self {
            Body::Group { body, .. }
            | Body::Within { body, .. }
            | Body::Let { body, .. }
            | Body::Repeat { body, .. }
            | Body::WithAgent { body, .. }
            | Body::Label { body, .. } => body,
            Body::Call { .. } | Body::Delay { .. } | Body::Between(_) => &[],
        }
    }
}

impl AmountValue {
    /// A number known at once.
    pub fn seconds(&self) -> Option<Duration> {
        match self {
            AmountValue::Known(bound) => bound.finite(),
            _ => None,
        }
    }

    /// True if it is known to be this.
    pub fn is(&self, wanted: Bound) -> bool {
        matches!(self, AmountValue::Known(bound) if *bound == wanted)
    }
}
