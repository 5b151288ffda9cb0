//! What puts a problem right, as an edit that can be made at once.

use kirk_compiler::ast::Body;
use kirk_compiler::form::Form;
use kirk_compiler::{Code, Diagnostic, OriginKind, Span};
use kirk_network::{Conflict, Duration, Network, Part};

use crate::analysis::{Analysis, analyse};
use crate::definition::bare;
use crate::mission::{Judgement, Mission, judge};
use crate::outline::top_level;
use crate::rename::edited;
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
        did_you_mean(analysis, diagnostic).into_iter().for_each(|fix| offer(Some(fix)));
        match diagnostic.code {
            Code::UnknownProgram => offer(create(analysis, diagnostic)),
            Code::DelayNotContingent => offer(make_contingent(analysis, diagnostic)),
            Code::LowerAboveUpper | Code::DelayReversed => offer(swap(analysis, diagnostic)),
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

/// The names that were probably meant instead of the one at the place of the problem.
fn did_you_mean(analysis: &Analysis, diagnostic: &Diagnostic) -> Vec<Fix> {
    let question = diagnostic.help.as_deref().and_then(|help| help.split_once("Did you mean "));
    let Some((question, _)) = question.and_then(|(_, rest)| rest.split_once('?')) else { return Vec::new() };
    let written = analysis.source.slice(diagnostic.span);
    let is_one_word =
        !written.is_empty() && !written.contains(|c: char| c.is_whitespace() || "()".contains(c));
    if !is_one_word {
        return Vec::new();
    }
    // Names are quoted in one way, strings, quotation marks and all, in another.
    let meant: Vec<&str> = match question.starts_with('"') {
        true => vec![question],
        false => question.split('`').skip(1).step_by(2).collect(),
    };
    let fix = |meant: &str| {
        let whole = meant.contains(':') || !written.contains(':');
        let span = if whole { diagnostic.span } else { bare(analysis, diagnostic.span) };
        (format!("Change to `{meant}`"), vec![(span, meant.to_string())])
    };
    meant.into_iter().filter(|meant| !meant.starts_with("--")).map(fix).collect()
}

/// A definition of the program that is called and does not exist, behind the one that calls it.
fn create(analysis: &Analysis, diagnostic: &Diagnostic) -> Option<Fix> {
    let name = analysis.source.slice(bare(analysis, diagnostic.span));
    if name.is_empty() || name.len() != (diagnostic.span.end - diagnostic.span.start) as usize {
        return None;
    }
    let mut open: Vec<&Body> = analysis.program.programs.iter().flat_map(|program| &program.body).collect();
    let mut count = 0;
    while let Some(body) = open.pop() {
        if let Body::Call(call) = body
            && call.program.span == diagnostic.span
        {
            count = call.arguments.len();
        }
        open.extend(body.parts());
    }
    let parameters: Vec<String> = (1..=count).map(|number| format!("x{number}")).collect();
    let at = top_level(analysis, diagnostic.span).end;
    let text = format!(
        "\n\n(define-control-program {name} ({})\n  (declare (primitive)\n    (duration (simple :lower-bound 5 :upper-bound 10))))",
        parameters.join(" ")
    );
    let end_of_line = if analysis.text().contains("\r\n") { "\r\n" } else { "\n" };
    Some((
        format!("Create the program `{name}`"),
        vec![(Span { source: 0, start: at, end: at }, text.replace('\n', end_of_line))],
    ))
}

/// `:contingent t` for a duration whose end is heard late.
fn make_contingent(analysis: &Analysis, diagnostic: &Diagnostic) -> Option<Fix> {
    let duration = analysis.program.programs.iter().filter_map(|program| program.duration.as_ref()).find(
        |duration| duration.span.start <= diagnostic.span.start && diagnostic.span.end <= duration.span.end,
    )?;
    let form = innermost(analysis, duration.span.start)?;
    let items = form.list()?;
    let written = items.iter().position(|item| item.keyword() == Some("contingent"));
    let edit = match written.and_then(|at| items.get(at + 1)) {
        Some(value) => (value.span, "t".to_string()),
        None => {
            let at = form.span.end - 1;
            (Span { source: 0, start: at, end: at }, " :contingent t".to_string())
        }
    };
    Some(("Let Nature decide: `:contingent t`".to_string(), vec![edit]))
}

/// The two bounds the other way round.
fn swap(analysis: &Analysis, diagnostic: &Diagnostic) -> Option<Fix> {
    let (a, b) = (diagnostic.span, diagnostic.labels.first()?.span);
    let text = |span| analysis.source.slice(span).to_string();
    let apart = a.end <= b.start || b.end <= a.start;
    let is_value = |text: &str| !text.is_empty() && !text.starts_with("(simple");
    (apart && is_value(&text(a)) && is_value(&text(b)))
        .then(|| ("Swap the bounds".to_string(), vec![(a, text(b)), (b, text(a))]))
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
                let origin = mission.plan.origins.requirements.get(index);
                origin
                    .filter(|origin| {
                        origin.kind == OriginKind::Join && meets_nature(&mission.plan.network, index)
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
        let fix = relax(analysis, place, &mission.plan.network, part, by)?;
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
    Some(mission.plan.origins.requirements.get(index)?.places[side])
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
    let (_, unjudged) = analyse(edited(analysis.text(), edits));
    let (after, _) = judge(unjudged);
    after.into_iter().find(|after| after.program == mission.program)
}

/// True if the requirement is a number that somebody wrote for one bound alone.
fn is_bound(mission: &Mission, requirement: usize) -> bool {
    let origin = mission.plan.origins.requirements.get(requirement);
    origin.is_some_and(|origin| {
        !matches!(origin.kind, OriginKind::Join | OriginKind::Order) && origin.places[0] != origin.places[1]
    })
}

/// A bound that asks for so much less.
fn relax(analysis: &Analysis, place: Span, network: &Network, part: Part, by: Duration) -> Option<Fix> {
    let written = analysis.source.slice(place);
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
    let form = innermost(analysis, operator.start)?;
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
