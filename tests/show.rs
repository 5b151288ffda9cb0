//! `kirk show`: pictures of missions, records, journals and teams, and wrong wishes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::fs;

use binary::{kirk, kirk_with_input, stderr, stdout};

const ROBOT: &str = "examples/rmpl/robot.rmpl";

/// What is drawn; that it was.
fn drawn(arguments: &[&str]) -> String {
    let output = kirk(arguments);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{arguments:?}");
    stdout(&output)
}

/// The pictures of the documentation, each with the command that draws it.
const OF_THE_DOCUMENTATION: [(&str, &[&str]); 3] = [
    ("sampling-eva", &["run", "examples/rmpl/sampling-eva.rmpl", "-q", "--simulate", "--format", "svg"]),
    ("too-late", &["show", "examples/rmpl/too-late.rmpl"]),
    ("team", &["show", "tests/rmpl/good/team.rmpl"]),
];

#[test]
fn the_pictures_of_the_documentation_are_those_of_the_missions() {
    for (name, command) in OF_THE_DOCUMENTATION {
        let kept = fs::read_to_string(format!("docs/images/{name}.svg")).unwrap_or_default();
        assert!(drawn(command) == kept, "draw it anew: kirk {} > docs/images/{name}.svg", command.join(" "));
    }
}

#[test]
fn the_name_of_the_file_says_what_to_draw() {
    let folder = tempfile::tempdir().unwrap();
    for (name, begins) in [("a.svg", "<svg"), ("a.html", "<!doctype html>"), ("a.mmd", "gantt\n")] {
        let file = folder.path().join(name).display().to_string();
        assert_eq!(drawn(&["show", ROBOT, "-o", &file]), "");
        assert!(fs::read_to_string(&file).unwrap().starts_with(begins), "{name}");
    }
    assert!(drawn(&["show", ROBOT]).starts_with("<svg"));
    assert!(drawn(&["show", ROBOT, "--format", "mermaid"]).starts_with("gantt"));
}

#[test]
fn a_record_is_drawn_alone_or_in_the_rows_of_its_mission() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json").display().to_string();
    let heard = ["run", ROBOT, "--simulate", "--observe", "human-downlink-science:end@22", "--format"];
    fs::write(&record, drawn(&[&heard[..], &["json"]].concat())).unwrap();
    let (alone, beside) = (drawn(&["show", &record]), drawn(&["show", &record, ROBOT]));
    for picture in [&alone, &beside] {
        assert!(picture.contains("completed in 58 s") && picture.contains("heard 22 s"), "{picture}");
    }
    assert!(!alone.contains("class=\"around\""));
    // In one go it knows of forms that nobody has named, too.
    assert!(drawn(&[&heard[..], &["svg"]].concat()).contains("class=\"around\""));
    let other = kirk(&["show", &record, "examples/rmpl/glider.rmpl"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(stderr(&other).contains("there is no event"), "{}", stderr(&other));
}

#[test]
fn a_journal_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal").display().to_string();
    let run = [
        "run",
        "examples/rmpl/glider.rmpl",
        "-q",
        "--speed",
        "100",
        "--screen",
        "never",
        "--journal",
        &journal,
    ];
    assert_eq!(kirk_with_input(&run, b"").status.code(), Some(0));
    let picture = drawn(&["show", &journal]);
    assert!(picture.contains("completed in") && picture.contains("data-known"), "{picture}");
    assert_eq!(picture, drawn(&["replay", &journal, "--internal", "--format", "svg"]));
    assert_eq!(kirk(&["show", &journal, ROBOT]).status.code(), Some(2));
}

#[test]
fn a_team_is_drawn_with_a_lane_for_each_agent() {
    let picture = drawn(&["show", "tests/rmpl/good/team.rmpl"]);
    for agent in ["astronaut", "robot", "orbiter"] {
        assert!(picture.contains("class=\"agent\" x=\"24\"") && picture.contains(&format!(">{agent}<")));
    }
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json").display().to_string();
    fs::write(&record, drawn(&["run", "tests/rmpl/good/team.rmpl", "--simulate", "--format", "json"]))
        .unwrap();
    assert_eq!(drawn(&["show", &record]), picture);
}

#[test]
fn what_cannot_be_promised_is_drawn_with_what_does_not_go_together() {
    let picture = drawn(&["show", "examples/rmpl/too-late.rmpl"]);
    assert!(
        picture.contains("blamed") && picture.contains("That needs 25 s, and 20 s are there"),
        "{picture}"
    );
}

#[test]
fn times_are_those_of_the_clock_if_its_start_is_given() {
    assert!(drawn(&["show", ROBOT, "--start", "14:00"]).contains(">14:00:10<"));
}

#[test]
fn wrong_wishes_are_refused() {
    let wrong: [(&[&str], &str); 5] = [
        (&[ROBOT, "-o", "robot.png"], "kirk draws no `.png`"),
        (&[ROBOT, "--start", "25:00"], "expected a time of day"),
        (&["no/such/file.rmpl"], "K0701"),
        (&["-", "-"], "given twice"),
        (&[ROBOT, "-o", "no/such/folder/a.svg"], "no/such/folder"),
    ];
    for (arguments, said) in wrong {
        let output = kirk(&[&["show"], arguments].concat());
        assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(2), ""), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
    }
}
