//! How the bounds that somebody has written are spoken of: what they are, and what they may be.

use kirk_network::slack::Slack;
use kirk_network::{Bound, Duration, Network, Part, Time};

use crate::repair::Unit;
use crate::written::Written;

impl Unit {
    /// A bound in words: `90 s`, or `any` if there is none.
    pub fn say_bound(self, bound: Bound) -> String {
        bound.finite().map_or("any".to_string(), |bound| self.say(bound))
    }

    /// A time in words, after the start.
    pub fn say_time(self, time: Time) -> String {
        self.say(since_start(time))
    }

    /// Two times, as [`Unit::say_both`].
    pub fn say_times(self, from: Time, between: &str, to: Time) -> String {
        self.say_both(since_start(from), between, since_start(to))
    }

    /// Two amounts with what stands between them, and the unit once: `20 to 45 s`.
    pub fn say_both(self, from: Duration, between: &str, to: Duration) -> String {
        match (self.number(from), self.number(to)) {
            (Some(number), Some(_)) => format!("{number}{between}{}", self.say(to)),
            _ => format!("{}{between}{}", self.say(from), self.say(to)),
        }
    }

    /// Where an amount may lie: `5 to 15 s`, `71 s or more`.
    pub fn say_range(self, least: Bound, most: Bound) -> String {
        match (least.finite(), most.finite()) {
            (Some(least), Some(most)) => self.say_both(least, " to ", most),
            (Some(least), None) => format!("{} or more", self.say(least)),
            (None, Some(most)) => format!("{} or less", self.say(most)),
            (None, None) => "anything".to_string(),
        }
    }
}

impl Written<'_> {
    /// What is there now: `5 s`, or `3 to 5 s` if there are several values.
    pub fn now(&self, network: &Network, unit: Unit) -> String {
        let (least, most) = self.values(network);
        match (least.finite(), most.finite()) {
            (Some(least), Some(most)) if least != most => unit.say_both(least, " to ", most),
            _ if least == most => unit.say_bound(least),
            (Some(least), _) => format!("{} to any", unit.say(least)),
            (None, _) => unit.say_bound(Bound::Infinite),
        }
    }

    /// Where that may lie; of several values, by how much all of them may move to the side that is harder.
    pub fn may_be(&self, slack: &Slack, network: &Network, unit: Unit) -> String {
        if self.has_one_value(network) {
            return unit.say_range(slack.least, slack.most);
        }
        let harder = match self.parts[0] {
            Part::RequirementUpper(_) | Part::LinkLower(_) | Part::DelayMin(_) => "less",
            _ => "more",
        };
        match slack.room {
            Some(room) => format!("up to {} {harder}", unit.say(room)),
            None => format!("any amount {harder}"),
        }
    }
}

fn since_start(time: Time) -> Duration {
    Duration::from_micros(time.as_micros())
}
