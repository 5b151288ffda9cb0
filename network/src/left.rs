//! What is left of an execution: between which times each event can still happen, what can be promised of it, and what has to be
//! given up if not all can be kept.
//!
//! *Can still happen* is meant over all that Nature may still do, by what has been heard, and over all that we may still do
//! without losing the guarantee. Two networks close that in from both sides. One is what is left with all news as early as it can
//! be, so that what may have happened already is known now: nobody can do more with less, so nothing happens outside of its
//! windows (as in [`windows`](mod@crate::windows)). The other is what is left as it is planned, each news used within its window:
//! what a plan leaves open can happen. Where both have the same end it is exact, and where they differ the first is told, as what
//! it is: not before, or not after. They are the same where no news is late by more or less and no link of a chain is delayed.

use crate::conflict::Part;
use crate::controllability::{Step, is_controllable, negative_cycle};
use crate::model::{Delay, EventId, Network, Requirement};
use crate::promise::Promise;
use crate::reduce::{Progress, reduce_rest};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration, Interval, Time};
use crate::windows::{Window, hear_early, is_chained, of_reduction};

/// How far an execution of a merged network has got.
#[derive(Clone, Debug)]
pub struct SoFar {
    /// Nothing more happens before this.
    pub now: Time,
    /// What is known of every event.
    pub events: Vec<Seen>,
}

/// What is known of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// It is ours and to come, or Nature's and what it follows is to come.
    ToCome,
    /// It was executed then.
    Executed(Time),
    /// It was handed over then, and nobody has confirmed it: it may have been executed, now or at any time since.
    Begun(Time),
    /// Nature has begun with it: it happened or will happen in this interval.
    Nature {
        /// By all that was heard, and not heard, up to now.
        happened: Interval,
        /// Its news has come.
        heard: bool,
        /// It has happened, as far as the plan is concerned: it was heard of, or acted on without.
        settled: bool,
    },
}

/// When an event can still happen. Of one that has happened, when it did as far as that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Left {
    /// Not before this; and not after.
    pub window: Window,
    /// It can happen as early as that.
    pub earliest_is_exact: bool,
    /// It can happen as late as that, or at any time if there is no latest.
    pub latest_is_exact: bool,
}

/// When every event of a merged network can still happen, while all [can be kept](can_be_kept).
pub fn left(network: &Network, so_far: &SoFar) -> Vec<Left> {
    let mut early = network.clone();
    hear_early(&mut early);
    let planned = windows_of(network, &so_far.planned(network));
    // Where Nature has broken the model, what is known of a chain may not even fit together.
    let earliest = windows_of(&early, &so_far.at_once(network, Course::Early));
    let latest = windows_of(&early, &so_far.at_once(network, Course::Late));
    let of = |event: EventId| {
        let at = event.index();
        let window = Window {
            earliest: earliest.as_ref().map_or(so_far.now, |windows| windows[at].earliest),
            latest: latest.as_ref().and_then(|windows| windows[at].latest),
        };
        let known = match so_far.events[at] {
            Seen::Executed(time) => Some(Interval::at(time)),
            Seen::Nature { happened, .. } => Some(happened),
            Seen::ToCome | Seen::Begun(_) => None,
        };
        if let Some(Interval { earliest, latest }) = known {
            let window = Window { earliest, latest: Some(latest).filter(|latest| *latest < Time::MAX) };
            return Left { window, earliest_is_exact: true, latest_is_exact: latest < Time::MAX };
        }
        let planned = planned.as_ref().map(|planned| planned[at]);
        let is_exact =
            |agrees: fn(Window, Window) -> bool| planned.is_some_and(|planned| agrees(planned, window));
        Left {
            window,
            earliest_is_exact: is_exact(|planned, window| planned.earliest == window.earliest),
            latest_is_exact: is_exact(|planned, window| planned.latest == window.latest),
        }
    };
    network.event_ids().map(of).collect()
}

/// True if whatever Nature does, by what has been heard, all requirements that are not decided yet can be kept.
pub fn can_be_kept(network: &Network, so_far: &SoFar) -> bool {
    decide(network, &so_far.planned(network)).unwrap_or(false)
}

/// What can be promised of the time of an event of ours that is to come; `None` if not everything can be kept any more.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn promise_left(network: &Network, so_far: &SoFar, event: EventId) -> Result<Option<Promise>, TooLarge> {
    /// Later than that nothing happens.
    const FARTHEST: i64 = Duration::MAX.as_micros();
    let progress = so_far.planned(network);
    if !decide(network, &progress)? {
        return Ok(None);
    }
    let mut asked = network.clone();
    let unbounded =
        Requirement { from: network.origin(), to: event, lower: Bound::Infinite, upper: Bound::Infinite };
    let at = asked.require(unbounded);
    let mut holds = |lower: Option<i64>, upper: Option<i64>| {
        let bound = |micros: Option<i64>| {
            micros.map_or(Bound::Infinite, |micros| Bound::Finite(Duration::from_micros(micros)))
        };
        *asked.requirement_mut(at) = Requirement { lower: bound(lower), upper: bound(upper), ..unbounded };
        decide(&asked, &progress)
    };
    let now = so_far.now.as_micros();
    let by = match holds(None, Some(FARTHEST))? {
        false => None,
        true => Some(first_yes(now, FARTHEST, |time| holds(None, Some(time)))?),
    };
    let from = match holds(Some(FARTHEST), None)? {
        true => None,
        false => Some(first_yes(now, FARTHEST, |time| Ok(!holds(Some(time), None)?))? - 1),
    };
    Ok(Some(Promise { by: by.map(Time::from_micros), from: from.map(Time::from_micros) }))
}

/// The least number from `first` on of which the answer is yes, as it is of all that are greater; of `last` it is yes.
fn first_yes(
    first: i64,
    last: i64,
    mut is_yes: impl FnMut(i64) -> Result<bool, TooLarge>,
) -> Result<i64, TooLarge> {
    let (mut no, mut yes, mut step) = (first - 1, last, 1_000_000);
    while yes - no > 1 {
        let middle = no + ((yes - no) / 2).min(step);
        if is_yes(middle)? {
            yes = middle
        } else {
            no = middle
        }
        step = step.saturating_mul(2);
    }
    Ok(yes)
}

/// The sides of requirements that have to be given up so that all others can be kept, if not all can. None of them could stay beside
/// the others. Of those that do not go together, the longest upper bound is given up: deadlines rather than how things are done.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn given_up(network: &Network, so_far: &SoFar) -> Result<Vec<Part>, TooLarge> {
    let progress = so_far.planned(network);
    let mut rest = network.clone();
    let mut found: Vec<(Part, Bound)> = Vec::new();
    // It ends: every round makes a finite bound infinite, and without any nothing is left to break.
    while let Some(part) = to_blame(&rest, &progress)? {
        found.push((part, std::mem::replace(side(&mut rest, part), Bound::Infinite)));
    }
    // What is given up later may settle what was given up before.
    let mut given_up: Vec<Part> = Vec::new();
    for (part, bound) in found.into_iter().rev() {
        *side(&mut rest, part) = bound;
        if !decide(&rest, &progress)? {
            *side(&mut rest, part) = Bound::Infinite;
            given_up.push(part);
        }
    }
    given_up.sort_unstable();
    Ok(given_up)
}

/// A side of a requirement of those that cannot be kept together, if there are any.
fn to_blame(network: &Network, progress: &Progress) -> Result<Option<Part>, TooLarge> {
    let reduction = reduce_rest(network, progress).map_err(|_| TooLarge)?;
    let Some(cycle) = negative_cycle(&reduction.stnu)? else { return Ok(None) };
    let parts = cycle.steps.iter().filter_map(|&(step, _)| match step {
        Step::Edge(edge) => Some(reduction.sources[edge as usize].part()),
        Step::Lower(_) | Step::Upper(_) => None,
    });
    let ours = parts.filter(|part| *part != Part::AfterOrigin);
    Ok(ours.max_by_key(|part| (matches!(part, Part::RequirementUpper(_)), part.bound(network), *part)))
}

fn side(network: &mut Network, part: Part) -> &mut Bound {
    match part {
        Part::RequirementLower(index) => &mut network.requirement_mut(index).lower,
        Part::RequirementUpper(index) => &mut network.requirement_mut(index).upper,
        _ => unreachable!("only requirements are given up"),
    }
}

fn decide(network: &Network, progress: &Progress) -> Result<bool, TooLarge> {
    is_controllable(&reduce_rest(network, progress).map_err(|_| TooLarge)?.stnu)
}

fn windows_of(network: &Network, progress: &Progress) -> Option<Vec<Window>> {
    of_reduction(&reduce_rest(network, progress).ok()?)
}

/// Which end of what is possible is asked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Course {
    Early,
    Late,
}

impl Course {
    fn of(self, interval: Interval) -> Time {
        if self == Course::Early { interval.earliest } else { interval.latest }
    }
}

impl SoFar {
    /// What a plan goes by. Where no news is to help, silence tells all there is to know.
    fn planned(&self, network: &Network) -> Progress {
        let chained = is_chained(network);
        let known =
            network.event_ids().map(|event| match (self.events[event.index()], network.link_of(event)) {
                (Seen::Executed(time), _) => Some(Interval::at(time)),
                (Seen::Nature { happened: Interval { earliest, latest }, settled, .. }, Some(link)) => {
                    let Delay { min, max } = network.contingents()[link].delay;
                    let window = latest.saturating_since(earliest);
                    let helps = max.finite().is_some_and(|max| window > max.saturating_sub(min));
                    let over = !helps || latest.saturating_add(min) <= self.now;
                    (settled || over && !chained[link]).then_some(Interval::new(earliest, latest))
                }
                _ => None,
            });
        Progress { now: self.now, known: known.collect() }
    }

    /// What would be known if all news that can have come by now had come, and all had gone this way so far.
    fn at_once(&self, network: &Network, course: Course) -> Progress {
        let chained = is_chained(network);
        let known =
            network.event_ids().map(|event| match (self.events[event.index()], network.link_of(event)) {
                (Seen::Executed(time), _) => Some(Interval::at(time)),
                (Seen::Begun(time), _) => Some(Interval::at(time)).filter(|_| course == Course::Early),
                // No other news will say more of it.
                (Seen::Nature { happened, heard: true, .. }, Some(link)) if !chained[link] => Some(happened),
                (Seen::Nature { happened, heard, .. }, Some(link)) => {
                    let delay =
                        if chained[link] { Duration::ZERO } else { network.contingents()[link].delay.min };
                    let time = course.of(happened);
                    (heard || time.saturating_add(delay) <= self.now).then_some(Interval::at(time))
                }
                _ => None,
            });
        Progress { now: self.now, known: known.collect() }
    }
}
