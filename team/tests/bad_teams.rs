//! What is wrong with a team is said, all of it at once.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod build;

use build::{Builder, NEVER, ORIGIN};

fn errors(b: &Builder) -> Vec<String> {
    b.build().unwrap_err().iter().map(ToString::to_string).collect()
}

#[test]
fn agents_have_names_of_their_own_and_are_known() {
    let mut b = Builder::new(&["robot", "robot", "rover"]);
    b.event("x", "robott");
    b.contingent("c", "", ORIGIN, [1, 2], [0, 0]);
    b.link("rover", "rover", [3, 2], false);
    assert_eq!(
        errors(&b),
        [
            "two agents are called `robot`; each needs a name of its own",
            "the delay [3, 2] is not 0 <= min <= max",
            "the link leads from `rover` to itself; an agent knows what it knows at once",
            "there is no agent `robott`; did you mean `robot`?",
            "nobody observes `c`; say which agent sees it first",
        ]
    );
    assert_eq!(errors(&Builder::new(&[])), ["the team has no agents; there must be at least one"]);
}

#[test]
fn what_begins_something_has_somebody_to_execute_it() {
    let mut b = Builder::new(&["one"]);
    let joint = b.event("joint", "");
    b.contingent("c", "one", joint, [1, 2], [0, 0]);
    assert_eq!(errors(&b), ["nobody executes `joint`, with which the way to `c` begins; give it an agent"]);
}

#[test]
fn news_that_is_needed_has_a_way() {
    let mut b = Builder::new(&["one", "two"]);
    let x = b.event("x", "one");
    let y = b.event("y", "two");
    b.require(x, y, [1, NEVER]);
    assert_eq!(
        errors(&b),
        [
            "no link leads from `one` to `two` or back, yet a requirement ties `y` of `two` to what `one` does; add a link \
          between them (one whose messages may all be lost, if need be)"
        ]
    );
    b.link("two", "one", [0, NEVER], true);
    assert!(b.build().is_ok());
}

#[test]
fn what_is_heard_late_cannot_be_the_same_moment() {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 8], [0, 0]);
    let x = b.event("x", "two");
    b.require(c, x, [0, 0]);
    b.link("one", "two", [5, 15], false);
    let message = "`x` of `two` cannot be the same moment as `c`: the news takes 5 to 15 s; allow some time between them";
    assert_eq!(errors(&b), [message]);
    // At once it can, and so it can if c is no surprise.
    b.links.clear();
    b.link("one", "two", [0, 0], false);
    assert!(b.build().is_ok());
}
