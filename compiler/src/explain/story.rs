//! A conflict as a story: step by step what is needed, who decides it, and how much is there.

use kirk_network::walk::{Step, walk};
use kirk_network::{Conflict, Duration, Network, Part};

use super::is_circle;
use crate::origins::{Origin, Origins};
use crate::repair::amount;
use crate::source::Source;

/// No line of a story is longer: with what a terminal shows before it, it fits 80 columns.
const WIDTH: usize = 74;

/// A step of a story.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
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
) -> Option<Vec<Said>> {
    let mut steps = walk(network, conflict)?;
    begin_with_a_need(&mut steps);
    let is_circle = is_circle(conflict);
    let mut told: Vec<Said> = Vec::new();
    for step in steps.iter().filter(|step| is_circle || step.needs != Duration::ZERO) {
        // There is a "but" only to what was said before.
        let but = if told.is_empty() { "" } else { "but " };
        let said = |text| Said { part: step.part, needs: step.needs, text };
        told.extend(say(step, origins, sources, but).map(said));
    }
    Some(told)
}

/// The story in numbered lines.
pub(super) fn lines(conflict: &Conflict, story: &[Said]) -> Vec<String> {
    if story.is_empty() {
        return Vec::new();
    }
    let is_circle = is_circle(conflict);
    let mut lines = vec![match is_circle {
        true => "Each of these comes after the one before, and the first after the last:".to_string(),
        false => "Step by step:".to_string(),
    }];
    for (number, Said { text, .. }) in story.iter().enumerate() {
        lines.extend(wrapped(&format!("{:>2}. ", number + 1), text));
    }
    if !is_circle {
        let needed = sum(story.iter().map(|step| step.needs).filter(|needs| *needs > Duration::ZERO));
        let there = -sum(story.iter().map(|step| step.needs).filter(|needs| *needs < Duration::ZERO));
        lines.push(format!("That needs {needed} s, and {there} s are there."));
    }
    lines
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

fn sum(amounts: impl Iterator<Item = Duration>) -> Duration {
    amounts.fold(Duration::ZERO, |sum, amount| sum.checked_add(amount).unwrap_or(Duration::MAX))
}

/// One step; `None` for what goes without saying.
fn say(step: &Step, origins: &Origins, sources: &[Source], but: &str) -> Option<String> {
    let (origin, side) = origins.of(step.part)?;
    let written = |needs: Duration| amount(needs.abs(), origin.place(side), sources);
    let Origin { kind, text, end, .. } = origin;
    Some(match step.part {
        Part::LinkUpper(_) => format!("Nature may take {} {}", written(step.needs), origin.about()),
        Part::LinkLower(_) => format!("{but}Nature may take only {} {}", written(step.needs), origin.about()),
        Part::DelayMax(_) => format!("the news of {end} may take {}", written(step.needs)),
        Part::DelayMin(_) => format!("{but}the news of {end} may take only {}", written(step.needs)),
        _ if !kind.is_amount() => text.clone(),
        _ if step.needs == Duration::ZERO => format!("the order {}", origin.about()),
        Part::RequirementLower(_) if step.needs > Duration::ZERO => {
            format!("you need at least {} {}", written(step.needs), origin.about())
        }
        Part::RequirementUpper(_) if step.needs > Duration::ZERO => {
            format!("you need at least {} the other way than {}", written(step.needs), origin.about())
        }
        _ => format!("you allow at most {} {}", written(step.needs), origin.about()),
    })
}

/// A text in lines that are not too long, those after the first indented below it.
pub(super) fn wrapped(lead: &str, text: &str) -> Vec<String> {
    let mut lines = vec![lead.to_string()];
    for word in text.split(' ') {
        let indent = lead.chars().count();
        if let Some(last) = lines.last_mut() {
            let length = last.chars().count();
            if length > indent && length + 1 + word.chars().count() > WIDTH {
                lines.push(format!("{:indent$}{word}", ""));
            } else {
                let blank = if length > indent { " " } else { "" };
                last.push_str(&format!("{blank}{word}"));
            }
        }
    }
    lines
}
