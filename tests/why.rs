//! `kirk run --why`: what decided each time, in words.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};

fn why(arguments: &[&str]) -> String {
    let output = kirk(&[&["run", "--simulate", "--why", "--quiet"], arguments].concat());
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{arguments:?}");
    stdout(&output)
}

#[test]
fn news_that_is_planned_with_held_and_missing() {
    let heard = ["examples/rmpl/robot.rmpl", "--observe", "human-downlink-science:end@22"];
    let mut all = why(&heard);
    all.push_str(&why(&[&heard[..], &["--strategy", "buffer"]].concat()));
    all.push_str(&why(&["examples/rmpl/robot.rmpl"]));
    insta::assert_snapshot!(all);
}

#[test]
fn orders_and_distances() {
    insta::assert_snapshot!(why(&["examples/rmpl/morning-lecture.rmpl"]));
}

/// `c` is to come no more than 5 s before `b`, so it waits for news of `b` for as long as that can come later.
#[test]
fn a_wait_runs_out_or_ends_with_the_news() {
    let network = br#"{"format": "kirk-network/1", "name": "n", "origin": "a", "events": ["a", "b", "c"],
        "requirements": [{"from": "c", "to": "b", "upper": 5}],
        "contingents": [{"from": "a", "to": "b", "lower": 10, "upper": 40}]}"#;
    let run = |observe: &[&str]| {
        let arguments = [&["run", "-", "--simulate", "--why", "--quiet"], observe].concat();
        let output = kirk_with_input(&arguments, network);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    let (silent, heard) = (run(&[]), run(&["--observe", "b@20"]));
    assert!(silent.contains("35  c      dispatched  no news of `b` by 35 s after the start"), "{silent}");
    assert!(heard.contains("20  c      dispatched  the news of `b`"), "{heard}");
}

#[test]
fn a_mission_in_real_time_says_why_too() {
    let run = ["run", "examples/rmpl/glider.rmpl", "--why", "--quiet", "--speed", "100", "--screen", "never"];
    let output = kirk_with_input(&run, b"");
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    assert!(stdout(&output).contains("dispatched  10 s after `move:start`"), "{}", stdout(&output));
}

#[test]
fn records_say_why_if_that_is_asked_for_and_are_verified_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json").display().to_string();
    let output = kirk(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--why", "--format", "json"]);
    let document: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(document["rows"][0]["because"], "at the start");
    std::fs::write(&record, stdout(&output)).unwrap();
    let verified = kirk(&["verify", &record, "examples/rmpl/robot.rmpl"]);
    assert_eq!(verified.status.code(), Some(0), "{}{}", stdout(&verified), stderr(&verified));
    let plain = kirk(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--format", "json"]);
    assert!(!stdout(&plain).contains("because"));
}

#[test]
fn a_journal_says_why_when_it_is_repeated_and_when_it_is_over() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal").display().to_string();
    let fast = ["--quiet", "--speed", "100", "--screen", "never", "--journal", &journal];
    let run = [&["run", "examples/rmpl/glider.rmpl", "--why"], &fast[..]].concat();
    let (run, replayed, resumed) = (
        kirk_with_input(&run, b""),
        kirk(&["replay", &journal, "--why"]),
        kirk(&["resume", &journal, "--why"]),
    );
    assert!(stdout(&run).contains("10 s after `move:start`"), "{}", stdout(&run));
    assert_eq!(stdout(&replayed), stdout(&run));
    assert_eq!(stdout(&resumed), stdout(&run), "{}", stderr(&resumed));
}
