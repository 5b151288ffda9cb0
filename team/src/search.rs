//! The search for promises: what each is measured from, who keeps what, and the numbers.
//!
//! The numbers of one choice are found by rounds: check all views; every conflict is a cut; the numbers that keep all cuts are next.
//! If there are none, an irreducible core of the cuts says which promises cannot do: for one of them another base, or for one of the
//! pairs another keeper, is the next choice, fewest changes first.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use kirk_network::check::any_conflict;
use kirk_network::merge::merge;
use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Conflict, Duration, EventId};

use crate::cuts::{Blame, Cut, Goal, Solved, solve_cuts};
use crate::distances::{Around, Distances, FAR, Step};
use crate::find::{Agreement, Options, View};
use crate::model::Team;
use crate::promise::{Promise, Term};
use crate::views::{Choice, Numbered, Outline, Pair, Plan, Reserve, news, pairs, plan};
use crate::whole::Whole;

/// With more choices times events times events than this nobody would wait for the answer.
const WORK: usize = 600_000;
/// So many bases are tried for one event.
const BASES: usize = 4;

pub(crate) struct Finder<'a> {
    pub(crate) team: &'a Team,
    pub(crate) whole: &'a Whole,
    pub(crate) options: &'a Options,
    pub(crate) pairs: Vec<Pair>,
    distances: Option<Distances>,
    /// By event, once it was asked for.
    around: Vec<Option<Around>>,
}

/// What came of the search.
pub(crate) enum Attempt {
    /// One or two, to choose from.
    Found(Vec<Found>),
    Failed(Failure),
}

/// Promises with numbers, and the views they are for.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    plan: Plan,
    pub(crate) promises: Vec<Promise>,
}

/// Cuts that no numbers keep, the first that were met.
#[derive(Debug, Default)]
pub(crate) struct Failure {
    /// Each with how many times it has to be taken for the promises to cancel.
    pub(crate) core: Vec<(Cut, i64)>,
    /// By number of the promise: the event and its base.
    pub(crate) promises: Vec<(EventId, EventId)>,
    /// The views the cuts are of, by agent.
    pub(crate) views: Vec<Numbered>,
}

/// What came of one choice.
enum Tried {
    Found(Found),
    Core(Vec<(Cut, i64)>, Plan, Vec<Numbered>),
    /// Rounds or digits were used up.
    Lost,
}

impl<'a> Finder<'a> {
    pub(crate) fn new(team: &'a Team, whole: &'a Whole, options: &'a Options) -> Finder<'a> {
        let around = whole.owner.iter().map(|_| None).collect();
        let distances = Distances::new(whole);
        Finder { team, whole, options, pairs: pairs(whole), distances, around }
    }

    /// The views and promises to hand out.
    pub(crate) fn agreement(&self, found: &Found) -> Agreement {
        let view = |outline: &Outline| View {
            agent: outline.agent,
            network: self.numbered(outline, &found.promises, false).network,
        };
        Agreement {
            network: self.whole.network(),
            promises: found.promises.clone(),
            views: found.plan.views.iter().map(view).collect(),
        }
    }

    /// Both ways to begin; if neither leads to anything, what their cores suggest.
    pub(crate) fn search(&mut self) -> Result<Attempt, TooLarge> {
        let mut failure = None;
        let mut found = Vec::new();
        let mut seen: BTreeSet<Choice> = BTreeSet::new();
        let mut open = BinaryHeap::new();
        let mut made = 0;
        for choice in [self.nearest(), self.all_from_the_origin()] {
            open.push(Reverse((0_usize, made, choice)));
            made += 1;
        }
        while seen.len() < self.choices()
            && let Some(Reverse((depth, _, choice))) = open.pop()
        {
            if !found.is_empty() && (depth > 0 || !self.options.soonest) {
                break;
            }
            if !seen.insert(choice.clone()) {
                continue;
            }
            match self.attempt(&choice)? {
                Some(Tried::Found(promises)) if self.options.soonest => found.push(self.earlier(promises)?),
                Some(Tried::Found(promises)) => found.push(promises),
                Some(Tried::Core(core, plan, views)) => {
                    for next in self.others(&choice, &core, &plan, &views) {
                        made += 1;
                        open.push(Reverse((depth + 1, made, next)));
                    }
                    failure.get_or_insert(Failure { core, promises: plan.promises, views });
                }
                Some(Tried::Lost) | None => {}
            }
        }
        Ok(if found.is_empty() {
            Attempt::Failed(failure.unwrap_or_default())
        } else {
            Attempt::Found(found)
        })
    }

    /// One choice; `None` if what is promised would lead in a circle.
    fn attempt(&mut self, choice: &Choice) -> Result<Option<Tried>, TooLarge> {
        let rules = &self.options.rules;
        let Some(plan) = plan(self.team, self.whole, &self.pairs, choice, rules) else { return Ok(None) };
        let promises: Vec<Promise> =
            plan.promises.iter().map(|&(event, base)| self.start(event, base)).collect();
        let mut cuts = Vec::new();
        for (number, &(event, base)) in plan.promises.iter().enumerate() {
            let [low, high] = ends(number);
            // That it is not too late the views say themselves, and why.
            let (least, _) = self.window(event, base);
            cuts.extend([Cut::order(low, high), Cut::at_least(low, least)]);
        }
        self.rounds(plan, promises, cuts, Goal::Narrow).map(Some)
    }

    /// Checks all views and mends the promises until all is well.
    fn rounds(
        &self,
        plan: Plan,
        mut promises: Vec<Promise>,
        mut cuts: Vec<Cut>,
        goal: Goal,
    ) -> Result<Tried, TooLarge> {
        let mut views: Vec<Option<(Numbered, bool)>> = plan.views.iter().map(|_| None).collect();
        // A round may settle no more than one promise.
        for _ in 0..self.options.rounds.max(2 * plan.promises.len()) {
            let known = cuts.len();
            for (outline, slot) in plan.views.iter().zip(&mut views) {
                if slot.is_some() {
                    continue;
                }
                let view = self.numbered(outline, &promises, true);
                let conflict = self.conflict(&view)?;
                let is_fine = conflict.is_none();
                cuts.extend(conflict.map(|it| Cut::new(&view, outline.agent, it, &promises)));
                *slot = Some((view, is_fine));
            }
            if cuts.len() == known {
                return Ok(Tried::Found(Found { plan, promises }));
            }
            match solve_cuts(2 * promises.len(), &cuts, goal) {
                Solved::Lost => return Ok(Tried::Lost),
                Solved::Core(core) => {
                    let core = core.into_iter().map(|(cut, times)| (cuts[cut].clone(), times)).collect();
                    let all = plan.views.iter().map(|outline| self.numbered(outline, &promises, true));
                    let views = all.collect();
                    return Ok(Tried::Core(core, plan, views));
                }
                Solved::Ends(ends) => {
                    let mut changed = vec![false; promises.len()];
                    for (number, promise) in promises.iter_mut().enumerate() {
                        let [low, high] = [ends[2 * number], ends[2 * number + 1]].map(Duration::from_micros);
                        changed[number] = (promise.low, promise.high) != (low, high);
                        (promise.low, promise.high) = (low, high);
                    }
                    if !changed.contains(&true) {
                        return Ok(Tried::Lost);
                    }
                    for (outline, slot) in plan.views.iter().zip(&mut views) {
                        if outline.depends_on(&changed) || slot.as_ref().is_some_and(|(_, is_fine)| !is_fine)
                        {
                            *slot = None;
                        }
                    }
                }
            }
        }
        Ok(Tried::Lost)
    }

    /// Some conflict of a view. There is nothing in it that could be made one.
    fn conflict(&self, view: &Numbered) -> Result<Option<Conflict>, TooLarge> {
        if self.options.rules.no_merging {
            return any_conflict(&view.network);
        }
        let merged = merge(&view.network);
        Ok(any_conflict(&merged.network)?.map(|conflict| merged.unmerge(&conflict, &view.network)))
    }

    /// The same promises with beginnings as early as the views bear it.
    fn earlier(&mut self, found: Found) -> Result<Found, TooLarge> {
        let mut promises = found.promises.clone();
        let mut cuts = Vec::new();
        for (number, promise) in promises.iter_mut().enumerate() {
            let [low, high] = ends(number);
            let (least, _) = self.window(promise.event, promise.base);
            let micros = promise.high.as_micros();
            cuts.extend([Cut::order(low, high), Cut::at_least(low, least)]);
            cuts.extend([Cut::at_least(high, micros), Cut::at_most(high, micros)]);
            promise.low = Duration::from_micros(least.min(promise.low.as_micros()));
        }
        Ok(match self.rounds(found.plan.clone(), promises, cuts, Goal::Early)? {
            Tried::Found(earlier) => earlier,
            Tried::Core(..) | Tried::Lost => found,
        })
    }

    fn numbered(&self, outline: &Outline, promises: &[Promise], apart: bool) -> Numbered {
        let tolerance = self.options.tolerance.as_micros();
        let reserve = Reserve { tolerance, apart, rules: &self.options.rules };
        outline.numbered(self.team, self.whole, &self.pairs, promises, reserve)
    }

    /// How many ways are tried: of large teams fewer, as each takes its time, but always both ways to begin.
    fn choices(&self) -> usize {
        let events = self.whole.owner.len().max(1);
        self.options.choices.min((WORK / (events * events)).max(2))
    }

    /// All promises measured from the origin: agreed dates.
    fn all_from_the_origin(&self) -> Choice {
        let origin = self.whole.origin();
        let mut choice =
            Choice { base: vec![origin; self.whole.owner.len()], keeper: vec![0; self.pairs.len()] };
        // But for what the author has agreed on.
        let class = |event: EventId| self.whole.merged.event_of[event.index()];
        for &(event, base) in self.team.wishes() {
            let (event, base) = (class(event), class(base));
            if event != origin && event != base && self.may_be_based(&choice, event, base) {
                choice.base[event.index()] = base;
            }
        }
        choice
    }

    /// Every promise measured from the nearest event it waits for.
    fn nearest(&mut self) -> Choice {
        let mut choice = self.all_from_the_origin();
        let mut settled = vec![false; self.whole.owner.len()];
        // With other bases other events have to be promised, too.
        while let Some(plan) = plan(self.team, self.whole, &self.pairs, &choice, &self.options.rules) {
            let open: Vec<EventId> =
                plan.promises.iter().map(|it| it.0).filter(|event| !settled[event.index()]).collect();
            if open.is_empty() {
                break;
            }
            for event in open {
                settled[event.index()] = true;
                if choice.base[event.index()] != self.whole.origin() {
                    continue;
                }
                let bases = self.bases(event, true);
                let free = bases.into_iter().find(|&base| self.may_be_based(&choice, event, base));
                choice.base[event.index()] = free.unwrap_or(self.whole.origin());
            }
        }
        choice
    }

    /// True if the way on from a base does not lead to the event.
    fn may_be_based(&self, choice: &Choice, event: EventId, base: EventId) -> bool {
        let mut at = base;
        for _ in 0..choice.base.len() {
            if at == self.whole.origin() || !self.options.rules.acyclic {
                return true;
            }
            if at == event {
                break;
            }
            at = self.whole.link_to(at).map_or(choice.base[at.index()], |link| link.from);
        }
        false
    }

    /// What a promise could be measured from, nearest first: what it waits for, or also what it may merely come after.
    fn bases(&mut self, event: EventId, waits: bool) -> Vec<EventId> {
        let Some(owner) = self.whole.owner[event.index()] else { return Vec::new() };
        let origin = self.whole.origin();
        let mut bases: Vec<(i64, i64, bool, EventId)> = Vec::new();
        for base in self.whole.merged.network.event_ids() {
            let is_joint = self.whole.owner[base.index()].is_none() && base != origin;
            if base == event || is_joint {
                continue;
            }
            let news = news(self.team, self.whole, base, owner, &self.options.rules);
            let (least, most) = self.range(event, base);
            if news.max != Bound::Infinite && (least >= 0 || !waits && most >= 0) {
                let is_contingent = self.whole.link_to(base).is_some();
                bases.push((most, least.saturating_neg(), !is_contingent, base));
            }
        }
        bases.sort_unstable();
        bases.into_iter().map(|(.., base)| base).collect()
    }

    /// Other choices, with one change that may be rid of a core.
    fn others(
        &mut self,
        choice: &Choice,
        core: &[(Cut, i64)],
        plan: &Plan,
        views: &[Numbered],
    ) -> Vec<Choice> {
        let mut promised: BTreeSet<EventId> = BTreeSet::new();
        let mut kept: BTreeSet<u32> = BTreeSet::new();
        for (cut, _) in core {
            promised.extend(cut.terms.iter().map(|&(end, _)| plan.promises[end / 2].0));
            let Blame::View(agent, conflict) = &cut.blame else { continue };
            let view = &views[agent.index()];
            for share in &conflict.members {
                kept.extend(view.side_of(share.part));
            }
        }
        let mut others = Vec::new();
        for event in promised {
            let mut bases = self.bases(event, true);
            bases.truncate(BASES);
            bases.extend(self.bases(event, false).into_iter().take(BASES));
            bases.push(self.whole.origin());
            let mut tried = BTreeSet::from([choice.base[event.index()]]);
            for base in bases {
                if tried.insert(base) && self.may_be_based(choice, event, base) {
                    let mut other = choice.clone();
                    other.base[event.index()] = base;
                    others.push(other);
                }
            }
        }
        for (number, pair) in self.pairs.iter().enumerate() {
            let keeper = choice.keeper[number];
            if pair.may.len() > 1 && pair.sides.iter().any(|side| kept.contains(side)) {
                let mut other = choice.clone();
                other.keeper[number] = 1 - keeper.min(1);
                others.push(other);
            }
        }
        others
    }

    /// Numbers to begin with: at its earliest from the origin, else as soon as its owner hears of the base.
    fn start(&mut self, event: EventId, base: EventId) -> Promise {
        let (least, most) = self.window(event, base);
        let (mut low, mut high) = (least, least);
        if let (Some(owner), true) = (self.whole.owner[event.index()], base != self.whole.origin()) {
            let news = news(self.team, self.whole, base, owner, &self.options.rules);
            let latest = news.max.finite().unwrap_or(news.min);
            low = low.max(news.min.as_micros()).min(most.max(least));
            high = high.max(latest.as_micros()).min(most.max(least)).max(low);
        }
        let [low, high] = [low, high].map(Duration::from_micros);
        Promise { event, base, low, high }
    }

    /// Why an event comes so long after its base: bounds of the whole.
    pub(crate) fn why(&self, (event, base): (EventId, EventId)) -> Vec<Step> {
        self.distances.as_ref().map_or(Vec::new(), |distances| distances.way(event, base))
    }

    /// How long after a base an event may be promised, by the requirements alone: the least and the most.
    fn window(&mut self, event: EventId, base: EventId) -> (i64, i64) {
        let (least, most) = self.range(event, base);
        (least.max(0), most)
    }

    /// The same, where the event may come before the base.
    fn range(&mut self, event: EventId, base: EventId) -> (i64, i64) {
        let Some(distances) = &self.distances else { return (-FAR, FAR) };
        let around = self.around[event.index()].get_or_insert_with(|| distances.around(event));
        let (least, most) = (around.at_most[base.index()], around.at_least[base.index()]);
        (-least, if most == -FAR { FAR } else { -most })
    }
}

/// Both ends of a promise among all ends.
fn ends(number: usize) -> [usize; 2] {
    [Term::Low(number as u32).index(), Term::High(number as u32).index()]
}

impl Outline {
    /// True if any of these promises is in the view.
    fn depends_on(&self, changed: &[bool]) -> bool {
        self.promises().any(|number| changed[number as usize])
    }
}
