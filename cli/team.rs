//! The mission of a team: the verdict on it, for people and as part of `kirk-check/1`.

pub(crate) mod simulate;
pub(crate) mod verify;

use std::collections::BTreeMap;
use std::time::Instant;

use kirk_compiler::{Explain, Span, Team, nearest};
use kirk_network::merge::merge;
use kirk_network::{Delay, Duration, Network, json};
use kirk_team::mission::judge as judge_team;
use kirk_team::{
    AgentId, Agreement, Cause, Change, Member, Mission, NotFound, Options, Promise, Remedy, Verdict,
};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::compile::Refusal;
use crate::conflict::SpotJson;
use crate::input::Loaded;
use crate::judge::Judged;
use crate::news::treatment;
use crate::report::Reporter;

/// Decides whether the team of an input can execute it; why not is among the diagnostics. `None` if that cannot be decided.
pub(crate) fn judge(input: &mut Loaded, theory: bool) -> Option<Judged> {
    let network = input.network.as_ref()?;
    let start = Instant::now();
    let origins = input.origins()?;
    let judged = judge_team(input.team()?, network, origins, &Options::default());
    let seconds = start.elapsed().as_secs_f64();
    let mission = match judged {
        Ok(mission) => mission,
        Err(why) => {
            input.diagnostics.extend(why.diagnostics(input.program_span().unwrap_or_default()));
            return None;
        }
    };
    let explain =
        Explain { network, origins, sources: &input.sources, program: input.program_span(), theory };
    let found = match &mission.verdict {
        Verdict::No(conflict) => (Some(conflict.clone()), vec![explain.one(conflict)]),
        Verdict::Yes(_) | Verdict::NotFound(_) => (None, Vec::new()),
    };
    let said = mission.diagnostics(&explain);
    input.diagnostics.extend(said);
    Some(Judged::by_team(mission, found, seconds))
}

/// What one agent of the team of an input executes.
///
/// # Errors
/// Why there is no such thing; if the team cannot be sure of it that is among the diagnostics.
pub(crate) fn view(input: &mut Loaded, agent: &str) -> Result<Network, Refusal> {
    let Some(written) = input.team() else {
        return Err(Refusal::Options(format!(
            "`--agent {agent}` asks what one agent of a team executes, and this mission has no `define-team`"
        )));
    };
    let wanted = agent.to_lowercase();
    let Some(number) = written.agents.iter().position(|known| *known == wanted) else {
        let near = nearest(&wanted, written.agents.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!(" (did you mean `{near}`?)"));
        let known = written.agents.join(", ");
        return Err(Refusal::Options(format!(
            "no agent of the team is called `{agent}`{near}; the agents are {known}"
        )));
    };
    let mission = judge(input, false).and_then(|judged| judged.team).ok_or(Refusal::Input)?;
    mission.view(AgentId(number as u32)).ok_or(Refusal::NotControllable)
}

/// What can be asked for instead of the network of the whole team.
pub(crate) fn what_else(written: &Team) -> String {
    let Team { name, agents, .. } = written;
    format!(
        "this is all of the team `{name}`; `--agent NAME` prints what one of its agents executes: {}",
        agents.join(", ")
    )
}

/// The verdict as the end of "`main` is ...".
pub(crate) fn verdict(mission: &Mission) -> String {
    let name = &mission.name;
    match mission.verdict {
        Verdict::Yes(_) => format!("controllable by the team `{name}`"),
        Verdict::No(_) => {
            format!("not controllable by the team `{name}`, not even if all knew everything at once")
        }
        Verdict::NotFound(_) => {
            format!("not found to be controllable by the team `{name}`: kirk knows no promises that would do")
        }
    }
}

/// What the agents promise each other, in lines; if asked for also how each treats news.
pub(crate) fn promised(mission: &Mission, verbose: bool) -> String {
    let Some(agreement) = mission.agreement() else { return String::new() };
    let mut lines: Vec<String> =
        agreement.sentences(&mission.team).into_iter().map(|it| format!("  {it}\n")).collect();
    if lines.is_empty() {
        lines.push("  no agent has to promise anything\n".to_string());
    }
    for view in agreement.views.iter().filter(|_| verbose) {
        lines.push(format!("{}:\n{}", mission.team.name(view.agent), treatment(&view.network)));
    }
    lines.concat()
}

/// `kirk-team/1`: the network of a team's mission, and whose each event is. A network file would be read as that of one alone.
#[derive(Serialize)]
pub(crate) struct NetworkJson<'a> {
    format: &'static str,
    name: &'a str,
    agents: &'a [String],
    links: Vec<LinkJson<'a>>,
    /// By each name of each event that is somebody's.
    owners: BTreeMap<&'a str, &'a str>,
    network: Option<Box<RawValue>>,
}

#[derive(Serialize)]
struct LinkJson<'a> {
    from: &'a str,
    to: &'a str,
    delay: (Duration, Option<Duration>),
    one_way: bool,
    stamped: bool,
}

impl<'a> NetworkJson<'a> {
    pub(crate) fn new(written: &'a Team, network: &'a Network) -> NetworkJson<'a> {
        let agent = |number: u32| written.agents[number as usize].as_str();
        let link = |link: &kirk_compiler::Link| LinkJson {
            from: agent(link.from),
            to: agent(link.to),
            delay: (link.delay.min, link.delay.max.finite()),
            one_way: link.one_way,
            stamped: link.stamped,
        };
        let mut owners = BTreeMap::new();
        for (event, owner) in network.events().iter().zip(&written.owners) {
            let names = event.names.iter().map(|name| name.text.as_str());
            owners
                .extend(owner.iter().flat_map(|owner| names.clone().map(move |name| (name, agent(*owner)))));
        }
        NetworkJson {
            format: "kirk-team/1",
            name: &written.name,
            agents: &written.agents,
            links: written.links.iter().map(link).collect(),
            owners,
            network: RawValue::from_string(json::write(&merge(network).network)).ok(),
        }
    }
}

/// `team` of `kirk-check/1`.
#[derive(Serialize)]
pub(crate) struct TeamJson<'a> {
    name: &'a str,
    agents: &'a [String],
    verdict: &'static str,
    promises: Vec<PromiseJson<'a>>,
    /// Of what was not found.
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<MissingJson<'a>>,
}

#[derive(Serialize)]
pub(crate) struct PromiseJson<'a> {
    agent: &'a str,
    event: &'a str,
    base: &'a str,
    lower: Duration,
    upper: Duration,
    heard: Vec<HeardJson<'a>>,
}

/// Who counts on a promise, and how late the news is that it was kept; `null` if it never comes.
#[derive(Serialize)]
struct HeardJson<'a> {
    agent: &'a str,
    delay: Option<(Duration, Option<Duration>)>,
}

#[derive(Serialize)]
struct MissingJson<'a> {
    lacks: Option<Duration>,
    members: Vec<MemberJson<'a>>,
    remedies: Vec<RemedyJson<'a>>,
}

#[derive(Serialize)]
struct MemberJson<'a> {
    kind: &'static str,
    text: String,
    #[serde(flatten)]
    place: SpotJson<'a>,
    times: i64,
}

/// A link as it would have to be, with all else as it is.
#[derive(Serialize)]
struct RemedyJson<'a> {
    from: &'a str,
    to: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    max_delay: Option<Duration>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stamped: Option<bool>,
}

impl<'a> TeamJson<'a> {
    pub(crate) fn new(mission: &'a Mission, input: &'a Loaded, reporter: &'a Reporter<'_>) -> TeamJson<'a> {
        let (verdict, missing) = match &mission.verdict {
            Verdict::Yes(_) => ("yes", None),
            Verdict::No(_) => ("no", None),
            Verdict::NotFound(missing) => {
                ("not-found", Some(MissingJson::new(missing, mission, input, reporter)))
            }
        };
        TeamJson {
            name: &mission.name,
            agents: mission.team.agents(),
            verdict,
            promises: mission.agreement().map_or(Vec::new(), |agreement| promises(agreement, mission)),
            missing,
        }
    }
}

/// The promises of a team, for programs.
pub(crate) fn promises<'a>(agreement: &'a Agreement, mission: &'a Mission) -> Vec<PromiseJson<'a>> {
    let team = &mission.team;
    let delay = |news: Option<Delay>| news.map(|Delay { min, max }| (min, max.finite()));
    let one = |promise: &Promise| PromiseJson {
        agent: agreement.owner(promise, team).map_or("", |agent| team.name(agent)),
        event: agreement.network.label(promise.event),
        base: agreement.network.label(promise.base),
        lower: promise.low,
        upper: promise.high,
        heard: (agreement.hearers(promise, team).into_iter())
            .map(|(agent, news)| HeardJson { agent: team.name(agent), delay: delay(news) })
            .collect(),
    };
    agreement.promises.iter().map(one).collect()
}

impl<'a> MissingJson<'a> {
    fn new(
        missing: &'a NotFound,
        mission: &'a Mission,
        input: &'a Loaded,
        reporter: &'a Reporter<'_>,
    ) -> MissingJson<'a> {
        let member = |&Member { what, times }: &Member| {
            let (kind, text, span) = what_and_where(what, mission, input);
            MemberJson { kind, text, place: SpotJson::new(span, reporter), times }
        };
        let remedy = |remedy: &Remedy| {
            let link = &mission.team.links()[remedy.link];
            let (max_delay, stamped) = match remedy.change {
                Change::Within(most) => (Some(most), None),
                Change::Stamped => (None, Some(true)),
            };
            RemedyJson { from: &link.from, to: &link.to, max_delay, stamped }
        };
        MissingJson {
            lacks: missing.lacks,
            members: missing.members.iter().map(member).collect(),
            remedies: mission.remedies.iter().map(remedy).collect(),
        }
    }
}

fn what_and_where(what: Cause, mission: &Mission, input: &Loaded) -> (&'static str, String, Span) {
    let of_link = |kind, link: u32| (kind, mission.says(link, what), mission.place(link));
    match what {
        Cause::Longest(link) => of_link("longest-delay", link),
        Cause::Shortest(link) => of_link("shortest-delay", link),
        Cause::Part(part) => {
            let origin = input.origins().and_then(|origins| origins.constraint(part));
            let (text, span) = origin.map_or_else(Default::default, |origin| (origin.text(), origin.span));
            ("bound", text, span)
        }
    }
}
