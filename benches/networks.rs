//! The public benchmark networks: `cargo bench --bench networks`.
//!
//! `heat_dynamic` and `j10_PSP` are groups of 60 and 25 networks; their times are for all of them together.

mod work;

use divan::{Bencher, black_box};

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
