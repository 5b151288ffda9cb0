//! Missions of teams: what is said of them, who executes what, and all of them in one simulation.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::Value;

fn file(name: &str) -> String {
    format!("tests/rmpl/team/{name}.rmpl")
}

/// The one document that a command prints.
fn document(arguments: &[&str]) -> Value {
    let output = kirk(arguments);
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)))
}

#[test]
fn the_verdict_on_a_team_is_yes_with_promises_no_or_not_found() {
    let mut said = String::new();
    for (name, status) in [("drill", 0), ("free", 0), ("not-found", 1), ("no", 1)] {
        let output = kirk(&["check", "--color", "never", &file(name)]);
        assert_eq!(output.status.code(), Some(status), "{name}");
        said.push_str(&format!("{}{}\n", stdout(&output), stderr(&output)));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn what_is_not_found_is_said_to_programs_with_what_would_do() {
    let document = document(&["check", "--format", "json", &file("not-found")]);
    assert_eq!(document["controllable"], false);
    let team = &document["team"];
    assert_eq!((&team["verdict"], &team["missing"]["lacks"]), (&"not-found".into(), &1.into()));
    let link = serde_json::json!([{"from": "astronaut", "to": "robot", "max_delay": 14}]);
    assert_eq!(team["missing"]["remedies"], link);
    assert_eq!(document["diagnostics"][0]["code"], "K0602");
}

#[test]
fn a_between_fixes_a_promise_and_programs_read_it() {
    let promise = |name: &str| {
        let document = document(&["check", "--format", "json", &file(name)]);
        let promises = document["team"]["promises"].as_array().unwrap().clone();
        promises.into_iter().find(|it| it["event"] == "drill:start").unwrap()
    };
    let fixed = promise("drill");
    let wanted = serde_json::json!({"agent": "robot", "event": "drill:start", "base": "downlink:end", "lower": 5, "upper": 15,
        "heard": [{"agent": "astronaut", "delay": [0, 1]}]});
    assert_eq!(fixed, wanted);
    assert_eq!((&promise("free")["base"], &promise("free")["upper"]), (&"main:start".into(), &30.into()));
}

#[test]
fn the_examples_of_the_page_on_missing_promises_are_true() {
    let page = kirk::compiler::explain("K0602").unwrap();
    for (title, status, code) in [("Wrong", 1, true), ("Right", 0, false)] {
        let (_, example) = page.split_once(&format!("\n{title}:\n\n")).unwrap();
        let example: Vec<&str> =
            example.lines().take_while(|line| line.is_empty() || line.starts_with("    ")).collect();
        let output = kirk_with_input(&["check", "-"], example.join("\n").as_bytes());
        assert_eq!(output.status.code(), Some(status), "{title}");
        assert_eq!(stderr(&output).contains("K0602"), code, "{title}");
    }
}

#[test]
fn what_knows_one_executive_refuses_a_team() {
    let drill = file("drill");
    for arguments in [
        vec!["slack", &drill],
        vec!["repair", &drill],
        vec!["query", &drill],
        vec!["check", "--delays", "zero", &drill],
        vec!["compile", "--emit", "dispatchable", &drill],
    ] {
        let output = kirk(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains("error[K0705]"), "{arguments:?}: {}", stderr(&output));
    }
}
