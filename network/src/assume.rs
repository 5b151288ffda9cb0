//! What if: the same network under another assumption about the delays of its news.
//!
//! Strong, dynamic and fixed-delay controllability are cases of variable-delay controllability (thesis, sections 4.2
//! and 4.5): no delay, no news at all, a delay that is known. So each of them is this network with other delays, and
//! [`check`](fn@crate::check) decides it. Only the elongated links of the thesis' table 4.3 are another network.

mod elongate;

use crate::check::{Verdict, check, conflict};
use crate::merge::merge;
use crate::model::{ContingentLink, Delay, Network};
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};

/// Decides a network under an assumption about its delays.
///
/// ```
/// use kirk_network::assume::{Assumption, check_assuming};
/// use kirk_network::{Verdict, json};
///
/// // C must come within 3 s of B, whose news is up to 5 s late.
/// let network = json::read(r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
///     "requirements": [{"from": "b", "to": "c", "lower": 0, "upper": 3}],
///     "contingents": [{"from": "a", "to": "b", "lower": 10, "upper": 20, "delay": [0, 5]}]}"#).unwrap();
/// let yes = |assumption| check_assuming(&network, assumption).unwrap().verdict == Verdict::Controllable;
/// assert!(!yes(Assumption::AsWritten));
/// assert!(yes(Assumption::Mean));
/// assert!(!yes(Assumption::Never));
/// ```
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn check_assuming(network: &Network, assumption: Assumption) -> Result<Assumed, TooLarge> {
    if assumption != Assumption::Elongated {
        let network = with_delays(network, assumption);
        return Ok(Assumed { verdict: check(&network)?, network });
    }
    let merged = merge(network);
    let elongated = elongate::elongate(&merged.network)?;
    let verdict = match conflict(&elongated.network)? {
        None => Verdict::Controllable,
        Some(found) => {
            Verdict::Uncontrollable(merged.unmerge(&elongated.conflict(&merged.network, &found), network))
        }
    };
    Ok(Assumed { verdict, network: network.clone() })
}

/// The network that stands for `network` under an assumption. The elongated one is merged, and its requirements are
/// one-sided; the others differ in their delays only.
///
/// # Errors
/// [`TooLarge`] if elongated durations add up to more than 64-bit microseconds can hold.
pub fn assume(network: &Network, assumption: Assumption) -> Result<Network, TooLarge> {
    match assumption {
        Assumption::Elongated => Ok(elongate::elongate(&merge(network).network)?.network),
        _ => Ok(with_delays(network, assumption)),
    }
}

/// What is assumed about the delays of news. [`Delay`] `[g-, g+]`; a `g+` that is infinite stays so, except in `Zero`
/// and `Minimum`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Assumption {
    /// The delays of the network: variable-delay controllability.
    #[default]
    AsWritten,
    /// All is known at once: dynamic controllability.
    Zero,
    /// News is always `g-` late, and we know it: fixed-delay controllability.
    Minimum,
    /// News is always `(g- + g+) / 2` late; half a microsecond is rounded up, to the later news.
    Mean,
    /// News is always `g+` late.
    Maximum,
    /// There is no news: strong controllability.
    Never,
    /// Duration and delay are one uncertainty: all we know of `[l, u]` is that the news comes in `[l + g-, u + g+]`, and
    /// of the event that it was between `g+` and `g-` before its news.
    ///
    /// Requirements are about the event, not its news. They must hold wherever in `[news - g+, news - g-]` it was,
    /// even where that is outside of `[l, u]`. Such a network is harder than the one as written, never easier (were
    /// requirements simply moved to the news, "within 3 s of the event" would become "within 3 s of the news", and
    /// that can be easier). A requirement that only Nature has a say in is judged as written. An event whose news may
    /// never come has nothing to be combined with, and stays as it is.
    Elongated,
}

/// The verdict under an assumption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumed {
    /// Its conflict has the indices of the network given.
    pub verdict: Verdict,
    /// The network the conflict speaks of: the one given, with the delays that were assumed.
    pub network: Network,
}

/// The same network with other delays; `Elongated` changes none.
fn with_delays(network: &Network, assumption: Assumption) -> Network {
    let links = network.contingents().iter().map(|link| {
        let delay = assumed(link.delay, assumption);
        ContingentLink { delay, ..*link }
    });
    let others = network.with(network.requirements().to_vec(), links.collect());
    others.unwrap_or_else(|errors| unreachable!("a valid network with other delays is valid: {errors:?}"))
}

fn assumed(delay: Delay, assumption: Assumption) -> Delay {
    let fixed = |bound: Bound| match bound {
        Bound::Finite(at) => Delay { min: at, max: bound },
        Bound::Infinite => Delay { min: delay.min, max: bound },
    };
    match assumption {
        Assumption::AsWritten | Assumption::Elongated => delay,
        Assumption::Zero => Delay::NONE,
        Assumption::Minimum => fixed(Bound::Finite(delay.min)),
        Assumption::Mean => fixed(delay.max.finite().map_or(Bound::Infinite, |max| {
            let (min, max) = (delay.min.as_micros(), max.as_micros());
            Bound::Finite(Duration::from_micros(max - (max - min) / 2))
        })),
        Assumption::Maximum => fixed(delay.max),
        Assumption::Never => fixed(Bound::Infinite),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conflict::Part;
    use crate::json;

    fn micros(min: i64, max: i64) -> Delay {
        Delay { min: Duration::from_micros(min), max: Duration::from_micros(max).into() }
    }

    #[test]
    fn a_fixed_delay_is_one_number_and_infinite_stays_never() {
        assert_eq!(assumed(micros(3, 8), Assumption::Minimum), micros(3, 3));
        assert_eq!(assumed(micros(3, 8), Assumption::Mean), micros(6, 6));
        assert_eq!(assumed(micros(4, 8), Assumption::Mean), micros(6, 6));
        assert_eq!(assumed(micros(3, 8), Assumption::Maximum), micros(8, 8));
        assert_eq!(assumed(micros(3, 8), Assumption::Zero), Delay::NONE);
        assert_eq!(assumed(micros(3, 8), Assumption::Never).max, Bound::Infinite);
        let perhaps = Delay { max: Bound::Infinite, ..micros(3, 8) };
        assert_eq!(assumed(perhaps, Assumption::Minimum), micros(3, 3));
        for assumption in [Assumption::Mean, Assumption::Maximum, Assumption::Never, Assumption::AsWritten] {
            assert_eq!(assumed(perhaps, assumption), perhaps);
        }
    }

    /// A -[l, u]-> B with a delay, then C in an interval after B, all within a limit.
    fn chain(link: (i64, i64), delay: (i64, i64), after: (i64, i64), limit: i64) -> Network {
        let ((l, u), (min, max), (from, to)) = (link, delay, after);
        json::read(&format!(
            r#"{{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
            "requirements": [{{"from": "b", "to": "c", "lower": {from}, "upper": {to}}},
                             {{"from": "a", "to": "c", "lower": 0, "upper": {limit}}}],
            "contingents": [{{"from": "a", "to": "b", "lower": {l}, "upper": {u}, "delay": [{min}, {max}]}}]}}"#
        ))
        .unwrap()
    }

    fn yes(network: &Network, assumption: Assumption) -> bool {
        check_assuming(network, assumption).unwrap().verdict == Verdict::Controllable
    }

    #[test]
    fn elongated_knows_less_than_as_written_and_never_more() {
        // C can follow at the news; B was at most 5 s before. With 4 s allowed that is too late.
        assert!(yes(&chain((5, 20), (0, 5), (0, 10), 30), Assumption::Elongated));
        assert!(!yes(&chain((5, 20), (0, 5), (0, 4), 100), Assumption::Elongated));
        // As written C comes at 25 at the latest (the latest B, 5 s after); elongated there is news as late as that,
        // and C must follow a B that might have been then.
        let network = chain((5, 20), (0, 5), (5, 10), 25);
        assert!(yes(&network, Assumption::AsWritten));
        assert!(!yes(&network, Assumption::Elongated));
        assert!(yes(&chain((5, 20), (0, 5), (5, 10), 30), Assumption::Elongated));
        // A delay that is known leaves nothing to be combined.
        assert!(yes(&chain((5, 20), (5, 5), (0, 5), 25), Assumption::Elongated));
        assert!(!yes(&chain((5, 20), (5, 5), (0, 4), 25), Assumption::Elongated));
    }

    #[test]
    fn the_conflict_of_elongated_links_adds_up_in_what_was_written() {
        let network = chain((5, 20), (0, 5), (5, 10), 25);
        let assumed = check_assuming(&network, Assumption::Elongated).unwrap();
        let Verdict::Uncontrollable(conflict) = assumed.verdict else { panic!("controllable") };
        let members: Vec<(Part, i64)> =
            conflict.members.iter().map(|share| (share.part, share.amount.as_micros() / 1_000_000)).collect();
        // 25 (the limit) - 5 (C after B) - 20 (B) - 5 (its news).
        let expected =
            [(Part::RequirementUpper(1), 25), (Part::RequirementLower(0), -5), (Part::LinkUpper(0), -20)];
        assert_eq!(members, [&expected[..], &[(Part::DelayMax(0), -5)]].concat());
        assert_eq!(conflict.total, Duration::from_secs(-5));
        assert_eq!(assumed.network, network);
    }

    #[test]
    fn what_only_nature_has_a_say_in_is_judged_as_written() {
        let text = |upper: i64| {
            format!(
                r#"{{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
                "requirements": [{{"from": "a", "to": "b", "lower": 5, "upper": {upper}}}],
                "contingents": [{{"from": "a", "to": "b", "lower": 5, "upper": 20, "delay": [0, 5]}},
                                {{"from": "b", "to": "c", "lower": 1, "upper": 2, "delay": [0, 9]}}]}}"#
            )
        };
        assert!(yes(&json::read(&text(20)).unwrap(), Assumption::Elongated));
        assert!(!yes(&json::read(&text(19)).unwrap(), Assumption::Elongated));
    }
}
