//! `kirk check`: all diagnostics and the verdict for each file.

use std::io;
use std::time::Instant;

use kirk_compiler::{Code, Diagnostic, Severity, Span};
use kirk_network::assume::{Assumed, Assumption, check_assuming};
use kirk_network::merge::merge;
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Network, Verdict};
use serde::Serialize;

use crate::args::{Check, CheckFormat, Common, Delays};
use crate::conflict::{self, MemberJson};
use crate::elsewhere;
use crate::input::{Input, load, load_all, shown};
use crate::json::line;
use crate::news::treatment;
use crate::output::{Status, print, print_line};
use crate::report::{DiagnosticJson, Reporter};
use crate::sarif::Log;

pub(crate) fn check(arguments: &Check, common: &Common) -> io::Result<Status> {
    let mut worst = Status::Yes;
    let mut log = Log::default();
    for (file, mut input) in inputs(arguments) {
        let judged = judge_assuming(&mut input, arguments.delays, arguments.theory);
        worst = worst.max(match &judged {
            None => Status::Wrong,
            Some(Judged { conflict: None, .. }) => Status::Yes,
            Some(Judged { conflict: Some(_), .. }) => Status::No,
        });
        let reporter = Reporter::new(&input.sources);
        let document = || CheckJson::new(&file, &input, judged.as_ref(), arguments.delays, &reporter);
        match arguments.format {
            CheckFormat::Json => print(&line(&document())?)?,
            CheckFormat::Sarif => log.add(&input, &reporter, &document()),
            CheckFormat::Short => reporter.show_short(&input.diagnostics, common)?,
            CheckFormat::Text => {
                reporter.show(&input.diagnostics, common)?;
                print_line(&verdict_line(&file, &input, judged.as_ref(), arguments))?;
                if common.verbose
                    && let Some(network) = &input.network
                {
                    print(&treatment(network))?;
                }
            }
        }
    }
    if arguments.format == CheckFormat::Sarif {
        print(&line(&log.document(worst))?)?;
    }
    Ok(worst)
}

/// What is judged, each with what to call it: every file by itself, or all of them as one program.
fn inputs(arguments: &Check) -> Vec<(String, Input)> {
    let Check { files, selection, .. } = arguments;
    if arguments.together {
        let all: Vec<&str> = files.iter().map(|file| shown(file)).collect();
        return vec![(all.join(" "), load_all(files, selection))];
    }
    let one = |(index, file): (usize, &String)| match file == "-" && files[..index].contains(file) {
        true => Input::twice(),
        false => load(file, selection),
    };
    let mut inputs: Vec<Input> = files.iter().enumerate().map(one).collect();
    elsewhere::point_out(&mut inputs, selection);
    files.iter().map(|file| shown(file).to_string()).zip(inputs).collect()
}

/// The verdict on a network and how long it took.
pub(crate) struct Judged {
    pub(crate) conflict: Option<Conflict>,
    seconds: f64,
    merged: Network,
    /// What the conflict speaks of, if not the network of the input: the same with other delays.
    assumed: Option<Network>,
}

/// Decides; a conflict becomes one of the diagnostics. `None` if there is no network.
pub(crate) fn judge(input: &mut Input) -> Option<Judged> {
    judge_assuming(input, Delays::AsWritten, false)
}

fn judge_assuming(input: &mut Input, delays: Delays, theory: bool) -> Option<Judged> {
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
            input.diagnostics.push(too_large());
            return None;
        }
    };
    let merged = merge(network).network;
    if conflict.is_some() {
        let judged = assumed.as_ref().unwrap_or(network);
        for mut diagnostic in conflict::diagnostics(judged, input, theory) {
            diagnostic.message.push_str(delays.words());
            input.diagnostics.push(diagnostic);
        }
    }
    Some(Judged { conflict, seconds, merged, assumed })
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
    fn words(self) -> &'static str {
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

pub(crate) fn too_large() -> Diagnostic {
    Diagnostic::error(Code::NumbersTooLarge, Span::default(), TooLarge.to_string())
}

fn verdict_line(file: &str, input: &Input, judged: Option<&Judged>, arguments: &Check) -> String {
    let Some(judged) = judged else {
        let errors = input.diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        let plural = if errors == 1 { "" } else { "s" };
        return format!("{file}: {errors} error{plural}");
    };
    let network = &judged.merged;
    let verdict = if judged.conflict.is_none() { "controllable" } else { "not controllable" };
    let program = input.program(&arguments.selection);
    let name = if input.compilation().is_some() { format!("`{program}` is ") } else { String::new() };
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    format!(
        "{file}: {name}{verdict}{} ({}, {}, {})",
        arguments.delays.words(),
        count(network.events().len(), "event"),
        count(network.requirements().len(), "requirement"),
        count(network.contingents().len(), "contingent link")
    )
}

/// `kirk-check/1`.
#[derive(Serialize)]
pub(crate) struct CheckJson<'a> {
    format: &'static str,
    pub(crate) file: &'a str,
    #[serde(flatten)]
    pub(crate) verdict: VerdictJson,
    diagnostics: Vec<DiagnosticJson<'a>>,
    pub(crate) conflict: Vec<MemberJson>,
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
    fn new(
        file: &'a str,
        input: &'a Input,
        judged: Option<&Judged>,
        delays: Delays,
        reporter: &Reporter<'_>,
    ) -> CheckJson<'a> {
        let conflict = judged.and_then(|judged| judged.conflict.as_ref());
        let merged = judged.map(|judged| &judged.merged);
        let assumed = judged.and_then(|judged| judged.assumed.as_ref());
        let network = assumed.or(input.network.as_ref());
        CheckJson {
            format: "kirk-check/1",
            file,
            verdict: VerdictJson {
                controllable: judged.map(|judged| judged.conflict.is_none()),
                kind: delays.kind(),
                events: merged.map_or(0, |network| network.events().len()),
                requirements: merged.map_or(0, |network| network.requirements().len()),
                contingents: merged.map_or(0, |network| network.contingents().len()),
                conservative: conflict.is_some_and(|conflict| conflict.conservative),
                seconds: judged.map_or(0.0, |judged| judged.seconds),
            },
            diagnostics: input.diagnostics.iter().map(|d| reporter.to_json(d)).collect(),
            conflict: match (conflict, network) {
                (Some(conflict), Some(network)) => conflict::to_json(conflict, network, input, reporter),
                _ => Vec::new(),
            },
        }
    }
}
