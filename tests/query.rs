//! `kirk query` and rehearsals with `--what-if`: what is said of missions, records and journals, and of wrong questions.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration as Real, Instant};

use binary::{kirk, kirk_with_input, stderr, stdout};
use kirk_network::{Duration, Network, Time};
use kirk_runtime::journal::{Clocks, Line, Record, Start, Trace, write};
use kirk_runtime::{Executive, Input, Patience, Plan, Scope, Settings, Setup, Speed, Strategy, handovers};
use serde_json::{Value, json};

const ROBOT: &str = "examples/rmpl/robot.rmpl";
const DOWNLINK: &str = "human-downlink-science:end";

/// What commands say, each with its exit status.
fn session(commands: &[&[&str]]) -> String {
    let mut all = String::new();
    for command in commands {
        let output = kirk(command);
        let shown = command.iter().map(|word| word.rsplit('/').next().unwrap()).collect::<Vec<_>>().join(" ");
        let (mut said, code) = (stderr(&output) + &stdout(&output), output.status.code().unwrap());
        // A folder of the test has another name each time.
        for word in command.iter().filter(|word| word.starts_with('/')) {
            said = said.replace(word, word.rsplit('/').next().unwrap());
        }
        all.push_str(&format!("$ kirk {shown}\n{said}[{code}]\n\n"));
    }
    all
}

fn query<'a>(file: &'a str, rest: &[&'a str]) -> Vec<&'a str> {
    [&["query", file], rest].concat()
}

#[test]
fn a_mission_is_asked() {
    insta::assert_snapshot!(session(&[
        &query(ROBOT, &[]),
        &query(ROBOT, &["--at", "22"]),
        &query(ROBOT, &["--event", "robot-poweroff:end", "--event", DOWNLINK, "--event", "main:start"]),
        &query(ROBOT, &["--heard", "human-downlink-science:end@22"]),
        &query(
            ROBOT,
            &[
                "--heard",
                "human-downlink-science:end@22",
                "--heard",
                "robot-drilling:end@46",
                "--event",
                "main:end"
            ]
        ),
        &query(ROBOT, &["--why", "robot-poweroff:end", "--why", "main:start"]),
    ]));
}

#[test]
fn news_the_model_rules_out_breaks_something_or_nothing() {
    insta::assert_snapshot!(session(&[
        &query(ROBOT, &["--heard", "human-downlink-science:end@3"]),
        &query(ROBOT, &["--heard", "human-downlink-science:end@60"]),
        &query("examples/rmpl/drive-to-lecture.rmpl", &["--heard", "drive-to-lecture:end@80"]),
        &["run", ROBOT, "-q", "--simulate", "--observe", "human-downlink-science:end@60"],
        &["run", ROBOT, "-q", "--simulate", "--observe", "human-downlink-science:end@60", "--what-if"],
        &["run", ROBOT, "-q", "--simulate", "--observe", "human-downlink-science:end@30", "--what-if"],
        &[
            "run",
            "examples/rmpl/drive-to-lecture.rmpl",
            "-q",
            "--simulate",
            "--observe",
            "drive-to-lecture:end@80",
            "--what-if"
        ],
    ]));
}

#[test]
fn a_record_is_asked_with_its_mission() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json").display().to_string();
    let run =
        kirk(&["run", ROBOT, "--simulate", "--observe", "human-downlink-science:end@22", "--format", "json"]);
    fs::write(&record, stdout(&run)).unwrap();
    let with = |rest: &[&'static str]| [&["query", &record, ROBOT], rest].concat();
    insta::assert_snapshot!(session(&[
        &with(&[]),
        &with(&["--at", "10"]),
        &with(&["--at", "30"]),
        &with(&["--at", "30", "--why", "main:end"]),
        &with(&["--at", "30", "--heard", "robot-drilling:end@29"]),
        &["query", &record],
        &["query", &record, "examples/rmpl/glider.rmpl"],
    ]));
    let from_input = kirk_with_input(&["query", "-", ROBOT, "--at", "30"], stdout(&run).as_bytes());
    assert_eq!(stdout(&from_input), stdout(&kirk(&with(&["--at", "30"]))));
}

/// The journal of a mission in which this was heard, up to a time.
fn journal(network: &Network, news: &[(i64, &str)], until: i64) -> String {
    journal_of(network, news, until, false)
}

/// The same, and there may be a driver, which confirms nothing.
fn journal_of(network: &Network, news: &[(i64, &str)], until: i64, driver: bool) -> String {
    let seconds = |seconds: i64| Time::from_micros(seconds * 1_000_000);
    let setup = Setup {
        program: "main".into(),
        run: "r".into(),
        settings: Settings::of(Strategy::Optimistic),
        handovers: if driver { handovers(network, None, Scope::All) } else { Vec::new() },
        driver,
        patience: Patience { first: Duration::ZERO, most: Duration::ZERO },
    };
    let clocks = Clocks { boot: None, since_boot: 0, calendar: 0 };
    let nothing = serde_json::value::RawValue::from_string("null".into()).unwrap();
    let start = Start::new(network, &setup, Speed::REAL, clocks, nothing, "0");
    let mut lines = vec![Line::new(Time::ZERO, Record::Start(Box::new(start)))];
    let mut executive = Executive::new(Plan::new(network).unwrap(), setup);
    let mut news = news.iter().map(|&(at, event)| (seconds(at), event)).peekable();
    let mut now = Time::ZERO;
    let mut take = |executive: &mut Executive, now: Time, input: Input| {
        let record = executive.handle(now, input).record;
        lines.extend(record.map(|input| Line::new(now, Record::In(input))));
        while executive.poll_output().is_some() {}
    };
    while now <= seconds(until) {
        match news.next_if(|(at, _)| *at <= now) {
            Some((_, event)) => take(&mut executive, now, Input::Observed { event: event.into() }),
            None => take(&mut executive, now, Input::Timeout {}),
        }
        while let Some(rebuild) = executive.poll_rebuild(now) {
            take(&mut executive, now, Input::rebuilt(rebuild.run()));
        }
        let heard = news.peek().map(|(at, _)| *at);
        match executive.poll_timeout().into_iter().chain(heard).min() {
            Some(next) => now = next.max(now),
            None => break,
        }
    }
    if executive.is_over() {
        let execution = executive.execution(now, false);
        lines.push(Line::new(now, Record::Out(Trace::End { execution })));
    }
    let mut checksum = 0;
    lines
        .iter()
        .map(|line| {
            let (text, next) = write(line, checksum);
            checksum = next;
            text
        })
        .collect()
}

/// If `b` is heard too early, `c` can be no more than 20 s after it or at least 40 s after `a`, not both.
const TIGHT: &str = r#"{"format": "kirk-network/1", "name": "tight", "origin": "a", "events": ["a", "b", "c"],
    "requirements": [{"from": "b", "to": "c", "lower": 5, "upper": 20}, {"from": "a", "to": "c", "lower": 40}],
    "contingents": [{"from": "a", "to": "b", "lower": 20, "upper": 30}]}"#;

/// A text without what comes after a line that contains this.
fn cut_after(text: &str, last: &str) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let at = lines.iter().position(|line| line.contains(last)).unwrap();
    lines[..=at].concat()
}

fn robot() -> Network {
    let text = stdout(&kirk(&["compile", ROBOT, "-q", "--format", "json"]));
    kirk_network::json::read(&text).unwrap()
}

#[test]
fn a_journal_is_asked_whole_or_torn() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (over, half, torn, broken) = (file("over"), file("half"), file("torn"), file("broken"));
    fs::write(&over, journal(&robot(), &[(22, DOWNLINK), (46, "robot-drilling:end")], 100)).unwrap();
    let begun = journal(&robot(), &[(22, DOWNLINK)], 25);
    fs::write(&half, &begun).unwrap();
    // The last line was being written.
    fs::write(&torn, &begun[..begun.len() - 10]).unwrap();
    fs::write(&broken, begun.replacen("timeout", "timeouts", 1).replacen("news", "mews", 1)).unwrap();
    insta::assert_snapshot!(session(&[
        &query(&over, &[]),
        &query(&over, &["--at", "30"]),
        &query(&half, &[]),
        &query(&half, &["--why", "main:end"]),
        &query(&half, &["--heard", "robot-drilling:end@60"]),
        &query(&torn, &[]),
        &query(&broken, &[]),
        &["query", &half, ROBOT],
    ]));
}

#[test]
fn a_journal_that_ends_with_news_against_the_model_is_planned_on() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (late, early, lost) = (file("late"), file("early"), file("lost"));
    let up_to_news = |network: &Network, at: i64, event: &str| {
        cut_after(&journal(network, &[(at, event)], 100), "\"observed\"")
    };
    fs::write(&late, up_to_news(&robot(), 60, DOWNLINK)).unwrap();
    fs::write(&early, up_to_news(&robot(), 3, DOWNLINK)).unwrap();
    let tight = kirk_network::json::read(TIGHT).unwrap();
    fs::write(&lost, up_to_news(&tight, 12, "b")).unwrap();
    insta::assert_snapshot!(session(&[
        &query(&late, &[]),
        &query(&late, &["--at", "70"]),
        &query(&late, &["--at", "59"]),
        &query(&early, &[]),
        &query(&lost, &[]),
        &query(&lost, &["--at", "11"]),
        &query(&lost, &["--at", "60"]),
    ]));
}

#[test]
fn news_that_waits_for_a_driver_is_counted_with() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("held").display().to_string();
    let text = cut_after(&journal_of(&robot(), &[(22, DOWNLINK)], 25, true), "\"observed\"");
    fs::write(&file, text).unwrap();
    insta::assert_snapshot!(session(&[
        &query(&file, &[]),
        &query(&file, &["--heard", "robot-drilling:end@60"])
    ]));
}

#[test]
fn a_record_of_a_failure_is_asked_before_and_after_it() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json").display().to_string();
    let network = folder.path().join("tight.json").display().to_string();
    fs::write(&network, TIGHT).unwrap();
    let run = ["run", &network, "--simulate", "--observe", "b@12", "--what-if", "--format", "json"];
    fs::write(&record, stdout(&kirk(&run))).unwrap();
    let with = |rest: &[&'static str]| [&["query", &record, &network], rest].concat();
    insta::assert_snapshot!(session(&[&with(&[]), &with(&["--at", "11"]), &with(&["--at", "60"])]));
}

#[test]
fn a_pipe_is_asked_and_read_once() {
    let asked = |file: &str, input: &[u8]| kirk_with_input(&["query", file, "--at", "22"], input);
    let text = fs::read(ROBOT).unwrap();
    let whole = kirk(&query(ROBOT, &["--at", "22"]));
    let half = journal(&robot(), &[(22, DOWNLINK)], 25);
    for file in ["-", "/dev/stdin"] {
        assert_eq!(stdout(&asked(file, &text)), stdout(&whole), "{file}");
        assert!(stdout(&asked(file, half.as_bytes())).contains("robot-drilling:end"), "{file}");
    }
}

#[test]
fn a_mission_that_is_running_is_asked_without_disturbing_it() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal").display().to_string();
    let mut running = Command::new(env!("CARGO_BIN_EXE_kirk"))
        .args(["run", "tests/live/field.rmpl", "-q", "--journal", &journal])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let patience = Instant::now() + Real::from_secs(60);
    while !fs::read(&journal).is_ok_and(|bytes| bytes.contains(&b'\n')) {
        assert!(Instant::now() < patience, "no journal");
        std::thread::yield_now();
    }
    let before = fs::read(&journal).unwrap();
    let asked = kirk(&["query", &journal, "--format", "json", "--event", "fly:end", "--why", "upload:end"]);
    let is_running = running.try_wait().unwrap().is_none();
    running.kill().unwrap();
    running.wait().unwrap();
    assert!(is_running, "it was not disturbed");
    assert_eq!(asked.status.code(), Some(0), "{}{}", stdout(&asked), stderr(&asked));
    assert!(fs::read(&journal).unwrap().starts_with(&before));
    let document: Value = serde_json::from_str(&stdout(&asked)).unwrap();
    assert_eq!((&document["format"], &document["outcome"]), (&json!("kirk-query/1"), &json!("running")));
    let event = &document["events"][0];
    assert_eq!((&event["whose"], &event["latest"]), (&json!("nature"), &json!(60)));
    assert_eq!(document["why"][0]["chain"][0]["time"], 63);
}

/// `b` is heard 5 to 8 s late, and `c` is to come 5 to 20 s after it.
const NETWORK: &str = r#"{"format": "kirk-network/1", "name": "n", "origin": "a", "events": ["a", "b", "c"],
    "requirements": [{"from": "b", "to": "c", "lower": 5, "upper": 20}],
    "contingents": [{"from": "a", "to": "b", "lower": 20, "upper": 40, "delay": [5, 8]}]}"#;

#[test]
fn programs_can_read_the_answers() {
    let ask = |rest: &[&str]| -> Value {
        let output =
            kirk_with_input(&[&["query", "-", "--format", "json"], rest].concat(), NETWORK.as_bytes());
        serde_json::from_str(&stdout(&output)).unwrap()
    };
    let document = ask(&["--event", "c", "--event", "b", "--heard", "b@30", "--why", "c"]);
    assert_eq!(document["events"][0]["promise"], json!({"by": 45, "not_before": 40}));
    assert_eq!(document["events"][1]["heard"], json!({"earliest": 25, "latest": 48}));
    assert_eq!(document["heard"], json!([{"event": "b", "at": 30, "verdict": "possible"}]));
    let after = &document["after"]["events"];
    // It was at 25 at the latest, so `c` is done at once.
    assert_eq!((&after[0]["earliest"], &after[0]["latest"]), (&json!(30), &json!(30)));
    assert_eq!(
        (&after[0]["done"], &after[0]["exact"]),
        (&json!(30), &json!({"earliest": true, "latest": true}))
    );
    assert_eq!(
        (&after[1]["done"], &after[1]["earliest"], &after[1]["latest"]),
        (&json!(30), &json!(22), &json!(25))
    );
    let broken = ask(&["--heard", "b@90"]);
    assert_eq!(broken["heard"][0]["verdict"], "broken-model");
    assert_eq!(broken["heard"][0]["aftermath"]["guaranteed"], true);
    assert_eq!(broken["heard"][0]["aftermath"]["in_doubt"][0]["to"], "c");
}

#[test]
fn wrong_questions_are_refused() {
    let record = r#"{"format":"kirk-execution/1","program":"main","outcome":"tea","makespan":0,"rows":[]}"#;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("record.json").display().to_string();
    fs::write(&file, record).unwrap();
    let wrong: [(&[&str], &str); 14] = [
        (&[ROBOT, "--event", "robot-driling:end"], "did you mean `robot-drilling:end`?"),
        (&[ROBOT, "--why", "tea:end"], "there is no event `tea:end`"),
        (&[ROBOT, "--heard", "tea:end@5"], "there is no event `tea:end`"),
        (&[ROBOT, "--heard", "sync:end@5"], "is not Nature's to decide"),
        (&[ROBOT, "--heard", "human-downlink-science:end"], "EVENT@T"),
        (&[ROBOT, "--at", "30", "--heard", "human-downlink-science:end@29"], "is in the past: it is 30 s"),
        (&[ROBOT, "--heard", "robot-drilling:end@1"], "it has not begun"),
        (
            &[ROBOT, "--heard", "human-downlink-science:end@22", "--heard", "sync:start@25"],
            "names of one event",
        ),
        (&[ROBOT, "--at=-3"], "before the mission starts"),
        (&[ROBOT, "--at", "soon"], "a time is in seconds after the start"),
        (&["no/such/file"], "K0701"),
        (&["no/such/file.rmpl"], "K0701"),
        (&[&file, ROBOT], "K0803"),
        (&["-", "-"], "is given twice"),
    ];
    for (arguments, said) in wrong {
        let output = kirk(&[&["query"], arguments].concat());
        assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(2), ""), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
    }
    let no = kirk(&["query", "examples/rmpl/too-late.rmpl"]);
    assert_eq!((no.status.code(), stderr(&no).contains("K0601")), (Some(1), true));
    let no = kirk(&["query", "examples/rmpl/too-late.rmpl", "--format", "json"]);
    let document: Value = serde_json::from_str(&stdout(&no)).unwrap();
    assert_eq!((no.status.code(), &document["guaranteed"]), (Some(1), &json!(false)));
    let alone = kirk(&["run", ROBOT, "--what-if"]);
    assert_eq!(alone.status.code(), Some(2));
}
