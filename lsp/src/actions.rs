//! What puts a problem right, as an edit that can be made at once.

use std::collections::BTreeSet;

use kirk_compiler::repair::{Changed, Proposal, Wishes, proposals, slack};
use kirk_compiler::{Code, Diagnostic, Edit, Lowered, Span};

use crate::analysis::Analysis;
use crate::judged::{Judged, Judgement, judge};
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
    let mut repaired = BTreeSet::new();
    for (problem, diagnostic) in problems.iter().enumerate() {
        let mut offer = |fix: Option<(String, Vec<(Span, String)>)>| {
            found.extend(fix.map(|(title, edits)| Action { title, problem, edits }));
        };
        // What settles a conflict is offered below, in whole units.
        if diagnostic.code != Code::NotControllable {
            suggested(analysis, diagnostic).for_each(|fix| offer(Some(fix)));
        }
        match diagnostic.code {
            Code::StartsAtDelayedEnd => offer(slack_around(analysis, diagnostic.span)),
            // Each of its conflicts is a problem, and what repairs a mission settles all of them.
            Code::NotControllable if view.is_current() && repaired.insert(diagnostic.span) => {
                let mission = view.missions.iter().find(|mission| mission.name == diagnostic.span);
                if let Some(mission) = mission
                    && mission.verdict == Judgement::Uncontrollable
                {
                    repairs(analysis, mission).into_iter().for_each(|fix| offer(Some(fix)));
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

/// What makes a mission controllable, as `kirk repair` proposes it. Each is tried before it is offered.
fn repairs(analysis: &Analysis, mission: &Judged) -> Vec<Fix> {
    const LARGE: usize = 2_000;
    // Somebody waits: what is not found soon is not offered. Of large missions nothing is tried, as each trial takes as long as the
    // verdict.
    let wishes = Wishes { effort: 50_000, ..Wishes::default() };
    if mission.occurrences.len() > LARGE {
        return Vec::new();
    }
    let Lowered { network, origins, .. } = &mission.lowered;
    let found = proposals(network, origins, &analysis.sources, &wishes).ok().flatten();
    let fix = |Proposal { changes }: Proposal| {
        let titles: Vec<String> = changes.iter().map(Changed::title).collect();
        let edits = changes.iter().flat_map(|change| &change.edits);
        let edits = edits.map(|edit| (edit.span, edit.text(&analysis.sources).to_string())).collect();
        (format!("Repair: {}", titles.join(" and ")), edits)
    };
    let is_proven = |fix: &Fix| {
        let is_here = !fix.1.is_empty() && fix.1.iter().all(|(span, _)| analysis.is_here(*span));
        let after = is_here.then(|| tried(analysis, mission, fix)).flatten();
        after.is_some_and(|after| after.verdict.is_yes())
    };
    found.into_iter().flat_map(|found| found.proposals).map(fix).filter(is_proven).collect()
}

/// The mission after an edit.
fn tried(analysis: &Analysis, mission: &Judged, (_, edits): &Fix) -> Option<Judged> {
    let (_, unjudged) = analysis.after(edits);
    let (after, _) = judge(unjudged);
    after.into_iter().find(|after| after.program == mission.program)
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
    let operator = operator?;
    let edit = slack(operator.span, &analysis.sources).filter(|_| analysis.is_here(operator.span))?;
    let title = format!("Give the `{}` slack: `(:slack t)`", operator.word()?);
    Some((title, vec![(edit.span, edit.text(&analysis.sources).to_string())]))
}
