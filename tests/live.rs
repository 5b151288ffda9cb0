//! Missions in real time, with the real binary, at a high speed of the clock: drivers of every kind, and a process that is
//! killed again and again.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use binary::{kirk, stderr, stdout};
use serde_json::Value;

const DELIVERIES: &str = "tests/live/deliveries.rmpl";

/// Starts `kirk` with these arguments, its output and errors to be read at the end.
fn start(arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_kirk"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The events of an execution by name: time and how.
fn rows(execution: &Value) -> BTreeMap<String, (Option<f64>, String)> {
    let row = |row: &Value| {
        let how = row["how"].as_str().unwrap().to_string();
        (row["event"].as_str().unwrap().to_string(), (row["time"].as_f64(), how))
    };
    execution["rows"].as_array().unwrap().iter().map(row).collect()
}

/// The execution that a command has printed, which must have ended well.
fn completed(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(output), stderr(output));
    let execution: Value = serde_json::from_str(&stdout(output)).unwrap();
    assert_eq!(execution["outcome"], "completed");
    execution
}

/// Checks an execution with `kirk verify`.
fn verified(execution: &Value, file: &str) {
    let mut record = tempfile::NamedTempFile::new().unwrap();
    write!(record, "{execution}").unwrap();
    let output = kirk(&["verify", record.path().to_str().unwrap(), file, "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}{}\n{execution}", stdout(&output), stderr(&output));
}

/// What a file of lines says, as far as it is there.
fn lines(file: &Path) -> Vec<String> {
    std::fs::read_to_string(file).unwrap_or_default().lines().map(str::to_string).collect()
}

#[test]
fn the_original_command_line_hands_over_starts_with_their_companions() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    let command = format!(
        "echo \"{{'start_cmd':'~A','end_cmd':'~A'}} $KIRK_EVENT $KIRK_COMPANION\" >> {}",
        log.display()
    );
    let kirk = start(&[
        "run",
        "examples/rmpl/drive-to-lecture.rmpl",
        "--driver-command",
        &command,
        "--tolerance",
        "1.0",
        "--optimistic",
        "--verbose",
        "--speed",
        "50",
        "--format",
        "json",
    ]);
    let output = kirk.wait_with_output().unwrap();
    let execution = completed(&output);
    verified(&execution, "examples/rmpl/drive-to-lecture.rmpl");
    assert_eq!(rows(&execution)["drive-to-lecture:end"], (Some(50.0), "imagined".to_string()));
    let mut told = lines(&log);
    told.sort();
    insta::assert_snapshot!(told.join("\n"), @r"
    {'start_cmd':'+DRIVE-TO-LECTURE::START+','end_cmd':'+DRIVE-TO-LECTURE::END+'} +DRIVE-TO-LECTURE::START+ +DRIVE-TO-LECTURE::END+
    {'start_cmd':'+EAT-BREAKFAST::START+','end_cmd':'+EAT-BREAKFAST::END+'} +EAT-BREAKFAST::START+ +EAT-BREAKFAST::END+
    {'start_cmd':'+PACK-BAG::START+','end_cmd':'+PACK-BAG::END+'} +PACK-BAG::START+ +PACK-BAG::END+
    {'start_cmd':'+REVIEW-PLANNING-NOTES::START+','end_cmd':'+REVIEW-PLANNING-NOTES::END+'} +REVIEW-PLANNING-NOTES::START+ +REVIEW-PLANNING-NOTES::END+
    {'start_cmd':'+REVIEW-SCHEDULING-NOTES::START+','end_cmd':'+REVIEW-SCHEDULING-NOTES::END+'} +REVIEW-SCHEDULING-NOTES::START+ +REVIEW-SCHEDULING-NOTES::END+
    {'start_cmd':'+SHOWER::START+','end_cmd':'+SHOWER::END+'} +SHOWER::START+ +SHOWER::END+
    ");
}

#[test]
fn ends_that_we_decide_are_handed_over_if_all_events_are() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    let command = format!("echo ~A ~A >> {}", log.display());
    let file = "examples/rmpl/eat-and-bike.rmpl";
    let kirk =
        start(&["run", file, "--driver-command", &command, "--driver-events", "all", "--speed", "50", "-q"]);
    assert_eq!(kirk.wait_with_output().unwrap().status.code(), Some(0));
    let told: BTreeSet<String> = lines(&log).into_iter().collect();
    let expected = [
        "+BIKE-TO-LECTURE::END+ NIL",
        "+BIKE-TO-LECTURE::START+ +BIKE-TO-LECTURE::END+",
        "+EAT-BREAKFAST::END+ NIL",
        "+EAT-BREAKFAST::START+ +EAT-BREAKFAST::END+",
    ];
    assert_eq!(told, expected.into_iter().map(str::to_string).collect());
}

/// What the driver hears of a drone whose flight ends 4 s after it began, with these options.
fn told_in_the_field(options: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    let command = format!("echo ~A ~A >> {}", log.display());
    let mut all = vec!["run", "tests/live/field.rmpl", "--speed", "10", "--driver-command", &command];
    all.extend(options);
    let mut kirk = start(&all);
    while lines(&log).is_empty() {
        assert!(kirk.try_wait().unwrap().is_none(), "{}", stderr(&kirk.wait_with_output().unwrap()));
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(400));
    // The middleware says what it was told to, and any name of the event will do.
    let end = lines(&log)[0].split(' ').nth(1).unwrap().to_string();
    writeln!(kirk.stdin.as_ref().unwrap(), "{end}").unwrap();
    let output = kirk.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let heard = |line: &str| line.contains("fly:end") && line.contains("observed");
    assert!(stdout(&output).lines().any(heard), "{}", stdout(&output));
    lines(&log)
}

#[test]
fn a_start_that_is_one_with_natures_event_and_the_second_place_are_as_the_original_has_them_if_asked_for() {
    let (fly, upload, land) =
        ("+FLY::START+ +FLY::END+", "+UPLOAD::START+ +UPLOAD::END+", "+LAND::START+ +LAND::END+");
    let (fly_merged, upload_merged) = ("+FLY::START+ +UPLOAD::START+", "+UPLOAD::START+ +LAND::START+");
    assert_eq!(told_in_the_field(&[]), [fly, upload, land]);
    assert_eq!(told_in_the_field(&["--driver-starts", "own"]), [fly, land]);
    assert_eq!(told_in_the_field(&["--companion", "merged"]), [fly_merged, upload_merged, land]);
    assert_eq!(told_in_the_field(&["--like-original"]), [fly_merged, land]);
    let but = ["--like-original", "--driver-starts", "all", "--companion", "end"];
    assert_eq!(told_in_the_field(&but), [fly, upload, land]);
}

/// What the first line of a journal says.
fn begun_with(options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let mut all =
        vec!["run", "tests/live/field.rmpl", "--speed", "1000", "-q", "--journal", journal.to_str().unwrap()];
    all.extend(options);
    let output = start(&all).wait_with_output().unwrap();
    // How it ends is another matter: at this speed a busy machine may miss a window.
    assert_ne!(output.status.code(), Some(2), "{}", stderr(&output));
    let first = lines(&journal).swap_remove(0);
    serde_json::from_str::<Value>(&first[9..]).unwrap()["record"]["start"].clone()
}

#[test]
fn like_original_sets_all_that_differs_and_the_journal_keeps_it() {
    let usual = begun_with(&[]);
    assert_eq!((&usual["optimistic"], &usual["shell"]["screen"]), (&true.into(), &"auto".into()));
    let original = begun_with(&["--like-original"]);
    assert_eq!((&original["optimistic"], &original["shell"]["screen"]), (&false.into(), &"never".into()));
    let optimistic = begun_with(&["--like-original", "--optimistic"]);
    assert_eq!(optimistic["optimistic"], true);
    assert_eq!(begun_with(&["--optimistic"])["shell"]["screen"], "never");
    assert_eq!(begun_with(&["--optimistic", "--screen", "auto"])["shell"]["screen"], "auto");
    assert_eq!(begun_with(&["--driver-command", "true"])["shell"]["screen"], "never");
    let simulated = kirk(&["run", "tests/live/once.rmpl", "--simulate", "--like-original"]);
    assert_eq!(simulated.status.code(), Some(2));
}

#[test]
fn like_original_is_every_switch_of_the_table_in_the_documentation() {
    let page = std::fs::read_to_string("docs/EXECUTING.md").unwrap();
    let table = page.split("| what | kirk | the original | switch |").nth(1).unwrap();
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let switches: Vec<&str> = rows.map(|row| row.rsplit('`').nth(1).unwrap()).collect();
    assert!(switches.len() >= 4, "{switches:?}");
    let begun = |options: &[&str]| {
        let start = begun_with(&[&["--driver-command", "true"], options].concat());
        [&start["optimistic"], &start["handovers"], &start["shell"]].map(Value::clone)
    };
    let original = begun(&["--like-original"]);
    let all: Vec<&str> = switches.iter().flat_map(|switch| switch.split(' ')).collect();
    assert_eq!(begun(&all), original);
    // Not one of them is idle, even where the screen is gone anyhow.
    let usual = begun(&["--screen", "auto"]);
    for switch in switches {
        let options: Vec<&str> = switch.split(' ').collect();
        let alone =
            if options[0] == "--screen" { options } else { [&options[..], &["--screen", "auto"]].concat() };
        assert_ne!(begun(&alone), usual, "{switch}");
    }
}

#[test]
fn what_the_driver_was_not_to_hear_of_it_does_not_hear_of_after_a_restart() {
    let folder = tempfile::tempdir().unwrap();
    let (journal, log) = (folder.path().join("journal"), folder.path().join("log"));
    let (journal, command) = (journal.to_str().unwrap(), format!("echo ~A ~A >> {}", log.display()));
    let mission = ["run", "tests/live/field.rmpl", "--speed", "20", "--like-original", "--journal", journal];
    let mut mission = start(&[&mission[..], &["--driver-command", &command]].concat());
    while lines(&log).is_empty() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(100));
    mission.kill().unwrap();
    mission.wait().unwrap();
    let resumed = start(&["resume", journal]);
    writeln!(resumed.stdin.as_ref().unwrap(), "+UPLOAD::START+").unwrap();
    let output = resumed.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told: BTreeSet<String> = lines(&log).into_iter().collect();
    assert_eq!(
        told,
        ["+FLY::START+ +UPLOAD::START+", "+LAND::START+ +LAND::END+"].map(str::to_string).into()
    );
}

#[test]
fn a_screen_that_must_be_and_cannot_is_an_error_before_anything_starts() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let output =
        kirk(&["run", "tests/live/once.rmpl", "--screen", "always", "--journal", journal.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("standard input is not a terminal"), "{}", stderr(&output));
    assert!(!journal.exists());
}

#[test]
fn what_commands_of_the_driver_print_comes_in_whole_lines_with_their_event_before_them() {
    // Both at the same time, in pieces that would mix.
    let speak =
        "for n in 1 2 3; do printf 'on'; sleep 0.03; printf 'ce '; done; echo; echo twice >&2; printf thrice";
    for quiet in ["-v", "-q"] {
        let arguments =
            ["run", "examples/rmpl/morning-lecture.rmpl", "--driver-command", speak, "--speed", "50", quiet];
        let output = start(&arguments).wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let told = stderr(&output);
        for activity in ["eat-breakfast", "review-scheduling-notes", "pack-bag", "bike-to-lecture"] {
            let lines: Vec<&str> =
                told.lines().filter_map(|line| line.strip_prefix(&format!("{activity}:start | "))).collect();
            assert_eq!(lines, ["once once once ", "twice", "thrice"], "{told}");
        }
        assert!(!stdout(&output).contains("once"));
    }
    // A child that speaks JSON has its standard error for people; what floods is counted.
    let flood = "stdio:yes flood | head -100000 >&2; examples/drivers/robot.sh";
    let output = start(&["run", "tests/live/once.rmpl", "--driver", flood, "--speed", "10"])
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let flood = stderr(&output).lines().filter(|line| *line == "driver | flood").count();
    assert!((100..2_000).contains(&flood), "{flood} lines");
    assert!(stderr(&output).contains("lines more, not shown"), "{}", stderr(&output));
}

/// A mission whose driver comes up only when a file is there, and the log of the driver.
fn waiting(folder: &Path, options: &[&str]) -> Child {
    let driver = format!("test -e {0}/up && echo $KIRK_DISPATCH_ID >> {0}/log", folder.display());
    let journal = folder.join("journal").display().to_string();
    let all =
        ["run", "tests/live/field.rmpl", "--speed", "10", "--format", "json", "--driver-command", &driver];
    start(&[&all[..], &["--journal", &journal], options].concat())
}

#[test]
fn the_clock_of_the_mission_starts_when_the_driver_first_confirms() {
    // Nobody is there for seven seconds of the mission, and its first event must be executed at its beginning.
    for patient in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let mut kirk = waiting(folder.path(), if patient { &["--wait-for-driver", "60"] } else { &[] });
        std::thread::sleep(Duration::from_millis(400));
        // Too early: what has not begun cannot have ended.
        let _ = writeln!(kirk.stdin.as_mut().unwrap(), "fly:end");
        std::thread::sleep(Duration::from_millis(300));
        std::fs::write(folder.path().join("up"), "").unwrap();
        let output = kirk.wait_with_output().unwrap();
        let execution: Value = serde_json::from_str(&stdout(&output)).unwrap();
        if !patient {
            assert_eq!(execution["failure"]["reason"], "driver-failed", "{execution}");
            continue;
        }
        completed(&output);
        assert_eq!(rows(&execution)["fly:start"], (Some(0.0), "dispatched".to_string()));
        assert_eq!(rows(&execution)["fly:end"], (Some(60.0), "imagined".to_string()));
        let told = stderr(&output);
        assert!(told.contains("fly:end  ignored: the mission has not begun"), "{told}");
        assert_eq!(told.matches("fly:start  not confirmed: the command ended with").count(), 1, "{told}");
        let journal = folder.path().join("journal");
        assert_eq!(kirk_replay(journal.to_str().unwrap()), execution);
        assert_eq!(lines(&folder.path().join("log")).len(), 3);
    }
}

#[test]
fn a_driver_that_does_not_come_up_in_time_ends_the_mission_before_it_begins() {
    let folder = tempfile::tempdir().unwrap();
    let output = waiting(folder.path(), &["--wait-for-driver", "0.5"]).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let execution: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(execution["failure"]["reason"], "driver-failed");
    let detail = execution["failure"]["detail"].as_str().unwrap();
    assert!(detail.starts_with("the driver did not confirm `fly:start` within 0.5 s"), "{detail}");
    let journal = folder.path().join("journal").display().to_string();
    let again = kirk(&["resume", &journal, "--format", "json"]);
    assert_eq!(again.status.code(), Some(1), "{}", stderr(&again));
    assert_eq!(serde_json::from_str::<Value>(&stdout(&again)).unwrap(), execution);
}

#[test]
fn a_mission_that_was_killed_before_its_clock_started_waits_on() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let mut mission = waiting(folder.path(), &["--wait-for-driver", "60"]);
    for _ in 0..3 {
        while !std::fs::read(&journal).is_ok_and(|bytes| bytes.contains(&b'\n')) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(300));
        mission.kill().unwrap();
        mission.wait().unwrap();
        // A command of the driver that is just starting may hold the journal a moment longer.
        std::thread::sleep(Duration::from_millis(300));
        mission = start(&["resume", journal.to_str().unwrap(), "--format", "json"]);
    }
    std::thread::sleep(Duration::from_millis(500));
    std::fs::write(folder.path().join("up"), "").unwrap();
    let output = mission.wait_with_output().unwrap();
    let execution = completed(&output);
    assert_eq!(rows(&execution)["fly:start"], (Some(0.0), "dispatched".to_string()));
    assert_eq!(kirk_replay(journal.to_str().unwrap()), execution);
    let told = lines(&folder.path().join("log"));
    assert_eq!(told.iter().collect::<BTreeSet<_>>().len(), 3, "{told:?}");
}

/// Seconds since 1970.
fn seconds_now() -> f64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64()
}

#[test]
fn several_executives_share_time_zero_also_one_that_was_killed_before() {
    let folder = tempfile::tempdir().unwrap();
    let zero = seconds_now().ceil() + 3.0;
    let date = Command::new("date").args(["-u", "-d", &format!("@{zero}"), "+%FT%TZ"]).output().unwrap();
    let date = stdout(&date).trim().to_string();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let begin = |name: &str| {
        let driver = format!("date +%s.%N >> {}", path(name));
        let journal = path(&format!("{name}-journal"));
        let arguments =
            ["run", "tests/live/field.rmpl", "--speed", "20", "--format", "json", "--journal", &journal];
        start(&[&arguments[..], &["--driver-command", &driver, "--start-at", &date]].concat())
    };
    let (one, mut two) = (begin("one"), begin("two"));
    std::thread::sleep(Duration::from_millis(700));
    two.kill().unwrap();
    two.wait().unwrap();
    let two = start(&["resume", &path("two-journal"), "--format", "json"]);
    let mut three = begin("three");
    writeln!(three.stdin.as_mut().unwrap(), "fly:end").unwrap();
    for (name, kirk) in [("one", one), ("two", two), ("three", three)] {
        let output = kirk.wait_with_output().unwrap();
        let execution = completed(&output);
        assert_eq!(rows(&execution)["fly:start"], (Some(0.0), "dispatched".to_string()));
        assert_eq!(rows(&execution)["fly:end"], (Some(60.0), "imagined".to_string()), "news came too early");
        let first: f64 = lines(&folder.path().join(name))[0].parse().unwrap();
        assert!(
            (zero..zero + 0.5).contains(&first),
            "{name} began at {first}, not at {zero}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn a_beginning_that_makes_no_sense_is_refused() {
    for (options, why) in [
        (&["--wait-for-driver", "5"][..], "there is none"),
        (&["--wait-for-driver", "0", "--driver-command", "true"], "greater than 0"),
        (&["--wait-for-driver", "5", "--driver-command", "true", "--start-at", "+5s"], "cannot be used with"),
        (&["--start-at", "2020-01-01T00:00:00Z"], "has to lie ahead"),
        (&["--start-at", "2040-01-01T00:00:00"], "expected a time with its offset"),
        (&["--start-at", "soon"], "expected a time with its offset"),
        (&["--start-at", "+soon"], "expected a time with its offset"),
        (&["--start-at=+0s"], "has to lie ahead"),
        (&["--start-at=+5s", "--simulate"], "cannot be used with"),
    ] {
        let output = kirk(&[&["run", "tests/live/once.rmpl"][..], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(why), "{options:?}: {}", stderr(&output));
    }
}

#[test]
fn the_drivers_of_the_examples_execute_a_mission() {
    let mut drivers = vec!["stdio:examples/drivers/robot.sh"];
    let has_python =
        Command::new("python3").arg("--version").output().is_ok_and(|output| output.status.success());
    if has_python {
        drivers.push("stdio:python3 examples/drivers/robot.py");
    }
    for driver in drivers {
        let kirk = start(&["run", DELIVERIES, "--driver", driver, "--speed", "20", "--format", "json"]);
        let output = kirk.wait_with_output().unwrap();
        let execution = completed(&output);
        verified(&execution, DELIVERIES);
        for (event, (_, how)) in rows(&execution) {
            // Half a second of the robot is ten of the mission.
            let expected =
                if event.starts_with("fly") && event.ends_with("end") { "observed" } else { continue };
            assert_eq!(how, expected, "{event} {driver}\n{}", stderr(&output));
        }
    }
}

#[test]
fn a_driver_that_fails_or_dies_or_hangs_is_tried_again_and_then_the_mission_fails() {
    let folder = tempfile::tempdir().unwrap();
    let count = folder.path().join("count");
    let failure = folder.path().join("failure");
    // It works the third time.
    let flaky = format!("echo x >> {0}; test $(wc -l < {0}) -ge 3", count.display());
    let kirk = start(&[
        "run",
        "tests/live/once.rmpl",
        "--driver-command",
        &flaky,
        "--speed",
        "10",
        "--format",
        "json",
    ]);
    let output = kirk.wait_with_output().unwrap();
    completed(&output);
    assert_eq!(lines(&count).len(), 3);
    for (driver, reason) in [
        ("stdio:exit 3", "exit status: 3"),
        ("stdio:sleep 60", "no answer within 0.3 s"),
        ("stdio:echo nonsense; sleep 60", "no answer within 0.3 s"),
    ] {
        let tell = format!("echo \"$KIRK_REASON $KIRK_EVENT $KIRK_DETAIL\" > {}", failure.display());
        let arguments =
            ["--driver", driver, "--driver-timeout", "0.3", "--on-failure", &tell, "--speed", "10"];
        let mut all = vec!["run", "tests/live/once.rmpl"];
        all.extend(arguments);
        let output = start(&all).wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{driver}: {}", stderr(&output));
        let told = lines(&failure).join(" ");
        assert!(told.starts_with("driver-failed go:start") && told.contains(reason), "{driver}: {told}");
    }
}

/// Kills a mission again and again, and has it go on each time.
#[test]
fn a_mission_that_is_killed_at_every_step_goes_on_and_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let journal = journal.to_str().unwrap();
    let log = folder.path().join("robot");
    let command = format!("echo ~A $KIRK_DISPATCH_ID $(date +%s.%N) >> {}", log.display());
    let mut random = fastrand::Rng::with_seed(7);
    let mut mission = start(&[
        "run",
        DELIVERIES,
        "--driver-command",
        &command,
        "--speed",
        "8",
        "--journal",
        journal,
        "--format",
        "json",
    ]);
    let begun = Instant::now();
    // Before it has begun there is nothing to go on with.
    while !std::fs::read(journal).is_ok_and(|bytes| bytes.contains(&b'\n')) {
        std::thread::sleep(Duration::from_millis(1));
    }
    // What is recorded apart from that it goes on.
    let records = || lines(Path::new(journal)).iter().filter(|line| !line.contains(r#""resumed""#)).count();
    let (mut kills, mut patience, mut recorded) = (0, 25, 0);
    let output = loop {
        assert!(begun.elapsed() < Duration::from_secs(120), "{kills} kills and no end");
        // A busy machine takes longer to begin than a quiet one to do something.
        patience = if records() == recorded { patience * 5 / 4 } else { (patience * 4 / 5).max(25) };
        recorded = records();
        let until = Instant::now() + Duration::from_millis(random.u64(1..patience));
        let mut ended = false;
        while Instant::now() < until && !ended {
            // Flights and deliveries are over after half a second, four in the mission; that is said until it is heard.
            let now =
                std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64();
            for line in lines(&log) {
                let words: Vec<&str> = line.split(' ').collect();
                let [event, _, at] = words[..] else { continue };
                let started: f64 = at.parse().unwrap_or(f64::MAX);
                if !event.contains("LOAD") && now > started + 0.55 {
                    let end = event.replace("::START+", "::END+");
                    // It may be dead already.
                    let _ = writeln!(mission.stdin.as_ref().unwrap(), "{end}");
                }
            }
            ended = mission.try_wait().unwrap().is_some();
            std::thread::sleep(Duration::from_millis(5));
        }
        if ended {
            break mission.wait_with_output().unwrap();
        }
        mission.kill().unwrap();
        mission.wait().unwrap();
        kills += 1;
        mission = start(&["resume", journal, "--format", "json"]);
    };
    assert!(kills > 30, "only {kills} kills: {}", stderr(&output));
    let execution = completed(&output);
    verified(&execution, DELIVERIES);

    let checked = kirk(&["verify", journal, DELIVERIES, "-q"]);
    assert_eq!(checked.status.code(), Some(0), "{}", stdout(&checked));

    // It is in the journal as it was, and nothing was handed over after it was confirmed.
    let replayed = kirk_replay(journal);
    assert_eq!(replayed, execution);
    let text = std::fs::read_to_string(journal).unwrap();
    let mut confirmed: BTreeSet<String> = BTreeSet::new();
    let mut sent: BTreeSet<String> = BTreeSet::new();
    for line in text.lines() {
        let line: Value = serde_json::from_str(&line[9..]).unwrap();
        let record = &line["record"]["in"];
        if let Some(id) = record["executed"]["id"].as_str() {
            confirmed.insert(id.to_string());
        }
        if let Some(id) = record["sent"]["id"].as_str() {
            assert!(!confirmed.contains(id), "{id} was handed over again\n{text}");
            sent.insert(id.to_string());
        }
    }
    assert_eq!(sent.len(), 18);
    let told: BTreeSet<String> =
        lines(&log).iter().filter_map(|line| line.split(' ').nth(1).map(str::to_string)).collect();
    assert_eq!(told, sent, "the robot has heard of everything, under the same ids");
    let again = kirk(&["resume", journal, "--format", "json", "-q"]);
    assert_eq!(completed(&again), execution, "a mission that is over is not executed again");
}

fn kirk_replay(journal: &str) -> Value {
    completed(&kirk(&["replay", journal, "--format", "json", "-q"]))
}

#[test]
fn a_torn_record_is_left_out_and_a_damaged_one_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let path = journal.to_str().unwrap();
    let file = "examples/rmpl/eat-and-bike.rmpl";
    let mission = start(&["run", file, "--speed", "100", "--journal", path, "--format", "json", "-q"]);
    let execution = completed(&mission.wait_with_output().unwrap());
    let whole = std::fs::read(&journal).unwrap();
    assert_eq!(kirk_replay(path), execution);

    let twice = kirk(&["run", file, "--speed", "100", "--journal", path]);
    assert_eq!(twice.status.code(), Some(2));
    assert!(stderr(&twice).contains("does not overwrite"), "{}", stderr(&twice));
    assert_eq!(std::fs::read(&journal).unwrap(), whole);

    // Without its end, and a part of the record before: there is something left to do.
    let end = whole[..whole.len() - 1].iter().rposition(|&byte| byte == b'\n').unwrap();
    std::fs::write(&journal, &whole[..end - 5]).unwrap();
    let resumed = kirk(&["resume", path, "--at", "16", "--format", "json"]);
    assert_eq!(completed(&resumed)["rows"].as_array().unwrap().len(), 6);
    assert!(stderr(&resumed).contains("the last record was torn"), "{}", stderr(&resumed));

    let mut damaged = whole.clone();
    let middle = damaged.iter().position(|&byte| byte == b'\n').unwrap() + 20;
    damaged[middle] ^= 1;
    std::fs::write(&journal, &damaged).unwrap();
    for command in ["resume", "replay"] {
        let output = kirk(&[command, path]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("line 2: it is damaged"), "{}", stderr(&output));
    }
    assert_eq!(std::fs::read(&journal).unwrap(), damaged, "a damaged journal is not touched");
    for nothing in [&b""[..], b"no journal at all\n", b"\0\0\0\0\0\0\0\0\0\0\0"] {
        std::fs::write(&journal, nothing).unwrap();
        let output = kirk(&["replay", path]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    }
}

#[test]
fn windows_that_were_missed_while_nobody_was_there_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal");
    let path = journal.to_str().unwrap();
    let mut mission =
        start(&["run", "examples/rmpl/eat-and-bike.rmpl", "--speed", "20", "--journal", path, "-q"]);
    std::thread::sleep(Duration::from_millis(300));
    mission.kill().unwrap();
    mission.wait().unwrap();
    // Both together take 40 at most; it is 1000 now.
    let output = kirk(&["resume", path, "--at", "1000", "--format", "json"]);
    assert_eq!(output.status.code(), Some(1));
    let execution: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(execution["failure"]["reason"], "missed-window");
    assert!(
        execution["failure"]["detail"].as_str().unwrap().contains("until 20 s at the latest"),
        "{execution}"
    );
    let before = kirk(&["resume", path, "--at", "1"]);
    assert_eq!(before.status.code(), Some(1), "it is over: {}", stderr(&before));
}

#[test]
fn a_full_disk_ends_the_mission_before_anything_leaves_unrecorded() {
    let folder = tempfile::tempdir().unwrap();
    let (journal, log) = (folder.path().join("journal"), folder.path().join("log"));
    // No file may grow beyond 10 KiB (20 blocks of 512 bytes).
    let script = format!(
        "trap '' XFSZ; ulimit -f 20; exec '{}' run {DELIVERIES} --driver-command 'echo $KIRK_DISPATCH_ID >> {}' --speed 20 \
         --journal {} --format json -q",
        env!("CARGO_BIN_EXE_kirk"),
        log.display(),
        journal.display(),
    );
    let output = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}{}", stdout(&output), stderr(&output));
    let execution: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(execution["failure"]["reason"], "journal-failed", "{execution}");
    // Everything the robot has heard of is in the journal.
    let recorded = std::fs::read_to_string(&journal).unwrap();
    for id in lines(&log) {
        assert!(recorded.contains(&id), "{id}\n{recorded}");
    }
    let full = kirk(&["run", DELIVERIES, "--journal", "/dev/full"]);
    assert_eq!(full.status.code(), Some(2));
    let nowhere = kirk(&["run", DELIVERIES, "--journal", "/proc/journal"]);
    assert_eq!(nowhere.status.code(), Some(2));
}

#[test]
fn a_mission_with_names_a_shell_could_misread_is_refused_for_a_driver_command() {
    let network =
        r#"{"format":"kirk-network/1","origin":"z","events":["z","$(reboot):start","$(reboot):end"]}"#;
    let output = binary::kirk_with_input(&["run", "-", "--driver-command", "echo ~A"], network.as_bytes());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`$(reboot):start`"), "{}", stderr(&output));
}
