//! `kirk check`: all diagnostics and the verdict for each file.

use std::io;
use std::time::Instant;

use kirk_compiler::{Code, Diagnostic, Severity, Span};
use kirk_network::merge::merge;
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Network, Verdict};
use serde::Serialize;

use crate::args::{Check, Common, Selection, TextOrJson};
use crate::conflict::{self, MemberJson};
use crate::input::{Input, load};
use crate::json::line;
use crate::output::{Status, print, print_line};
use crate::report::{DiagnosticJson, Reporter};

pub(crate) fn check(arguments: &Check, common: &Common) -> io::Result<Status> {
    let mut worst = Status::Yes;
    for file in &arguments.files {
        worst = worst.max(check_one(file, arguments, common)?);
    }
    Ok(worst)
}

fn check_one(file: &str, arguments: &Check, common: &Common) -> io::Result<Status> {
    let mut input = load(file, &arguments.selection);
    let judged = judge(&mut input);
    let status = match &judged {
        None => Status::Wrong,
        Some(Judged { conflict: None, .. }) => Status::Yes,
        Some(Judged { conflict: Some(_), .. }) => Status::No,
    };
    let reporter = Reporter::new(&input.sources);
    match arguments.format {
        TextOrJson::Json => {
            let document = CheckJson::new(file, &input, judged.as_ref(), &reporter);
            print(&line(&document)?)?;
        }
        TextOrJson::Text => {
            reporter.show(&input.diagnostics, common)?;
            if !common.quiet || status == Status::Yes {
                print_line(&verdict_line(file, &input, judged.as_ref(), &arguments.selection))?;
            }
        }
    }
    Ok(status)
}

/// The verdict on a network and how long it took.
pub(crate) struct Judged {
    pub(crate) conflict: Option<Conflict>,
    seconds: f64,
    merged: Network,
}

/// Decides; a conflict becomes one of the diagnostics. `None` if there is no network.
pub(crate) fn judge(input: &mut Input) -> Option<Judged> {
    let network = input.network.as_ref()?;
    let start = Instant::now();
    let verdict = kirk_network::check(network);
    let seconds = start.elapsed().as_secs_f64();
    let conflict = match verdict {
        Ok(Verdict::Controllable) => None,
        Ok(Verdict::Uncontrollable(conflict)) => Some(conflict),
        Err(TooLarge) => {
            input.diagnostics.push(too_large());
            return None;
        }
    };
    let merged = merge(network).network;
    if let Some(conflict) = &conflict {
        let diagnostic = conflict::diagnostic(conflict, network, input);
        input.diagnostics.push(diagnostic);
    }
    Some(Judged { conflict, seconds, merged })
}

pub(crate) fn too_large() -> Diagnostic {
    Diagnostic::error(Code::NumbersTooLarge, Span::default(), TooLarge.to_string())
}

fn verdict_line(file: &str, input: &Input, judged: Option<&Judged>, selection: &Selection) -> String {
    let Some(judged) = judged else {
        let errors = input.diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        let plural = if errors == 1 { "" } else { "s" };
        return format!("{file}: {errors} error{plural}");
    };
    let network = &judged.merged;
    let verdict = if judged.conflict.is_none() { "controllable" } else { "not controllable" };
    let program = input.program(selection);
    let name = if input.compilation.is_some() { format!("`{program}` is ") } else { String::new() };
    format!(
        "{file}: {name}{verdict} ({} events, {} requirements, {} contingent links)",
        network.events().len(),
        network.requirements().len(),
        network.contingents().len()
    )
}

#[derive(Serialize)]
struct CheckJson<'a> {
    format: &'static str,
    file: &'a str,
    controllable: Option<bool>,
    kind: &'static str,
    events: usize,
    requirements: usize,
    contingents: usize,
    conservative: bool,
    seconds: f64,
    diagnostics: Vec<DiagnosticJson<'a>>,
    conflict: Vec<MemberJson>,
}

impl<'a> CheckJson<'a> {
    fn new(
        file: &'a str,
        input: &'a Input,
        judged: Option<&Judged>,
        reporter: &Reporter<'_>,
    ) -> CheckJson<'a> {
        let conflict = judged.and_then(|judged| judged.conflict.as_ref());
        let merged = judged.map(|judged| &judged.merged);
        CheckJson {
            format: "kirk-check/1",
            file,
            controllable: judged.map(|judged| judged.conflict.is_none()),
            kind: "variable-delay",
            events: merged.map_or(0, |network| network.events().len()),
            requirements: merged.map_or(0, |network| network.requirements().len()),
            contingents: merged.map_or(0, |network| network.contingents().len()),
            conservative: conflict.is_some_and(|conflict| conflict.conservative),
            seconds: judged.map_or(0.0, |judged| judged.seconds),
            diagnostics: input.diagnostics.iter().map(|d| reporter.to_json(d)).collect(),
            conflict: match (conflict, &input.network) {
                (Some(conflict), Some(network)) => conflict::to_json(conflict, network, input, reporter),
                _ => Vec::new(),
            },
        }
    }
}
