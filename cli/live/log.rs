//! What was said lately: warnings, failures of the driver, answers to keys.

use std::collections::VecDeque;

use kirk_network::Time;

/// How much of it is kept.
const KEPT: usize = 100;

/// What was said lately.
#[derive(Debug, Default)]
pub(crate) struct Log {
    notes: VecDeque<Note>,
}

/// One thing that was said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Note {
    /// When it was said last.
    pub(crate) at: Time,
    pub(crate) tone: Tone,
    pub(crate) text: String,
    /// How often it was said without anything else in between.
    pub(crate) times: u32,
}

/// How grave it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tone {
    Answer,
    Warning,
}

impl Log {
    pub(crate) fn add(&mut self, at: Time, tone: Tone, text: String) {
        if let Some(last) = self.notes.back_mut()
            && (last.tone, &last.text) == (tone, &text)
        {
            (last.at, last.times) = (at, last.times.saturating_add(1));
            return;
        }
        if self.notes.len() == KEPT {
            self.notes.pop_front();
        }
        self.notes.push_back(Note { at, tone, text, times: 1 });
    }

    /// The latest first.
    pub(crate) fn latest(&self) -> impl Iterator<Item = &Note> {
        self.notes.iter().rev()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_again_is_counted_and_what_is_old_is_dropped() {
        let mut log = Log::default();
        for at in 0..3 {
            log.add(Time::from_micros(at), Tone::Warning, "again".to_string());
        }
        let again = Note { at: Time::from_micros(2), tone: Tone::Warning, text: "again".into(), times: 3 };
        assert_eq!(log.latest().collect::<Vec<_>>(), [&again]);
        for number in 0..1_000 {
            log.add(Time::ZERO, Tone::Answer, number.to_string());
        }
        assert_eq!(log.latest().count(), KEPT);
        assert_eq!(log.latest().next().map(|note| note.text.as_str()), Some("999"));
    }
}
