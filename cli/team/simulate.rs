//! `kirk run --simulate` of a team: all executives and the links between them in one virtual time.

use std::io;

use kirk_compiler::{Diagnostic, Severity};
use kirk_picture::{Chart, Look};
use kirk_runtime::{How, Outcome, Strategy};
use kirk_team::record::{Heard, Record, Row};
use kirk_team::{Agreement, Mission, Mood, Ready, Simulation, Weather};

use crate::args::{Common, Links, Nature, Run, ShowFormat, StrategyName};
use crate::foreign::one_line;
use crate::input::Loaded;
use crate::json::line;
use crate::output::{Status, complain, eprint, print};
use crate::report::Reporter;
use crate::show::drawn;
use crate::team::{judge, promised};

pub(crate) fn run(arguments: &Run, common: &Common, mut input: Loaded) -> io::Result<Status> {
    let judged = judge(&mut input, false);
    let is_json = arguments.show.format == ShowFormat::Json;
    let reported = |diagnostic: &&Diagnostic| !is_json || diagnostic.severity == Severity::Error;
    let shown: Vec<Diagnostic> = input.diagnostics.iter().filter(reported).cloned().collect();
    Reporter::new(&input.sources).show(&shown, common)?;
    let Some(mission) = judged.and_then(|judged| judged.team) else { return Ok(Status::Wrong) };
    if let Some(refused) = refused(arguments, &mission) {
        complain(&refused);
        return Ok(Status::Wrong);
    }
    let program = input.program(&arguments.selection);
    let names = (program.as_str(), mission.name.as_str());
    let Some(record) =
        mission.agreement().and_then(|agreement| executed(arguments, &mission, agreement, names))
    else {
        if is_json {
            print(&line(&Record::not_executed(names, &mission.team))?)?;
        }
        return Ok(Status::No);
    };
    if common.verbose {
        eprint(&promised(&mission, true))?;
    }
    print(&match (is_json, arguments.show.format.picture()) {
        (true, _) => line(&record)?,
        (_, Some(picture)) => drawn(&Chart::of_team(&record), Look::default(), picture),
        (_, None) => timetable(&record),
    })?;
    Ok(if record.outcome == Outcome::Completed { Status::Yes } else { Status::No })
}

/// Why the options are none of a team's.
fn refused(arguments: &Run, mission: &Mission) -> Option<String> {
    let name = &mission.name;
    let about_one = [
        (!arguments.observe.is_empty(), "--observe"),
        (arguments.observations.is_some(), "--observations"),
        (arguments.what_if, "--what-if"),
        (arguments.show.why, "--why"),
    ];
    if let Some((_, option)) = about_one.into_iter().find(|(is_given, _)| *is_given) {
        return Some(format!(
            "`{option}` is of one executive, and the team `{name}` executes this; give it to the mission of one agent \
             (`kirk compile --agent NAME --format json`)"
        ));
    }
    (!arguments.simulate).then(|| {
        format!(
            "the team `{name}` executes this: `--simulate` executes all of its agents in one virtual time, and `kirk compile \
             --agent NAME --format json` prints the mission of one of them ({}), which `kirk run` executes",
            mission.team.agents().join(", ")
        )
    })
}

/// Executes all agents; `None` if a view cannot be executed, which those of an agreement can.
fn executed(
    arguments: &Run,
    mission: &Mission,
    agreement: &Agreement,
    names: (&str, &str),
) -> Option<Record> {
    let (delays, lost, doubled) = match arguments.links {
        None | Some(Links::Longest) => (Mood::Longest, 0, 0),
        Some(Links::Shortest) => (Mood::Shortest, 0, 0),
        Some(Links::Random) => (Mood::Random, 0, 0),
        Some(Links::Lossy) => (Mood::Random, 30, 20),
    };
    let simulation = Simulation {
        strategy: match arguments.strategy() {
            StrategyName::Buffer => Strategy::Buffer,
            StrategyName::Optimistic => Strategy::Optimistic,
        },
        nature: match arguments.nature {
            Nature::Upper => Mood::Longest,
            Nature::Lower => Mood::Shortest,
            Nature::Random => Mood::Random,
        },
        weather: Weather { delays, lost, doubled, ..Weather::default() },
        seed: arguments.seed,
        ..Simulation::default()
    };
    let execution = Ready::new(&mission.team, agreement).ok()?.run(&simulation);
    Some(Record::new(names, &mission.team, &execution, arguments.seed, arguments.show.internal))
}

/// All agents, if Nature and the links take the most; `None` if nothing makes the team sure of it.
pub(crate) fn longest(mission: &Mission, program: &str) -> Option<Record> {
    let execution = Ready::new(&mission.team, mission.agreement()?).ok()?.run(&Simulation::default());
    Some(Record::new((program, &mission.name), &mission.team, &execution, 0, false))
}

/// One line for each row: when it happened, and for each agent what it knows of it.
fn timetable(record: &Record) -> String {
    let end = match &record.failure {
        Some(failure) => {
            format!("failed at {} s: {} ({})", failure.time, one_line(&failure.detail), failure.reason.word())
        }
        None => format!("completed in {} s", record.makespan),
    };
    let headings = ["happened", "event"].map(str::to_string).into_iter().chain(record.agents.iter().cloned());
    let mut lines: Vec<Vec<String>> = vec![headings.collect()];
    for row in &record.rows {
        let happened = row.happened.map_or("-".to_string(), |at| at.to_string());
        let event = one_line(&row.event).into_owned();
        lines.push(
            [happened, event].into_iter().chain(record.agents.iter().map(|it| cell(row, it))).collect(),
        );
    }
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
    let mut text = format!("{} by {}: {end}\n\n", one_line(&record.program), one_line(&record.team));
    for line in &lines {
        let mut shown = format!("  {:>1$}", line[0], widths[0]);
        for (cell, width) in line.iter().zip(&widths).skip(1) {
            shown.push_str(&format!("  {cell:<width$}"));
        }
        text.push_str(shown.trim_end());
        text.push('\n');
    }
    text
}

/// What an agent knows of an event.
fn cell(row: &Row, agent: &str) -> String {
    let Some(owner) = &row.agent else { return "dispatched".to_string() };
    let Some(Heard { at, acted, how }) = row.heard.get(agent) else {
        return if owner == agent { "dispatched" } else { "-" }.to_string();
    };
    let heard = at.map_or("never heard".to_string(), |at| format!("heard at {at}"));
    match (how, acted) {
        (Some(how @ (How::Imagined | How::Buffered)), Some(acted)) => {
            format!("{heard}, {} at {acted}", how.word())
        }
        _ => heard,
    }
}
