//! The program unfolded: a tree of episodes, each with a start and an end. Serialised for `--emit episodes`.

use kirk_network::{Bound, Duration};
use serde::Serialize;

use crate::ast::{Condition, ValueKind, seconds};
use crate::source::Span;

/// How many episodes a program may unfold to, internal ones included.
pub const MAX_EPISODES: u64 = 200_000;

/// How deep episodes may be nested in each other.
pub const MAX_DEPTH: u64 = 1_000;

/// One occurrence of a program or of a form of a body, from its start event to its end event.
#[derive(Clone, Debug, Serialize)]
pub struct Episode {
    /// Its name: its events are `name:start` and `name:end`.
    pub name: String,
    /// What it is an occurrence of.
    pub kind: Kind,
    /// True if no user wrote the name.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub internal: bool,
    /// What its parameters stand for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub arguments: Vec<ValueKind>,
    /// True if time may pass between its parts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slack: Option<bool>,
    /// From its start to its end, if something is said about that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<Range>,
    /// True if Nature decides the duration.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub contingent: bool,
    /// How early and late the news of its end may be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay: Option<Range>,
    /// Who executes it: an agent of the team. What joins several is nobody's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agent: Option<String>,
    /// Who hears of its end first, if that is another agent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observed_by: Option<String>,
    /// What has to hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub requires: Option<Box<Condition>>,
    /// What it brings about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effect: Option<Box<Condition>>,
    /// The names a `label` gives it, as far as nothing else has them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<String>,
    /// Its parts, in source order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Episode>,
    /// Of the outermost episode: what `between` says, anywhere in the program.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<Constraint>,
    /// The call or the operator.
    #[serde(skip)]
    pub span: Span,
}

/// What an episode is an occurrence of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A primitive program.
    Primitive,
    /// A program with a body.
    Program,
    /// `sequence`.
    Sequence,
    /// `parallel`.
    Parallel,
    /// `with-temporal-constraint`.
    WithTemporalConstraint,
    /// `delay`.
    Delay,
}

/// What `between` says.
#[derive(Clone, Debug, Serialize)]
pub struct Constraint {
    /// Where the interval begins.
    pub from: EventOf,
    /// Where it ends.
    pub to: EventOf,
    /// From the one to the other.
    pub interval: Range,
}

/// The start or the end of an episode.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct EventOf {
    /// The name of the episode.
    pub episode: String,
    /// True for the end.
    pub end: bool,
}

/// An interval of durations; a list of two when it is serialised, the upper bound null if there is none.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "Vec<Side>")]
pub struct Range {
    /// The least.
    pub lower: Duration,
    /// The most.
    pub upper: Bound,
    /// Where the least is written.
    pub lower_span: Span,
    /// Where the most is written.
    pub upper_span: Span,
    /// The form that says so.
    pub span: Span,
}

impl Kind {
    /// The word a user writes for it.
    pub fn word(self) -> &'static str {
        match self {
            Kind::Primitive | Kind::Program => "program",
            Kind::Sequence => "sequence",
            Kind::Parallel => "parallel",
            Kind::WithTemporalConstraint => "with-temporal-constraint",
            Kind::Delay => "delay",
        }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum Side {
    Finite(#[serde(serialize_with = "seconds")] Duration),
    Infinite,
}

impl From<Range> for Vec<Side> {
    fn from(interval: Range) -> Vec<Side> {
        vec![Side::Finite(interval.lower), interval.upper.finite().map_or(Side::Infinite, Side::Finite)]
    }
}
