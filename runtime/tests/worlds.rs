//! The executive when the world does not keep to the model, or the driver not to its time: small missions, by hand.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use kirk_network::{Duration, EventId, Time, json};
use kirk_runtime::{
    Answer, Executive, Outcome, Output, Patience, Plan, Scope, Settings, Setup, handovers, verify,
};

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
        patience: Patience { first: second, most: second },
    };
    Executive::new(plan, setup)
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
        executive.handle_rebuilt(now, rebuild.run());
    }
}

/// The drive begins at 1, confirmed at once. Returns its end.
fn drive(executive: &mut Executive) -> EventId {
    executive.handle_timeout(second(1));
    assert!(executive.handle_sent(second(1), "run/drive:start"));
    executive.handle_executed(second(1), "run/drive:start", None);
    executive.network().find("drive:end").unwrap()
}

#[test]
fn news_that_is_too_early_is_taken_for_true_and_the_mission_goes_on() {
    let mut executive = executive();
    let end = drive(&mut executive);
    assert_eq!(executive.handle_news(second(6), end), Answer::Accepted);
    plan_anew(&mut executive, second(6));
    let said = warnings(&mut executive);
    assert!(said.len() == 1 && said[0].contains("too early: it was to come from 11 s on"), "{said:?}");
    executive.handle_timeout(second(60));
    let execution = executive.execution(second(60), false);
    assert_eq!(execution.outcome, Outcome::Completed);
    let photo = execution.rows.iter().find(|row| row.event == "photo").unwrap();
    assert_eq!(photo.time.unwrap().0.to_string(), "6");
    assert!(!verify(executive.network(), &execution).is_empty(), "it is not what the model says");
}

#[test]
fn news_that_is_too_late_for_the_rest_ends_the_mission() {
    let mut executive = executive();
    let end = drive(&mut executive);
    // It must be over at 21, so the photo is taken.
    executive.handle_timeout(second(21));
    assert_eq!(warnings(&mut executive), [""; 0]);
    // Home by 80 is 40 s after its end no more.
    assert_eq!(executive.handle_news(second(45), end), Answer::Accepted);
    plan_anew(&mut executive, second(45));
    let failure = executive.failure().unwrap();
    assert_eq!((failure.event.as_str(), failure.reason.as_str()), ("drive:end", "broken-model"));
    assert!(failure.detail.contains("too late: it was to come by 21 s"), "{}", failure.detail);
}

#[test]
fn news_that_never_comes_is_told_once_and_what_was_imagined_stands() {
    let mut executive = executive();
    drive(&mut executive);
    executive.handle_timeout(second(21));
    assert_eq!(warnings(&mut executive), [""; 0]);
    executive.handle_timeout(second(22));
    executive.handle_timeout(second(61));
    let said = warnings(&mut executive);
    assert!(said.len() == 1 && said[0].contains("nothing was heard of `drive:end`"), "{said:?}");
    let execution = executive.execution(second(61), false);
    assert_eq!(execution.outcome, Outcome::Completed);
    let row = execution.rows.iter().find(|row| row.event == "drive:end").unwrap();
    assert!(row.happened.is_some_and(|(low, high)| low <= high), "{row:?}");
}

#[test]
fn a_dispatch_that_leaves_after_its_window_does_not_leave() {
    let mut executive = executive();
    executive.handle_timeout(second(1));
    // The disk took its time: the window closed at 3.
    assert!(!executive.handle_sent(second(4), "run/drive:start"));
    let failure = executive.failure().unwrap();
    assert_eq!((failure.event.as_str(), failure.reason.as_str()), ("drive:start", "driver-failed"));
}

#[test]
fn what_was_not_handed_over_in_its_window_is_missed_when_somebody_is_back() {
    let mut executive = executive();
    executive.handle_timeout(second(1));
    while executive.poll_output().is_some() {}
    executive.handle_resumed(second(9), &["run/drive:start".to_string()]);
    assert_eq!(executive.failure().unwrap().reason, "missed-window");
    let sends = std::iter::from_fn(|| executive.poll_output()).filter(|o| matches!(o, Output::Send(_)));
    assert_eq!(sends.count(), 0);
}

#[test]
fn an_attempt_that_fails_is_made_once_more_when_the_window_closes() {
    let mut executive = executive();
    executive.handle_timeout(second(1));
    executive.handle_sent(second(1), "run/drive:start");
    executive.handle_failed(second(1), "run/drive:start", "no", false);
    executive.handle_timeout(second(2));
    executive.handle_failed(Time::from_micros(2_500_000), "run/drive:start", "no", false);
    // Again after 1 s would be too late: the window closes at 3.
    assert_eq!(executive.poll_timeout(), Some(second(3)));
    executive.handle_timeout(second(3));
    executive.handle_executed(second(3), "run/drive:start", None);
    let row = executive.rows(executive.network().find("drive:start").unwrap());
    assert_eq!(row[0].time.unwrap().0.to_string(), "3");
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
        patience: Patience { first: Duration::from_micros(100_000), most: Duration::from_secs(2) },
    };
    let mut executive = Executive::new(plan, setup);
    let (mut now, mut last, mut attempts) = (Time::ZERO, 0, 0);
    while now < second(24 * 3600) {
        executive.handle_timeout(now);
        while let Some(output) = executive.poll_output() {
            let Output::Send(sending) = output else { continue };
            attempts += 1;
            // Never is it waited for longer than 2 s, or a hundredth of the time for which it has failed.
            let waited = now.as_micros() - last;
            assert!(waited <= 2_000_000.max(last / 100), "{waited} after {last}");
            last = now.as_micros();
            assert!(executive.handle_sent(now, &sending.id));
            executive.handle_failed(now, &sending.id, "no", false);
        }
        now = executive.poll_timeout().unwrap();
    }
    assert!((500..1000).contains(&attempts), "{attempts}");
}
