//! The search for the cheapest plan: branch and bound over the alternatives of the clauses, best first.
//!
//! What is known is a growing set of clauses. A node of the search has chosen an alternative of some of them, and bounds for some
//! amounts; the linear program of what it has chosen, and of the clauses without a choice, gives its cheapest plan. That is
//! rounded outward and asked about. If it is not controllable there is a clause that it violates, known or new, and the
//! node branches over its alternatives. If it is, it is a plan; and the cheapest of the node unless rounding made it
//! dearer. Then the node branches over the amount that was rounded most: no more than the value below, or no less than that
//! above (A. Land, A. Doig, 1960). The first node whose plan can be no cheaper than one that is known ends the search.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use crate::check::{Verdict, check};
use crate::model::Network;
use crate::program::{Column, Inequality, Optimized, solve};
use crate::vary::{Change, Probe, changed};

use super::clause::{Answer, Clause, Levers, ask};
use super::lever::Lever;
use super::{Allowed, Repair, Turns};

/// A linear program of so many inequalities takes about as long as a verdict.
const SMALL: usize = 32;

/// No question takes more than this part of all rounds.
const SHARES: usize = 4;

pub(super) struct Search<'a> {
    network: &'a Network,
    /// The knobs that can be turned, by number.
    knobs: Vec<Lever>,
    levers: Levers,
    /// That bounds stay in order.
    order: Vec<Clause>,
    clauses: Vec<Clause>,
    /// Plans that are known to do.
    proven: BTreeSet<Turns>,
    /// Those of them in which every amount is known to be as small as the others allow.
    settled: BTreeSet<Turns>,
    rounds: usize,
    /// So many rounds for one question, or it would use up what the others need.
    share: usize,
    gave_up: bool,
    /// True if no network is controllable in which bounds of a given one are harder.
    monotone: bool,
}

/// A part of all plans: those that keep the chosen alternatives and are within these amounts.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Node {
    /// By clause the alternative.
    chosen: BTreeMap<usize, usize>,
    low: BTreeMap<usize, i64>,
    high: BTreeMap<usize, i64>,
}

/// The cheapest amounts of a node, not rounded.
struct Relaxed {
    amounts: BTreeMap<usize, f64>,
    cost: f64,
}

/// What is known of a plan.
enum Judged {
    Controllable,
    /// A clause, by number.
    Violates(usize),
    /// It is no network, its numbers are too large, or the rounds are used up.
    Unknown,
}

impl<'a> Search<'a> {
    /// `allowed` in order.
    pub(super) fn new(network: &'a Network, allowed: &[Allowed], rounds: usize) -> Search<'a> {
        let probe = Probe::new(network);
        let knobs: Vec<Lever> =
            allowed.iter().filter_map(|allowed| Lever::new(network, &probe, allowed)).collect();
        let levers = Levers::new(network, knobs.iter().map(|lever| lever.knob.parts()));
        let order = levers.order(network);
        let clauses = order.iter().filter(|clause| clause.len() > 1).cloned().collect();
        let monotone = probe.is_exact() && !levers.part_events();
        Search {
            network,
            knobs,
            levers,
            order,
            clauses,
            proven: BTreeSet::new(),
            settled: BTreeSet::new(),
            rounds,
            share: rounds / SHARES,
            gave_up: false,
            monotone,
        }
    }

    /// Finds the conflicts that have no knob in common, one after the other, with the knobs of those before as far as they go. True
    /// if these are all.
    pub(super) fn gather(&mut self) -> bool {
        let mut plan = Turns::new();
        while let Some(changed) = self.carried_out(&plan) {
            if !self.spend(1) {
                self.gave_up = true;
                return false;
            }
            let Ok(Answer::Not(clause)) = ask(self.network, &changed, &self.levers, &plan) else { break };
            let grown = self.put_far(&mut plan, &clause);
            self.learn(clause);
            if !grown {
                break;
            }
        }
        true
    }

    /// Keeps a clause; without the alternatives that no amounts there are would keep.
    fn learn(&mut self, mut clause: Clause) {
        let most =
            |(&knob, &factor): (&usize, &i64)| i128::from(factor.max(0)) * i128::from(self.knobs[knob].room);
        clause.retain(|alternative| alternative.terms.iter().map(most).sum::<i128>() >= alternative.least);
        self.clauses.push(clause);
    }

    /// Turns the knobs of a clause as far as they go; false if they were so far.
    fn put_far(&self, plan: &mut Turns, clause: &Clause) -> bool {
        let knobs: BTreeSet<usize> = clause.iter().flat_map(|it| it.terms.keys()).copied().collect();
        let before = plan.len();
        for knob in knobs {
            let was = plan.insert(knob, self.knobs[knob].far(self.network));
            if was.is_none() && !self.in_order(plan) {
                plan.remove(&knob);
            }
        }
        plan.len() > before
    }

    /// What there is to find was not all found.
    pub(super) fn give_up(&mut self) {
        self.gave_up = true;
    }

    /// True if the rounds did not suffice for all that was asked.
    pub(super) fn gave_up(&self) -> bool {
        self.gave_up
    }

    pub(super) fn cost(&self, plan: &Turns) -> u128 {
        let cost = |(knob, amount): (&usize, &i64)| {
            u128::from(self.knobs[*knob].weight) * u128::from(amount.unsigned_abs())
        };
        plan.iter().map(cost).sum()
    }

    /// The plan of a change that is enough alone, rounded outward. `None` if that is no longer enough.
    pub(super) fn single(&mut self, change: &Change) -> Option<Turns> {
        let knob = self.knobs.iter().position(|lever| lever.knob == change.knob)?;
        let amount = self.knobs[knob].up(self.knobs[knob].amount_of(change)?)?;
        let plan = Turns::from([(knob, amount)]);
        (amount > 0 && self.prove(&plan)).then_some(plan)
    }

    /// A plan as the changes it stands for.
    pub(super) fn repair(&self, plan: &Turns) -> Repair {
        let mut changes = self.changes(plan);
        changes.sort_by(|a, b| a.knob.cmp(&b.knob));
        Repair { changes, cost: self.cost(plan) }
    }

    /// The cheapest plan that does without certain knobs, if it is cheaper than one that is known; else that one.
    pub(super) fn least(&mut self, without: &BTreeSet<usize>, known: Option<Turns>) -> Option<Turns> {
        let mut best = known;
        let reserve = self.rounds.saturating_sub(self.share);
        let mut open = BinaryHeap::from([Reverse((0_u128, 0_usize, Node::default()))]);
        let mut made = 0;
        let gave_up = std::mem::take(&mut self.gave_up);
        while let Some(Reverse((cost, _, node))) = open.pop() {
            if self.is_no_cheaper(cost as f64, best.as_ref()) {
                break;
            }
            if self.rounds <= reserve || !self.spend(1 + self.clauses.len() / SMALL) {
                self.gave_up = true;
                break;
            }
            if let Some((cost, parts)) = self.look_into(&node, without, &mut best) {
                for part in parts {
                    made += 1;
                    open.push(Reverse((cost.max(0.0) as u128, made, part)));
                }
            }
        }
        let is_least = self.monotone && !self.gave_up;
        self.gave_up |= gave_up;
        let best = best?;
        if self.settled.contains(&best) {
            return Some(best);
        }
        let best = if is_least && self.would_show(&best) { best } else { self.lowered(best) };
        if !self.prove(&best) {
            self.gave_up = true;
            return None;
        }
        self.settled.insert(best.clone());
        Some(best)
    }

    /// What a plan in this node costs at least, and the parts of it that are left to look into. A plan that is found is kept in
    /// `best` if it is cheaper.
    fn look_into(
        &mut self,
        node: &Node,
        without: &BTreeSet<usize>,
        best: &mut Option<Turns>,
    ) -> Option<(f64, Vec<Node>)> {
        let relaxed = self.relaxed(node, without)?;
        if self.is_no_cheaper(relaxed.cost, best.as_ref()) {
            return None;
        }
        let Some(plan) = self.rounded(node, &relaxed) else {
            let halves = self.split(node, &relaxed);
            self.gave_up |= halves.is_empty();
            return Some((relaxed.cost, halves));
        };
        match self.judged(&plan) {
            Judged::Unknown => {
                self.gave_up = true;
                None
            }
            Judged::Violates(clause) => Some((relaxed.cost, self.alternatives(node, clause))),
            Judged::Controllable => {
                self.keep_if_cheaper(best, plan, relaxed.cost);
                let is_best = self.is_no_cheaper(relaxed.cost, best.as_ref());
                (!is_best).then(|| (relaxed.cost, self.split(node, &relaxed)))
            }
        }
    }

    /// Keeps a plan, lowered where its node may have cheaper ones.
    fn keep_if_cheaper(&mut self, best: &mut Option<Turns>, mut plan: Turns, at_least: f64) {
        let is_cheaper = |search: &Search<'_>, plan: &Turns| {
            best.as_ref().is_none_or(|best| search.cost(plan) < search.cost(best))
        };
        let is_least = self.monotone && self.cost(&plan) as f64 <= at_least + self.rounding(&plan);
        if !is_least && is_cheaper(self, &plan) {
            plan = self.lowered(plan);
        }
        if is_cheaper(self, &plan) {
            *best = Some(plan);
        }
    }

    /// A node with each alternative of a clause that its cheapest plan violates.
    fn alternatives(&self, node: &Node, clause: usize) -> Vec<Node> {
        // That of a clause without a choice goes into every program.
        let count = self.clauses[clause].len();
        if count == 1 {
            return vec![node.clone()];
        }
        let chosen = |alternative| {
            let mut child = node.clone();
            child.chosen.insert(clause, alternative);
            child
        };
        (0..count).map(chosen).collect()
    }

    /// True if a plan with any of its amounts a step lower would cost less by more than nobody can tell.
    fn would_show(&self, plan: &Turns) -> bool {
        let rounding = self.rounding(plan);
        plan.iter().all(|(&knob, &amount)| {
            let lever = &self.knobs[knob];
            let step = amount - lever.down(amount - 1);
            step as f64 * lever.weight as f64 > 2.0 * rounding
        })
    }

    /// Some plan of at most so many knobs, for want of a cheap one: every knob that has a part in a conflict as far as it goes, then each back as far as
    /// the others allow.
    pub(super) fn any(&mut self, most: usize) -> Option<Turns> {
        const CONFLICTS: usize = 100;
        let mut plan = Turns::new();
        for _ in 0..CONFLICTS {
            if plan.len() > most {
                return None;
            }
            let changed = self.carried_out(&plan)?;
            let Answer::Not(clause) = ask(self.network, &changed, &self.levers, &plan).ok()? else { break };
            if !self.put_far(&mut plan, &clause) {
                return None;
            }
        }
        let plan = self.prove(&plan).then(|| self.lowered(plan))?;
        self.prove(&plan).then_some(plan)
    }

    /// Uses up rounds; false if there are none.
    fn spend(&mut self, rounds: usize) -> bool {
        let enough = self.rounds >= rounds;
        self.rounds = self.rounds.saturating_sub(rounds);
        enough
    }

    /// What a microsecond more of each change costs: nobody can tell.
    fn rounding(&self, plan: &Turns) -> f64 {
        let cost = self.cost(plan) as f64;
        plan.keys().map(|knob| self.knobs[*knob].weight as f64).sum::<f64>() + cost * 1e-9
    }

    fn is_no_cheaper(&self, cost: f64, best: Option<&Turns>) -> bool {
        best.is_some_and(|best| cost + self.rounding(best) >= self.cost(best) as f64)
    }

    /// The cheapest amounts of a node; `None` if there are none.
    fn relaxed(&mut self, node: &Node, without: &BTreeSet<usize>) -> Option<Relaxed> {
        let rows = self.rows(node);
        let mut columns = BTreeMap::new();
        let mentioned = rows.iter().flat_map(|row| row.terms.keys()).chain(node.low.keys());
        for &knob in mentioned.filter(|knob| !without.contains(knob)) {
            let lever = &self.knobs[knob];
            let low = node.low.get(&knob).copied().unwrap_or(0);
            let high = node.high.get(&knob).copied().unwrap_or(lever.room);
            if low > high {
                return None;
            }
            columns.insert(knob, Column { weight: lever.weight, low, high });
        }
        let possible =
            |row: &&Inequality| row.least <= 0 || row.terms.keys().any(|knob| columns.contains_key(knob));
        if !rows.iter().all(possible) {
            return None;
        }
        match solve(&columns, &rows) {
            Optimized::Optimum(amounts) => {
                let cost = amounts.iter().map(|(knob, amount)| amount * columns[knob].weight as f64).sum();
                Some(Relaxed { amounts, cost })
            }
            Optimized::Infeasible => None,
            Optimized::Failed => {
                self.gave_up = true;
                None
            }
        }
    }

    /// The inequalities of a node: what it has chosen, that of every clause without a choice, and that the bounds they
    /// speak of stay in order.
    fn rows(&self, node: &Node) -> Vec<&Inequality> {
        let alone = self.clauses.iter().filter(|clause| clause.len() == 1).map(|clause| &clause[0]);
        let chosen = node.chosen.iter().map(|(&clause, &at)| &self.clauses[clause][at]);
        let mut rows: Vec<&Inequality> = alone.chain(chosen).collect();
        let mentioned: BTreeSet<usize> =
            rows.iter().flat_map(|row| row.terms.keys()).chain(node.low.keys()).copied().collect();
        let is_mentioned = |row: &&Inequality| row.terms.keys().all(|knob| mentioned.contains(knob));
        let order = self.order.iter().filter(|clause| clause.len() == 1).map(|clause| &clause[0]);
        rows.extend(order.filter(is_mentioned));
        rows
    }

    /// The amounts rounded outward to values that are wanted, so that all inequalities of the node hold. `None` if rounding
    /// violates one that cannot be mended.
    fn rounded(&self, node: &Node, relaxed: &Relaxed) -> Option<Turns> {
        let mut plan = Turns::new();
        for (&knob, &amount) in &relaxed.amounts {
            let amount = self.knobs[knob].up(self.outward(knob, amount))?;
            if amount > 0 {
                plan.insert(knob, amount);
            }
        }
        let rows = self.rows(node);
        // What floating point has left out, by the cheapest that can make up for it.
        for _ in 0..rows.len() {
            let Some((row, lacks)) =
                rows.iter().map(|row| (row, row.lacks(&plan))).find(|(_, lacks)| *lacks > 0)
            else {
                return Some(plan);
            };
            let raised = |(&knob, &factor): (&usize, &i64)| {
                relaxed.amounts.get(&knob).filter(|_| factor > 0)?;
                let factor = i128::from(factor);
                let more = i64::try_from((lacks + factor - 1) / factor).ok()?;
                let here = plan.get(&knob).copied().unwrap_or(0);
                let raised = self.knobs[knob].up(here.checked_add(more)?)?;
                let cost = u128::from(self.knobs[knob].weight) * u128::from((raised - here).unsigned_abs());
                Some((cost, knob, raised))
            };
            let (_, knob, raised) = row.terms.iter().filter_map(raised).min()?;
            plan.insert(knob, raised);
        }
        rows.iter().all(|row| row.lacks(&plan) <= 0).then_some(plan)
    }

    /// A number of microseconds that is no less than what floating point means.
    fn outward(&self, knob: usize, amount: f64) -> i64 {
        let lever = &self.knobs[knob];
        let whole = (amount - 0.01).ceil().max(0.0) as i64;
        // A hair above a wanted value is that value.
        let below = lever.down(whole);
        if amount - (below as f64) < 0.5 { below } else { whole.min(lever.room) }
    }

    /// Two halves of a node, between which no wanted value lies: on either side of the amount whose rounding costs most.
    fn split(&self, node: &Node, relaxed: &Relaxed) -> Vec<Node> {
        let between = |(&knob, &amount): (&usize, &f64)| {
            let lever = &self.knobs[knob];
            let amount = self.outward(knob, amount);
            let (below, above) = (lever.down(amount), lever.up(amount));
            let cost = u128::from(lever.weight) * u128::from((amount - below).unsigned_abs());
            (below < amount && above != Some(amount)).then_some((cost, Reverse(knob), below, above))
        };
        let Some((_, Reverse(knob), below, above)) = relaxed.amounts.iter().filter_map(between).max() else {
            return Vec::new();
        };
        let mut lower = node.clone();
        lower.high.insert(knob, below);
        let upper = above.map(|above| {
            let mut upper = node.clone();
            upper.low.insert(knob, above);
            upper
        });
        [Some(lower), upper].into_iter().flatten().collect()
    }

    /// The verdict on a plan, if need be with a new clause that it violates.
    fn judged(&mut self, plan: &Turns) -> Judged {
        if self.proven.contains(plan) {
            return Judged::Controllable;
        }
        let violates = |clause: &Clause| clause.iter().all(|alternative| alternative.lacks(plan) > 0);
        if let Some(known) = self.clauses.iter().position(violates) {
            return Judged::Violates(known);
        }
        if !self.spend(1) {
            return Judged::Unknown;
        }
        let Some(changed) = self.carried_out(plan) else { return Judged::Unknown };
        match ask(self.network, &changed, &self.levers, plan) {
            Ok(Answer::Controllable) => {
                self.proven.insert(plan.clone());
                Judged::Controllable
            }
            Ok(Answer::Not(clause)) => {
                self.learn(clause);
                Judged::Violates(self.clauses.len() - 1)
            }
            Err(_) => Judged::Unknown,
        }
    }

    /// The plan with every amount as small as the others allow: each by halving, the dearest first.
    fn lowered(&mut self, mut plan: Turns) -> Turns {
        const PASSES: usize = 3;
        for _ in 0..PASSES {
            let before = plan.clone();
            let mut order: Vec<usize> = plan.keys().copied().collect();
            order.sort_by_key(|knob| {
                let cost = u128::from(self.knobs[*knob].weight) * u128::from(plan[knob].unsigned_abs());
                (Reverse(cost), *knob)
            });
            for knob in order {
                self.lower(&mut plan, knob);
            }
            if plan == before || self.monotone {
                break;
            }
        }
        plan
    }

    fn lower(&mut self, plan: &mut Turns, knob: usize) {
        // About so many it takes.
        const VERDICTS: usize = 4;
        self.spend(VERDICTS);
        let Some(amount) = plan.remove(&knob) else { return };
        let lever = &self.knobs[knob];
        let Some(others) = self.carried_out(plan) else {
            plan.insert(knob, amount);
            return;
        };
        let mut probe = Probe::new(&others);
        let dial = probe.dial(&lever.knob);
        if probe.is_yes(&dial, dial.here) {
            return;
        }
        let below = lever.down(amount - 1);
        if below == 0 || !probe.is_yes(&dial, lever.position(below)) {
            plan.insert(knob, amount);
            return;
        }
        let least = lever.amount(probe.boundary(&dial, dial.here, lever.position(below)));
        let least = lever.up(least).filter(|least| *least <= below).unwrap_or(below);
        let enough = probe.is_yes(&dial, lever.position(least));
        plan.insert(knob, if enough { least } else { below });
    }

    /// True if the network is controllable with a plan carried out, by a check of its own.
    fn prove(&mut self, plan: &Turns) -> bool {
        let Some(changed) = self.carried_out(plan) else { return false };
        let proven = matches!(check(&changed), Ok(Verdict::Controllable));
        if proven {
            self.proven.insert(plan.clone());
        }
        proven
    }

    /// The network with a plan carried out; `None` if that is none.
    fn carried_out(&self, plan: &Turns) -> Option<Network> {
        self.in_order(plan).then(|| changed(self.network, &self.changes(plan)))?
    }

    /// True if with a plan carried out bounds are in order.
    fn in_order(&self, plan: &Turns) -> bool {
        self.order.iter().all(|clause| clause.iter().any(|it| it.lacks(plan) <= 0))
    }

    fn changes(&self, plan: &Turns) -> Vec<Change> {
        plan.iter().map(|(&knob, &amount)| self.knobs[knob].change(amount)).collect()
    }
}
