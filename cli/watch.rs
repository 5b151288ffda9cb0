//! Whoever watches a mission in real time: a screen, or a line for everything that happens and news from lines of standard
//! input.

use std::io::BufRead;
use std::sync::mpsc::Receiver;
use std::thread::JoinHandle;

use kirk_executive::{Acknowledgement, Desk, Happening, Said, read_observations};

use crate::foreign::one_line;
use crate::live;
use crate::output::remark;
use crate::timetable::cells;

/// Prints what happens to standard error, until the mission is over.
fn happenings(desk: &Desk) -> JoinHandle<()> {
    let mut happenings = desk.listen();
    std::thread::spawn(move || {
        loop {
            match happenings.blocking_recv() {
                Ok(happening) => {
                    lines(&happening).iter().for_each(|line| remark(line));
                    if matches!(*happening, Happening::Over { .. }) {
                        return;
                    }
                }
                Err(tokio::sync::broadcast::error::RecvError::Lagged(missed)) => {
                    remark(&format!("          ({missed} lines not shown)"));
                }
                Err(tokio::sync::broadcast::error::RecvError::Closed) => return,
            }
        }
    })
}

/// Prints what happens, unless `quiet`, and what commands of the driver say, until the mission is over and they are done.
pub(crate) fn print(desk: &Desk, said: Receiver<Said>, quiet: bool) -> JoinHandle<()> {
    let happenings = (!quiet).then(|| happenings(desk));
    std::thread::spawn(move || {
        pass_on(&said);
        if let Some(happenings) = happenings {
            let _ = happenings.join();
        }
    })
}

/// Shows the mission on a screen until it is over; with lines, if the terminal turns out not to do.
pub(crate) fn screen(
    desk: Desk,
    options: live::Options,
    said: Receiver<Said>,
    quiet: bool,
) -> JoinHandle<()> {
    std::thread::spawn(move || match live::run(&desk, options, &said) {
        Ok(_) => pass_on(&said),
        Err(error) => {
            remark(&format!("no screen: {error}"));
            read_lines(desk.clone());
            let _ = print(&desk, said, quiet).join();
        }
    })
}

/// Prints what commands of the driver say, each line with whom it is from, until no driver is there any more.
fn pass_on(said: &Receiver<Said>) {
    said.iter().for_each(|Said { who, line }| remark(&one_line(&format!("{who} | {line}"))));
}

fn lines(happening: &Happening) -> Vec<String> {
    match happening {
        Happening::Sent { at, event, attempt, .. } if *attempt > 1 => {
            vec![format!("{:>10}  {}  handed over again, attempt {attempt}", at, one_line(event))]
        }
        Happening::Sent { .. } | Happening::Over { .. } => Vec::new(),
        Happening::Fixed { rows, .. } => rows
            .iter()
            .map(|row| {
                let [time, event, how] = cells(row);
                format!("{time:>10}  {event}  {how}")
            })
            .collect(),
        Happening::Failed { at, event, reason, .. } => {
            vec![format!("{:>10}  {}  not confirmed: {}", at, one_line(event), one_line(reason))]
        }
        Happening::Ignored { at, event, why } => {
            vec![format!("{:>10}  {}  ignored: {}", at, one_line(event), one_line(&why.to_string()))]
        }
        Happening::Warning { at, text } | Happening::Note { at, text } => {
            vec![format!("{:>10}  {}", at, one_line(text))]
        }
    }
}

/// Takes every line of standard input as news: an event, or what the original's `POST /` takes.
pub(crate) fn read_lines(desk: Desk) {
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().split(b'\n') {
            let Ok(line) = line else { return };
            match names(String::from_utf8_lossy(&line).trim()) {
                Ok(names) if names.is_empty() => {}
                Ok(names) => desk.observe(names, Box::new(said)),
                Err(message) => remark(&message),
            }
        }
    });
}

fn names(line: &str) -> Result<Vec<String>, String> {
    let line = line.trim_start_matches('\u{feff}').trim();
    if line.starts_with('{') {
        return read_observations(line.as_bytes())
            .map_err(|error| format!("`{line}`: {error}, or the name of an event"));
    }
    Ok(line.split_whitespace().map(str::to_string).collect())
}

fn said(answer: Acknowledgement) {
    for ignored in answer.ignored {
        remark(&format!("            {}  ignored: {}", ignored.event, ignored.why));
    }
}
