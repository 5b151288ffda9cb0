//! `check --format sarif`: one log for all files, as editors and code hosts read it.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::{Value, json};

/// Runs a check; its log, and its exit status.
fn log(arguments: &[&str]) -> (Value, Option<i32>) {
    let output = kirk(&[&["check", "--format", "sarif"], arguments].concat());
    assert_eq!(stderr(&output), "", "everything is in the log");
    (serde_json::from_str(&stdout(&output)).unwrap(), output.status.code())
}

#[test]
fn a_log_has_the_rules_the_results_and_the_verdicts() {
    let (mut log, status) = log(&["examples/rmpl/too-late.rmpl", "tests/rmpl/bad/K0302-let-twice.rmpl"]);
    assert_eq!(status, Some(2));
    let run = &mut log["runs"][0];
    for artifact in run["artifacts"].as_array_mut().unwrap() {
        artifact["properties"]["seconds"] = json!("(seconds)");
    }
    run["tool"]["driver"]["semanticVersion"] = json!("(version)");
    insta::assert_snapshot!(serde_json::to_string_pretty(&log).unwrap());
}

#[test]
fn every_bad_program_and_every_unreadable_file_is_in_the_log() {
    let mut files: Vec<String> = std::fs::read_dir("tests/rmpl/bad")
        .unwrap()
        .map(|entry| entry.unwrap().path().to_str().unwrap().to_string())
        .collect();
    files.sort();
    files.extend(
        ["no/such file.rmpl", "examples", "tests/networks/lane50_notDC_000.stnu"].map(str::to_string),
    );
    let arguments: Vec<&str> = files.iter().map(String::as_str).collect();
    let (log, status) = log(&arguments);
    assert_eq!(status, Some(2));
    let run = &log["runs"][0];
    let artifacts = run["artifacts"].as_array().unwrap();
    assert_eq!(artifacts.len(), files.len());
    assert_eq!(artifacts[files.len() - 3]["location"]["uri"], "no/such%20file.rmpl");
    assert_eq!(artifacts[files.len() - 3]["properties"]["controllable"], Value::Null);
    assert_eq!(artifacts[files.len() - 1]["properties"]["controllable"], false);
    let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
    let results = run["results"].as_array().unwrap();
    assert!(results.len() > 400, "only {} results", results.len());
    for result in results {
        let rule = &rules[result["ruleIndex"].as_u64().unwrap() as usize];
        assert_eq!(rule["id"], result["ruleId"]);
        assert!(rule["help"]["text"].as_str().unwrap().starts_with(result["ruleId"].as_str().unwrap()));
        let related = result["relatedLocations"].as_array().unwrap();
        for location in result["locations"].as_array().unwrap().iter().chain(related) {
            let place = &location["physicalLocation"];
            let artifact = &artifacts[place["artifactLocation"]["index"].as_u64().unwrap() as usize];
            assert_eq!(artifact["location"]["uri"], place["artifactLocation"]["uri"]);
            let number = |name: &str| place["region"][name].as_u64().unwrap();
            let start = (number("startLine"), number("startColumn"));
            assert!(start >= (1, 1) && start <= (number("endLine"), number("endColumn")), "{location}");
        }
    }
}

#[test]
fn what_puts_a_problem_right_is_a_fix() {
    let file = "tests/rmpl/bad/K0403-lower-above-upper.rmpl";
    let (log, _) = log(&["tests/rmpl/bad/K0401-ranges.rmpl", file]);
    let results = log["runs"][0]["results"].as_array().unwrap();
    let result = results.iter().find(|result| result["ruleId"] == "K0403").unwrap();
    let region =
        |from: u32, to: u32| json!({"startLine": 2, "startColumn": from, "endLine": 2, "endColumn": to});
    let fix = json!({
        "description": {"text": "Swap the bounds"},
        "artifactChanges": [{
            "artifactLocation": {"uri": file, "index": 1},
            "replacements": [
                {"deletedRegion": region(55, 57), "insertedContent": {"text": "15"}},
                {"deletedRegion": region(71, 73), "insertedContent": {"text": "20"}},
            ],
        }],
    });
    assert_eq!(result["fixes"], json!([fix]));

    let output = kirk(&["check", "--format", "json", file]);
    let checked: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let span =
        |from: u32, to: u32| json!({"start": {"line": 2, "column": from}, "end": {"line": 2, "column": to}});
    let suggestion = json!({
        "title": "Swap the bounds",
        "edits": [
            {"file": file, "span": span(55, 57), "text": "15"},
            {"file": file, "span": span(71, 73), "text": "20"},
        ],
    });
    assert_eq!(checked["diagnostics"][0]["suggestions"], json!([suggestion]));
}

/// Two conflicts that have no bound in common: one of ours, and one of ours with Nature.
const TWICE: &str = "(define-control-program heat ()
  (declare (primitive) (duration (simple :lower-bound 10 :upper-bound 20))))
(define-control-program cool ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 9) :contingent t)))
(define-control-program main ()
  (sequence (:slack t)
    (with-temporal-constraint (simple-temporal :upper-bound 8) (heat))
    (with-temporal-constraint (simple-temporal :upper-bound 7) (cool))))
";

#[test]
fn every_conflict_is_told_to_programs_with_all_that_people_are_told() {
    let output = kirk_with_input(&["check", "--format", "json", "-"], TWICE.as_bytes());
    assert_eq!(output.status.code(), Some(1));
    let checked: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let conflicts = checked["conflicts"].as_array().unwrap();
    let said: Vec<&Value> =
        checked["diagnostics"].as_array().unwrap().iter().filter(|it| it["code"] == "K0601").collect();
    assert_eq!((conflicts.len(), said.len()), (2, 2));
    assert!(conflicts.iter().any(|conflict| conflict["members"] == checked["conflict"]));
    for (conflict, said) in conflicts.iter().zip(said) {
        let amounts = conflict["members"].as_array().unwrap().iter().map(|it| it["amount"].as_f64().unwrap());
        assert_eq!(amounts.sum::<f64>(), conflict["total"].as_f64().unwrap());
        let help = said["help"].as_str().unwrap().replace('\n', " ");
        for step in conflict["story"].as_array().unwrap() {
            assert!(help.contains(step["text"].as_str().unwrap()), "{step}: {help}");
        }
        let needs = conflict["story"].as_array().unwrap().iter().map(|it| it["needs"].as_f64().unwrap());
        assert_eq!(needs.sum::<f64>(), -conflict["total"].as_f64().unwrap());
        let enough = conflict["enough"].as_array().unwrap();
        assert!(enough.iter().all(|it| help.contains(it["title"].as_str().unwrap())), "{help}");
        assert_eq!(enough.len(), said["suggestions"].as_array().unwrap().len());
    }
    let amounts = |at: usize| {
        let enough = conflicts[at]["enough"].as_array().unwrap();
        enough.iter().map(|it| (it["from"].as_f64(), it["to"].as_f64())).collect::<Vec<_>>()
    };
    let heat = usize::from(amounts(0).len() == 1);
    assert_eq!(amounts(heat), [(Some(8.0), Some(10.0)), (Some(10.0), Some(8.0))]);
    assert_eq!(amounts(1 - heat), [(Some(7.0), Some(9.0))]);

    let output = kirk_with_input(&["check", "--format", "sarif", "-"], TWICE.as_bytes());
    let log: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let results = log["runs"][0]["results"].as_array().unwrap();
    let results: Vec<&Value> = results.iter().filter(|it| it["ruleId"] == "K0601").collect();
    assert_eq!(results.len(), 2);
    for (result, conflict) in results.iter().zip(conflicts) {
        assert_eq!(result["properties"]["conflict"], conflict["members"]);
    }
}

#[test]
fn a_no_that_only_an_assumption_makes_is_explained_too() {
    // `c` could come 5 s after `b` in time, were it known which part of the lateness is the duration's and which the news'.
    let network = r#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "c"],
        "requirements": [{"from": "b", "to": "c", "lower": 5, "upper": 10}, {"from": "a", "to": "c", "lower": 0, "upper": 25}],
        "contingents": [{"from": "a", "to": "b", "lower": 5, "upper": 20, "delay": [0, 5]}]}"#;
    let arguments = ["check", "--format", "json", "--delays", "elongated", "-"];
    let output = kirk_with_input(&arguments, network.as_bytes());
    assert_eq!(output.status.code(), Some(1));
    let checked: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked["diagnostics"].as_array().unwrap().len(), 1, "{checked}");
    let said = &checked["diagnostics"][0];
    assert!(
        said["message"].as_str().unwrap().ends_with("if durations and delays are one uncertainty"),
        "{said}"
    );
    assert!(
        said["help"].as_str().unwrap().contains("That needs 30 s, and 25 s are there: this way round"),
        "{said}"
    );
    let conflicts = checked["conflicts"].as_array().unwrap();
    assert_eq!((&conflicts[0]["members"], &conflicts[0]["enough"]), (&checked["conflict"], &Value::Null));
}

#[test]
fn each_bound_of_a_network_file_is_blamed_where_it_stands() {
    let file = "tests/networks/lane50_notDC_000.stnu";
    let text = std::fs::read_to_string(file).unwrap();
    let output = kirk(&["check", "--format", "json", file]);
    let checked: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let mut links = 0;
    for member in checked["conflict"].as_array().unwrap() {
        let [from, to] = ["from", "to"].map(|end| member[end].as_str().unwrap());
        let line = member["span"]["start"]["line"].as_u64().unwrap() as usize;
        let edge = text.lines().nth(line - 1).unwrap();
        // The way back says the least of a requirement, and with labels the most of a contingent link.
        let (source, target) = match member["kind"].as_str().unwrap() {
            "requirement-upper" | "contingent-lower" => (from, to),
            "requirement-lower" | "contingent-upper" => (to, from),
            kind => panic!("{kind}"),
        };
        assert!(edge.contains(&format!("source=\"{source}\" target=\"{target}\"")), "{member}: {edge}");
        links += usize::from(edge.contains("contingent"));
    }
    assert!(links > 1);
}

#[test]
fn the_exit_status_is_that_of_a_check() {
    assert_eq!(log(&["examples/rmpl/eat-and-bike.rmpl"]).1, Some(0));
    assert_eq!(log(&["examples/rmpl/too-late.rmpl", "examples/rmpl/eat-and-bike.rmpl"]).1, Some(1));
    let output = kirk_with_input(&["check", "--format", "sarif", "-"], "(ä (b)".as_bytes());
    assert_eq!(output.status.code(), Some(2));
    let log: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(log["runs"][0]["invocations"][0]["exitCode"], 2);
    // Columns count characters.
    assert_eq!(log["runs"][0]["columnKind"], "unicodeCodePoints");
}
