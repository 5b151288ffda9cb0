//! The promises of the command line: exit statuses, formats, and a message for every kind of wrong input.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::fs;
use std::path::Path;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::Value;

/// Wrong input: exit status 2, a message, and nothing that looks like a crash.
fn is_refused(arguments: &[&str], input: &[u8], words: &str) -> String {
    let output = kirk_with_input(arguments, input);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(words), "{arguments:?} does not say {words:?}: {message}");
    assert!(!message.contains("panicked"), "{arguments:?}: {message}");
    assert!(message.len() < 200_000, "{arguments:?}: {} bytes of messages", message.len());
    message
}

#[test]
fn wrong_input_of_every_kind_gets_a_message_and_status_2() {
    let cases: &[(&[u8], &str)] = &[
        (b"", "K0109"),
        (b"   ; only a comment\n", "K0109"),
        (b"\x7fELF\x02\x01\x01\x00\x00\x00\xff\xfe", "K0106"),
        (b"\xff\xfe\x00a", "K0106"),
        (b"let x = 5;\n", "K0108"),
        (b"$ kirk run mission.rmpl\n", "K0108"),
        (b"<html><body>hello</body></html>", "K0108"),
        (b"(define-control-program main () (sequence (a) (b)", "K0101"),
        (b"(define-control-program main () (nothing))", "K0301"),
        (b"(((((", "K0101"),
        (b")", "K0102"),
        (b"{\"format\":\"kirk-network/1\"", "K0702"),
        (b"{\"a\": 1}", "K0702"),
    ];
    for (input, code) in cases {
        for command in [&["check", "-"][..], &["run", "-", "--simulate"], &["compile", "-"]] {
            is_refused(command, input, code);
        }
    }
}

#[test]
fn wrong_files_get_a_message_and_status_2() {
    is_refused(&["check", "examples"], b"", "directory");
    is_refused(&["check", "no/such/file.rmpl"], b"", "no such file");
    is_refused(&["run", "no/such/file.rmpl", "--simulate"], b"", "no such file");
    is_refused(&["verify", "examples/rmpl/robot.rmpl", "examples/rmpl/robot.rmpl"], b"", "K0803");
    is_refused(&["verify", "no/such/file.json", "examples/rmpl/robot.rmpl"], b"", "no such file");
    is_refused(&["explain", "K9999"], b"", "K9999");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--seed", "3"], b"", "--simulate");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--speed", "3"], b"", "--speed");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--speed", "0"], b"", "greater than 0");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--driver", "robot"], b"", "stdio:");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--driver-url", "https://robot/"], b"", "curl");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--driver-command", "~A ~A ~A"], b"", "3 times");
    is_refused(&["run", "examples/rmpl/robot.rmpl", "-p", "0", "--bind", "0.0.0.0"], b"", "--token-file");
    is_refused(&["resume", "no/such/journal"], b"", "no/such/journal");
    is_refused(&["replay", "examples/rmpl/robot.rmpl"], b"", "line 1");
    is_refused(&["check"], b"", "FILE");
    is_refused(&["fly"], b"", "fly");
    is_refused(&["run", "--simulate", "examples/rmpl/robot.rmpl", "--strategy", "hope"], b"", "hope");
    is_refused(&["compile", "examples/rmpl/robot.rmpl", "--emit", "ast", "--format", "dot"], b"", "ast");
    is_refused(&["compile", "tests/networks/lane50_dc_000.json", "--emit", "ast"], b"", "network");
}

#[test]
fn hostile_input_ends_in_bounded_time_and_memory() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_string()
    };
    is_refused(&["check", &write("large.rmpl", &vec![b'('; 100 << 20])], b"", "bytes");
    is_refused(&["check", &write("large.json", &vec![b'['; 100 << 20])], b"", "K070");
    is_refused(&["check", &write("deep.rmpl", &"(".repeat(100_000).into_bytes())], b"", "K01");
    let closed = ["(".repeat(100_000), ")".repeat(100_000)].concat();
    is_refused(&["check", &write("closed.rmpl", closed.as_bytes())], b"", "K0105");
    is_refused(&["check", &write("deep.json", &"[".repeat(100_000).into_bytes())], b"", "K0702");
    is_refused(&["check", &write("quotes.rmpl", &vec![b'"'; 100_000])], b"", "K0");
    is_refused(&["check", &write("hashes.rmpl", &b"#|".repeat(50_000))], b"", "K0104");
    is_refused(&["check", &write("one-line.rmpl", &b"a ".repeat(100_000))], b"", "K0110");
}

#[test]
fn a_mission_cut_anywhere_is_refused_or_accepted_but_never_crashes() {
    let text = fs::read("examples/rmpl/robot.rmpl").unwrap();
    for end in (0..text.len()).step_by(97) {
        let output = kirk_with_input(&["check", "-"], &text[..end]);
        assert_eq!(output.status.code(), Some(2), "cut at {end}: {}", stderr(&output));
    }
}

#[test]
fn all_problems_of_a_network_file_are_reported_with_their_places() {
    let network = r#"{
  "format": "kirk-network/1", "origin": "z",
  "events": ["z", "x", "x", {"id": "c", "nmes": []}],
  "requirements": [
    {"from": "z", "to": "xx", "lower": 0},
    {"from": "z", "to": "x", "lower": 0.0000001},
    {"from": "z", "to": "x", "weight": 3}
  ],
  "contingents": [{"from": "z", "to": "x", "lower": 5}]
}"#;
    let message = is_refused(&["check", "-"], network.as_bytes(), "K0702");
    insta::assert_snapshot!(message);
}

#[test]
fn impossible_observations_are_refused_one_and_all() {
    let refused = |observations: &[&str], words: &str| {
        let mut arguments = vec!["run", "examples/rmpl/robot.rmpl", "--simulate", "--quiet"];
        for observation in observations {
            arguments.extend(["--observe", *observation]);
        }
        is_refused(&arguments, b"", words)
    };
    refused(&["human-downlink-science:end@19"], "too early");
    refused(&["human-downlink-science:end@46"], "too late");
    refused(&["robot-drilling:end@600"], "too late");
    refused(&["main:start@0"], "kirk dispatches it");
    refused(&["robot-driling:end@60"], "did you mean `robot-drilling:end`?");
    refused(&["robot-drilling:end"], "EVENT@T");
    refused(&["robot-drilling:end@soon"], "not a number");
    refused(&["robot-drilling:end@-5"], "before the mission starts");
    refused(&["robot-drilling:end@60", "robot-poweroff:start@61"], "twice");
    let two = refused(&["nothing:end@1", "nobody:end@2"], "nothing:end");
    assert!(two.contains("nobody:end"), "{two}");
}

#[test]
fn observations_come_from_a_file_too() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("observations.json");
    fs::write(&file, r#"{"human-downlink-science:end": 22, "+ROBOT-DRILLING::END+": 46.0}"#).unwrap();
    let file = file.to_str().unwrap();
    let output = kirk(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--observations", file, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("main: completed in 56 s"), "{}", stdout(&output));
    fs::write(file, r#"{"human-downlink-science:end": "soon"}"#).unwrap();
    is_refused(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--observations", file], b"", "K0801");
}

#[test]
fn json_goes_to_standard_output_alone_one_document_per_file() {
    let files = [
        "examples/rmpl/robot.rmpl",
        "no/such/file.rmpl",
        "examples/rmpl/too-late.rmpl",
        "tests/networks/lane50_notDC_000.json",
    ];
    let mut arguments = vec!["check", "--format", "json"];
    arguments.extend(files);
    let output = kirk(&arguments);
    assert_eq!(output.status.code(), Some(2), "the worst of all counts");
    assert_eq!(stderr(&output), "");
    let documents: Vec<Value> =
        stdout(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(documents.len(), files.len());
    let verdicts: Vec<&Value> = documents.iter().map(|document| &document["controllable"]).collect();
    assert_eq!(verdicts, [&Value::Bool(true), &Value::Null, &Value::Bool(false), &Value::Bool(false)]);
    for (document, file) in documents.iter().zip(files) {
        assert_eq!(document["format"], "kirk-check/1");
        assert_eq!(document["file"], file);
        assert_eq!(document["kind"], "variable-delay");
    }
    assert_eq!(documents[0]["events"], 5);
    assert_eq!(documents[0]["contingents"], 2);
    assert_eq!(documents[0]["diagnostics"][0]["severity"], "note");
    assert_eq!(documents[1]["diagnostics"][0]["code"], "K0701");
    let said = documents[2]["diagnostics"].as_array().unwrap();
    let conflict = said.iter().find(|diagnostic| diagnostic["code"] == "K0601").unwrap();
    assert!(conflict["span"]["start"]["line"].as_u64() > Some(1), "{conflict}");
    let amounts =
        documents[3]["conflict"].as_array().unwrap().iter().map(|member| member["amount"].as_f64().unwrap());
    assert!(amounts.sum::<f64>() < 0.0);
}

#[test]
fn a_mission_that_cannot_be_promised_is_a_failed_execution_in_json() {
    let output = kirk(&["run", "examples/rmpl/too-late.rmpl", "--simulate", "--format", "json"]);
    assert_eq!(output.status.code(), Some(1));
    let record: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(record["outcome"], "failed");
    assert_eq!(record["failure"]["reason"], "not-controllable");
    assert!(stderr(&output).contains("K0601"), "{}", stderr(&output));
}

#[test]
fn news_after_the_end_is_heard_all_the_same() {
    let arguments = ["run", "examples/rmpl/collect-sample.rmpl", "--simulate", "--format", "json"];
    let output = kirk(&[&arguments[..], &["--observe", "collect-science-sample:end@45"]].concat());
    let record: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let rows = record["rows"].as_array().unwrap();
    let row = rows.iter().find(|row| row["event"] == "collect-science-sample:end").unwrap();
    assert_eq!(
        (&row["how"], row["time"].as_f64(), row["observed"].as_f64()),
        (&"imagined".into(), Some(35.0), Some(45.0))
    );
    assert_eq!(row["happened"], serde_json::json!([30, 30]));
}

#[test]
fn a_compiled_network_is_input_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("robot.json");
    let file = file.to_str().unwrap();
    let compiled = kirk(&["compile", "examples/rmpl/robot.rmpl", "--format", "json", "-o", file, "--quiet"]);
    assert_eq!((compiled.status.code(), stdout(&compiled)), (Some(0), String::new()));
    let again = kirk(&["compile", file, "--format", "json"]);
    assert_eq!(stdout(&again), fs::read_to_string(file).unwrap());
    let run = kirk(&["run", file, "--simulate", "--observe", "human-downlink-science:end@22"]);
    assert!(stdout(&run).contains("22  sync:end"), "{}", stdout(&run));
}

#[test]
fn a_reduced_network_is_the_same_as_graphml_and_as_json() {
    let folder = tempfile::tempdir().unwrap();
    let stnu = folder.path().join("robot.stnu");
    let stnu = stnu.to_str().unwrap();
    let reduced = ["compile", "examples/rmpl/robot.rmpl", "--emit", "reduced", "--quiet", "--format"];
    assert_eq!(kirk(&[&reduced[..], &["graphml", "-o", stnu]].concat()).status.code(), Some(0));
    let as_json = stdout(&kirk(&[&reduced[..], &["json"]].concat()));
    assert_eq!(stdout(&kirk(&["compile", stnu, "--format", "json"])), as_json);
}

#[test]
fn two_names_of_one_event_are_observed_once() {
    let run = ["run", "examples/rmpl/robot.rmpl", "--simulate", "--observe", "human-downlink-science:end@20"];
    let again = |observation| [&run[..], &["--observe", observation]].concat();
    let words = "`human-downlink-science:end` and `sync:start` are names of one event";
    is_refused(&again("sync:start@22"), b"", words);
    is_refused(&again("human-downlink-science:end@22"), b"", "is observed twice");
    assert_eq!(kirk(&again("sync:start@20")).status.code(), Some(0));
}

#[test]
fn networks_of_other_tools_are_input_too() {
    let stnu = "tests/networks/lane50_dc_000.stnu";
    for file in [stnu, "tests/networks/lane50_dc_000.plainstnu"] {
        let check = kirk(&["check", file]);
        let verdict = format!("{file}: controllable (51 events, 121 requirements, 5 contingent links)\n");
        assert_eq!((check.status.code(), stdout(&check)), (Some(0), verdict), "{}", stderr(&check));
        assert_eq!(kirk(&["run", file, "--simulate"]).status.code(), Some(0));
        let compiled = stdout(&kirk(&["compile", file, "--format", "json"]));
        let compiled: Value = serde_json::from_str(&compiled).unwrap();
        assert_eq!(compiled["name"], "lane50_dc_000");
    }
    assert_eq!(kirk(&["check", "tests/networks/lane50_notDC_000.stnu"]).status.code(), Some(1));
    // Without an extension GraphML is known by its first element.
    let text = fs::read(stnu).unwrap();
    let check = kirk_with_input(&["check", "-"], &text);
    assert_eq!(check.status.code(), Some(0), "{}", stderr(&check));
    is_refused(&["check", "-"], b"<?xml version=\"1.0\"?><graphml><grph/></graphml>", "K0702");
    // So is plain text, by its sections.
    let text = fs::read("tests/networks/lane50_dc_000.plainstnu").unwrap();
    let check = kirk_with_input(&["check", "-"], &text);
    assert_eq!(check.status.code(), Some(0), "{}", stderr(&check));
    let folder = tempfile::tempdir().unwrap();
    let wrong = folder.path().join("wrong.plainstnu");
    fs::write(&wrong, "# Time-Point Names\nZ A\n# Ordinary Edges\nA ten Z\n").unwrap();
    is_refused(&["check", wrong.to_str().unwrap()], b"", "line 4");
    // A network with oracles is what its name says, in either form.
    let oracles = folder.path().join("oracles.ostnu");
    for text in [fs::read(stnu).unwrap(), text] {
        fs::write(&oracles, text).unwrap();
        is_refused(&["check", oracles.to_str().unwrap()], b"", "`OSTNU`, an STNU with oracles");
    }
}

#[test]
fn a_network_without_a_name_takes_that_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("Rover one.json");
    let network = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z"]}"#;
    fs::write(&file, network).unwrap();
    let compiled = stdout(&kirk(&["compile", file.to_str().unwrap(), "--format", "json"]));
    assert!(compiled.contains(r#""name":"Rover one""#), "{compiled}");
}

#[test]
fn the_same_mission_can_be_checked_under_other_delays() {
    let words = [
        ("as-written", "variable-delay", "controllable (", Some(0)),
        ("zero", "dynamic", "controllable if all news comes at once (", Some(0)),
        ("minimum", "fixed-delay", "controllable if all news is as early as it can be (", Some(0)),
        ("mean", "fixed-delay", "controllable if all news is late by its mean delay (", Some(0)),
        ("maximum", "fixed-delay", "controllable if all news is as late as it can be (", Some(0)),
        ("never", "strong", "not controllable if no news ever comes (", Some(1)),
        ("elongated", "elongated", "controllable if durations and delays are one uncertainty (", Some(0)),
    ];
    let file = "examples/rmpl/repeater.rmpl";
    for (delays, kind, verdict, status) in words {
        let text = kirk(&["check", file, "--delays", delays]);
        assert_eq!(text.status.code(), status, "{delays}");
        assert!(stdout(&text).contains(&format!("`main` is {verdict}")), "{}", stdout(&text));
        let json = kirk(&["check", file, "--delays", delays, "--format", "json"]);
        let document: Value = serde_json::from_str(&stdout(&json)).unwrap();
        assert_eq!(document["kind"], kind);
        assert_eq!(document["controllable"], status == Some(0));
        let members = document["conflict"].as_array().unwrap();
        let sum: f64 = members.iter().map(|member| member["amount"].as_f64().unwrap()).sum();
        assert_eq!(sum < 0.0, status == Some(1), "{delays}");
    }
    let never = kirk(&["check", file, "--delays", "never"]);
    assert!(
        stderr(&never).contains("these bounds do not go together if no news ever comes"),
        "{}",
        stderr(&never)
    );
    is_refused(&["check", file, "--delays", "soon"], b"", "as-written");
}

#[test]
fn every_stage_has_its_formats() {
    for stage in ["ast", "episodes", "stnu", "reduced", "dispatchable"] {
        for format in ["text", "json", "sexpr", "dot", "graphml"] {
            let arguments =
                ["compile", "examples/rmpl/robot.rmpl", "--quiet", "--emit", stage, "--format", format];
            let output = kirk(&arguments);
            let text = stdout(&output);
            let expected = match (stage, format) {
                ("ast" | "episodes", "dot" | "graphml") | ("dispatchable", "graphml") => 2,
                // The delays of the robot cannot be said there.
                ("stnu", "graphml") => 2,
                _ => 0,
            };
            assert_eq!(output.status.code(), Some(expected), "{arguments:?}: {}", stderr(&output));
            match (expected, format) {
                (0, "json") => assert!(serde_json::from_str::<Value>(&text).is_ok(), "{text}"),
                (0, "sexpr") => assert!(text.starts_with('('), "{text}"),
                (0, "dot") => assert!(text.starts_with("digraph"), "{text}"),
                (0, "graphml") => assert!(text.starts_with("<?xml"), "{text}"),
                (0, _) => assert!(!text.is_empty()),
                _ => assert_eq!(text, "", "nothing is printed beside an error"),
            }
        }
    }
}

#[test]
fn verify_finds_what_was_changed_in_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("execution.json");
    let run = kirk(&["run", "examples/rmpl/robot.rmpl", "--simulate", "--format", "json"]);
    let original: Value = serde_json::from_str(&stdout(&run)).unwrap();
    let verify = |record: &Value| {
        fs::write(&path, record.to_string()).unwrap();
        let output = kirk(&["verify", path.to_str().unwrap(), "examples/rmpl/robot.rmpl", "--quiet"]);
        (output.status.code(), stdout(&output))
    };
    assert_eq!(verify(&original), (Some(0), String::new()));
    let row_of = |record: &Value, event: &str| {
        record["rows"].as_array().unwrap().iter().position(|row| row["event"] == event).unwrap()
    };
    let mut late = original.clone();
    for event in ["robot-poweroff:end", "main:end"] {
        let row = row_of(&late, event);
        late["rows"][row]["time"] = 500.into();
        late["rows"][row]["true"] = 500.into();
    }
    let (status, said) = verify(&late);
    assert_eq!(status, Some(1));
    assert!(said.contains("at most 480 s after `main:start`"), "{said}");
    let mut missing = original.clone();
    let row = row_of(&missing, "sync:end");
    missing["rows"].as_array_mut().unwrap().remove(row);
    assert!(verify(&missing).1.contains("`sync:end` has no row"));
    let mut apart = original.clone();
    let row = row_of(&apart, "sync:end");
    apart["rows"][row]["time"] = 36.into();
    assert!(verify(&apart).1.contains("one event"));
    let mut impossible = original.clone();
    for event in ["human-downlink-science:end", "sync:start"] {
        let row = row_of(&impossible, event);
        impossible["rows"][row]["true"] = 31.into();
    }
    assert!(verify(&impossible).1.contains("outside of its bounds [15, 30]"));
    let mut makespan = original.clone();
    makespan["makespan"] = 600.into();
    assert!(verify(&makespan).1.contains("the makespan is said to be 600 s"));
    let mut order = original.clone();
    order["rows"].as_array_mut().unwrap().rotate_left(1);
    assert!(verify(&order).1.contains("not in time order"));
}

#[test]
fn a_record_of_another_mission_is_refused_and_one_that_was_lucky_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (network, record) = (path("luck.json"), path("record.json"));
    fs::write(
        &network,
        r#"{"format": "kirk-network/1", "name": "luck", "origin": "a", "events": ["a", "b", "c"],
            "requirements": [{"from": "b", "to": "c", "lower": 0, "upper": 1}],
            "contingents": [{"from": "a", "to": "b", "lower": 1, "upper": 5, "delay": [0, 10]}]}"#,
    )
    .unwrap();
    let of = |program: &str| {
        let rows = r#"[{"event": "a", "time": 0, "how": "dispatched", "true": 0},
            {"event": "b", "time": 5, "how": "observed", "true": 4, "observed": 5, "happened": [1, 5]},
            {"event": "c", "time": 5, "how": "dispatched", "true": 5}]"#;
        let text = format!(
            r#"{{"format": "kirk-execution/1", "program": "{program}", "outcome": "completed", "makespan": 5, "rows": {rows}}}"#
        );
        fs::write(&record, text).unwrap();
        let output = kirk(&["verify", &record, &network, "-q"]);
        (output.status.code(), stdout(&output))
    };
    let (status, said) = of("luck");
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.starts_with(
            "note: only as it truly happened; by what was heard Nature could have broken this: `c`"
        ),
        "{said}"
    );
    let (status, said) = of("another");
    assert_eq!(status, Some(1));
    assert!(said.contains("this is a record of `another`, and the mission is `luck`"), "{said}");
}

#[test]
fn verbose_says_how_the_news_of_each_event_is_treated() {
    let output = kirk(&["check", "examples/rmpl/robot.rmpl", "--verbose"]);
    let text = stdout(&output);
    let downlink =
        "`human-downlink-science:end`: heard 5 to 15 s late; acted on 30 to 35 s after `main:start`";
    assert!(text.contains(downlink), "{text}");
    let hidden = kirk_with_input(
        &["check", "-", "--verbose"],
        br#"{"format": "kirk-network/1", "origin": "a", "events": ["a", "b"],
             "contingents": [{"from": "a", "to": "b", "lower": 1, "upper": 3, "delay": [3, 8]}]}"#,
    );
    assert!(stdout(&hidden).contains("its news is not needed"), "{}", stdout(&hidden));
}

#[test]
fn help_and_version_are_not_errors() {
    for arguments in [&["--help"][..], &["--version"], &["run", "--help"], &["check", "--help"]] {
        assert_eq!(kirk(arguments).status.code(), Some(0), "{arguments:?}");
    }
    let page = kirk(&["explain", "k0601"]);
    assert_eq!(page.status.code(), Some(0));
    assert!(stdout(&page).starts_with("K0601"));
}

#[test]
fn the_benchmark_networks_are_checked_in_one_command() {
    let table = fs::read_to_string("tests/networks/verdicts.tsv").unwrap();
    let files: Vec<String> = table
        .lines()
        .skip(1)
        .map(|line| format!("tests/networks/{}", line.split('\t').next().unwrap()))
        .collect();
    assert!(files.iter().all(|file| Path::new(file).exists()));
    let mut arguments = vec!["check", "--format", "json"];
    arguments.extend(files.iter().map(String::as_str));
    let output = kirk(&arguments);
    assert_eq!(output.status.code(), Some(1), "some are not controllable");
    for (line, known) in stdout(&output).lines().zip(table.lines().skip(1)) {
        let document: Value = serde_json::from_str(line).unwrap();
        assert_eq!(document["controllable"], known.split('\t').nth(1) == Some("dc"), "{known}");
    }
}

#[test]
fn options_that_choose_a_program_are_refused_with_a_network() {
    let network = "tests/networks/lane50_dc_000.json";
    for arguments in [
        &["check", network, "-P", "rovers"][..],
        &["check", network, "--entry", "main"],
        &["run", network, "--simulate", "--entry", "main"],
        &["compile", network, "--package", "rovers"],
    ] {
        is_refused(arguments, b"", "K0704");
    }
}

#[test]
fn standard_input_is_read_once() {
    is_refused(&["check", "-", "-"], b"(define-control-program main () (sequence ()))", "given twice");
    is_refused(&["verify", "-", "-"], b"", "both");
}

#[test]
fn a_conflict_points_at_the_elements_of_a_network_file() {
    let network = br#"{"format": "kirk-network/1", "name": "n", "origin": "z", "events": ["z", "a"],
"requirements": [
  {"from": "z", "to": "a", "lower": 5},
  {"from": "z", "to": "a", "upper": 3}]}"#;
    let output = kirk_with_input(&["check", "-", "--format", "json"], network);
    let said: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let conflict = &said["diagnostics"][0];
    assert_eq!(conflict["code"], "K0601");
    assert_eq!(conflict["span"]["start"]["line"], 4);
    assert_eq!(conflict["labels"][1]["span"]["start"]["line"], 3);
    let help = conflict["help"].as_str().unwrap();
    assert!(
        help.contains("\n- at most 5 s instead of 3 s from `z` to `a`\n- at least 3 s instead"),
        "{help}"
    );
}

#[test]
fn explain_lists_codes_and_knows_them_in_any_dress() {
    let said = |arguments: &[&str]| stdout(&kirk(&[&["explain"], arguments].concat()));
    assert_eq!(said(&[]), said(&["--list"]));
    assert!(said(&[]).lines().count() > 60 && said(&[]).starts_with("K0101  "));
    for code in ["K0203", "k203", "203", "error[K0203]:"] {
        assert!(said(&[code]).starts_with("K0203: "), "{code}");
    }
    is_refused(&["explain", "K0299"], b"", "K0203  not a keyword");
    is_refused(&["explain", "nonsense"], b"", "lists them all");
}

#[test]
fn what_could_not_be_decided_is_null() {
    let output = kirk_with_input(&["check", "-", "--format", "json"], b"(((");
    let said: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(said["controllable"], Value::Null);
    let fields: Vec<&str> = said.as_object().unwrap().keys().map(String::as_str).collect();
    let promised = [
        "conflict",
        "conflicts",
        "conservative",
        "contingents",
        "controllable",
        "diagnostics",
        "events",
        "file",
        "format",
        "kind",
        "requirements",
        "seconds",
    ];
    assert_eq!(fields, promised);
}
