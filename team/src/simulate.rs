//! The whole team in one virtual time: each agent a dispatcher over its own view, the links in the process, flooding.
//!
//! Each agent relays each event once, when it first hears of it: what it has executed, what it observes, what it is told, never what
//! it imagines. Messages may be lost, come twice and overtake each other. News of something that has not begun here yet is held, and
//! offered again when more has been executed.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use kirk_network::{ContingentLink, EventId, Network, Time};
use kirk_runtime::dispatcher::Missed;
use kirk_runtime::{Dispatcher, How, NoPlan, Plan, Reception, Settings, Strategy};

use crate::find::Agreement;
use crate::model::{AgentId, Team};
use crate::rules::Rules;
use crate::weather::{Mood, Weather};
use crate::whole::Whole;

/// What to simulate.
#[derive(Clone, Debug, Default)]
pub struct Simulation {
    /// How agents treat early news.
    pub strategy: Strategy,
    /// How long what Nature does takes, and its news.
    pub nature: Mood,
    /// What the links do.
    pub weather: Weather,
    /// Of all that is random.
    pub seed: u64,
    #[doc(hidden)]
    pub rules: Rules,
}

/// A team ready to be executed.
#[derive(Debug)]
pub struct Ready<'a> {
    team: &'a Team,
    whole: Whole,
    members: Vec<Member>,
    /// By event the contingent links that start there.
    children: Vec<Vec<u32>>,
    /// Longer than anything takes.
    far: i64,
}

/// What does not change of one agent.
#[derive(Debug)]
struct Member {
    plan: Plan,
    /// By event of the plan: those of the whole that it is.
    of_whole: Vec<Vec<EventId>>,
    /// By event of the whole: that of the plan.
    here: Vec<Option<EventId>>,
}

/// What became of a team. Events are those of the team's network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TeamExecution {
    /// By event: when it happened; `None` for joints of nobody, and for what did not come about.
    pub truth: Vec<Option<Time>>,
    /// By agent and event: when the agent first heard of it.
    pub learned: Vec<Vec<Option<Time>>>,
    /// By agent and event: when and how the agent took it as having happened.
    pub acted: Vec<Vec<Option<(Time, How)>>>,
    /// When the last event happened.
    pub makespan: Time,
    /// What went wrong on the way.
    pub troubles: Vec<Trouble>,
}

/// Something an agent could not go on with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// An event could not be executed in its window.
    Missed {
        /// Whose it is.
        agent: AgentId,
        /// The event of the team's network, and when it was due.
        event: EventId,
        /// The latest time at which it could be executed.
        latest: Time,
    },
    /// News came that the view of an agent rules out: a bound of Nature or of a link, or a promise, was broken.
    Impossible {
        /// Who heard it.
        agent: AgentId,
        /// Of which event.
        event: EventId,
        /// When.
        at: Time,
    },
}

impl<'a> Ready<'a> {
    /// Makes the plans of all agents.
    ///
    /// # Errors
    /// [`NoPlan`] if a view cannot be executed, which those of [`crate::find()`] can.
    pub fn new(team: &'a Team, agreement: &Agreement) -> Result<Ready<'a>, NoPlan> {
        let whole = Whole::new(team);
        let merged = &whole.merged.network;
        let mut by_name: BTreeMap<&str, EventId> = BTreeMap::new();
        for event in merged.event_ids() {
            let names = &merged.events()[event.index()].names;
            by_name.extend(names.iter().map(|name| (name.text.as_str(), event)));
        }
        let members: Result<Vec<Member>, NoPlan> =
            agreement.views.iter().map(|view| Member::new(&view.network, &by_name, merged)).collect();
        let mut children = vec![Vec::new(); merged.events().len()];
        for (number, link) in merged.contingents().iter().enumerate() {
            children[link.from.index()].push(number as u32);
        }
        let longest = merged.contingents().iter().map(|link| {
            let delay = link.delay.max.finite().unwrap_or(link.delay.min).as_micros();
            link.upper.as_micros().saturating_add(delay)
        });
        let far = longest.max().unwrap_or(0).clamp(1_000_000, i64::MAX / 1024);
        Ok(Ready { team, members: members?, children, far, whole })
    }

    /// Executes the team once.
    pub fn run(&self, simulation: &Simulation) -> TeamExecution {
        let mut run = Run::new(self, simulation);
        run.go();
        run.record()
    }
}

impl Member {
    fn new(view: &Network, by_name: &BTreeMap<&str, EventId>, whole: &Network) -> Result<Member, NoPlan> {
        let plan = Plan::new(view)?;
        let mut here = vec![None; whole.events().len()];
        let mut of_whole = Vec::with_capacity(plan.network().events().len());
        for event in plan.network().event_ids() {
            let names = plan.network().events()[event.index()].names.iter();
            let mut all: Vec<EventId> =
                names.filter_map(|name| by_name.get(name.text.as_str()).copied()).collect();
            all.sort_unstable();
            all.dedup();
            for one in &all {
                here[one.index()] = Some(event);
            }
            of_whole.push(all);
        }
        Ok(Member { plan, of_whole, here })
    }
}

/// Something that happens at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Happening {
    /// An agent observes an event of its own.
    Observed(EventId),
    /// A message arrives.
    Told(Message),
    /// What was told with a stamp counts as heard.
    Due(AgentId, EventId),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Message {
    to: AgentId,
    event: EventId,
    /// When the owner knew, if all links on the way say so.
    stamp: Option<i64>,
    /// The agents that have been told, or are being told, as the thesis' algorithm 7 has it.
    seen: u64,
}

struct Run<'a> {
    ready: &'a Ready<'a>,
    simulation: &'a Simulation,
    random: fastrand::Rng,
    agents: Vec<Agent>,
    /// By event of the whole.
    truth: Vec<Option<i64>>,
    queue: BinaryHeap<Reverse<(i64, u64, Happening)>>,
    queued: u64,
    now: i64,
    troubles: Vec<Trouble>,
}

struct Agent {
    dispatcher: Dispatcher,
    /// By event of the whole: when it was first heard of, and whether it has come with a stamp.
    learned: Vec<Option<i64>>,
    stamped: Vec<bool>,
    /// News of what has not begun here.
    held: Vec<EventId>,
    missed: Option<Missed>,
}

impl<'a> Run<'a> {
    fn new(ready: &'a Ready<'a>, simulation: &'a Simulation) -> Run<'a> {
        let count = ready.whole.owner.len();
        let agent = |member: &Member| Agent {
            dispatcher: Dispatcher::new(member.plan.clone(), Settings::of(simulation.strategy)),
            learned: vec![None; count],
            stamped: vec![false; count],
            held: Vec::new(),
            missed: None,
        };
        Run {
            ready,
            simulation,
            random: fastrand::Rng::with_seed(simulation.seed),
            agents: ready.members.iter().map(agent).collect(),
            truth: vec![None; count],
            queue: BinaryHeap::new(),
            queued: 0,
            now: 0,
            troubles: Vec::new(),
        }
    }

    fn go(&mut self) {
        let origin = self.ready.whole.origin();
        self.truth[origin.index()] = Some(0);
        self.begin(origin, 0);
        loop {
            // Acting and hearing take no time, so at one moment they take turns until nothing more happens.
            loop {
                let mut happened = self.hear();
                let mut order: Vec<usize> = (0..self.agents.len()).collect();
                self.random.shuffle(&mut order);
                for agent in order {
                    happened |= self.act(AgentId(agent as u32));
                    happened |= self.hear();
                }
                if !happened {
                    break;
                }
            }
            let next = self.queue.peek().map(|Reverse((at, ..))| *at);
            let timeouts = self.agents.iter_mut().filter_map(|agent| agent.dispatcher.poll_timeout());
            let Some(at) = timeouts.map(Time::as_micros).chain(next).min() else { break };
            self.now = self.now.max(at);
        }
    }

    /// All that is observed and told by now.
    fn hear(&mut self) -> bool {
        let mut happened = false;
        while let Some(&Reverse((_, _, happening))) = self.queue.peek().filter(|it| it.0.0 <= self.now) {
            self.queue.pop();
            happened = true;
            match happening {
                Happening::Observed(event) => {
                    if let Some(owner) = self.ready.whole.owner[event.index()] {
                        self.learn(owner, event, Some(self.now), 0);
                        self.deliver(owner, event);
                    }
                }
                Happening::Told(message) => self.told(message),
                Happening::Due(agent, event) => self.deliver(agent, event),
            }
        }
        happened
    }

    fn told(&mut self, Message { to, event, stamp, seen }: Message) {
        self.learn(to, event, stamp, seen);
        let Some(owner) = self.ready.whole.owner[event.index()] else { return };
        let reach = self.ready.team.reach();
        if !reach.is_stamped(owner, to) {
            self.deliver(to, event);
        } else if let (Some(stamp), Some(delay)) = (stamp, reach.delay(owner, to)) {
            // Whoever waits until the latest knows exactly.
            self.push(self.now.max(stamp.saturating_add(delay.min.as_micros())), Happening::Due(to, event));
        }
    }

    /// One agent does what is due.
    fn act(&mut self, agent: AgentId) -> bool {
        let ready = self.ready;
        let member = &ready.members[agent.index()];
        let mut happened = false;
        let own = &mut self.agents[agent.index()];
        own.dispatcher.handle_timeout(Time::from_micros(self.now));
        let mut executed: Vec<(EventId, i64)> = Vec::new();
        while let Some(dispatch) = own.dispatcher.poll_dispatch() {
            executed.push((dispatch.event, dispatch.time.as_micros()));
        }
        // What is one with something contingent happens as soon as that is taken to have happened.
        while let Some(event) = own.dispatcher.poll_fixed() {
            if member.of_whole[event.index()].len() > 1 {
                executed.push((event, self.now));
            }
        }
        if own.missed.is_none() {
            own.missed = own.dispatcher.missed();
            if let Some(missed) = own.missed {
                let event = member.of_whole[missed.event.index()][0];
                self.troubles.push(Trouble::Missed { agent, event, latest: missed.latest });
            }
        }
        for (event, time) in executed {
            for &event in &member.of_whole[event.index()] {
                let is_own = ready.whole.owner[event.index()] == Some(agent);
                if is_own && ready.whole.link_to(event).is_none() && self.truth[event.index()].is_none() {
                    happened = true;
                    self.truth[event.index()] = Some(time);
                    self.learn(agent, event, Some(time), 0);
                    self.begin(event, time);
                }
            }
        }
        if happened {
            for event in std::mem::take(&mut self.agents[agent.index()].held) {
                self.deliver(agent, event);
            }
        }
        happened
    }

    /// Nature goes on from an event.
    fn begin(&mut self, event: EventId, time: i64) {
        let ready = self.ready;
        for &number in &ready.children[event.index()] {
            let link: ContingentLink = ready.whole.merged.network.contingents()[number as usize];
            // Of its own for each link, so that Nature does the same whatever is done first.
            let mut random = fastrand::Rng::with_seed(
                self.simulation.seed ^ (u64::from(number) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15),
            );
            let nature = self.simulation.nature;
            let (lower, upper) = (link.lower.as_micros(), link.upper.as_micros());
            let truth = time.saturating_add(nature.between(&mut random, lower, upper));
            self.truth[link.to.index()] = Some(truth);
            if let Some(delay) = nature.choose(&mut random, link.delay, ready.far) {
                self.push(truth.saturating_add(delay), Happening::Observed(link.to));
            }
            self.begin(link.to, truth);
        }
    }

    /// An agent hears of an event, perhaps not for the first time, and tells on what it did not know.
    fn learn(&mut self, agent: AgentId, event: EventId, stamp: Option<i64>, seen: u64) {
        let own = &mut self.agents[agent.index()];
        let is_new = own.learned[event.index()].is_none();
        own.learned[event.index()].get_or_insert(self.now);
        let is_new_stamp = stamp.is_some() && !std::mem::replace(&mut own.stamped[event.index()], true);
        if !is_new && !is_new_stamp {
            return;
        }
        let ready = self.ready;
        let bit = |agent: AgentId| 1_u64 << (agent.0 % 64);
        let arcs = ready.team.arcs().iter().filter(|arc| arc.from == agent);
        let skipped = |to: AgentId| !self.simulation.rules.flooding && seen & bit(to) != 0;
        let peers: Vec<_> = arcs.filter(|arc| !skipped(arc.to)).copied().collect();
        let seen = peers.iter().fold(seen | bit(agent), |seen, arc| seen | bit(arc.to));
        for arc in peers {
            if !is_new && !arc.stamped {
                continue;
            }
            let message = Message { to: arc.to, event, stamp: stamp.filter(|_| arc.stamped), seen };
            let ends = (arc.from, arc.to);
            let weather = &self.simulation.weather;
            let arrivals = weather.arrivals(&mut self.random, ends, arc.delay, self.now, ready.far);
            for at in arrivals.into_iter().flatten() {
                self.push(at, Happening::Told(message));
            }
        }
    }

    /// News for the dispatcher of an agent.
    fn deliver(&mut self, agent: AgentId, event: EventId) {
        let member = &self.ready.members[agent.index()];
        let Some(here) = member.here[event.index()] else { return };
        let is_own = self.ready.whole.owner[event.index()] == Some(agent);
        if is_own && self.ready.whole.link_to(event).is_none() {
            return;
        }
        let own = &mut self.agents[agent.index()];
        let at = Time::from_micros(self.now);
        match own.dispatcher.handle_observation(at, here) {
            Reception::Impossible { earliest: None, .. } if self.simulation.rules.hold => {
                own.held.push(event)
            }
            Reception::Impossible { earliest: None, .. } => {}
            Reception::Impossible { .. } => self.troubles.push(Trouble::Impossible { agent, event, at }),
            Reception::Accepted | Reception::Repeated | Reception::NotContingent => {}
        }
        // Planning anew takes no time here.
        own.dispatcher.plan_at_once(at);
    }

    fn push(&mut self, at: i64, happening: Happening) {
        self.queued += 1;
        self.queue.push(Reverse((at, self.queued, happening)));
    }

    fn record(self) -> TeamExecution {
        let event_of = &self.ready.whole.merged.event_of;
        let time = Time::from_micros;
        let by_event = |of: &dyn Fn(EventId) -> Option<Time>| -> Vec<Option<Time>> {
            event_of.iter().map(|&event| of(event)).collect()
        };
        let acted = |(agent, member): (&Agent, &Member)| {
            let of = |event: &EventId| {
                let fixed = agent.dispatcher.known(member.here[event.index()]?).fixed?;
                Some((fixed.time, fixed.how))
            };
            event_of.iter().map(of).collect()
        };
        let back = |event: EventId| {
            let original = event_of.iter().position(|&it| it == event);
            original.map_or(event, |at| EventId(at as u32))
        };
        let troubles = self.troubles.iter().map(|trouble| match *trouble {
            Trouble::Missed { agent, event, latest } => Trouble::Missed { agent, event: back(event), latest },
            Trouble::Impossible { agent, event, at } => Trouble::Impossible { agent, event: back(event), at },
        });
        TeamExecution {
            truth: by_event(&|event| self.truth[event.index()].map(time)),
            learned: self
                .agents
                .iter()
                .map(|agent| by_event(&|it| agent.learned[it.index()].map(time)))
                .collect(),
            acted: self.agents.iter().zip(&self.ready.members).map(acted).collect(),
            makespan: self.truth.iter().flatten().max().map_or(Time::ZERO, |&at| time(at)),
            troubles: troubles.collect(),
        }
    }
}
