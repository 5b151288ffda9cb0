//! The independent verifier of a team: does what truly happened keep every requirement of its network, and every promise?
//!
//! It knows nothing of views and of how promises were found.

use kirk_network::{Bound, Delay, Duration, EventId, Time};

use crate::find::Agreement;
use crate::model::{AgentId, Team};
use crate::rules::Rules;
use crate::simulate::TeamExecution;
use crate::views::news;
use crate::whole::Whole;

/// Something that happened otherwise than the team's network says. Events, requirements and links are those of the team's network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// An event that is somebody's did not come about.
    Never(EventId),
    /// An event came before the origin.
    BeforeOrigin(EventId),
    /// So long it was between the ends of a requirement.
    Requirement(usize, Duration),
    /// So long a contingent link took.
    Link(usize, Duration),
    /// There are no moments for the joints of nobody that keep all requirements.
    Joints,
    /// So long it was between the base of a promise and its event.
    Promise(usize, Duration),
}

/// News that came later than Nature and the links allow, which breaks the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Late {
    /// Who heard it.
    pub agent: AgentId,
    /// Of which event.
    pub event: EventId,
    /// When; `None` if never.
    pub at: Option<Time>,
    /// By when it should have been.
    pub by: Time,
}

/// Checks what truly happened. An empty list means that all is well.
pub fn verify(team: &Team, agreement: &Agreement, execution: &TeamExecution) -> Vec<Violation> {
    let network = team.network();
    let mut violations = verify_truth(team, &execution.truth);
    let truth = |event: EventId| execution.truth[event.index()];
    let named = |event: EventId| network.find(agreement.network.id(event)).and_then(truth);
    for (index, promise) in agreement.promises.iter().enumerate() {
        let (Some(base), Some(event)) = (named(promise.base), named(promise.event)) else { continue };
        let length = event.saturating_since(base);
        if length < promise.low || length > promise.high {
            violations.push(Violation::Promise(index, length));
        }
    }
    violations
}

/// The same of all but the promises: by event of the team's network when it happened.
pub fn verify_truth(team: &Team, happened: &[Option<Time>]) -> Vec<Violation> {
    let network = team.network();
    let truth = |event: EventId| happened[event.index()];
    let mut violations = Vec::new();
    for event in network.event_ids() {
        match truth(event) {
            None if team.owner(event).is_some() => violations.push(Violation::Never(event)),
            Some(at) if at < Time::ZERO => violations.push(Violation::BeforeOrigin(event)),
            _ => {}
        }
    }
    for (index, requirement) in network.requirements().iter().enumerate() {
        let (Some(from), Some(to)) = (truth(requirement.from), truth(requirement.to)) else { continue };
        let length = to.saturating_since(from);
        if !within(length, requirement.lower, requirement.upper) {
            violations.push(Violation::Requirement(index, length));
        }
    }
    for (index, link) in network.contingents().iter().enumerate() {
        let (Some(from), Some(to)) = (truth(link.from), truth(link.to)) else { continue };
        let length = to.saturating_since(from);
        if length < link.lower || length > link.upper {
            violations.push(Violation::Link(index, length));
        }
    }
    if !have_moments(team, happened) {
        violations.push(Violation::Joints);
    }
    violations
}

fn within(length: Duration, lower: Bound, upper: Bound) -> bool {
    lower.finite().is_none_or(|lower| length >= lower) && upper.finite().is_none_or(|upper| length <= upper)
}

/// True if the events that nobody executes could have been at some moments: no negative cycle, with all others where they were.
fn have_moments(team: &Team, happened: &[Option<Time>]) -> bool {
    let network = team.network();
    let mut edges: Vec<(usize, usize, i64)> = Vec::new();
    let origin = network.origin().index();
    // An end that is known is the origin, so much later.
    let place = |event: EventId| match happened[event.index()] {
        Some(at) => (origin, at.as_micros()),
        None => (event.index(), 0),
    };
    for (from, to, weight) in network.requirements().iter().flat_map(|it| it.edges()).flatten() {
        let ((a, before), (b, after)) = (place(from), place(to));
        if a != b {
            edges.push((a, b, weight.as_micros().saturating_add(before).saturating_sub(after)));
        } else if a != origin && weight < Duration::ZERO {
            return false;
        }
    }
    edges.extend((0..network.events().len()).filter(|&it| it != origin).map(|event| (event, origin, 0)));
    let mut most = vec![0_i64; network.events().len()];
    for _ in 0..=most.len() {
        let mut changed = false;
        for &(from, to, weight) in &edges {
            let there = most[from].saturating_add(weight);
            if there < most[to] {
                most[to] = there;
                changed = true;
            }
        }
        if !changed {
            return true;
        }
    }
    false
}

/// The news that came too late.
pub fn late_news(team: &Team, execution: &TeamExecution) -> Vec<Late> {
    let whole = Whole::new(team);
    let mut late = Vec::new();
    for event in team.network().event_ids().filter(|&event| team.owner(event).is_some()) {
        let Some(truth) = execution.truth[event.index()] else { continue };
        for agent in team.agent_ids() {
            let class = whole.merged.event_of[event.index()];
            let Delay { max: Bound::Finite(max), .. } = news(team, &whole, class, agent, &Rules::ALL) else {
                continue;
            };
            let (by, at) = (truth.saturating_add(max), execution.learned[agent.index()][event.index()]);
            if class != whole.origin() && at.is_none_or(|at| at > by) {
                late.push(Late { agent, event, at, by });
            }
        }
    }
    late
}
