//! Parallel lanes of tasks, in the manner of the random STNU benchmarks.
//!
//! Task j of lane i takes [U(1..15), + U(1..10)] if Nature decides (`links` percent of them), else [U(50..500), + U(50..500)];
//! the next starts [U(50..500), + U(50..500)] later. `cross` percent of the events are tied to the event of another lane
//! that comes at about the same time: to within U(1..slack) seconds around the difference that the middles of all bounds
//! would give, so that a plan with no uncertainty would always exist. All lanes end within 1.25 times what the middles
//! add up to in the longest one. These ranges are ours; those of the sample files are alike.

use crate::model::{Delay, EventId, Network};
use crate::time::{Bound, Duration};

use super::builder::Builder;
use super::{GenerateError, Link, Random, check_size};

/// What can be varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneOptions {
    /// How many of 100 tasks are contingent.
    pub links: u32,
    /// How many of 100 events are tied to another lane.
    pub cross: u32,
    /// Such a tie leaves U(1..slack) seconds on either side.
    pub slack: u32,
    /// The longest delay of the news of each contingent task is U(0..delay) seconds, the shortest 0.
    pub delay: u32,
}

/// A fifth of the tasks contingent, a third of the events tied to other lanes, no delays.
impl Default for LaneOptions {
    fn default() -> LaneOptions {
        LaneOptions { links: 20, cross: 33, slack: 40, delay: 0 }
    }
}

/// So many lanes (`agents`) of so many `tasks`.
///
/// # Errors
/// If an argument makes no sense.
pub fn lanes(agents: u32, tasks: u32, seed: u64, options: &LaneOptions) -> Result<Network, GenerateError> {
    check_size(agents, tasks, 0, 2)?;
    for (option, percent) in [("links", options.links), ("cross", options.cross)] {
        if percent > 100 {
            return Err(GenerateError::Percent { option, percent });
        }
    }
    let mut random = Random::new(seed);
    let mut builder = Builder::new();
    // For each lane its events, each with the time the middles of all bounds before give it.
    let mut timed: Vec<Vec<(EventId, i64)>> = Vec::new();
    let mut ends = Vec::new();
    for lane in 1..=agents {
        let (mut last, mut middle) = (Builder::ORIGIN, 0);
        let mut own = Vec::with_capacity(2 * tasks as usize);
        for task in 1..=tasks {
            let start = builder.event(format!("task.{lane}.{task}:start"));
            let end = builder.event(format!("task.{lane}.{task}:end"));
            if task == 1 {
                builder.requirement(last, start, Duration::ZERO, Bound::Infinite);
            } else {
                let (lower, upper) = (random.within(50..=500), random.within(50..=500));
                builder.link(Link::Requirement, last, start, seconds(lower, lower + upper));
                middle += lower + upper / 2;
            }
            own.push((start, middle));
            if random.percent(options.links) {
                let (lower, more) = (random.within(1..=15), random.within(1..=10));
                let max = random.seconds(0..=i64::from(options.delay));
                let delay = Delay { min: Duration::ZERO, max: Bound::Finite(max) };
                builder.contingent(start, end, seconds(lower, lower + more), delay);
                middle += lower + more / 2;
            } else {
                let (lower, more) = (random.within(50..=500), random.within(50..=500));
                builder.link(Link::Requirement, start, end, seconds(lower, lower + more));
                middle += lower + more / 2;
            }
            own.push((end, middle));
            last = end;
        }
        timed.push(own);
        ends.push((last, middle));
    }
    let horizon = ends.iter().map(|&(_, middle)| middle).max().unwrap_or(0);
    let limit = Duration::from_secs(horizon + horizon / 4);
    for (end, _) in ends {
        builder.requirement(Builder::ORIGIN, end, Duration::ZERO, limit);
    }
    if agents > 1 {
        for lane in 0..timed.len() {
            for &(from, at) in &timed[lane] {
                if random.percent(options.cross) {
                    let other = random.within(0..=timed.len() as i64 - 2) as usize;
                    let (to, there) = nearest(&timed[if other < lane { other } else { other + 1 }], at);
                    let slack = random.within(1..=i64::from(options.slack.max(1)));
                    let (lower, upper) = seconds(there - at - slack, there - at + slack);
                    builder.requirement(from, to, lower, upper);
                }
            }
        }
    }
    Ok(builder.finish(format!("lanes {agents}x{tasks} seed {seed}")))
}

/// Of events in the order of their times, the one nearest to a time.
fn nearest(events: &[(EventId, i64)], time: i64) -> (EventId, i64) {
    let after = events.partition_point(|&(_, at)| at < time).min(events.len() - 1);
    let before = after.saturating_sub(1);
    if time - events[before].1 < events[after].1 - time { events[before] } else { events[after] }
}

fn seconds(lower: i64, upper: i64) -> (Duration, Duration) {
    (Duration::from_secs(lower), Duration::from_secs(upper))
}
