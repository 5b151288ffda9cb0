//! News that says more than the plan assumed is planned with, but only if that can make a difference.

use kirk_network::{Interval, Time, json};
use kirk_runtime::{Dispatcher, Plan, Reception, Settings, Strategy};

/// Nothing is heard of `b` by 8, so its end is imagined then and `x` executed; the news comes at 9. `y` is to come.
fn planned_anew(also: &str) -> bool {
    let text = format!(
        r#"{{"format": "kirk-network/1", "origin": "a", "events": ["a", "b", "x", "y"],
            "requirements": [
                {{"from": "b", "to": "x", "lower": 0, "upper": 4}},
                {{"from": "x", "to": "y", "lower": 5, "upper": 9}}{also}
            ],
            "contingents": [{{"from": "a", "to": "b", "lower": 1, "upper": 7, "delay": [1, 3]}}]}}"#
    );
    let network = json::read(&text).expect("a valid network");
    let plan = Plan::new(&network).expect("a controllable network");
    let (b, x) = (plan.network().find("b").expect("b"), plan.network().find("x").expect("x"));
    let mut dispatcher = Dispatcher::new(plan, Settings::of(Strategy::Optimistic));
    let second = |seconds: i64| Time::from_micros(seconds * 1_000_000);
    dispatcher.handle_timeout(second(8));
    assert!(dispatcher.known(x).fixed.is_some(), "x follows b");
    assert!(dispatcher.poll_rebuild(second(8)).is_none(), "there was no news");
    assert_eq!(dispatcher.handle_observation(second(9), b), Reception::Accepted);
    assert_eq!(
        dispatcher.happened(b),
        Some(Interval::new(Time::from_micros(6_000_000), Time::from_micros(7_000_000))),
        "the news says more than [5, 7]"
    );
    dispatcher.poll_rebuild(second(9)).is_some()
}

#[test]
fn late_news_is_planned_with_if_something_to_come_is_measured_against_the_event() {
    assert!(planned_anew(r#", {"from": "b", "to": "y", "lower": 0, "upper": 20}"#));
    assert!(planned_anew(r#", {"from": "y", "to": "b", "lower": -20, "upper": 0}"#));
}

#[test]
fn late_news_is_not_planned_with_if_nothing_to_come_is_measured_against_the_event() {
    assert!(!planned_anew(""));
}
