//! How much is left: how far each bound of a controllable network can move before the guarantee is lost.
//!
//! Every figure is exact: at it the verdict is "yes", a microsecond beyond it "no". The longest delays that can be tolerated
//! are those of N. Bhargava, T. Vaquero, B. Williams, *Faster conflict generation for dynamic controllability*, IJCAI 2017, and
//! J. Cui, P. Yu, C. Fang, P. Haslum, B. Williams, *Optimising bounds in simple temporal networks with uncertainty under
//! dynamic controllability constraints*, ICAPS 2015, asked for one bound at a time.

use crate::check::{Verdict, check};
use crate::conflict::{Conflict, Part};
use crate::merge::merge;
use crate::model::{ContingentLink, Network};
use crate::stnu::{TooLarge, add};
use crate::time::{Bound, Duration};
use crate::vary::{Dial, INFINITE, Knob, Probe, decide, is_finite};

/// Where the value of a bound may lie, all else as it is, with the guarantee kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slack {
    /// The bound, or the bounds that move together.
    pub knob: Knob,
    /// The value of the first of them.
    pub value: Bound,
    /// The least value; `Infinite` if there is no limit.
    pub least: Bound,
    /// The greatest value; `Infinite` if there is no limit.
    pub most: Bound,
    /// How far the value can move to the side on which it becomes harder to keep the rest; `None` without a limit.
    pub room: Option<Duration>,
    /// True if a microsecond further the guarantee is lost. Otherwise nothing stops the bound but its own sense: it has met its
    /// partner, or zero.
    pub loses: bool,
}

/// Where each knob can be turned; `None` if the network is not controllable.
///
/// Bounds stay in order: an upper bound cannot be below its lower one, whatever else would allow it.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn slack(network: &Network, knobs: &[Knob]) -> Result<Option<Vec<Slack>>, TooLarge> {
    let mut probe = Probe::new(network);
    if !probe.as_is()? {
        return Ok(None);
    }
    let of = |knob: &Knob| {
        let dial = probe.dial(knob);
        let (hard, easy) = (hardest_yes(&mut probe, &dial), easiest_yes(&mut probe, &dial));
        let (mut least, mut most) = (dial.value(hard), dial.value(easy));
        if knob.parts()[0].is_subtracted() {
            std::mem::swap(&mut least, &mut most);
        }
        let room = dial.distance(hard);
        let loses = is_finite(hard) && hard > dial.hardest.max(dial.finite.0);
        Slack { knob: knob.clone(), value: dial.value(dial.here), least, most, room, loses }
    };
    Ok(Some(knobs.iter().map(of).collect()))
}

/// All bounds that a network has, each alone, in the order of the network.
pub fn bounds(network: &Network) -> Vec<Knob> {
    let requirements = network.requirements().iter().enumerate().flat_map(|(index, requirement)| {
        let lower = requirement.lower.finite().map(|_| Part::RequirementLower(index));
        let upper = requirement.upper.finite().map(|_| Part::RequirementUpper(index));
        [lower, upper].into_iter().flatten()
    });
    let links = (0..network.contingents().len()).flat_map(|index| {
        [Part::LinkLower(index), Part::LinkUpper(index), Part::DelayMin(index), Part::DelayMax(index)]
    });
    requirements.chain(links).filter_map(Knob::of).collect()
}

/// Why a bound cannot move beyond its slack: the conflict a microsecond further, which is the chain of bounds on which that is
/// critical. Its amounts are those of the network as it is, and add up to what is left, not to a lack. `None` if the
/// guarantee is not lost there.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn beyond(network: &Network, slack: &Slack) -> Result<Option<Conflict>, TooLarge> {
    let (end, micro) = match slack.knob.parts()[0].is_subtracted() {
        true => (slack.most, 1),
        false => (slack.least, -1),
    };
    let further = end.finite().and_then(|end| end.checked_add(Duration::from_micros(micro)));
    let further = further.filter(|_| slack.loses);
    let further = further.and_then(|value| slack.knob.at(network, Bound::Finite(value)));
    match further.as_ref().map(check).transpose()? {
        Some(Verdict::Uncontrollable(conflict)) => Ok(Some(as_it_is(conflict, network)?)),
        Some(Verdict::Controllable) | None => Ok(None),
    }
}

/// A conflict of a network with other bounds, with the amounts of this one.
fn as_it_is(mut conflict: Conflict, network: &Network) -> Result<Conflict, TooLarge> {
    let mut total = 0;
    for share in &mut conflict.members {
        let sign = match share.part {
            Part::RequirementUpper(_) | Part::LinkLower(_) | Part::DelayMin(_) => 1,
            Part::RequirementLower(_) | Part::LinkUpper(_) | Part::DelayMax(_) => -1,
            Part::AfterOrigin | Part::Join(_) => 0,
        };
        let times = sign * i64::from(share.times);
        let amount = share.bound(network).as_micros().checked_mul(times).ok_or(TooLarge)?;
        total = add(total, amount)?;
        share.amount = Duration::from_micros(amount);
    }
    conflict.total = Duration::from_micros(total);
    Ok(conflict)
}

/// How many times as late all news may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Factor {
    /// So many millionths: 1,500,000 is one and a half times.
    Millionths(i64),
    /// It need never come.
    Unlimited,
}

/// By what factor the longest delays of all news can grow together, each rounded down to a microsecond; the shortest delays
/// stay. A millionth more would be too much. `None` if the network is not controllable, or no news has a delay that could grow.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn common_factor(network: &Network) -> Result<Option<Factor>, TooLarge> {
    const ONE: i64 = 1_000_000;
    let merged = merge(network).network;
    let late = |link: &ContingentLink| link.delay.max.finite().filter(|max| *max > Duration::ZERO);
    let Some(longest) = merged.contingents().iter().filter_map(late).max() else { return Ok(None) };
    if !decide(&merged)? {
        return Ok(None);
    }
    let mut scaled = merged.clone();
    let mut is_yes = |factor: Option<i64>| {
        for (index, link) in merged.contingents().iter().enumerate() {
            let Some(max) = late(link) else { continue };
            let times = |factor: i64| i128::from(max.as_micros()) * i128::from(factor) / i128::from(ONE);
            scaled.link_mut(index).delay.max = match factor {
                Some(factor) => Bound::Finite(Duration::from_micros(times(factor) as i64)),
                None => Bound::Infinite,
            };
        }
        decide(&scaled)
    };
    if is_yes(None)? {
        return Ok(Some(Factor::Unlimited));
    }
    // The factor at which the longest delay is the longest of all that a model may have: that is as good as never.
    let most = i128::from(Duration::MAX.as_micros()) * i128::from(ONE) / i128::from(longest.as_micros());
    let (mut yes, mut no) = (ONE, i64::try_from(most).unwrap_or(i64::MAX).saturating_add(1));
    let mut step = ONE;
    while no - yes > 1 {
        let middle = yes + ((no - yes) / 2).min(step);
        *(if is_yes(Some(middle))? { &mut yes } else { &mut no }) = middle;
        step = step.saturating_mul(2);
    }
    Ok(Some(Factor::Millionths(yes)))
}

/// The hardest position up to which the answer is "yes" all the way from where the knob is.
pub(crate) fn hardest_yes(probe: &mut Probe<'_>, dial: &Dial) -> i64 {
    let merges = is_finite(dial.hardest) && probe.merges(dial, dial.hardest);
    if dial.hardest == dial.here || !merges && probe.is_yes(dial, dial.hardest) {
        return if dial.hardest_is_any { -INFINITE } else { dial.hardest };
    }
    // At exactly [0, 0] two events become one, which may be easier again: what lies before is asked first.
    let mut no = dial.hardest;
    if merges {
        if no + 1 >= dial.here || probe.is_yes(dial, no + 1) {
            return if probe.is_yes(dial, no) { no } else { no + 1 };
        }
        no += 1;
    }
    probe.boundary(dial, no, dial.here)
}

/// The easiest position up to which the answer is "yes".
fn easiest_yes(probe: &mut Probe<'_>, dial: &Dial) -> i64 {
    if dial.easiest == dial.here {
        return dial.here;
    }
    // What is easier is "yes", but for two events that were one, and for what late news of chains does to the reduction.
    if probe.merges(dial, dial.here) && !probe.is_yes(dial, dial.here + 1) {
        return dial.here;
    }
    if probe.is_exact() || probe.is_yes(dial, dial.easiest) {
        return if dial.easiest_is_any { INFINITE } else { dial.easiest };
    }
    probe.last_yes(dial, dial.here, dial.easiest)
}
