//! A conflict as a walk: from event to event, forward where something takes time, back where a bound allows no more.
//!
//! The steps are those of the cycle, against its edges, so that time that is needed counts positively. Their order is one of
//! those that lead round once (C. Hierholzer, 1873); the sums of a cycle do not depend on which.

use crate::conflict::{Conflict, Part};
use crate::merge::merge;
use crate::model::{EventId, Network};
use crate::time::Duration;

/// One step of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The bound by which it leads on. News is a step at the event it tells of.
    pub part: Part,
    /// The event it starts from.
    pub from: EventId,
    /// The event it leads to.
    pub to: EventId,
    /// What is needed for it; negative where so much is allowed.
    pub needs: Duration,
}

/// A longer walk tells nobody anything.
const LONGEST: i64 = 5_000;

/// The walk of a conflict of a network, not merged. It ends with the step that allows most; what it needs adds up to what the
/// conflict lacks. `None` if it is very long.
pub fn walk(network: &Network, conflict: &Conflict) -> Option<Vec<Step>> {
    if conflict.members.iter().map(|share| i64::from(share.times)).sum::<i64>() > LONGEST {
        return None;
    }
    let class_of = merge(network).event_of;
    let origin = class_of[network.origin().index()].index();
    let mut graph = Graph { leaving: vec![Vec::new(); network.events().len()], surplus: Vec::new() };
    graph.surplus.resize(network.events().len(), 0_i64);
    let mut news = Vec::new();
    for share in conflict.members.iter().filter(|share| share.times > 0) {
        let needs = Duration::from_micros(-(share.amount.as_micros() / i64::from(share.times)));
        let Some((from, to)) = ends(network, share.part) else { continue };
        let step = Step { part: share.part, from, to, needs };
        for _ in 0..share.times {
            match share.part {
                Part::DelayMin(_) | Part::DelayMax(_) => news.push(step),
                _ => graph.add(step, class_of[from.index()].index(), class_of[to.index()].index()),
            }
        }
    }
    // What comes after the origin goes without saying, and closes the ways that lead nowhere else.
    for class in 0..graph.surplus.len() {
        while class != origin && graph.surplus[class] > 0 && graph.surplus[origin] < 0 {
            let to = class_of.iter().position(|at| at.index() == class)?;
            let to = EventId(to as u32);
            let step = Step { part: Part::AfterOrigin, from: network.origin(), to, needs: Duration::ZERO };
            graph.add(step, origin, class);
        }
    }
    if graph.surplus.iter().any(|&surplus| surplus != 0) {
        return None;
    }
    let start = graph.leaving.iter().position(|steps| !steps.is_empty()).unwrap_or(origin);
    let mut steps = graph.round(start)?;
    let last = (0..steps.len()).min_by_key(|&at| (steps[at].needs, at)).unwrap_or(0);
    let first = if last + 1 < steps.len() { last + 1 } else { 0 };
    steps.rotate_left(first);
    for step in news {
        let class = class_of[step.from.index()];
        let at = steps.iter().position(|known| class_of[known.from.index()] == class)?;
        steps.insert(at, step);
    }
    Some(steps)
}

/// From where to where a bound leads, against its edge.
fn ends(network: &Network, part: Part) -> Option<(EventId, EventId)> {
    let (from, to) = part.ends(network)?;
    match part {
        Part::DelayMin(_) | Part::DelayMax(_) => Some((to, to)),
        Part::AfterOrigin | Part::Join(_) => None,
        _ if part.is_subtracted() => Some((from, to)),
        _ => Some((to, from)),
    }
}

/// Steps between classes of events that are one.
struct Graph {
    /// The steps from each class, with where they lead.
    leaving: Vec<Vec<(Step, usize)>>,
    /// How many more steps leave a class than lead to it.
    surplus: Vec<i64>,
}

impl Graph {
    fn add(&mut self, step: Step, from: usize, to: usize) {
        self.leaving[from].push((step, to));
        self.surplus[from] += 1;
        self.surplus[to] -= 1;
    }

    /// All steps, one after the other, from a class back to it; `None` if they do not hang together.
    fn round(mut self, start: usize) -> Option<Vec<Step>> {
        let count: usize = self.leaving.iter().map(Vec::len).sum();
        let mut open: Vec<(Option<Step>, usize)> = vec![(None, start)];
        let mut steps = Vec::new();
        while let Some(&(by, class)) = open.last() {
            match self.leaving[class].pop() {
                Some((step, to)) => open.push((Some(step), to)),
                None => {
                    steps.extend(by);
                    open.pop();
                }
            }
        }
        steps.reverse();
        (steps.len() == count).then_some(steps)
    }
}
