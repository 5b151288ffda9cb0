//! The public benchmark networks: `cargo bench --bench networks`.
//!
//! `heat_dynamic` and `j10_PSP` are groups of 60 and 25 networks; their times are for all of them together.

#[path = "../runtime/tests/fast_ex/mod.rs"]
mod fast_ex;
mod work;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use divan::{Bencher, black_box};
use fast_ex::{AllMaxEdge, FastEx};
use kirk_network::repair::{Allowed, Options, ours, repairs};
use kirk_network::{Dispatchable, Duration};

fn main() {
    divan::main();
}

/// The verdict alone, in memory.
#[divan::bench(args = work::CONTROLLABLE.iter().chain(work::NOT_CONTROLLABLE))]
fn check(bencher: Bencher<'_, '_>, group: &str) {
    let networks = work::public(group);
    bencher.bench_local(|| networks.iter().filter(|network| work::decide(black_box(network))).count());
}

/// The verdict with a minimal conflict.
#[divan::bench(args = work::NOT_CONTROLLABLE)]
fn conflict(bencher: Bencher<'_, '_>, group: &str) {
    let networks = work::public(group);
    bencher.bench_local(|| {
        networks.iter().filter(|network| kirk_network::check(black_box(network)).is_ok()).count()
    });
}

/// What would make it controllable: five proven changes of what is ours, in whole seconds.
#[divan::bench(args = work::NOT_CONTROLLABLE)]
fn repair(bencher: Bencher<'_, '_>, group: &str) {
    let networks: Vec<_> = work::public(group)
        .into_iter()
        .map(|network| {
            let allowed = |knob| Allowed::relative(&network, knob, Duration::from_secs(1));
            (ours(&network).into_iter().map(allowed).collect::<Vec<_>>(), network)
        })
        .collect();
    bencher.bench_local(|| {
        let count = |(allowed, network): &(Vec<Allowed>, _)| {
            repairs(black_box(network), allowed, &Options::default()).map(|it| it.map(|it| it.repairs.len()))
        };
        networks.iter().filter(|it| count(it).is_ok()).count()
    });
}

/// From the network to its dispatchable form.
#[divan::bench(args = work::CONTROLLABLE)]
fn dispatchable(bencher: Bencher<'_, '_>, group: &str) {
    let networks: Vec<_> = work::public(group).into_iter().filter(work::decide).collect();
    bencher.bench_local(|| {
        networks.iter().map(|network| work::compile(black_box(network)).edges.len()).sum::<usize>()
    });
}

/// A whole execution in virtual time, with the record of it.
#[divan::bench(args = work::CONTROLLABLE)]
fn execute(bencher: Bencher<'_, '_>, group: &str) {
    let plans = work::plans(group);
    bencher.bench_local(|| plans.iter().map(|plan| work::execute(black_box(plan)).rows.len()).sum::<usize>());
}

/// The same events executed by FAST-EX, which the original Delay Kirk uses: the baseline.
#[divan::bench(args = work::CONTROLLABLE)]
fn execute_fast_ex(bencher: Bencher<'_, '_>, group: &str) {
    let nets: Vec<_> = work::public(group).iter().filter(|n| work::decide(n)).map(work::compile).collect();
    bencher.bench_local(|| nets.iter().map(|net| execute_by_fast_ex(black_box(net))).sum::<i64>());
}

/// Executes a dispatchable network with every contingent link at its longest; the time of the last event.
fn execute_by_fast_ex(net: &Dispatchable) -> i64 {
    let plain = |from: u32, to: u32, weight: i64| AllMaxEdge {
        from: from as usize,
        to: to as usize,
        weight,
        label: None,
    };
    let mut edges: Vec<AllMaxEdge> = net.edges.iter().map(|e| plain(e.from, e.to, e.weight)).collect();
    edges.extend((1..net.nodes).map(|node| plain(node, 0, 0)));
    for link in &net.links {
        edges.push(plain(link.activation, link.contingent, link.upper));
        edges.push(plain(link.contingent, link.activation, -link.lower));
        let label = Some(link.contingent as usize);
        edges.push(AllMaxEdge { label, ..plain(link.contingent, link.activation, -link.upper) });
    }
    edges.extend(net.waits.iter().map(|wait| {
        let link = net.links[wait.link as usize];
        let label = Some(link.contingent as usize);
        AllMaxEdge { label, ..plain(wait.waiter, link.activation, wait.weight) }
    }));
    let mut state = FastEx::new(net.nodes as usize, 0, &edges);
    let mut natures = vec![false; net.nodes as usize];
    net.links.iter().for_each(|link| natures[link.contingent as usize] = true);
    let ours: Vec<usize> = (0..net.nodes as usize).filter(|&node| !natures[node]).collect();
    let mut pending: BinaryHeap<Reverse<(i64, usize)>> = BinaryHeap::new();
    let mut last = 0;
    let mut activated = vec![0];
    loop {
        for node in activated.drain(..) {
            for link in net.links.iter().filter(|link| link.activation as usize == node) {
                pending.push(Reverse((last + link.upper, link.contingent as usize)));
            }
        }
        let decision = state.next(ours.iter().copied());
        let (time, node) = match (pending.peek(), decision) {
            (Some(&Reverse(nature)), decision) if decision.is_none_or(|decision| nature.0 <= decision.0) => {
                pending.pop();
                nature
            }
            (_, Some(decision)) => decision,
            _ => return last,
        };
        state.execute(node, time);
        last = time;
        activated.push(node);
    }
}

/// Planning anew with half the events executed.
#[divan::bench(args = work::CONTROLLABLE)]
fn rebuild(bencher: Bencher<'_, '_>, group: &str) {
    let plans: Vec<_> = work::plans(group).into_iter().map(|plan| (work::halfway(&plan), plan)).collect();
    bencher.bench_local(|| {
        plans
            .iter()
            .map(|(progress, plan)| work::rebuild(black_box(plan), progress).edges.len())
            .sum::<usize>()
    });
}
