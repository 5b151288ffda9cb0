//! How the origins of constraints are spoken of: what they are about, and what they say.

use std::fmt;

use kirk_network::{Bound, Delay};

use crate::origins::{Origin, OriginKind, Point, Side, Statement, Subject};

impl Subject {
    /// What to call it where it does not stand: "`drive`", "the `sequence`".
    pub fn elsewhere(&self) -> String {
        match self {
            Subject::Form(word) => format!("the `{word}`"),
            _ => self.to_string(),
        }
    }

    /// What to call it in a sentence about the form around it.
    fn inside(&self) -> String {
        match self {
            Subject::Form(word) => format!("the `{word}` inside"),
            _ => self.to_string(),
        }
    }
}

/// What to call it where it stands: "`drive`", "this `sequence`", "from the start of `a` to the end of `b`".
impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Subject::Named(name) => write!(f, "`{name}`"),
            Subject::Form(word) => write!(f, "this `{word}`"),
            Subject::Reach(ends) => write!(f, "from {} to {}", ends[0], ends[1]),
        }
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Point::Start(subject) => write!(f, "the start of {}", subject.elsewhere()),
            Point::End(subject) => write!(f, "the end of {}", subject.elsewhere()),
            Point::Event(name) => write!(f, "`{name}`"),
        }
    }
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
}

impl Origin {
    /// What it says, as part of a sentence where it stands.
    pub fn text(&self) -> String {
        let Origin { kind, says, .. } = self;
        match says {
            Statement::Starts(part) | Statement::Ends(part) if *kind == OriginKind::SideBySide => {
                let verb = if matches!(says, Statement::Starts(_)) { "starts" } else { "ends" };
                format!("{} {verb} together with the others here (no slack)", part.inside())
            }
            _ => self.sentence(Subject::inside, Subject::to_string),
        }
    }

    /// The same where it does not stand.
    pub(crate) fn told_elsewhere(&self) -> String {
        self.sentence(Subject::elsewhere, Subject::elsewhere)
    }

    fn sentence(&self, part: fn(&Subject) -> String, whole: fn(&Subject) -> String) -> String {
        let Origin { kind, says, subject, .. } = self;
        let (is_order, whole) = (*kind == OriginKind::Order, whole(subject));
        let after = if is_order { "after" } else { "when" };
        let no_slack = if is_order { "" } else { " (no slack)" };
        match says {
            Statement::Passes { least, most, news } => self.passes(*least, *most, *news),
            Statement::Starts(it) if *kind == OriginKind::SideBySide => {
                format!("{} starts when {whole} starts{no_slack}", part(it))
            }
            Statement::Ends(it) if *kind == OriginKind::SideBySide => {
                format!("{} ends when {whole} ends{no_slack}", part(it))
            }
            Statement::Starts(it) => format!("{} starts {after} {whole} starts", part(it)),
            Statement::Ends(it) => format!("{} ends before {whole} ends", part(it)),
            Statement::Follows(it, first) => {
                format!("{} starts {after} {} ends{no_slack}", part(it), part(first))
            }
            Statement::Closes(it) => format!("{whole} ends {after} {} ends", part(it)),
            Statement::Empty => format!("{whole} is empty and takes no time"),
        }
    }

    fn passes(&self, least: Bound, most: Bound, news: Option<Delay>) -> String {
        let Origin { kind, subject, .. } = self;
        let range = range(least, most);
        match (kind, subject) {
            (OriginKind::Between, _) => format!("{range} {subject}"),
            (OriginKind::Constraint, _) => format!("this takes {range} from start to end"),
            (OriginKind::Requirement, Subject::Reach(ends))
                if (least, most) == (Bound::ZERO, Bound::ZERO) =>
            {
                format!("{} and {} are one event", ends[0], ends[1])
            }
            (OriginKind::Requirement, _) => format!("{} {subject}", entry(least, most)),
            (OriginKind::Link, _) => {
                let news = news.map(|Delay { min, max }| {
                    let most = max.finite().map_or("any time".to_string(), |max| format!("{max} s"));
                    format!(", and its news comes {min} s to {most} later")
                });
                let range = entry(least, most);
                format!("{range} {subject}, Nature decides{}", news.unwrap_or_default())
            }
            (OriginKind::Contingent, _) => {
                let news = news.map(|delay| self::range(delay.min.into(), delay.max));
                let news = news.map(|late| format!(", and the news of its end comes {late} later"));
                format!("{subject} takes {range}, Nature decides{}", news.unwrap_or_default())
            }
            _ => format!("{subject} takes {range}"),
        }
    }

    /// What it is about, as the end of a sentence: "for `drive`", "from the start of `a` to the end of `b`".
    pub fn about(&self) -> String {
        match &self.subject {
            Subject::Reach(_) => self.subject.to_string(),
            subject => format!("for {}", subject.elsewhere()),
        }
    }

    /// From where to where it reaches the other way round.
    pub(crate) fn back(&self) -> String {
        match &self.subject {
            Subject::Reach(ends) => format!("from {} to {}", ends[1], ends[0]),
            subject => {
                let name = subject.elsewhere();
                format!("from the end of {name} to its start")
            }
        }
    }

    /// From where to where a requirement of a file reaches the other way round: what is said of it with a negative bound, people
    /// say with a positive one from the later event to the earlier.
    pub(crate) fn reversed(&self) -> Option<String> {
        match (self.kind, &self.subject) {
            (OriginKind::Requirement, Subject::Reach(ends)) => {
                Some(format!("from {} to {}", ends[1], ends[0]))
            }
            _ => None,
        }
    }

    /// The event at its end: "the end of `drive`".
    pub fn end(&self) -> String {
        match &self.subject {
            Subject::Reach(ends) => ends[1].to_string(),
            subject => format!("the end of {subject}"),
        }
    }
}

/// How much time passes, as an entry of a file says it: `15 to 20 s`.
fn entry(least: Bound, most: Bound) -> String {
    match (least, most) {
        (Bound::Infinite, Bound::Infinite) => "any time".to_string(),
        (Bound::Finite(least), Bound::Infinite) => format!("at least {least} s"),
        (Bound::Infinite, Bound::Finite(most)) => format!("at most {most} s"),
        (Bound::Finite(least), Bound::Finite(most)) => format!("{least} to {most} s"),
    }
}

/// The same as a form says it, of which nothing is below zero.
fn range(least: Bound, most: Bound) -> String {
    match (least, most) {
        (least, Bound::Finite(most)) if least == Bound::Finite(most) => format!("{most} s"),
        (Bound::ZERO, most) => entry(Bound::Infinite, most),
        _ => entry(least, most),
    }
}
