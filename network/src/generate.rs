//! Families of random networks, for benchmarks and experiments.
//!
//! The same arguments give the same network on every machine. [`repeaters()`] and [`sampling()`] are the two families of C.
//! Pittman's thesis (MIT, 2023; figures 5.2 and 4.3), [`lanes()`] is in the manner of the random STNU benchmarks.
//! All times are seconds.
//!
//! ```
//! use kirk_network::generate::{controllable, repeaters};
//!
//! let make = |seed| repeaters(2, 3, seed, &Default::default());
//! let (seed, network) = controllable(make, 1)?.expect("one of the first thousand");
//! assert_eq!(make(seed)?, network);
//! # Ok::<(), kirk_network::generate::GenerateError>(())
//! ```

mod builder;
mod lanes;
mod random;
mod repeaters;
mod sampling;

use std::fmt;

use crate::controllability::is_controllable;
use crate::merge::merge;
use crate::model::Network;
use crate::reduce::reduce;
use random::Random;

pub use lanes::{LaneOptions, lanes};
pub use repeaters::{Bounds, RepeaterOptions, repeaters};
pub use sampling::{SamplingOptions, sampling};

/// No network generated here has more events than this.
pub const MOST_EVENTS: u64 = 1_000_000;

/// So many seeds [`controllable`] tries.
pub const MOST_ATTEMPTS: u64 = 1000;

/// The first seed from `seed` on for which `make` gives a controllable network, and that network; `None` if there is
/// none among [`MOST_ATTEMPTS`].
///
/// # Errors
/// Those of `make`.
pub fn controllable<E>(
    make: impl Fn(u64) -> Result<Network, E>,
    seed: u64,
) -> Result<Option<(u64, Network)>, E> {
    for attempt in 0..MOST_ATTEMPTS {
        let seed = seed.wrapping_add(attempt);
        let network = make(seed)?;
        // Without the reasons of a "no", which would take most of the time.
        let reduction = reduce(&merge(&network).network);
        if reduction.is_ok_and(|reduction| is_controllable(&reduction.stnu) == Ok(true)) {
            return Ok(Some((seed, network)));
        }
    }
    Ok(None)
}

/// Who decides how long something takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// We do, within the bounds.
    Requirement,
    /// Nature does.
    Contingent,
}

/// An exponential distribution, of the longest delay of news.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// The parameter.
    pub lambda: f64,
    /// What the parameter is.
    pub lambda_is: Lambda,
}

/// What the parameter of an exponential distribution is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lambda {
    /// Delays are `lambda` seconds long on average.
    Mean,
    /// Delays are `1 / lambda` seconds long on average: the density is `lambda * exp(-lambda * t)`.
    Rate,
}

impl Exponential {
    /// The average, if the parameter makes sense.
    fn mean(self) -> Result<f64, GenerateError> {
        let mean = match self.lambda_is {
            Lambda::Mean => self.lambda,
            Lambda::Rate => 1.0 / self.lambda,
        };
        let sensible = self.lambda > 0.0 && (0.000_001..=1_000_000.0).contains(&mean);
        if sensible { Ok(mean) } else { Err(GenerateError::Lambda) }
    }
}

/// Why there is no such network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GenerateError {
    /// There must be at least one agent.
    NoAgents,
    /// There must be at least one task for each agent.
    NoTasks,
    /// The network would have too many events.
    TooLarge {
        /// So many.
        events: u64,
    },
    /// The parameter of the delays is not a positive number, or gives delays of nothing or of weeks.
    Lambda,
    /// A chance is not within 0 to 100 percent.
    Percent {
        /// Which option.
        option: &'static str,
        /// What it was set to.
        percent: u32,
    },
}

impl fmt::Display for GenerateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GenerateError::NoAgents => write!(f, "the number of agents is 0; there must be at least one"),
            GenerateError::NoTasks => write!(f, "the number of tasks is 0; each agent needs at least one"),
            GenerateError::TooLarge { events } => {
                write!(f, "the network would have {events} events; at most {MOST_EVENTS} are generated")
            }
            GenerateError::Lambda => {
                write!(
                    f,
                    "lambda must be a positive number that gives delays of 0.000001 to 1000000 s on average"
                )
            }
            GenerateError::Percent { option, percent } => {
                write!(f, "{option} is {percent} percent; it must be from 0 to 100")
            }
        }
    }
}

impl std::error::Error for GenerateError {}

/// Refuses sizes that make no sense: `1 + agents * (per_agent + per_task * tasks)` events.
fn check_size(agents: u32, tasks: u32, per_agent: u64, per_task: u64) -> Result<(), GenerateError> {
    if agents == 0 {
        return Err(GenerateError::NoAgents);
    }
    if tasks == 0 {
        return Err(GenerateError::NoTasks);
    }
    let events = u64::from(agents).saturating_mul(per_agent + per_task * u64::from(tasks)).saturating_add(1);
    if events > MOST_EVENTS { Err(GenerateError::TooLarge { events }) } else { Ok(()) }
}
