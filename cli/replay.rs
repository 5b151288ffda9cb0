//! `kirk replay`: repeats a mission from its journal, bit for bit.

use std::io;

use kirk_network::Time;
use kirk_runtime::journal::read as read_journal;
use kirk_runtime::{Output, replay as repeat};

use crate::args::{Common, Replay};
use crate::execute::Show;
use crate::input::read;
use crate::output::{Status, complain, remark};
use crate::timetable::cells;

/// Journals are written by machines.
pub(crate) const LARGEST_JOURNAL: u64 = 1 << 30;

pub(crate) fn replay(arguments: &Replay, common: &Common) -> io::Result<Status> {
    let file = arguments.journal.display();
    let journal = read(&arguments.journal.to_string_lossy(), LARGEST_JOURNAL)
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
        let Some(speed) = arguments.speed else { return };
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
            let show = Show { internal: arguments.internal, format: arguments.format, why: false };
            show.execution(&replayed.executive.execution(replayed.at, arguments.internal), None)
        }
        Err(bad) => {
            complain(&format!("`{file}`, {bad}"));
            Ok(Status::Wrong)
        }
    }
}
