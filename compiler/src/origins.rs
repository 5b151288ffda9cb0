//! Where the constraints of a network come from: of a program its forms, of a network file its entries. How they are spoken of is
//! in `wording/origins.rs`.

use kirk_network::{Bound, ContingentLink, Delay, EventId, Network, Part, Requirement, SourceMap};

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

/// Where a constraint comes from, and what it says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The form that says so.
    pub span: Span,
    /// What kind of constraint it is.
    pub kind: OriginKind,
    /// What it says.
    pub says: Statement,
    /// What it is about.
    pub subject: Subject,
    /// What a user may call it: names of what it is about, and of an entry of a file its number.
    pub names: Vec<String>,
    /// Where the lower and the upper bound are written, and the shortest and the longest delay.
    pub places: [Span; 4],
}

/// What a constraint says of what it is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// How much time passes; and of what Nature decides, how late the news of its end is.
    Passes {
        /// At least so much.
        least: Bound,
        /// At most so much.
        most: Bound,
        /// So late, if it is not heard of at once.
        news: Option<Delay>,
    },
    /// A part starts when it starts, or after that.
    Starts(Subject),
    /// A part ends when it ends, or before that.
    Ends(Subject),
    /// The first of its parts starts when the second ends, or after that.
    Follows(Subject, Subject),
    /// It ends when its last part ends, or after that.
    Closes(Subject),
    /// It has no parts and takes no time.
    Empty,
}

/// What a constraint is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// An activity, or a form with a label, by its name.
    Named(String),
    /// A form without a name, by its word.
    Form(&'static str),
    /// What lies between two events.
    Reach(Box<[Point; 2]>),
}

/// An event, as an author knows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Point {
    /// The start of something.
    Start(Subject),
    /// The end of something.
    End(Subject),
    /// An event of a file.
    Event(String),
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
}

impl Origins {
    /// Those of a network that was read from a file.
    pub fn of_network(network: &Network, places: &SourceMap) -> Origins {
        let span = |part: Part| places.of(part).map_or(Span::default(), |at| Span::new(0, at.start, at.end));
        let origin = |kind, says, number: String, (from, to): (EventId, EventId), parts: [Part; 2]| {
            let [lower, upper] = parts.map(span);
            let [from, to] = [from, to].map(|event| network.label(event).to_string());
            let names = vec![number, from.clone(), to.clone()];
            let subject = Subject::Reach(Box::new([Point::Event(from), Point::Event(to)]));
            Origin { span: lower, kind, says, subject, names, places: [lower, upper, lower, upper] }
        };
        let requirement = |(index, requirement): (usize, &Requirement)| {
            let Requirement { from, to, lower: least, upper: most } = *requirement;
            let says = Statement::Passes { least, most, news: None };
            let parts = [Part::RequirementLower(index), Part::RequirementUpper(index)];
            origin(OriginKind::Requirement, says, format!("requirements[{index}]"), (from, to), parts)
        };
        let link = |(index, link): (usize, &ContingentLink)| {
            let ContingentLink { from, to, lower, upper, delay } = *link;
            let news = (delay != Delay::NONE).then_some(delay);
            let says = Statement::Passes { least: lower.into(), most: upper.into(), news };
            let parts = [Part::LinkLower(index), Part::LinkUpper(index)];
            origin(OriginKind::Link, says, format!("contingents[{index}]"), (from, to), parts)
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
        let requirement = part.requirement().and_then(|index| self.requirements.get(index));
        requirement.or(part.link().and_then(|index| self.contingents.get(index)))
    }
}
