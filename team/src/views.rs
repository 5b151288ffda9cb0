//! What each agent executes: a network of its own, closed under what it needs to know.
//!
//! A pair of events with requirements between them goes to one agent that can act on it. What an agent has in its view and does not
//! execute itself is contingent there: Nature's as it was, what another agent executes by that agent's promise.

use std::collections::BTreeMap;

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Network, Part, Requirement};

use crate::model::{AgentId, Team};
use crate::promise::{Promise, Term};
use crate::rules::Rules;
use crate::whole::Whole;

/// Two events with requirements between them, and who could keep those, best first; nobody if Nature alone decides.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// Numbers of [`Whole::sides`].
    pub(crate) sides: Vec<u32>,
    pub(crate) may: Vec<AgentId>,
}

/// What is free to choose before promises are given numbers.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Choice {
    /// By event: what a promise of its time is measured from.
    pub(crate) base: Vec<EventId>,
    /// By pair: which of those who may keep it.
    pub(crate) keeper: Vec<u8>,
}

/// The views of a choice, with promises that have no numbers yet.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// (event, base), in order of the events.
    pub(crate) promises: Vec<(EventId, EventId)>,
    pub(crate) views: Vec<Outline>,
}

/// One view without numbers for promises.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    pub(crate) agent: AgentId,
    /// The events in it, in order; the origin is one of them.
    events: Vec<EventId>,
    pairs: Vec<u32>,
    /// The promises of this agent, by number.
    kept: Vec<u32>,
    /// By event of the view: the promise it is known by.
    known_by: Vec<Option<u32>>,
}

/// A view with numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbered {
    pub(crate) network: Network,
    /// By requirement of the network what its upper and its lower bound come from.
    pub(crate) said: Vec<[Option<Said>; 2]>,
    /// By contingent link what it comes from.
    pub(crate) told: Vec<Told>,
    /// By event of the network which of the whole it is.
    events: Vec<EventId>,
}

/// Where a bound in a view comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Said {
    /// A side of the whole.
    Side(u32),
    /// An end of a promise of the agent itself.
    Own(Term),
}

/// Where a contingent link in a view comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Told {
    /// It is a link of the whole.
    Nature(u32),
    /// It is a promise of another agent.
    Promise(u32),
}

/// All pairs of events with requirements between them.
pub(crate) fn pairs(whole: &Whole) -> Vec<Pair> {
    let mut by_events: BTreeMap<(EventId, EventId), Vec<u32>> = BTreeMap::new();
    for (number, side) in whole.sides.iter().enumerate() {
        let ends = (side.from.min(side.to), side.from.max(side.to));
        by_events.entry(ends).or_default().push(number as u32);
    }
    let pair = |((a, b), sides): ((EventId, EventId), Vec<u32>)| {
        let may = keepers(whole, a, b, &sides);
        Pair { sides, may }
    };
    by_events.into_iter().map(pair).collect()
}

fn keepers(whole: &Whole, a: EventId, b: EventId, sides: &[u32]) -> Vec<AgentId> {
    let is_after = |late: EventId, early: EventId| {
        // `early - late <= 0`.
        sides
            .iter()
            .map(|&side| &whole.sides[side as usize])
            .any(|side| side.from == late && side.to == early && side.weight <= 0)
    };
    let ordered = if is_after(a, b) && !is_after(b, a) { [a, b] } else { [b, a] };
    let direct = ordered.into_iter().filter(|&event| whole.link_to(event).is_none());
    let through =
        ordered.into_iter().filter(|&event| whole.link_to(event).is_some()).map(|it| whole.root(it));
    let mut may: Vec<AgentId> = Vec::new();
    for agent in direct.chain(through).filter_map(|event| whole.owner[event.index()]) {
        if !may.contains(&agent) {
            may.push(agent);
        }
    }
    may
}

/// The views of a choice; `None` if what is known of events leads in a circle.
pub(crate) fn plan(
    team: &Team,
    whole: &Whole,
    pairs: &[Pair],
    choice: &Choice,
    rules: &Rules,
) -> Option<Plan> {
    let mut closure = Closure::new(team, whole, choice);
    for agent in team.agent_ids() {
        closure.need(agent, whole.origin());
    }
    for event in whole.merged.network.event_ids() {
        if let (Some(owner), None) = (whole.owner[event.index()], whole.link_to(event)) {
            closure.need(owner, event);
        }
    }
    let mut pairs_of: Vec<Vec<u32>> = vec![Vec::new(); team.agents().len()];
    for (number, pair) in pairs.iter().enumerate() {
        let Some(&keeper) = pair.may.get(usize::from(choice.keeper[number])) else { continue };
        pairs_of[keeper.index()].push(number as u32);
        for &side in &pair.sides {
            closure.need(keeper, whole.sides[side as usize].from);
            closure.need(keeper, whole.sides[side as usize].to);
        }
    }
    closure.close();
    let promises: Vec<(EventId, EventId)> = (whole.merged.network.event_ids())
        .filter(|event| closure.promised[event.index()])
        .map(|event| (event, choice.base[event.index()]))
        .collect();
    if rules.acyclic && leads_in_a_circle(whole, &promises) {
        return None;
    }
    Some(closure.plan(promises, pairs_of))
}

struct Closure<'a> {
    team: &'a Team,
    whole: &'a Whole,
    choice: &'a Choice,
    /// By agent and event.
    needed: Vec<bool>,
    promised: Vec<bool>,
    open: Vec<(AgentId, EventId)>,
}

impl<'a> Closure<'a> {
    fn new(team: &'a Team, whole: &'a Whole, choice: &'a Choice) -> Closure<'a> {
        let count = whole.owner.len();
        let needed = vec![false; count * team.agents().len()];
        Closure { team, whole, choice, needed, promised: vec![false; count], open: Vec::new() }
    }

    fn need(&mut self, agent: AgentId, event: EventId) {
        let at = agent.index() * self.promised.len() + event.index();
        if !std::mem::replace(&mut self.needed[at], true) {
            self.open.push((agent, event));
        }
    }

    fn close(&mut self) {
        while let Some((agent, event)) = self.open.pop() {
            if let Some(link) = self.whole.link_to(event) {
                self.need(agent, link.from);
            } else if let Some(owner) = self.whole.owner[event.index()].filter(|&owner| owner != agent) {
                let base = self.choice.base[event.index()];
                self.promised[event.index()] = true;
                self.need(agent, base);
                self.need(owner, base);
            }
        }
    }

    fn plan(&self, promises: Vec<(EventId, EventId)>, pairs_of: Vec<Vec<u32>>) -> Plan {
        let count = self.promised.len();
        let mut number = vec![None; count];
        for (at, (event, _)) in promises.iter().enumerate() {
            number[event.index()] = Some(at as u32);
        }
        let outline = |(agent, pairs): (AgentId, Vec<u32>)| {
            let owns = |event: EventId| self.whole.owner[event.index()] == Some(agent);
            let needed = &self.needed[agent.index() * count..][..count];
            let events: Vec<EventId> =
                (0..count as u32).map(EventId).filter(|event| needed[event.index()]).collect();
            let known_by = |event: &EventId| number[event.index()].filter(|_| !owns(*event));
            Outline {
                agent,
                pairs,
                kept: (0..promises.len() as u32).filter(|&at| owns(promises[at as usize].0)).collect(),
                known_by: events.iter().map(known_by).collect(),
                events,
            }
        };
        let views = self.team.agent_ids().zip(pairs_of).map(outline).collect();
        Plan { promises, views }
    }
}

/// Every promise leads to its base, every contingent event to its activation.
fn leads_in_a_circle(whole: &Whole, promises: &[(EventId, EventId)]) -> bool {
    let mut next = vec![None; whole.owner.len()];
    for link in whole.merged.network.contingents() {
        next[link.to.index()] = Some(link.from);
    }
    for &(event, base) in promises {
        next[event.index()] = Some(base);
    }
    // Each has one way on at most: walk on until something is known to end, or is met again.
    let mut seen = vec![0_u32; next.len()];
    for start in 0..next.len() {
        let (walk, mut at) = (start as u32 + 1, start);
        while seen[at] == 0 {
            seen[at] = walk;
            match next[at] {
                Some(on) => at = EventId::index(on),
                None => break,
            }
        }
        if seen[at] == walk && next[at].is_some() {
            return true;
        }
    }
    false
}

impl Outline {
    /// The promises that the view has anything to do with.
    pub(crate) fn promises(&self) -> impl Iterator<Item = u32> {
        self.kept.iter().copied().chain(self.known_by.iter().filter_map(|number| *number))
    }

    /// The view with the numbers of promises. The agent promises itself a little less than it tells, by the `tolerance`.
    pub(crate) fn numbered(
        &self,
        team: &Team,
        whole: &Whole,
        pairs: &[Pair],
        promises: &[Promise],
        options: Reserve,
    ) -> Numbered {
        let index = |event: EventId| match self.events.binary_search(&event) {
            Ok(at) => EventId(at as u32),
            Err(_) => unreachable!("a view is closed under what it needs"),
        };
        let mut view = Writer::default();
        for &pair in &self.pairs {
            let sides = &pairs[pair as usize].sides;
            let first = &whole.sides[sides[0] as usize];
            let (from, to) = (index(first.from), index(first.to));
            let upper = Some((first.weight, Said::Side(sides[0])));
            let lower = sides.get(1).map(|&side| (-whole.sides[side as usize].weight, Said::Side(side)));
            view.require(from, to, lower, upper, options.rules);
        }
        for &number in self.kept.iter().filter(|_| options.rules.own_promise) {
            let Promise { event, base, low, high } = promises[number as usize];
            let high = (high.as_micros() - options.tolerance).max(low.as_micros());
            let ends = [(low.as_micros(), Term::Low(number)), (high, Term::High(number))];
            let [lower, upper] = ends.map(|(bound, term)| Some((bound, Said::Own(term))));
            if options.apart {
                view.require(index(base), index(event), lower, None, options.rules);
                view.require(index(base), index(event), None, upper, options.rules);
            } else {
                view.require(index(base), index(event), lower, upper, options.rules);
            }
        }
        for (&event, known_by) in self.events.iter().zip(&self.known_by) {
            let news = news(team, whole, event, self.agent, options.rules);
            if let Some(link) = whole.merged.network.link_of(event) {
                let ContingentLink { from, lower, upper, .. } = whole.merged.network.contingents()[link];
                let link_here =
                    ContingentLink { from: index(from), to: index(event), lower, upper, delay: news };
                view.contingents.push(link_here);
                view.told.push(Told::Nature(link as u32));
            } else if let Some(number) = *known_by {
                let Promise { base, low, high, .. } = promises[number as usize];
                let (from, to) = (index(base), index(event));
                view.contingents.push(ContingentLink { from, to, lower: low, upper: high, delay: news });
                view.told.push(Told::Promise(number));
            }
        }
        let merged = &whole.merged.network;
        let events: Vec<Event> =
            self.events.iter().map(|event| merged.events()[event.index()].clone()).collect();
        let network = Network::new(
            format!("{}: {}", merged.name(), team.name(self.agent)),
            index(merged.origin()),
            events,
            view.requirements,
            view.contingents,
        )
        .unwrap_or_else(|errors| {
            unreachable!("a part of a valid network with promises in order is valid: {errors:?}")
        });
        Numbered { network, said: view.said, told: view.told, events: self.events.clone() }
    }
}

impl Numbered {
    /// Which event of the whole an event of the view is.
    pub(crate) fn event_of(&self, event: EventId) -> EventId {
        self.events[event.index()]
    }

    /// The side of the whole that a part of a conflict is.
    pub(crate) fn side_of(&self, part: Part) -> Option<u32> {
        let said = match part {
            Part::RequirementUpper(index) => self.said[index][0],
            Part::RequirementLower(index) => self.said[index][1],
            _ => None,
        };
        match said {
            Some(Said::Side(side)) => Some(side),
            _ => None,
        }
    }
}

/// How promises are written down in views.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reserve<'a> {
    /// Microseconds by which an agent is earlier than it says.
    pub(crate) tolerance: i64,
    /// The ends of promises are requirements of their own, so that these have the same numbers whatever is promised.
    pub(crate) apart: bool,
    pub(crate) rules: &'a Rules,
}

#[derive(Default)]
struct Writer {
    requirements: Vec<Requirement>,
    said: Vec<[Option<Said>; 2]>,
    contingents: Vec<ContingentLink>,
    told: Vec<Told>,
}

impl Writer {
    fn require(
        &mut self,
        from: EventId,
        to: EventId,
        lower: Option<(i64, Said)>,
        upper: Option<(i64, Said)>,
        rules: &Rules,
    ) {
        let bound = |end: Option<(i64, Said)>| {
            end.map_or(Bound::Infinite, |(micros, _)| Bound::Finite(Duration::from_micros(micros)))
        };
        let mut add = |lower: Option<(i64, Said)>, upper: Option<(i64, Said)>| {
            self.requirements.push(Requirement { from, to, lower: bound(lower), upper: bound(upper) });
            self.said.push([upper, lower].map(|end| end.map(|(_, said)| said)));
        };
        // What is [0, 0] is written as two, so that nothing is made one that is not; so is what contradicts itself.
        let ends = lower.zip(upper).map(|(lower, upper)| (lower.0, upper.0));
        let reversed = ends.is_some_and(|(lower, upper)| lower > upper);
        if reversed || ends == Some((0, 0)) && rules.no_merging {
            add(lower, None);
            add(None, upper);
        } else {
            add(lower, upper);
        }
    }
}

/// When an agent hears of an event, after it.
pub(crate) fn news(team: &Team, whole: &Whole, event: EventId, agent: AgentId, rules: &Rules) -> Delay {
    let own = whole.link_to(event).map_or(Delay::NONE, |link| link.delay);
    let Some(owner) = whole.owner[event.index()] else { return own };
    let never = Delay { min: Duration::ZERO, max: Bound::Infinite };
    let Some(way) = team.reach().delay(owner, agent) else { return never };
    let way = rules.delay(way);
    let max = match (own.max, way.max) {
        (Bound::Finite(own), Bound::Finite(way)) => Bound::Finite(own.saturating_add(way)),
        _ => Bound::Infinite,
    };
    Delay { min: own.min.saturating_add(way.min), max }
}

/// The end of a promise that a part of a view's conflict is, with the sign of what it contributes; or else what it is.
pub(crate) fn term(view: &Numbered, part: Part) -> Option<(Term, i64)> {
    let own = |end: Option<Said>| match end {
        Some(Said::Own(term)) => Some(term),
        _ => None,
    };
    let told = |link: usize| match view.told[link] {
        Told::Promise(number) => Some(number),
        Told::Nature(_) => None,
    };
    match part {
        Part::RequirementUpper(index) => own(view.said[index][0]).map(|term| (term, 1)),
        Part::RequirementLower(index) => own(view.said[index][1]).map(|term| (term, -1)),
        Part::LinkLower(link) => told(link).map(|number| (Term::Low(number), 1)),
        Part::LinkUpper(link) => told(link).map(|number| (Term::High(number), -1)),
        _ => None,
    }
}
