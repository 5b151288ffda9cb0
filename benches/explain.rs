//! How long it takes to say why not, what would fix it, and how much is left.

#![allow(clippy::unwrap_used, reason = "a benchmark may fail")]

use std::fs;
use std::path::Path;
use std::sync::Arc;

use divan::{Bencher, black_box};
use kirk::compiler::repair::{Wishes, proposals};
use kirk::{Explain, Options, Source, compile};
use kirk_lsp::{Shift, View, analyse, hover, judge};
use kirk_network::generate::{Exponential, Lambda, Link, SamplingOptions, controllable, sampling};
use kirk_network::slack::{bounds, slack};
use kirk_network::vary::Knob;
use kirk_network::{Network, rmpl};

fn main() {
    divan::main();
}

/// The missions that cannot be promised.
fn gallery() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rmpl/gallery");
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn source(name: &str) -> Source {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/rmpl/gallery/{name}.rmpl"));
    Source::new(name, fs::read_to_string(path).unwrap())
}

fn public(name: &str) -> Network {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/networks/{name}.json"));
    kirk_network::json::read(&fs::read_to_string(path).unwrap()).unwrap()
}

/// All conflicts of a mission, with all amounts that would be enough.
#[divan::bench(args = gallery())]
fn why_not(bencher: Bencher<'_, '_>, name: &str) {
    let sources = [source(name)];
    let mission = compile(&sources, &Options::default()).lowered.unwrap();
    bencher.bench_local(|| Explain::of(black_box(&mission), &sources).all().unwrap().len());
}

/// All proposals for a mission, without the proof of the edited source.
#[divan::bench(args = gallery())]
fn repair(bencher: Bencher<'_, '_>, name: &str) {
    let sources = [source(name)];
    let mission = compile(&sources, &Options::default()).lowered.unwrap();
    let wishes = Wishes::default();
    bencher
        .bench_local(|| proposals(black_box(&mission.network), &mission.origins, &sources, &wishes).unwrap());
}

/// How far every bound of a network can move.
#[divan::bench(args = ["lane500_dc_000"], sample_count = 3)]
fn slack_of_every_bound(bencher: Bencher<'_, '_>, name: &str) {
    let network = public(name);
    let knobs: Vec<Knob> = bounds(&network);
    bencher.bench_local(|| slack(black_box(&network), &knobs).unwrap().map(|all| all.len()));
}

/// The mission of 2,000 lines that `benches/editing.rs` types in.
fn sampling_mission() -> String {
    let delay = Exponential { lambda: 0.3, lambda_is: Lambda::Mean };
    let options = SamplingOptions { scan_delay: delay, message_delay: delay, traverse: Link::Requirement };
    let (_, network) = controllable(|seed| sampling(4, 26, seed, &options), 0).unwrap().unwrap();
    rmpl::write(&network)
}

/// What an editor shows of one activity in a mission of 2,000 lines.
#[divan::bench(args = ["(scan", "(message"])]
fn hover_of_an_activity(bencher: Bencher<'_, '_>, name: &str) {
    let text = sampling_mission();
    let (analysis, unjudged) = analyse(text.clone());
    let (missions, _) = judge(unjudged);
    let view = View { analysis: Arc::new(analysis), missions: Arc::new(missions), shift: Shift::default() };
    let offset = text.rfind(name).unwrap() as u32 + 1;
    assert!(hover(&view, offset).unwrap().markdown.contains("as late as"));
    bencher.bench_local(|| hover(black_box(&view), offset).map(|hover| hover.markdown.len()));
}
