//! The terminal of this process: taken over while the screen is up, and given back whatever happens.
//!
//! It is opened a second time, so that waiting for it and writing to it can have time limits without changing anything
//! for those who share it: a terminal that stands still (a frozen connection) or goes away holds up nobody.

use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};

use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode};
use crossterm::{cursor, execute};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::termios::{QueueSelector, tcflush, tcgetpgrp, tcgetwinsize};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

/// A terminal that was taken over; dropping it gives it back.
pub(crate) struct Terminal {
    file: File,
    signals: Signals,
}

/// The signals that came while the screen was up.
struct Signals {
    hangup: Arc<AtomicBool>,
    stop: Arc<AtomicBool>,
}

/// What a terminal sent.
pub(crate) enum Sent {
    Bytes(Vec<u8>),
    Nothing,
    /// It is gone.
    Gone,
}

/// How long a write may take before the terminal counts as standing still.
const PATIENCE_MILLIS: i64 = 500;

/// The terminal is taken over.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// True if somebody sits before a terminal that can show a screen, and this process may use it.
pub(crate) fn is_there() -> bool {
    let dumb = std::env::var_os("TERM").is_none_or(|name| name.is_empty() || name == "dumb");
    let shown = io::stdout().is_terminal() || io::stderr().is_terminal();
    !dumb && shown && obstacle().is_none()
}

/// Why no screen can be shown whatever one wants, if none can.
pub(crate) fn obstacle() -> Option<&'static str> {
    if !io::stdin().is_terminal() {
        Some("standard input is not a terminal")
    } else if is_in_background() {
        Some("the terminal is somebody else's now")
    } else if open().is_err() {
        Some("the terminal cannot be opened")
    } else {
        None
    }
}

/// True if standard input is a terminal that is somebody else's now: who reads from it there is stopped for that.
pub(crate) fn is_in_background() -> bool {
    let stdin = io::stdin();
    stdin.is_terminal() && tcgetpgrp(&stdin).is_ok_and(|group| group != rustix::process::getpgrp())
}

impl Terminal {
    /// Takes the terminal over: keys come one by one and unseen, and a second screen hides the first. What was typed
    /// before is forgotten: whoever typed it had not seen what it would mean.
    pub(crate) fn take() -> io::Result<Terminal> {
        let file = open()?;
        let signals = Signals::watch()?;
        restore_on_panic();
        enable_raw_mode()?;
        TAKEN.store(true, Ordering::SeqCst);
        let terminal = Terminal { file, signals };
        tcflush(&terminal.file, QueueSelector::IFlush)?;
        let mut writer = terminal.writer()?;
        execute!(writer, EnterAlternateScreen, EnableBracketedPaste, cursor::Hide)?;
        Ok(terminal)
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> io::Result<(u16, u16)> {
        let size = tcgetwinsize(&self.file)?;
        // Some serial lines do not know.
        Ok(if size.ws_col == 0 || size.ws_row == 0 { (80, 24) } else { (size.ws_col, size.ws_row) })
    }

    /// Waits for keys, so many milliseconds at most.
    pub(crate) fn wait(&mut self, millis: i64) -> Sent {
        let flags = match ready(&self.file, PollFlags::IN, millis) {
            Ok(flags) => flags,
            Err(_) => return Sent::Gone,
        };
        if self.signals.hangup.load(Ordering::SeqCst) {
            return Sent::Gone;
        }
        if flags.is_empty() {
            return Sent::Nothing;
        }
        let mut bytes = [0; 1024];
        match rustix::io::read(&self.file, &mut bytes) {
            Ok(0) => Sent::Gone,
            Ok(length) => Sent::Bytes(bytes[..length].to_vec()),
            Err(rustix::io::Errno::AGAIN | rustix::io::Errno::INTR) => Sent::Nothing,
            Err(_) => Sent::Gone,
        }
    }

    /// True if something can be written at once.
    pub(crate) fn is_moving(&self) -> bool {
        ready(&self.file, PollFlags::OUT, 0).is_ok_and(|flags| flags.contains(PollFlags::OUT))
    }

    /// True if the screen is still ours: not after a panic.
    pub(crate) fn is_taken(&self) -> bool {
        TAKEN.load(Ordering::SeqCst)
    }

    /// True if a signal asked this process to end.
    pub(crate) fn is_told_to_stop(&self) -> bool {
        self.signals.stop.load(Ordering::SeqCst)
    }

    /// Somewhere else to write to the same terminal.
    pub(crate) fn writer(&self) -> io::Result<Writer> {
        Ok(io::BufWriter::with_capacity(1 << 16, Patient(self.file.try_clone()?)))
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        restore();
    }
}

/// Gives the terminal back, if it was taken over.
pub(crate) fn restore() {
    if !TAKEN.swap(false, Ordering::SeqCst) {
        return;
    }
    // If it is gone there is nothing to give back.
    if let Ok(file) = open() {
        let mut file = Patient(file);
        let _ = execute!(file, DisableBracketedPaste, LeaveAlternateScreen, cursor::Show);
    }
    let _ = disable_raw_mode();
}

/// Whatever panics, wherever, its message is for a terminal that shows it.
fn restore_on_panic() {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            restore();
            before(info);
        }));
    });
}

impl Signals {
    /// A hangup ends nothing from now on: the mission goes on without a terminal. What the other signals mean for the
    /// mission is said elsewhere.
    fn watch() -> io::Result<Signals> {
        let signals = Signals { hangup: Arc::default(), stop: Arc::default() };
        flag::register(SIGHUP, Arc::clone(&signals.hangup))?;
        for signal in [SIGINT, SIGTERM] {
            flag::register(signal, Arc::clone(&signals.stop))?;
        }
        Ok(signals)
    }
}

/// Collects what is written up to the next flush.
pub(crate) type Writer = io::BufWriter<Patient>;

/// A terminal, written to with patience.
pub(crate) struct Patient(File);

impl Write for Patient {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        write(&self.0, bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn open() -> io::Result<File> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    Ok(File::from(rustix::fs::open("/dev/tty", flags, Mode::empty())?))
}

fn write(file: &File, bytes: &[u8]) -> io::Result<usize> {
    if !ready(file, PollFlags::OUT, PATIENCE_MILLIS)?.contains(PollFlags::OUT) {
        return Err(io::ErrorKind::TimedOut.into());
    }
    match rustix::io::write(file, bytes) {
        Err(rustix::io::Errno::AGAIN) => Err(io::ErrorKind::Interrupted.into()),
        written => Ok(written?),
    }
}

/// What a file is ready for within so many milliseconds; a signal may end the waiting.
fn ready(file: &File, wanted: PollFlags, millis: i64) -> io::Result<PollFlags> {
    let mut files = [PollFd::new(file, wanted)];
    let limit = Timespec { tv_sec: millis / 1000, tv_nsec: millis % 1000 * 1_000_000 };
    match poll(&mut files, Some(&limit)) {
        Ok(_) => Ok(files[0].revents()),
        Err(rustix::io::Errno::INTR) => Ok(PollFlags::empty()),
        Err(error) => Err(error.into()),
    }
}
