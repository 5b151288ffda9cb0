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
fn records_for_programs_do_not_say_why() {
    let output = kirk(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--why", "--format", "json"]);
    assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(2), ""));
    assert!(stderr(&output).contains("`--why` adds a column to the timetable"), "{}", stderr(&output));
}
