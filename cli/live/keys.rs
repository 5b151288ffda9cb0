//! Which key stands for which event. An event keeps its key while it can be heard of, and a key that has become free
//! rests for a while, so that no key changes its meaning between the moment it is seen and the moment it is pressed.

use std::time::Duration;

use kirk_executive::Possible;

/// The keys there are, in the order in which they are given out.
const KEYS: &[u8; 35] = b"123456789abcdefghijklmnopqrstuvwxyz";

/// How long a key rests.
pub(crate) const REST: Duration = Duration::from_secs(5);

/// The keys and what they stand for.
#[derive(Debug)]
pub(crate) struct Keys {
    keys: [Meaning; KEYS.len()],
}

impl Default for Keys {
    fn default() -> Keys {
        Keys { keys: [const { Meaning::Nothing }; KEYS.len()] }
    }
}

/// What a key stands for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Meaning {
    #[default]
    Nothing,
    /// An event that can be heard of.
    Event(String),
    /// An event that was heard then (since the screen came up).
    Was(String, Duration),
}

impl Keys {
    /// Takes back the keys of what is not possible any more, and gives keys to what is new, as long as there are any.
    /// `now` is the real time since the screen came up.
    pub(crate) fn update(&mut self, possible: &[Possible], now: Duration) {
        for key in &mut self.keys {
            match key {
                Meaning::Event(event) if !possible.iter().any(|possible| possible.event == *event) => {
                    *key = Meaning::Was(std::mem::take(event), now);
                }
                Meaning::Was(_, freed) if now.saturating_sub(*freed) >= REST => *key = Meaning::Nothing,
                _ => {}
            }
        }
        for Possible { event, .. } in possible {
            if self.of(event).is_none()
                && let Some(free) = self.keys.iter_mut().find(|key| **key == Meaning::Nothing)
            {
                *free = Meaning::Event(event.clone());
            }
        }
    }

    /// The key of an event, if it has one.
    pub(crate) fn of(&self, event: &str) -> Option<char> {
        let stands_for = |meaning: &Meaning| matches!(meaning, Meaning::Event(found) if found == event);
        self.keys.iter().position(stands_for).map(|at| char::from(KEYS[at]))
    }

    /// What a key stands for; capital letters are as good as small ones.
    pub(crate) fn meaning(&self, key: char) -> &Meaning {
        let at = KEYS.iter().position(|&found| char::from(found) == key.to_ascii_lowercase());
        at.map_or(&Meaning::Nothing, |at| &self.keys[at])
    }
}

#[cfg(test)]
mod tests {
    use kirk_network::Time;

    use super::*;

    fn possible(events: &[&str]) -> Vec<Possible> {
        let possible = |event: &&str| Possible { event: event.to_string(), from: Time::ZERO, until: None };
        events.iter().map(possible).collect()
    }

    #[test]
    fn an_event_keeps_its_key_and_a_free_key_rests() {
        let mut keys = Keys::default();
        keys.update(&possible(&["a", "b", "c"]), Duration::ZERO);
        assert_eq!([keys.of("a"), keys.of("b"), keys.of("c")], [Some('1'), Some('2'), Some('3')]);

        let second = Duration::from_secs(1);
        keys.update(&possible(&["d", "c", "b"]), second);
        assert_eq!([keys.of("b"), keys.of("c"), keys.of("d")], [Some('2'), Some('3'), Some('4')]);
        assert_eq!(*keys.meaning('1'), Meaning::Was("a".to_string(), second));

        keys.update(&possible(&["d", "c", "b", "e"]), second + REST);
        assert_eq!(keys.of("e"), Some('1'));
    }

    #[test]
    fn what_finds_no_key_gets_one_when_one_is_free() {
        let names: Vec<String> = (0..40).map(|number| format!("e{number}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut keys = Keys::default();
        keys.update(&possible(&names), Duration::ZERO);
        assert_eq!([keys.of("e8"), keys.of("e9"), keys.of("e34")], [Some('9'), Some('a'), Some('z')]);
        assert_eq!(keys.of("e35"), None);

        keys.update(&possible(&names[1..]), Duration::ZERO);
        assert_eq!(keys.of("e35"), None);
        keys.update(&possible(&names[1..]), REST);
        assert_eq!(keys.of("e35"), Some('1'));
    }

    /// Whatever comes and goes, a key that stood for one event does not stand for another within its rest.
    #[test]
    fn no_key_changes_its_meaning_at_once() {
        let seed = 7;
        let mut random = fastrand::Rng::with_seed(seed);
        let mut keys = Keys::default();
        let mut seen: Vec<(char, String, Duration)> = Vec::new();
        for step in 0..3_000 {
            let now = Duration::from_millis(step * 300);
            let events: Vec<String> =
                (0..60).filter(|_| random.u8(..3) == 0).map(|n| format!("e{n}")).collect();
            let events: Vec<&str> = events.iter().map(String::as_str).collect();
            keys.update(&possible(&events), now);
            for key in KEYS.iter().map(|&key| char::from(key)) {
                let Meaning::Event(event) = keys.meaning(key) else { continue };
                assert!(events.contains(&event.as_str()));
                if let Some((_, before, last)) = seen.iter().find(|(seen, ..)| *seen == key) {
                    assert!(
                        before == event || now - *last >= REST,
                        "seed {seed}: {key} was {before}, then {event}"
                    );
                }
                seen.retain(|(seen, ..)| *seen != key);
                seen.push((key, event.clone(), now));
            }
        }
    }
}
