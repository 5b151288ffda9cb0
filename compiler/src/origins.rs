//! Where the constraints of a network come from, and how to speak of them: of a program its forms, of a network file its entries.

use std::fmt;

use kirk_network::{Bound, ContingentLink, Delay, Duration, EventId, Network, Part, Requirement, SourceMap};

use serde::Serialize;

use crate::source::Span;

/// Where the constraints of a network come from.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// For each requirement of the network.
    pub requirements: Vec<Origin>,
    /// For each contingent link of the network.
    pub contingents: Vec<Origin>,
}

/// Where a constraint comes from.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The form that says so.
    pub span: Span,
    /// What it says, as part of a sentence.
    pub text: String,
    /// What kind of constraint it is.
    pub kind: OriginKind,
    /// What it is about.
    pub subject: Subject,
    /// The event at its end, in words.
    pub end: String,
    /// What a user may call it: names of what it is about, and of an entry of a file its number.
    pub names: Vec<String>,
    /// Where the lower and the upper bound are written, and the shortest and the longest delay.
    pub places: [Span; 4],
}

/// What a constraint is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// An activity, by its name.
    Named(String),
    /// A form without a name, by its word.
    Form(&'static str),
    /// What lies between two events: "from `a` to `b`".
    Reach(String),
}

impl Subject {
    /// What to call it where it does not stand: "`drive`", "the `sequence`".
    pub fn elsewhere(&self) -> String {
        match self {
            Subject::Form(word) => format!("the `{word}`"),
            _ => self.to_string(),
        }
    }
}

/// What to call it where it stands: "`drive`", "this `sequence`".
impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Subject::Named(name) => write!(f, "`{name}`"),
            Subject::Form(word) => write!(f, "this `{word}`"),
            Subject::Reach(reach) => f.write_str(reach),
        }
    }
}

/// Which amount of a constraint a bound is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The least of a duration.
    Lower,
    /// The longest delay of news.
    MaxDelay,
    /// The shortest delay of news.
    MinDelay,
    /// The most of a duration.
    Upper,
}

impl Side {
    /// It as the end of a sentence about what it bounds.
    pub fn word(self) -> &'static str {
        match self {
            Side::Lower => "at least",
            Side::MaxDelay => "maximum",
            Side::MinDelay => "minimum",
            Side::Upper => "at most",
        }
    }

    /// `None` for what has no bound.
    pub fn of(part: Part) -> Option<Side> {
        Some(match part {
            Part::RequirementLower(_) | Part::LinkLower(_) => Side::Lower,
            Part::RequirementUpper(_) | Part::LinkUpper(_) => Side::Upper,
            Part::DelayMin(_) => Side::MinDelay,
            Part::DelayMax(_) => Side::MaxDelay,
            Part::AfterOrigin | Part::Join(_) => return None,
        })
    }
}

/// The kinds of constraints there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OriginKind {
    /// How long an activity takes, as we decide.
    Duration,
    /// How long an activity takes, as Nature decides.
    Contingent,
    /// `with-temporal-constraint`.
    Constraint,
    /// Two events at the same time, one after the other.
    Join,
    /// Two events at the same time, as the parts of a `parallel` start or end together.
    SideBySide,
    /// Two events at the same time, as there is nothing between them.
    Empty,
    /// Two events one after the other.
    Order,
    /// `between`.
    Between,
    /// A requirement of a network file.
    Requirement,
    /// A contingent link of a network file.
    Link,
}

impl OriginKind {
    /// True if two events are at the same time because of the form they are in.
    pub fn is_join(self) -> bool {
        matches!(self, OriginKind::Join | OriginKind::SideBySide | OriginKind::Empty)
    }

    /// True if somebody has written an amount.
    pub fn is_amount(self) -> bool {
        !self.is_join() && self != OriginKind::Order
    }
}

impl Origin {
    /// What it is about, as the end of a sentence: "for `drive`", "from the start of `a` to the end of `b`".
    pub fn about(&self) -> String {
        match &self.subject {
            Subject::Reach(reach) => reach.clone(),
            subject => format!("for {}", subject.elsewhere()),
        }
    }

    /// Where one of its amounts is written.
    pub fn place(&self, side: Side) -> Span {
        let [lower, upper, min_delay, max_delay] = self.places;
        match side {
            Side::Lower => lower,
            Side::Upper => upper,
            Side::MinDelay => min_delay,
            Side::MaxDelay => max_delay,
        }
    }

    /// From where to where a requirement of a file reaches the other way round: what is said of it with a negative bound, people
    /// say with a positive one from the later event to the earlier.
    pub(crate) fn reversed(&self) -> Option<String> {
        match (self.kind, &self.names[..]) {
            (OriginKind::Requirement, [_, from, to]) => Some(format!("from `{to}` to `{from}`")),
            _ => None,
        }
    }
}

impl Origins {
    /// Those of a network that was read from a file.
    pub fn of_network(network: &Network, places: &SourceMap) -> Origins {
        let label = |event: EventId| network.label(event);
        let span = |part: Part| places.of(part).map_or(Span::default(), |at| Span::new(0, at.start, at.end));
        let requirement = |(index, requirement): (usize, &Requirement)| {
            let Requirement { from, to, lower, upper } = *requirement;
            let [lower_place, upper_place] =
                [Part::RequirementLower(index), Part::RequirementUpper(index)].map(span);
            let zero = Bound::Finite(Duration::ZERO);
            let subject = Subject::Reach(format!("from `{}` to `{}`", label(from), label(to)));
            let text = match (lower, upper) {
                (lower, upper) if lower == zero && upper == zero => {
                    format!("`{}` and `{}` are one event", label(from), label(to))
                }
                (Bound::Infinite, Bound::Infinite) => format!("any time {subject}"),
                (Bound::Finite(least), Bound::Infinite) => format!("at least {least} s {subject}"),
                (Bound::Infinite, Bound::Finite(most)) => format!("at most {most} s {subject}"),
                (Bound::Finite(least), Bound::Finite(most)) => format!("{least} to {most} s {subject}"),
            };
            Origin {
                span: lower_place,
                text,
                kind: OriginKind::Requirement,
                subject,
                end: format!("`{}`", label(to)),
                names: vec![format!("requirements[{index}]"), label(from).to_string(), label(to).to_string()],
                places: [lower_place, upper_place, lower_place, upper_place],
            }
        };
        let link = |(index, link): (usize, &ContingentLink)| {
            let end = format!("`{}`", label(link.to));
            let [lower_place, upper_place] = [Part::LinkLower(index), Part::LinkUpper(index)].map(span);
            let subject = Subject::Reach(format!("from `{}` to {end}", label(link.from)));
            let mut text = format!("{} to {} s {subject}, Nature decides", link.lower, link.upper);
            if link.delay != Delay::NONE {
                let most = link.delay.max.finite().map_or("any time".to_string(), |max| format!("{max} s"));
                text.push_str(&format!(", and its news comes {} s to {most} later", link.delay.min));
            }
            let names = vec![
                format!("contingents[{index}]"),
                label(link.from).to_string(),
                label(link.to).to_string(),
            ];
            let places = [lower_place, upper_place, lower_place, upper_place];
            Origin { span: lower_place, text, kind: OriginKind::Link, subject, end, names, places }
        };
        Origins {
            requirements: network.requirements().iter().enumerate().map(requirement).collect(),
            contingents: network.contingents().iter().enumerate().map(link).collect(),
        }
    }

    /// Where a bound comes from, and which of its amounts it is; `None` for what is no bound.
    pub fn of(&self, part: Part) -> Option<(&Origin, Side)> {
        Some((self.constraint(part)?, Side::of(part)?))
    }

    /// Where the constraint comes from that something is a part of; `None` for what goes without saying.
    pub fn constraint(&self, part: Part) -> Option<&Origin> {
        match part {
            Part::RequirementLower(index) | Part::RequirementUpper(index) | Part::Join(index) => {
                self.requirements.get(index)
            }
            Part::LinkLower(index)
            | Part::LinkUpper(index)
            | Part::DelayMin(index)
            | Part::DelayMax(index) => self.contingents.get(index),
            Part::AfterOrigin => None,
        }
    }
}
