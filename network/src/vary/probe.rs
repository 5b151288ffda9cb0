//! Turns knobs on a network and asks for the verdict; finds where along a knob's axis it changes.

use super::axis::{self, FARTHEST, INFINITE};
use super::{Change, Knob};
use crate::conflict::{Conflict, Part};
use crate::controllability::{is_controllable, negative_cycle};
use crate::merge::{Merged, merge};
use crate::model::{ContingentLink, Delay, EventId, Network, Requirement};
use crate::reduce::{ReduceError, reduce};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};

/// A network to ask for the verdict at other values of its bounds. Merging is done once, wherever turning a knob joins
/// and parts no events.
pub(crate) struct Probe<'a> {
    original: &'a Network,
    merged: Merged,
    /// For every requirement of the original its index in the merged network, if it is there.
    requirement_in: Vec<Option<usize>>,
    /// The merged network; put back after every question.
    varied: Network,
}

/// A knob of one network, and where it can be turned.
pub(crate) struct Dial {
    knob: Knob,
    /// The bounds of the merged network with what their positions are more than that of the knob's first. `None` if a
    /// bound is not in the merged network, as its requirement joins two events.
    merged: Option<Vec<(Part, i64)>>,
    /// Where it is now.
    pub(crate) here: i64,
    /// The hardest position, all else as it is.
    pub(crate) hardest: i64,
    /// The easiest position, all else as it is.
    pub(crate) easiest: i64,
    /// The easiest position if a shortest delay follows the longest.
    pub(crate) easiest_followed: i64,
    /// The hardest and the easiest position at which all bounds are numbers that a model may contain.
    pub(crate) finite: (i64, i64),
    /// True if the hardest position is only the largest number a model may contain.
    pub(crate) hardest_is_any: bool,
    /// The same for the easiest.
    pub(crate) easiest_is_any: bool,
}

/// The verdict at a position.
enum Answer {
    Yes,
    /// No, and the easier position that would settle the conflict found, if the knob has a share in that.
    No(Option<i64>),
}

impl<'a> Probe<'a> {
    pub(crate) fn new(original: &'a Network) -> Probe<'a> {
        let merged = merge(original);
        let mut requirement_in = vec![None; original.requirements().len()];
        for (index, &requirement) in merged.requirement_of.iter().enumerate() {
            requirement_in[requirement] = Some(index);
        }
        let varied = merged.network.clone();
        Probe { original, merged, requirement_in, varied }
    }

    /// The verdict on the network as it is.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub(crate) fn as_is(&self) -> Result<bool, TooLarge> {
        decide(&self.varied)
    }

    /// A knob of the network.
    pub(crate) fn dial(&self, knob: &Knob) -> Dial {
        let network = self.original;
        let first = knob.parts[0];
        let here = axis::position(first, knob.value(network));
        let (mut hardest, mut easiest, mut followed) = (-INFINITE, INFINITE, INFINITE);
        let (mut hardest_is_any, mut easiest_is_any) = (true, true);
        let mut finite = (-FARTHEST, FARTHEST);
        let mut merged = Some(Vec::new());
        for &part in &knob.parts {
            let own = axis::position(part, axis::value(network, part));
            // A bound that is infinite is put where the knob is.
            let offset = if is_finite(own) && is_finite(here) { own - here } else { 0 };
            let back = |position: i64| if is_finite(position) { position - offset } else { position };
            finite = (finite.0.max(-FARTHEST - offset), finite.1.min(FARTHEST - offset));
            let (hard, easy) = axis::range(network, part);
            hardest_is_any &= hard <= -FARTHEST;
            easiest_is_any &= easy >= FARTHEST;
            hardest = hardest.max(back(hard));
            easiest = easiest.min(back(easy));
            followed = followed.min(if matches!(part, Part::DelayMax(_)) { back(0) } else { back(easy) });
            match self.in_merged(part) {
                Some(part) => merged.iter_mut().for_each(|parts| parts.push((part, offset))),
                None => merged = None,
            }
        }
        let limit =
            knob.limit.map_or(INFINITE, |limit| axis::position(first, Bound::Finite(limit))).max(here);
        let (easiest, easiest_followed) = (easiest.min(limit), followed.min(limit));
        easiest_is_any &= limit == INFINITE;
        let knob = knob.clone();
        Dial {
            knob,
            merged,
            here,
            hardest,
            easiest,
            easiest_followed,
            finite,
            hardest_is_any,
            easiest_is_any,
        }
    }

    /// One more requirement, not yet bounded, from the origin to an event, for questions about the event's time.
    /// `None` if the event is the origin.
    pub(crate) fn require_time_of(&mut self, event: EventId) -> Option<usize> {
        let (from, to) = (self.merged.network.origin(), self.merged.event_of[event.index()]);
        let unbounded = Requirement { from, to, lower: Bound::Infinite, upper: Bound::Infinite };
        (from != to).then(|| self.varied.require(unbounded))
    }

    /// Takes back what [`Probe::require_time_of`] added.
    pub(crate) fn forget_time(&mut self) {
        self.varied.forget_last_requirement();
    }

    /// A side of a requirement of the merged network that has no value yet, as a dial.
    pub(crate) fn unbounded(part: Part) -> Dial {
        let knob = Knob { parts: vec![part], limit: None };
        let hardest_is_any = !matches!(part, Part::RequirementUpper(_));
        Dial {
            knob,
            merged: Some(vec![(part, 0)]),
            here: INFINITE,
            hardest: if hardest_is_any { -FARTHEST } else { 0 },
            easiest: INFINITE,
            easiest_followed: INFINITE,
            finite: (-FARTHEST, FARTHEST),
            hardest_is_any,
            easiest_is_any: true,
        }
    }

    /// True if the network is controllable with the knob at a position.
    pub(crate) fn is_yes(&mut self, dial: &Dial, position: i64) -> bool {
        self.with(dial, position, |network, _| decide(network).unwrap_or(false)).unwrap_or(false)
    }

    /// The hardest position at which the answer is "yes" between one where it is "no" and an easier one where it is "yes".
    ///
    /// What a conflict lacks is a first guess; mostly it is the answer, and two questions show that. It need not be: a
    /// cycle that takes less from the bound may be lacking more, and one may cease to be semi-reducible before its sum
    /// is mended. Then guesses that double, and halving.
    pub(crate) fn boundary(&mut self, dial: &Dial, mut no: i64, mut yes: i64) -> i64 {
        const GUESSES: usize = 12;
        if no == -INFINITE {
            no = dial.finite.0;
            if self.is_yes(dial, no) {
                return no;
            }
        }
        if yes == INFINITE {
            yes = dial.finite.1;
            if !self.is_yes(dial, yes) {
                return INFINITE;
            }
        }
        for _ in 0..GUESSES {
            let Answer::No(Some(guess)) = self.answer(dial, no) else { break };
            if guess >= yes {
                break;
            }
            if !self.is_yes(dial, guess) {
                no = guess;
                continue;
            }
            yes = guess;
            if yes - no > 1 && self.is_yes(dial, yes - 1) {
                yes -= 1;
                break;
            }
            return yes;
        }
        self.border(dial, no, yes, false).1
    }

    /// Brings two positions together of which the answer at the lower one is known, and at the upper one the other.
    fn border(&mut self, dial: &Dial, mut lower: i64, mut upper: i64, is_yes: bool) -> (i64, i64) {
        let mut step = 1_000_000;
        while upper - lower > 1 {
            let middle = lower + ((upper - lower) / 2).min(step);
            let end = if self.is_yes(dial, middle) == is_yes { &mut lower } else { &mut upper };
            *end = middle;
            step = step.saturating_mul(2);
        }
        (lower, upper)
    }

    /// The last position at which the answer is "yes" on the way from one where it is "yes" to an easier one where it is "no".
    /// There is one at most where late news of chains makes the reduction too careful.
    pub(crate) fn last_yes(&mut self, dial: &Dial, yes: i64, mut no: i64) -> i64 {
        if no == INFINITE {
            no = dial.finite.1;
            if self.is_yes(dial, no) {
                return no;
            }
        }
        self.border(dial, yes, no, true).0
    }

    /// True if with the knob at a position a requirement of it makes two events one.
    pub(crate) fn merges(&self, dial: &Dial, position: i64) -> bool {
        // What has no value yet is one side only.
        let varied =
            is_finite(dial.here).then(|| dial.knob.at(self.original, dial.value(position))).flatten();
        varied.is_some_and(|varied| dial.knob.parts.iter().any(|part| joins(&varied, *part)))
    }

    /// True if no chain has late news, so that the answer is exact.
    pub(crate) fn is_exact(&self) -> bool {
        let network = &self.merged.network;
        let chained = |link: &ContingentLink| network.link_of(link.from).is_some();
        let late = |link: &ContingentLink| link.delay != Delay::NONE;
        !network.contingents().iter().any(chained) || !network.contingents().iter().any(late)
    }

    fn answer(&mut self, dial: &Dial, position: i64) -> Answer {
        let conflict = self.with(dial, position, conflict_of).flatten();
        let Some((conflict, parts)) = conflict else { return Answer::Yes };
        let times =
            |part: &Part| conflict.members.iter().find(|share| share.part == *part).map(|it| it.times);
        let times: i64 = parts.iter().filter_map(times).map(i64::from).sum();
        let missing = conflict.total.as_micros().saturating_neg();
        let by = (times > 0).then(|| missing.div_euclid(times) + i64::from(missing.rem_euclid(times) != 0));
        Answer::No(by.map(|by| position.saturating_add(by)))
    }

    /// Asks about the merged network with the knob at a position; `None` if there is no such network.
    fn with<T>(&mut self, dial: &Dial, position: i64, ask: fn(&Network, &[Part]) -> T) -> Option<T> {
        if let Some(parts) = &dial.merged {
            let only: Vec<Part> = parts.iter().map(|(part, _)| *part).collect();
            let before: Vec<Saved> = only.iter().map(|part| Saved::of(&self.varied, *part)).collect();
            let joined = only.iter().any(|part| joins(&self.varied, *part));
            for &(part, offset) in parts {
                let at = if is_finite(position) { position + offset } else { position };
                axis::set(&mut self.varied, part, axis::value_at(part, at));
            }
            let in_order = axis::in_order(&self.varied, &only);
            // A requirement that has become [0, 0] has to be merged.
            let same_events = joined || !only.iter().any(|part| joins(&self.varied, *part));
            let answer = (in_order && same_events).then(|| ask(&self.varied, &only));
            before.into_iter().rev().for_each(|saved| saved.restore(&mut self.varied));
            if !in_order || same_events {
                return answer;
            }
        }
        let varied = dial.knob.at(self.original, axis::value_at(dial.knob.parts[0], position))?;
        let merged = merge(&varied);
        let index_of = |wanted: usize| merged.requirement_of.iter().position(|&index| index == wanted);
        let parts = dial.knob.parts.iter().filter_map(|part| match *part {
            Part::RequirementUpper(index) => index_of(index).map(Part::RequirementUpper),
            Part::RequirementLower(index) => index_of(index).map(Part::RequirementLower),
            other => Some(other),
        });
        Some(ask(&merged.network, &parts.collect::<Vec<Part>>()))
    }

    fn in_merged(&self, part: Part) -> Option<Part> {
        match part {
            Part::RequirementUpper(index) => self.requirement_in[index].map(Part::RequirementUpper),
            Part::RequirementLower(index) => self.requirement_in[index].map(Part::RequirementLower),
            other => Some(other),
        }
    }
}

impl Dial {
    /// The value at a position.
    pub(crate) fn value(&self, position: i64) -> Bound {
        axis::value_at(self.knob.parts[0], position)
    }

    /// How far it is from where the knob is to a position; `None` without end.
    pub(crate) fn distance(&self, position: i64) -> Option<Duration> {
        let both = is_finite(position) && is_finite(self.here);
        both.then(|| Duration::from_micros(self.here.abs_diff(position) as i64))
    }

    /// The change from where the knob is to a position.
    pub(crate) fn change(&self, to: i64) -> Change {
        Change { knob: self.knob.clone(), from: self.value(self.here), to: self.value(to) }
    }
}

/// What turning one bound can change.
enum Saved {
    Requirement(usize, Requirement),
    Link(usize, ContingentLink),
}

impl Saved {
    fn of(network: &Network, part: Part) -> Saved {
        match (part.requirement(), part.link()) {
            (Some(index), _) => Saved::Requirement(index, network.requirements()[index]),
            (_, Some(index)) => Saved::Link(index, network.contingents()[index]),
            (None, None) => unreachable!("it has no bound, so there is no knob for it"),
        }
    }

    fn restore(self, network: &mut Network) {
        match self {
            Saved::Requirement(index, requirement) => *network.requirement_mut(index) = requirement,
            Saved::Link(index, link) => *network.link_mut(index) = link,
        }
    }
}

/// True if there is a number at a position.
pub(crate) fn is_finite(position: i64) -> bool {
    position != INFINITE && position != -INFINITE
}

/// True if the part is of a requirement that says that two events are one.
fn joins(network: &Network, part: Part) -> bool {
    part.requirement().is_some_and(|index| network.requirements()[index].is_join())
}

/// The verdict on a merged network.
pub(crate) fn decide(merged: &Network) -> Result<bool, TooLarge> {
    match reduce(merged) {
        Ok(reduction) => is_controllable(&reduction.stnu),
        Err(ReduceError::Never(_)) => Ok(false),
        Err(ReduceError::TooLarge) => Err(TooLarge),
    }
}

/// Some conflict of a merged network, as it was found, and the parts asked about. `None` also where numbers are too large.
fn conflict_of(merged: &Network, parts: &[Part]) -> Option<(Conflict, Vec<Part>)> {
    let conflict = match reduce(merged) {
        Ok(reduction) => {
            let cycle = negative_cycle(&reduction.stnu).ok().flatten()?;
            reduction.conflict(merged, &cycle).ok()?
        }
        Err(ReduceError::Never(violation)) => violation.conflict(merged).ok()?,
        Err(ReduceError::TooLarge) => return None,
    };
    Some((conflict, parts.to_vec()))
}
