//! The public benchmark networks under `tests/networks` give their known verdicts, with a proof for every "no".

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test that fails may panic, and reads files"
)]

use std::fs;
use std::path::Path;

use kirk_network::{Verdict, check, json};

#[test]
fn every_benchmark_network_gives_its_known_verdict() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/networks");
    let table = fs::read_to_string(folder.join("verdicts.tsv")).unwrap();
    let mut seen = 0;
    for line in table.lines().skip(1) {
        let (file, rest) = line.split_once('\t').unwrap();
        let verdict = rest.split('\t').next().unwrap();
        let network = json::read(&fs::read_to_string(folder.join(file)).unwrap()).unwrap();
        match (check(&network).unwrap(), verdict) {
            (Verdict::Controllable, "dc") => {}
            (Verdict::Uncontrollable(conflict), "not") => {
                let sum: i64 = conflict.members.iter().map(|share| share.amount.as_micros()).sum();
                assert_eq!(sum, conflict.total.as_micros(), "{file}");
                assert!(sum < 0, "{file}");
                assert!(!conflict.conservative, "{file}: there are no delays");
            }
            (found, known) => panic!("{file}: known as {known}, found {found:?}"),
        }
        seen += 1;
    }
    assert_eq!(seen, 97);
}
