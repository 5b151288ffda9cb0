//! Several files on one command line are one program, and messages point into the right one.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod binary;

use std::fs;

use binary::{kirk, stderr, stdout};

const LIBRARY: &str = "(defpackage #:tools)
(in-package #:tools)
(defconstant +pause+ 5)
(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
(define-control-program unused () (declare (primitive)))
";

const MISSION: &str = "(defpackage #:mission (:use #:tools))
(in-package #:mission)
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (sequence (:slack t)
      (drive)
      (delay +pause+))))
";

/// Runs kirk in a folder with these files.
fn run(files: &[(&str, &str)], arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut all: Vec<String> = Vec::new();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for argument in arguments {
        let path = folder.path().join(argument);
        all.push(if path.exists() { path.to_str().unwrap().to_string() } else { (*argument).to_string() });
    }
    let output = kirk(&all.iter().map(String::as_str).collect::<Vec<_>>());
    let plain = |text: String| text.replace(&format!("{}/", folder.path().to_str().unwrap()), "");
    (output.status.code(), plain(stdout(&output)), plain(stderr(&output)))
}

#[test]
fn a_library_and_a_mission_are_one_program() {
    let files = [("lib.rmpl", LIBRARY), ("mission.rmpl", MISSION)];
    let (status, out, messages) = run(&files, &["run", "lib.rmpl", "mission.rmpl", "--simulate"]);
    assert_eq!((status, messages.as_str()), (Some(0), ""), "{out}");
    assert!(out.contains("drive:end"), "{out}");
    let (status, out, _) = run(&files, &["compile", "mission.rmpl", "lib.rmpl"]);
    assert_eq!(status, Some(0));
    assert!(out.contains("[5, 5]"), "{out}");
    let (status, out, _) =
        run(&files, &["run", "lib.rmpl", "mission.rmpl", "--simulate", "--format", "json"]);
    assert_eq!(status, Some(0));
    let with_record = [files[0], files[1], ("record.json", out.as_str())];
    let (status, out, messages) = run(&with_record, &["verify", "record.json", "lib.rmpl", "mission.rmpl"]);
    assert_eq!(status, Some(0), "{out}{messages}");
    assert_eq!(out, "record.json satisfies every constraint of lib.rmpl mission.rmpl\n");
}

#[test]
fn messages_point_into_the_right_file() {
    let broken = MISSION.replace("(drive)", "(drvie)");
    let slow = LIBRARY.replace(":upper-bound 20", ":upper-bound 200").replace("+pause+ 5)", "+pause+ -5)");
    let (status, _, messages) =
        run(&[("lib.rmpl", &slow), ("mission.rmpl", &broken)], &["compile", "lib.rmpl", "mission.rmpl"]);
    assert_eq!(status, Some(2));
    insta::assert_snapshot!("a_slip", messages);
    let slow = LIBRARY.replace(":upper-bound 20", ":upper-bound 200");
    let (status, _, messages) = run(
        &[("lib.rmpl", &slow), ("mission.rmpl", MISSION)],
        &["run", "lib.rmpl", "mission.rmpl", "--simulate"],
    );
    assert_eq!(status, Some(1));
    insta::assert_snapshot!("a_conflict", messages);
}

#[test]
fn what_cannot_be_one_program_is_refused() {
    let network = r#"{"format":"kirk-network/1","name":"n","origin":"a","events":["a"]}"#;
    let files = [("lib.rmpl", LIBRARY), ("mission.rmpl", MISSION), ("network.json", network)];
    for (arguments, said) in [
        (&["compile", "lib.rmpl", "network.json"][..], "`network.json` is a network"),
        (&["compile", "lib.rmpl", "mission.rmpl", "lib.rmpl"], "`lib.rmpl` is given twice"),
        (&["compile", "missing.rmpl", "mission.rmpl"], "cannot read `missing.rmpl`: there is no such file"),
        (&["compile", "mission.rmpl"], "K0501"),
    ] {
        let (status, _, messages) = run(&files, arguments);
        assert_eq!(status, Some(2), "{arguments:?}: {messages}");
        assert!(messages.contains(said), "{arguments:?}: {messages}");
    }
}

#[test]
fn check_judges_each_file_for_itself() {
    let alone = "(define-control-program main () (declare (primitive)))\n";
    let files = [("lib.rmpl", LIBRARY), ("alone.rmpl", alone), ("same.rmpl", alone)];
    let (status, out, _) = run(&files, &["check", "alone.rmpl", "same.rmpl"]);
    assert_eq!((status, out.lines().count()), (Some(0), 2), "{out}");
}

#[test]
fn files_are_checked_together_if_that_is_asked_for_and_a_missing_program_says_where_it_is() {
    let library =
        "(define-control-program drive () (declare (primitive) (duration (simple :upper-bound 5))))";
    let mission = "(define-control-program main () (drive))";
    let files = [("a.rmpl", library), ("b.rmpl", mission)];
    let (status, out, messages) = run(&files, &["check", "a.rmpl", "b.rmpl"]);
    assert_eq!(status, Some(2), "{out}{messages}");
    for said in [
        "`drive` is in a.rmpl: `kirk check --together` takes",
        "`main` is in b.rmpl: `kirk check --together` takes",
    ] {
        assert!(messages.contains(said), "{said} is not in {messages}");
    }
    let (status, out, messages) = run(&files, &["check", "--together", "a.rmpl", "b.rmpl"]);
    assert_eq!((status, messages.as_str()), (Some(0), ""));
    assert_eq!(out, "a.rmpl b.rmpl: `main` is controllable (2 events, 1 requirement, 0 contingent links)\n");
    // Each message is about the file it stands in.
    let wrong = "(define-control-program drive (fast) (declare (primitive)))";
    let files = [("a.rmpl", wrong), ("b.rmpl", mission)];
    let (status, out, _) = run(&files, &["check", "--together", "a.rmpl", "b.rmpl", "--format", "json"]);
    assert_eq!(status, Some(2));
    let document: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&document["file"], &document["diagnostics"][0]["file"]),
        (&"a.rmpl b.rmpl".into(), &"b.rmpl".into())
    );
    assert_eq!(document["diagnostics"][0]["labels"][1]["file"], "a.rmpl");
    let (_, out, _) = run(&files, &["check", "--together", "a.rmpl", "b.rmpl", "--format", "sarif"]);
    let log: serde_json::Value = serde_json::from_str(&out).unwrap();
    let result = &log["runs"][0]["results"][0];
    let uri = |place: &serde_json::Value| {
        place["physicalLocation"]["artifactLocation"]["uri"].as_str().unwrap().to_string()
    };
    assert!(uri(&result["locations"][0]).ends_with("b.rmpl"), "{result}");
    assert!(uri(&result["relatedLocations"][0]).ends_with("a.rmpl"), "{result}");
}

#[test]
fn the_short_form_has_a_line_for_every_place_with_the_guilty_bounds() {
    let mission = "(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 90) :contingent t)))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (drive)))
";
    let (status, out, messages) = run(&[("m.rmpl", mission)], &["check", "m.rmpl", "--format", "short"]);
    assert_eq!((status, messages.as_str()), (Some(1), ""));
    let places: Vec<&str> = out.lines().map(|line| line.split(": ").next().unwrap()).collect();
    assert_eq!(places, ["m.rmpl:3:25", "m.rmpl:4:59", "m.rmpl:2:70"], "{out}");
    assert!(out.lines().all(|line| line.contains(": error[K0601]: ") || line.contains(": note: ")), "{out}");
}

#[test]
fn a_file_that_names_others_is_one_program_with_them() {
    let library =
        "(define-control-program drive () (declare (primitive) (duration (simple :upper-bound 5))))";
    let mission = ";;; kirk: files a.rmpl b.rmpl\n(define-control-program main () (drive))";
    let files = [("a.rmpl", library), ("b.rmpl", mission)];
    for command in [&["check", "b.rmpl"][..], &["run", "b.rmpl", "--simulate"], &["compile", "b.rmpl"]] {
        let (status, out, messages) = run(&files, command);
        assert_eq!((status, messages.as_str()), (Some(0), ""), "{command:?}: {out}");
    }
    let (status, _, messages) = run(&files[1..], &["check", "b.rmpl"]);
    assert_eq!(status, Some(2));
    assert!(messages.contains("b.rmpl:1:17") && messages.contains("there is no such file"), "{messages}");
    let stdin = ("b.rmpl", ";;; kirk: files -\n(define-control-program main () (delay 1))");
    let (status, _, messages) = run(&[stdin], &["check", "b.rmpl"]);
    assert_eq!(status, Some(2), "standard input is no file: {messages}");
    assert!(messages.contains("b.rmpl:1:17"), "{messages}");
}
