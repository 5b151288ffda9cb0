//! `kirk replay`: repeats a mission from its journal, bit for bit.

use std::io;
use std::path::Path;

use kirk_network::Time;
use kirk_picture::Chart;
use kirk_runtime::journal::read as read_journal;
use kirk_runtime::{Output, Speed, replay as repeat};

use crate::args::{Common, Replay, Show};
use crate::input::read;
use crate::output::{Status, complain, remark};
use crate::timetable::cells;

/// Journals are written by machines.
pub(crate) const LARGEST_JOURNAL: u64 = 1 << 30;

pub(crate) fn replay(arguments: &Replay, common: &Common) -> io::Result<Status> {
    print_journal(&arguments.journal, arguments.speed, arguments.show, common)
}

/// Prints what a journal leads to, and at some speed, if one is given, what happens on the way.
pub(crate) fn print_journal(
    path: &Path,
    speed: Option<Speed>,
    show: Show,
    common: &Common,
) -> io::Result<Status> {
    let file = path.display();
    let journal = read(&path.to_string_lossy(), LARGEST_JOURNAL)
        .and_then(|bytes| read_journal(&bytes).map_err(|bad| format!("`{file}`, {bad}")));
    let journal = match journal {
        Ok(journal) => journal,
        Err(message) => {
            complain(&message);
            return Ok(Status::Wrong);
        }
    };
    if journal.torn > 0 && !common.quiet {
        remark(&format!("the last record was torn, {} bytes of it; it is left out", journal.torn));
    }
    let mut shown_until = Time::ZERO;
    let replayed = repeat(&journal, |at, executive, output| {
        let Some(speed) = speed else { return };
        std::thread::sleep(speed.times(journal.start.speed).real(at.saturating_since(shown_until)));
        shown_until = shown_until.max(at);
        match output {
            Output::Fixed { event, .. } if !common.quiet => {
                for row in executive.rows(*event) {
                    let [time, event, how] = cells(&row);
                    remark(&format!("{time:>10}  {event}  {how}"));
                }
            }
            Output::Warning(text) if !common.quiet => remark(&format!("{at:>10}  {text}")),
            _ => {}
        }
    });
    match replayed {
        Ok(replayed) => {
            let execution = replayed.executive.execution(replayed.at, show.internal);
            let dispatcher = replayed.executive.dispatcher();
            let chart = || Chart::of_network(&execution.program, dispatcher.network());
            show.execution(&execution, Some(dispatcher), chart)
        }
        Err(bad) => {
            complain(&format!("`{file}`, {bad}"));
            Ok(Status::Wrong)
        }
    }
}
