//! Missions on the screen of a terminal, end to end: a pseudo-terminal takes the place of the person before it.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, tcgetattr};
use tempfile::TempDir;

/// The scan may end at any time from the first moment on, and is packed up a second later.
const MISSION: &str = r#"{"format": "kirk-network/1", "name": "scan", "origin": "go",
    "events": ["go", "scan:end", "pack"],
    "requirements": [{"from": "scan:end", "to": "pack", "lower": 1, "upper": 100}],
    "contingents": [{"from": "go", "to": "scan:end", "lower": 0.001, "upper": 50}]}"#;

/// A mission before a person; its record goes to a file.
struct Rig {
    folder: TempDir,
    person: Option<File>,
    kirk: Child,
    seen: String,
}

impl Rig {
    fn new(speed: &str) -> Rig {
        Rig::with(&["--speed", speed])
    }

    fn with(options: &[&str]) -> Rig {
        Rig::of(|mission| [&["run", mission][..], options].concat().into_iter().map(str::to_string).collect())
    }

    /// `arguments` for the file of a mission.
    fn of(arguments: impl FnOnce(&str) -> Vec<String>) -> Rig {
        let folder = tempfile::tempdir().unwrap();
        let mission = folder.path().join("scan.json");
        std::fs::write(&mission, MISSION).unwrap();
        let person = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&person).unwrap();
        unlockpt(&person).unwrap();
        let name = ptsname(&person, Vec::new()).unwrap();
        let open = || rustix::fs::open(&name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
        let kirk = Command::new("setsid")
            .args(["--ctty", env!("CARGO_BIN_EXE_kirk")])
            .args(arguments(mission.to_str().unwrap()))
            .args(["--format", "json"])
            .env("TERM", "xterm")
            .stdin(File::from(open()))
            .stdout(File::create(folder.path().join("record.json")).unwrap())
            .stderr(File::from(open()))
            .spawn()
            .unwrap();
        Rig { folder, person: Some(File::from(person)), kirk, seen: String::new() }
    }

    fn press(&mut self, keys: &str) {
        self.person.as_mut().unwrap().write_all(keys.as_bytes()).unwrap();
    }

    /// Looks at the terminal until a text is there.
    fn see(&mut self, text: &str) {
        let limit = Instant::now() + Duration::from_secs(60);
        while !self.seen.contains(text) {
            assert!(Instant::now() < limit && self.look(), "`{text}` is not in {:?}", self.seen);
        }
    }

    /// Takes what is new on the terminal; false if there will be nothing more.
    fn look(&mut self) -> bool {
        let person = self.person.as_ref().unwrap();
        let mut files = [PollFd::new(person, PollFlags::IN)];
        poll(&mut files, Some(&Timespec { tv_sec: 0, tv_nsec: 50_000_000 })).unwrap();
        if files[0].revents().is_empty() {
            return true;
        }
        let mut bytes = [0; 4096];
        let length = rustix::io::read(person, &mut bytes).unwrap_or(0);
        self.seen.push_str(&String::from_utf8_lossy(&bytes[..length]));
        length > 0
    }

    /// Waits for the end of the mission, and returns its record.
    fn end(&mut self) -> (ExitStatus, serde_json::Value) {
        let limit = Instant::now() + Duration::from_secs(60);
        let status = loop {
            if let Some(status) = self.kirk.try_wait().unwrap() {
                break status;
            }
            assert!(Instant::now() < limit, "the mission does not end; seen: {:?}", self.seen);
            if self.person.is_none() || !self.look() {
                std::thread::sleep(Duration::from_millis(20));
            }
        };
        // What it said last.
        while self.person.is_some() && self.look() {}
        (status, serde_json::from_slice(&std::fs::read(self.record()).unwrap()).unwrap())
    }

    fn record(&self) -> PathBuf {
        self.folder.path().join("record.json")
    }

    fn is_restored(&self) -> bool {
        let modes = tcgetattr(self.person.as_ref().unwrap()).unwrap().local_modes;
        let last = |text: &str| self.seen.rfind(text).unwrap();
        last("\u{1b}[?1049l") > last("\u{1b}[?1049h")
            && last("\u{1b}[?25h") > last("\u{1b}[?25l")
            && modes.contains(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG)
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        // Over already, unless the test has failed.
        let _ = self.kirk.kill();
        let _ = self.kirk.wait();
    }
}

#[test]
fn a_key_is_news_and_the_terminal_is_given_back() {
    let mut rig = Rig::new("1");
    rig.see("[1]");
    rig.press("1");
    rig.see("heard:");
    let (status, record) = rig.end();
    assert!(status.success());
    assert_eq!(record["outcome"], "completed");
    let heard = record["rows"].as_array().unwrap().iter().find(|row| row["event"] == "scan:end").unwrap();
    assert!(heard["observed"].as_f64().unwrap() < 50.0, "{heard}");
    assert!(rig.is_restored(), "{:?}", rig.seen);
}

#[test]
fn the_interrupt_key_stops_the_mission_only_when_pressed_twice() {
    let mut rig = Rig::new("1");
    rig.see("[1]");
    rig.press("\u{3}");
    rig.see("again");
    rig.press("x");
    rig.press("\u{3}");
    rig.press("\u{3}");
    let (status, record) = rig.end();
    assert_eq!(status.code(), Some(1));
    assert_eq!(record["failure"]["reason"], "stopped");
    assert!(rig.is_restored(), "{:?}", rig.seen);
}

#[test]
fn the_mission_goes_on_when_the_terminal_goes_away() {
    let mut rig = Rig::new("20");
    rig.see("[1]");
    rig.person = None;
    let (status, record) = rig.end();
    assert!(status.success(), "{status}");
    assert_eq!(record["outcome"], "completed");
}

/// Whether a mission with these options, before a person at a terminal, is on a screen. It is over soon.
fn has_screen(options: &[&str]) -> bool {
    let mut rig = Rig::with(&[&["--speed", "100"], options].concat());
    let (status, record) = rig.end();
    assert!(status.success(), "{status}: {:?}", rig.seen);
    assert_eq!(record["outcome"], "completed");
    let (screen, lines) = (rig.seen.contains("\u{1b}[?1049h"), rig.seen.contains("go  dispatched"));
    assert!(!(screen && lines), "{:?}", rig.seen);
    screen
}

#[test]
fn there_are_lines_with_the_options_of_the_original_and_a_screen_if_it_is_asked_for() {
    assert!(has_screen(&[]));
    assert!(has_screen(&["--tolerance", "1.0", "--verbose"]));
    assert!(has_screen(&["--quiet"]), "quiet is another question");
    assert!(!has_screen(&["--screen", "never"]));
    for original in [&["--driver-command", "true"][..], &["--optimistic"], &["--like-original"]] {
        assert!(!has_screen(original), "{original:?}");
        assert!(!has_screen(&[original, &["--verbose"]].concat()), "{original:?}");
        assert!(has_screen(&[original, &["--screen", "auto"]].concat()), "{original:?}");
        assert!(has_screen(&[original, &["--screen", "always"]].concat()), "{original:?}");
    }
}

#[test]
fn a_mission_that_goes_on_is_shown_as_it_was_unless_something_else_is_asked_for() {
    for (begun, resumed, screen) in
        [("never", None, false), ("auto", None, true), ("never", Some("auto"), true)]
    {
        let folder = tempfile::tempdir().unwrap();
        let journal = folder.path().join("journal").to_str().unwrap().to_string();
        let mut rig = Rig::with(&["--screen", begun, "--journal", &journal, "--speed", "20"]);
        while !std::fs::read(&journal).is_ok_and(|bytes| bytes.contains(&b'\n')) {
            rig.look();
        }
        rig.kirk.kill().unwrap();
        rig.kirk.wait().unwrap();
        let mut arguments = vec!["resume".to_string(), journal];
        arguments.extend(resumed.map(|when| format!("--screen={when}")));
        let mut rig = Rig::of(|_| arguments);
        let (status, _) = rig.end();
        assert!(status.success(), "{status}: {:?}", rig.seen);
        assert_eq!(rig.seen.contains("\u{1b}[?1049h"), screen, "{begun} {resumed:?}: {:?}", rig.seen);
    }
}
