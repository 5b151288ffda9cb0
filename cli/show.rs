//! `kirk show`: pictures of missions, records and journals.

use std::io;
use std::path::Path;

use kirk_compiler::Explain;
use kirk_network::json::parse;
use kirk_network::{Duration, EventId, Network};
use kirk_picture::{Chart, Look, Scene, html, mermaid, svg};
use kirk_runtime::execution::is_record;
use kirk_runtime::journal::{is_journal, read as read_journal};
use kirk_runtime::{Execution, replay};
use kirk_team::record::Record;

use crate::args::{Common, Picture, Pictures, Selection};
use crate::foreign::one_line;
use crate::input::{Bytes, Loaded, load_begun, read, without_mark};
use crate::output::{Status, complain, deliver};
use crate::replay::LARGEST_JOURNAL;
use crate::report::Reporter;
use crate::team;
use crate::verify::execution_of;

pub(crate) fn show(arguments: &Pictures, common: &Common) -> io::Result<Status> {
    let look = match look(arguments.start.as_deref()) {
        Ok(look) => look,
        Err(message) => return wrong(&message),
    };
    let format = match format(arguments) {
        Ok(format) => format,
        Err(message) => return wrong(&message),
    };
    let first = read(&arguments.files[0], LARGEST_JOURNAL);
    let chart = match &first {
        Ok(bytes) if is_journal(bytes) => of_journal(arguments, bytes),
        Ok(bytes) if team::verify::is_record(bytes) => of_team_record(arguments, bytes),
        Ok(bytes) if is_record(bytes) => return of_record(arguments, first, look, format, common),
        _ => {
            let input = load_begun(&arguments.files, Some(first), &arguments.selection);
            if input.team().is_some() {
                return of_team(arguments, input, look, format, common);
            }
            let Some(chart) = of_input(&input, &arguments.selection) else {
                Reporter::new(&input.sources).show(&input.diagnostics, common)?;
                return Ok(Status::Wrong);
            };
            Ok(chart)
        }
    };
    match chart {
        Ok(chart) => deliver(&drawn(&chart, look, format), arguments.output.as_deref()),
        Err(message) => wrong(&message),
    }
}

fn wrong(message: &str) -> io::Result<Status> {
    complain(message);
    Ok(Status::Wrong)
}

/// A chart in a format.
pub(crate) fn drawn(chart: &Chart, look: Look, format: Picture) -> String {
    match format {
        Picture::Svg => svg(&Scene::new(chart, look)),
        Picture::Html => html(&Scene::new(chart, look)),
        Picture::Mermaid => mermaid(chart),
    }
}

/// What is to be seen of a mission; `None` if it could not be read.
pub(crate) fn of_input(input: &Loaded, selection: &Selection) -> Option<Chart> {
    let network = input.network.as_ref()?;
    let program = input.program(selection);
    let chart = match input.compilation().and_then(|compilation| compilation.episodes.as_ref()) {
        Some(episodes) => Chart::of_mission(&program, episodes, network),
        None => Chart::of_network(&program, network),
    };
    Some(chart.noted(told(input, network)))
}

/// What does not go together, step by step.
fn told(input: &Loaded, network: &Network) -> Vec<String> {
    let Some(origins) = input.origins() else { return Vec::new() };
    let program = input.program_span();
    let explain = Explain { network, origins, sources: &input.sources, program, theory: false };
    let told = explain.all().unwrap_or_default();
    let lines = told.iter().flat_map(|diagnostic| {
        let helps = diagnostic.help.iter().flat_map(|help| help.lines());
        std::iter::once(diagnostic.message.as_str()).chain(helps)
    });
    lines.map(|line| one_line(line).into_owned()).collect()
}

fn of_journal(arguments: &Pictures, bytes: &[u8]) -> Result<Chart, String> {
    let file = &arguments.files[0];
    if arguments.files.len() > 1 {
        return Err(format!("`{file}` is a journal, which says what its mission is: name nothing else"));
    }
    let told = |bad: &dyn std::fmt::Display| format!("`{file}`, {bad}");
    let journal = read_journal(bytes).map_err(|bad| told(&bad))?;
    let network = journal.start.network().map_err(|bad| told(&bad))?;
    let replayed = replay(&journal, |_, _, _| {}).map_err(|bad| told(&bad))?;
    let execution = replayed.executive.execution(replayed.at, true);
    Ok(Chart::of_network(&journal.start.program, &network).executed(&execution))
}

/// The mission of a team: all agents, as it goes if Nature and the links take the most.
fn of_team(
    arguments: &Pictures,
    mut input: Loaded,
    look: Look,
    format: Picture,
    common: &Common,
) -> io::Result<Status> {
    let judged = team::judge(&mut input, false);
    let program = input.program(&arguments.selection);
    let record = judged.and_then(|judged| team::simulate::longest(&judged.team?, &program));
    let Some(record) = record else {
        Reporter::new(&input.sources).show(&input.diagnostics, common)?;
        return Ok(if input.network.is_some() { Status::No } else { Status::Wrong });
    };
    deliver(&drawn(&Chart::of_team(&record), look, format), arguments.output.as_deref())
}

fn of_team_record(arguments: &Pictures, bytes: &[u8]) -> Result<Chart, String> {
    let file = &arguments.files[0];
    if arguments.files.len() > 1 {
        return Err(format!("`{file}` is a record of a team, which says who did what: name nothing else"));
    }
    let record = parse::<Record>(without_mark(&String::from_utf8_lossy(bytes)));
    record.map(|record| Chart::of_team(&record)).map_err(|problem| format!("`{file}`: {}", problem.message))
}

/// A record alone, or beside its mission, which knows what belongs together.
fn of_record(
    arguments: &Pictures,
    bytes: Bytes,
    look: Look,
    format: Picture,
    common: &Common,
) -> io::Result<Status> {
    let (file, files) = (&arguments.files[0], &arguments.files[1..]);
    let execution = match execution_of(file, bytes) {
        Ok(execution) => execution,
        Err(bad) => {
            let (source, diagnostic) = *bad;
            Reporter::new(&[source]).show(&[diagnostic], common)?;
            return Ok(Status::Wrong);
        }
    };
    let chart = if files.is_empty() {
        Chart::of_execution(&execution)
    } else {
        let selection =
            Selection { otherwise: Some(execution.program.clone()), ..arguments.selection.clone() };
        let input = load_begun(files, None, &selection);
        let (Some(chart), Some(network)) = (of_input(&input, &selection), &input.network) else {
            Reporter::new(&input.sources).show(&input.diagnostics, common)?;
            return Ok(Status::Wrong);
        };
        if let Some(stranger) = stranger(&execution, network) {
            let files = files.join(" ");
            return wrong(&format!(
                "`{file}` is no record of `{files}`: there is no event `{stranger}` in the mission"
            ));
        }
        chart.executed(&execution)
    };
    deliver(&drawn(&chart, look, format), arguments.output.as_deref())
}

/// An event of a record that a network does not have.
fn stranger<'a>(execution: &'a Execution, network: &Network) -> Option<&'a str> {
    let is_known = |event: &&str| -> bool { network.find(event).is_some_and(|_: EventId| true) };
    execution.rows.iter().map(|row| row.event.as_str()).find(|event| !is_known(event))
}

/// What is asked for, or what the name of the file says.
fn format(arguments: &Pictures) -> Result<Picture, String> {
    let named = arguments.output.as_deref().and_then(|output| Path::new(output).extension()?.to_str());
    let named = named.map(str::to_lowercase);
    match (arguments.format, named.as_deref()) {
        (Some(format), _) => Ok(format),
        (None, None | Some("svg")) => Ok(Picture::Svg),
        (None, Some("html" | "htm")) => Ok(Picture::Html),
        (None, Some("mmd" | "mermaid")) => Ok(Picture::Mermaid),
        (None, Some(other)) => Err(format!(
            "kirk draws no `.{other}`: name a file that ends in .svg, .html or .mmd, or say `--format`"
        )),
    }
}

/// `14:00`, or `14:00:30`, as a time of day.
fn look(start: Option<&str>) -> Result<Look, String> {
    let Some(text) = start else { return Ok(Look::default()) };
    let parts: Option<Vec<i64>> =
        text.split(':').map(|part| part.parse().ok().filter(|_| part.len() <= 2)).collect();
    let seconds = match parts.as_deref() {
        Some(&[hours @ 0..24, minutes @ 0..60]) => hours * 3_600 + minutes * 60,
        Some(&[hours @ 0..24, minutes @ 0..60, seconds @ 0..60]) => hours * 3_600 + minutes * 60 + seconds,
        _ => return Err(format!("`--start {text}`: expected a time of day, such as 14:00 or 14:00:30")),
    };
    Ok(Look { start: Some(Duration::from_secs(seconds)) })
}
