//! How much is left of a "yes" at one place: how late an activity may start, how far a bound can move. Exact, and found by asking for
//! the verdict again and again, so only where somebody looks.

use kirk_compiler::episode::Kind;
use kirk_compiler::repair::what;
use kirk_compiler::{Span, Written, measurable};
use kirk_network::merge::{Merged, merge};
use kirk_network::promise::{latest_start, stretch};
use kirk_network::slack::slack;
use kirk_network::vary::Knob;
use kirk_network::{Bound, Duration, EventId, Network, Part};

use crate::judged::{Judged, Judgement, Occurrence};
use crate::view::View;

/// Of missions with more events than this nobody would wait for the figures.
const LARGE: usize = 5_000;

/// What is said instead.
const TOO_LARGE: &str = "how much is left is not measured here, as the mission is large: `kirk slack` does";

/// What an occurrence has left, each alone, with all else as it is and still guaranteed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Left {
    /// How late it may start, whatever happens; nothing if Nature decides when.
    start: Option<Bound>,
    /// How long what is ours may be made to take.
    stretch: Option<Bound>,
    /// How long Nature takes at most, and may take.
    natures: Option<(Duration, Bound)>,
    /// How late the news of the end may be, as it is and at most.
    news: Option<(Duration, Bound)>,
}

/// What an occurrence has left, in a sentence; nothing if there is no guarantee.
pub(crate) fn of_occurrence(mission: &Judged, occurrence: &Occurrence) -> Option<String> {
    if !is_measured(mission)? {
        return Some(TOO_LARGE.to_string());
    }
    let Left { start, stretch, natures, news } = left(mission, occurrence);
    let start = start.map(|start| match start.finite() {
        Some(start) => format!("it may start as late as {start} s"),
        None => "it may start as late as you like".to_string(),
    });
    let stretch = stretch.map(|most| match most.finite() {
        Some(most) => format!("it may be stretched to {most} s"),
        None => "it may take any time".to_string(),
    });
    let natures = natures.map(|(now, most)| match most.finite() {
        Some(most) => format!("Nature may take up to {most} s (now {now} s)"),
        None => "Nature may take any time".to_string(),
    });
    let news = news.map(|(now, most)| match most.finite() {
        Some(most) => format!("its news may be up to {most} s late (now {now} s)"),
        None => "its news need never come".to_string(),
    });
    let told: Vec<String> = [start, stretch, natures, news].into_iter().flatten().collect();
    (!told.is_empty()).then(|| format!("each alone, with all else guaranteed: {}", told.join("; ")))
}

/// How late an occurrence may start, if we decide, and the mission is so small that this is known at once.
pub(crate) fn start_of(mission: &Judged, occurrence: &Occurrence) -> Option<Bound> {
    is_measured(mission)?.then(|| latest(&mission.lowered.network, occurrence.start))?
}

/// Whether the mission is measured; nothing if it has no guarantee to lose.
fn is_measured(mission: &Judged) -> Option<bool> {
    let is_small = mission.lowered.network.events().len() <= LARGE;
    (mission.verdict == Judgement::Controllable).then_some(is_small)
}

fn left(mission: &Judged, occurrence: &Occurrence) -> Left {
    let network = &mission.lowered.network;
    let Occurrence { start, end, kind, .. } = *occurrence;
    let mut left = Left { start: latest(network, start), ..Left::default() };
    if !matches!(kind, Kind::Primitive | Kind::Delay) {
        return left;
    }
    if let Some(index) = network.contingents().iter().position(|it| (it.from, it.to) == (start, end)) {
        let link = network.contingents()[index];
        let most = |part: Part| Some(slack(network, &[Knob::of(part)?]).ok()??.first()?.most);
        left.natures = most(Part::LinkUpper(index)).map(|most| (link.upper, most));
        left.news = link.delay.max.finite().and_then(|now| Some((now, most(Part::DelayMax(index))?)));
    } else if let Some(index) = network.requirements().iter().position(|it| (it.from, it.to) == (start, end))
    {
        left.stretch = stretch(network, index).ok().flatten();
    }
    left
}

/// How late an event may come whatever happens, if it is ours.
fn latest(network: &Network, event: EventId) -> Option<Bound> {
    let Merged { network: merged, event_of, .. } = merge(network);
    let event_there = event_of[event.index()];
    let is_ours = merged.link_of(event_there).is_none() && event_there != merged.origin();
    is_ours.then(|| latest_start(network, event).ok().flatten())?
}

/// How far the bounds can move that are written at a place of the newest text, each in a line.
pub(crate) fn of_bounds(view: &View, place: Span) -> Vec<String> {
    let Some(before) = view.shift.back(place) else { return Vec::new() };
    let mut lines = Vec::new();
    for mission in view.missions.iter() {
        let network = &mission.lowered.network;
        let written = measurable(network, &mission.lowered.origins);
        let here: Vec<Written<'_>> = written.into_iter().filter(|it| it.place() == before).collect();
        match is_measured(mission) {
            Some(false) if !here.is_empty() => lines.push(TOO_LARGE.to_string()),
            Some(true) => lines.extend(here.iter().filter_map(|written| of_bound(network, written))),
            _ => {}
        }
    }
    // Several missions may say the same.
    lines.dedup();
    lines
}

fn of_bound(network: &Network, written: &Written<'_>) -> Option<String> {
    let (part, count) = (written.parts[0], written.parts.len());
    let found = slack(network, &[Knob::together(written.parts.clone())?]).ok()??;
    let slack = found.first()?;
    let what = format!("{}, {}", what(part, written.origin)?, written.side.word());
    if written.has_one_value(network) {
        let now = slack.value.finite().map_or("any".to_string(), |now| format!("{now} s"));
        let all = if count > 1 { format!(" in all {count} occurrences together") } else { String::new() };
        return Some(format!("{what}: {now}, and may be {}{all}, with all else guaranteed", slack.range()));
    }
    let harder = if part.is_subtracted() { "more" } else { "less" };
    let by = slack.room.map_or("any amount".to_string(), |room| format!("up to {room} s"));
    Some(format!(
        "{what}: may be {by} {harder} in all {count} occurrences together, with all else guaranteed"
    ))
}
