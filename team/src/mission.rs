//! From a mission as it is compiled to a team and the verdict on it, in the words and places of its source.

use std::collections::BTreeMap;

use kirk_compiler::{self as compiler, Diagnostic, Explain, OriginKind, Origins, Span, too_large};
use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Duration, EventId, Network, Requirement};

use crate::find::{Agreement, Options, Verdict, find};
use crate::model::{AgentId, Link, Team, TeamError};
use crate::shortage::{Remedy, remedies};
use crate::wording;

/// Of teams with more events than this no remedies are looked for: each takes dozens of searches.
const LARGE: usize = 400;
/// So many choices are looked through in each of them; somebody waits.
const FEW: usize = 2;

/// A mission of a team, and whether the team can execute it.
#[derive(Clone, Debug)]
pub struct Mission {
    /// What the team is called.
    pub name: String,
    /// The team.
    pub team: Team,
    /// What was found.
    pub verdict: Verdict,
    /// Of what was not found: the links that would do if they were other than they are.
    pub remedies: Vec<Remedy>,
    /// Where each link is written.
    pub(crate) places: Vec<Span>,
}

/// Why there is no verdict on a team's mission.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoVerdict {
    /// Its parts do not go together. Most of what can be wrong the compiler has told already.
    Team(Vec<TeamError>),
    /// Its durations add up to too much.
    TooLarge,
}

/// The team that executes this network.
///
/// # Errors
/// What is wrong with it.
pub fn team(written: &compiler::Team, network: &Network) -> Result<Team, Vec<TeamError>> {
    let name = |agent: u32| written.agents[agent as usize].clone();
    let link = |link: &compiler::Link| Link {
        from: name(link.from),
        to: name(link.to),
        delay: link.delay,
        one_way: link.one_way,
        stamped: link.stamped,
    };
    let owners: Vec<Option<String>> = written.owners.iter().map(|owner| owner.map(name)).collect();
    let links = written.links.iter().map(link).collect();
    Team::new(network.clone(), written.agents.clone(), links, &owners)
}

/// Judges a team's mission.
///
/// # Errors
/// Why there is no verdict.
pub fn judge(
    written: &compiler::Team,
    network: &Network,
    origins: &Origins,
    options: &Options,
) -> Result<Mission, NoVerdict> {
    let team = team(written, network).map_err(NoVerdict::Team)?;
    let agreed = agreed(&team, origins);
    let team = team.agreed(agreed);
    let too_large = |TooLarge| NoVerdict::TooLarge;
    let verdict = find(&team, options).map_err(too_large)?;
    let remedies = match &verdict {
        Verdict::NotFound(missing) if network.events().len() <= LARGE => {
            let quick = Options { choices: FEW, soonest: false, ..*options };
            remedies(&team, missing, &quick).map_err(too_large)?
        }
        _ => Vec::new(),
    };
    let places = written.links.iter().map(|link| link.span).collect();
    Ok(Mission { name: written.name.clone(), team, verdict, remedies, places })
}

/// What the author says how long something of one agent comes after something of another, with both bounds: that is a promise.
fn agreed(team: &Team, origins: &Origins) -> Vec<(EventId, EventId)> {
    let network = team.network();
    let all = network.requirements().iter().zip(&origins.requirements);
    let between = all.filter(|(it, origin)| {
        let is_after = it.lower.finite().is_some_and(|lower| lower >= Duration::ZERO);
        let is_ours = network.link_of(it.to).is_none() && team.owner(it.to).is_some();
        let are_two = team.owner(it.from) != team.owner(it.to);
        // A bound that is not written stands where the whole does.
        let [lower, upper, ..] = origin.places;
        let is_written = upper.start < lower.start || lower.end < upper.end;
        let has_both = is_written && is_after && it.upper.finite().is_some();
        origin.kind == OriginKind::Between && has_both && is_ours && are_two
    });
    between.map(|(it, _)| (it.to, it.from)).collect()
}

impl Mission {
    /// What the agents have agreed on, if they can do it.
    pub fn agreement(&self) -> Option<&Agreement> {
        if let Verdict::Yes(agreement) = &self.verdict { Some(agreement) } else { None }
    }

    /// What an agent executes, with one requirement at most between any two events, from the earlier to the later if that is known.
    pub fn view(&self, agent: AgentId) -> Option<Network> {
        let view = &self.agreement()?.views.get(agent.index())?.network;
        let mut bounds: BTreeMap<(EventId, EventId), (i64, i64)> = BTreeMap::new();
        for (from, to, most) in view.requirements().iter().flat_map(|it| it.edges()).flatten() {
            let (ends, is_upper) = if from < to { ((from, to), true) } else { ((to, from), false) };
            let (least, upper) = bounds.entry(ends).or_insert((i64::MIN, i64::MAX));
            match is_upper {
                true => *upper = most.as_micros().min(*upper),
                false => *least = (-most.as_micros()).max(*least),
            }
        }
        let finite = |bound: i64| Bound::Finite(Duration::from_micros(bound));
        let lower = |bound: i64| if bound == i64::MIN { Bound::Infinite } else { finite(bound) };
        let upper = |bound: i64| if bound == i64::MAX { Bound::Infinite } else { finite(bound) };
        let requirement = |((from, to), (least, most)): ((EventId, EventId), (i64, i64))| match most {
            ..=0 if least < 0 => {
                let upper = if least == i64::MIN { Bound::Infinite } else { finite(-least) };
                Requirement { from: to, to: from, lower: finite(-most), upper }
            }
            _ => Requirement { from, to, lower: lower(least), upper: upper(most) },
        };
        let requirements = bounds.into_iter().map(requirement).collect();
        let (events, contingents) = (view.events().to_vec(), view.contingents().to_vec());
        Network::new(view.name().to_string(), view.origin(), events, requirements, contingents).ok()
    }

    /// Why not, in the source; nothing if they can. What would settle a conflict of the whole is not said: it may not be enough where
    /// news is late.
    pub fn diagnostics(&self, explain: &Explain<'_>) -> Vec<Diagnostic> {
        match &self.verdict {
            Verdict::Yes(_) => Vec::new(),
            Verdict::NotFound(missing) => vec![wording::not_found(self, missing, explain)],
            Verdict::No(conflict) => vec![explain.one(conflict).diagnostic],
        }
    }
}

impl NoVerdict {
    /// It at the mission, which is named there.
    pub fn diagnostics(&self, mission: Span) -> Vec<Diagnostic> {
        match self {
            NoVerdict::Team(errors) => errors.iter().map(|wrong| wording::no_team(wrong, mission)).collect(),
            NoVerdict::TooLarge => vec![too_large(mission)],
        }
    }
}
