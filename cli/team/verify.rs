//! `kirk verify` of the record of a team: did what truly happened keep the network of the team? It knows nothing of views and promises.

use std::io;

use kirk_compiler::{Source, Span};
use kirk_network::json::parse;
use kirk_runtime::Violation;
use kirk_team::mission::team;
use kirk_team::record::{FORMAT, Record};
use serde::Deserialize;

use crate::args::{Common, Selection, Verify};
use crate::input::{load_all, shown, without_mark};
use crate::output::{Status, complain};
use crate::report::Reporter;
use crate::verify::conclude;
use crate::wording::Problem;

/// True if these bytes are the record of a team, as far as they say what they are.
pub(crate) fn is_record(bytes: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Begins {
        format: String,
    }
    serde_json::from_slice::<Begins>(bytes).is_ok_and(|begins| begins.format == FORMAT)
}

pub(crate) fn verify(arguments: &Verify, common: &Common, bytes: &[u8]) -> io::Result<Status> {
    let text = without_mark(&String::from_utf8_lossy(bytes)).to_string();
    let record = match parse::<Record>(&text) {
        Ok(record) => record,
        Err(wrong) => {
            let at = Span::new(0, wrong.offset, wrong.offset);
            let diagnostic = Problem::BadRecord(wrong.message).at(at);
            let source = Source::new(shown(&arguments.execution), text);
            Reporter::new(&[source]).show(&[diagnostic], common)?;
            return Ok(Status::Wrong);
        }
    };
    let selection = Selection {
        package: arguments.package.clone(),
        entry: arguments.entry.clone(),
        otherwise: Some(record.program.clone()),
    };
    let input = load_all(&arguments.files, &selection);
    Reporter::new(&input.sources).show(&input.diagnostics, common)?;
    let Some(network) = &input.network else { return Ok(Status::Wrong) };
    let Some(team) = input.team().and_then(|written| team(written, network).ok()) else {
        complain("this is the record of a team, and the mission has no `define-team`");
        return Ok(Status::Wrong);
    };
    let found = record.violations(&team).into_iter();
    let mut violations: Vec<Violation> = found.map(|(event, message)| Violation { event, message }).collect();
    if !input.may_be(&record.program, &selection) {
        let (theirs, ours) = (&record.program, input.program(&selection));
        let message = format!("this is a record of `{theirs}`, and the mission is `{ours}`");
        violations.insert(0, Violation { event: None, message });
    }
    conclude(arguments, common, &violations, &[])
}
