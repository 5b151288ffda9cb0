//! What is said of the bounds that are written, and of changes of them.

use kirk_network::{Bound, Duration, Part};

use crate::origins::{Origin, OriginKind};
use crate::repair::{ChangeKind, Changed, Loosening, Unit};

impl Changed {
    /// What it is, as part of a sentence: "at most 45 s instead of 40 s for `drive`".
    pub fn title(&self) -> String {
        match self.change {
            ChangeKind::Amount { part, from, to, unit } => {
                // A shortest delay follows a longest one that becomes less.
                let also = if self.edits.len() > 1 { ", and its shortest delay with it" } else { "" };
                amount(part, (from, to), &self.origin, unit) + also
            }
            ChangeKind::Loosened(Loosening::Slack) => {
                format!("slack (`:slack t`) in {}", self.origin.subject.elsewhere())
            }
            ChangeKind::Loosened(Loosening::Order) => format!("without the order {}", self.origin.subject),
        }
    }

    /// What is changed: "how long `drive` takes".
    pub fn what(&self) -> String {
        match self.change {
            ChangeKind::Amount { part, .. } => what(part, &self.origin).unwrap_or_default(),
            ChangeKind::Loosened(Loosening::Slack) => {
                format!("the slack of {}", self.origin.subject.elsewhere())
            }
            ChangeKind::Loosened(Loosening::Order) => self.origin.text(),
        }
    }
}

fn amount(part: Part, (from, to): (Bound, Bound), origin: &Origin, unit: Unit) -> String {
    let is_lower = matches!(part, Part::RequirementLower(_));
    if let (Some(reversed), Some(from), Some(to)) = (origin.reversed(), from.finite(), to.finite())
        && from.max(to) <= Duration::ZERO
    {
        let word = if is_lower { "at most" } else { "at least" };
        return format!("{word} {} instead of {} {reversed}", unit.say(-to), unit.say(-from));
    }
    let of = origin.about();
    let Some(to) = to.finite() else { return format!("no bound {of}") };
    let to = unit.say(to);
    let instead = from.finite().map_or(String::new(), |from| format!(" instead of {}", unit.say(from)));
    match part {
        Part::LinkLower(_) => format!("Nature taking at least {to}{instead} {of}"),
        Part::LinkUpper(_) => format!("Nature taking at most {to}{instead} {of}"),
        Part::DelayMin(_) | Part::DelayMax(_) => format!("news of {} within {to}{instead}", origin.end()),
        _ => format!("{} {to}{instead} {of}", if is_lower { "at least" } else { "at most" }),
    }
}

/// What a bound is about; `None` for what nobody wrote.
pub fn what(part: Part, origin: &Origin) -> Option<String> {
    let Origin { subject, kind, names, .. } = origin;
    let text = match (kind, part) {
        (_, Part::DelayMin(_) | Part::DelayMax(_)) => format!("how late {} is heard", origin.end()),
        (OriginKind::Between | OriginKind::Requirement, _) => subject.to_string(),
        (OriginKind::Link, _) => format!("{subject}, Nature decides"),
        (OriginKind::Contingent, _) => format!("how long {subject} takes, Nature decides"),
        (OriginKind::Duration | OriginKind::Constraint, _) => format!("how long {subject} takes"),
        _ => return None,
    };
    // Entries of a file have no name but their number.
    Some(match names.first().filter(|_| matches!(kind, OriginKind::Requirement | OriginKind::Link)) {
        Some(number) => format!("{number}: {text}"),
        None => text,
    })
}
