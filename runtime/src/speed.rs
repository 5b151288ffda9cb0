//! How fast a mission is executed: how much of its time passes in so much real time, and the other way round.

use std::time::Duration as Real;

use kirk_network::Duration;
use serde::{Deserialize, Serialize};

/// How many times faster than the world a mission is executed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Speed(f64);

impl Speed {
    /// As fast as the world.
    pub const REAL: Speed = Speed(1.0);

    /// How much mission time passes in so much real time.
    pub fn mission(self, real: Duration) -> Duration {
        Duration::from_micros((real.as_micros() as f64 * self.0) as i64)
    }

    /// How long it really takes until so much mission time has passed; nothing if that is past. Rounded up, so as not to wake a
    /// moment too early.
    pub fn real(self, mission: Duration) -> Real {
        Real::from_nanos((mission.as_micros().max(0) as f64 * 1000.0 / self.0).ceil() as u64)
    }

    /// So many times faster again.
    #[must_use]
    pub fn times(self, other: Speed) -> Speed {
        Speed(self.0 * other.0)
    }
}

impl TryFrom<f64> for Speed {
    type Error = String;

    fn try_from(factor: f64) -> Result<Speed, String> {
        let is_speed = factor.is_finite() && factor > 0.0;
        is_speed.then_some(Speed(factor)).ok_or(format!("`{factor}` is no speed: expected a number above 0"))
    }
}

impl From<Speed> for f64 {
    fn from(speed: Speed) -> f64 {
        speed.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_so_long_is_over_by_then() {
        let thrice = Speed::try_from(3.0).unwrap();
        assert_eq!(thrice.mission(Duration::from_secs(2)), Duration::from_secs(6));
        assert_eq!(thrice.real(Duration::from_micros(1)), Real::from_nanos(334));
        assert_eq!(thrice.real(Duration::from_secs(-1)), Real::ZERO);
        assert_eq!(Speed::REAL.real(Duration::from_secs(2)), Real::from_secs(2));
        assert_eq!(thrice.times(thrice).mission(Duration::from_secs(-1)), Duration::from_secs(-9));
    }

    #[test]
    fn a_speed_is_written_as_a_number_and_must_be_above_zero() {
        assert_eq!(serde_json::to_string(&Speed::REAL).unwrap(), "1.0");
        assert_eq!(serde_json::from_str::<Speed>("2.5").unwrap(), Speed(2.5));
        for wrong in ["0", "-1", "1e999"] {
            assert!(serde_json::from_str::<Speed>(wrong).is_err(), "{wrong}");
        }
    }
}
