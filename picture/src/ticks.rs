//! Where the axis of time is marked, and how times are written there.

use kirk_network::{Duration, Time};

const SECOND: i64 = 1_000_000;

/// How far marks may be apart, in seconds: what people count in.
const STEPS: [i64; 26] = [
    1,
    2,
    5,
    10,
    15,
    30,
    60,
    120,
    300,
    600,
    900,
    1_800,
    3_600,
    7_200,
    10_800,
    21_600,
    43_200,
    86_400,
    172_800,
    604_800,
    1_209_600,
    2_592_000,
    7_776_000,
    31_536_000,
    157_680_000,
    1_576_800_000,
];

/// The marks from the start to `end`, at most so many of them.
pub(crate) fn ticks(end: Time, most: usize) -> Vec<Time> {
    let span = end.as_micros().max(1);
    let small = [1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000];
    let steps = small.into_iter().chain(STEPS.iter().map(|step| step * SECOND));
    let fits = |step: &i64| span / step < most as i64;
    let step = steps.clone().find(fits).unwrap_or(span);
    (0..=span / step).map(|number| Time::from_micros(number * step)).collect()
}

/// A time as people read it: `22 s` in short missions, else `1:05:00`; with a time of day for the start, that of the clock.
pub(crate) fn say(time: Time, end: Time, start: Option<Duration>) -> String {
    let micros = time.as_micros().saturating_add(start.unwrap_or_default().as_micros());
    if start.is_none() && end.as_micros() <= 120 * SECOND {
        return format!("{time} s");
    }
    let (seconds, fraction) = (micros.div_euclid(SECOND), micros.rem_euclid(SECOND));
    let (hours, minutes, seconds) = (seconds / 3_600, seconds / 60 % 60, seconds % 60);
    let hours = if start.is_some() { hours % 24 } else { hours };
    let mut text = format!("{hours}:{minutes:02}");
    if seconds > 0 || fraction > 0 || start.is_none() {
        text.push_str(&format!(":{seconds:02}"));
    }
    if fraction > 0 {
        text.push_str(format!(".{fraction:06}").trim_end_matches('0'));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: i64) -> Time {
        Time::from_micros(seconds * SECOND)
    }

    #[test]
    fn marks_are_where_people_count_and_not_too_many() {
        for end in [1, 7, 58, 59, 100, 3_599, 10_000, 86_400, 100_000_000] {
            let marks = ticks(at(end), 12);
            assert!(marks.len() <= 13 && marks.len() >= 3, "{end}: {marks:?}");
            assert_eq!(marks[0], Time::ZERO);
        }
        assert_eq!(ticks(at(58), 12), [0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55].map(at));
    }

    #[test]
    fn times_are_written_as_the_mission_is_long() {
        assert_eq!(say(at(22), at(58), None), "22 s");
        assert_eq!(say(at(65), at(4_000), None), "0:01:05");
        assert_eq!(say(Time::from_micros(65_500_000), at(4_000), None), "0:01:05.5");
        let two = Some(Duration::from_secs(14 * 3_600));
        assert_eq!(say(at(65), at(58), two), "14:01:05");
        assert_eq!(say(at(60), at(58), two), "14:01");
        assert_eq!(say(at(11 * 3_600), at(58), two), "1:00");
    }
}
