//! Who executes a mission together: what `define-team` says, and whose each event of the network is.

use std::collections::BTreeMap;

use kirk_network::{Bound, Delay, Duration, EventId, Network};

use crate::episode::{Episode, Kind};
use crate::lower::events_of;
use crate::origins::Origins;
use crate::source::Span;
use crate::typed;

/// A team, and whose the events of a network are.
#[derive(Clone, Debug)]
pub struct Team {
    /// Its name.
    pub name: String,
    /// Who belongs to it.
    pub agents: Vec<String>,
    /// How news travels between them.
    pub links: Vec<Link>,
    /// For each event of the network, its agent by its position: who executes it, or hears of it first if Nature decides. `None`
    /// for what joins several agents.
    pub owners: Vec<Option<u32>>,
}

/// A link between two agents.
#[derive(Clone, Debug)]
pub struct Link {
    /// One agent, by its position.
    pub from: u32,
    /// The other.
    pub to: u32,
    /// How long a message takes; it may be lost if there is no most.
    pub delay: Delay,
    /// True if messages go from the first to the second only.
    pub one_way: bool,
    /// True if messages say when what they tell of happened.
    pub stamped: bool,
    /// Where it is written.
    pub span: Span,
}

/// Who owns the events of a tree of episodes.
pub(crate) fn team(written: &typed::Team, root: &Episode) -> Team {
    let numbers: BTreeMap<&str, u32> =
        written.agents.iter().zip(0..).map(|(agent, number)| (agent.name.as_str(), number)).collect();
    let number = |agent: &Option<String>| numbers.get(agent.as_deref()?).copied();
    let episodes = events_of(root);
    let mut owners = vec![None; 2 * episodes.len()];
    for (episode, (start, end)) in episodes {
        owners[start.index()] = number(&episode.agent);
        let is_natures = episode.kind == Kind::Primitive && episode.contingent;
        let observer = number(&episode.observed_by).filter(|_| is_natures);
        owners[end.index()] = observer.or(number(&episode.agent));
    }
    let link = |link: &typed::Link| Link {
        from: link.from as u32,
        to: link.to as u32,
        delay: Delay {
            min: link.delay.lower.value.seconds().unwrap_or(Duration::ZERO),
            max: link.delay.upper.value.seconds().map_or(Bound::Infinite, Bound::Finite),
        },
        one_way: link.one_way,
        stamped: link.stamped,
        span: link.span,
    };
    Team {
        name: written.name.name.clone(),
        agents: written.agents.iter().map(|agent| agent.name.clone()).collect(),
        links: written.links.iter().map(link).collect(),
        owners,
    }
}

/// What no team can do, whatever it promises.
pub(crate) enum Problem {
    /// The moment of an end that Nature chooses, at which an agent is to act who hears of it later.
    NotTheSameMoment { join: Span, event: String, agent: String, end: String, news: Option<Delay>, at: Span },
    /// A constraint between two agents of whom neither hears of the other.
    Unreachable { constraint: Span, agents: [String; 2] },
}

/// Finds it.
pub(crate) fn faults(team: &Team, network: &Network, origins: &Origins) -> Vec<Problem> {
    let hears = team.hears();
    let mut problems = Vec::new();
    let mut joined: Vec<Vec<(EventId, usize)>> = vec![Vec::new(); network.events().len()];
    for (index, requirement) in network.requirements().iter().enumerate() {
        let ends = [requirement.from, requirement.to];
        if requirement.is_join() {
            joined[ends[0].index()].push((ends[1], index));
            joined[ends[1].index()].push((ends[0], index));
        }
        if let [Some(from), Some(to)] = ends.map(|event| team.owner(event, network))
            && from != to
            && hears[from][to].is_none()
            && hears[to][from].is_none()
        {
            let agents = [from, to].map(|agent| team.agents[agent].clone());
            problems.push(Problem::Unreachable { constraint: origins.requirements[index].span, agents });
        }
    }
    for (link, origin) in network.contingents().iter().zip(&origins.contingents) {
        let Some(observer) = team.owner(link.to, network).filter(|_| link.lower < link.upper) else {
            continue;
        };
        for (event, index) in same_moment(link.to, &joined) {
            let Some(agent) = team.owner(event, network).filter(|agent| *agent != observer) else { continue };
            let news = hears[observer][agent].map(|way| sum(link.delay, way));
            if network.link_of(event).is_none() && news != Some(Delay::NONE) {
                problems.push(Problem::NotTheSameMoment {
                    join: origins.requirements[index].span,
                    event: network.label(event).to_string(),
                    agent: team.agents[agent].clone(),
                    end: network.label(link.to).to_string(),
                    news,
                    at: origin.span,
                });
                break;
            }
        }
    }
    problems
}

/// The events at the moment of another, each with the requirement that says so, the nearest first.
fn same_moment(event: EventId, joined: &[Vec<(EventId, usize)>]) -> Vec<(EventId, usize)> {
    let mut found = vec![(event, usize::MAX)];
    let mut next = 0;
    while next < found.len() {
        for &(event, index) in &joined[found[next].0.index()] {
            if found.iter().all(|(known, _)| *known != event) {
                found.push((event, index));
            }
        }
        next += 1;
    }
    found.split_off(1)
}

impl Team {
    /// Whose an event is; the origin, at which all begin together, is nobody's.
    fn owner(&self, event: EventId, network: &Network) -> Option<usize> {
        self.owners[event.index()].filter(|_| event != network.origin()).map(|agent| agent as usize)
    }

    /// How late each agent hears of each other, news being passed on: the shortest ways of the least and of the greatest delays,
    /// each by itself (Floyd and Warshall). `None` if never.
    fn hears(&self) -> Vec<Vec<Option<Delay>>> {
        let count = self.agents.len();
        let mut ways = vec![vec![None; count]; count];
        for (agent, row) in ways.iter_mut().enumerate() {
            row[agent] = Some(Delay::NONE);
        }
        for link in &self.links {
            let delay = if link.stamped {
                Delay { min: link.delay.max.finite().unwrap_or(link.delay.min), ..link.delay }
            } else {
                link.delay
            };
            let (from, to) = (link.from as usize, link.to as usize);
            ways[from][to] = sooner(ways[from][to], Some(delay));
            if !link.one_way {
                ways[to][from] = sooner(ways[to][from], Some(delay));
            }
        }
        for over in 0..count {
            for from in 0..count {
                for to in 0..count {
                    let way = ways[from][over].zip(ways[over][to]).map(|(first, then)| sum(first, then));
                    ways[from][to] = sooner(ways[from][to], way);
                }
            }
        }
        ways
    }
}

fn sum(first: Delay, then: Delay) -> Delay {
    let max = match (first.max, then.max) {
        (Bound::Finite(first), Bound::Finite(then)) => Bound::Finite(first.saturating_add(then)),
        _ => Bound::Infinite,
    };
    Delay { min: first.min.saturating_add(then.min), max }
}

fn sooner(one: Option<Delay>, other: Option<Delay>) -> Option<Delay> {
    match (one, other) {
        (Some(one), Some(other)) => {
            let max = match (one.max, other.max) {
                (Bound::Finite(one), Bound::Finite(other)) => Bound::Finite(one.min(other)),
                (Bound::Infinite, bound) | (bound, Bound::Infinite) => bound,
            };
            Some(Delay { min: one.min.min(other.min), max })
        }
        (one, other) => one.or(other),
    }
}
