//! The executive when the world does not keep to the model, or the driver not to its time: small missions, by hand.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use kirk_network::{Duration, EventId, Time, json};
use kirk_runtime::journal::{Clocks, Line, Record, Start, Trace, read, write};
use kirk_runtime::{
    Executive, Input, Outcome, Output, Patience, Plan, Reason, Scope, Sending, Settings, Setup, Speed,
    handovers, replay, verify,
};
use serde_json::value::RawValue;

/// A drive of 10 to 20 s, heard at once, a photo within 5 s of its end, and home 40 s after it and within 60 to 80 s.
fn executive() -> Executive {
    let network = json::read(
        r#"{"format": "kirk-network/1", "origin": "go",
            "events": ["go", "drive:start", "drive:end", "photo", "home"],
            "requirements": [{"from": "go", "to": "drive:start", "lower": 1, "upper": 3},
                             {"from": "drive:end", "to": "photo", "lower": 0, "upper": 5},
                             {"from": "drive:end", "to": "home", "lower": 40},
                             {"from": "go", "to": "home", "lower": 60, "upper": 80}],
            "contingents": [{"from": "drive:start", "to": "drive:end", "lower": 10, "upper": 20}]}"#,
    )
    .unwrap();
    let plan = Plan::new(&network).unwrap();
    let second = Duration::from_micros(1_000_000);
    let setup = Setup {
        program: "test".into(),
        run: "run".into(),
        settings: Settings::default(),
        handovers: handovers(plan.network(), None, Scope::Starts),
        driver: true,
        patience: Patience { first: second, most: second },
    };
    Executive::new(plan, setup)
}

fn sent(id: &str) -> Input {
    Input::Sent { id: id.to_string() }
}

fn executed(id: &str, ago: Option<Duration>) -> Input {
    Input::Executed { id: id.to_string(), ago }
}

fn failed(id: &str, reason: &str, doubt: bool) -> Input {
    Input::Failed { id: id.to_string(), reason: reason.to_string(), doubt }
}

/// News arrives. Returns whether it is of use.
fn hear(executive: &mut Executive, arrived: Time, event: EventId) -> bool {
    let news = Input::observed(executive.network(), event);
    executive.handle(arrived, news).is_accepted()
}

fn second(seconds: i64) -> Time {
    Time::from_micros(seconds * 1_000_000)
}

fn warnings(executive: &mut Executive) -> Vec<String> {
    let outputs = std::iter::from_fn(|| executive.poll_output());
    outputs.filter_map(|output| if let Output::Warning(text) = output { Some(text) } else { None }).collect()
}

/// Plans anew what is to be planned, which takes no time.
fn plan_anew(executive: &mut Executive, now: Time) {
    while let Some(rebuild) = executive.poll_rebuild(now) {
        executive.handle(now, Input::rebuilt(rebuild.run()));
    }
}

/// The drive begins at 1, confirmed at once. Returns its end.
fn drive(executive: &mut Executive) -> EventId {
    executive.handle(second(1), Input::Timeout {});
    assert!(executive.handle(second(1), sent("run/drive:start")).is_accepted());
    executive.handle(second(1), executed("run/drive:start", None));
    executive.network().find("drive:end").unwrap()
}

#[test]
fn a_mission_does_not_wait_for_a_plan_that_cannot_be_made() {
    let mut executive = executive();
    let end = drive(&mut executive);
    assert!(hear(&mut executive, second(6), end));
    let rebuild = executive.poll_rebuild(second(6)).unwrap();
    executive.handle(second(7), Input::rebuilt(rebuild.without_plan()));
    assert!(
        executive.is_over() || executive.poll_timeout().is_some(),
        "it waits for something that never comes"
    );
    let execution = executive.execution(second(7), false);
    assert_eq!(execution.failure.map(|failure| failure.reason), Some(Reason::BrokenModel));
}

#[test]
fn news_that_is_too_early_is_taken_for_true_and_the_mission_goes_on() {
    let mut executive = executive();
    let end = drive(&mut executive);
    assert!(hear(&mut executive, second(6), end));
    plan_anew(&mut executive, second(6));
    let said = warnings(&mut executive);
    assert!(said.len() == 1 && said[0].contains("too early: it was to come from 11 s on"), "{said:?}");
    executive.handle(second(60), Input::Timeout {});
    let execution = executive.execution(second(60), false);
    assert_eq!(execution.outcome, Outcome::Completed);
    let photo = execution.rows.iter().find(|row| row.event == "photo").unwrap();
    assert_eq!(photo.time.unwrap().to_string(), "6");
    assert!(!verify(executive.network(), &execution).is_empty(), "it is not what the model says");
}

#[test]
fn a_plan_is_repeated_from_the_moment_it_was_asked_for_whatever_was_confirmed_meanwhile() {
    let network = json::read(
        r#"{"format": "kirk-network/1", "origin": "go",
            "events": ["go", "c", "x", "y"],
            "requirements": [{"from": "c", "to": "x", "lower": 0}, {"from": "c", "to": "y", "lower": 2}],
            "contingents": [{"from": "go", "to": "c", "lower": 1, "upper": 3}]}"#,
    )
    .unwrap();
    let plan = Plan::new(&network).unwrap();
    let millisecond = |number: i64| Time::from_micros(1_000 * number);
    let setup = Setup {
        program: "test".into(),
        run: "run".into(),
        settings: Settings { lateness: Duration::from_micros(90_000), ..Settings::default() },
        handovers: handovers(plan.network(), None, Scope::All),
        driver: true,
        patience: Patience { first: Duration::from_micros(1), most: Duration::from_micros(1) },
    };
    let clocks = Clocks { boot: None, since_boot: 0, calendar: 0 };
    let shell = RawValue::from_string("null".into()).unwrap();
    let start = Start::new(&network, &setup, Speed::REAL, clocks, shell, "test");
    let mut executive = Executive::new(plan, setup);
    let (mut journal, mut checksum) = write(&Line::new(Time::ZERO, Record::Start(Box::new(start))), 0);
    let mut note = |at: Time, record: Record| {
        let (text, next) = write(&Line::new(at, record), checksum);
        journal.push_str(&text);
        checksum = next;
    };
    let mut happens = |executive: &mut Executive, at: Time, input: Input| {
        if let Some(input) = executive.handle(at, input).record {
            note(at, Record::In(input));
        }
        while let Some(output) = executive.poll_output() {
            if let Output::Send(Sending { id, due, attempt, .. }) = output {
                note(at, Record::Out(Trace::Dispatch { id, due, attempt }));
            }
        }
    };
    happens(&mut executive, Time::ZERO, Input::Timeout {});
    happens(&mut executive, Time::ZERO, sent("run/go"));
    let news = Input::observed(&network, network.find("c").unwrap());
    happens(&mut executive, Time::ZERO, news);
    let rebuild = executive.poll_rebuild(Time::ZERO).unwrap();
    // The clock goes on while it is planned, and what was known is confirmed.
    happens(&mut executive, millisecond(3), executed("run/go", None));
    happens(&mut executive, millisecond(6), Input::rebuilt(rebuild.run()));
    let journal = read(journal.as_bytes()).unwrap();
    let repeated = replay(&journal, |_, _, _| {}).unwrap();
    assert_eq!(repeated.executive.execution(second(1), true), executive.execution(second(1), true));
}

#[test]
fn news_that_is_too_late_for_the_rest_ends_the_mission() {
    let mut executive = executive();
    let end = drive(&mut executive);
    // It must be over at 21, so the photo is taken.
    executive.handle(second(21), Input::Timeout {});
    assert_eq!(warnings(&mut executive), [""; 0]);
    // Home by 80 is 40 s after its end no more.
    assert!(hear(&mut executive, second(45), end));
    plan_anew(&mut executive, second(45));
    let failure = executive.failure().unwrap();
    assert_eq!((failure.event.as_str(), failure.reason), ("drive:end", Reason::BrokenModel));
    assert!(failure.detail.contains("too late: it was to come by 21 s"), "{}", failure.detail);
}

#[test]
fn news_that_never_comes_is_told_once_and_what_was_imagined_stands() {
    let mut executive = executive();
    drive(&mut executive);
    executive.handle(second(21), Input::Timeout {});
    assert_eq!(warnings(&mut executive), [""; 0]);
    executive.handle(second(22), Input::Timeout {});
    executive.handle(second(61), Input::Timeout {});
    let said = warnings(&mut executive);
    assert!(said.len() == 1 && said[0].contains("nothing was heard of `drive:end`"), "{said:?}");
    let execution = executive.execution(second(61), false);
    assert_eq!(execution.outcome, Outcome::Completed);
    let row = execution.rows.iter().find(|row| row.event == "drive:end").unwrap();
    assert!(row.happened.is_some_and(|happened| !happened.is_empty()), "{row:?}");
}

#[test]
fn a_dispatch_that_leaves_after_its_window_does_not_leave() {
    let mut executive = executive();
    executive.handle(second(1), Input::Timeout {});
    // The disk took its time: the window closed at 3.
    assert!(!executive.handle(second(4), sent("run/drive:start")).is_accepted());
    let failure = executive.failure().unwrap();
    assert_eq!((failure.event.as_str(), failure.reason), ("drive:start", Reason::DriverFailed));
}

#[test]
fn what_was_not_handed_over_in_its_window_is_missed_when_somebody_is_back() {
    let mut executive = executive();
    executive.handle(second(1), Input::Timeout {});
    while executive.poll_output().is_some() {}
    executive.handle(second(9), Input::Resumed { unsent: vec!["run/drive:start".to_string()] });
    assert_eq!(executive.failure().unwrap().reason, Reason::MissedWindow);
    let sends = std::iter::from_fn(|| executive.poll_output()).filter(|o| matches!(o, Output::Send(_)));
    assert_eq!(sends.count(), 0);
}

#[test]
fn an_attempt_that_fails_is_made_once_more_when_the_window_closes() {
    let mut executive = executive();
    executive.handle(second(1), Input::Timeout {});
    executive.handle(second(1), sent("run/drive:start"));
    executive.handle(second(1), failed("run/drive:start", "no", false));
    executive.handle(second(2), Input::Timeout {});
    executive.handle(Time::from_micros(2_500_000), failed("run/drive:start", "no", false));
    // Again after 1 s would be too late: the window closes at 3.
    assert_eq!(executive.poll_timeout(), Some(second(3)));
    executive.handle(second(3), Input::Timeout {});
    executive.handle(second(3), executed("run/drive:start", None));
    let row = executive.rows(executive.network().find("drive:start").unwrap());
    assert_eq!(row[0].time.unwrap().to_string(), "3");
}

#[test]
fn a_driver_that_fails_for_a_day_is_tried_some_hundreds_of_times() {
    let network = json::read(
        r#"{"format": "kirk-network/1", "origin": "go", "events": ["go", "a:start", "a:end"],
            "requirements": [{"from": "go", "to": "a:start", "lower": 0},
                             {"from": "a:start", "to": "a:end", "lower": 1}]}"#,
    )
    .unwrap();
    let plan = Plan::new(&network).unwrap();
    let setup = Setup {
        program: "test".into(),
        run: "run".into(),
        settings: Settings::default(),
        handovers: handovers(plan.network(), None, Scope::Starts),
        driver: true,
        patience: Patience { first: Duration::from_micros(100_000), most: Duration::from_secs(2) },
    };
    let mut executive = Executive::new(plan, setup);
    let (mut now, mut last, mut attempts) = (Time::ZERO, 0, 0);
    while now < second(24 * 3600) {
        executive.handle(now, Input::Timeout {});
        while let Some(output) = executive.poll_output() {
            let Output::Send(sending) = output else { continue };
            attempts += 1;
            // Never is it waited for longer than 2 s, or a hundredth of the time for which it has failed.
            let waited = now.as_micros() - last;
            assert!(waited <= 2_000_000.max(last / 100), "{waited} after {last}");
            last = now.as_micros();
            assert!(executive.handle(now, sent(&sending.id)).is_accepted());
            executive.handle(now, failed(&sending.id, "no", false));
        }
        now = executive.poll_timeout().unwrap();
    }
    assert!((500..1000).contains(&attempts), "{attempts}");
}

/// An executive for a network, with lead and lateness, in seconds; the driver hears of everything that is ours, or starts only.
fn executive_of(network: &str, scope: Scope, tolerance: f64) -> Executive {
    let plan = Plan::new(&json::read(network).unwrap()).unwrap();
    let tolerance = Duration::from_micros((tolerance * 1e6) as i64);
    let settings = Settings { lateness: tolerance, ..Settings::default() };
    let setup = Setup {
        program: "test".into(),
        run: "run".into(),
        settings,
        handovers: handovers(plan.network(), None, scope),
        driver: true,
        patience: Patience { first: Duration::from_micros(100_000), most: Duration::from_secs(1) },
    };
    Executive::new(plan, setup)
}

fn millis(millis: i64) -> Time {
    Time::from_micros(millis * 1000)
}

/// The names of what is to be handed over now.
fn sends(executive: &mut Executive) -> Vec<String> {
    let outputs = std::iter::from_fn(|| executive.poll_output());
    outputs.filter_map(|output| if let Output::Send(s) = output { Some(s.name) } else { None }).collect()
}

/// `a` takes 1 to 2 s of ours, `b` follows it by up to 5 s.
const ONE_AFTER_THE_OTHER: &str = r#"{"format": "kirk-network/1", "origin": "z",
    "events": ["z", "b:start", "a:start", "a:end"],
    "requirements": [{"from": "a:end", "to": "b:start", "lower": 0, "upper": 5},
                     {"from": "a:start", "to": "a:end", "lower": 1, "upper": 2},
                     {"from": "z", "to": "b:start", "lower": 1}]}"#;

#[test]
fn what_follows_at_no_distance_waits_for_the_confirmation_and_a_failed_attempt_is_made_again() {
    let mut executive = executive_of(ONE_AFTER_THE_OTHER, Scope::All, 0.0);
    executive.handle(Time::ZERO, Input::Timeout {});
    assert_eq!(sends(&mut executive), ["z", "a:start"]);
    for id in ["run/z", "run/a:start"] {
        executive.handle(Time::ZERO, sent(id));
        executive.handle(Time::ZERO, executed(id, None));
    }
    executive.handle(second(1), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["a:end"], "b:start waits for it");
    executive.handle(second(1), sent("run/a:end"));
    executive.handle(millis(1100), failed("run/a:end", "no", false));
    executive.handle(millis(1199), Input::Timeout {});
    assert_eq!(sends(&mut executive), [""; 0]);
    executive.handle(millis(1200), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["a:end"], "its own window is open until 2 s");
    executive.handle(millis(1200), sent("run/a:end"));
    executive.handle(millis(1300), executed("run/a:end", None));
    assert_eq!(sends(&mut executive), ["b:start"]);
    executive.handle(millis(1300), sent("run/b:start"));
    executive.handle(millis(1300), executed("run/b:start", None));
    let execution = executive.execution(second(2), false);
    assert_eq!(execution.outcome, Outcome::Completed);
    let rows: Vec<&str> = execution.rows.iter().map(|row| row.event.as_str()).collect();
    assert_eq!(rows, ["z", "a:start", "a:end", "b:start"]);
    assert_eq!(verify(executive.network(), &execution), []);
}

#[test]
fn what_follows_natures_end_waits_for_what_had_to_come_before_it() {
    // Nobody knows when `n` will be, so `before` is done when it is, and `after` at the same time.
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "after", "before", "n"],
            "requirements": [{"from": "n", "to": "after", "lower": 0}, {"from": "before", "to": "n", "lower": 0, "upper": 1}],
            "contingents": [{"from": "z", "to": "n", "lower": 0, "upper": 2}]}"#,
        Scope::All,
        0.0,
    );
    executive.handle(Time::ZERO, Input::Timeout {});
    executive.handle(Time::ZERO, sent("run/z"));
    executive.handle(Time::ZERO, executed("run/z", None));
    let n = executive.network().find("n").unwrap();
    hear(&mut executive, millis(500), n);
    executive.handle(millis(500), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["z", "before"]);
    executive.handle(millis(500), sent("run/before"));
    executive.handle(millis(600), executed("run/before", None));
    executive.handle(millis(600), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["after"]);
}

#[test]
fn what_follows_an_end_that_nobody_waits_for_waits_for_what_had_to_come_before_it() {
    // It takes exactly 3 s, so no news of it is needed.
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "after", "before", "n"],
            "requirements": [{"from": "n", "to": "after", "lower": 0}, {"from": "before", "to": "n", "lower": 0},
                             {"from": "z", "to": "before", "lower": 3}],
            "contingents": [{"from": "z", "to": "n", "lower": 3, "upper": 3}]}"#,
        Scope::All,
        0.0,
    );
    executive.handle(Time::ZERO, Input::Timeout {});
    executive.handle(Time::ZERO, sent("run/z"));
    executive.handle(Time::ZERO, executed("run/z", None));
    executive.handle(second(3), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["z", "before"]);
    executive.handle(second(3), sent("run/before"));
    executive.handle(second(3), executed("run/before", None));
    executive.handle(second(3), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["after"]);
}

#[test]
fn what_follows_an_event_that_has_to_be_at_time_zero_waits_for_it() {
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "after", "first", "last"],
            "requirements": [{"from": "first", "to": "last", "lower": 5}, {"from": "z", "to": "last", "upper": 5},
                             {"from": "first", "to": "after", "lower": 0}]}"#,
        Scope::All,
        0.0,
    );
    executive.handle(Time::ZERO, Input::Timeout {});
    assert_eq!(sends(&mut executive), ["z", "first"]);
    executive.handle(Time::ZERO, sent("run/first"));
    executive.handle(millis(0), executed("run/first", None));
    executive.handle(millis(0), Input::Timeout {});
    assert_eq!(sends(&mut executive), ["after"]);
}

/// A pause of exactly 2 s, which is nobody's to execute, then `b`.
const PAUSE: &str = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "pause", "b:start", "b:end"],
    "requirements": [{"from": "z", "to": "pause", "lower": 2, "upper": 2},
                     {"from": "pause", "to": "b:start", "lower": 0, "upper": 10},
                     {"from": "b:start", "to": "b:end", "lower": 1, "upper": 2}]}"#;

#[test]
fn what_nobody_executes_is_over_on_time_though_nobody_was_there() {
    let mut executive = executive_of(PAUSE, Scope::Starts, 0.1);
    executive.handle(millis(3500), Input::Timeout {});
    let due = std::iter::from_fn(|| executive.poll_output()).find_map(|output| match output {
        Output::Send(sending) => Some((sending.name, sending.due)),
        _ => None,
    });
    assert_eq!(due, Some(("b:start".to_string(), second(2))), "what it is late by can be seen");
    executive.handle(millis(3500), sent("run/b:start"));
    executive.handle(millis(3500), executed("run/b:start", None));
    executive.handle(second(9), Input::Timeout {});
    let execution = executive.execution(second(9), false);
    assert_eq!(execution.outcome, Outcome::Completed, "{:?}", execution.failure);
    let time = |name| execution.rows.iter().find(|row| row.event == name).unwrap().time.unwrap().to_string();
    assert_eq!(["pause", "b:start", "b:end"].map(time), ["2", "3.5", "4.5"]);
    assert_eq!(verify(executive.network(), &execution), []);
}

#[test]
fn a_window_that_was_missed_says_that_nobody_was_there() {
    let mut executive = executive_of(PAUSE, Scope::Starts, 0.1);
    executive.handle(second(20), Input::Timeout {});
    let detail = &executive.failure().unwrap().detail;
    assert!(detail.contains("was due at 2 s and could be executed until 12 s"), "{detail}");
}

#[test]
fn news_that_is_late_has_one_deadline_and_proves_no_more_than_it_can() {
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "go", "events": ["go", "drive:end", "home"],
            "requirements": [{"from": "drive:end", "to": "home", "lower": 60}],
            "contingents": [{"from": "go", "to": "drive:end", "lower": 10, "upper": 20, "delay": [1, 5]}]}"#,
        Scope::Starts,
        0.1,
    );
    executive.handle(second(26), Input::Timeout {});
    let end = executive.network().find("drive:end").unwrap();
    hear(&mut executive, second(40), end);
    plan_anew(&mut executive, second(40));
    let said = warnings(&mut executive).join("\n");
    assert!(said.contains("its news was to come by 25 s"), "{said}");
    assert!(said.contains("too late: it was to come by 25 s"), "{said}");
    let happened = executive.rows(end)[0].happened.unwrap();
    // Either the drive took longer, or its news did.
    assert_eq!((happened.earliest, happened.latest), (second(10), second(39)));
}

#[test]
fn news_that_counts_as_of_another_time_is_told() {
    let mut executive = executive();
    let end = drive(&mut executive);
    assert!(hear(&mut executive, second(11), end));
    assert!(!std::iter::from_fn(|| executive.poll_output()).any(|output| matches!(output, Output::Note(_))));
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "go", "events": ["go", "end", "home"],
            "requirements": [{"from": "end", "to": "home", "lower": 10}],
            "contingents": [{"from": "go", "to": "end", "lower": 10, "upper": 20}]}"#,
        Scope::Starts,
        0.1,
    );
    let end = executive.network().find("end").unwrap();
    assert!(hear(&mut executive, millis(9950), end));
    let told = std::iter::from_fn(|| executive.poll_output()).find_map(|output| match output {
        Output::Note(text) => Some(text),
        _ => None,
    });
    let told = told.unwrap();
    assert!(told.contains("at 9.95 s counts as of 10 s, the earliest the model allows"), "{told}");
}

#[test]
fn what_was_never_confirmed_is_not_listed_as_dispatched() {
    let mut executive = executive_of(
        r#"{"format": "kirk-network/1", "origin": "a:start", "events": ["a:start", "a:end"],
            "requirements": [{"from": "a:start", "to": "a:end", "lower": 1, "upper": 2}]}"#,
        Scope::Starts,
        0.1,
    );
    executive.handle(Time::ZERO, sent("run/a:start"));
    executive.handle(millis(10), failed("run/a:start", "no", false));
    executive.handle(second(1), Input::Timeout {});
    assert_eq!(executive.failure().unwrap().reason, Reason::DriverFailed);
    let rows = executive.execution(second(1), true).rows;
    assert!(rows.iter().all(|row| row.event != "a:start"), "{rows:?}");
}
