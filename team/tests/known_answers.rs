//! Teams whose answer is known.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod build;

use build::{Builder, NEVER, ORIGIN, together};
use kirk_network::merge::merge;
use kirk_network::{Delay, Duration, Part};
use kirk_team::{Agreement, Cause, Change, Options, Remedy, Team, Verdict, find, remedies};

fn verdict(team: &Team) -> Verdict {
    find(team, &Options::default()).unwrap()
}

fn yes(team: &Team) -> Agreement {
    match verdict(team) {
        Verdict::Yes(agreement) => agreement,
        other => panic!("{other:?}"),
    }
}

/// The promises, in words and seconds.
fn promises(agreement: &Agreement) -> Vec<String> {
    let name = |event| agreement.network.label(event);
    let promise = |it: &kirk_team::Promise| {
        format!("{} {} to {} after {}", name(it.event), it.low, it.high, name(it.base))
    };
    agreement.promises.iter().map(promise).collect()
}

/// The astronaut and the robot of the thesis' section 7.3.2, from one source: the robot drills within so many seconds of the
/// astronaut's downlink.
fn drilling(within: i64) -> Builder {
    let mut b = Builder::new(&["astronaut", "robot"]);
    let downlinked = b.contingent("downlink:end", "astronaut", ORIGIN, [15, 30], [0, 0]);
    let drill = b.event("drilling:start", "robot");
    let drilled = b.contingent("drilling:end", "robot", drill, [22, 26], [0, 1]);
    let closed = b.event("closeout:end", "astronaut");
    let off = b.event("poweroff:end", "robot");
    b.require(downlinked, drill, [0, within]);
    b.require(drilled, closed, [10, 30]);
    b.require(drilled, off, [10, 30]);
    b.require(ORIGIN, closed, [0, 480]);
    b.require(ORIGIN, off, [0, 480]);
    b.link("astronaut", "robot", [5, 15], true);
    b.link("robot", "astronaut", [0, 1], true);
    b
}

#[test]
fn the_promise_of_the_robot_is_the_sync_that_was_written_by_hand() {
    let team = drilling(NEVER).build().unwrap();
    let options = Options { soonest: false, ..Options::default() };
    let Ok(Verdict::Yes(agreement)) = find(&team, &options) else { panic!("there is a way") };
    assert_eq!(promises(&agreement), ["drilling:start 5 to 15 after downlink:end"]);
    // What the astronaut's own program said: sync takes 5 to 15 s and is heard of within a second, drilling within two.
    let astronaut = &agreement.views[0].network;
    let link =
        |name: &str| astronaut.contingents()[astronaut.link_of(astronaut.find(name).unwrap()).unwrap()];
    let seconds = |min, max| Delay { min: Duration::from_secs(min), max: Duration::from_secs(max).into() };
    let sync = link("drilling:start");
    assert_eq!(
        (sync.lower, sync.upper, sync.delay),
        (Duration::from_secs(5), Duration::from_secs(15), seconds(0, 1))
    );
    assert_eq!(link("drilling:end").delay, seconds(0, 2));
    // And the robot's: it hears of the downlink 5 to 15 s late.
    let robot = &agreement.views[1].network;
    assert_eq!(robot.contingents()[0].delay, seconds(5, 15));
    // Yet the team is done sooner if the robot starts at 30 s, when the downlink is over in any case.
    assert_eq!(promises(&yes(&team)), ["drilling:start 15 to 30 after start"]);
}

#[test]
fn fourteen_seconds_are_one_too_few() {
    assert!(matches!(verdict(&drilling(15).build().unwrap()), Verdict::Yes(_)));
    let team = drilling(14).build().unwrap();
    let Verdict::NotFound(why) = verdict(&team) else { panic!("news takes up to 15 s") };
    assert_eq!(why.lacks, Some(Duration::from_secs(1)));
    let causes: Vec<(Cause, i64)> = why.members.iter().map(|member| (member.what, member.times)).collect();
    // Without waiting for news, which is no better: 14 + 15 - 30.
    let parts =
        [Part::RequirementUpper(0), Part::RequirementLower(0), Part::LinkLower(0), Part::LinkUpper(0)];
    assert_eq!(causes, parts.map(|part| (Cause::Part(part), 1)));
    let within = Remedy { link: 0, change: Change::Within(Duration::from_secs(14)) };
    assert_eq!(remedies(&team, &why, &Options::default()), Ok(vec![within]));
}

#[test]
fn two_agents_do_something_at_one_moment_that_was_agreed() {
    for news in [[1, 3], [0, NEVER]] {
        let agreement = yes(&together(NEVER, news).build().unwrap());
        assert!(
            promises(&agreement).iter().any(|it| it.ends_with("8 to 8 after start")),
            "{news:?} {:?}",
            promises(&agreement)
        );
        // Neither view makes them one.
        for view in &agreement.views {
            assert_eq!(merge(&view.network).network.events().len(), view.network.events().len());
        }
    }
}

#[test]
fn two_agents_do_something_at_one_moment_after_news_that_takes_a_fixed_time() {
    assert!(matches!(verdict(&together(4, [1, 3]).build().unwrap()), Verdict::NotFound(_)));
    let agreement = yes(&together(4, [3, 3]).build().unwrap());
    let said = promises(&agreement);
    assert_eq!(said, ["x1 0 to 0 after x2", "x2 3 to 3 after c"]);
    // Clocks that agree are as good.
    let mut stamped = together(4, [1, 3]);
    stamped.links[0].stamped = true;
    assert_eq!(promises(&yes(&stamped.build().unwrap())), said);
}

#[test]
fn what_nature_alone_decides_is_decided_in_the_whole() {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 8], [0, 0]);
    let d = b.contingent("d", "two", ORIGIN, [3, 8], [0, 0]);
    b.require(c, d, [-4, 4]);
    b.link("one", "two", [0, 0], false);
    let Verdict::No(conflict) = verdict(&b.build().unwrap()) else {
        panic!("nobody can do anything about it")
    };
    assert_eq!(conflict.total, Duration::from_secs(-1));
    // With all the time Nature may take there is nothing to keep.
    b.requirements.clear();
    b.require(c, d, [-5, 5]);
    assert!(promises(&yes(&b.build().unwrap())).is_empty());
}

#[test]
fn joints_of_nobody_are_what_the_ways_through_them_say() {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 8], [0, 0]);
    let x = b.event("x", "one");
    let y = b.event("y", "two");
    let joint = b.event("all:end", "");
    b.require(c, x, [1, NEVER]);
    b.require(x, joint, [0, NEVER]);
    b.require(y, joint, [2, NEVER]);
    b.require(ORIGIN, joint, [0, 10]);
    b.require(c, y, [0, NEVER]);
    b.link("one", "two", [0, NEVER], false);
    let agreement = yes(&b.build().unwrap());
    assert!(agreement.views.iter().all(|view| view.network.find("all:end").is_none()));
    b.requirements[3].upper = Duration::from_secs(9).into();
    let Verdict::No(conflict) = verdict(&b.build().unwrap()) else { panic!("y cannot be 2 s before 9") };
    assert_eq!(conflict.total, Duration::from_secs(-1));
    let members: Vec<Part> = conflict.members.iter().map(|share| share.part).collect();
    // From the limit back over the joint to y, and from there to the latest c.
    let [limit, y_before, after_c] =
        [Part::RequirementUpper(3), Part::RequirementLower(2), Part::RequirementLower(4)];
    assert_eq!(members, [limit, y_before, after_c, Part::LinkUpper(0)]);
}
