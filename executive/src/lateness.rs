//! How late dispatches were: measured, not hoped for.

use kirk_network::{Duration, Time};

/// How long after they were due events were handed over, in mission time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lateness {
    all: Vec<Duration>,
}

impl Lateness {
    pub(crate) fn add(&mut self, now: Time, due: Time) {
        self.all.push(now.saturating_since(due).max(Duration::ZERO));
    }

    /// How many dispatches there were.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// The lateness that so many of 100 dispatches did not exceed; `None` if there were none.
    pub fn percentile(&self, percent: usize) -> Option<Duration> {
        let mut sorted = self.all.clone();
        sorted.sort_unstable();
        let at = (sorted.len() * percent).div_ceil(100).saturating_sub(1);
        sorted.get(at).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_what_was_measured() {
        let mut lateness = Lateness::default();
        assert_eq!(lateness.percentile(99), None);
        for micros in (1..=200).rev() {
            lateness.add(Time::from_micros(1000 + micros), Time::from_micros(1000));
        }
        assert_eq!(lateness.percentile(50), Some(Duration::from_micros(100)));
        assert_eq!(lateness.percentile(99), Some(Duration::from_micros(198)));
        assert_eq!(lateness.percentile(100), Some(Duration::from_micros(200)));
    }
}
