//! The same network with some bounds at other values: what asks how far a bound can move, or has to.
//!
//! A [`Knob`] is one bound, or several that are written once and so move together. Its values are laid on an axis
//! (`axis`) on which larger is easier for us, whatever the bound: a later deadline, a smaller least duration, less
//! uncertainty, sooner news. Nature having fewer choices, or we having more, never turns a "yes" into a "no": along
//! the axis the verdict changes once, from "no" to "yes", and `Probe` finds where.
//!
//! There are two exceptions. A requirement that is exactly [0, 0] makes two events one, which is another model and may
//! be an easier one. And where news of the first event of a chain is late, [`reduce`](mod@crate::reduce) may say "no" too
//! often, and not at every value. So what is found is claimed for what it is: "yes" at a value, "no" a microsecond
//! beyond it.

mod axis;
mod probe;

use crate::conflict::Part;
use crate::model::Network;
use crate::time::{Bound, Duration};

pub(crate) use axis::INFINITE;
pub(crate) use probe::{Dial, Probe, decide, is_finite};

/// One bound, or several of one kind that move together by the same amount, as they are written once.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Knob {
    /// At least one; all of one kind.
    parts: Vec<Part>,
    /// No value easier than this is wanted, whatever the network would allow.
    limit: Option<Duration>,
}

impl Knob {
    /// One bound alone. `None` for what has no bound: [`Part::AfterOrigin`] and [`Part::Join`].
    pub fn of(part: Part) -> Option<Knob> {
        Knob::together(vec![part])
    }

    /// Bounds that move together. `None` if there are none, or they are not of one kind, or have no value.
    pub fn together(mut parts: Vec<Part>) -> Option<Knob> {
        parts.sort_unstable();
        parts.dedup();
        let first = *parts.first()?;
        let alike = |part: &Part| std::mem::discriminant(part) == std::mem::discriminant(&first);
        let has_bound = !matches!(first, Part::AfterOrigin | Part::Join(_));
        (has_bound && parts.iter().all(alike)).then_some(Knob { parts, limit: None })
    }

    /// The same, never to be made easier than `limit`: a least duration cannot be less than nothing.
    #[must_use]
    pub fn limited(self, limit: Duration) -> Knob {
        Knob { limit: Some(limit), ..self }
    }

    /// The same, never to lose its sense: what takes time is to take no less than none, what comes after something is to go on
    /// to, and no news is there before what it tells.
    #[must_use]
    pub fn in_its_sense(self, network: &Network) -> Knob {
        let value = self.value(network).finite();
        let keeps_order = match self.parts[0] {
            Part::RequirementLower(_) => value.is_some_and(|lower| lower >= Duration::ZERO),
            Part::RequirementUpper(index) => {
                let is_order = network.requirements()[index].lower == Bound::Infinite;
                is_order && value.is_some_and(|upper| upper <= Duration::ZERO)
            }
            part => matches!(part, Part::DelayMax(_)),
        };
        if keeps_order { self.limited(Duration::ZERO) } else { self }
    }

    /// The bounds, in order. The value of the first stands for all.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The value of the first of the bounds.
    pub fn value(&self, network: &Network) -> Bound {
        axis::value(network, self.parts[0])
    }

    /// The network with this knob at another value; the others of its bounds move by as much as the first. A shortest
    /// delay follows a longest one that becomes less than it. `None` if that is no network.
    pub fn at(&self, network: &Network, to: Bound) -> Option<Network> {
        let mut varied = network.clone();
        self.turn(&mut varied, to)?;
        Some(varied)
    }

    /// Turns the knob in a network; `None` if that is no network any more.
    fn turn(&self, network: &mut Network, to: Bound) -> Option<()> {
        let shifted: Option<Vec<Bound>> =
            self.parts.iter().map(|part| self.shifted(network, *part, to)).collect();
        for (part, value) in self.parts.iter().zip(shifted?) {
            axis::set(network, *part, value);
        }
        axis::in_order(network, &self.parts).then_some(())
    }

    /// The value of one of the bounds when the first is at `to`. `None` if it is beyond what a model may contain.
    fn shifted(&self, network: &Network, part: Part, to: Bound) -> Option<Bound> {
        let (first, this) = (self.value(network), axis::value(network, part));
        let (Bound::Finite(first), Bound::Finite(this), Bound::Finite(to)) = (first, this, to) else {
            return Some(to);
        };
        let shifted = this.checked_add(to.checked_sub(first)?)?;
        (shifted <= Duration::MAX && shifted.as_micros() >= -Duration::MAX.as_micros())
            .then_some(Bound::Finite(shifted))
    }
}

/// A knob turned from one value to another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What is turned.
    pub knob: Knob,
    /// The value of its first bound in the network.
    pub from: Bound,
    /// The value it is to have.
    pub to: Bound,
}

impl Change {
    /// By how much the bound moves, without sign; `None` if it is infinite before or after.
    pub fn amount(&self) -> Option<Duration> {
        let by = self.to.finite()?.checked_sub(self.from.finite()?)?;
        Some(Duration::from_micros(by.as_micros().saturating_abs()))
    }

    /// The value a microsecond harder than the one it is to have; `None` if that is infinite.
    pub(crate) fn just_before(&self) -> Option<Bound> {
        let part = *self.knob.parts().first()?;
        self.to.finite()?;
        Some(axis::value_at(part, axis::position(part, self.to) - 1))
    }
}

/// The network with several knobs turned, one after the other; `None` if that is no network.
pub fn changed(network: &Network, changes: &[Change]) -> Option<Network> {
    let mut varied = network.clone();
    changes.iter().try_for_each(|change| change.knob.turn(&mut varied, change.to))?;
    Some(varied)
}
