//! What can be promised of single events of a controllable network: by when, not before when, and how long it may take.

use crate::conflict::Part;
use crate::model::{EventId, Network};
use crate::slack::hardest_yes;
use crate::stnu::TooLarge;
use crate::time::{Bound, Time};
use crate::vary::{Knob, Probe};

/// What can be promised of the time of one event, each alone, all else as it is.
///
/// Where `by` is the later of the two, the time of the event depends on what Nature does. Promising one may cost the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Promise {
    /// "It happens by then": the earliest time of which this can be promised. `None` if it cannot be of any.
    pub by: Option<Time>,
    /// "It does not happen before": the latest time of which this can be promised. So long can be put off what is ours, in any
    /// case; if Nature takes her time perhaps longer, but not beyond [`crate::windows::Window::latest`]. `None` if it can be of
    /// every time.
    pub from: Option<Time>,
}

/// What can be promised of the times of some events; `None` if the network is not controllable.
///
/// Each figure is exact: a microsecond before `by`, or after `from`, it cannot be promised.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn promises(network: &Network, events: &[EventId]) -> Result<Option<Vec<Promise>>, TooLarge> {
    let mut probe = Probe::new(network);
    if !probe.as_is()? {
        return Ok(None);
    }
    let of = |event: &EventId| {
        let Some(requirement) = probe.require_time_of(*event) else {
            return Promise { by: Some(Time::ZERO), from: Some(Time::ZERO) };
        };
        let mut farthest = |part: Part| {
            farthest(&mut probe, part).finite().map(|value| Time::from_micros(value.as_micros()))
        };
        let promise = Promise {
            by: farthest(Part::RequirementUpper(requirement)),
            from: farthest(Part::RequirementLower(requirement)),
        };
        probe.forget_time();
        promise
    };
    Ok(Some(events.iter().map(of).collect()))
}

/// [`Promise::from`] of one event alone, from the origin; `None` if the network is not controllable.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn put_off_to(network: &Network, event: EventId) -> Result<Option<Bound>, TooLarge> {
    let mut probe = Probe::new(network);
    if !probe.as_is()? {
        return Ok(None);
    }
    let requirement = probe.require_time_of(event);
    let latest = |requirement| farthest(&mut probe, Part::RequirementLower(requirement));
    Ok(Some(requirement.map_or(Bound::ZERO, latest)))
}

/// How far a side that has no value yet can be bounded.
fn farthest(probe: &mut Probe<'_>, part: Part) -> Bound {
    let dial = Probe::unbounded(part);
    let position = hardest_yes(probe, &dial);
    dial.value(position)
}

/// How long what a requirement bounds may be made to take, its own upper bound aside, with all else still guaranteed.
///
/// `Infinite` if nothing limits it. `None` if the network is not controllable.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn stretch(network: &Network, requirement: usize) -> Result<Option<Bound>, TooLarge> {
    if !Probe::new(network).as_is()? {
        return Ok(None);
    }
    let lower = network.requirements()[requirement].lower;
    let mut open = network.clone();
    open.requirement_mut(requirement).upper = Bound::Infinite;
    let mut probe = Probe::new(&open);
    // What was one moment and has become two may be impossible; so may more time be where late news of chains is in play.
    let Some(knob) = Knob::of(Part::RequirementLower(requirement)) else { return Ok(None) };
    if !probe.as_is()? {
        return Ok(Some(lower));
    }
    let dial = probe.dial(&knob);
    let position = hardest_yes(&mut probe, &dial);
    Ok(Some(dial.value(position)))
}
