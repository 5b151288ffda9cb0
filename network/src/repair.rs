//! What would make a network controllable: proven changes of one bound or several, the least first.
//!
//! After P. Yu and B. Williams, *Continuously relaxing over-constrained conditional temporal problems*, IJCAI 2013; P. Yu,
//! C. Fang, B. Williams, *Resolving uncontrollable conditional temporal problems using continuous relaxations*, ICAPS 2014;
//! J. Cui and others, *Optimising bounds in simple temporal networks with uncertainty under dynamic controllability
//! constraints*, ICAPS 2015; N. Bhargava, T. Vaquero, B. Williams, *Faster conflict generation for dynamic controllability*,
//! IJCAI 2017.
//!
//! A conflict says what must hold of the changes for it to be settled: one of a few linear inequalities (`clause`). The least
//! changes that keep all that is known so far come from a linear program (`program`); the network is changed so and asked
//! again; the answer is the next conflict, or "yes" (`search`). Other repairs come of forbidding a bound of one that was found
//! (K. Murty, 1968; E. Lawler, 1972).

mod clause;
mod lever;
mod search;

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use crate::conflict::{Conflict, Part};
use crate::conflicts::conflicts;
use crate::least::{could_settle, least_changes};
use crate::model::Network;
use crate::slack::bounds;
use crate::stnu::TooLarge;
use crate::time::{Bound, Duration};
use crate::vary::{Change, Knob};

use search::Search;

/// What changing a bound by its own size costs, as [`Allowed::relative`] has it.
pub const ONE: u128 = 1_000_000_000_000_000_000;

/// A knob that may be turned, towards what is easier.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Allowed {
    /// What may be turned, up to its limit if it has one.
    pub knob: Knob,
    /// What a microsecond costs. Nothing is for free: 0 counts as 1.
    pub weight: u64,
    /// Values are whole multiples of this where that is within the limit. Nothing counts as a microsecond.
    pub unit: Duration,
}

impl Allowed {
    /// With the cost of a relative change: [`ONE`] for a change by the size of the bound itself, or of a unit if that is
    /// more. The size of a delay without end is that of the longest one that would still be of some use.
    pub fn relative(network: &Network, knob: Knob, unit: Duration) -> Allowed {
        let value = match knob.value(network) {
            Bound::Finite(value) => value.as_micros().saturating_abs(),
            Bound::Infinite => lever::longest_useful(network, &knob),
        };
        let size = value.max(unit.as_micros()).max(1);
        Allowed { knob, weight: ONE as u64 / size as u64, unit }
    }
}

/// From so many conflicts on that have no bound of ours in common, all of them are looked for first.
const MANY: usize = 8;

/// Other plans than one of more changes than this are not looked for.
const MOST_CHANGES: usize = 50;

/// How much to look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// So many repairs at most.
    pub limit: usize,
    /// So many linear programs and verdicts at most in the search for joint changes, large programs counting for more.
    pub rounds: usize,
    /// So many knobs at most are tried alone; and for want of a cheap repair one of at most so many changes is looked for.
    pub patience: usize,
}

impl Default for Options {
    fn default() -> Options {
        Options { limit: 5, rounds: 1000, patience: 1000 }
    }
}

/// Changes with which the network is controllable, and without any one of them is not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repair {
    /// In the order of their knobs. No bound is in two of them.
    pub changes: Vec<Change>,
    /// What they cost: for each its amount in microseconds times its weight. A delay that had no end counts from the longest
    /// one that would be of any use.
    pub cost: u128,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repairs {
    /// By cost, then by number of changes, then by order of the knobs. No two turn the same knobs.
    pub repairs: Vec<Repair>,
    /// The knobs that cannot settle it alone, in order.
    pub not_alone: Vec<Knob>,
    /// Whether there could be more, or better ones.
    pub extent: Extent,
}

/// Why the search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// There is nothing cheaper, or there are as many as were asked for.
    Complete,
    /// The rounds were used up.
    OutOfRounds,
}

/// The cheapest repairs; `None` if the network is controllable as it is.
///
/// Each is proven: with its changes [`check`](crate::check::check) says "yes", and with any one of them less by a unit (by a microsecond, where it
/// is between the last whole unit and its limit; left out, where that is all there is) it says "no". The first is the cheapest of
/// all of whole units, if the search ended [`Extent::Complete`], no chain has late news, and no requirement that may change
/// makes an event one with something heard late. In a chain with late news the lengths of the reduction may switch at any change, and what a conflict
/// says about other values is a guess; the repair is proven and no change in it can be less, but another may be cheaper.
///
/// The second differs from the first in that it does without one of its knobs, and so on: a repair that only adds a knob to
/// those of a cheaper one is not looked for. A change of one knob that is enough alone is always looked for, if there is the patience.
///
/// Of knobs with a bound in common, the first, in their own order, is used where several change; the others alone. The order
/// of `allowed` is of no importance.
///
/// ```
/// use kirk_network::repair::{Allowed, Options, ours, repairs};
/// use kirk_network::{Duration, json};
///
/// // Steps of 40 s and 30 s are to take no more than 55 s, and the second no more than 20 s.
/// let network = json::read(r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
///     "requirements": [{"from": "a", "to": "b", "lower": 40}, {"from": "b", "to": "c", "lower": 30},
///                      {"from": "b", "to": "c", "upper": 20}, {"from": "a", "to": "c", "upper": 55}]}"#).unwrap();
/// let second = Duration::from_secs(1);
/// let allowed: Vec<_> = ours(&network).into_iter().map(|knob| Allowed::relative(&network, knob, second)).collect();
/// let found = repairs(&network, &allowed, &Options::default()).unwrap().unwrap();
/// let shown = |repair: usize| -> Vec<String> {
///     let changes = found.repairs[repair].changes.iter();
///     changes.map(|it| format!("{} -> {}", it.from.finite().unwrap(), it.to.finite().unwrap())).collect()
/// };
/// assert_eq!(shown(0), ["55 -> 60", "30 -> 20"]);
/// assert_eq!(shown(1), ["40 -> 35", "30 -> 20"]);
/// assert_eq!(shown(2), ["30 -> 15"]);
/// ```
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn repairs(
    network: &Network,
    allowed: &[Allowed],
    options: &Options,
) -> Result<Option<Repairs>, TooLarge> {
    let independent = conflicts(network, MANY)?;
    if independent.is_empty() {
        return Ok(None);
    }
    let mut allowed = allowed.to_vec();
    allowed.sort();
    allowed.dedup_by(|a, b| a.knob == b.knob);
    let (mut touching, mut not_alone) = with_a_part_in_all(network, &allowed, &independent);
    let mut search = Search::new(network, &allowed, options.rounds);
    if touching.len() > options.patience {
        touching.truncate(options.patience);
        search.give_up();
    }
    let least = least_changes(network, &touching)?;
    let mut singles: BTreeMap<Knob, Turns> = BTreeMap::new();
    for (knob, change) in touching.into_iter().zip(least) {
        match change.and_then(|change| search.single(&change)) {
            Some(plan) => _ = singles.insert(knob, plan),
            None => not_alone.push(knob),
        }
    }
    // Of many it takes at least so many changes, and it would take as many programs to come upon them one by one.
    let is_hopeful = independent.len() < MANY || search.gather();
    let mut plans = Vec::new();
    if is_hopeful {
        plans = cheapest(&mut search, singles.into_values().collect(), options.limit);
    }
    if plans.is_empty() && search.gave_up() {
        plans.extend(search.any(options.patience));
    }
    plans.truncate(options.limit);
    let repairs: Vec<Repair> = plans.iter().map(|plan| search.repair(plan)).collect();
    // Where the reduction is too careful at the far end of a knob, there may yet be a value that is enough.
    let is_enough =
        |knob: &Knob| repairs.iter().any(|it| it.changes.len() == 1 && it.changes[0].knob == *knob);
    not_alone.retain(|knob| !is_enough(knob));
    not_alone.sort();
    let extent = if search.gave_up() { Extent::OutOfRounds } else { Extent::Complete };
    Ok(Some(Repairs { repairs, not_alone, extent }))
}

/// The knobs that have a part in every conflict, and those that cannot settle all of them alone.
fn with_a_part_in_all(
    network: &Network,
    allowed: &[Allowed],
    conflicts: &[Conflict],
) -> (Vec<Knob>, Vec<Knob>) {
    let settle =
        |conflict: &Conflict| -> BTreeSet<Part> { could_settle(network, conflict).into_iter().collect() };
    let settle: Vec<BTreeSet<Part>> = conflicts.iter().map(settle).collect();
    let has_a_part = |knob: &Knob| {
        settle.iter().all(|could_settle| knob.parts().iter().any(|part| could_settle.contains(part)))
    };
    allowed.iter().map(|it| it.knob.clone()).partition(has_a_part)
}

/// By how much each knob is turned, by its number, in microseconds: those that are turned at all.
type Turns = BTreeMap<usize, i64>;

/// The knobs of a plan.
fn knobs(plan: &Turns) -> Vec<usize> {
    plan.keys().copied().collect()
}

/// Plans of different knobs in the order of their costs, with those that are known.
///
/// What is best without certain knobs costs no less than what is best with them. So the cheapest without knobs of the one
/// before is next, whichever of them it does without.
fn cheapest(search: &mut Search<'_>, known: Vec<Turns>, limit: usize) -> Vec<Turns> {
    let mut plans: BTreeMap<Vec<usize>, Turns> = known.into_iter().map(|plan| (knobs(&plan), plan)).collect();
    let mut taken: BTreeSet<Vec<usize>> = BTreeSet::new();
    let mut seen: BTreeSet<BTreeSet<usize>> = BTreeSet::new();
    let mut open = BinaryHeap::from([Reverse((0_u128, BTreeSet::new(), None::<Turns>))]);
    while taken.len() < limit
        && let Some(Reverse((_, without, plan))) = open.pop()
    {
        let Some(plan) = plan else {
            let is_free = |plan: &&Turns| plan.keys().all(|knob| !without.contains(knob));
            let best = plans.values().filter(is_free).min_by_key(|plan| (search.cost(plan), plan.len()));
            if let Some(plan) = search.least(&without, best.cloned()) {
                plans.insert(knobs(&plan), plan.clone());
                open.push(Reverse((search.cost(&plan), without, Some(plan))));
            }
            continue;
        };
        taken.insert(knobs(&plan));
        // One change less of very many leaves it what it is.
        if plan.len() > MOST_CHANGES && taken.len() < limit {
            search.give_up();
            break;
        }
        for &knob in plan.keys() {
            let mut without = without.clone();
            without.insert(knob);
            if seen.insert(without.clone()) {
                open.push(Reverse((search.cost(&plan), without, None)));
            }
        }
    }
    let mut plans: Vec<Turns> = plans.into_values().collect();
    plans.sort_by_cached_key(|plan| (search.cost(plan), plan.len(), knobs(plan)));
    plans
}

/// The bounds that are ours, none of which is to lose its sense: those of requirements, and by when news must be here.
pub fn ours(network: &Network) -> Vec<Knob> {
    let is_ours = |knob: &Knob| match knob.parts()[0] {
        Part::RequirementLower(_) | Part::RequirementUpper(_) => true,
        Part::DelayMax(_) => knob.value(network) != Bound::ZERO,
        _ => false,
    };
    bounds(network).into_iter().filter(is_ours).map(|knob| knob.in_its_sense(network)).collect()
}
