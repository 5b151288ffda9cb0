//! A team: a network, who owns each event, and the links between the agents.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use kirk_network::{Bound, Delay, Duration, EventId, Network, nearest};

use crate::reach::{Arc, Reach};

/// An agent, an index into [`Team::agents`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AgentId(pub u32);

impl AgentId {
    /// The position in [`Team::agents`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A link as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// One agent, by name.
    pub from: String,
    /// The other.
    pub to: String,
    /// How long a message takes; [`Bound::Infinite`] if it may be lost.
    pub delay: Delay,
    /// Messages go from the first to the second only.
    pub one_way: bool,
    /// Messages say when they were told, by clocks that agree.
    pub stamped: bool,
}

/// A network, an owner of each event, and links between the agents. Valid by construction.
///
/// The owner of an executable event executes it; the owner of a contingent one observes it first, with the delay that the network
/// gives it. The origin is everybody's: all agents start together. An executable event without an owner is a joint that nobody
/// has to execute.
#[derive(Clone, Debug)]
pub struct Team {
    network: Network,
    agents: Vec<String>,
    links: Vec<Link>,
    arcs: Vec<Arc>,
    reach: Reach,
    owner: Vec<Option<AgentId>>,
    agreed: Vec<(EventId, EventId)>,
}

impl Team {
    /// Builds a team, or says everything that is wrong with its parts. `owners` has a name for each event of the network, in order;
    /// what it says of the origin is of no importance.
    pub fn new(
        network: Network,
        agents: Vec<String>,
        links: Vec<Link>,
        owners: &[Option<String>],
    ) -> Result<Team, Vec<TeamError>> {
        let mut errors = Vec::new();
        let number = number_agents(&agents, &mut errors);
        let arcs = arcs(&links, &number, &mut errors);
        let owner = owner_of_events(&network, &number, owners, &mut errors);
        if !errors.is_empty() {
            return Err(errors);
        }
        let reach = Reach::new(agents.len(), &arcs);
        let team = Team { network, agents, links, arcs, reach, owner, agreed: Vec::new() };
        let errors = team.faults_of_requirements();
        if errors.is_empty() { Ok(team) } else { Err(errors) }
    }

    /// The same team, with the author's wish of what the promise of an event is measured from: pairs of an event and its base.
    #[must_use]
    pub fn agreed(mut self, agreed: Vec<(EventId, EventId)>) -> Team {
        self.agreed = agreed;
        self
    }

    pub(crate) fn wishes(&self) -> &[(EventId, EventId)] {
        &self.agreed
    }

    /// The network of the whole team.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// The names of the agents; an [`AgentId`] is an index into this.
    pub fn agents(&self) -> &[String] {
        &self.agents
    }

    /// All agents.
    pub fn agent_ids(&self) -> impl Iterator<Item = AgentId> + use<> {
        (0..self.agents.len() as u32).map(AgentId)
    }

    /// The name of an agent.
    pub fn name(&self, agent: AgentId) -> &str {
        &self.agents[agent.index()]
    }

    /// The links as they were written.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The links in each direction.
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// Who hears of whom, and how late.
    pub fn reach(&self) -> &Reach {
        &self.reach
    }

    /// Who owns an event; `None` for the origin and for joints.
    pub fn owner(&self, event: EventId) -> Option<AgentId> {
        self.owner[event.index()]
    }

    /// The same team with another link in the place of one.
    pub fn with_link(&self, number: usize, link: Link) -> Option<Team> {
        let mut links = self.links.clone();
        *links.get_mut(number)? = link;
        let owners: Vec<Option<String>> =
            self.owner.iter().map(|owner| owner.map(|agent| self.name(agent).to_string())).collect();
        let team = Team::new(self.network.clone(), self.agents.clone(), links, &owners).ok()?;
        Some(team.agreed(self.agreed.clone()))
    }

    /// When news of an event reaches an agent, after the event: its own delay and the links'. `None` if never.
    pub fn news(&self, event: EventId, to: AgentId) -> Option<Delay> {
        let own = match self.network.link_of(event) {
            Some(link) => self.network.contingents()[link].delay,
            None => Delay::NONE,
        };
        match self.owner(event) {
            Some(owner) => self.reach.delay(owner, to).map(|way| sum(own, way)),
            None => Some(own),
        }
    }

    fn faults_of_requirements(&self) -> Vec<TeamError> {
        let mut errors = Vec::new();
        let mut told = BTreeSet::new();
        for (index, requirement) in self.network.requirements().iter().enumerate() {
            let ends = [requirement.from, requirement.to];
            let [Some(from), Some(to)] = ends.map(|event| self.owner(event)) else { continue };
            if from == to {
                continue;
            }
            let no_way = |a, b| self.reach.delay(a, b).is_none();
            if no_way(from, to) && no_way(to, from) && told.insert((from.min(to), from.max(to))) {
                let [from, to] = [from, to].map(|agent| self.name(agent).to_string());
                let event = self.network.label(requirement.to).to_string();
                errors.push(TeamError::Unreachable { requirement: index, from, to, event });
            }
            if requirement.is_join() {
                errors.extend(self.same_moment(index, ends).or(self.same_moment(index, [ends[1], ends[0]])));
            }
        }
        errors
    }

    /// An event of one agent that is to be the very moment of an end that Nature chooses and that the agent hears of later.
    fn same_moment(&self, requirement: usize, [given, other]: [EventId; 2]) -> Option<TeamError> {
        let link = self.network.contingents()[self.network.link_of(given)?];
        if self.network.link_of(other).is_some() || link.lower == link.upper {
            return None;
        }
        let agent = self.owner(other)?;
        let news = self.news(given, agent);
        (news != Some(Delay::NONE)).then(|| TeamError::SameMoment {
            requirement,
            event: self.network.label(other).to_string(),
            agent: self.name(agent).to_string(),
            end: self.network.label(given).to_string(),
            news,
        })
    }
}

/// One delay after another.
fn sum(a: Delay, b: Delay) -> Delay {
    let max = match (a.max, b.max) {
        (Bound::Finite(a), Bound::Finite(b)) => Bound::Finite(a.saturating_add(b)),
        _ => Bound::Infinite,
    };
    Delay { min: a.min.saturating_add(b.min), max }
}

fn number_agents<'a>(agents: &'a [String], errors: &mut Vec<TeamError>) -> BTreeMap<&'a str, AgentId> {
    if agents.is_empty() {
        errors.push(TeamError::NoAgents);
    }
    let mut number = BTreeMap::new();
    for (index, name) in agents.iter().enumerate() {
        if number.insert(name.as_str(), AgentId(index as u32)).is_some() {
            errors.push(TeamError::TwoOfOneName { name: name.clone() });
        }
    }
    number
}

fn known(
    number: &BTreeMap<&str, AgentId>,
    name: &str,
    place: Place,
    errors: &mut Vec<TeamError>,
) -> Option<AgentId> {
    let agent = number.get(name).copied();
    if agent.is_none() {
        let like = nearest(name, number.keys().copied()).map(str::to_string);
        errors.push(TeamError::UnknownAgent { name: name.to_string(), place, like });
    }
    agent
}

fn arcs(links: &[Link], number: &BTreeMap<&str, AgentId>, errors: &mut Vec<TeamError>) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for (index, link) in links.iter().enumerate() {
        let ends = [&link.from, &link.to].map(|name| known(number, name, Place::Link(index), errors));
        let is_late = link.delay.max.finite().is_some_and(|max| max < link.delay.min);
        if link.delay.min < Duration::ZERO || is_late {
            errors.push(TeamError::LinkBounds { link: index, delay: link.delay });
        }
        let [Some(from), Some(to)] = ends else { continue };
        if from == to {
            errors.push(TeamError::LinkToItself { link: index, name: link.from.clone() });
        }
        let Link { delay, stamped, .. } = *link;
        let arc = Arc { from, to, delay, stamped, link: index as u32 };
        arcs.push(arc);
        if !link.one_way {
            arcs.push(Arc { from: to, to: from, ..arc });
        }
    }
    arcs
}

fn owner_of_events(
    network: &Network,
    number: &BTreeMap<&str, AgentId>,
    owners: &[Option<String>],
    errors: &mut Vec<TeamError>,
) -> Vec<Option<AgentId>> {
    if owners.len() != network.events().len() {
        errors.push(TeamError::OwnersMissing { events: network.events().len(), owners: owners.len() });
        return Vec::new();
    }
    let mut owner = Vec::with_capacity(owners.len());
    for (event, name) in network.event_ids().zip(owners) {
        let name = name.as_deref().filter(|_| event != network.origin());
        let place = Place::Event(event);
        let agent = name.and_then(|name| known(number, name, place, errors));
        if name.is_none() && network.link_of(event).is_some() {
            errors.push(TeamError::EndOfNobody { event: network.label(event).to_string() });
        }
        owner.push(agent);
    }
    for link in network.contingents() {
        let nobody = link.from != network.origin() && owners[link.from.index()].is_none();
        if nobody && network.link_of(link.from).is_none() {
            errors.push(TeamError::StartOfNobody {
                event: network.label(link.from).to_string(),
                end: network.label(link.to).to_string(),
            });
        }
    }
    owner
}

/// Where an agent is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a link, by its number.
    Link(usize),
    /// As the owner of an event.
    Event(EventId),
}

/// Why parts do not make a team.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TeamError {
    /// There is no agent.
    NoAgents,
    /// Two agents go by this name.
    TwoOfOneName {
        /// The name.
        name: String,
    },
    /// No agent goes by this name.
    UnknownAgent {
        /// The name.
        name: String,
        /// Where it stands.
        place: Place,
        /// The nearest name there is.
        like: Option<String>,
    },
    /// A link leads from an agent to itself.
    LinkToItself {
        /// Which link.
        link: usize,
        /// The agent.
        name: String,
    },
    /// A delay is not `0 <= min <= max`.
    LinkBounds {
        /// Which link.
        link: usize,
        /// The delay.
        delay: Delay,
    },
    /// There is not one owner, or the lack of one, for each event.
    OwnersMissing {
        /// So many events.
        events: usize,
        /// So many owners.
        owners: usize,
    },
    /// Nobody observes a contingent event.
    EndOfNobody {
        /// The event.
        event: String,
    },
    /// Nobody executes the event at which a contingent link starts.
    StartOfNobody {
        /// The event.
        event: String,
        /// The end of the link.
        end: String,
    },
    /// A requirement between events of two agents, neither of which hears of the other.
    Unreachable {
        /// The requirement, by its number.
        requirement: usize,
        /// One agent.
        from: String,
        /// The other.
        to: String,
        /// The event of the other.
        event: String,
    },
    /// An event is to be the very moment of an end that its agent hears of only later.
    SameMoment {
        /// The requirement, by its number.
        requirement: usize,
        /// The event.
        event: String,
        /// Who executes it.
        agent: String,
        /// The end.
        end: String,
        /// How late the agent hears of it; `None` if never.
        news: Option<Delay>,
    },
}

impl fmt::Display for TeamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TeamError::NoAgents => write!(f, "the team has no agents; there must be at least one"),
            TeamError::TwoOfOneName { name } => {
                write!(f, "two agents are called `{name}`; each needs a name of its own")
            }
            TeamError::UnknownAgent { name, like, .. } => {
                write!(f, "there is no agent `{name}`")?;
                like.as_ref().map_or(Ok(()), |like| write!(f, "; did you mean `{like}`?"))
            }
            TeamError::LinkToItself { name, .. } => {
                write!(f, "the link leads from `{name}` to itself; an agent knows what it knows at once")
            }
            TeamError::LinkBounds { delay, .. } => {
                write!(f, "the delay [{}, {}] is not 0 <= min <= max", delay.min, shown(delay.max))
            }
            TeamError::OwnersMissing { events, owners } => {
                write!(f, "there are {owners} owners for {events} events; each event needs one, or none")
            }
            TeamError::EndOfNobody { event } => {
                write!(f, "nobody observes `{event}`; say which agent sees it first")
            }
            TeamError::StartOfNobody { event, end } => {
                write!(f, "nobody executes `{event}`, with which the way to `{end}` begins; give it an agent")
            }
            TeamError::Unreachable { from, to, event, .. } => write!(
                f,
                "no link leads from `{from}` to `{to}` or back, yet a requirement ties `{event}` of `{to}` to what `{from}` \
                 does; add a link between them (one whose messages may all be lost, if need be)"
            ),
            TeamError::SameMoment { event, agent, end, news, .. } => {
                write!(f, "`{event}` of `{agent}` cannot be the same moment as `{end}`: ")?;
                match news {
                    Some(delay) if delay.max == Bound::Infinite => {
                        write!(f, "the news takes {} s or more and may be lost", delay.min)?;
                    }
                    Some(delay) => write!(f, "the news takes {} to {} s", delay.min, shown(delay.max))?,
                    None => write!(f, "there is no way for the news")?,
                }
                write!(f, "; allow some time between them")
            }
        }
    }
}

impl std::error::Error for TeamError {}

fn shown(bound: Bound) -> String {
    bound.finite().map_or("infinity".to_string(), |finite| finite.to_string())
}
