//! The mission of a team: the verdict on it, for people and as part of `kirk-check/1`.

use std::time::Instant;

use kirk_compiler::{Explain, Span};
use kirk_network::{Delay, Duration};
use kirk_team::mission::judge as judge_team;
use kirk_team::{Agreement, Cause, Change, Member, Mission, NotFound, Options, Promise, Remedy, Verdict};
use serde::Serialize;

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
