//! Whatever bytes a file has, the whole way of `check` gives a result: a verdict, or messages in places of the file.
//!
//! The other half is in `fuzz/`. What fuzzing found is in `tests/crashes`, and stays.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::fs;
use std::sync::LazyLock;

use kirk_compiler::{Explain, Options, Severity, Source, compile};
use kirk_network::json::ReadProblem;
use kirk_network::{Network, check, graphml, json, plain};
use kirk_runtime::{Execution, verify};
use proptest::prelude::*;

/// What `kirk check` does with a program, without the terminal.
fn check_program(text: &str) {
    let sources = [Source::new("x", text)];
    let compiled = compile(&sources, &Options::default());
    let mut said = compiled.diagnostics;
    assert_eq!(compiled.lowered.is_none(), said.iter().any(|d| d.severity == Severity::Error), "{text}");
    if let Some(plan) = compiled.lowered
        && let Ok(told) = Explain::of(&plan, &sources).all()
    {
        said.extend(told);
    }
    for diagnostic in &said {
        for span in diagnostic.labels.iter().map(|label| label.span).chain([diagnostic.span]) {
            assert!(text.get(span.start as usize..span.end as usize).is_some(), "{diagnostic:?}");
        }
    }
}

type Reader = fn(&str) -> Result<Network, Vec<ReadProblem>>;
const READERS: [(&str, Reader); 3] =
    [("json", json::read), ("stnu", graphml::read), ("plainstnu", plain::read)];

/// What it does with a network: read or refused; what is read can be decided, written, and read again.
fn check_network(text: &str, reader: Reader) {
    match reader(text) {
        Ok(network) => {
            let _ = check(&network);
            let again = json::read(&json::write(&network)).expect("what was written can be read");
            assert_eq!(again.requirements(), network.requirements());
        }
        Err(problems) => {
            assert!(!problems.is_empty(), "refused without a reason");
            assert!(problems.iter().all(|problem| text.is_char_boundary(problem.offset)), "{problems:?}");
        }
    }
}

/// The files of a directory with one of these extensions, the smaller ones.
fn files(folder: &str, extensions: &[&str]) -> Vec<String> {
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| extensions.contains(&e.to_str().unwrap())))
        .collect();
    found.sort();
    let texts = found.iter().map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned());
    texts.filter(|text| text.len() < 50_000).collect()
}

static MISSIONS: LazyLock<Vec<String>> =
    LazyLock::new(|| [files("examples/rmpl", &["rmpl"]), files("tests/rmpl/good", &["rmpl"])].concat());
/// For each reader what it is made for.
static NETWORKS: LazyLock<[Vec<String>; 3]> =
    LazyLock::new(|| READERS.map(|(extension, _)| files("tests/networks", &[extension])));
static ROBOT: LazyLock<(Network, String)> = LazyLock::new(|| {
    let mission = fs::read_to_string("examples/rmpl/robot.rmpl").unwrap();
    let network = compile(&[Source::new("x", mission)], &Options::default()).lowered.unwrap().network;
    let plan = kirk_runtime::Plan::new(&network).unwrap();
    let execution = kirk_runtime::simulate(&plan, "main", &kirk_runtime::Simulation::default()).unwrap();
    (network, serde_json::to_string(&execution).unwrap())
});

/// A text with some bytes in the place of others.
fn spliced(text: &str, at: prop::sample::Index, length: usize, bytes: &[u8]) -> String {
    let at = at.index(text.len() + 1);
    let end = (at + length).min(text.len());
    let bytes = [&text.as_bytes()[..at], bytes, &text.as_bytes()[end..]].concat();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn what_once_crashed_gives_a_result() {
    for text in files("tests/crashes", &["rmpl"]) {
        check_program(&text);
    }
    for (extension, reader) in READERS {
        for text in files("tests/crashes", &[extension]) {
            check_network(&text, reader);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn any_bytes_give_a_result(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let text = String::from_utf8_lossy(&bytes);
        check_program(&text);
        for (_, reader) in READERS {
            check_network(&text, reader);
        }
    }

    #[test]
    fn a_mission_with_any_bytes_in_it_gives_a_result(
        which in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
        length in 0..40_usize,
        bytes in prop::collection::vec(any::<u8>(), 0..10),
    ) {
        check_program(&spliced(&MISSIONS[which.index(MISSIONS.len())], at, length, &bytes));
    }

    #[test]
    fn a_network_with_any_bytes_in_it_gives_a_result(
        which in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
        length in 0..40_usize,
        bytes in prop_oneof![
            prop::collection::vec(any::<u8>(), 0..10),
            "[0-9a-zA-Z\"{}\\[\\],:<>/ \n-]{0,10}".prop_map(String::into_bytes),
        ],
    ) {
        for ((_, reader), networks) in READERS.iter().zip(NETWORKS.iter()) {
            check_network(&spliced(&networks[which.index(networks.len())], at, length, &bytes), *reader);
        }
    }

    #[test]
    fn a_record_with_any_bytes_in_it_is_refused_or_verified(
        at in any::<prop::sample::Index>(),
        length in 0..10_usize,
        bytes in "[0-9a-z\"{}\\[\\],:. -]{0,8}",
    ) {
        let (network, record) = &*ROBOT;
        if let Ok(execution) = serde_json::from_str::<Execution>(&spliced(record, at, length, bytes.as_bytes())) {
            verify(network, &execution);
        }
    }
}
