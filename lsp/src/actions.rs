//! What puts a problem right, as an edit that can be made at once.

use kirk_compiler::form::Form;
use kirk_compiler::{Code, Diagnostic, Edit, OriginKind, Span};
use kirk_network::{Conflict, Duration, Network, Part};

use crate::analysis::Analysis;
use crate::mission::{Judgement, Mission, judge};
use crate::view::View;

/// An edit that puts a problem right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// What it does.
    pub title: String,
    /// The position of the problem among those given.
    pub problem: usize,
    /// The edits.
    pub edits: Vec<(Span, String)>,
}

/// What can be done about problems of the newest text.
pub fn actions(view: &View, problems: &[Diagnostic]) -> Vec<Action> {
    let analysis = &*view.analysis;
    let mut found = Vec::new();
    for (problem, diagnostic) in problems.iter().enumerate() {
        let mut offer = |fix: Option<(String, Vec<(Span, String)>)>| {
            found.extend(fix.map(|(title, edits)| Action { title, problem, edits }));
        };
        suggested(analysis, diagnostic).for_each(|fix| offer(Some(fix)));
        match diagnostic.code {
            Code::StartsAtDelayedEnd => offer(slack_around(analysis, diagnostic.span)),
            Code::NotControllable if view.is_current() => {
                let mission = view.missions.iter().find(|mission| mission.name == diagnostic.span);
                if let Some(mission) = mission
                    && let Judgement::Uncontrollable(conflict) = &mission.verdict
                {
                    settle(analysis, mission, conflict).into_iter().for_each(|fix| offer(Some(fix)));
                }
            }
            _ => {}
        }
    }
    found.dedup_by(|a, b| a.title == b.title && a.edits == b.edits);
    found
}

type Fix = (String, Vec<(Span, String)>);

/// What the message itself suggests, as edits of the text.
fn suggested<'a>(analysis: &'a Analysis, diagnostic: &'a Diagnostic) -> impl Iterator<Item = Fix> + 'a {
    let sources = &analysis.sources;
    let end_of_line = if analysis.text().contains("\r\n") { "\r\n" } else { "\n" };
    diagnostic.suggestions.iter().map(move |suggestion| {
        let edits = suggestion.edits.iter();
        let edit = |edit: &Edit| (edit.span, edit.text(sources).replace('\n', end_of_line));
        (suggestion.title.clone(), edits.map(edit).collect())
    })
}

/// What settles a conflict: more in one bound of ours, and slack where ends have to meet. Each is tried before it is offered,
/// as the conflict may be one of several.
fn settle(analysis: &Analysis, mission: &Mission, conflict: &Conflict) -> Vec<Fix> {
    const LARGE: usize = 2_000;
    let mut fixes: Vec<Fix> = Vec::new();
    // Of large missions nothing is tried, as that takes as long as the verdict, each time.
    if mission.occurrences.len() > LARGE {
        return fixes;
    }
    for share in &conflict.members {
        let fix = match share.part {
            Part::RequirementUpper(index) | Part::RequirementLower(index) if is_bound(mission, index) => {
                relax_enough(analysis, mission, conflict, share.part)
            }
            Part::RequirementUpper(index) | Part::RequirementLower(index) | Part::Join(index) => {
                let origin = mission.lowered.origins.requirements.get(index);
                origin
                    .filter(|origin| {
                        origin.kind == OriginKind::Join && meets_nature(&mission.lowered.network, index)
                    })
                    .and_then(|origin| add_slack(analysis, origin.span))
                    .filter(|fix| {
                        matches!(
                            tried(analysis, mission, fix),
                            Some(Mission { verdict: Judgement::Controllable, .. })
                        )
                    })
            }
            _ => None,
        };
        fixes.extend(fix.filter(|fix| !fixes.contains(fix)));
    }
    fixes
}

/// A bound that asks for so much less that no conflict is left; `None` if that does not come about in a few rounds.
fn relax_enough(analysis: &Analysis, mission: &Mission, conflict: &Conflict, part: Part) -> Option<Fix> {
    const ROUNDS: usize = 6;
    let place = written_at(mission, part)?;
    let mut by = missing_at(mission, conflict, part, place)?;
    for _ in 0..ROUNDS {
        let fix = relax(analysis, place, &mission.lowered.network, part, by)?;
        let after = tried(analysis, mission, &fix)?;
        match &after.verdict {
            Judgement::Controllable => return Some(fix),
            Judgement::Uncontrollable(rest) => by = by.checked_add(missing_at(&after, rest, part, place)?)?,
            Judgement::TooLarge => return None,
        }
    }
    None
}

/// Where the bound of a requirement is written.
fn written_at(mission: &Mission, part: Part) -> Option<Span> {
    let (index, side) = match part {
        Part::RequirementLower(index) => (index, 0),
        Part::RequirementUpper(index) => (index, 1),
        _ => return None,
    };
    Some(mission.lowered.origins.requirements.get(index)?.places[side])
}

/// How much the bound at a place has to change for this conflict, which may use it several times. `None` if it does not.
fn missing_at(mission: &Mission, conflict: &Conflict, part: Part, place: Span) -> Option<Duration> {
    let is_same = |other: Part| {
        std::mem::discriminant(&other) == std::mem::discriminant(&part)
            && written_at(mission, other).is_some_and(|at| at.start == place.start)
    };
    let times: i64 =
        conflict.members.iter().filter(|it| is_same(it.part)).map(|it| i64::from(it.times)).sum();
    let missing = conflict.total.as_micros().saturating_neg();
    (times > 0)
        .then(|| Duration::from_micros(missing.div_euclid(times) + i64::from(missing.rem_euclid(times) != 0)))
}

/// The mission after an edit.
fn tried(analysis: &Analysis, mission: &Mission, (_, edits): &Fix) -> Option<Mission> {
    let (_, unjudged) = analysis.after(edits);
    let (after, _) = judge(unjudged);
    after.into_iter().find(|after| after.program == mission.program)
}

/// True if the requirement is a number that somebody wrote for one bound alone.
fn is_bound(mission: &Mission, requirement: usize) -> bool {
    let origin = mission.lowered.origins.requirements.get(requirement);
    origin.is_some_and(|origin| {
        !matches!(origin.kind, OriginKind::Join | OriginKind::Order) && origin.places[0] != origin.places[1]
    })
}

/// A bound that asks for so much less.
fn relax(analysis: &Analysis, place: Span, network: &Network, part: Part, by: Duration) -> Option<Fix> {
    let written = analysis.slice(place);
    if written.is_empty() || written.starts_with("(simple") {
        return None;
    }
    let bound = part.bound(network);
    let (sign, what, relaxed) = match part {
        Part::RequirementUpper(_) => ('+', "more", bound.checked_add(by)?),
        _ => ('-', "less", bound.checked_sub(by).filter(|rest| *rest >= Duration::ZERO)?),
    };
    // What is no plain number is calculated from what is written.
    let new = match Duration::parse_seconds(written) {
        Ok(number) if number == bound => relaxed.to_string(),
        _ => format!("({sign} {written} {by})"),
    };
    Some((format!("Allow {by} s {what}: `{new}`"), vec![(place, new)]))
}

/// True if the requirement is about an event that Nature decides.
fn meets_nature(network: &Network, requirement: usize) -> bool {
    let requirement = network.requirements()[requirement];
    network.link_of(requirement.from).is_some() || network.link_of(requirement.to).is_some()
}

/// Slack for the form whose first word is at a place.
fn add_slack(analysis: &Analysis, operator: Span) -> Option<Fix> {
    let form = innermost(analysis, operator.start).filter(|_| analysis.is_here(operator))?;
    let items = form.list()?;
    let head = items.first()?;
    let word = head.word().filter(|word| matches!(*word, "sequence" | "parallel"))?;
    let options = items
        .get(1)
        .filter(|it| it.list().is_some_and(|it| it.first().is_none_or(|first| first.keyword().is_some())));
    let edit = match options.map(|it| (it, it.list().unwrap_or_default())) {
        Some((options, [])) => (options.span, "(:slack t)".to_string()),
        Some((_, [keyword, value])) if keyword.keyword() == Some("slack") => {
            if value.word() == Some("t") {
                return None;
            }
            (value.span, "t".to_string())
        }
        Some(_) => return None,
        None => {
            let at = head.span.end;
            (Span { source: 0, start: at, end: at }, " (:slack t)".to_string())
        }
    };
    Some((format!("Give the `{word}` slack: `(:slack t)`"), vec![edit]))
}

/// Slack for the sequence that a call is a part of.
fn slack_around(analysis: &Analysis, call: Span) -> Option<Fix> {
    let mut operator = None;
    let mut forms = &analysis.forms[..];
    while let Some(form) = forms.iter().find(|it| it.span.start <= call.start && call.end <= it.span.end) {
        if form.span == call {
            break;
        }
        forms = form.list().unwrap_or_default();
        // These are no forms of their own: what is in them belongs to the form around.
        if !matches!(form.call(), Some(("label" | "let" | "let*" | "dotimes", _))) {
            operator = forms.first();
        }
    }
    add_slack(analysis, operator?.span)
}

/// The innermost list around an offset.
fn innermost(analysis: &Analysis, offset: u32) -> Option<&Form> {
    let mut found = None;
    let mut forms = &analysis.forms[..];
    while let Some(form) = forms.iter().find(|it| it.span.start <= offset && offset < it.span.end) {
        let Some(items) = form.list() else { break };
        found = Some(form);
        forms = items;
    }
    found
}
