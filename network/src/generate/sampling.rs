//! Astronauts who sample rocks with the advice of scientists on Earth (thesis, figure 4.3 and section 4.5).
//!
//! For astronaut i and site j: A => X, chipping and scanning, [U(5..10), + U(0..10)], contingent, its data heard after
//! [0, exponential]; X -> P, the deadline of the decision, [0, U(10..20)]; P => B, the message with the decision,
//! [U(0..5), + U(0..15)], contingent, heard after [0, exponential]; B -> C, stowing, [U(1..4), + U(4..10)]; C => A of the
//! next site, the traverse, [U(5..10), + U(0..10)], contingent as the text has it. The consumables of each astronaut last
//! `tasks * u` seconds, u of U(40..55).
//!
//! The thesis gives the structure and no numbers: these ranges are ours, chosen so that some of the networks are
//! controllable and some are not.

use crate::model::Network;
use crate::time::{Bound, Duration};

use super::builder::{Builder, plus, up_to};
use super::{Exponential, GenerateError, Lambda, Link, Random, check_size};

/// What can be varied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplingOptions {
    /// The longest delay of the spectroscopy data.
    pub scan_delay: Exponential,
    /// The longest delay of the message.
    pub message_delay: Exponential,
    /// C to the next A. A contingent one starts the scan the moment the astronaut arrives.
    pub traverse: Link,
}

/// Delays of 2 s on average, traverses of Nature's.
impl Default for SamplingOptions {
    fn default() -> SamplingOptions {
        let delay = Exponential { lambda: 2.0, lambda_is: Lambda::Mean };
        SamplingOptions { scan_delay: delay, message_delay: delay, traverse: Link::Contingent }
    }
}

/// So many astronauts (`agents`), each sampling at so many sites (`tasks`).
///
/// # Errors
/// If an argument makes no sense.
pub fn sampling(
    agents: u32,
    tasks: u32,
    seed: u64,
    options: &SamplingOptions,
) -> Result<Network, GenerateError> {
    check_size(agents, tasks, 0, 5)?;
    let (scan_delay, message_delay) = (options.scan_delay.mean()?, options.message_delay.mean()?);
    let mut random = Random::new(seed);
    let mut builder = Builder::new();
    let limit = Duration::from_secs(i64::from(tasks) * random.within(40..=55));
    for astronaut in 1..=agents {
        let mut scan = builder.event(format!("scan.{astronaut}.1:start"));
        builder.requirement(Builder::ORIGIN, scan, Duration::ZERO, Bound::Infinite);
        for task in 1..=tasks {
            let scanned = builder.event(format!("scan.{astronaut}.{task}:end"));
            let message = builder.event(format!("message.{astronaut}.{task}:start"));
            let received = builder.event(format!("message.{astronaut}.{task}:end"));
            let stowed = builder.event(format!("stow.{astronaut}.{task}:end"));
            let bounds = interval(&mut random, (5, 10), (0, 10));
            builder.contingent(scan, scanned, bounds, up_to(random.exponential(scan_delay)));
            builder.requirement(scanned, message, Duration::ZERO, random.seconds(10..=20));
            let bounds = interval(&mut random, (0, 5), (0, 15));
            builder.contingent(message, received, bounds, up_to(random.exponential(message_delay)));
            let (lower, upper) = interval(&mut random, (1, 4), (4, 10));
            builder.requirement(received, stowed, lower, upper);
            if task < tasks {
                scan = builder.event(format!("scan.{astronaut}.{}:start", task + 1));
                let bounds = interval(&mut random, (5, 10), (0, 10));
                builder.link(options.traverse, stowed, scan, bounds);
            } else {
                builder.requirement(Builder::ORIGIN, stowed, Duration::ZERO, limit);
            }
        }
    }
    Ok(builder.finish(format!("sampling {agents}x{tasks} seed {seed}")))
}

/// `[l, l + more]`.
fn interval(random: &mut Random, lower: (i64, i64), more: (i64, i64)) -> (Duration, Duration) {
    let lower = random.seconds(lower.0..=lower.1);
    (lower, plus(lower, random.seconds(more.0..=more.1)))
}
