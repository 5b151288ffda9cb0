//! Arithmetic on numbers: exact to a microsecond, or refused.

use kirk_network::Duration;
use serde::{Serialize, Serializer};

/// What can be calculated with numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `(+ a b ...)`.
    Add,
    /// `(- a b ...)`, `(- a)`.
    Subtract,
    /// `(* a b ...)`.
    Multiply,
    /// `(/ a b ...)`.
    Divide,
    /// `(1+ a)`.
    Increment,
    /// `(1- a)`.
    Decrement,
    /// `(min a b ...)`.
    Minimum,
    /// `(max a b ...)`.
    Maximum,
    /// `(mod a b)`.
    Modulo,
}

/// Why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoResult {
    /// It would have to be rounded.
    NotExact,
    /// It is more than a duration can be.
    TooLarge,
    /// Something is divided by zero.
    DividedByZero,
}

const SECOND: i128 = 1_000_000;

impl Operator {
    /// All of them.
    pub const ALL: [Operator; 9] = [
        Operator::Add,
        Operator::Subtract,
        Operator::Multiply,
        Operator::Divide,
        Operator::Increment,
        Operator::Decrement,
        Operator::Minimum,
        Operator::Maximum,
        Operator::Modulo,
    ];

    /// The operator of this name.
    pub fn of(word: &str) -> Option<Operator> {
        Operator::ALL.into_iter().find(|operator| operator.word() == word)
    }

    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Operator::Add => "+",
            Operator::Subtract => "-",
            Operator::Multiply => "*",
            Operator::Divide => "/",
            Operator::Increment => "1+",
            Operator::Decrement => "1-",
            Operator::Minimum => "min",
            Operator::Maximum => "max",
            Operator::Modulo => "mod",
        }
    }

    /// How many numbers it takes: at least, and at most.
    pub fn takes(self) -> (usize, usize) {
        match self {
            Operator::Increment | Operator::Decrement => (1, 1),
            // One number alone is a slip: `(min 5)` is meant to be `(minutes 5)`.
            Operator::Minimum | Operator::Maximum => (2, usize::MAX),
            Operator::Modulo | Operator::Divide => (2, if self == Operator::Modulo { 2 } else { usize::MAX }),
            _ => (1, usize::MAX),
        }
    }

    /// The result for as many numbers as it takes.
    pub fn apply(self, numbers: &[Duration]) -> Result<Duration, NoResult> {
        let mut numbers = numbers.iter().map(|number| i128::from(number.as_micros()));
        let first = numbers.next().unwrap_or(0);
        let result = match self {
            Operator::Increment => first + SECOND,
            Operator::Decrement => first - SECOND,
            Operator::Subtract if numbers.len() == 0 => -first,
            _ => numbers.try_fold(first, |a, b| limited(self.step(a, b)?))?,
        };
        let micros = i64::try_from(limited(result)?).map_err(|_| NoResult::TooLarge)?;
        Ok(Duration::from_micros(micros))
    }

    fn step(self, a: i128, b: i128) -> Result<i128, NoResult> {
        match self {
            Operator::Multiply => exactly(a * b, SECOND),
            Operator::Divide | Operator::Modulo if b == 0 => Err(NoResult::DividedByZero),
            Operator::Divide => exactly(a * SECOND, b),
            // As in Lisp, the result has the sign of the divisor.
            Operator::Modulo => Ok((a % b + b) % b),
            Operator::Minimum => Ok(a.min(b)),
            Operator::Maximum => Ok(a.max(b)),
            Operator::Subtract | Operator::Decrement => Ok(a - b),
            Operator::Add | Operator::Increment => Ok(a + b),
        }
    }
}

/// So many units of `unit` microseconds.
pub(crate) fn scale(number: Duration, unit: i64) -> Result<Duration, NoResult> {
    let micros = limited(exactly(i128::from(number.as_micros()) * i128::from(unit), SECOND)?)?;
    i64::try_from(micros).map(Duration::from_micros).map_err(|_| NoResult::TooLarge)
}

fn exactly(top: i128, bottom: i128) -> Result<i128, NoResult> {
    if top % bottom == 0 { Ok(top / bottom) } else { Err(NoResult::NotExact) }
}

fn limited(micros: i128) -> Result<i128, NoResult> {
    let most = i128::from(Duration::MAX.as_micros());
    if (-most..=most).contains(&micros) { Ok(micros) } else { Err(NoResult::TooLarge) }
}

impl Serialize for Operator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_exact_or_refused() {
        let apply = |word: &str, numbers: &[i64]| {
            let numbers: Vec<Duration> = numbers.iter().map(|n| Duration::from_micros(*n)).collect();
            Operator::of(word).map(|operator| operator.apply(&numbers).map(Duration::as_micros))
        };
        let second = 1_000_000;
        assert_eq!(apply("+", &[second, 2, 3]), Some(Ok(1_000_005)));
        assert_eq!(apply("-", &[5]), Some(Ok(-5)));
        assert_eq!(apply("-", &[5, 7, 1]), Some(Ok(-3)));
        assert_eq!(apply("*", &[2 * second, 3 * second, 500_000]), Some(Ok(3 * second)));
        assert_eq!(apply("*", &[1, 1]), Some(Err(NoResult::NotExact)));
        assert_eq!(
            apply("*", &[1_000_000_000 * second, 1_000_000_000 * second]),
            Some(Err(NoResult::TooLarge))
        );
        assert_eq!(apply("/", &[7 * second, 2 * second]), Some(Ok(3_500_000)));
        assert_eq!(apply("/", &[second, 3 * second]), Some(Err(NoResult::NotExact)));
        assert_eq!(apply("/", &[second, 0]), Some(Err(NoResult::DividedByZero)));
        assert_eq!(apply("1+", &[second]), Some(Ok(2 * second)));
        assert_eq!(apply("1-", &[0]), Some(Ok(-second)));
        assert_eq!(apply("min", &[3, 1, 2]), Some(Ok(1)));
        assert_eq!(apply("max", &[3, 1, 2]), Some(Ok(3)));
        assert_eq!(apply("mod", &[-second, 3 * second]), Some(Ok(2 * second)));
        assert_eq!(apply("mod", &[second, 0]), Some(Err(NoResult::DividedByZero)));
        assert_eq!(apply("plus", &[1]), None);
        assert_eq!(scale(Duration::from_secs(5), 60 * second), Ok(Duration::from_secs(300)));
        assert_eq!(scale(Duration::from_micros(1), 1), Err(NoResult::NotExact));
    }
}
