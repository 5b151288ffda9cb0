//! The timetable of an execution, for people.

use kirk_network::time::Interval;
use kirk_runtime::{Execution, How, Outcome, Row};

use crate::foreign::one_line;

/// One line for each row: time, event, how, and where the event must have happened if it was heard late.
pub(crate) fn timetable(execution: &Execution) -> String {
    let end = match (&execution.outcome, &execution.failure) {
        (Outcome::Failed, Some(failure)) => {
            format!("failed at {} s: {} ({})", failure.time, one_line(&failure.detail), failure.reason.word())
        }
        (Outcome::Failed, None) => "failed".to_string(),
        (Outcome::Running, _) => format!("at {} s", execution.makespan),
        (Outcome::Completed, _) => format!("completed in {} s", execution.makespan),
    };
    let cells: Vec<[String; 3]> = execution.rows.iter().map(cells).collect();
    let width = |column: usize, heading: &str| {
        cells.iter().map(|cell| cell[column].chars().count()).chain([heading.len()]).max().unwrap_or(0)
    };
    let (time, event) = (width(0, "time"), width(1, "event"));
    let mut text =
        format!("{}: {end}\n\n  {:>time$}  {:<event$}  how\n", one_line(&execution.program), "time", "event");
    for [at, name, how] in &cells {
        text.push_str(&format!("  {at:>time$}  {name:<event$}  {how}\n"));
    }
    text
}

/// Time, event and how, as a terminal may show them.
pub(crate) fn cells(row: &Row) -> [String; 3] {
    let time = row.time.map_or("-".to_string(), |time| time.to_string());
    let mut how = row.how.word().to_string();
    let heard = row.observed.flatten();
    match (row.how, heard) {
        (How::Buffered, Some(heard)) => how.push_str(&format!(", heard at {}", heard)),
        (How::Imagined, Some(heard)) => how.push_str(&format!(", heard only at {}", heard)),
        _ => {}
    }
    if let Some(Interval { earliest: low, latest: high }) = row.happened
        && (low != high || row.time.is_some_and(|time| time != low))
    {
        if low == high {
            how.push_str(&format!(", happened at {}", low));
        } else {
            how.push_str(&format!(", happened in [{}, {}]", low, high));
        }
    }
    [time, one_line(&row.event).into_owned(), how]
}
