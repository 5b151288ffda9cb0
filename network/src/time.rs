//! Dates, differences of dates and intervals: 64-bit integer microseconds, seconds at the edges.
//!
//! [`Time`] is a date (microseconds after the origin), [`Duration`] a signed difference of two dates, [`Interval`] all
//! dates from one to another. Infinity is a variant of [`Bound`], never a number, so it cannot be added to anything by
//! mistake. In JSON all are seconds in decimal with all their digits, read exactly or refused.
//!
//! Whatever enters the model is at most [`Duration::MAX`]. There are two ways to calculate with it, both without
//! overflow: `checked_*` where a result that cannot be represented is an error to tell, and `saturating_*` where it is a
//! bound on what can be known: beyond the ends of time (300,000 years) the end of time says as little. The searches
//! have integers of their own, checked in theirs (see `stnu.rs`).

use std::fmt;
use std::ops::Neg;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

const MICROS_PER_SECOND: i64 = 1_000_000;

/// An exponent beyond which nothing is exact, or nothing is not too large, however many digits there are.
const FAR: i64 = 1 << 40;

/// A date: microseconds after the origin of the network (which is executed at time 0).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Time(i64);

/// A signed difference of two dates, in microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Duration(i64);

/// The dates from `earliest` to `latest`, both included; none if `earliest` is after `latest`. In JSON a list of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(from = "(Time, Time)", into = "(Time, Time)")]
pub struct Interval {
    /// The first date.
    pub earliest: Time,
    /// The last date.
    pub latest: Time,
}

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

    /// The first date there is. As a lower bound it says nothing.
    pub const MIN: Time = Time(i64::MIN);

    /// The last date there is. As an upper bound it says nothing.
    pub const MAX: Time = Time(i64::MAX);

    /// The date `micros` microseconds after the origin.
    pub const fn from_micros(micros: i64) -> Time {
        Time(micros)
    }

    /// Microseconds after the origin.
    pub const fn as_micros(self) -> i64 {
        self.0
    }

    /// The date so long after the origin.
    pub const fn after_origin(duration: Duration) -> Time {
        Time(duration.0)
    }

    /// The seconds that are over since the origin.
    pub const fn second(self) -> i64 {
        self.0.div_euclid(MICROS_PER_SECOND)
    }

    /// How long after the origin this is.
    pub const fn since_origin(self) -> Duration {
        Duration(self.0)
    }

    /// The date `duration` later, `None` if it cannot be represented.
    pub fn checked_add(self, duration: Duration) -> Option<Time> {
        self.0.checked_add(duration.0).map(Time)
    }

    /// The date `duration` earlier, `None` if it cannot be represented.
    pub fn checked_sub(self, duration: Duration) -> Option<Time> {
        self.0.checked_sub(duration.0).map(Time)
    }

    /// How long after `earlier` this date is (negative if it is before), `None` if that cannot be represented.
    pub fn checked_since(self, earlier: Time) -> Option<Duration> {
        self.0.checked_sub(earlier.0).map(Duration)
    }

    /// The date `duration` later, or the end of time it would be beyond.
    #[must_use]
    pub const fn saturating_add(self, duration: Duration) -> Time {
        Time(self.0.saturating_add(duration.0))
    }

    /// The date `duration` earlier, or the end of time it would be beyond.
    #[must_use]
    pub const fn saturating_sub(self, duration: Duration) -> Time {
        Time(self.0.saturating_sub(duration.0))
    }

    /// How long after `earlier` this date is (negative if it is before), or the longest duration there is.
    pub const fn saturating_since(self, earlier: Time) -> Duration {
        Duration(self.0.saturating_sub(earlier.0))
    }
}

impl Duration {
    /// No time at all.
    pub const ZERO: Duration = Duration(0);

    /// The largest duration a model may contain: 10 billion seconds, some 317 years.
    pub const MAX: Duration = Duration(10_000_000_000 * MICROS_PER_SECOND);

    /// The shortest that can be told from none: a microsecond.
    pub const SHORTEST: Duration = Duration(1);

    /// A duration of `micros` microseconds.
    pub const fn from_micros(micros: i64) -> Duration {
        Duration(micros)
    }

    /// A duration of whole seconds.
    pub const fn from_secs(seconds: i64) -> Duration {
        Duration(seconds * MICROS_PER_SECOND)
    }

    /// How many seconds it is, if it is whole ones.
    pub const fn whole_seconds(self) -> Option<i64> {
        if self.0 % MICROS_PER_SECOND == 0 { Some(self.0 / MICROS_PER_SECOND) } else { None }
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

    /// The sum, or the longest duration of its sign there is.
    #[must_use]
    pub const fn saturating_add(self, other: Duration) -> Duration {
        Duration(self.0.saturating_add(other.0))
    }

    /// The difference, or the longest duration of its sign there is.
    #[must_use]
    pub const fn saturating_sub(self, other: Duration) -> Duration {
        Duration(self.0.saturating_sub(other.0))
    }

    /// So many times the duration, or the longest duration of its sign there is.
    #[must_use]
    pub const fn saturating_mul(self, times: i64) -> Duration {
        Duration(self.0.saturating_mul(times))
    }

    /// The duration without its sign.
    #[must_use]
    pub const fn abs(self) -> Duration {
        Duration(self.0.saturating_abs())
    }

    /// Reads seconds written in decimal (`15`, `-1.5`, `.5`, `1e3`), exact to a microsecond.
    pub fn parse_seconds(text: &str) -> Result<Duration, ParseDurationError> {
        Duration::parse(text, MICROS_PER_SECOND)
    }

    /// Reads a number written in decimal, of units of so many microseconds (seconds, minutes, days), exact to a
    /// microsecond.
    pub fn parse(text: &str, unit: i64) -> Result<Duration, ParseDurationError> {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let digits = unsigned(mantissa);
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let all = [whole, fraction].concat();
        let is_natural = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if !is_natural(&all) || !is_natural(unsigned(exponent)) {
            return Err(ParseDurationError::NotANumber);
        }
        // The value is `digits` * 10^power units; without zeros at the end, so that the power is what counts.
        let digits = all.trim_end_matches('0');
        let zeros = (all.len() - digits.len()) as i64;
        let digits = digits.trim_start_matches('0');
        if digits.is_empty() {
            return Ok(Duration::ZERO);
        }
        let beyond = if exponent.starts_with('-') { -FAR } else { FAR };
        let exponent = exponent.parse().unwrap_or(beyond).clamp(-FAR, FAR);
        let power = exponent - fraction.len() as i64 + zeros;
        if digits.len() as i64 + power + i64::from(unit.ilog10()) > 17 {
            return Err(ParseDurationError::TooLarge);
        }
        // No unit has so many twos and fives that it makes up for more.
        if power < -18 {
            return Err(ParseDurationError::TooPrecise);
        }
        // By now it has 36 digits at most.
        let top = digits.parse::<i128>().map_err(|_| ParseDurationError::TooLarge)? * i128::from(unit);
        let scale = 10_i128.pow(power.unsigned_abs() as u32);
        let (top, bottom) = if power < 0 { (top, scale) } else { (top * scale, 1) };
        Duration::exactly(if mantissa.starts_with('-') { -top } else { top }, bottom)
    }

    /// `top / bottom` microseconds.
    pub fn exactly(top: i128, bottom: i128) -> Result<Duration, ParseDurationError> {
        let micros = top.checked_div(bottom).ok_or(ParseDurationError::NotANumber)?;
        if micros.unsigned_abs() > Duration::MAX.0 as u128 {
            return Err(ParseDurationError::TooLarge);
        }
        if top % bottom != 0 {
            return Err(ParseDurationError::TooPrecise);
        }
        Ok(Duration(micros as i64))
    }
}

fn unsigned(number: &str) -> &str {
    number.strip_prefix(['+', '-']).unwrap_or(number)
}

impl Bound {
    /// No time at all.
    pub const ZERO: Bound = Bound::Finite(Duration::ZERO);

    /// The finite value, if there is one.
    pub fn finite(self) -> Option<Duration> {
        match self {
            Bound::Finite(duration) => Some(duration),
            Bound::Infinite => None,
        }
    }
}

impl Interval {
    /// All there is.
    pub const ANYTIME: Interval = Interval { earliest: Time::MIN, latest: Time::MAX };

    /// From a date to a date.
    pub const fn new(earliest: Time, latest: Time) -> Interval {
        Interval { earliest, latest }
    }

    /// One date alone.
    pub const fn at(time: Time) -> Interval {
        Interval { earliest: time, latest: time }
    }

    /// True if there is no date in it.
    pub fn is_empty(self) -> bool {
        self.earliest > self.latest
    }

    /// True if the date is in it.
    pub fn contains(self, time: Time) -> bool {
        self.earliest <= time && time <= self.latest
    }

    /// The dates that are in both.
    #[must_use]
    pub fn and(self, other: Interval) -> Interval {
        Interval { earliest: self.earliest.max(other.earliest), latest: self.latest.min(other.latest) }
    }

    /// Where something is that comes `least` to `most` after what is in here.
    #[must_use]
    pub const fn later(self, least: Duration, most: Duration) -> Interval {
        Interval { earliest: self.earliest.saturating_add(least), latest: self.latest.saturating_add(most) }
    }

    /// Where something is that comes `least` to `most` before what is in here.
    #[must_use]
    pub const fn earlier(self, least: Duration, most: Duration) -> Interval {
        Interval { earliest: self.earliest.saturating_sub(most), latest: self.latest.saturating_sub(least) }
    }
}

impl From<(Time, Time)> for Interval {
    fn from((earliest, latest): (Time, Time)) -> Interval {
        Interval { earliest, latest }
    }
}

impl From<Interval> for (Time, Time) {
    fn from(interval: Interval) -> (Time, Time) {
        (interval.earliest, interval.latest)
    }
}

impl Neg for Duration {
    type Output = Duration;

    /// The same in the other direction. Nothing that is read or counted is so long that it has no opposite.
    fn neg(self) -> Duration {
        Duration(self.0.saturating_neg())
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

impl Serialize for Duration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let number = RawValue::from_string(self.to_string())
            .unwrap_or_else(|error| unreachable!("seconds are a JSON number: {error}"));
        number.serialize(serializer)
    }
}

/// Only from the text of a document: what was a binary number before is not what stands there.
impl<'de> Deserialize<'de> for Duration {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Duration, D::Error> {
        let text = <&RawValue>::deserialize(deserializer)?.get();
        Duration::parse_seconds(text).map_err(|error| D::Error::custom(format!("`{text}`: {error}")))
    }
}

/// A number, or `null` for no bound.
impl Serialize for Bound {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.finite().serialize(serializer)
    }
}

impl Serialize for Time {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.since_origin().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Time {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Time, D::Error> {
        Duration::deserialize(deserializer).map(Time::after_origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_all_digits_and_takes_them_back() {
        let interval = Interval::new(Time::from_micros(-1_500_000), Time::from_micros(22_000_001));
        let text = serde_json::to_string(&interval).unwrap();
        assert_eq!(text, "[-1.5,22.000001]");
        assert_eq!(serde_json::from_str::<Interval>(&text).unwrap(), interval);
        for (text, why) in [
            ("1.0000001", "`1.0000001`: this has digits below a microsecond (kirk never rounds a bound)"),
            ("\"1\"", "`\"1\"`: this is not a number of seconds"),
            ("1e11", "`1e11`: this is more than 10 billion seconds"),
        ] {
            assert!(serde_json::from_str::<Time>(text).unwrap_err().to_string().starts_with(why), "{text}");
        }
    }

    #[test]
    fn beyond_the_ends_of_time_is_the_end_of_time() {
        let long = Duration::from_micros(i64::MAX);
        assert_eq!(Time::from_micros(1).checked_add(long), None);
        assert_eq!(Time::from_micros(1).saturating_add(long), Time::MAX);
        assert_eq!(Time::from_micros(-2).checked_sub(long), None);
        assert_eq!(Time::from_micros(-2).saturating_sub(long), Time::MIN);
        assert_eq!(Time::MAX.saturating_since(Time::MIN), long);
        assert_eq!(-Duration::from_micros(i64::MIN), long);
        let always = Interval::ANYTIME.later(Duration::from_secs(1), long);
        assert_eq!(always.latest, Time::MAX);
        assert_eq!(Interval::ANYTIME.earlier(Duration::ZERO, long).earliest, Time::MIN);
    }

    #[test]
    fn what_is_in_two_intervals_is_in_both() {
        let interval =
            |earliest, latest| Interval::new(Time::from_micros(earliest), Time::from_micros(latest));
        for (a, b, c, d) in (0..256).map(|n| (n & 3, n >> 2 & 3, n >> 4 & 3, n >> 6)) {
            let (first, second) = (interval(a, b), interval(c, d));
            let both = first.and(second);
            for time in (0..4).map(Time::from_micros) {
                assert_eq!(both.contains(time), first.contains(time) && second.contains(time));
            }
            assert_eq!(both.is_empty(), !(0..4).any(|time| both.contains(Time::from_micros(time))));
        }
    }

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
            ("1e99999999999999999999", ParseDurationError::TooLarge),
            ("1e-99999999999999999999", ParseDurationError::TooPrecise),
            ("1e+", ParseDurationError::NotANumber),
            ("--1", ParseDurationError::NotANumber),
            ("123456789012345678901234567890", ParseDurationError::TooLarge),
        ] {
            assert_eq!(Duration::parse_seconds(text), Err(error), "{text:?}");
        }
    }

    /// What is written means what its digits say, place by place.
    #[test]
    fn numbers_are_what_their_digits_say() {
        let mut fates = [0; 3];
        for seed in 0..20_000 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut digits = || -> String { (0..random.usize(1..5)).map(|_| random.digit(10)).collect() };
            let (whole, fraction) = (digits(), digits());
            let exponent = random.i32(-5..=5);
            let unit = *random.choice(&[1_000_000, 60_000_000, 3_600_000_000, 86_400_000_000]).unwrap();
            let text = format!("-{whole}.{fraction}e{exponent}");
            let number: i128 = format!("{whole}{fraction}").parse().unwrap();
            let scaled = number * i128::from(unit) * 10_i128.pow((exponent + 5) as u32);
            let one = 10_i128.pow(fraction.len() as u32 + 5);
            let expected = match (scaled / one, scaled % one) {
                (micros, _) if micros > i128::from(Duration::MAX.0) => Err(ParseDurationError::TooLarge),
                (micros, 0) => Ok(Duration(-micros as i64)),
                _ => Err(ParseDurationError::TooPrecise),
            };
            assert_eq!(Duration::parse(&text, unit), expected, "seed {seed}: {text} of {unit}");
            fates[match expected {
                Ok(_) => 0,
                Err(ParseDurationError::TooPrecise) => 1,
                Err(_) => 2,
            }] += 1;
        }
        assert!(fates.iter().all(|&count| count > 100), "{fates:?}");
    }

    #[test]
    fn seconds_are_written_in_the_shortest_exact_form() {
        assert_eq!(Time::from_micros(22_000_000).to_string(), "22");
        assert_eq!(Duration::from_micros(-1_500_000).to_string(), "-1.5");
        assert_eq!(Duration::from_micros(1).to_string(), "0.000001");
        assert_eq!(Duration::from_micros(-1).to_string(), "-0.000001");
    }
}
