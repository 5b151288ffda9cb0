//! Each rule on which views rest is needed: with it a team is safe, without it something goes wrong in true time.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod build;

use build::{Builder, NEVER, ORIGIN, together};
use kirk_team::{Mood, Options, Ready, Rules, Simulation, Verdict, Weather, find, verify};

/// True if the team is accepted and some execution of it breaks a requirement.
fn goes_wrong(builder: &Builder, rules: Rules) -> bool {
    let team = builder.build().unwrap();
    let Verdict::Yes(agreement) = find(&team, &Options { rules, ..Options::default() }).unwrap() else {
        return false;
    };
    let ready = Ready::new(&team, &agreement).unwrap();
    let moods = [Mood::Longest, Mood::Shortest, Mood::Extremes, Mood::Random];
    (0..64_usize).any(|number| {
        let weather = Weather { delays: moods[number / 4 % 4], ..Weather::default() };
        let nature = moods[number % 4];
        let execution =
            ready.run(&Simulation { nature, weather, rules, seed: number as u64, ..Simulation::default() });
        !verify(&team, &agreement, &execution).is_empty()
    })
}

fn is_needed(builder: &Builder, without: Rules) {
    assert!(!goes_wrong(builder, Rules::ALL), "it is not even right with all rules");
    assert!(goes_wrong(builder, without), "nothing goes wrong without: {without:?}");
}

/// Something of agent one ends 3 to 20 s after the start; agent two has to act within an interval after it.
fn after_the_news(news: [i64; 2], range: [i64; 2]) -> Builder {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 20], [0, 0]);
    let x = b.event("x", "two");
    b.require(c, x, range);
    b.link("one", "two", news, false);
    b
}

#[test]
fn whoever_hears_something_tells_it_whoever_may_have_been_told() {
    let mut b = Builder::new(&["one", "two", "three"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 20], [0, 0]);
    let x = b.event("x", "two");
    b.require(c, x, [0, 3]);
    b.link("one", "two", [0, 100], true);
    b.link("one", "three", [0, 1], true);
    b.link("three", "two", [0, 1], true);
    is_needed(&b, Rules { flooding: false, ..Rules::ALL });
}

#[test]
fn news_takes_as_long_as_the_longest_delays() {
    let wrong = after_the_news([1, 5], [0, 3]);
    assert!(goes_wrong(&wrong, Rules { longest: false, ..Rules::ALL }));
    is_needed(&wrong, Rules { longest: false, ..Rules::ALL });
}

#[test]
fn news_is_as_soon_as_the_shortest_delays() {
    is_needed(&after_the_news([1, 5], [4, 6]), Rules { shortest: false, ..Rules::ALL });
}

#[test]
fn who_promises_something_has_it_as_a_requirement() {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 8], [0, 0]);
    let x = b.event("x", "one");
    let y = b.event("y", "two");
    b.require(c, x, [0, NEVER]);
    b.require(x, y, [2, 3]);
    b.link("one", "two", [0, NEVER], true);
    is_needed(&b, Rules { own_promise: false, ..Rules::ALL });
}

#[test]
fn nothing_is_in_the_end_measured_from_itself() {
    is_needed(&together(NEVER, [1, 3]), Rules { acyclic: false, ..Rules::ALL });
}

#[test]
fn one_moment_of_two_agents_is_two_events() {
    is_needed(&together(4, [1, 3]), Rules { no_merging: false, ..Rules::ALL });
}

#[test]
fn news_of_what_has_not_begun_here_is_held() {
    let mut b = Builder::new(&["one", "two"]);
    // At 8 both act: two because it is time, one because it counts on two. News takes no time, so it may come first.
    let d = b.contingent("d", "one", ORIGIN, [0, 12], [0, 0]);
    let x = b.event("x", "two");
    let f = b.event("f", "one");
    let y = b.event("y", "two");
    b.require(ORIGIN, x, [8, 8]);
    b.require(d, f, [0, NEVER]);
    b.require(x, f, [0, 10]);
    b.require(f, y, [0, 1]);
    b.link("one", "two", [0, 0], false);
    is_needed(&b, Rules { hold: false, ..Rules::ALL });
}
