//! What is measured, and on which networks.

#![allow(dead_code, unreachable_pub, reason = "each benchmark uses only some of it")]
#![allow(clippy::unwrap_used, reason = "a benchmark may fail")]

use std::fs;
use std::path::Path;

use kirk_network::controllability::is_controllable;
use kirk_network::generate::{
    Exponential, GenerateError, Lambda, LaneOptions, RepeaterOptions, SamplingOptions, controllable, lanes,
    repeaters, sampling,
};
use kirk_network::merge::merge;
use kirk_network::precedence::Precedence;
use kirk_network::reduce::{Progress, reduce, reduce_rest};
use kirk_network::{Dispatchable, Interval, Network, Time, dispatchable, json};
use kirk_runtime::{Execution, Plan, Simulation, Strategy, Temper, simulate};

/// The public networks of `tests/networks` whose names start so: those without a number are groups of many.
pub const CONTROLLABLE: &[&str] = &[
    "heat_dynamic",
    "j10_PSP",
    "lane50_dc",
    "rnd200_dc",
    "tree400_dc",
    "lane500_dc",
    "lane1000_dc",
    "lane2000_dc",
];

/// The same of networks that are not controllable.
pub const NOT_CONTROLLABLE: &[&str] =
    &["lane50_notDC", "rnd200_notDC", "tree400_notDC", "lane500_notDC", "lane1000_notDC", "lane2000_notDC"];

/// All networks whose names start with `group`.
pub fn public(group: &str) -> Vec<Network> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/networks");
    let mut files: Vec<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.starts_with(group) && name.ends_with(".json"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no network is called {group}");
    files.iter().map(|file| json::read(&fs::read_to_string(folder.join(file)).unwrap()).unwrap()).collect()
}

/// The networks of `group` that are controllable, ready to be executed.
pub fn plans(group: &str) -> Vec<Plan> {
    public(group).iter().filter_map(|network| Plan::new(network).ok()).collect()
}

/// A family of generated networks.
pub trait Family {
    /// A controllable member with about so many events.
    fn network(events: u32) -> Network;
}

/// Four rovers, news of 0.3 s on average, so that large ones are controllable too.
pub struct Repeaters;

impl Family for Repeaters {
    fn network(events: u32) -> Network {
        let tasks = (events / 16).max(1);
        let delay = Exponential { lambda: 0.3, lambda_is: Lambda::Mean };
        let options = RepeaterOptions { delay, spare: tasks / 2 + 1, ..RepeaterOptions::default() };
        first(|seed| repeaters(4, tasks, seed, &options))
    }
}

/// Four astronauts who decide how long their ways take; news of 0.3 s on average.
pub struct Sampling;

impl Family for Sampling {
    fn network(events: u32) -> Network {
        let tasks = (events / 20).max(1);
        let delay = Exponential { lambda: 0.3, lambda_is: Lambda::Mean };
        let traverse = kirk_network::generate::Link::Requirement;
        let options = SamplingOptions { scan_delay: delay, message_delay: delay, traverse };
        first(|seed| sampling(4, tasks, seed, &options))
    }
}

/// Five lanes, no delays.
pub struct Lanes;

impl Family for Lanes {
    fn network(events: u32) -> Network {
        let options = LaneOptions { slack: 400, ..LaneOptions::default() };
        first(|seed| lanes(5, events / 10, seed, &options))
    }
}

fn first(make: impl Fn(u64) -> Result<Network, GenerateError>) -> Network {
    controllable(make, 0).unwrap().expect("one of the first thousand").1
}

/// The verdict alone: merge, reduce, decide.
pub fn decide(network: &Network) -> bool {
    reduce(&merge(network).network).is_ok_and(|reduction| is_controllable(&reduction.stnu).unwrap())
}

/// From a network to its dispatchable form.
pub fn compile(network: &Network) -> Dispatchable {
    let merged = merge(network).network;
    dispatchable(&reduce(&merged).unwrap(), &Precedence::new(&merged)).unwrap().unwrap()
}

/// A whole execution, with a random Nature.
pub fn execute(plan: &Plan) -> Execution {
    let simulation = Simulation {
        strategy: Strategy::Buffer,
        nature: Temper::Random,
        seed: 1,
        observations: Vec::new(),
        internal: true,
        what_if: false,
    };
    simulate(plan, "benchmark", &simulation).unwrap()
}

/// The moment at which half the events of an execution have happened.
pub fn halfway(plan: &Plan) -> Progress {
    let network = plan.network();
    let mut known: Vec<Option<Interval>> = vec![None; network.events().len()];
    let mut truths: Vec<(Time, usize)> = execute(plan)
        .rows
        .iter()
        .filter_map(|row| Some((row.truth.or(row.time)?, network.find(&row.event)?.index())))
        .collect();
    truths.sort();
    let now = truths[truths.len() / 2].0;
    for &(time, event) in truths.iter().filter(|(time, _)| *time <= now) {
        known[event] = Some(Interval::at(time));
    }
    Progress { now, known }
}

/// The plan of what is left, as after news that came early.
pub fn rebuild(plan: &Plan, progress: &Progress) -> Dispatchable {
    let reduction = reduce_rest(plan.network(), progress).unwrap();
    dispatchable(&reduction, plan.precedence()).unwrap().unwrap()
}
