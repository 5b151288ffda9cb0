//! Rovers that set up radio repeaters on the Moon, a grid of them (thesis, figure 5.2 and section 4.5).
//!
//! For rover i and repeater j: A => B, the traverse to the site, [0, U(0..19)], contingent; B -> C, the installation,
//! [0, U(0..14)]; C => D, the test with confirmation from Earth, [0, U(0..19)], contingent, heard after [0, exponential];
//! D -> A of the next repeater, the cleaning up, [a, a + U(4..10)] with a of U(0..10). Rover i + 1 starts its jth test
//! after rover i has ended its own: bandwidth is limited. The consumables of each rover last `tasks * u` seconds, u of
//! U(50..60). Every number is drawn by itself, U in whole seconds, both ends included. The text of the thesis has other
//! ranges, see [`Bounds`].

use crate::model::{Delay, EventId, Network};
use crate::time::{Bound, Duration};

use super::builder::{Builder, plus, up_to};
use super::{Exponential, GenerateError, Lambda, Link, Random, check_size};

/// What the thesis leaves open, or varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepeaterOptions {
    /// The longest delay of the confirmation.
    pub delay: Exponential,
    /// D to the next A: a requirement in the figure, a contingent link in the text.
    pub last_link: Link,
    /// Whether a rover cleans up after its last repeater as well, or ends with its confirmation.
    pub clean_up_at_end: bool,
    /// For how many activities more than there are repeaters the consumables last.
    pub spare: u32,
    /// What the bounds are drawn from.
    pub bounds: Bounds,
}

/// Two ways to draw the bounds. With those of the tables all figures of the thesis come out to within chance, with
/// those of the text most do not (`docs/EXPERIMENTS.md`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounds {
    /// U(0..19) for traverse and test, U(0..14) for the installation, as a `random` that leaves out its limit has it, and
    /// cleaning up from U(0..10) on.
    Tables,
    /// U(0..20), U(0..15), and cleaning up from U(10..20) on.
    Text,
}

/// The figure, with delays of 3 s on average, and the bounds of the tables.
///
/// The thesis gives the density of an exponential distribution of rate 3, but says that a larger lambda makes longer
/// delays, and with a rate of 3 they are too short to matter: hardly a network is lost to them, where the thesis loses
/// 619 of 841. With an average of 3 s as many are.
impl Default for RepeaterOptions {
    fn default() -> RepeaterOptions {
        RepeaterOptions {
            delay: Exponential { lambda: 3.0, lambda_is: Lambda::Mean },
            last_link: Link::Requirement,
            clean_up_at_end: false,
            spare: 0,
            bounds: Bounds::Tables,
        }
    }
}

/// So many rovers (`agents`), each setting up so many repeaters (`tasks`).
///
/// # Errors
/// If an argument makes no sense.
pub fn repeaters(
    agents: u32,
    tasks: u32,
    seed: u64,
    options: &RepeaterOptions,
) -> Result<Network, GenerateError> {
    check_size(agents, tasks, 1, 4)?;
    let mean_delay = options.delay.mean()?;
    let (longest, installation, clean_up) = match options.bounds {
        Bounds::Tables => (19, 14, 0),
        Bounds::Text => (20, 15, 10),
    };
    let mut random = Random::new(seed);
    let mut builder = Builder::new();
    let activities = i64::from(tasks) + i64::from(options.spare);
    let limit = Duration::from_secs(activities * random.within(50..=60));
    // The ends of the confirmations of the rover before.
    let mut confirmed_before: Vec<EventId> = Vec::new();
    for rover in 1..=agents {
        let mut confirmed = Vec::with_capacity(tasks as usize);
        let mut traverse = builder.event(format!("traverse.{rover}.1:start"));
        builder.requirement(Builder::ORIGIN, traverse, Duration::ZERO, Bound::Infinite);
        let mut end = traverse;
        for task in 1..=tasks {
            let arrived = builder.event(format!("traverse.{rover}.{task}:end"));
            let test = builder.event(format!("test.{rover}.{task}:start"));
            let done = builder.event(format!("test.{rover}.{task}:end"));
            let zero = Duration::ZERO;
            builder.contingent(traverse, arrived, (zero, random.seconds(0..=longest)), Delay::NONE);
            builder.requirement(arrived, test, zero, random.seconds(0..=installation));
            let duration = (zero, random.seconds(0..=longest));
            builder.contingent(test, done, duration, up_to(random.exponential(mean_delay)));
            if let Some(&before) = confirmed_before.get(task as usize - 1) {
                builder.requirement(before, test, zero, Bound::Infinite);
            }
            confirmed.push(done);
            end = done;
            // Drawn even where it is not used, so that the option changes nothing else.
            let lower = random.seconds(clean_up..=clean_up + 10);
            let bounds = (lower, plus(lower, random.seconds(4..=10)));
            if task < tasks || options.clean_up_at_end {
                let name = if task < tasks {
                    format!("traverse.{rover}.{}:start", task + 1)
                } else {
                    format!("clean-up.{rover}.{task}:end")
                };
                traverse = builder.event(name);
                builder.link(options.last_link, done, traverse, bounds);
                end = traverse;
            }
        }
        builder.requirement(Builder::ORIGIN, end, Duration::ZERO, limit);
        confirmed_before = confirmed;
    }
    Ok(builder.finish(format!("repeaters {agents}x{tasks} seed {seed}")))
}
