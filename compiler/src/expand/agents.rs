//! Who executes each episode of a team's mission.
//!
//! An activity is its agent's. So are the forms around activities of one agent alone, and the waits among them. What joins
//! several agents is nobody's: no one has to execute it.

use super::problem::Problem;
use super::{Expander, Frame};
use crate::ast::ValueKind;
use crate::episode::Episode;
use crate::evaluate::evaluate;
use crate::typed::Expression;

impl Expander<'_> {
    /// The agent that is meant; what stands for none is reported.
    pub(super) fn agent(&mut self, written: &Expression, frame: &Frame<'_>) -> Option<String> {
        // Only a variable is no agent yet, and to look at its value is nothing that could go wrong.
        let value = evaluate(written, &frame.variables).ok()?;
        let team = self.model.team.as_ref()?;
        let named = match &value.kind {
            ValueKind::Name(None, name) => Some(name.clone()),
            _ => None,
        };
        let agent = named.filter(|name| team.agents.iter().any(|agent| agent.name == *name));
        if agent.is_none() {
            let agents = team.agents.iter().map(|agent| agent.name.clone()).collect();
            self.problems.push(Problem::NoAgent { named: written.span, value, agents, call: frame.call });
        }
        agent
    }
}

/// Gives every episode that can have one an agent. Activities have theirs already.
pub(super) fn settle(root: &mut Episode) {
    gather(root);
    hand_down(root, None);
}

/// Who has to do with an episode.
enum Agents {
    Nobody,
    One(String),
    Several,
}

impl Agents {
    fn and(self, other: Agents) -> Agents {
        match (self, other) {
            (Agents::One(one), Agents::One(other)) if one == other => Agents::One(one),
            (Agents::Nobody, agents) | (agents, Agents::Nobody) => agents,
            _ => Agents::Several,
        }
    }
}

/// From the activities up: an episode is its agent's if it has to do with no other, whoever it was given to.
fn gather(episode: &mut Episode) -> Agents {
    let within = episode.parts.iter_mut().map(gather).fold(Agents::Nobody, Agents::and);
    match &within {
        Agents::Nobody => {
            let one = |agent: &Option<String>| agent.clone().map_or(Agents::Nobody, Agents::One);
            return one(&episode.agent).and(one(&episode.observed_by));
        }
        Agents::One(agent) => episode.agent = Some(agent.clone()),
        Agents::Several => episode.agent = None,
    }
    within
}

/// Down to the waits, which have to do with nobody: they are of whoever the form around them is.
fn hand_down(episode: &mut Episode, around: Option<&str>) {
    if episode.agent.is_none() {
        episode.agent = around.map(str::to_string);
    }
    let agent = episode.agent.clone();
    episode.parts.iter_mut().for_each(|part| hand_down(part, agent.as_deref()));
}
