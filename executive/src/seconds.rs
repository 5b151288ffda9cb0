//! Seconds as a floating-point number, as options and drivers have them: `10.0`.

use std::time::Duration as Real;

use kirk_network::Duration;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// So many seconds.
pub(crate) fn of(duration: Duration) -> f64 {
    duration.as_micros() as f64 / 1e6
}

/// The duration of so many seconds; `None` if it is negative, or no number.
pub(crate) fn read(seconds: f64) -> Option<Duration> {
    let is_duration = seconds.is_finite() && seconds >= 0.0;
    is_duration.then(|| Duration::from_micros((seconds * 1e6).round() as i64))
}

/// Mission time, for `#[serde(with = "seconds::mission")]`.
pub(crate) mod mission {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
        of(*duration).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Duration, D::Error> {
        read(f64::deserialize(deserializer)?).ok_or(D::Error::custom("these are no seconds"))
    }
}

/// Real time, for `#[serde(with = "seconds::real")]`.
pub(crate) mod real {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(real: &Real, serializer: S) -> Result<S::Ok, S::Error> {
        real.as_secs_f64().serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Real, D::Error> {
        Real::try_from_secs_f64(f64::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}
