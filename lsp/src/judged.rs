//! A program unfolded and judged: which occurrences there are, when each can happen, and the verdict.

use std::collections::BTreeMap;
use std::sync::Arc;

use kirk_compiler::Problems;
use kirk_compiler::episode::{Episode, Kind};
use kirk_compiler::repair::Unit;
use kirk_compiler::{
    Diagnostic, Explain, Lowered, Source, Span, Team, Unfolded, events_of, too_large, unfold, usual_unit,
};
use kirk_network::EventId;
use kirk_network::stnu::TooLarge;
use kirk_network::windows::{Window, windows};
use kirk_team::mission as teams;

use crate::analysis::Unjudged;

/// A program that can be started, with all that follows from it.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The name of the program.
    pub program: String,
    /// Where it is defined.
    pub name: Span,
    /// Its network and where that comes from.
    pub lowered: Lowered,
    /// Everything that occurs in it, in source order; the first is the mission itself.
    pub occurrences: Vec<Occurrence>,
    /// The occurrences of every place.
    pub at: BTreeMap<Span, Vec<usize>>,
    /// When each event can happen; `None` if no schedule keeps every bound.
    pub windows: Option<Vec<Window>>,
    /// Whether it can be promised.
    pub verdict: Judgement,
    /// The texts that were judged, which all places point into.
    pub sources: Arc<[Source]>,
    /// The unit in which its times are told: that of most amounts.
    pub unit: Unit,
}

/// One occurrence of a program or a form.
#[derive(Clone, Debug)]
pub struct Occurrence {
    /// Its name.
    pub name: String,
    /// What it is an occurrence of.
    pub kind: Kind,
    /// Its start.
    pub start: EventId,
    /// Its end.
    pub end: EventId,
}

/// The verdict on a mission.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// It can be executed whatever happens.
    Controllable,
    /// Its team can execute it whatever happens, with these promises.
    Promised(Vec<String>),
    /// No promises were found with which its team can; the diagnostic says what is missing.
    NoPromises,
    /// It cannot; the diagnostic says why.
    Uncontrollable,
    /// Its durations add up to too much.
    TooLarge,
}

impl Judgement {
    /// True if it can be executed whatever happens.
    pub fn is_yes(&self) -> bool {
        matches!(self, Judgement::Controllable | Judgement::Promised(_))
    }
}

/// Unfolds and judges every program a mission may start from, and says what there is to say about them.
pub fn judge(unjudged: Unjudged) -> (Vec<Judged>, Vec<Diagnostic>) {
    let Unjudged { mut model, roots, sources } = unjudged;
    let sources: Arc<[Source]> = sources.into();
    let mut missions = Vec::new();
    let mut problems = Problems::default();
    // Several conflicts are told at one place.
    let mut verdicts = Vec::new();
    for root in roots {
        model.entry = Some(root);
        let Some(Unfolded { episodes, lowered: Some(lowered) }) = unfold(&model, &mut problems) else {
            continue;
        };
        let (mission, verdict) = mission(&episodes, lowered, &sources);
        verdicts.extend(verdict);
        missions.push(mission);
    }
    let mut told = problems.into_sorted();
    told.append(&mut verdicts);
    told.sort_by_key(|diagnostic| diagnostic.span);
    (missions, told)
}

fn mission(root: &Episode, lowered: Lowered, sources: &Arc<[Source]>) -> (Judged, Vec<Diagnostic>) {
    let explain = Explain::of(&lowered, sources);
    let (verdict, diagnostics) = match &lowered.team {
        Some(team) => by_team(team, &lowered, &explain),
        None => alone(lowered.entry, &explain),
    };
    let mut at: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    let mut occurrences = Vec::new();
    for (index, (episode, (start, end))) in events_of(root).into_iter().enumerate() {
        at.entry(episode.span).or_default().push(index);
        occurrences.push(Occurrence { name: episode.name.clone(), kind: episode.kind, start, end });
    }
    let windows = windows(&lowered.network);
    let (unit, sources) = (usual_unit(&lowered.origins, sources), sources.clone());
    let (program, name) = (root.name.clone(), root.span);
    let mission = Judged { program, name, lowered, occurrences, at, windows, verdict, sources, unit };
    (mission, diagnostics)
}

/// The verdict on what one executes alone, and what there is to say about it.
fn alone(entry: Span, explain: &Explain<'_>) -> (Judgement, Vec<Diagnostic>) {
    match explain.all() {
        Ok(told) if told.is_empty() => (Judgement::Controllable, told),
        Ok(told) => (Judgement::Uncontrollable, told),
        Err(TooLarge) => (Judgement::TooLarge, vec![too_large(entry)]),
    }
}

/// The same of what a team executes.
fn by_team(team: &Team, lowered: &Lowered, explain: &Explain<'_>) -> (Judgement, Vec<Diagnostic>) {
    match teams::judge(team, &lowered.network, &lowered.origins, &kirk_team::Options::default()) {
        Ok(mission) => {
            let judgement = match &mission.verdict {
                kirk_team::Verdict::Yes(agreement) => Judgement::Promised(agreement.sentences(&mission.team)),
                kirk_team::Verdict::No(_) => Judgement::Uncontrollable,
                kirk_team::Verdict::NotFound(_) => Judgement::NoPromises,
            };
            (judgement, mission.diagnostics(explain))
        }
        Err(why) => (Judgement::TooLarge, why.diagnostics(lowered.entry)),
    }
}

impl Judged {
    /// When an event can happen.
    pub fn window(&self, event: EventId) -> Option<Window> {
        self.windows.as_ref().map(|windows| windows[event.index()])
    }
}
