//! From a journal to an executive at work.

use std::path::Path;
use std::sync::mpsc::Sender;
use std::time::Duration as Real;

use kirk_network::Time;
use kirk_network::merge::merge;
use kirk_runtime::journal::{Clocks, Journal, Line, Record, Trace};
use kirk_runtime::{Execution, Input, Replay, recover};

use crate::clock::{Clock, clocks};
use crate::driver::Said;
use crate::file::JournalFile;
use crate::mission::{Hall, Options, Ready, Zero, make, open};

/// What a journal leads to.
pub enum Resumption {
    /// The mission goes on.
    Ready(Box<Ready>),
    /// The mission is over.
    Over(Box<Execution>),
}

/// Goes on with the mission of a journal. Time has passed meanwhile as the clocks of the machine say, or it is `at` now.
/// `said` hears what commands of the driver print, `note` is told what a person should know.
///
/// # Errors
/// A sentence that says why that is not possible.
pub fn resume(
    path: &Path,
    at: Option<Time>,
    said: Sender<Said>,
    mut note: impl FnMut(String),
) -> Result<Resumption, String> {
    let (mut file, journal) = JournalFile::open(path)?;
    if journal.torn > 0 {
        note(format!("the last record was torn, {} bytes of it; it is left out", journal.torn));
    }
    let recovered = || recover(&journal).map_err(|bad| format!("`{}`, {bad}", path.display()));
    let over =
        |replayed: Replay| Resumption::Over(Box::new(replayed.executive.execution(replayed.at, false)));
    if matches!(journal.lines.last(), Some(Line { record: Record::Out(Trace::End { .. }), .. })) {
        return recovered().map(over);
    }
    let start = &journal.start;
    let options: Options = serde_json::from_str(start.shell.get())
        .map_err(|error| format!("`{}` does not say how the mission is executed: {error}", path.display()))?;
    let Moment { now, clock, clocks, since } = moment(&journal, &options, at)?;
    // Whoever has news is listened to from this moment on, and answered when it is known how things were.
    let network = start.network().map_err(|wrong| format!("`{}`: {wrong}", path.display()))?;
    let hall = Hall::open(&merge(&network).network, clock, open(&options)?)?;
    let Replay { mut executive, at: last, mut unsent, ahead } = recovered()?;
    if executive.is_over() {
        return Ok(Resumption::Over(Box::new(executive.execution(last, false))));
    }
    let program = &start.program;
    note(match since {
        Since::NotBegun => format!("`{program}` has not begun; it is waited for time zero"),
        Since::SameBoot | Since::Reboot => {
            format!("`{program}` goes on at {now} s; the last record is of {last} s")
        }
    });
    if since == Since::Reboot {
        // The records of what left may be lost, not those of what was going to: the driver is asked.
        unsent.clear();
        if let Some(due) = ahead.filter(|&due| due <= now) {
            let due_then = Input::Timeout {};
            file.push(&Line::new(due, Record::In(due_then.clone())));
            executive.handle(due, due_then);
            // It may have left already: it is handed over again with all the rest.
            while executive.poll_output().is_some() {}
        }
    }
    let back = Input::Resumed { unsent };
    file.push(&Line::new(now, Record::Out(Trace::Back { clocks })));
    file.push(&Line::new(now, Record::In(back.clone())));
    executive.handle(now, back);
    make(executive, options, hall, Some(file), &start.run, said, true)
        .map(|ready| Resumption::Ready(Box::new(ready)))
}

/// When a mission goes on.
struct Moment {
    /// What time it is in the mission.
    now: Time,
    /// A clock that says so.
    clock: Clock,
    /// What the clocks of the machine say then.
    clocks: Clocks,
    /// What was meanwhile.
    since: Since,
}

/// What happened while nobody executed the mission.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Since {
    /// Nothing: it is before time zero.
    NotBegun,
    /// Time went by.
    SameBoot,
    /// The machine was booted again, as far as one can tell.
    Reboot,
}

/// When the mission of a journal goes on: now, and at a time in the mission that the clocks tell, or that is given.
fn moment(journal: &Journal, options: &Options, at: Option<Time>) -> Result<Moment, String> {
    let (mut anchor, mut anchored, mut last) = (&journal.start.clocks, Time::ZERO, Time::ZERO);
    for line in &journal.lines {
        last = last.max(line.at);
        if let Record::Out(Trace::Back { clocks } | Trace::Began { clocks }) = &line.record {
            (anchor, anchored) = (clocks, line.at);
        }
    }
    if let Some(clock) = before_zero(options, journal, anchor) {
        if at.is_some_and(|at| at > Time::ZERO) {
            let program = &journal.start.program;
            return Err(format!("`{program}` has not begun, so it can be no time in the mission"));
        }
        let clocks = clock.anchor();
        return Ok(Moment { now: Time::ZERO, clock, clocks, since: Since::NotBegun });
    }
    let clocks = clocks();
    let since = if clocks.rebooted_since(anchor) { Since::Reboot } else { Since::SameBoot };
    let passed = clocks.since(anchor).map(|real| options.speed.mission(real));
    let told = passed.and_then(|passed| anchored.checked_add(passed));
    let now = at.or(told).ok_or(
        "the machine was booted again, and its calendar says it is earlier than when the mission was interrupted; say what \
         time it is in the mission, in seconds after its start, with `--at`",
    )?;
    if now < last {
        return Err(format!(
            "the mission was executed until {last} s, so it cannot be {now} s now; say what time it is in the mission with `--at`"
        ));
    }
    Ok(Moment { now, clock: Clock::starting(now, options.speed), clocks, since })
}

/// The clock of a mission that was interrupted before it began. `anchor` is what the clocks of the machine said, or will say, at
/// time zero, as far as the journal knows.
fn before_zero(options: &Options, journal: &Journal, anchor: &Clocks) -> Option<Clock> {
    let began = || journal.lines.iter().any(|line| matches!(line.record, Record::Out(Trace::Began { .. })));
    match options.zero {
        Zero::DriverConfirms { .. } if !began() => Some(Clock::standing(options.speed)),
        Zero::At(_) if journal.lines.iter().all(|line| line.at == Time::ZERO) => {
            let now = clocks();
            let rebooted = now.rebooted_since(anchor);
            let left =
                if rebooted { anchor.calendar - now.calendar } else { anchor.since_boot - now.since_boot };
            (left > 0).then(|| Clock::starting_in(Real::from_micros(left.unsigned_abs()), options.speed))
        }
        _ => None,
    }
}
