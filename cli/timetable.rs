//! The timetable of an execution, for people.

use kirk_network::time::Interval;
use kirk_runtime::{Dispatcher, Execution, How, Outcome, Row};

use crate::aftermath;
use crate::foreign::one_line;
use crate::why::why;

/// One line for each row: time, event, how, and where the event must have happened if it was heard late. If the dispatcher is
/// given also why.
pub(crate) fn timetable(execution: &Execution, by: Option<&Dispatcher>) -> String {
    let end = match (&execution.outcome, &execution.failure) {
        (Outcome::Failed, Some(failure)) => {
            format!("failed at {} s: {} ({})", failure.time, one_line(&failure.detail), failure.reason.word())
        }
        (Outcome::Failed, None) => "failed".to_string(),
        (Outcome::BrokenModel, Some(failure)) => {
            let guaranteed = execution.what_if.as_ref().is_some_and(|what_if| what_if.guaranteed);
            let until = if guaranteed { format!(" until {} s", execution.makespan) } else { String::new() };
            format!("{}{until}", one_line(&failure.detail))
        }
        (Outcome::BrokenModel, None) => "the model is broken".to_string(),
        (Outcome::Running, _) => format!("at {} s", execution.makespan),
        (Outcome::Completed, _) => format!("completed in {} s", execution.makespan),
    };
    let headings = ["time", "event", "how", if by.is_some() { "why" } else { "" }].map(str::to_string);
    let line = |row: &Row| {
        let [time, event, how] = cells(row);
        [time, event, how, by.map(|dispatcher| why(dispatcher, row)).unwrap_or_default()]
    };
    let lines: Vec<[String; 4]> = [headings].into_iter().chain(execution.rows.iter().map(line)).collect();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let [at, name, in_which_way] = [0, 1, 2].map(width);
    let mut text = format!("{}: {end}\n\n", one_line(&execution.program));
    for [time, event, how, why] in &lines {
        let line = format!("  {time:>at$}  {event:<name$}  {how:<in_which_way$}  {why}");
        text.push_str(line.trim_end());
        text.push('\n');
    }
    if let Some(what_if) = &execution.what_if {
        text.push('\n');
        for line in aftermath::lines(what_if) {
            text.push_str(&format!("{}\n", one_line(&line)));
        }
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
