//! A conflict as a story: step by step what is needed, who decides it, and how much is there.

use kirk_network::walk::{Step, walk};
use kirk_network::{Conflict, Duration, Network, Part};

use super::is_circle;
use crate::origins::Origins;
use crate::source::Source;
use crate::wording;

/// A step of a story.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoryStep {
    /// The bound by which it leads on.
    pub part: Part,
    /// What is needed for it; negative where so much is there.
    pub needs: Duration,
    /// In words.
    pub text: String,
}

/// The story; `None` if the walk would be too long to tell anything. What takes no time is left out, but in a circle.
pub(super) fn steps(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    sources: &[Source],
) -> Option<Vec<StoryStep>> {
    let mut steps = walk(network, conflict)?;
    begin_with_a_need(&mut steps);
    let is_circle = is_circle(conflict);
    let mut told: Vec<StoryStep> = Vec::new();
    for step in steps.iter().filter(|step| is_circle || step.needs != Duration::ZERO) {
        // Of what has no origin there is nothing to say.
        let Some(origin) = origins.of(step.part) else { continue };
        let text = wording::conflict::step(step, origin, sources, told.is_empty());
        told.push(StoryStep { part: step.part, needs: step.needs, text });
    }
    Some(told)
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
