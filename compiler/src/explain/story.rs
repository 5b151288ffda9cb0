//! A conflict as a story: step by step what is needed, who decides it, and how much is there.

use std::collections::{BTreeSet, VecDeque};

use kirk_network::merge::merge;
use kirk_network::news::untold;
use kirk_network::walk::{Step, walk};
use kirk_network::{Conflict, Delay, Duration, EventId, Network, Part};

use super::is_circle;
use crate::origins::Origins;
use crate::repair::{Unit, unit};
use crate::source::Source;
use crate::wording;

/// A step of a story, or several that differ only in which repetition they are of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoryStep {
    /// The bound by which it leads on; of several, that of the first.
    pub part: Part,
    /// How many there are.
    pub times: u32,
    /// What is needed for all of them; negative where so much is there.
    pub needs: Duration,
    /// In words.
    pub text: String,
    /// In which the author wrote it.
    pub unit: Unit,
}

/// So many steps that are alike are told as one.
const ALIKE: usize = 3;

/// The story; `None` if the walk would be too long to tell anything. What takes no time is left out where something takes time and
/// something else allows it. `settling` are bounds of which one is enough.
pub(super) fn steps(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    sources: &[Source],
    settling: &BTreeSet<Part>,
) -> Option<Vec<StoryStep>> {
    let mut steps = walk(network, conflict)?;
    begin_with_a_need(&mut steps);
    if is_circle(conflict) || steps.iter().all(|step| step.needs >= Duration::ZERO) {
        steps = with_joins(&steps, conflict, network);
        with_late_news(&mut steps, network, settling);
    } else {
        with_late_news(&mut steps, network, settling);
        let is_news = |step: &Step| matches!(step.part, Part::DelayMax(_));
        steps.retain(|step| step.needs != Duration::ZERO || is_news(step));
    }
    let mut told: Vec<StoryStep> = Vec::new();
    for step in &steps {
        // Of what has no origin there is nothing to say.
        let Some(origin) = origins.constraint(step.part) else { continue };
        let text = wording::conflict::step(step, origin, network, sources, told.is_empty());
        let place = origins.of(step.part).map_or(origin.span, |(origin, side)| origin.place(side));
        let unit = unit(place, sources);
        told.push(StoryStep { part: step.part, times: 1, needs: step.needs, text, unit });
    }
    Some(folded(told))
}

/// What is needed comes first, and what is there for it after that.
fn begin_with_a_need(steps: &mut [Step]) {
    let is_need = |step: &Step| step.needs > Duration::ZERO;
    let is_there = |step: &Step| step.needs < Duration::ZERO;
    let before = |at: usize| steps[(at + steps.len() - 1) % steps.len()];
    if !steps.first().is_some_and(is_need)
        && let Some(first) = (0..steps.len()).find(|&at| is_need(&steps[at]) && is_there(&before(at)))
    {
        steps.rotate_left(first);
    }
}

/// The same with what makes the end of each step and the start of the next one event.
fn with_joins(steps: &[Step], conflict: &Conflict, network: &Network) -> Vec<Step> {
    let class = merge(network).event_of;
    let mut all = Vec::new();
    for (at, step) in steps.iter().enumerate() {
        all.push(*step);
        let next = steps[(at + 1) % steps.len()].from;
        if step.to != next && class[step.to.index()] == class[next.index()] {
            all.extend(joins(step.to, next, conflict, network));
        }
    }
    all
}

/// The joins of a conflict that lead from one event to another, as few as can be.
fn joins(from: EventId, to: EventId, conflict: &Conflict, network: &Network) -> Vec<Step> {
    let mut all = Vec::new();
    for share in &conflict.members {
        let Part::Join(index) = share.part else { continue };
        let requirement = network.requirements()[index];
        let ends = (requirement.from, requirement.to);
        for (from, to) in [ends, (ends.1, ends.0)] {
            all.push(Step { part: share.part, from, to, needs: Duration::ZERO });
        }
    }
    let mut seen = BTreeSet::from([from]);
    let mut open = VecDeque::from([(from, Vec::new())]);
    while let Some((at, way)) = open.pop_front() {
        if at == to {
            return way;
        }
        for step in all.iter().filter(|step| step.from == at) {
            if seen.insert(step.to) {
                let further: Vec<Step> = way.iter().copied().chain([*step]).collect();
                open.push_back((step.to, further));
            }
        }
    }
    Vec::new()
}

/// Says where news would be that tells nothing, or comes so late that it is of no use but would be if it came sooner: before the
/// least that Nature may take counts for that.
fn with_late_news(steps: &mut Vec<Step>, network: &Network, settling: &BTreeSet<Part>) {
    if network.contingents().iter().all(|link| link.delay == Delay::NONE) {
        return;
    }
    let untold = untold(network);
    let mut told: BTreeSet<Part> = steps.iter().map(|step| step.part).collect();
    let mut all = Vec::new();
    for step in steps.iter() {
        if let Part::LinkLower(link) = step.part
            && (untold[link] || settling.contains(&Part::DelayMax(link)))
            && told.insert(Part::DelayMax(link))
        {
            let end = network.contingents()[link].to;
            all.push(Step { part: Part::DelayMax(link), from: end, to: end, needs: Duration::ZERO });
        }
        all.push(*step);
    }
    *steps = all;
}

/// Steps one after the other that are alike are told once.
fn folded(steps: Vec<StoryStep>) -> Vec<StoryStep> {
    let whole = |step: &StoryStep| wording::conflict::of_any(&step.text);
    let mut folded: Vec<StoryStep> = Vec::new();
    let alike = |a: &StoryStep, b: &StoryStep| a.needs == b.needs && whole(a) == whole(b);
    for run in steps.chunk_by(alike) {
        let needs = run[0].needs.as_micros().checked_mul(run.len() as i64).map(Duration::from_micros);
        match needs {
            Some(needs) if run.len() >= ALIKE => {
                let text = wording::conflict::several(run.len(), &run[0].text);
                folded.push(StoryStep { times: run.len() as u32, needs, text, ..run[0].clone() });
            }
            _ => folded.extend_from_slice(run),
        }
    }
    folded
}
