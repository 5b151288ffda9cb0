//! When each occurrence happens, beside it in the text; and the verdict, above the program that is started.

use kirk_compiler::Span;
use kirk_compiler::ast::Body;
use kirk_compiler::episode::Kind;
use kirk_network::windows::Window;
use kirk_network::{Bound, Time};

use crate::judged::{Judged, Judgement};
use crate::left::start_of;
use crate::view::View;

/// A short text in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hint {
    /// The byte behind which it stands.
    pub offset: u32,
    /// What it says: `0-30 s`.
    pub label: String,
    /// The same in a sentence.
    pub about: String,
}

/// With more events than this it would take long to say of everything in sight how long it can wait.
const SMALL: usize = 200;

/// The earliest start and the latest end of everything that is called between two offsets; and until when its start can be put off,
/// unless that would take long: the hover says so of a single one.
pub fn hints(view: &View, within: Span) -> Vec<Hint> {
    let events: usize = view.missions.iter().map(|mission| mission.lowered.network.events().len()).sum();
    let mut found = Vec::new();
    let programs = view.analysis.program.programs.iter().filter(|it| view.analysis.is_here(it.span));
    let mut open: Vec<&Body> = programs.flat_map(|program| &program.body).rev().collect();
    while let Some(body) = open.pop() {
        let span = body.span();
        if span.end < within.start || within.end < span.start {
            continue;
        }
        if matches!(body, Body::Call(_) | Body::Delay(_)) && span.end <= within.end {
            found.extend(hint(view, span, events <= SMALL));
        }
        open.extend(body.parts().iter().rev());
    }
    found
}

fn hint(view: &View, span: Span, is_small: bool) -> Option<Hint> {
    let all = view.occurrences(span);
    let windows: Vec<(Window, Window)> = all
        .iter()
        .filter_map(|(mission, it)| Some((mission.window(it.start)?, mission.window(it.end)?)))
        .collect();
    let earliest = windows.iter().map(|(start, _)| start.earliest).min()?;
    let latest = windows.iter().map(|(_, end)| end.latest).reduce(later)?;
    let count = match windows.len() {
        1 => String::new(),
        count => format!("{count}x "),
    };
    let Judged { program, unit, .. } = all.first()?.0;
    let from = unit.say_time(earliest);
    let (mut label, until) = match latest {
        Some(latest) => (
            format!("{count}{}", unit.say_times(earliest, "-", latest)),
            format!("ends at {} at the latest", unit.say_time(latest)),
        ),
        None => (format!("{count}{from}-"), "nothing limits when it ends".to_string()),
    };
    let mut about = format!("starts at {from} at the earliest, {until}, after the start of `{program}`");
    if let [(mission, occurrence)] = all[..]
        && is_small
        && let Some(Bound::Finite(latest)) = start_of(mission, occurrence)
    {
        let latest = unit.say(latest);
        label.push_str(&format!(", can wait to {latest}"));
        about.push_str(&format!(
            "; its start can be put off to {latest} in any case, with all else guaranteed"
        ));
    }
    Some(Hint { offset: span.end, label, about })
}

/// The later of two times; without a limit is later than any.
fn later(a: Option<Time>, b: Option<Time>) -> Option<Time> {
    a.zip(b).map(|(a, b)| a.max(b))
}

/// The verdict on a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lens {
    /// The name of the program.
    pub program: String,
    /// Where that stands.
    pub span: Span,
    /// What is said above it.
    pub title: String,
}

/// The verdict on each program a mission may start from.
pub fn lenses(view: &View) -> Vec<Lens> {
    let mut found = Vec::new();
    for program in view.analysis.program.programs.iter().filter(|it| view.analysis.is_here(it.span)) {
        let span = program.name.span;
        let started = view.occurrences(span).into_iter().find(|(mission, it)| {
            it.kind == Kind::Program && mission.occurrences.first().is_some_and(|root| root.start == it.start)
        });
        let Some((mission, _)) = started else { continue };
        let title = match (view.is_current(), view.analysis.has_errors()) {
            (true, _) => verdict(mission),
            (false, true) => format!("before the errors: {}", verdict(mission)),
            (false, false) => format!("before the last change: {}", verdict(mission)),
        };
        found.push(Lens { program: program.name.name.clone(), span, title });
    }
    found
}

fn verdict(mission: &Judged) -> String {
    let (network, unit) = (&mission.lowered.network, mission.unit);
    match &mission.verdict {
        Judgement::Uncontrollable => "not controllable: some bounds do not go together".to_string(),
        Judgement::TooLarge => "no verdict: the durations add up to too much".to_string(),
        Judgement::NoPromises => "not found possible: no promises make its team sure of it".to_string(),
        Judgement::Controllable | Judgement::Promised(_) => {
            let end = mission.occurrences.first().and_then(|root| mission.window(root.end));
            let takes = match end {
                Some(Window { earliest, latest: Some(latest) }) if earliest == latest => {
                    format!(", takes {}", unit.say_time(latest))
                }
                Some(Window { earliest, latest: Some(latest) }) => {
                    format!(", takes {}", unit.say_times(earliest, " to ", latest))
                }
                Some(Window { earliest, latest: None }) => {
                    format!(", takes at least {}", unit.say_time(earliest))
                }
                None => String::new(),
            };
            let uncertain = network.contingents().len();
            let links = if uncertain == 1 { "contingent duration" } else { "contingent durations" };
            let by_team = match &mission.verdict {
                Judgement::Promised(promises) => {
                    let are = if promises.len() == 1 { "promise" } else { "promises" };
                    format!(" by its team, with {} {are}", promises.len())
                }
                _ => String::new(),
            };
            format!("controllable{by_team}: whatever happens{takes}, {uncertain} {links}")
        }
    }
}
