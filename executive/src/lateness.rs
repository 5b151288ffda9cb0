//! How late dispatches were: measured, not hoped for.

use kirk_network::{Duration, Time};

/// How long after they were due events were handed over, in mission time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lateness {
    micros: Vec<i64>,
}

impl Lateness {
    pub(crate) fn add(&mut self, now: Time, due: Time) {
        self.micros.push((now.as_micros() - due.as_micros()).max(0));
    }

    /// How many dispatches there were.
    pub fn count(&self) -> usize {
        self.micros.len()
    }

    /// The lateness that so many of 100 dispatches did not exceed; `None` if there were none.
    pub fn percentile(&self, percent: usize) -> Option<Duration> {
        let mut sorted = self.micros.clone();
        sorted.sort_unstable();
        let at = (sorted.len() * percent).div_ceil(100).saturating_sub(1);
        sorted.get(at).map(|&micros| Duration::from_micros(micros))
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
