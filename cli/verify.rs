//! `kirk verify`: does a recorded execution satisfy every constraint of a file?

use std::io;

use kirk_compiler::{Diagnostic, Source, Span};
use kirk_network::json::{ReadProblem, parse};
use kirk_runtime::execution::FORMAT;
use kirk_runtime::journal::{self, is_journal};
use kirk_runtime::{Execution, Violation, lucky, replay, verify as check};
use serde::Serialize;

use crate::args::{Common, Selection, TextOrJson, Verify};
use crate::input::{Bytes, at_most, load_all, read, shown, without_mark};
use crate::json::line;
use crate::output::{Status, complain, print, print_line};
use crate::report::Reporter;
use crate::team;
use crate::wording::Problem;

/// Records are written by machines.
const LARGEST_RECORD: u64 = 256 << 20;

pub(crate) fn verify(arguments: &Verify, common: &Common) -> io::Result<Status> {
    if arguments.execution == "-" && arguments.files.iter().any(|file| file == "-") {
        complain("the execution and the mission cannot both be standard input");
        return Ok(Status::Wrong);
    }
    let bytes = read(&arguments.execution, LARGEST_RECORD);
    if let Some(bytes) = bytes.as_ref().ok().filter(|bytes| team::verify::is_record(bytes)) {
        return team::verify::verify(arguments, common, bytes);
    }
    let execution = match execution_of(&arguments.execution, bytes) {
        Ok(execution) => Some(execution),
        Err(wrong) => {
            let (source, diagnostic) = *wrong;
            Reporter::new(&[source]).show(&[diagnostic], common)?;
            None
        }
    };
    let selection = Selection {
        package: arguments.package.clone(),
        entry: arguments.entry.clone(),
        otherwise: execution.as_ref().map(|execution| execution.program.clone()),
    };
    let input = load_all(&arguments.files, &selection);
    Reporter::new(&input.sources).show(&input.diagnostics, common)?;
    let (Some(execution), Some(network)) = (execution, &input.network) else { return Ok(Status::Wrong) };
    let mut violations = check(network, &execution);
    if !input.may_be(&execution.program, &selection) {
        let (theirs, ours) = (&execution.program, input.program(&selection));
        let message = format!("this is a record of `{theirs}`, and the mission is `{ours}`");
        violations.insert(0, Violation { event: None, message });
    }
    let lucky = if violations.is_empty() { lucky(network, &execution) } else { Vec::new() };
    conclude(arguments, common, &violations, &lucky)
}

/// Says what was found.
pub(crate) fn conclude(
    arguments: &Verify,
    common: &Common,
    violations: &[Violation],
    lucky: &[Violation],
) -> io::Result<Status> {
    let file = arguments.files.join(" ");
    match arguments.format {
        TextOrJson::Json => {
            let document = VerifyJson {
                format: "kirk-verify/1",
                execution: &arguments.execution,
                file: &file,
                verified: violations.is_empty(),
                violations: violations.iter().map(told).collect(),
                lucky: lucky.iter().map(told).collect(),
            };
            print(&line(&document)?)?;
        }
        TextOrJson::Text => {
            for violation in violations {
                print_line(&format!("violation: {}", violation.message))?;
            }
            for Violation { message, .. } in lucky {
                print_line(&format!(
                    "note: only as it truly happened; by what was heard Nature could have broken this: {message}"
                ))?;
            }
            let verdict = match violations.len() {
                0 => "satisfies every constraint of".to_string(),
                1 => "violates, in 1 place,".to_string(),
                count => format!("violates, in {count} places,"),
            };
            if !common.quiet {
                print_line(&format!("{} {verdict} {}", arguments.execution, file))?;
            }
        }
    }
    Ok(if violations.is_empty() { Status::Yes } else { Status::No })
}

/// Reads a record, or what a journal leads to, from the bytes of a file.
pub(crate) fn execution_of(file: &str, bytes: Bytes) -> Result<Execution, Box<(Source, Diagnostic)>> {
    let wrong = |text: &str, problem: Problem<'_>, at: usize| {
        Box::new((Source::new(shown(file), text), problem.at(Span::new(0, at, at))))
    };
    let bytes = bytes
        .and_then(|bytes| at_most(file, bytes, LARGEST_RECORD))
        .map_err(|message| wrong("", Problem::Unreadable(message), 0))?;
    if is_journal(&bytes) {
        return journal::read(&bytes)
            .and_then(|journal| replay(&journal, |_, _, _| {}))
            .map(|replayed| replayed.executive.execution(replayed.at, false))
            .map_err(|bad| wrong("", Problem::BadJournal(bad.to_string()), 0));
    }
    let text = without_mark(&String::from_utf8_lossy(&bytes)).to_string();
    match parse::<Execution>(&text) {
        Ok(execution) if execution.format != FORMAT => {
            Err(wrong(&text, Problem::OtherFormat(&execution.format), 0))
        }
        Ok(execution) => Ok(execution),
        Err(ReadProblem { offset, message }) => Err(wrong(&text, Problem::BadRecord(message), offset)),
    }
}

#[derive(Serialize)]
struct VerifyJson<'a> {
    format: &'static str,
    execution: &'a str,
    file: &'a str,
    verified: bool,
    violations: Vec<ViolationJson<'a>>,
    /// What holds only as it truly happened: by what was heard it might not have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lucky: Vec<ViolationJson<'a>>,
}

fn told(violation: &Violation) -> ViolationJson<'_> {
    ViolationJson { event: violation.event.as_deref(), message: &violation.message }
}

#[derive(Serialize)]
struct ViolationJson<'a> {
    event: Option<&'a str>,
    message: &'a str,
}
