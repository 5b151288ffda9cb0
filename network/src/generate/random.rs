//! Random numbers that are the same everywhere: SplitMix64, and exponential ones without a logarithm.
//!
//! The logarithm of the standard library may differ in its last digit from machine to machine; comparisons, sums and one
//! division do not.

use std::ops::RangeInclusive;

use crate::time::Duration;

/// A pseudo-random generator (G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number generators*, 2014).
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number in the range, all equally likely (to within 1 in 10^16).
    pub(super) fn within(&mut self, range: RangeInclusive<i64>) -> i64 {
        let count = range.end().abs_diff(*range.start()) + 1;
        range.start() + ((u128::from(self.bits()) * u128::from(count)) >> 64) as i64
    }

    /// Whole seconds in the range, all equally likely.
    pub(super) fn seconds(&mut self, range: RangeInclusive<i64>) -> Duration {
        Duration::from_secs(self.within(range))
    }

    /// True in so many of 100 cases.
    pub(super) fn percent(&mut self, chance: u32) -> bool {
        self.within(1..=100) <= i64::from(chance)
    }

    /// Exponentially distributed with this average in seconds, to the nearest microsecond.
    pub(super) fn exponential(&mut self, mean: f64) -> Duration {
        Duration::from_micros((self.unit_exponential() * mean * 1_000_000.0).round() as i64)
    }

    /// Exponentially distributed with average 1 (J. von Neumann, *Various techniques used in connection with random
    /// digits*, 1951): the first of a falling run of odd length, plus the number of runs of even length before.
    fn unit_exponential(&mut self) -> f64 {
        let mut rounds = 0.0;
        loop {
            let first = self.bits();
            let mut last = first;
            let mut length = 1_u32;
            loop {
                let next = self.bits();
                if next > last {
                    break;
                }
                last = next;
                length += 1;
            }
            if length % 2 == 1 {
                return rounds + (first >> 11) as f64 / (1_u64 << 53) as f64;
            }
            rounds += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_numbers_have_their_average_and_their_tail() {
        let mut random = Random::new(7);
        let numbers: Vec<f64> = (0..100_000).map(|_| random.unit_exponential()).collect();
        let mean = numbers.iter().sum::<f64>() / 100_000.0;
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
        for (above, share) in [(0.5, 0.6065), (1.0, 0.3679), (2.0, 0.1353), (3.0, 0.0498)] {
            let found = numbers.iter().filter(|&&x| x > above).count() as f64 / 100_000.0;
            assert!((found - share).abs() < 0.006, "{found} of the numbers are above {above}, not {share}");
        }
    }

    #[test]
    fn whole_numbers_reach_both_ends_of_their_range() {
        let mut random = Random::new(1);
        let mut seen = [false; 7];
        (0..1000).for_each(|_| seen[(random.within(-3..=3) + 3) as usize] = true);
        assert_eq!(seen, [true; 7]);
    }
}
