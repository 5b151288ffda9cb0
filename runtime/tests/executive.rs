//! The executive in a rough world: the driver is slow and fails, the clock is late, planning anew takes its time, news is
//! repeated, and the process dies at any moment. Whatever happens, what was executed keeps every requirement in true time up
//! to the lateness that was allowed, and the journal leads to the same state, bit for bit.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-runtime --release --test executive` tries as many missions as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

#[path = "../../network/tests/oracle/mod.rs"]
mod oracle;

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};
use std::time::Instant;

use kirk_network::generate::{
    self, Exponential, Lambda, LaneOptions, RepeaterOptions, SamplingOptions, controllable, lanes, repeaters,
    sampling,
};
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::journal::{Clocks, Line, Record, Start, Trace, read, write};
use kirk_runtime::nature::Nature;
use kirk_runtime::{
    Answer, Executive, Handled, Input, Outcome, Output, Patience, Plan, Rebuild, Scope, Settings, Setup,
    Speed, Strategy, Temper, Why, handovers, recover, replay, verify,
};
use oracle::order::precedes;
use oracle::random::{self, Shape};
use serde_json::value::RawValue;

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// How the world is.
#[derive(Clone, Copy, Default)]
struct World {
    /// Everything takes up to so many microseconds: waking up, the driver, planning anew. Also what counts as on time.
    slow: i64,
    /// Of 100 attempts the driver fails so many.
    fails: u32,
    /// Of 100 good answers of the driver so many are lost: it is asked again.
    lost: u32,
    /// How many microseconds before it is due an event is handed over.
    lead: i64,
    /// Of 100 steps the process dies after so many, and is back at once.
    dies: u32,
    /// Of 100 news so many come when the model says they cannot. Then nothing is promised but that the journal is right.
    lies: u32,
    /// Of 100 events so many are nobody's to execute: they happen when they are due.
    nobodys: u32,
}

/// What is still to come.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Coming {
    News(EventId),
    Answer { id: String, good: bool, lost: bool },
}

struct Life {
    network: Network,
    setup: Setup,
    world: World,
    random: fastrand::Rng,
    executive: Executive,
    coming: BinaryHeap<Reverse<(i64, Coming)>>,
    rebuilding: Vec<(i64, Rebuild)>,
    /// When the driver has really done what; a repeated id is not done again.
    done: HashMap<String, i64>,
    /// When executable events really happened, and contingent ones.
    truth: Vec<Option<i64>>,
    /// What the driver has said it has done.
    confirmed: HashSet<String>,
    /// What must not come before what, apart from the origin, which is time zero whether its activities have begun or not.
    precedes: Box<dyn Fn(EventId, EventId) -> bool>,
    journal: String,
    checksum: u32,
    deaths: u32,
    seen: Seen,
}

/// What the missions have come across.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Deaths after a new plan was followed.
    recoveries: u32,
    /// Warnings that something is wrong in the world.
    warnings: u32,
}

impl Life {
    fn new(network: &Network, strategy: Strategy, world: World, seed: u64) -> Option<Life> {
        let plan = Plan::new(network).ok()?;
        let mut random = fastrand::Rng::with_seed(seed);
        let mut handovers = handovers(plan.network(), None, Scope::All);
        handovers.retain(|_| random.u32(0..100) >= world.nobodys);
        let setup = Setup {
            program: "random".into(),
            run: "run".into(),
            settings: Settings {
                strategy,
                lead: Duration::from_micros(world.lead),
                lateness: Duration::from_micros(world.slow.max(world.lead)),
                ..Settings::default()
            },
            handovers,
            driver: true,
            patience: Patience {
                first: Duration::from_micros(1),
                most: Duration::from_micros(world.slow / 12 + 1),
            },
        };
        let clocks = Clocks { boot: None, since_boot: 0, calendar: 0 };
        let shell = RawValue::from_string("null".into()).unwrap();
        let start = Start::new(network, &setup, Speed::REAL, clocks, shell, "test");
        let (journal, checksum) = write(&Line::new(Time::ZERO, Record::Start(Box::new(start))), 0);
        let precedes = Box::new(precedes(plan.network(), Some(plan.network().origin())));
        Some(Life {
            network: plan.network().clone(),
            confirmed: HashSet::new(),
            truth: vec![None; plan.network().events().len()],
            executive: Executive::new(plan, setup.clone()),
            setup,
            world,
            random,
            precedes,
            coming: BinaryHeap::new(),
            rebuilding: Vec::new(),
            done: HashMap::new(),
            journal,
            checksum,
            deaths: 0,
            seen: Seen::default(),
        })
    }

    fn record(&mut self, at: i64, record: Record) {
        let (text, checksum) = write(&Line::new(Time::from_micros(at), record), self.checksum);
        self.journal.push_str(&text);
        self.checksum = checksum;
    }

    /// A part of what may be late in all: waking up, failing twice, waiting to try again.
    fn soon(&mut self) -> i64 {
        self.random.i64(0..=self.world.slow / 12)
    }

    fn live(&mut self) -> Result<(), String> {
        let network = self.network.clone();
        let mut nature = Nature::new(&network, Temper::Random, self.random.u64(..), &[]);
        let mut now = 0;
        self.perform(now, &mut nature)?;
        for _ in 0..100_000 {
            if self.executive.is_over() {
                return Ok(());
            }
            if self.random.u32(0..100) < self.world.dies {
                self.die(now)?;
                self.perform(now, &mut nature)?;
            }
            if self.random.u32(0..20) == 0
                && self.executive.poll_timeout().is_none_or(|t| t.as_micros() > now)
            {
                self.rumour(now);
                self.perform(now, &mut nature)?;
            }
            let timeout = self.executive.poll_timeout().map(|time| time.as_micros());
            let coming = self.coming.peek().map(|Reverse((time, _))| *time);
            let rebuilt = self.rebuilding.iter().map(|(time, _)| *time).min();
            let Some(next) = [timeout, coming, rebuilt].into_iter().flatten().min() else {
                return Err("nothing is due and nothing will be, but the mission is not over".into());
            };
            now = now.max(next);
            if timeout == Some(next) {
                // The world does not stop while we oversleep.
                let late = self.soon();
                now = match coming.into_iter().chain(rebuilt).min() {
                    Some(other) => (now + late).min(other.max(now)),
                    None => now + late,
                };
                self.happens(now, Input::Timeout {});
            } else if coming == Some(next) {
                let Reverse((arrived, coming)) = self.coming.pop().unwrap();
                self.take(now, arrived, coming)?;
            } else if let Some(at) = self.rebuilding.iter().position(|(time, _)| rebuilt == Some(*time)) {
                let (_, rebuild) = self.rebuilding.remove(at);
                self.happens(now, Input::rebuilt(rebuild.run()));
            }
            self.perform(now, &mut nature)?;
        }
        Err("the mission does not end".into())
    }

    /// Somebody reports what cannot have happened yet.
    fn rumour(&mut self, now: i64) {
        let waiting = |event: &EventId| {
            self.network.link_of(*event).is_some() && self.executive.dispatcher().happened(*event).is_none()
        };
        let Some(event) = self.network.event_ids().find(waiting) else { return };
        if self.executive.dispatcher().is_in_flight(self.executive.dispatcher().root(event)) {
            return;
        }
        // What was due just before may have begun it, and it is broken by now; no matter for this test.
        self.happens(now, Input::observed(&self.network, event));
    }

    /// Something happens, and is on record.
    fn happens(&mut self, at: i64, input: Input) -> Handled {
        let handled = self.executive.handle(Time::from_micros(at), input);
        if let Some(input) = &handled.record {
            self.record(at, Record::In(input.clone()));
        }
        handled
    }

    fn take(&mut self, now: i64, arrived: i64, coming: Coming) -> Result<(), String> {
        match coming {
            Coming::News(event) => {
                match self.happens(arrived, Input::observed(&self.network, event)).answer {
                    Answer::Accepted | Answer::Ignored(Why::ObservedBefore) => {}
                    Answer::Ignored(why) if !self.executive.is_over() && self.world.lies == 0 => {
                        let name = self.network.id(event);
                        return Err(format!("news of {name} at {arrived} was ignored: {why}"));
                    }
                    Answer::Ignored(_) => {}
                }
                if self.random.u32(0..4) == 0 {
                    let again = self.happens(arrived, Input::observed(&self.network, event));
                    assert!(!again.is_accepted(), "{again:?}");
                }
            }
            Coming::Answer { id, good: true, lost: false } => {
                self.confirmed.insert(id.clone());
                self.happens(now, Input::Executed { id, ago: None });
            }
            Coming::Answer { id, lost, .. } => {
                self.happens(now, Input::Failed { id, reason: "no".into(), doubt: lost });
            }
        }
        Ok(())
    }

    /// What is handed over follows nothing that the driver has not confirmed.
    fn nothing_before(&self, name: &str) -> Result<(), String> {
        let event = self.network.find(name).unwrap();
        let ours = |event: EventId| self.network.link_of(event).is_none();
        let open = self.setup.handovers.iter().find(|earlier| {
            let confirmed = self.confirmed.contains(&format!("run/{}", earlier.name));
            ours(event) && ours(earlier.event) && !confirmed && (self.precedes)(earlier.event, event)
        });
        open.map_or(Ok(()), |open| Err(format!("{name} was handed over before {} was confirmed", open.name)))
    }

    fn perform(&mut self, now: i64, nature: &mut Nature) -> Result<(), String> {
        let mut sends = Vec::new();
        while let Some(output) = self.executive.poll_output() {
            match output {
                Output::Send(sending) => {
                    self.nothing_before(&sending.name)?;
                    let (id, due, attempt) = (sending.id.clone(), sending.due, sending.attempt);
                    self.record(now, Record::Out(Trace::Dispatch { id, due, attempt }));
                    sends.push(sending);
                }
                Output::Fixed { event, .. } => {
                    let time = self.executive.dispatcher().known(event).fixed.unwrap().time;
                    let handed = self.setup.handovers.iter().any(|handover| handover.event == event);
                    if self.network.link_of(event).is_none() && (!handed || event == self.network.origin()) {
                        self.comes_true(event, time.as_micros(), nature)?;
                    }
                }
                Output::Warning(text) if self.world.lies == 0 => return Err(text),
                Output::Warning(_) => self.seen.warnings += 1,
                Output::Note(_) => {}
                Output::Over => {
                    let execution = self.executive.execution(Time::from_micros(now), false);
                    self.record(now, Record::Out(Trace::End { execution }));
                }
            }
        }
        for sending in sends {
            if !self.happens(now, Input::Sent { id: sending.id.clone() }).is_accepted() {
                continue;
            }
            let answer = now + self.soon();
            // It never fails more than twice, and never after it was done.
            let known = self.done.contains_key(&sending.id);
            let good = known || sending.attempt > 2 || self.random.u32(0..100) >= self.world.fails;
            let lost = good && sending.attempt < 3 && self.random.u32(0..100) < self.world.lost;
            if good && !known {
                self.done.insert(sending.id.clone(), now);
                let event = self.network.find(&sending.name).unwrap();
                let of_event = |id: &str| id == format!("run/{}", sending.name);
                let last = self.setup.handovers.iter().filter(|h| h.event == event).all(|h| {
                    of_event(&format!("run/{}", h.name)) || self.done.contains_key(&format!("run/{}", h.name))
                });
                if last && self.network.link_of(event).is_none() && event != self.network.origin() {
                    self.comes_true(event, now, nature)?;
                }
            }
            self.coming.push(Reverse((answer, Coming::Answer { id: sending.id, good, lost })));
        }
        if let Some(rebuild) = self.executive.poll_rebuild(Time::from_micros(now)) {
            let ready = now + self.soon();
            self.rebuilding.push((ready, rebuild));
        }
        Ok(())
    }

    /// An executable event really happens, and with it all that follows.
    fn comes_true(&mut self, event: EventId, time: i64, nature: &mut Nature) -> Result<(), String> {
        self.truth[event.index()] = Some(time);
        for deed in nature.begin(event, Time::from_micros(time)).map_err(|error| format!("{error:?}"))? {
            self.truth[deed.event.index()] = Some(deed.truth.as_micros());
            if let Some(news) = deed.observed {
                let lie = self.random.u32(0..100) < self.world.lies;
                let wrong = if lie { self.random.i64(-3_000_000..30_000_000) } else { 0 };
                self.coming.push(Reverse(((news.as_micros() + wrong).max(time), Coming::News(deed.event))));
            }
        }
        Ok(())
    }

    /// The process dies, and another goes on from the journal.
    fn die(&mut self, now: i64) -> Result<(), String> {
        self.deaths += 1;
        let before = self.executive.execution(Time::from_micros(now), true);
        let mut bytes = self.journal.clone().into_bytes();
        // The last record may be torn.
        bytes.extend_from_slice(&b"0123abcd {\"at\":"[..self.random.usize(0..15)]);
        let journal = read(&bytes).map_err(|bad| bad.to_string())?;
        assert_eq!(journal.length, self.journal.len());
        let replayed = replay(&journal, |_, _, _| {}).map_err(|bad| format!("{bad}\n{}", self.journal))?;
        let after = replayed.executive.execution(Time::from_micros(now), true);
        if before != after {
            return Err(format!("the journal leads elsewhere:\n{before:#?}\n{after:#?}\n{}", self.journal));
        }
        assert!(replayed.unsent.is_empty());
        let recovered = recover(&journal).map_err(|bad| format!("{bad}\n{}", self.journal))?;
        self.seen.recoveries += u32::from(
            journal
                .lines
                .iter()
                .any(|line| matches!(&line.record, Record::In(Input::Rebuilt { known: Some(_), .. }))),
        );
        // Bit for bit, as far as it can be seen; line by line only where there is a difference, as that takes its time.
        if format!("{recovered:?}") != format!("{replayed:?}") {
            let differences = differences(&format!("{recovered:#?}"), &format!("{replayed:#?}"));
            return Err(format!("recovering leads elsewhere:\n{differences}\n{}", self.journal));
        }
        self.executive = recovered.executive;
        self.rebuilding.clear();
        if !self.executive.is_over() {
            // Answers that were under way are lost with the process; news is brought again until it is taken.
            self.coming.retain(|Reverse((_, coming))| matches!(coming, Coming::News(_)));
            let clocks = Clocks { boot: None, since_boot: 0, calendar: 0 };
            self.record(now, Record::Out(Trace::Back { clocks }));
            self.happens(now, Input::Resumed { unsent: Vec::new() });
        }
        Ok(())
    }

    /// What is wrong with how it ended.
    fn problem(&self) -> Option<String> {
        if self.world.lies > 0 {
            return None;
        }
        let execution = self.executive.execution(Time::ZERO, false);
        if execution.outcome != Outcome::Completed {
            return Some(format!("{:?}", execution.failure));
        }
        for requirement in self.network.requirements() {
            let (Some(from), Some(to)) =
                (self.truth[requirement.from.index()], self.truth[requirement.to.index()])
            else {
                return Some(format!("{requirement:?} has an end that never happened"));
            };
            let length = to - from;
            // Each end may be as late as is allowed, and so may news be that Nature sends on time.
            let slack = 2 * (self.world.slow + self.world.lead);
            let low = requirement.lower.finite().is_some_and(|lower| length < lower.as_micros() - slack);
            let high = requirement.upper.finite().is_some_and(|upper| length > upper.as_micros() + slack);
            if low || high {
                return Some(format!("{requirement:?} has length {length}"));
            }
        }
        if let Some(violation) = verify(&self.network, &execution).first() {
            return Some(format!("verify: {violation:?}"));
        }
        None
    }
}

/// The lines in which two texts differ.
fn differences(ours: &str, theirs: &str) -> String {
    let lines = ours.lines().zip(theirs.lines()).enumerate().filter(|(_, (our, their))| our != their);
    lines.take(20).map(|(at, (our, their))| format!("{at}: {our} | {their}\n")).collect()
}

/// Lives through a mission, and says what is wrong with it.
fn problem(
    network: &Network,
    strategy: Strategy,
    world: World,
    seed: u64,
    seen: &mut Seen,
) -> Option<String> {
    let mut life = Life::new(network, strategy, world, seed)?;
    let lived = life.live().err().or_else(|| life.problem());
    seen.recoveries += life.seen.recoveries;
    seen.warnings += life.seen.warnings;
    let told = |problem: String| format!("{problem}\n{}", life.journal);
    lived.map(told).or_else(|| {
        // The whole of it once more.
        let journal = read(life.journal.as_bytes()).unwrap();
        let replayed = replay(&journal, |_, _, _| {}).map_err(|bad| format!("{bad}\n{}", life.journal));
        match replayed {
            Err(problem) => Some(problem),
            Ok(replayed) => {
                let (ours, theirs) = (
                    life.executive.execution(Time::ZERO, true),
                    replayed.executive.execution(Time::ZERO, true),
                );
                (ours != theirs).then(|| format!("{ours:?}\n{theirs:?}"))
            }
        }
    })
}

fn missions_hold(world: World, usual: u64) -> Seen {
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    all_hold(|seed| random::network(seed, &shapes[(seed % 4) as usize]), world, usual)
}

/// Missions of several agents who have to wait for one another, so that early news makes a difference to much.
fn coupled(seed: u64) -> Network {
    let delay = Exponential { lambda: 0.3, lambda_is: Lambda::Mean };
    let sampled =
        SamplingOptions { scan_delay: delay, message_delay: delay, traverse: generate::Link::Requirement };
    let one = |seed| match seed % 3 {
        0 => lanes(3, 6, seed, &LaneOptions { links: 60, slack: 400, delay: 9, ..LaneOptions::default() }),
        1 => repeaters(2, 3, seed, &RepeaterOptions { delay, ..RepeaterOptions::default() }),
        _ => sampling(2, 3, seed, &sampled),
    };
    controllable(one, seed).unwrap().unwrap().1
}

fn all_hold(make: impl Fn(u64) -> Network, world: World, usual: u64) -> Seen {
    let (mut lived, mut controllable, mut seen) = (0, 0, Seen::default());
    for seed in 0..cases(usual) {
        let network = make(seed);
        controllable += u64::from(Plan::new(&network).is_ok());
        for strategy in [Strategy::Optimistic, Strategy::Buffer] {
            lived += 1;
            if let Some(found) = problem(&network, strategy, world, seed, &mut seen) {
                let again = |network: &Network| problem(network, strategy, world, seed, &mut Seen::default());
                let small = random::shrunk(&network, |candidate| again(candidate).is_some());
                let shrunk = again(&small).unwrap_or_default();
                panic!(
                    "seed {seed} {strategy:?}: {found}\n{}\nshrinks to\n{}\n{shrunk}",
                    random::describe(&network),
                    random::describe(&small)
                );
            }
        }
    }
    assert!(lived > 0 && controllable * 4 > cases(usual), "too few are controllable: {controllable}");
    seen
}

#[test]
fn with_a_driver_that_confirms_at_once_missions_hold_to_the_microsecond() {
    missions_hold(World { slow: 0, fails: 0, dies: 0, ..World::default() }, 500);
}

#[test]
fn whatever_is_late_within_bounds_missions_hold_within_them() {
    missions_hold(World { slow: 90_000, fails: 0, dies: 0, ..World::default() }, 500);
}

#[test]
fn a_process_that_dies_at_any_step_goes_on_as_if_nothing_had_happened() {
    missions_hold(World { slow: 0, dies: 30, ..World::default() }, 300);
    missions_hold(World { slow: 90_000, dies: 30, ..World::default() }, 300);
}

#[test]
fn a_process_that_dies_goes_on_with_the_last_of_many_plans() {
    for slow in [0, 90_000] {
        let seen = all_hold(coupled, World { slow, dies: 10, ..World::default() }, 50);
        assert!(u64::from(seen.recoveries) > cases(50), "{seen:?}");
    }
}

#[test]
fn an_attempt_that_fails_is_made_again() {
    missions_hold(World { slow: 90_000, fails: 30, dies: 10, ..World::default() }, 300);
}

#[test]
fn what_nobody_has_to_execute_happens_on_time_however_late_the_clock_is_looked_at() {
    for slow in [0, 90_000] {
        missions_hold(World { slow, nobodys: 50, dies: 10, ..World::default() }, 300);
        missions_hold(World { slow, nobodys: 100, ..World::default() }, 100);
    }
}

#[test]
fn an_answer_that_is_lost_does_not_move_what_was_done() {
    missions_hold(World { slow: 90_000, lost: 30, ..World::default() }, 300);
}

#[test]
fn what_is_handed_over_early_is_recorded_when_the_requirements_hold() {
    missions_hold(World { lead: 500_000, ..World::default() }, 500);
    missions_hold(World { slow: 90_000, lead: 500_000, dies: 10, ..World::default() }, 300);
}

#[test]
fn the_journal_of_a_mission_whose_model_is_broken_leads_to_the_same_state() {
    for slow in [0, 90_000] {
        let world = World { slow, fails: 10, dies: 10, lies: 20, ..World::default() };
        missions_hold(world, 200);
        let seen = all_hold(coupled, world, 50);
        assert!(u64::from(seen.recoveries.min(seen.warnings)) > cases(50), "{seen:?}");
    }
}

#[test]
#[expect(clippy::disallowed_methods, reason = "the core has no clock, but a test may look at one")]
fn going_on_makes_one_plan_however_many_were_made() {
    let options = LaneOptions { links: 60, slack: 400, delay: 9, ..LaneOptions::default() };
    let (_, network) = controllable(|seed| lanes(5, 60, seed, &options), 0).unwrap().unwrap();
    let mut life = Life::new(&network, Strategy::Optimistic, World::default(), 0).unwrap();
    life.live().unwrap();
    let journal = read(life.journal.as_bytes()).unwrap();
    let plans =
        journal.lines.iter().filter(|line| matches!(line.record, Record::In(Input::Rebuilt { .. }))).count();
    let begun = Instant::now();
    let recovered = recover(&journal).unwrap();
    let recovering = begun.elapsed();
    let replayed = replay(&journal, |_, _, _| {}).unwrap();
    let replaying = begun.elapsed() - recovering;
    assert_eq!(format!("{recovered:?}"), format!("{replayed:?}"));
    assert!(plans > 50 && recovering * 5 < replaying, "{plans} plans, {recovering:?}, {replaying:?}");
}
