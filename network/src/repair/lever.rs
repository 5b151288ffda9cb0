//! A knob as a number to choose: by how many microseconds it is made easier, and which of these give values that are wanted.

use std::iter::successors;

use crate::conflict::Part;
use crate::model::{EventId, Network};
use crate::time::{Bound, Duration};
use crate::vary::{Change, Dial, Knob, Probe, is_finite};

use super::Allowed;

pub(super) struct Lever {
    pub(super) knob: Knob,
    /// What a microsecond costs.
    pub(super) weight: u64,
    pub(super) dial: Dial,
    /// The position from which amounts are counted: where the knob is, but for news that may never come.
    start: i64,
    /// The greatest amount.
    pub(super) room: i64,
    unit: i64,
}

impl Lever {
    /// `None` if the bound is missing, or cannot be any easier.
    pub(super) fn new(network: &Network, probe: &Probe<'_>, allowed: &Allowed) -> Option<Lever> {
        let dial = probe.dial(&allowed.knob);
        let start = match allowed.knob.parts()[0] {
            Part::DelayMax(_) if !is_finite(dial.here) => -longest_useful(network, &allowed.knob),
            _ => dial.here,
        };
        let room = dial.easiest_followed.min(dial.finite.1).checked_sub(start)?;
        let (knob, weight, unit) =
            (allowed.knob.clone(), allowed.weight.max(1), allowed.unit.as_micros().max(1));
        (is_finite(start) && room > 0).then_some(Lever { knob, weight, dial, start, room, unit })
    }

    /// The least amount that is wanted and no less than this.
    pub(super) fn up(&self, amount: i64) -> Option<i64> {
        if amount <= 0 {
            return Some(0);
        }
        let whole = (self.start + amount - 1).div_euclid(self.unit) * self.unit + self.unit - self.start;
        let up = if whole <= self.room { whole } else { amount };
        (up <= self.room).then_some(up)
    }

    /// The greatest amount that is wanted and no more than this.
    pub(super) fn down(&self, amount: i64) -> i64 {
        let amount = amount.min(self.room);
        let last = (self.start + self.room).div_euclid(self.unit) * self.unit - self.start;
        if amount > last.max(0) {
            return amount;
        }
        ((self.start + amount).div_euclid(self.unit) * self.unit - self.start).max(0)
    }

    /// An amount with which the bound is no longer in the way of any other: more than all bounds together, if there is room.
    pub(super) fn far(&self, network: &Network) -> i64 {
        let size = |bound: Bound| bound.finite().map_or(0, |finite| finite.as_micros().saturating_abs());
        let requirements = network.requirements().iter().flat_map(|it| [it.lower, it.upper]);
        let links = network.contingents().iter();
        let links = links.flat_map(|it| [it.upper.into(), it.delay.min.into(), it.delay.max]);
        let all = requirements.chain(links).map(size).fold(self.unit, i64::saturating_add);
        self.down(all)
    }

    /// The position at an amount.
    pub(super) fn position(&self, amount: i64) -> i64 {
        if amount == 0 { self.dial.here } else { self.start + amount }
    }

    /// The amount that leads to a position.
    pub(super) fn amount(&self, position: i64) -> i64 {
        (position - self.start).max(1)
    }

    pub(super) fn change(&self, amount: i64) -> Change {
        self.dial.change(self.position(amount))
    }

    /// The amount of a change of this knob; `None` if it is without end.
    pub(super) fn amount_of(&self, change: &Change) -> Option<i64> {
        let micros = change.to.finite()?.as_micros();
        let start = self.dial.value(self.start).finite()?.as_micros();
        // News that may never come may be of use a little later than was thought.
        Some(if change.from == Bound::Infinite { (start - micros).max(1) } else { (micros - start).abs() })
    }
}

/// The longest delay, in microseconds, with which news that may never come would tell anything: as long as the event is
/// uncertain when it comes at the earliest.
pub(super) fn longest_useful(network: &Network, knob: &Knob) -> i64 {
    let useful = |part: &Part| match *part {
        Part::DelayMax(link) => {
            let delay = network.contingents()[link].delay;
            delay.min.as_micros().saturating_add(spread(network, link))
        }
        _ => 0,
    };
    knob.parts().iter().map(useful).max().unwrap_or(0).min(Duration::MAX.as_micros())
}

/// How uncertain the end of a link is as long as there is no news: what Nature can choose between on the way to it.
pub(super) fn spread(network: &Network, link: usize) -> i64 {
    let width = |link: usize| {
        let link = network.contingents()[link];
        link.upper.as_micros().saturating_sub(link.lower.as_micros())
    };
    way_to(network, link).map(width).fold(0, i64::saturating_add)
}

/// A link and all before it, up to one that starts at an event of ours.
pub(super) fn way_to(network: &Network, link: usize) -> impl Iterator<Item = usize> + use<'_> {
    successors(Some(link), |link| network.link_of(network.contingents()[*link].from))
}

/// For every link the event at the root of its tree.
pub(super) fn roots(network: &Network) -> Vec<EventId> {
    let root = |link: usize| {
        let above = |event: &EventId| Some(network.contingents()[network.link_of(*event)?].from);
        successors(Some(network.contingents()[link].to), above).last()
    };
    (0..network.contingents().len()).filter_map(root).collect()
}

/// True if a requirement says that two events are one.
pub(super) fn joins(network: &Network, requirement: usize) -> bool {
    network.requirements()[requirement].is_join()
}
