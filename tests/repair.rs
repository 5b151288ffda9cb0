//! `kirk repair`: every proposal it makes, of every mission there is that cannot be promised, made and checked afresh.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod binary;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::{Value, json};

fn missions(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rmpl"));
    files.sort();
    files
}

fn status(arguments: &[&str]) -> Option<i32> {
    kirk(arguments).status.code()
}

/// Makes every proposal for a copy of a mission, each for a copy of its own. Returns how many there are.
fn each_proposal_is_enough(file: &Path, options: &[&str]) -> usize {
    let path = file.to_str().unwrap();
    let output = kirk(&[&["repair", path, "--format", "json"], options].concat());
    let document: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let repairs = document["repairs"].as_array().unwrap();
    assert_eq!(document["format"], "kirk-repair/1");
    assert_eq!(output.status.code(), Some(i32::from(repairs.is_empty())), "{path}");
    for (number, repair) in repairs.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join(file.file_name().unwrap());
        fs::copy(file, &copy).unwrap();
        let copy = copy.to_str().unwrap();
        let applied = kirk(&[&["repair", copy, "--apply", &(number + 1).to_string()], options].concat());
        assert_eq!(applied.status.code(), Some(0), "{path} {number}: {}", stderr(&applied));
        assert_eq!(status(&["check", copy]), Some(0), "{path} {number}: {repair}");
    }
    repairs.len()
}

#[test]
fn every_mission_of_the_gallery_is_explained_and_put_right_in_one_step() {
    for file in missions("tests/rmpl/gallery") {
        let name = file.file_stem().unwrap().to_str().unwrap();
        let path = format!("tests/rmpl/gallery/{name}.rmpl");
        assert!(each_proposal_is_enough(&file, &[]) > 0, "{name}");
        let (check, repair) = (kirk(&["check", &path, "-q"]), kirk(&["repair", &path]));
        let shown =
            format!("{}\n{}\n{}", fs::read_to_string(&file).unwrap(), stderr(&check), stdout(&repair));
        insta::assert_snapshot!(format!("gallery_{name}"), shown);
    }
}

#[test]
fn every_proposal_for_every_mission_that_cannot_be_promised_is_enough() {
    let mut repaired = 0;
    for file in missions("tests/rmpl/bad").into_iter().chain(missions("examples/rmpl")) {
        if status(&["check", file.to_str().unwrap(), "-q"]) == Some(1) {
            for options in
                [&[][..], &["--nature"], &["--prefer", "news"], &["--prefer", "durations", "--limit", "3"]]
            {
                repaired += each_proposal_is_enough(&file, options);
            }
        }
    }
    assert!(repaired > 4, "{repaired}");
}

#[test]
fn what_is_kept_is_not_touched_and_what_is_dear_comes_last() {
    let first = |options: &[&str]| {
        let file = "tests/rmpl/gallery/warm-up.rmpl";
        let output = kirk(&[&["repair", file, "--format", "json"], options].concat());
        let document: Value = serde_json::from_str(&stdout(&output)).unwrap();
        document["repairs"][0]["changes"][0]["title"].as_str().unwrap_or_default().to_string()
    };
    assert_eq!(first(&[]), "at least 180 s instead of 300 s for `warm-up`");
    assert!(
        first(&["--keep", "warm-up"]).starts_with("at most 300 s instead of 180 s from the end of `arrive`")
    );
    assert!(first(&["--prefer", "deadlines"]).contains(" from the end of "));
    assert!(
        first(&["--weight", "warm-up=4"]).starts_with("at most 300 s instead of 180 s from"),
        "{}",
        first(&["--weight", "warm-up=4"])
    );
    assert_eq!(first(&["--keep", "warm-up", "--keep", "between"]), "");
    let nature = first(&["--keep", "warm-up", "--keep", "between", "--nature"]);
    assert!(nature.starts_with("Nature taking at "), "{nature}");
}

#[test]
fn an_order_is_left_out_whatever_it_leaves_between_and_of_a_file_by_hand() {
    let told = |mission: &str| stdout(&kirk_with_input(&["repair", "-"], mission.as_bytes()));
    let program = |name: &str| {
        format!(
            "(define-control-program {name} () (declare (primitive) (duration (simple :lower-bound 10 :upper-bound 20))))"
        )
    };
    let orders = "(define-control-program main () (sequence (:slack t) (a) (b)
        (between (end b) (start a) (simple-temporal :lower-bound 5))))";
    let mission = program("a") + &program("b") + orders;
    assert!(
        told(&mission).contains("1  without the order from the end of `b` to the start of `a`"),
        "{}",
        told(&mission)
    );
    let network = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b"],
        "requirements": [{"from": "a", "to": "b", "lower": 1}, {"from": "b", "to": "a", "lower": 1}],
        "contingents": [{"from": "z", "to": "a", "lower": 1, "upper": 2}]}"#;
    let told = told(network);
    assert!(told.contains("without the order") && told.contains("by hand"), "{told}");
}

#[test]
fn a_shortest_delay_that_follows_is_told() {
    let mission = "(define-control-program etch () (declare (primitive) (duration
        (simple :lower-bound 30 :upper-bound 60 :min-observation-delay 10 :max-observation-delay 20) :contingent t)))
      (define-control-program rinse () (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))
      (define-control-program main () (parallel (:slack t) (sequence (:slack t) (etch) (rinse))
        (between (end etch) (start rinse) (simple-temporal :upper-bound 5))))";
    let told = stdout(&kirk_with_input(&["repair", "-"], mission.as_bytes()));
    let first = "1  news of the end of `etch` within 5 s instead of 20 s, and its shortest delay with it";
    assert!(told.contains(first), "{told}");
}

#[test]
fn what_a_negative_bound_says_is_told_the_way_people_say_it() {
    let network = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a", "b"],
        "requirements": [{"from": "b", "to": "a", "upper": -5}, {"from": "b", "to": "a", "lower": -3}]}"#;
    let output = kirk_with_input(&["repair", "-"], network.as_bytes());
    let told = stdout(&output);
    assert!(told.contains("at least 3 s instead of 5 s from `a` to `b`"), "{told}");
    assert!(told.contains("at most 5 s instead of 3 s from `a` to `b`"), "{told}");
}

#[test]
fn what_cannot_be_read_is_neither_yes_nor_no() {
    let output = kirk_with_input(&["repair", "-", "--format", "json"], b"(((");
    assert_eq!(output.status.code(), Some(2));
    let document: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&document["format"], &document["controllable"]), (&json!("kirk-repair/1"), &Value::Null));
}

#[test]
fn what_is_written_once_is_kept_with_all_that_reads_it() {
    let file = "tests/rmpl/gallery/shared-bound.rmpl";
    let told = |options: &[&str]| stdout(&kirk(&[&["repair", file], options].concat()));
    assert!(told(&[]).contains("at least 5 s instead of 10 s for `heat`"), "{}", told(&[]));
    // The second call is `heat#2`, and its bound is that of the first.
    let kept = told(&["--keep", "heat#2"]);
    assert!(!kept.contains("for `heat`") && kept.contains("at most 10 s instead of 5 s"), "{kept}");
}

#[test]
fn a_file_that_may_not_be_written_is_left_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.rmpl");
    fs::copy("tests/rmpl/gallery/deadline.rmpl", &file).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o444)).unwrap();
    let output = kirk(&["repair", file.to_str().unwrap(), "--apply", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("nothing is changed"), "{}", stderr(&output));
    assert_eq!(fs::read(&file).unwrap(), fs::read("tests/rmpl/gallery/deadline.rmpl").unwrap());
}

#[test]
fn a_patch_says_what_applying_does_and_changes_nothing() {
    let file = "tests/rmpl/gallery/late-news.rmpl";
    let before = fs::read_to_string(file).unwrap();
    let patch = kirk(&["repair", file, "--diff", "--apply", "2"]);
    insta::assert_snapshot!(stdout(&patch));
    assert_eq!(fs::read_to_string(file).unwrap(), before);
}

#[test]
fn patch_takes_a_patch_of_a_file_with_blanks_in_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("late news.rmpl");
    fs::copy("tests/rmpl/gallery/late-news.rmpl", &file).unwrap();
    let patch = stdout(&kirk(&["repair", file.to_str().unwrap(), "--diff"]));
    let run = Command::new("patch").args(["-p0", "-s"]).current_dir("/").stdin(Stdio::piped()).spawn();
    let Ok(mut run) = run else {
        // There is no `patch` here.
        return;
    };
    run.stdin.take().unwrap().write_all(patch.as_bytes()).unwrap();
    assert!(run.wait().unwrap().success(), "{patch}");
    assert_eq!(status(&["check", file.to_str().unwrap()]), Some(0));
}

/// News of `b` is up to 5 s late, and `c` is to come within 3 s of it.
const NETWORK: &str = r#"{"format": "kirk-network/1", "name": "n", "origin": "a", "events": ["a", "b", "c"],
 "requirements": [{"from": "b", "to": "c", "lower": 0, "upper": 3}],
 "contingents": [{"from": "a", "to": "b", "lower": 20, "upper": 40, "delay": [4, 5]}]}"#;

#[test]
fn a_network_file_is_repaired_where_its_numbers_stand() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("n.json");
    let path = file.to_str().unwrap();
    fs::write(&file, format!("\u{feff}{NETWORK}")).unwrap();
    let output = kirk(&["repair", path]);
    let told = stdout(&output);
    assert!(told.contains("news of `b` within 3 s instead of 5 s"), "{told}");
    assert!(told.contains("at most 5 s instead of 3 s from `b` to `c`"), "{told}");
    assert_eq!(status(&["repair", path, "--apply", "1", "-q"]), Some(0));
    let after = fs::read_to_string(&file).unwrap();
    assert!(after.starts_with('\u{feff}') && after.contains(r#""delay": [3, 3]"#), "{after}");
    let again = kirk(&["repair", path]);
    assert!(stdout(&again).contains("there is nothing to repair") && again.status.success());
    let json: Value = serde_json::from_str(&stdout(&kirk(&["repair", path, "--format", "json"]))).unwrap();
    assert_eq!((&json["controllable"], &json["repairs"]), (&json!(true), &json!([])));
}

#[test]
fn a_hundred_windows_that_are_too_short_are_widened_at_once() {
    use std::fmt::Write;
    let mut text = "(define-control-program listen () (declare (primitive)
  (duration (simple :lower-bound 5 :upper-bound 7 :max-observation-delay 1) :contingent t)))
(define-control-program main () (sequence (:slack t)\n"
        .to_string();
    for window in 0..100 {
        let (most, before) = (8 + window % 2, 1 + window % 5);
        writeln!(
            text,
            "  (with-temporal-constraint (simple-temporal :upper-bound {most})
    (sequence (:slack t) (delay {before} 20) (listen) (delay 2 30)))"
        )
        .unwrap();
    }
    text.push_str("))\n");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("windows.rmpl");
    fs::write(&file, text).unwrap();
    let path = file.to_str().unwrap();
    let applied = kirk(&["repair", path, "--apply", "1"]);
    assert_eq!(applied.status.code(), Some(0), "{}", stderr(&applied));
    let changes = stdout(&applied).lines().count();
    assert!(changes >= 100, "{changes}");
    assert_eq!(status(&["check", path, "-q"]), Some(0));
}

#[test]
fn what_kirk_cannot_write_is_said_to_be_to_be_made_by_hand() {
    let file = "tests/networks/lane50_notDC_000.stnu";
    let told = stdout(&kirk(&["repair", file]));
    assert!(told.contains("     by hand: kirk cannot write this change in the file\n"), "{told}");
    assert!(!told.contains("--apply"), "{told}");
    let applied = kirk(&["repair", file, "--apply", "1"]);
    assert_eq!(applied.status.code(), Some(2));
    assert!(stderr(&applied).contains("kirk cannot write proposal 1 in the file"), "{}", stderr(&applied));
    let applicable = |path: &str| -> Vec<bool> {
        let document: Value =
            serde_json::from_str(&stdout(&kirk(&["repair", path, "--format", "json"]))).unwrap();
        let all = document["repairs"].as_array().unwrap().iter();
        let of = |repair: &Value| {
            let changes = repair["changes"].as_array().unwrap().iter();
            let each = changes.map(|change| change["applicable"].as_bool().unwrap()).min();
            assert_eq!(each, repair["applicable"].as_bool(), "{repair}");
            each.unwrap()
        };
        all.map(of).collect()
    };
    let (by_hand, by_kirk) = (applicable(file), applicable("tests/networks/lane50_notDC_000.json"));
    assert!(!by_hand.is_empty() && !by_hand.contains(&true));
    assert!(!by_kirk.is_empty() && !by_kirk.contains(&false));
}

#[test]
fn wrong_wishes_are_refused_and_nothing_is_changed() {
    let file = "tests/rmpl/gallery/deadline.rmpl";
    let before = fs::read_to_string(file).unwrap();
    for (arguments, said) in [
        (&["repair", file, "--keep", "drvie"][..], "did you mean `drive`?"),
        (&["repair", file, "--weight", "drive"], "expected NAME=W"),
        (&["repair", file, "--weight", "drive=0"], "`--keep drive` leaves it as it is"),
        (&["repair", file, "--apply", "7"], "there is only proposal 1"),
        (&["repair", file, "--apply", "0"], "there is no proposal 0"),
        (&["repair", file, "--limit", "0"], "from 1 to 100"),
        (&["repair", "examples/rmpl/robot.rmpl", "--apply", "1"], "there is nothing to repair"),
        (&["repair", "tests/rmpl/bad/K0109-empty.rmpl"], "K0109"),
        (&["repair", "nowhere.rmpl"], "there is no such file"),
    ] {
        let output = kirk(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(file).unwrap(), before);
    let piped = kirk_with_input(&["repair", "-", "--apply", "1"], before.as_bytes());
    assert_eq!(piped.status.code(), Some(2));
    assert!(stderr(&piped).contains("`--diff` prints the change"), "{}", stderr(&piped));
}
