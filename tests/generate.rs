//! `kirk generate` through the binary: what it prints is input again, and impossible parameters are refused.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::Value;

fn generated(arguments: &[&str]) -> Value {
    let output = kirk(&[&["generate"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn every_family_is_printed_as_a_network_that_can_be_checked() {
    for (family, events) in
        [("repeaters", 1 + 4 * 5 * 4), ("sampling", 1 + 4 * 5 * 5), ("lanes", 1 + 4 * 5 * 2)]
    {
        let output = kirk(&["generate", family]);
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()), "{family}");
        let network: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(network["format"], "kirk-network/1");
        assert_eq!(network["name"], format!("{family} 4x5 seed 0"));
        assert_eq!(network["events"].as_array().unwrap().len(), events, "{family}");
        let check = kirk_with_input(&["check", "-", "--quiet"], &output.stdout);
        assert!(matches!(check.status.code(), Some(0 | 1)), "{family}: {}", stderr(&check));
    }
}

#[test]
fn the_seed_and_the_options_make_the_network() {
    let seed = |seed: &str| generated(&["lanes", "--agents", "2", "--tasks", "3", "--seed", seed]);
    assert_eq!(seed("7"), seed("7"));
    assert_ne!(seed("7")["requirements"], seed("8")["requirements"]);
    let links = |arguments: &[&str]| generated(arguments)["contingents"].as_array().unwrap().len();
    assert_eq!(links(&["lanes", "--links", "0"]), 0);
    assert_eq!(links(&["lanes", "--links", "100"]), 20);
    assert_eq!(links(&["repeaters"]), 40);
    assert_eq!(links(&["repeaters", "--clean-up", "contingent"]), 40 + 4 * 4);
    assert_eq!(links(&["repeaters", "--clean-up", "contingent", "--clean-up-at-end"]), 60);
    assert_eq!(links(&["sampling", "--traverse", "requirement"]), 40);
    let longest = |lambda: &str| {
        let network = generated(&["repeaters", "--lambda", lambda]);
        let delays: Vec<f64> = network["contingents"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(|c| c["delay"][1].as_f64())
            .collect();
        delays.into_iter().fold(0.0, f64::max)
    };
    assert!((longest("30") / longest("3") - 10.0).abs() < 0.001);
    let limit = |spare: &str| {
        let network = generated(&["repeaters", "--agents", "1", "--tasks", "1", "--spare", spare]);
        network["requirements"].as_array().unwrap().last().unwrap()["upper"].as_f64().unwrap()
    };
    assert_eq!(limit("4"), 5.0 * limit("0"));
}

#[test]
fn a_controllable_network_is_found_and_its_seed_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("repeaters.json");
    let file = file.to_str().unwrap();
    let output = kirk(&["generate", "repeaters", "--seed", "3", "--controllable", "-o", file]);
    assert_eq!((output.status.code(), stdout(&output)), (Some(0), String::new()));
    let said = stderr(&output);
    let seed = said.split(' ').nth(1).unwrap();
    assert!(said.starts_with("seed ") && said.contains("gives a controllable network"), "{said}");
    assert_eq!(kirk(&["check", file]).status.code(), Some(0));
    let written: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!(written, generated(&["repeaters", "--seed", seed]));
    let run = kirk(&["run", file, "--simulate", "--nature", "random", "--quiet"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let quiet = kirk(&["generate", "repeaters", "--seed", "3", "--controllable", "--quiet"]);
    assert_eq!(stderr(&quiet), "");
}

#[test]
fn when_no_seed_will_do_the_answer_is_no() {
    let hopeless =
        ["generate", "repeaters", "--clean-up", "contingent", "--bounds", "text", "--controllable"];
    let output = kirk(&hopeless);
    assert_eq!((output.status.code(), stdout(&output)), (Some(1), String::new()));
    assert!(stderr(&output).contains("none of the 1000 seeds from 0 on"), "{}", stderr(&output));
}

#[test]
fn parameters_that_make_no_sense_are_refused() {
    let cases: &[(&[&str], &str)] = &[
        (&["repeaters", "--agents", "0"], "at least one"),
        (&["sampling", "--tasks", "0"], "at least one"),
        (&["lanes", "--agents", "4000000000", "--tasks", "4000000000"], "at most 1000000"),
        (&["repeaters", "--lambda", "0"], "lambda must be a positive number"),
        (&["repeaters", "--lambda", "NaN"], "lambda must be a positive number"),
        (&["sampling", "--lambda", "1e300"], "lambda must be a positive number"),
        (&["lanes", "--links", "101"], "from 0 to 100"),
        (&["lanes", "--cross", "-1"], "-1"),
        (&["lanes", "--lambda", "3"], "--lambda"),
        (&["repeaters", "--seed", "soon"], "soon"),
        (&["repeaters", "--clean-up", "perhaps"], "contingent"),
        (&["repeaters", "-o", "no/such/folder/file.json"], "cannot write"),
        (&["gliders"], "gliders"),
        (&[], "repeaters"),
    ];
    for (arguments, words) in cases {
        let output = kirk(&[&["generate"], *arguments].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(words), "{arguments:?} does not say {words:?}: {message}");
        assert!(!message.contains("panicked"), "{arguments:?}: {message}");
        assert_eq!(stdout(&output), "");
    }
}

#[test]
fn a_family_as_a_program_has_the_verdict_of_the_network() {
    let mut verdicts = [0, 0];
    for family in ["repeaters", "sampling", "lanes"] {
        for seed in ["0", "1", "2", "3"] {
            let arguments = ["generate", family, "--agents", "3", "--tasks", "3", "--seed", seed];
            let network = kirk(&arguments);
            let program = kirk(&[&arguments[..], &["--format", "rmpl"]].concat());
            let verdict = kirk_with_input(&["check", "-", "--quiet"], &network.stdout).status.code();
            let of_program = kirk_with_input(&["check", "-", "--quiet"], &program.stdout);
            assert_eq!(of_program.status.code(), verdict, "{family} {seed}: {}", stderr(&of_program));
            verdicts[verdict.unwrap() as usize] += 1;
            let laid_out = kirk_with_input(&["fmt", "-"], &program.stdout);
            assert_eq!(stdout(&laid_out), stdout(&program), "{family} {seed}");
        }
    }
    assert!(verdicts.iter().all(|&count| count > 0), "{verdicts:?}");
}
