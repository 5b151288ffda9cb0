//! The record of a team's execution, `kirk-team-execution/1`: what truly happened when, and who heard of it when.

use std::collections::{BTreeMap, BTreeSet};

use kirk_network::{EventId, Time};
use kirk_runtime::{Failure, How, Outcome, Reason};
use serde::{Deserialize, Serialize};

use crate::model::{AgentId, Team};
use crate::simulate::{TeamExecution, Trouble};
use crate::verify::{Late, Violation, late_news, verify_truth};

/// The `format` of the record written and read here.
pub const FORMAT: &str = "kirk-team-execution/1";

/// A finished (or failed) execution. All times are seconds after the origin, exact to a microsecond.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Always [`FORMAT`].
    pub format: String,
    /// The control program.
    pub program: String,
    /// What the team is called.
    pub team: String,
    /// Who belongs to it.
    pub agents: Vec<String>,
    /// Did it come to its end?
    pub outcome: Outcome,
    /// What went wrong first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<Failure>,
    /// When the last event happened.
    pub makespan: Time,
    /// The seed of a simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// One row for each name, in time order.
    pub rows: Vec<Row>,
}

/// What became of one event, under one of its names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The name.
    pub event: String,
    /// Who executed it, or is the first to observe it; `null` for the start, which is everybody's.
    pub agent: Option<String>,
    /// When it truly happened; `null` if it did not.
    pub happened: Option<Time>,
    /// Who heard of it and when: all but who executed it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub heard: BTreeMap<String, Heard>,
}

/// What one agent knows of an event that it does not execute.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Heard {
    /// When news of it first came; `null` if never.
    pub at: Option<Time>,
    /// When the agent took it as having happened, if it counts on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acted: Option<Time>,
    /// And how.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub how: Option<How>,
}

impl Record {
    /// Records an execution; of events that no user wrote only if they are asked for.
    pub fn new(
        (program, name): (&str, &str),
        team: &Team,
        execution: &TeamExecution,
        seed: u64,
        internal: bool,
    ) -> Record {
        let mut rows: Vec<Row> = Vec::new();
        let mut events: Vec<EventId> = team.network().event_ids().collect();
        events.sort_by_key(|event| {
            let at = execution.truth[event.index()];
            (at.is_none(), at, *event)
        });
        for event in events {
            // What joins several agents is executed by nobody, and happens at no moment of its own.
            let is_joint = team.owner(event).is_none() && event != team.network().origin();
            let names = team.network().events()[event.index()].names.iter();
            let shown = names.filter(|name| internal || !(name.internal || is_joint));
            rows.extend(shown.map(|name| Row {
                event: name.text.clone(),
                agent: team.owner(event).map(|agent| team.name(agent).to_string()),
                happened: execution.truth[event.index()],
                heard: heard(team, execution, event),
            }));
        }
        let failure = execution.troubles.first().map(|trouble| trouble.failure(team));
        Record {
            format: FORMAT.to_string(),
            program: program.to_string(),
            team: name.to_string(),
            agents: team.agents().to_vec(),
            outcome: if failure.is_some() { Outcome::Failed } else { Outcome::Completed },
            failure,
            makespan: execution.makespan,
            seed: Some(seed),
            rows,
        }
    }

    /// Of a mission that was not started, as no promises are known that make its team sure of it.
    pub fn not_executed((program, name): (&str, &str), team: &Team) -> Record {
        Record {
            format: FORMAT.to_string(),
            program: program.to_string(),
            team: name.to_string(),
            agents: team.agents().to_vec(),
            outcome: Outcome::Failed,
            failure: Some(Failure {
                event: program.to_string(),
                time: Time::ZERO,
                reason: Reason::NotControllable,
                detail: "there are no promises with which the team is sure of it".to_string(),
            }),
            makespan: Time::ZERO,
            seed: None,
            rows: Vec::new(),
        }
    }

    /// What of the team's mission was not so, each in a sentence, with the event it is about: requirements and Nature's durations in true
    /// time, and news that came when it cannot. Nothing if all is well.
    pub fn violations(&self, team: &Team) -> Vec<(Option<String>, String)> {
        let network = team.network();
        let mut found = Vec::new();
        if self.agents.iter().collect::<BTreeSet<_>>() != team.agents().iter().collect() {
            let (theirs, ours) = (self.agents.join(", "), team.agents().join(", "));
            found.push((None, format!("this is a record of {theirs}, and the team is {ours}")));
        }
        if let (Outcome::Failed, Some(failure)) = (&self.outcome, &self.failure) {
            found.push((Some(failure.event.clone()), failure.detail.clone()));
        }
        let mut execution = TeamExecution {
            truth: vec![None; network.events().len()],
            learned: vec![vec![None; network.events().len()]; team.agents().len()],
            acted: Vec::new(),
            makespan: self.makespan,
            troubles: Vec::new(),
        };
        for row in &self.rows {
            let Some(event) = network.find(&row.event) else {
                found.push((Some(row.event.clone()), format!("there is no event `{}`", row.event)));
                continue;
            };
            execution.truth[event.index()] = row.happened;
            for agent in team.agent_ids() {
                let is_own = network.link_of(event).is_none() && team.owner(event) == Some(agent);
                let heard = row.heard.get(team.name(agent)).and_then(|heard| heard.at);
                let at = if is_own { row.happened } else { heard };
                execution.learned[agent.index()][event.index()] = at;
                if let (Some(at), Some(soonest)) = (at, soonest(team, event, agent, row.happened))
                    && at < soonest
                {
                    let (event, agent) = (&row.event, team.name(agent));
                    let message =
                        format!("{agent} heard of `{event}` at {at} s, and cannot before {soonest} s");
                    found.push((Some(event.clone()), message));
                }
            }
        }
        // Events that no user wrote need not be in a record; there has to be a moment for each.
        let is_known = |violation: &&Violation| match violation {
            Violation::Never(event) => {
                network.events()[event.index()].names.iter().any(|name| !name.internal)
            }
            _ => true,
        };
        let kept = verify_truth(team, &execution.truth);
        found.extend(kept.iter().filter(is_known).map(|violation| violation.sentence(team)));
        found.extend(late_news(team, &execution).iter().map(|late| late.sentence(team)));
        found
    }
}

/// Before that nobody can have heard of it.
fn soonest(team: &Team, event: EventId, agent: AgentId, happened: Option<Time>) -> Option<Time> {
    let news = team.news(event, agent)?;
    // A stamp comes as soon as any message, and says when.
    let is_stamped = team.owner(event).is_some_and(|owner| team.reach().is_stamped(owner, agent));
    happened.map(|at| if is_stamped { at } else { at.saturating_add(news.min) })
}

fn heard(team: &Team, execution: &TeamExecution, event: EventId) -> BTreeMap<String, Heard> {
    let Some(owner) = team.owner(event) else { return BTreeMap::new() };
    let executes = |agent: AgentId| agent == owner && team.network().link_of(event).is_none();
    let one = |agent: AgentId| {
        let acted = execution.acted[agent.index()][event.index()];
        let heard = Heard {
            at: execution.learned[agent.index()][event.index()],
            acted: acted.map(|(at, _)| at),
            how: acted.map(|(_, how)| how),
        };
        (team.name(agent).to_string(), heard)
    };
    team.agent_ids().filter(|&agent| !executes(agent)).map(one).collect()
}

impl Trouble {
    fn failure(&self, team: &Team) -> Failure {
        let name = |event: EventId| team.network().label(event).to_string();
        match *self {
            Trouble::Missed { agent, event, latest } => Failure {
                event: name(event),
                time: latest,
                reason: Reason::MissedWindow,
                detail: format!(
                    "{} had to execute `{}` by {latest} s and could not",
                    team.name(agent),
                    name(event)
                ),
            },
            Trouble::Impossible { agent, event, at } => Failure {
                event: name(event),
                time: at,
                reason: Reason::BrokenModel,
                detail: format!(
                    "{} heard of `{}` at {at} s, which what it was promised rules out",
                    team.name(agent),
                    name(event)
                ),
            },
        }
    }
}

impl Violation {
    fn sentence(&self, team: &Team) -> (Option<String>, String) {
        let network = team.network();
        let name = |event: EventId| network.label(event).to_string();
        match *self {
            Violation::Never(event) => (Some(name(event)), format!("`{}` never happened", name(event))),
            Violation::BeforeOrigin(event) => {
                (Some(name(event)), format!("`{}` happened before the start", name(event)))
            }
            Violation::Requirement(index, length) => {
                let it = network.requirements()[index];
                let lower = it.lower.finite().map_or("-inf".to_string(), |lower| lower.to_string());
                let upper = it.upper.finite().map_or("inf".to_string(), |upper| upper.to_string());
                let (from, to) = (name(it.from), name(it.to));
                let message =
                    format!("from `{from}` to `{to}` it was {length} s, not within [{lower}, {upper}]");
                (Some(to), message)
            }
            Violation::Link(index, length) => {
                let it = network.contingents()[index];
                let (from, to) = (name(it.from), name(it.to));
                let message = format!(
                    "from `{from}` to `{to}` it was {length} s, not within Nature's [{}, {}]",
                    it.lower, it.upper
                );
                (Some(to), message)
            }
            Violation::Joints => (
                None,
                "what joins several agents could have been at no moment that keeps all requirements"
                    .to_string(),
            ),
            Violation::Promise(index, length) => {
                (None, format!("promise {index} was not kept: it was {length} s"))
            }
        }
    }
}

impl Late {
    fn sentence(&self, team: &Team) -> (Option<String>, String) {
        let Late { agent, event, at, by } = *self;
        let name = team.network().label(event).to_string();
        let when = at.map_or("never".to_string(), |at| format!("only at {at} s"));
        let message = format!("{} heard of `{name}` {when}, not by {by} s", team.name(agent));
        (Some(name), message)
    }
}
