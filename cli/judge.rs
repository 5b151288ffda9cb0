//! The verdict on an input, and the document that tells it: `kirk-check/1`.

use std::time::Instant;

use kirk_compiler::{Span, Told, too_large};
use kirk_network::assume::{Assumed, Assumption, check_assuming};
use kirk_network::merge::merge;
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Network, Verdict};
use serde::Serialize;

use crate::args::Delays;
use crate::conflict::{ConflictJson, MemberJson, members, told};
use crate::input::Loaded;
use crate::report::{DiagnosticJson, Reporter};
use crate::team::{self, TeamJson};

/// The verdict on a network and how long it took.
pub(crate) struct Judged {
    pub(crate) conflict: Option<Conflict>,
    /// All of them, each as it is told.
    told: Vec<Told>,
    seconds: f64,
    /// Of a mission that a team executes: whether the team can.
    pub(crate) team: Option<kirk_team::Mission>,
    pub(crate) merged: Network,
    /// What the conflict speaks of, if not the network of the input: the same with other delays.
    assumed: Option<Network>,
}

impl Judged {
    /// True if it can be executed whatever happens, by whoever executes it.
    pub(crate) fn is_yes(&self) -> bool {
        self.conflict.is_none() && self.team.as_ref().is_none_or(|team| team.agreement().is_some())
    }

    /// Of a team.
    pub(crate) fn by_team(
        team: kirk_team::Mission,
        (conflict, told): (Option<Conflict>, Vec<Told>),
        seconds: f64,
    ) -> Judged {
        let merged = merge(team.team.network()).network;
        Judged { conflict, told, seconds, team: Some(team), merged, assumed: None }
    }
}

/// Decides; a conflict becomes one of the diagnostics. `None` if there is no network.
pub(crate) fn judge(input: &mut Loaded) -> Option<Judged> {
    judge_assuming(input, Delays::AsWritten, false)
}

/// Decides as if delays were as they are said to be.
pub(crate) fn judge_assuming(input: &mut Loaded, delays: Delays, theory: bool) -> Option<Judged> {
    if input.team().is_some() {
        if delays != Delays::AsWritten {
            input.for_one_alone("`--delays`");
        }
        return team::judge(input, theory);
    }
    let network = input.network.as_ref()?;
    let start = Instant::now();
    let decided = match delays.assumption() {
        Assumption::AsWritten => kirk_network::check(network).map(|verdict| (verdict, None)),
        assumption => {
            check_assuming(network, assumption).map(|Assumed { verdict, network }| (verdict, Some(network)))
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let (conflict, assumed) = match decided {
        Ok((Verdict::Controllable, assumed)) => (None, assumed),
        Ok((Verdict::Uncontrollable(conflict), assumed)) => (Some(conflict), assumed),
        Err(TooLarge) => {
            input.diagnostics.push(too_large(Span::default()));
            return None;
        }
    };
    let merged = merge(network).network;
    let mut all = Vec::new();
    if let Some(first) = &conflict {
        let judged = assumed.as_ref().unwrap_or(network);
        all = told(first, judged, input, (delays.assumption(), theory));
        for told in &all {
            let mut diagnostic = told.diagnostic.clone();
            diagnostic.message.push_str(delays.words());
            input.diagnostics.push(diagnostic);
        }
    }
    Some(Judged { conflict, told: all, seconds, team: None, merged, assumed })
}

impl Delays {
    fn assumption(self) -> Assumption {
        match self {
            Delays::AsWritten => Assumption::AsWritten,
            Delays::Zero => Assumption::Zero,
            Delays::Minimum => Assumption::Minimum,
            Delays::Mean => Assumption::Mean,
            Delays::Maximum => Assumption::Maximum,
            Delays::Never => Assumption::Never,
            Delays::Elongated => Assumption::Elongated,
        }
    }

    /// What is decided, as `kirk-check/1` calls it.
    fn kind(self) -> &'static str {
        match self {
            Delays::AsWritten => "variable-delay",
            Delays::Zero => "dynamic",
            Delays::Minimum | Delays::Mean | Delays::Maximum => "fixed-delay",
            Delays::Never => "strong",
            Delays::Elongated => "elongated",
        }
    }

    /// The assumption as the end of "controllable ...".
    pub(crate) fn words(self) -> &'static str {
        match self {
            Delays::AsWritten => "",
            Delays::Zero => " if all news comes at once",
            Delays::Minimum => " if all news is as early as it can be",
            Delays::Mean => " if all news is late by its mean delay",
            Delays::Maximum => " if all news is as late as it can be",
            Delays::Never => " if no news ever comes",
            Delays::Elongated => " if durations and delays are one uncertainty",
        }
    }
}

/// `kirk-check/1`.
#[derive(Serialize)]
pub(crate) struct CheckJson<'a> {
    format: &'static str,
    pub(crate) file: &'a str,
    #[serde(flatten)]
    pub(crate) verdict: VerdictJson,
    /// Of a mission that a team executes.
    #[serde(skip_serializing_if = "Option::is_none")]
    team: Option<TeamJson<'a>>,
    diagnostics: Vec<DiagnosticJson<'a>>,
    conflict: Vec<MemberJson>,
    pub(crate) conflicts: Vec<ConflictJson<'a>>,
}

/// What was decided, of what, and how long that took.
#[derive(Clone, Serialize)]
pub(crate) struct VerdictJson {
    /// `null` if nothing could be decided.
    controllable: Option<bool>,
    kind: &'static str,
    events: usize,
    requirements: usize,
    contingents: usize,
    conservative: bool,
    seconds: f64,
}

impl<'a> CheckJson<'a> {
    pub(crate) fn new(
        file: &'a str,
        input: &'a Loaded,
        judged: Option<&'a Judged>,
        delays: Delays,
        reporter: &'a Reporter<'_>,
    ) -> CheckJson<'a> {
        // The one that is told first, which lacks what is missing.
        let told = judged.and_then(|judged| judged.told.first()).map(|told| &told.conflict);
        let conflict = told.or(judged.and_then(|judged| judged.conflict.as_ref()));
        let merged = judged.map(|judged| &judged.merged);
        let assumed = judged.and_then(|judged| judged.assumed.as_ref());
        let network = assumed.or(input.network.as_ref());
        let all = judged.iter().flat_map(|judged| &judged.told);
        CheckJson {
            format: "kirk-check/1",
            file,
            verdict: VerdictJson {
                controllable: judged.map(Judged::is_yes),
                kind: delays.kind(),
                events: merged.map_or(0, |network| network.events().len()),
                requirements: merged.map_or(0, |network| network.requirements().len()),
                contingents: merged.map_or(0, |network| network.contingents().len()),
                conservative: conflict.is_some_and(|conflict| conflict.conservative),
                seconds: judged.map_or(0.0, |judged| judged.seconds),
            },
            team: judged
                .and_then(|judged| judged.team.as_ref())
                .map(|team| TeamJson::new(team, input, reporter)),
            diagnostics: input.diagnostics.iter().map(|d| reporter.to_json(d)).collect(),
            conflict: match (conflict, network) {
                (Some(conflict), Some(network)) => members(conflict, network, input, reporter),
                _ => Vec::new(),
            },
            conflicts: match network {
                Some(network) => all.map(|told| ConflictJson::new(told, network, input, reporter)).collect(),
                None => Vec::new(),
            },
        }
    }
}
