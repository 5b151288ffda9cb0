//! Dates and differences of dates: 64-bit integer microseconds, seconds at the edges.
//!
//! `Time` is a date (microseconds after the origin), `Duration` a signed difference of two dates. Infinity is a
//! variant of [`Bound`], never a number, so it cannot be added to anything by mistake. Whatever enters the model is
//! at most [`Duration::MAX`]; the sums the algorithms form are checked against overflow (see `graph.rs`).

use std::fmt;

const MICROS_PER_SECOND: i64 = 1_000_000;

/// A date: microseconds after the origin of the network (which is executed at time 0).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Time(i64);

/// A signed difference of two dates, in microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Duration(i64);

/// One side of an interval of durations: a number, or no bound on that side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bound {
    /// A finite bound.
    Finite(Duration),
    /// No bound: minus infinity as a lower bound, plus infinity as an upper one.
    Infinite,
}

impl Time {
    /// The moment the origin is executed.
    pub const ZERO: Time = Time(0);

    /// The date `micros` microseconds after the origin.
    pub const fn from_micros(micros: i64) -> Time {
        Time(micros)
    }

    /// Microseconds after the origin.
    pub const fn as_micros(self) -> i64 {
        self.0
    }

    /// The date `duration` later, `None` if it cannot be represented.
    pub fn checked_add(self, duration: Duration) -> Option<Time> {
        self.0.checked_add(duration.0).map(Time)
    }

    /// How long after `earlier` this date is (negative if it is before), `None` if that cannot be represented.
    pub fn checked_since(self, earlier: Time) -> Option<Duration> {
        self.0.checked_sub(earlier.0).map(Duration)
    }
}

impl Duration {
    /// No time at all.
    pub const ZERO: Duration = Duration(0);

    /// The largest duration a model may contain: 10 billion seconds, some 317 years.
    pub const MAX: Duration = Duration(10_000_000_000 * MICROS_PER_SECOND);

    /// A duration of `micros` microseconds.
    pub const fn from_micros(micros: i64) -> Duration {
        Duration(micros)
    }

    /// A duration of whole seconds.
    pub const fn from_secs(seconds: i64) -> Duration {
        Duration(seconds * MICROS_PER_SECOND)
    }

    /// The number of microseconds.
    pub const fn as_micros(self) -> i64 {
        self.0
    }

    /// The sum, `None` if it cannot be represented.
    pub fn checked_add(self, other: Duration) -> Option<Duration> {
        self.0.checked_add(other.0).map(Duration)
    }

    /// The difference, `None` if it cannot be represented.
    pub fn checked_sub(self, other: Duration) -> Option<Duration> {
        self.0.checked_sub(other.0).map(Duration)
    }

    /// Reads seconds written in decimal (`15`, `-1.5`, `.5`, `1e3`), exact to a microsecond.
    pub fn parse_seconds(text: &str) -> Result<Duration, ParseDurationError> {
        let (mantissa, exponent) = match text.find(['e', 'E']) {
            None => (text, 0),
            Some(at) => {
                let exponent = text[at + 1..].parse::<i32>().map_err(|_| ParseDurationError::NotANumber)?;
                (&text[..at], exponent)
            }
        };
        let (negative, digits) = match mantissa.as_bytes().first() {
            Some(b'-') => (true, &mantissa[1..]),
            Some(b'+') => (false, &mantissa[1..]),
            _ => (false, mantissa),
        };
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        if whole.is_empty() && fraction.is_empty()
            || !whole.bytes().chain(fraction.bytes()).all(|b| b.is_ascii_digit())
        {
            return Err(ParseDurationError::NotANumber);
        }
        // The value is `all digits` * 10^(exponent - fraction digits) seconds; strip zeros so that the power is small.
        let all: String = [whole, fraction].concat();
        let significant = all.trim_start_matches('0').trim_end_matches('0');
        if significant.is_empty() {
            return Ok(Duration::ZERO);
        }
        let stripped = all.len() - all.trim_end_matches('0').len();
        let power = i64::from(exponent) - fraction.len() as i64 + stripped as i64 + 6;
        if power < 0 {
            return Err(ParseDurationError::TooPrecise);
        }
        if significant.len() as i64 + power > 19 {
            return Err(ParseDurationError::TooLarge);
        }
        let mut micros: i128 = significant.parse().map_err(|_| ParseDurationError::TooLarge)?;
        micros *= 10_i128.pow(power as u32);
        if micros > i128::from(Duration::MAX.0) {
            return Err(ParseDurationError::TooLarge);
        }
        let micros = micros as i64;
        Ok(Duration(if negative { -micros } else { micros }))
    }
}

impl Bound {
    /// The finite value, if there is one.
    pub fn finite(self) -> Option<Duration> {
        match self {
            Bound::Finite(duration) => Some(duration),
            Bound::Infinite => None,
        }
    }
}

impl From<Duration> for Bound {
    fn from(duration: Duration) -> Bound {
        Bound::Finite(duration)
    }
}

/// Why a text is not a duration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParseDurationError {
    /// It is not a decimal number.
    NotANumber,
    /// It has digits below a microsecond, which kirk would have to round.
    TooPrecise,
    /// It is larger than [`Duration::MAX`].
    TooLarge,
}

impl fmt::Display for ParseDurationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ParseDurationError::NotANumber => "this is not a number of seconds",
            ParseDurationError::TooPrecise => {
                "this has digits below a microsecond (kirk never rounds a bound)"
            }
            ParseDurationError::TooLarge => "this is more than 10 billion seconds",
        })
    }
}

impl std::error::Error for ParseDurationError {}

fn write_seconds(micros: i64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let magnitude = micros.unsigned_abs();
    let (seconds, fraction) = (magnitude / 1_000_000, magnitude % 1_000_000);
    let mut text = format!("{}{seconds}", if micros < 0 { "-" } else { "" });
    if fraction != 0 {
        text.push_str(format!(".{fraction:06}").trim_end_matches('0'));
    }
    f.pad(&text)
}

/// Seconds in the shortest exact form: `22`, `1.5`, `-0.000001`.
impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_seconds(self.0, f)
    }
}

/// Seconds in the shortest exact form: `22`, `1.5`, `-0.000001`.
impl fmt::Display for Duration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_seconds(self.0, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_read_exactly_or_refused() {
        let ok = |text: &str| Duration::parse_seconds(text).unwrap().as_micros();
        assert_eq!(ok("15"), 15_000_000);
        assert_eq!(ok("-1.5"), -1_500_000);
        assert_eq!(ok("1e3"), 1_000_000_000);
        assert_eq!(ok("2.5E-1"), 250_000);
        assert_eq!(ok("0.000001"), 1);
        assert_eq!(ok("1.0000000000000000000000000"), 1_000_000);
        assert_eq!(ok("0e999"), 0);
        for (text, error) in [
            ("", ParseDurationError::NotANumber),
            (".", ParseDurationError::NotANumber),
            ("1x", ParseDurationError::NotANumber),
            ("1e", ParseDurationError::NotANumber),
            ("NaN", ParseDurationError::NotANumber),
            ("0.0000001", ParseDurationError::TooPrecise),
            ("1.00000000000000001", ParseDurationError::TooPrecise),
            ("1e11", ParseDurationError::TooLarge),
            ("1e999999999", ParseDurationError::TooLarge),
            ("123456789012345678901234567890", ParseDurationError::TooLarge),
        ] {
            assert_eq!(Duration::parse_seconds(text), Err(error), "{text:?}");
        }
    }

    #[test]
    fn seconds_are_written_in_the_shortest_exact_form() {
        assert_eq!(Time::from_micros(22_000_000).to_string(), "22");
        assert_eq!(Duration::from_micros(-1_500_000).to_string(), "-1.5");
        assert_eq!(Duration::from_micros(1).to_string(), "0.000001");
        assert_eq!(Duration::from_micros(-1).to_string(), "-0.000001");
    }
}
