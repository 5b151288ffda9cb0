//! Where the constraints of a network come from, and how to speak of them: of a program its forms, of a network file its entries.

use kirk_network::{Bound, ContingentLink, Delay, Duration, EventId, Network, Part, Requirement, SourceMap};

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
    /// What it is about: an activity, a form, or from where to where it reaches.
    pub subject: String,
    /// The event at its end, in words.
    pub end: String,
    /// What a user may call it: names of what it is about, and of an entry of a file its number.
    pub names: Vec<String>,
    /// Where the lower and the upper bound are written, and the shortest and the longest delay.
    pub places: [Span; 4],
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
        match (self.kind, self.subject.strip_prefix("this ")) {
            (OriginKind::Between | OriginKind::Requirement | OriginKind::Link, _) => self.subject.clone(),
            (_, Some(form)) => format!("for the {form}"),
            (_, None) => format!("for {}", self.subject),
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
            let subject = format!("from `{}` to `{}`", label(from), label(to));
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
            let (place, end) = (span(Part::LinkUpper(index)), format!("`{}`", label(link.to)));
            let subject = format!("from `{}` to {end}", label(link.from));
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
            Origin { span: place, text, kind: OriginKind::Link, subject, end, names, places: [place; 4] }
        };
        Origins {
            requirements: network.requirements().iter().enumerate().map(requirement).collect(),
            contingents: network.contingents().iter().enumerate().map(link).collect(),
        }
    }

    /// Where a bound comes from, and which of its places says it; `None` for what is no bound.
    pub fn of(&self, part: Part) -> Option<(&Origin, usize)> {
        match part {
            Part::RequirementLower(index) => Some((self.requirements.get(index)?, 0)),
            Part::RequirementUpper(index) => Some((self.requirements.get(index)?, 1)),
            Part::LinkLower(index) => Some((self.contingents.get(index)?, 0)),
            Part::LinkUpper(index) => Some((self.contingents.get(index)?, 1)),
            Part::DelayMin(index) => Some((self.contingents.get(index)?, 2)),
            Part::DelayMax(index) => Some((self.contingents.get(index)?, 3)),
            Part::AfterOrigin | Part::Join(_) => None,
        }
    }
}
