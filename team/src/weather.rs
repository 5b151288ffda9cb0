//! Links in a simulation: how long each message takes, which are lost, doubled, or kept back.

use kirk_network::{Bound, Delay, Time};

use crate::model::AgentId;

/// How Nature, or a link, chooses where she may.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mood {
    /// Always the least, or the soonest.
    Shortest,
    /// Always the most, or the latest; never, where that is possible.
    #[default]
    Longest,
    /// One of these two each time.
    Extremes,
    /// Anything possible.
    Random,
}

/// What the links do to messages. Whoever tells something tells it again until it is acknowledged, so a lost message is a late one; of a
/// link that promises nothing all may be lost.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Weather {
    /// How long messages take.
    pub delays: Mood,
    /// So many of 100 messages are lost at first, and come later than they would, by the latest that the link allows.
    pub lost: u32,
    /// So many of 100 messages come twice.
    pub doubled: u32,
    /// When nothing comes through.
    pub partitions: Vec<Partition>,
}

/// A time at which nothing comes through from one agent to another; what is told then comes afterwards. It may be longer than the
/// link allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// Who is not heard.
    pub from: AgentId,
    /// By whom.
    pub to: AgentId,
    /// From when on.
    pub since: Time,
    /// Until when; `None` is for good.
    pub until: Option<Time>,
}

impl Mood {
    /// A number of the interval; `None`, which stands for never, only where there is no most.
    pub(crate) fn choose(self, random: &mut fastrand::Rng, delay: Delay, far: i64) -> Option<i64> {
        let min = delay.min.as_micros();
        let Bound::Finite(max) = delay.max else {
            return match self {
                Mood::Shortest => Some(min),
                Mood::Longest => None,
                Mood::Extremes => random.bool().then_some(min),
                Mood::Random => random.bool().then(|| min.saturating_add(random.i64(0..=far))),
            };
        };
        Some(self.between(random, min, max.as_micros()))
    }

    pub(crate) fn between(self, random: &mut fastrand::Rng, least: i64, most: i64) -> i64 {
        match self {
            Mood::Shortest => least,
            Mood::Longest => most,
            Mood::Extremes => *random.choice(&[least, most]).unwrap_or(&most),
            Mood::Random => random.i64(least..=most),
        }
    }
}

impl Weather {
    /// When a message that is told now arrives: once, twice or never.
    pub(crate) fn arrivals(
        &self,
        random: &mut fastrand::Rng,
        (from, to): (AgentId, AgentId),
        delay: Delay,
        now: i64,
        far: i64,
    ) -> [Option<i64>; 2] {
        let mut draw = || self.delays.choose(random, delay, far);
        let (first, again) = (draw(), draw());
        let mut percent = |chance: u32| random.u32(0..100) < chance;
        // Never is later than ever.
        let later = first.zip(again).map(|(first, again)| first.max(again));
        let first = if percent(self.lost) { later } else { first };
        let arrives = first.and_then(|delay| self.through(from, to, now, delay));
        let twice = arrives.filter(|_| percent(self.doubled));
        [arrives, twice.map(|at| at.saturating_add(again.unwrap_or(0)))]
    }

    /// What would arrive while nothing comes through is told again afterwards.
    fn through(&self, from: AgentId, to: AgentId, now: i64, delay: i64) -> Option<i64> {
        let mut at = now.saturating_add(delay);
        for partition in self.partitions.iter().filter(|it| (it.from, it.to) == (from, to)) {
            if at >= partition.since.as_micros() {
                let until = partition.until?.as_micros();
                if at < until {
                    at = until.saturating_add(delay);
                }
            }
        }
        Some(at)
    }
}
