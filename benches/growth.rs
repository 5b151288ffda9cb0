//! How times grow with the size of generated networks: `cargo bench --bench growth`.

mod work;

use divan::{Bencher, black_box};
use work::{Family, Lanes, Repeaters, Sampling};

fn main() {
    divan::main();
}

const EVENTS: &[u32] = &[50, 100, 200, 500, 1000, 2000, 5000, 10_000];

/// The dispatchable form has an edge for most pairs of events that matter to each other.
const FEWER_EVENTS: &[u32] = &[50, 100, 200, 500, 1000, 2000];

/// The verdict alone, in memory.
#[divan::bench(types = [Repeaters, Sampling, Lanes], args = EVENTS)]
fn check<F: Family>(bencher: Bencher<'_, '_>, events: u32) {
    let network = F::network(events);
    bencher.bench_local(|| work::decide(black_box(&network)));
}

/// From the network to its dispatchable form.
#[divan::bench(types = [Repeaters, Sampling, Lanes], args = FEWER_EVENTS)]
fn dispatchable<F: Family>(bencher: Bencher<'_, '_>, events: u32) {
    let network = F::network(events);
    bencher.bench_local(|| work::compile(black_box(&network)));
}

/// A whole execution in virtual time, with the record of it.
#[divan::bench(types = [Repeaters, Sampling, Lanes], args = FEWER_EVENTS)]
fn execute<F: Family>(bencher: Bencher<'_, '_>, events: u32) {
    let plan = plan::<F>(events);
    bencher.bench_local(|| work::execute(black_box(&plan)));
}

/// Planning anew with half the events executed.
#[divan::bench(types = [Repeaters, Sampling, Lanes], args = FEWER_EVENTS)]
fn rebuild<F: Family>(bencher: Bencher<'_, '_>, events: u32) {
    let plan = plan::<F>(events);
    let progress = work::halfway(&plan);
    bencher.bench_local(|| work::rebuild(black_box(&plan), &progress));
}

fn plan<F: Family>(events: u32) -> kirk_runtime::Plan {
    match kirk_runtime::Plan::new(&F::network(events)) {
        Ok(plan) => plan,
        Err(error) => unreachable!("the family gives controllable networks: {error:?}"),
    }
}
