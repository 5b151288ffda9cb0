//! What helps where no amount does: slack in a form whose parts have to meet, an order less.

use std::collections::BTreeSet;

use kirk_network::check::{Verdict, check};
use kirk_network::least::could_settle;
use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Conflict, Duration, Network, Part, Requirement};

use super::{Changed, Proposal, Wishes, is_called};
use crate::diagnostic::{Edit, Text};
use crate::form::Form;
use crate::origins::{Origin, OriginKind, Origins};
use crate::problem::Problems;
use crate::read::read;
use crate::source::{Source, Span};

/// The forms of a conflict that would settle it if they had slack, and the orders that would if they were left out: slack first.
pub(super) fn proposals(
    network: &Network,
    origins: &Origins,
    sources: &[Source],
    wishes: &Wishes,
) -> Result<Vec<Proposal>, TooLarge> {
    let Verdict::Uncontrollable(conflict) = check(network)? else { return Ok(Vec::new()) };
    let mut found = Vec::new();
    for (loosening, spans) in [
        (Loosening::Slack, joins(&conflict, network, origins)),
        (Loosening::Order, orders(&conflict, network, origins)),
    ] {
        for span in spans {
            let of_form = |origin: &Origin| origin.span == span && loosening.concerns(origin.kind);
            let kept = |origin: &Origin| wishes.keep.iter().any(|name| is_called(origin, name));
            let Some(origin) = origins.requirements.iter().find(|it| of_form(it) && !kept(it)) else {
                continue;
            };
            let loosened = loosened(network, origins, of_form);
            let edit = loosening.edit(span, sources);
            if let (Some(loosened), Some(edit)) = (loosened, edit)
                && check(&loosened)? == Verdict::Controllable
            {
                let (title, what) = loosening.words(origin);
                let changed = Changed { title, what, place: span, amounts: None, edits: vec![edit] };
                found.push(Proposal { changes: vec![changed] });
            }
        }
    }
    Ok(found)
}

#[derive(Clone, Copy)]
enum Loosening {
    Slack,
    Order,
}

impl Loosening {
    fn concerns(self, kind: OriginKind) -> bool {
        match self {
            Loosening::Slack => matches!(kind, OriginKind::Join | OriginKind::SideBySide),
            Loosening::Order => kind == OriginKind::Between,
        }
    }

    fn edit(self, span: Span, sources: &[Source]) -> Option<Edit> {
        match self {
            Loosening::Slack => slack(span, sources),
            Loosening::Order => Some(Edit { span: around(span, sources)?, text: Text::Plain(String::new()) }),
        }
    }

    fn words(self, origin: &Origin) -> (String, String) {
        let Origin { subject, text, .. } = origin;
        let form = subject.elsewhere();
        match self {
            Loosening::Slack => (format!("slack (`:slack t`) in {form}"), format!("the slack of {form}")),
            Loosening::Order => (format!("without the order {subject}"), text.clone()),
        }
    }
}

/// The forms whose joins a conflict may rest on.
fn joins(conflict: &Conflict, network: &Network, origins: &Origins) -> BTreeSet<Span> {
    spans(conflict, network, origins, |origin, _| Loosening::Slack.concerns(origin.kind))
}

/// The orders a conflict may rest on: what only says that something comes after something else.
fn orders(conflict: &Conflict, network: &Network, origins: &Origins) -> BTreeSet<Span> {
    let order = |requirement: &Requirement| {
        requirement.lower == Bound::Finite(Duration::ZERO) && requirement.upper == Bound::Infinite
    };
    spans(conflict, network, origins, |origin, requirement| {
        origin.kind == OriginKind::Between && order(requirement)
    })
}

fn spans(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    is_meant: impl Fn(&Origin, &Requirement) -> bool,
) -> BTreeSet<Span> {
    let members = conflict.members.iter().map(|share| share.part);
    let parts = could_settle(network, conflict).into_iter().chain(members);
    let requirement = |part: Part| match part {
        Part::RequirementLower(index) | Part::RequirementUpper(index) | Part::Join(index) => {
            Some((origins.constraint(part)?, network.requirements().get(index)?))
        }
        _ => None,
    };
    let found = parts.filter_map(requirement).filter(|(origin, requirement)| is_meant(origin, requirement));
    found.map(|(origin, _)| origin.span).collect()
}

/// The network in which some requirements leave more time, or say nothing.
fn loosened(network: &Network, origins: &Origins, which: impl Fn(&Origin) -> bool) -> Option<Network> {
    let loose = |(requirement, origin): (&Requirement, &Origin)| match (which(origin), origin.kind) {
        (true, OriginKind::Between) => None,
        (true, _) => Some(Requirement { upper: Bound::Infinite, ..*requirement }),
        (false, _) => Some(*requirement),
    };
    let requirements = network.requirements().iter().zip(&origins.requirements).filter_map(loose).collect();
    let (events, links) = (network.events().to_vec(), network.contingents().to_vec());
    Network::new(network.name().to_string(), network.origin(), events, requirements, links).ok()
}

/// Slack for the form whose first word is at a place.
pub fn slack(operator: Span, sources: &[Source]) -> Option<Edit> {
    let form = innermost(operator, sources)?;
    let items = form.list()?;
    let head = items.first()?;
    head.word().filter(|word| matches!(*word, "sequence" | "parallel"))?;
    let options = items
        .get(1)
        .filter(|it| it.list().is_some_and(|it| it.first().is_none_or(|first| first.keyword().is_some())));
    let (span, text) = match options.map(|it| (it, it.list().unwrap_or_default())) {
        Some((options, [])) => (options.span, "(:slack t)"),
        Some((_, [keyword, value])) if keyword.keyword() == Some("slack") => {
            if value.word() == Some("t") {
                return None;
            }
            (value.span, "t")
        }
        Some(_) => return None,
        None => (Span { start: head.span.end, ..head.span }, " (:slack t)"),
    };
    Some(Edit { span, text: Text::Plain(text.to_string()) })
}

/// A form with the blanks before it.
fn around(span: Span, sources: &[Source]) -> Option<Span> {
    let form = innermost(span, sources)?.span;
    let before = sources.get(form.source as usize)?.text.get(..form.start as usize)?;
    let start = match before.trim_end().rsplit('\n').next() {
        // What comes after is not to become part of a comment.
        Some(line) if line.contains(';') => before.trim_end_matches([' ', '\t']).len(),
        _ => before.trim_end().len(),
    };
    Some(Span { start: start as u32, ..form })
}

/// The innermost list that a place is inside of.
fn innermost(place: Span, sources: &[Source]) -> Option<Form> {
    let source = sources.get(place.source as usize)?;
    let mut forms = read(source, place.source, &mut Problems::default());
    let mut found = None;
    while let Some(form) =
        forms.into_iter().find(|it| it.span.start < place.start && place.start < it.span.end)
    {
        forms = form.list().map(<[Form]>::to_vec).unwrap_or_default();
        if form.list().is_some() {
            found = Some(form);
        }
    }
    found
}
