//! What helps where no amount does: slack in a form whose parts have to meet, an order less.

use std::collections::{BTreeSet, VecDeque};

use kirk_network::check::{Verdict, check};
use kirk_network::least::could_settle;
use kirk_network::repair::Repair;
use kirk_network::stnu::TooLarge;
use kirk_network::vary::{self, Change};
use kirk_network::{Bound, Conflict, Duration, Network, Part, Requirement};

use super::{ChangeKind, Changed, Loosening, Wishes, is_called};
use crate::diagnostic::{Edit, Text};
use crate::form::Form;
use crate::origins::{Origin, OriginKind, Origins, Side};
use crate::problem::Problems;
use crate::read::read;
use crate::source::{Source, Span};

/// A change of the structure, and what amounts have to change beside it.
pub(super) struct Restructured {
    pub(super) changes: Vec<Changed>,
    pub(super) amounts: Vec<Change>,
}

/// One loosening of what stands at a place.
type Step = (Loosening, Span);

/// So many proposals are found, if there are as many, before it is enough not to look for longer ones.
const ENOUGH: usize = 3;

/// So many networks at most are tried.
const MOST_TRIED: usize = 32;

/// The forms that would settle the conflicts if they had slack, and the orders that would if they were left out, slack first; then, if
/// with those that are `known` there are few proposals, several of these, or with changes of amounts.
///
/// Breadth first: a conflict names what it may rest on, and where one of that loosened leaves another conflict, that does.
pub(super) fn found(
    network: &Network,
    origins: &Origins,
    sources: &[Source],
    wishes: &Wishes,
    known: usize,
    amounts: impl Fn(&Network, usize) -> Result<Vec<Repair>, TooLarge>,
) -> Result<Vec<Restructured>, TooLarge> {
    let changed = |step: &Step| changed(*step, origins, sources, wishes);
    let without = |steps: &BTreeSet<Step>, step: &Step| -> BTreeSet<Step> {
        steps.iter().filter(|other| *other != step).copied().collect()
    };
    // Each is needed, with the others and the amounts as they are.
    let is_needed = |steps: &BTreeSet<Step>, step: &Step, amounts: &[Change]| {
        let less =
            loosened(network, origins, &without(steps, step)).and_then(|less| vary::changed(&less, amounts));
        less.map_or(Ok(true), |less| Ok(check(&less)? != Verdict::Controllable))
    };
    let mut found: Vec<Restructured> = Vec::new();
    let mut open = VecDeque::from([BTreeSet::new()]);
    let mut seen: BTreeSet<BTreeSet<Step>> = BTreeSet::new();
    for _ in 0..MOST_TRIED {
        let Some(steps) = open.pop_front() else { break };
        if steps.len() > 1 && known + found.len() >= ENOUGH {
            break;
        }
        let Some(loose) = loosened(network, origins, &steps) else { continue };
        let beside: Vec<Vec<Change>> = match check(&loose)? {
            Verdict::Controllable => vec![Vec::new()],
            Verdict::Uncontrollable(conflict) => {
                for next in steps_of(&conflict, network, origins).filter(|next| changed(next).is_some()) {
                    let more: BTreeSet<Step> = steps.iter().copied().chain([next]).collect();
                    if seen.insert(more.clone()) {
                        open.push_back(more);
                    }
                }
                match ENOUGH.saturating_sub(known + found.len()) {
                    missing if missing > 0 && !steps.is_empty() => {
                        amounts(&loose, missing)?.into_iter().map(|repair| repair.changes).collect()
                    }
                    _ => Vec::new(),
                }
            }
        };
        for amounts in beside {
            let needed: Result<Vec<bool>, TooLarge> =
                steps.iter().map(|step| is_needed(&steps, step, &amounts)).collect();
            if needed?.into_iter().all(|it| it) {
                found.push(Restructured { changes: steps.iter().filter_map(changed).collect(), amounts });
            }
        }
    }
    found.sort_by_key(|it| it.changes.len() + it.amounts.len());
    Ok(found)
}

/// What a conflict may rest on that can be loosened: slack first.
fn steps_of<'a>(
    conflict: &Conflict,
    network: &'a Network,
    origins: &'a Origins,
) -> impl Iterator<Item = Step> + use<> {
    let slack = joins(conflict, network, origins).into_iter().map(|span| (Loosening::Slack, span));
    slack.chain(orders(conflict, network, origins).into_iter().map(|span| (Loosening::Order, span)))
}

/// A step as a change of the source, if it can be made there and nobody wants to keep what it loosens.
fn changed(
    (loosening, span): Step,
    origins: &Origins,
    sources: &[Source],
    wishes: &Wishes,
) -> Option<Changed> {
    let kept = |origin: &Origin| wishes.keep.iter().any(|name| is_called(origin, name));
    let of_form = |origin: &&Origin| origin.span == span && loosening.concerns(origin.kind);
    let origin = origins.requirements.iter().filter(of_form).find(|origin| !kept(origin))?;
    let edits = match origin.kind {
        // An entry is not taken out of a file; nor is what does not stand by itself.
        OriginKind::Requirement if origins.requirements.iter().filter(of_form).count() > 1 => return None,
        OriginKind::Requirement => Vec::new(),
        _ => vec![loosening.edit(span, sources)?],
    };
    let change = ChangeKind::Loosened(loosening);
    Some(Changed { change, origin: origin.clone(), place: span, edits })
}

impl Loosening {
    fn concerns(self, kind: OriginKind) -> bool {
        match self {
            Loosening::Slack => matches!(kind, OriginKind::Join | OriginKind::SideBySide),
            Loosening::Order => matches!(kind, OriginKind::Between | OriginKind::Requirement),
        }
    }

    fn edit(self, span: Span, sources: &[Source]) -> Option<Edit> {
        match self {
            Loosening::Slack => slack(span, sources),
            Loosening::Order => Some(Edit { span: around(span, sources)?, text: Text::Plain(String::new()) }),
        }
    }
}

/// The forms whose joins a conflict may rest on.
fn joins(conflict: &Conflict, network: &Network, origins: &Origins) -> BTreeSet<Span> {
    spans(conflict, network, origins, |origin, _| Loosening::Slack.concerns(origin.kind))
}

/// The orders a conflict may rest on: what only says that something comes after something else.
fn orders(conflict: &Conflict, network: &Network, origins: &Origins) -> BTreeSet<Span> {
    let follows = |it: &Requirement| it.lower.finite().is_some_and(|lower| lower >= Duration::ZERO);
    let precedes = |it: &Requirement| {
        it.lower == Bound::Infinite && it.upper.finite().is_some_and(|upper| upper <= Duration::ZERO)
    };
    // With an upper bound it is a deadline, unless it says that it is an order, too.
    let is_written =
        |origin: &Origin| origin.kind == OriginKind::Between && origin.place(Side::Lower) != origin.span;
    spans(conflict, network, origins, |origin, it| {
        let is_order = follows(it) && (it.upper == Bound::Infinite || is_written(origin)) || precedes(it);
        Loosening::Order.concerns(origin.kind) && is_order
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
    let requirement =
        |part: Part| Some((origins.constraint(part)?, network.requirements().get(part.requirement()?)?));
    let found = parts.filter_map(requirement).filter(|(origin, requirement)| is_meant(origin, requirement));
    found.map(|(origin, _)| origin.span).collect()
}

/// The network in which some requirements leave more time, or say nothing.
fn loosened(network: &Network, origins: &Origins, steps: &BTreeSet<Step>) -> Option<Network> {
    let loose = |(requirement, origin): (&Requirement, &Origin)| {
        let is_meant = |loosening: Loosening| {
            loosening.concerns(origin.kind) && steps.contains(&(loosening, origin.span))
        };
        Requirement {
            lower: if is_meant(Loosening::Order) { Bound::Infinite } else { requirement.lower },
            upper: if is_meant(Loosening::Order) || is_meant(Loosening::Slack) {
                Bound::Infinite
            } else {
                requirement.upper
            },
            ..*requirement
        }
    };
    let requirements = network.requirements().iter().zip(&origins.requirements).map(loose).collect();
    network.with(requirements, network.contingents().to_vec()).ok()
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
