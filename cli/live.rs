//! The screen of a mission in a terminal: the live timetable, and a key for each event that may be heard of.
//!
//! The thin loop around pure parts: `input` (bytes to keys), `state` (what a key does), `view` (what is seen). It has a
//! thread of its own and only leaves messages at the desk, so whatever the terminal does the mission does not wait for it.

mod input;
mod keys;
mod log;
mod state;
mod terminal;
#[cfg(test)]
mod tests;
mod text;
mod view;

use std::io;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;

use kirk_executive::{Desk, Happening, Said, Snapshot};
use kirk_network::Time;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{TerminalOptions, Viewport};

use input::Decoder;
use log::Tone;
use state::{Action, Moment, State};
use terminal::{Sent, Terminal, Writer};

pub(crate) use terminal::{is_in_background, is_there, obstacle};

/// How it looks.
#[derive(Clone, Debug)]
pub(crate) struct Options {
    /// Colours may be used.
    pub(crate) color: bool,
    /// What is said at the beginning.
    pub(crate) greeting: Option<String>,
}

/// Why the screen came down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The mission is over.
    Over,
    /// Somebody would not wait until the mission has stopped, or a signal or a panic took the screen down.
    Left,
    /// The terminal is gone, and the mission goes on.
    Gone,
}

/// How often the clock is looked at, and the most often it is drawn.
const TICK_MILLIS: i64 = 100;

/// Shows a mission, and what commands of its driver say, and takes keys until the mission is over, or somebody or something
/// takes the screen away. Blocks: it wants a thread of its own.
///
/// # Errors
/// The terminal cannot be taken over, or fails in an unexpected way. It is given back in any case.
pub(crate) fn run(desk: &Desk, options: Options, said: &Receiver<Said>) -> io::Result<End> {
    let mut screen = Screen::up(options.color)?;
    let started = Instant::now();
    let now = || Moment { mission: desk.clock().countdown(), real: started.elapsed() };
    let mut happenings = desk.listen();
    let (replies, answers) = channel();
    let mut look = Look::default();
    let mut state = State::default();
    let mut decoder = Decoder::default();
    if let Some(greeting) = options.greeting {
        state.say(now().mission, Tone::Answer, greeting);
    }
    loop {
        match look.again(desk) {
            Looked::Seen(snapshot) => state.see(*snapshot, now()),
            Looked::Same => {}
            Looked::Blind => return Ok(End::Over),
        }
        loop {
            match happenings.try_recv() {
                Ok(happening) if matches!(*happening, Happening::Over { .. }) => return Ok(End::Over),
                Ok(happening) => state.note(&happening),
                Err(_) if happenings.is_empty() => break,
                Err(lost) => state.say(now().mission, Tone::Warning, format!("not all is shown: {lost}")),
            }
        }
        for Said { who, line } in said.try_iter() {
            state.say(now().mission, Tone::Answer, format!("{who} | {line}"));
        }
        for answer in answers.try_iter() {
            state.answered(answer, now());
        }
        state.tick(now());
        if state.is_over() {
            return Ok(End::Over);
        }
        // The signals are for the mission; the screen only makes room for what is said about them.
        if screen.terminal.is_told_to_stop() || !screen.terminal.is_taken() {
            return Ok(End::Left);
        }
        screen.show(&mut state, now().mission)?;
        let keys = match screen.terminal.wait(TICK_MILLIS) {
            Sent::Bytes(bytes) => decoder.keys(&bytes),
            Sent::Nothing => decoder.pause().into_iter().collect(),
            Sent::Gone => return Ok(End::Gone),
        };
        for key in keys {
            match state.key(key, now()) {
                Action::Nothing => {}
                Action::Observe(event) => {
                    let replies = replies.clone();
                    // The screen may be down when the answer comes.
                    desk.observe(vec![event], Box::new(move |answer| drop(replies.send(answer))));
                }
                Action::Stop => desk.stop("at the keyboard".to_string()),
                Action::Leave => return Ok(End::Left),
                Action::Redraw => screen.stale = true,
            }
        }
    }
}

/// A terminal and what is on it.
struct Screen {
    color: bool,
    // Dropped before the terminal: what it still has to say is for the screen, not for what comes after.
    shown: ratatui::Terminal<CrosstermBackend<Writer>>,
    terminal: Terminal,
    size: (u16, u16),
    /// The second that is shown.
    second: i64,
    /// What is on the terminal may be anything.
    stale: bool,
}

impl Screen {
    fn up(color: bool) -> io::Result<Screen> {
        let terminal = Terminal::take()?;
        let size = terminal.size()?;
        let viewport = Viewport::Fixed(Rect::new(0, 0, size.0, size.1));
        let backend = CrosstermBackend::new(terminal.writer()?);
        let shown = ratatui::Terminal::with_options(backend, TerminalOptions { viewport })?;
        Ok(Screen { color, terminal, shown, size, second: i64::MIN, stale: true })
    }

    /// Draws what has changed, if anything has and the terminal takes it.
    fn show(&mut self, state: &mut State, now: Time) -> io::Result<()> {
        let (size, second) = (self.terminal.size().unwrap_or(self.size), now.second());
        let changed = state.changed || second != self.second || size != self.size || self.stale;
        if !changed || !self.terminal.is_moving() {
            return Ok(());
        }
        match self.draw(state, now, size) {
            Ok(()) => (self.second, self.size, self.stale, state.changed) = (second, size, false, false),
            // It stands still in the middle of a frame. All is drawn again when it moves.
            Err(error) if error.kind() == io::ErrorKind::TimedOut => self.stale = true,
            // It goes away; whoever waits for its keys will see that.
            Err(error) if error.raw_os_error() == Some(rustix::io::Errno::IO.raw_os_error()) => {}
            Err(error) => return Err(error),
        }
        Ok(())
    }

    fn draw(&mut self, state: &mut State, now: Time, size: (u16, u16)) -> io::Result<()> {
        if self.stale || size != self.size {
            self.shown.resize(Rect::new(0, 0, size.0, size.1))?;
        }
        self.shown.draw(|frame| {
            state.visible = view::view(state, now, self.color, frame.buffer_mut());
        })?;
        Ok(())
    }
}

/// Looks at the mission, again whenever it has changed.
#[derive(Default)]
struct Look {
    version: Option<u64>,
    asked: Option<Receiver<Box<Snapshot>>>,
}

enum Looked {
    Seen(Box<Snapshot>),
    Same,
    /// Nobody is there any more.
    Blind,
}

impl Look {
    fn again(&mut self, desk: &Desk) -> Looked {
        if self.asked.is_none() && self.version != Some(desk.version()) {
            let (reply, asked) = channel();
            self.version = Some(desk.version());
            self.asked = Some(asked);
            desk.look(Box::new(move |snapshot| {
                // The screen may be down by now.
                let _ = reply.send(Box::new(snapshot));
            }));
        }
        match self.asked.as_ref().map(Receiver::try_recv) {
            None | Some(Err(TryRecvError::Empty)) => Looked::Same,
            Some(Ok(snapshot)) => {
                self.asked = None;
                Looked::Seen(snapshot)
            }
            Some(Err(TryRecvError::Disconnected)) => Looked::Blind,
        }
    }
}
