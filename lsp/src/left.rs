//! How much is left of a "yes" at one place: how long an activity can wait, how far a bound can move. Exact, and found by asking for
//! the verdict again and again, so only where somebody looks.

use kirk_compiler::episode::Kind;
use kirk_compiler::repair::{Unit, what, written_unit};
use kirk_compiler::{Side, Span, Written, measurable};
use kirk_network::merge::{Merged, merge};
use kirk_network::promise::{put_off_to, stretch};
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
    /// Until when its start can be put off in any case; nothing if that is not ours to choose.
    start: Option<Bound>,
    /// How long what is ours may be made to take.
    stretch: Option<(Bound, Unit)>,
    /// How long Nature takes at most, and may take.
    natures: Option<(Duration, Bound, Unit)>,
    /// How late the news of the end may be, as it is and at most.
    news: Option<(Duration, Bound, Unit)>,
}

/// What an occurrence has left, in a sentence; nothing if there is no guarantee.
pub(crate) fn of_occurrence(mission: &Judged, occurrence: &Occurrence) -> Option<String> {
    if !is_measured(mission)? {
        return Some(TOO_LARGE.to_string());
    }
    let Left { start, stretch, natures, news } = left(mission, occurrence);
    let start = start.map(|start| match start.finite() {
        Some(start) => format!("its start can be put off to {} in any case", mission.unit.say(start)),
        None => "its start can be put off as long as you like".to_string(),
    });
    let stretch = stretch.map(|(most, unit)| match most.finite() {
        Some(most) => format!("it may be stretched to {}", unit.say(most)),
        None => "it may take any time".to_string(),
    });
    let natures = natures.map(|(now, most, unit)| match most.finite() {
        Some(most) => format!("Nature may take up to {} (now {})", unit.say(most), unit.say(now)),
        None => "Nature may take any time".to_string(),
    });
    let news = news.map(|(now, most, unit)| match most.finite() {
        Some(most) => format!("its news may be up to {} late (now {})", unit.say(most), unit.say(now)),
        None => "its news need never come".to_string(),
    });
    let told: Vec<String> = [start, stretch, natures, news].into_iter().flatten().collect();
    (!told.is_empty()).then(|| format!("each alone, with all else guaranteed: {}", told.join("; ")))
}

/// Until when the start of an occurrence can be put off in any case, if we decide, and the mission is so small that this is known
/// at once.
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
        let unit = |side: Side| unit(mission, mission.lowered.origins.contingents[index].place(side));
        left.natures = most(Part::LinkUpper(index)).map(|most| (link.upper, most, unit(Side::Upper)));
        let late = link.delay.max.finite().zip(most(Part::DelayMax(index)));
        left.news = late.map(|(now, most)| (now, most, unit(Side::MaxDelay)));
    } else if let Some(index) = network.requirements().iter().position(|it| (it.from, it.to) == (start, end))
    {
        let unit = unit(mission, mission.lowered.origins.requirements[index].place(Side::Upper));
        left.stretch = stretch(network, index).ok().flatten().map(|most| (most, unit));
    }
    left
}

/// The unit in which an amount is written.
fn unit(mission: &Judged, place: Span) -> Unit {
    written_unit(place, &mission.sources).unwrap_or(mission.unit)
}

/// Until when an event can be put off in any case, if it is ours.
fn latest(network: &Network, event: EventId) -> Option<Bound> {
    let Merged { network: merged, event_of, .. } = merge(network);
    let event_there = event_of[event.index()];
    let is_ours = merged.link_of(event_there).is_none() && event_there != merged.origin();
    is_ours.then(|| put_off_to(network, event).ok().flatten())?
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
            Some(true) => lines.extend(here.iter().filter_map(|written| of_bound(mission, written))),
            _ => {}
        }
    }
    // Several missions may say the same.
    lines.dedup();
    lines
}

fn of_bound(mission: &Judged, written: &Written<'_>) -> Option<String> {
    let network = &mission.lowered.network;
    let unit = written.unit(mission.unit, &mission.sources);
    let found = slack(network, &[Knob::together(written.parts.clone())?]).ok()??;
    let what = format!("{}, {}", what(written.parts[0], written.origin)?, written.side.word());
    let (now, may_be) = (written.now(network, unit), written.may_be(found.first()?, network, unit));
    let all = match written.parts.len() {
        1 => String::new(),
        count => format!(" in all {count} occurrences together"),
    };
    Some(format!("{what}: {now}, and may be {may_be}{all}, with all else guaranteed"))
}
