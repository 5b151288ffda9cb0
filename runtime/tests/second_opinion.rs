//! Looking at direct neighbours only is enough: the dispatcher executes every event exactly when FAST-EX, which
//! propagates through the whole closed graph after every event, would execute it.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod fast_ex;
#[path = "../../network/tests/oracle/mod.rs"]
mod oracle;

use fast_ex::{AllMaxEdge, FastEx};
use kirk_network::{Delay, EventId, Network};
use kirk_runtime::{Execution, Plan, Simulation, Temper, simulate};
use oracle::closure::{self, Closed};
use oracle::random::{self, Shape};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

/// The AllMax graph: all that follows, lower-case edges left out.
fn all_max(network: &Network, closed: &Closed) -> Vec<AllMaxEdge> {
    let mut edges = Vec::new();
    for (from, row) in closed.ordinary.iter().enumerate() {
        for (to, &weight) in
            row.iter().enumerate().filter(|&(to, &weight)| to != from && weight != closure::NONE)
        {
            edges.push(AllMaxEdge { from, to, weight, label: None });
        }
    }
    for (link, row) in network.contingents().iter().zip(&closed.upper) {
        let (to, label) = (link.from.index(), Some(link.to.index()));
        for (from, &weight) in
            row.iter().enumerate().filter(|&(from, &weight)| from != to && weight != closure::NONE)
        {
            edges.push(AllMaxEdge { from, to, weight, label });
        }
    }
    edges
}

/// When FAST-EX executes each event if Nature does what she did in `execution`.
fn fast_ex_times(network: &Network, closed: &Closed, execution: &Execution) -> Vec<i64> {
    let truth = |event: EventId| {
        let row = execution.rows.iter().find(|row| row.event == network.id(event)).unwrap();
        row.truth.unwrap().as_micros()
    };
    let mut state = FastEx::new(network.events().len(), network.origin().index(), &all_max(network, closed));
    let mut times = vec![None; network.events().len()];
    times[network.origin().index()] = Some(0);
    let ours = |network: &Network| {
        network.event_ids().filter(|&e| network.link_of(e).is_none()).map(EventId::index).collect::<Vec<_>>()
    };
    loop {
        // The next contingent event whose activation has happened; Nature comes first.
        let nature = network
            .contingents()
            .iter()
            .filter(|link| times[link.to.index()].is_none() && times[link.from.index()].is_some())
            .map(|link| {
                let length = truth(link.to) - truth(link.from);
                (times[link.from.index()].unwrap() + length, link.to.index())
            })
            .min();
        let decision = state.next(ours(network).into_iter());
        let (time, event) = match (nature, decision) {
            (Some(nature), Some(decision)) if nature.0 <= decision.0 => nature,
            (_, Some(decision)) => {
                assert!(decision.0 <= state.latest(decision.1), "FAST-EX misses a window");
                decision
            }
            (Some(nature), None) => nature,
            (None, None) => break,
        };
        times[event] = Some(time);
        state.execute(event, time);
    }
    times.into_iter().map(|time| time.expect("every event happens")).collect()
}

#[test]
fn every_event_is_executed_when_the_full_closure_would() {
    let shapes = [Shape::tiny(), Shape::tiny().chained(), Shape::medium(), Shape::medium().chained()]
        .map(|shape| Shape { fixed: 0, variable: 0, infinite: 0, ..shape });
    let mut compared = 0;
    for seed in 0..cases(2000) {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let Ok(plan) = Plan::new(&random::with_delays(&network, Delay::NONE)) else { continue };
        let network = plan.network();
        let closed = closure::closed(network).expect("the closure agrees that it is controllable");
        for (nature, seed) in [(Temper::Upper, 0), (Temper::Lower, 0), (Temper::Random, seed)] {
            let simulation = Simulation { nature, seed, ..Simulation::default() };
            let execution = simulate(&plan, "random", &simulation).unwrap();
            let times = fast_ex_times(network, &closed, &execution);
            for event in network.event_ids() {
                let row = execution.rows.iter().find(|row| row.event == network.id(event)).unwrap();
                let truth = row.truth.unwrap().as_micros();
                let described = random::describe(network);
                assert_eq!(truth, times[event.index()], "seed {seed} {nature:?}: {}\n{described}", row.event);
            }
            compared += 1;
        }
    }
    assert!(compared > cases(2000), "too few of the networks are controllable");
}
