//! A hostile world around a mission: signals at the wrong moment, journals that vanish, drivers that talk too much.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use binary::{kirk, stderr, stdout};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use tempfile::TempDir;

const ONCE: &str = "tests/live/once.rmpl";

/// Starts `kirk` with these arguments, its output and errors to be read at the end.
fn start(arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_kirk"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// A folder with room for a journal and a log.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn new() -> Desk {
        Desk { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn journal(&self) -> String {
        self.path("journal").to_str().unwrap().to_string()
    }

    /// Starts a mission with a journal.
    fn run(&self, file: &str, arguments: &[&str]) -> Child {
        let journal = self.journal();
        let mut all = vec!["run", file, "--journal", &journal, "--format", "json"];
        all.extend(arguments);
        start(&all)
    }

    /// The records of one kind that are in the journal: the start, what happened, or what came of it.
    fn records(&self, kind: &str) -> Vec<Value> {
        let text = fs::read_to_string(self.path("journal")).unwrap_or_default();
        let lines = text.lines().filter_map(|line| serde_json::from_str::<Value>(line.get(9..)?).ok());
        let found = |record: &Value| {
            [record, &record["in"], &record["out"]].into_iter().find_map(|record| record.get(kind)).cloned()
        };
        lines.filter_map(|line| found(&line["record"])).collect()
    }

    fn lines(&self, name: &str) -> Vec<String> {
        fs::read_to_string(self.path(name)).unwrap_or_default().lines().map(str::to_string).collect()
    }
}

/// Waits until something is so.
fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(60), "never: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn interrupt(child: &Child) {
    kill_process(Pid::from_child(child), Signal::INT).unwrap();
}

fn execution(output: &Output) -> Value {
    serde_json::from_str(&stdout(output)).unwrap_or_else(|_| panic!("{}", stderr(output)))
}

#[test]
fn a_mission_that_is_stopped_waits_for_what_the_driver_is_at() {
    let desk = Desk::new();
    let log = desk.path("log");
    let command = format!("echo begun >> {0}; sleep 1; echo done >> {0}", log.display());
    let mission = desk.run(ONCE, &["--driver-command", &command, "--speed", "0.5"]);
    until("it has begun", || !desk.lines("log").is_empty());
    interrupt(&mission);
    let output = mission.wait_with_output().unwrap();
    assert_eq!(
        (output.status.code(), execution(&output)["failure"]["reason"].as_str()),
        (Some(1), Some("stopped"))
    );
    assert!(stderr(&output).contains("the driver has answered for go:start"), "{}", stderr(&output));
    assert_eq!(desk.lines("log"), ["begun", "done"]);
    assert_eq!(desk.records("executed").len(), 1);
    let resumed = kirk(&["resume", &desk.journal(), "--format", "json"]);
    assert_eq!(execution(&resumed)["outcome"], "completed", "{}", stderr(&resumed));
    assert_eq!(desk.lines("log"), ["begun", "done"], "it is not begun again");
}

#[test]
fn a_mission_that_is_stopped_before_its_driver_is_up_can_be_gone_on_with() {
    let desk = Desk::new();
    let command =
        format!("echo asked >> {}; test -e {}", desk.path("log").display(), desk.path("up").display());
    let options = ["--driver-command", &command, "--wait-for-driver", "60", "--speed", "10"];
    let mission = desk.run("tests/live/field.rmpl", &options);
    until("it is asked for", || !desk.lines("log").is_empty());
    interrupt(&mission);
    let output = mission.wait_with_output().unwrap();
    let stopped = execution(&output);
    assert_eq!(
        (output.status.code(), &stopped["failure"]["reason"]),
        (Some(1), &"stopped".into()),
        "{stopped}"
    );
    fs::write(desk.path("up"), "").unwrap();
    let resumed = kirk(&["resume", &desk.journal(), "--format", "json"]);
    assert_eq!(execution(&resumed)["outcome"], "completed", "{}", stderr(&resumed));
}

#[test]
fn news_that_cannot_be_recorded_is_not_acknowledged() {
    let desk = Desk::new();
    let mut mission = desk.run("tests/live/field.rmpl", &["--port", "0"]);
    let mut said = BufReader::new(mission.stderr.take().unwrap()).lines();
    let heard_at = |line: Result<String, _>| {
        line.unwrap()
            .strip_prefix("news is heard at http://")
            .map(|rest| rest.trim_end_matches('/').to_string())
    };
    let address = said.find_map(heard_at).unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    // It is not noticed before something is written.
    fs::remove_file(desk.path("journal")).unwrap();
    let body = r#"{"event-ids": ["fly:end"]}"#;
    write!(stream, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n{body}", body.len())
        .unwrap();
    let mut answer = String::new();
    let _ = stream.read_to_string(&mut answer);
    assert!(!answer.contains("fly:end"), "{answer}");
    let ended = mission.wait_with_output().unwrap();
    assert_eq!(execution(&ended)["failure"]["reason"], "journal-failed");
}

#[test]
fn a_mission_that_is_stopped_waits_no_longer_than_an_attempt_may_take() {
    let desk = Desk::new();
    let command = format!("echo begun >> {}; sleep 60", desk.path("log").display());
    let mission = desk.run(ONCE, &["--driver-command", &command, "--driver-timeout", "0.7"]);
    until("it has begun", || !desk.lines("log").is_empty());
    interrupt(&mission);
    assert_eq!(mission.wait_with_output().unwrap().status.code(), Some(1));
    let failed = desk.records("failed");
    assert!(failed.len() == 1 && failed[0]["doubt"] == true, "{failed:?}");
    assert_eq!(desk.lines("log").len(), 1, "it is not tried again");
}

#[test]
fn a_second_signal_does_not_wait() {
    let desk = Desk::new();
    let command = format!("echo begun >> {}; exec sleep 7", desk.path("log").display());
    let mission = desk.run(ONCE, &["--driver-command", &command, "--driver-timeout", "60"]);
    until("it has begun", || !desk.lines("log").is_empty());
    let begun = Instant::now();
    interrupt(&mission);
    std::thread::sleep(Duration::from_millis(300));
    interrupt(&mission);
    // What the command has open of ours is not waited for.
    let mut mission = mission;
    assert_eq!(mission.wait().unwrap().code(), Some(1));
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
}

/// What somebody may do to a journal.
type Spoil<'a> = &'a dyn Fn(&Path);

/// What is done to a journal while its mission is executed, and what is said of it.
#[test]
fn a_journal_that_is_lost_while_the_mission_runs_is_noticed() {
    let replace = |journal: &Path| {
        let copy = journal.with_extension("copy");
        fs::copy(journal, &copy).unwrap();
        fs::rename(copy, journal).unwrap();
    };
    let truncate = |journal: &Path| File::options().write(true).open(journal).unwrap().set_len(10).unwrap();
    let overwrite = |journal: &Path| fs::write(journal, "something else").unwrap();
    let ways: [(&str, Spoil); 4] = [
        ("deleted", &|journal| fs::remove_file(journal).unwrap()),
        ("another file put in its place", &replace),
        ("it has 10 bytes", &truncate),
        ("it has 14 bytes", &overwrite),
    ];
    for (said, spoil) in ways {
        let desk = Desk::new();
        // Nothing is due for a long time: it is noticed all the same.
        let mission = desk.run("examples/rmpl/eat-and-bike.rmpl", &["--speed", "0.1"]);
        until("it has begun", || !desk.records("timeout").is_empty() || !desk.records("start").is_empty());
        std::thread::sleep(Duration::from_millis(200));
        spoil(&desk.path("journal"));
        let output = mission.wait_with_output().unwrap();
        let failure = &execution(&output)["failure"];
        assert_eq!((output.status.code(), failure["reason"].as_str()), (Some(1), Some("journal-failed")));
        assert!(failure["detail"].as_str().unwrap().contains(said), "{failure}");
    }
}

#[test]
fn no_copy_of_a_journal_is_gone_on_with_while_its_mission_runs() {
    let desk = Desk::new();
    let mut mission = desk.run("examples/rmpl/eat-and-bike.rmpl", &["--speed", "0.1"]);
    until("it has begun", || !desk.records("start").is_empty());
    let copy = desk.path("copy");
    fs::copy(desk.path("journal"), &copy).unwrap();
    for journal in [desk.path("journal"), copy.clone()] {
        let refused = kirk(&["resume", journal.to_str().unwrap()]);
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        assert!(stderr(&refused).contains("is in use"), "{}", stderr(&refused));
    }
    mission.kill().unwrap();
    mission.wait().unwrap();
    let resumed = kirk(&["resume", copy.to_str().unwrap(), "--at", "1000"]);
    assert_eq!(resumed.status.code(), Some(1), "the window is missed: {}", stderr(&resumed));
}

#[test]
fn resume_waits_a_moment_for_the_lock() {
    let desk = Desk::new();
    let mut mission = desk.run(ONCE, &["--speed", "0.1"]);
    until("it has begun", || !desk.records("start").is_empty());
    mission.kill().unwrap();
    mission.wait().unwrap();
    let lock = File::open(desk.path("journal")).unwrap();
    lock.lock().unwrap();
    let resumed = start(&["resume", &desk.journal(), "--at", "1000"]);
    std::thread::sleep(Duration::from_millis(700));
    drop(lock);
    let output = resumed.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "the window is missed: {}", stderr(&output));
}

#[test]
fn what_is_no_file_is_no_journal() {
    let desk = Desk::new();
    let pipe = desk.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for path in ["/dev/zero", "/dev/null", pipe.to_str().unwrap()] {
        for arguments in [vec!["resume", path], vec!["run", ONCE, "--journal", path]] {
            let begun = Instant::now();
            let output = kirk(&arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
            assert!(stderr(&output).contains("is no file"), "{arguments:?}: {}", stderr(&output));
            assert!(begun.elapsed() < Duration::from_secs(5), "{arguments:?}");
        }
    }
    let huge = desk.path("huge");
    File::create(&huge).unwrap().set_len(1 << 40).unwrap();
    let output = kirk(&["resume", huge.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("bytes; kirk does not read that"), "{}", stderr(&output));
}

#[test]
fn a_driver_that_repeats_itself_does_not_fill_the_journal() {
    let desk = Desk::new();
    // It confirms everything 500 times, and once more each time it hears anything.
    let driver = r#"stdio:while read -r line; do id=$(echo "$line" | sed -n 's/.*"id":"\([^"]*\)".*/\1/p');
        [ -z "$id" ] || for n in $(seq 500); do echo "{\"executed\": \"$id\"}"; echo "{\"failed\": {\"id\": \"$id\"}}"; done; done"#;
    let output = desk.run(ONCE, &["--driver", driver]).wait_with_output().unwrap();
    assert_eq!(execution(&output)["outcome"], "completed", "{}", stderr(&output));
    assert_eq!((desk.records("executed").len(), desk.records("failed").len()), (1, 0));
}

#[test]
fn a_driver_that_complains_and_dies_again_and_again_does_not_fill_the_journal() {
    let desk = Desk::new();
    let driver = "stdio:for n in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do echo nonsense $n; done";
    let output = desk.run(ONCE, &["--driver", driver, "--speed", "2"]).wait_with_output().unwrap();
    assert_eq!(execution(&output)["failure"]["reason"], "driver-failed", "{}", stderr(&output));
    let told = stderr(&output).matches("which kirk does not understand").count();
    let recorded = desk.records("warning").len();
    assert!(told > 150 && recorded == 100, "{told} told, {recorded} recorded");
}

/// The port is open before it is known how the mission stood, and what is heard then counts from then.
#[test]
fn resume_hears_news_while_it_finds_out_how_things_are() {
    let desk = Desk::new();
    let network = desk.path("lanes.json");
    let generate =
        ["generate", "lanes", "--agents", "5", "--tasks", "200", "--slack", "400", "--controllable"];
    let generated = kirk(&generate);
    assert_eq!(generated.status.code(), Some(0), "{}", stderr(&generated));
    fs::write(&network, &generated.stdout).unwrap();
    // Not one of those the machine gives to whoever connects: who asks for such a port long enough meets himself.
    let number = (20_000 + std::process::id() % 10_000).to_string();
    let port = format!("127.0.0.1:{number}");
    let mut mission = desk.run(network.to_str().unwrap(), &["--port", &number, "--speed", "0.1"]);
    until("it has begun", || !desk.records("timeout").is_empty());
    mission.kill().unwrap();
    mission.wait().unwrap();
    let mut resumed = start(&["resume", &desk.journal()]);
    let errors = BufReader::new(resumed.stderr.take().unwrap());
    let noted = std::thread::spawn(move || {
        let goes_on = errors.lines().map_while(Result::ok).find(|line| line.contains("goes on at"));
        (goes_on, Instant::now())
    });
    until("the port is open", || TcpStream::connect(&port).is_ok());
    let heard = Instant::now();
    let (goes_on, noted) = noted.join().unwrap();
    resumed.kill().unwrap();
    resumed.wait().unwrap();
    assert!(goes_on.is_some());
    assert!(heard + Duration::from_millis(20) < noted, "{:?}", noted.checked_duration_since(heard));
}
