//! What the screen remembers, and what a key does to it. No clock and no terminal: both are arguments.

use std::time::Duration;

use kirk_executive::{Acknowledgement, Happening, Possible, Snapshot};
use kirk_network::Time;
use kirk_runtime::Outcome;

use super::input::Key;
use super::keys::{Keys, Meaning};
use super::log::{Log, Tone};

/// What the screen remembers.
#[derive(Debug, Default)]
pub(crate) struct State {
    /// The mission as it was seen last.
    pub(crate) snapshot: Option<Snapshot>,
    pub(crate) keys: Keys,
    pub(crate) log: Log,
    /// The first row of the timetable to be shown, if not the latest are.
    pub(crate) first: Option<usize>,
    /// How many rows of the timetable are visible.
    pub(crate) visible: usize,
    /// How often the page of what may be heard was turned.
    pub(crate) turned: usize,
    pub(crate) help: bool,
    /// Somebody asked for the end of the mission.
    pub(crate) stopping: bool,
    asked: Option<Asked>,
    /// Anything of this has changed since it was drawn.
    pub(crate) changed: bool,
}

/// A question that the same key answers with yes, until some time.
#[derive(Debug)]
struct Asked {
    key: Key,
    question: String,
    until: Duration,
}

/// How long a question stands.
const PATIENCE: Duration = Duration::from_secs(5);

/// What is to be done because of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Action {
    Nothing,
    /// This event was seen to happen.
    Observe(String),
    /// End the mission.
    Stop,
    /// Take the screen down, whatever the mission does.
    Leave,
    /// Draw all of it again.
    Redraw,
}

/// The moment of a key: by the clock of the mission, and really, since the screen came up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub(crate) mission: Time,
    pub(crate) real: Duration,
}

impl State {
    /// Takes a look at the mission.
    pub(crate) fn see(&mut self, snapshot: Snapshot, now: Moment) {
        self.keys.update(&snapshot.possible, now.real);
        self.snapshot = Some(snapshot);
        self.changed = true;
    }

    /// Time passes: questions lapse, and keys have rested.
    pub(crate) fn tick(&mut self, now: Moment) {
        if self.asked.as_ref().is_some_and(|asked| now.real >= asked.until) {
            self.asked = None;
            self.changed = true;
        }
        if let Some(snapshot) = &self.snapshot {
            self.keys.update(&snapshot.possible, now.real);
        }
    }

    /// True when there is nothing more to see.
    pub(crate) fn is_over(&self) -> bool {
        self.snapshot.as_ref().is_some_and(|snapshot| snapshot.outcome != Outcome::Running)
    }

    /// The question that stands.
    pub(crate) fn question(&self) -> Option<&str> {
        self.asked.as_ref().map(|asked| asked.question.as_str())
    }

    /// Notes what happened, if it does not show in the timetable.
    pub(crate) fn note(&mut self, happening: &Happening) {
        let mut tone = Tone::Warning;
        let (at, text) = match happening {
            Happening::Failed { at, event, reason, .. } => {
                (at, format!("the driver failed: {event}: {reason}"))
            }
            Happening::Warning { at, text } => (at, text.clone()),
            Happening::Note { at, text } => {
                tone = Tone::Answer;
                (at, text.clone())
            }
            Happening::Ignored { at, event, why } => (at, format!("not heard: {event}: {why}")),
            Happening::Sent { .. } | Happening::Fixed { .. } | Happening::Over { .. } => return,
        };
        self.say(*at, tone, text);
    }

    /// Notes what became of a key that was pressed.
    pub(crate) fn answered(&mut self, answer: Acknowledgement, now: Moment) {
        for event in answer.accepted {
            self.say(now.mission, Tone::Answer, format!("heard: {event}"));
        }
        for ignored in answer.ignored {
            self.say(now.mission, Tone::Warning, format!("not heard: {}: {}", ignored.event, ignored.why));
        }
    }

    /// Adds a sentence to what was said.
    pub(crate) fn say(&mut self, at: Time, tone: Tone, text: String) {
        self.log.add(at, tone, text);
        self.changed = true;
    }

    /// What a key does.
    pub(crate) fn key(&mut self, key: Key, now: Moment) -> Action {
        self.changed = true;
        let confirmed = self.asked.take().is_some_and(|asked| asked.key == key && now.real < asked.until);
        if key == Key::Interrupt {
            return self.interrupt(confirmed, now);
        }
        if std::mem::take(&mut self.help) {
            // What the key stands for could not be seen.
            return Action::Nothing;
        }
        match key {
            Key::Char('?') => self.help = true,
            Key::Char(char) => return self.observe(char, confirmed, now),
            Key::Redraw => return Action::Redraw,
            Key::Tab => self.turned = self.turned.wrapping_add(1),
            Key::Up => self.scroll(-1),
            Key::Down => self.scroll(1),
            Key::PageUp => self.scroll(-(self.visible.max(2) as isize - 1)),
            Key::PageDown => self.scroll(self.visible.max(2) as isize - 1),
            Key::Home => self.scroll(isize::MIN),
            Key::End => self.first = None,
            Key::Escape | Key::Interrupt => {}
        }
        Action::Nothing
    }

    fn interrupt(&mut self, confirmed: bool, now: Moment) -> Action {
        if self.stopping {
            return Action::Leave;
        }
        if confirmed {
            self.stopping = true;
            return Action::Stop;
        }
        self.ask(Key::Interrupt, "Press Ctrl-C again to stop the mission.".to_string(), now);
        Action::Nothing
    }

    fn observe(&mut self, char: char, confirmed: bool, now: Moment) -> Action {
        match self.keys.meaning(char).clone() {
            Meaning::Nothing => Action::Nothing,
            Meaning::Was(event, _) => {
                let text = format!("{char} was {event}, which has been heard");
                self.say(now.mission, Tone::Warning, text);
                Action::Nothing
            }
            Meaning::Event(event) => match self.impossible(&event, now.mission) {
                Some(why) if !confirmed => {
                    let question = format!("{event} {why}. Press {char} again to report it all the same.");
                    self.ask(Key::Char(char), question, now);
                    Action::Nothing
                }
                _ => Action::Observe(event),
            },
        }
    }

    /// Why the model says that an event cannot be heard of now.
    fn impossible(&self, event: &str, now: Time) -> Option<String> {
        let possible = &self.snapshot.as_ref()?.possible;
        let Possible { from, until, .. } = possible.iter().find(|possible| possible.event == event)?;
        match until {
            _ if now < *from => Some(format!("is not possible before {from} s")),
            Some(until) if now > *until => Some(format!("was to be heard by {until} s")),
            _ => None,
        }
    }

    fn ask(&mut self, key: Key, question: String, now: Moment) {
        self.asked = Some(Asked { key, question, until: now.real + PATIENCE });
    }

    /// Moves the rows shown; at the end they follow what comes.
    fn scroll(&mut self, by: isize) {
        let rows = self.snapshot.as_ref().map_or(0, |snapshot| snapshot.rows.len());
        let last = rows.saturating_sub(self.visible);
        let first = self.first.unwrap_or(last).min(last).saturating_add_signed(by);
        self.first = (first < last).then_some(first);
    }
}
