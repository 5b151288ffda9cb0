//! Foreign text and odd files, with the real binary: what a terminal would obey is spelt out, marks before JSON do no harm, and
//! what is no text is pointed at.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::io::Write;
use std::process::Output;

use binary::{kirk, kirk_with_input, stderr, stdout};
use tempfile::NamedTempFile;

/// A file of this ending and these bytes.
fn file(ending: &str, bytes: &[u8]) -> NamedTempFile {
    let mut file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
    file.write_all(bytes).unwrap();
    file
}

/// Nothing that was said is an order to a terminal.
fn is_harmless(output: &Output, what: &str) {
    for text in [stdout(output), stderr(output)] {
        let odd = text.chars().find(|&c| (c.is_control() && c != '\n') || c == '\u{202e}');
        assert_eq!(odd, None, "{what}: {text:?}");
    }
}

/// An activity whose name clears the screen, turns the direction of writing and forges a line.
const NAME: &str = "x\\u001b[2J\\u202ey\\nmain: controllable\\u009b1m";

fn network() -> NamedTempFile {
    let text = format!(
        r#"{{"format": "kirk-network/1", "name": "{NAME}", "origin": "go", "events": ["go", "{NAME}:start", "{NAME}:end"],
            "requirements": [{{"from": "go", "to": "{NAME}:start", "lower": 1, "upper": 2}}],
            "contingents": [{{"from": "{NAME}:start", "to": "{NAME}:end", "lower": 1, "upper": 2}}]}}"#
    );
    file(".json", text.as_bytes())
}

#[test]
fn names_that_a_terminal_would_obey_are_spelt_out() {
    let network = network();
    let path = network.path().to_str().unwrap();
    for arguments in [
        &["run", path, "--simulate"][..],
        &["run", path, "--speed", "100"],
        &["run", path, "--simulate", "--observe", "\u{1b}[31mno\u{202e}@5"],
        &["check", path, "-v"],
        &["check", "no/\u{1b}[31m\u{202e}.rmpl"],
        &["compile", path],
        &["run", path, "--driver-command", "echo ~A"],
    ] {
        let output = kirk(arguments);
        is_harmless(&output, &arguments.join(" "));
        let told = stdout(&output) + &stderr(&output);
        assert!(arguments[0] == "check" || told.contains("\\u{1b}["), "{arguments:?}: {told}");
    }
    // What is for programs is as it is.
    let json = kirk(&["compile", path, "--format", "json"]);
    assert!(stdout(&json).contains('\u{202e}'));
}

#[test]
fn a_name_of_several_lines_is_one_line_of_a_message() {
    let events = format!(
        r#""format": "kirk-network/1", "name": "{NAME}", "origin": "go", "events": ["go", "{NAME}"]"#
    );
    let from_to = format!(r#""from": "go", "to": "{NAME}""#);
    let late = format!(
        r#"{{{events}, "requirements": [{{{from_to}, "upper": 1}}], "contingents": [{{{from_to}, "lower": 1, "upper": 2}}]}}"#
    );
    let unknown = format!(r#"{{{events}, "requirements": [{{"from": "go", "to": "{NAME}!", "upper": 1}}]}}"#);
    let twice = format!(r#"{{{events}, "contingents": [{{{from_to}, "lower": 3, "upper": 2}}]}}"#);
    for text in [late, unknown, twice] {
        let network = file(".json", text.as_bytes());
        let output = kirk(&["check", network.path().to_str().unwrap()]);
        let told = stdout(&output) + &stderr(&output);
        let forged = told.lines().any(|line| line.starts_with("main: controllable"));
        assert!(!forged && told.contains("K0"), "{told}");
    }
}

#[test]
fn what_news_and_drivers_say_is_spelt_out() {
    let say = r"printf 'a\033[2Jb\342\200\256c\n'; exit 3";
    let arguments = ["run", "tests/live/once.rmpl", "--speed", "10", "--driver-command", say];
    let output = kirk_with_input(&arguments, b"\x1b[31mlunch:end\n{\x1b[2J}\n");
    assert_eq!(output.status.code(), Some(1));
    is_harmless(&output, "a driver");
    let told = stderr(&output);
    assert!(told.contains(r"go:start | a\u{1b}[2Jb\u{202e}c"), "{told}");
    assert!(told.contains(r"\u{1b}[31mlunch:end  ignored"), "{told}");
}

#[test]
fn a_source_that_is_shown_has_no_orders_in_it_and_its_places_are_right() {
    let source = "(define-control-program main () ; \u{1b}[2J\u{202e} \u{9b}1m\n  (sequence (:slack t) (lunhc \u{202e})))\n";
    let source = file(".rmpl", source.as_bytes());
    let output = kirk(&["check", source.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    is_harmless(&output, "a source");
    assert!(stderr(&output).contains("lunhc"), "{}", stderr(&output));
}

#[test]
fn a_mark_before_json_does_no_harm() {
    let mark = "\u{feff}";
    let mission = "examples/rmpl/robot.rmpl";
    let compiled = stdout(&kirk(&["compile", mission, "--format", "json"]));
    let network = file(".json", format!("{mark}{compiled}").as_bytes());
    let path = network.path().to_str().unwrap();
    assert_eq!(kirk(&["check", path]).status.code(), Some(0));

    let observations = file(".json", format!("{mark}{{\"human-downlink-science:end\": 22}}").as_bytes());
    let given = ["run", path, "--simulate", "--format", "json", "--observations"];
    let output = kirk(&[&given[..], &[observations.path().to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

    let record = file(".json", format!("{mark}{}", stdout(&output)).as_bytes());
    let output = kirk(&["verify", record.path().to_str().unwrap(), path]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));

    let news = format!("{mark}{{\"event-ids\": [\"fly:end\"]}}\n");
    let arguments = ["run", "tests/live/field.rmpl", "--speed", "20", "--format", "json"];
    let output = kirk_with_input(&arguments, news.as_bytes());
    assert!(!stderr(&output).contains("not news"), "{}", stderr(&output));

    // What is wrong in such a file is pointed at all the same.
    let wrong = file(".json", format!("{mark}{{\n  \"format\": 7}}").as_bytes());
    let output = kirk(&["check", wrong.path().to_str().unwrap()]);
    assert!(stderr(&output).contains(":2:"), "{}", stderr(&output));
}

#[test]
fn what_is_no_text_is_pointed_at() {
    let bytes = b"(define-control-program a ())\n(sequence (caf\xe9) (b))\n(c)\n";
    let source = file(".rmpl", bytes);
    let path = source.path().to_str().unwrap();
    let told = stderr(&kirk(&["check", path]));
    assert!(told.contains("this is not UTF-8 text (line 2, byte 44)"), "{told}");
    assert!(told.contains(&format!("{path}:2:15")), "{told}");
    let lines: Vec<&str> = told.lines().collect();
    let shown = lines.iter().position(|line| line.contains("(sequence (caf\u{fffd}")).expect(&told);
    // The caret stands below the character.
    let column = |text: &str, of: char| text.chars().position(|c| c == of);
    assert_eq!(column(lines[shown + 1], '^'), column(lines[shown], '\u{fffd}'), "{told}");

    let several = stderr(&kirk(&["run", "--simulate", "tests/live/once.rmpl", path]));
    assert!(several.contains(&format!("{path}:2:15")), "{several}");
    assert_eq!(kirk(&["fmt", "--check", path]).status.code(), Some(2));
    // Nothing but bytes, and much of it.
    let machine = file(".rmpl", &[0x80; 1 << 20]);
    let told = stderr(&kirk(&["check", machine.path().to_str().unwrap()]));
    assert!(told.contains("line 1, byte 0") && told.len() < 2_000, "{told}");
}

#[test]
fn a_driver_that_can_be_none_is_refused_before_anything_starts() {
    for (driver, why) in [
        (["--driver-url", "http://127.0.0.1:99999/"], "`99999` is no port"),
        (["--driver-url", "http://127.0.0.1:0/"], "`0` is no port"),
        (["--driver-command", ""], "the driver command is empty"),
        (["--driver-command", "  "], "the driver command is empty"),
        (["--driver", "stdio: "], "expected `stdio:` and a command"),
    ] {
        let output = kirk(&["run", "tests/live/once.rmpl", "--speed", "100", driver[0], driver[1]]);
        assert_eq!(output.status.code(), Some(2), "{driver:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(why), "{driver:?}: {}", stderr(&output));
    }
}
