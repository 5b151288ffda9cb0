//! What the conflicts of views say of promises: linear inequalities, and numbers that keep them all.
//!
//! Most inequalities compare two ends of promises, or one with a number; then the least numbers that keep all of them are longest
//! paths (R. Bellman, 1958; L. Ford, 1956), exact, and if there are none a circle says why. For the rest there is the linear program
//! of least total width.

use std::collections::BTreeMap;

use kirk_network::Conflict;
use kirk_network::program::{Column, Inequality, Optimized, solve};

use crate::model::AgentId;
use crate::promise::Promise;
use crate::views::{Numbered, term};

/// `sum of factor * end + constant >= 0`, over ends of promises.
#[derive(Clone, Debug)]
pub(crate) struct Cut {
    pub(crate) terms: Vec<(usize, i64)>,
    pub(crate) constant: i64,
    pub(crate) blame: Blame,
}

/// Why a cut is to be kept.
#[derive(Clone, Debug)]
pub(crate) enum Blame {
    /// Promises are in order.
    Order,
    /// So long the event of a promise (by number) comes after its base by the requirements alone.
    Window(usize),
    /// It is the conflict of the view of an agent.
    View(AgentId, Conflict),
}

/// Numbers, or cuts (by number) that no numbers keep, without any of which there are some.
pub(crate) enum Solved {
    Ends(Vec<i64>),
    /// With how many times each has to be taken for all ends to cancel, or to be left over where they cannot help; no numbers if that
    /// is not known.
    Core(Vec<(usize, i64)>),
    /// Floating point has lost its way.
    Lost,
}

impl Cut {
    /// What a conflict of a view says.
    pub(crate) fn new(view: &Numbered, agent: AgentId, conflict: Conflict, promises: &[Promise]) -> Cut {
        let mut factors: BTreeMap<usize, i64> = BTreeMap::new();
        let mut constant = conflict.total.as_micros();
        for share in &conflict.members {
            if let Some((end, sign)) = term(view, share.part) {
                let factor = sign * i64::from(share.times);
                *factors.entry(end.index()).or_default() += factor;
                constant = constant.saturating_sub(factor.saturating_mul(end.of(promises)));
            }
        }
        factors.retain(|_, factor| *factor != 0);
        Cut { terms: factors.into_iter().collect(), constant, blame: Blame::View(agent, conflict) }
    }

    /// That the ends of a promise are in order.
    pub(crate) fn order(low: usize, high: usize) -> Cut {
        Cut { terms: vec![(low, -1), (high, 1)], constant: 0, blame: Blame::Order }
    }

    /// That one end is no less than a number.
    pub(crate) fn at_least(end: usize, number: i64) -> Cut {
        Cut { terms: vec![(end, 1)], constant: -number, blame: Blame::Window(end / 2) }
    }

    /// That one end is no more than a number.
    pub(crate) fn at_most(end: usize, number: i64) -> Cut {
        Cut { terms: vec![(end, -1)], constant: number, blame: Blame::Order }
    }

    /// What is left over; negative if it is violated.
    pub(crate) fn spare(&self, ends: &[i64]) -> i128 {
        let sum = |&(end, factor): &(usize, i64)| i128::from(factor) * i128::from(ends[end]);
        self.terms.iter().map(sum).sum::<i128>() + i128::from(self.constant)
    }

    /// What it says if it compares two ends, or one with a number.
    fn difference(&self) -> Option<Difference> {
        let (more, less, times) = match self.terms[..] {
            [] => (None, None, 1),
            [(end, times)] if times > 0 => (Some(end), None, times),
            [(end, times)] => (None, Some(end), -times),
            [(more, times), (less, other)] if times > 0 && times == -other => (Some(more), Some(less), times),
            [(less, other), (more, times)] if times > 0 && times == -other => (Some(more), Some(less), times),
            _ => return None,
        };
        // What is more than a number of microseconds is at least the next one.
        Some(Difference { more, less, by: -self.constant.div_euclid(times), times })
    }
}

/// One end is no less than another by so much; no end is 0.
struct Difference {
    more: Option<usize>,
    less: Option<usize>,
    by: i64,
    /// How many times the cut says so.
    times: i64,
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Numbers for `count` ends, each 0 or more, that keep all cuts.
pub(crate) fn solve_cuts(count: usize, cuts: &[Cut], goal: Goal) -> Solved {
    let differences: Option<Vec<Difference>> = cuts.iter().map(Cut::difference).collect();
    match (differences, goal) {
        (Some(differences), _) => least(count, &differences),
        (None, goal) => program(count, cuts, goal),
    }
}

/// Of what to have little where a choice is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Goal {
    /// Of width.
    Narrow,
    /// Of what comes before a promise begins.
    Early,
}

/// The least numbers, by longest paths from 0.
fn least(count: usize, rows: &[Difference]) -> Solved {
    // The node after all ends is 0, which no end is below.
    let zero = count;
    let node = |end: Option<usize>| end.unwrap_or(zero);
    let mut value = vec![0_i64; count + 1];
    let mut raised_by = vec![None; count + 1];
    for round in 0..=count + 1 {
        let mut raised = None;
        for (number, row) in rows.iter().enumerate() {
            let (more, less) = (node(row.more), node(row.less));
            let wanted = value[less].saturating_add(row.by);
            if wanted > value[more] {
                raised_by[more] = Some(number);
                value[more] = wanted;
                raised = Some(more);
                // 0 cannot be raised.
                if more == zero {
                    break;
                }
            }
        }
        let Some(last) = raised else {
            value.truncate(count);
            return Solved::Ends(value);
        };
        if last == zero || round > count {
            let core = circle(last, &raised_by, |row| node(rows[row].less));
            let common = core.iter().fold(1, |common, &row| lcm(common, rows[row].times));
            return Solved::Core(core.into_iter().map(|row| (row, common / rows[row].times)).collect());
        }
    }
    unreachable!("longer ways than there are nodes lead in a circle")
}

fn lcm(a: i64, b: i64) -> i64 {
    (a / gcd(a.unsigned_abs(), b.unsigned_abs()) as i64).saturating_mul(b)
}

/// The rows that raised one another in a circle, or from an end at its least on.
fn circle(start: usize, raised_by: &[Option<usize>], from: impl Fn(usize) -> usize) -> Vec<usize> {
    let mut place = vec![None; raised_by.len()];
    let mut walk = Vec::new();
    let mut at = start;
    while let Some(row) = raised_by[at] {
        if let Some(begin) = place[at] {
            return walk.split_off(begin);
        }
        place[at] = Some(walk.len());
        walk.push(row);
        at = from(row);
    }
    walk
}

/// What there is to be little of costs so many times as much as the rest.
const MORE: u64 = 1000;

/// The linear program, rounded to microseconds.
fn program(count: usize, cuts: &[Cut], goal: Goal) -> Solved {
    let all: Vec<usize> = (0..cuts.len()).collect();
    match relaxed(count, cuts, &all, goal) {
        Optimized::Optimum(amounts) => rounded(count, cuts, &amounts).map_or(Solved::Lost, Solved::Ends),
        Optimized::Infeasible => Solved::Core(times_of(cuts, irreducible(count, cuts, all))),
        Optimized::Failed => Solved::Lost,
    }
}

/// By amounts: a promise is its beginning and its width.
fn relaxed(count: usize, cuts: &[Cut], rows: &[usize], goal: Goal) -> Optimized {
    let most = kirk_network::Duration::MAX.as_micros();
    let column = |end: usize| {
        let matters = (end % 2 == 1) == (goal == Goal::Narrow);
        // That ends are in order is said by cuts, so that a core has all there is to it.
        (end, Column { weight: if matters { MORE } else { 1 }, low: -most, high: most })
    };
    let columns: BTreeMap<usize, Column> = (0..count).map(column).collect();
    let rows: Vec<Inequality> = rows.iter().map(|&row| inequality(&cuts[row])).collect();
    // What mentions no promise holds or does not, whatever the promises.
    if rows.iter().any(|row| row.terms.is_empty() && row.least > 0) {
        return Optimized::Infeasible;
    }
    let rows: Vec<&Inequality> = rows.iter().filter(|row| !row.terms.is_empty()).collect();
    solve(&columns, &rows)
}

fn inequality(cut: &Cut) -> Inequality {
    let mut terms = BTreeMap::new();
    for &(end, factor) in &cut.terms {
        *terms.entry(end & !1).or_default() += factor;
        if end % 2 == 1 {
            *terms.entry(end).or_default() += factor;
        }
    }
    terms.retain(|_, factor: &mut i64| *factor != 0);
    Inequality { terms, least: -i128::from(cut.constant) }
}

/// Whole microseconds near the amounts that keep all cuts.
fn rounded(count: usize, cuts: &[Cut], amounts: &BTreeMap<usize, f64>) -> Option<Vec<i64>> {
    let mut ends = vec![0_i64; count];
    for promise in (0..count).step_by(2) {
        let amount = |end: usize| amounts.get(&end).map_or(0, |amount| amount.round() as i64);
        ends[promise] = amount(promise);
        ends[promise + 1] = amount(promise) + amount(promise + 1);
    }
    // What floating point has left out, by whatever end makes up for it.
    for _ in 0..=cuts.len() {
        let Some(cut) = cuts.iter().find(|cut| cut.spare(&ends) < 0) else { return Some(ends) };
        let lacks = i64::try_from(-cut.spare(&ends)).ok()?;
        let &(end, factor) = cut.terms.iter().max_by_key(|(_, factor)| *factor).filter(|it| it.1 > 0)?;
        ends[end] = ends[end].checked_add((lacks + factor - 1) / factor)?;
    }
    None
}

/// Takes out cuts one by one as long as the rest cannot be kept (J. W. Chinneck, E. W. Dravnieks, 1991).
fn irreducible(count: usize, cuts: &[Cut], mut core: Vec<usize>) -> Vec<usize> {
    for at in (0..core.len()).rev() {
        let taken = core.remove(at);
        if !matches!(relaxed(count, cuts, &core, Goal::Narrow), Optimized::Infeasible) {
            core.insert(at, taken);
        }
    }
    core
}

/// How many times each cut of an irreducible core has to be taken for all ends to cancel (J. Farkas, 1902): the one solution of as
/// many equations, by elimination in whole numbers. All 0 if it is not to be had.
fn times_of(cuts: &[Cut], core: Vec<usize>) -> Vec<(usize, i64)> {
    let times = null_vector(cuts, &core).unwrap_or_else(|| vec![0; core.len()]);
    core.into_iter().zip(times).collect()
}

fn null_vector(cuts: &[Cut], core: &[usize]) -> Option<Vec<i64>> {
    let mut rows: BTreeMap<usize, Vec<i128>> = BTreeMap::new();
    for (column, &cut) in core.iter().enumerate() {
        for &(end, factor) in &cuts[cut].terms {
            rows.entry(end).or_insert_with(|| vec![0; core.len()])[column] += i128::from(factor);
        }
    }
    let mut open: Vec<Vec<i128>> = rows.into_values().collect();
    let mut solved: Vec<(usize, Vec<i128>)> = Vec::new();
    while let Some(row) = open.pop() {
        let Some(pivot) = row.iter().position(|&factor| factor != 0) else { continue };
        for other in open.iter_mut().chain(solved.iter_mut().map(|(_, other)| other)) {
            eliminate(other, &row, pivot)?;
        }
        solved.push((pivot, row));
    }
    let is_free = |column: &usize| solved.iter().all(|(pivot, _)| pivot != column);
    let free: Vec<usize> = (0..core.len()).filter(is_free).collect();
    let [free] = free[..] else { return None };
    let common = solved
        .iter()
        .try_fold(1_i64, |common, (pivot, row)| Some(lcm(common, i64::try_from(row[*pivot]).ok()?.abs())))?;
    let mut times = vec![0; core.len()];
    times[free] = common;
    for (pivot, row) in &solved {
        times[*pivot] = i64::try_from(-row[free] * i128::from(common) / row[*pivot]).ok()?;
    }
    times.iter().all(|&times| times > 0).then_some(times)
}

/// Takes a row from another as often as makes a column 0.
fn eliminate(other: &mut [i128], row: &[i128], pivot: usize) -> Option<()> {
    let (own, by) = (other[pivot], row[pivot]);
    if own == 0 {
        return Some(());
    }
    let mut common = 0;
    for (other, &row) in other.iter_mut().zip(row) {
        *other = other.checked_mul(by)?.checked_sub(row.checked_mul(own)?)?;
        common = gcd(common, u64::try_from(other.unsigned_abs()).ok()?);
    }
    other.iter_mut().filter(|_| common > 1).for_each(|factor| *factor /= i128::from(common));
    Some(())
}
