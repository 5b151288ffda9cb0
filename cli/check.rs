//! `kirk check`: all diagnostics and the verdict for each file.

use std::io;

use kirk_compiler::Severity;

use crate::args::{Check, CheckFormat, Common};
use crate::elsewhere;
use crate::input::{Loaded, load, load_all, shown};
use crate::json::line;
use crate::judge::{CheckJson, Judged, judge_assuming};
use crate::news::treatment;
use crate::output::{Status, print, print_line};
use crate::report::Reporter;
use crate::sarif::Log;
use crate::team;

pub(crate) fn check(arguments: &Check, common: &Common) -> io::Result<Status> {
    let mut worst = Status::Yes;
    let mut log = Log::default();
    for (file, mut input) in inputs(arguments) {
        let judged = judge_assuming(&mut input, arguments.delays, arguments.theory);
        worst = worst.max(match &judged {
            None => Status::Wrong,
            Some(judged) if judged.is_yes() => Status::Yes,
            Some(_) => Status::No,
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
                if let Some(team) = judged.as_ref().and_then(|judged| judged.team.as_ref()) {
                    print(&team::promised(team, common.verbose))?;
                } else if common.verbose
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
fn inputs(arguments: &Check) -> Vec<(String, Loaded)> {
    let Check { files, selection, .. } = arguments;
    if arguments.together {
        let all: Vec<&str> = files.iter().map(|file| shown(file)).collect();
        return vec![(all.join(" "), load_all(files, selection))];
    }
    let one = |(index, file): (usize, &String)| match file == "-" && files[..index].contains(file) {
        true => Loaded::twice(),
        false => load(file, selection),
    };
    let mut inputs: Vec<Loaded> = files.iter().enumerate().map(one).collect();
    elsewhere::point_out(&mut inputs);
    files.iter().map(|file| shown(file).to_string()).zip(inputs).collect()
}

fn verdict_line(file: &str, input: &Loaded, judged: Option<&Judged>, arguments: &Check) -> String {
    let Some(judged) = judged else {
        let errors = input.diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        let plural = if errors == 1 { "" } else { "s" };
        return format!("{file}: {errors} error{plural}");
    };
    let network = &judged.merged;
    let verdict = match &judged.team {
        Some(team) => team::verdict(team),
        None if judged.conflict.is_none() => "controllable".to_string(),
        None => "not controllable".to_string(),
    };
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
