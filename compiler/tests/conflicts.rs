//! Missions that cannot be executed in every case, and how that is explained: the constraints to blame, in the source.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use kirk_compiler::{Explain, Source};

/// The explanation of a mission that is not controllable.
fn explanation(text: &str) -> String {
    let compiled = common::compile(text);
    let plan =
        compiled.lowered.unwrap_or_else(|| panic!("{}", common::diagnostics(text, &compiled.diagnostics)));
    match &Explain::of(&plan, &[Source::new("test.rmpl", text)]).all().unwrap()[..] {
        [] => "controllable".to_string(),
        problems => format!("{text}\n---\n{}", common::diagnostics(text, problems)),
    }
}

fn example(name: &str) -> String {
    let found = common::sources("examples/rmpl").into_iter().find(|(other, _)| other == name);
    found.map(|(_, text)| text).expect("the example")
}

#[test]
fn the_deadline_is_too_tight_for_a_chain_of_activities() {
    insta::assert_snapshot!(explanation(
        &example("astronaut").replace(":upper-bound 480", ":upper-bound 60")
    ));
}

#[test]
fn the_news_comes_too_late_to_act_on() {
    insta::assert_snapshot!(explanation(&example("too-late")));
}

#[test]
fn each_amount_that_is_said_to_be_enough_alone_is_and_no_less() {
    let mission = example("too-late");
    let told = explanation(&mission);
    for (said, written, enough, less) in [
        ("at most 25 s instead of 20 s", ":upper-bound 20)\n      ", "25", "24.999999"),
        ("at least 5 s instead of 10 s", ":lower-bound 10 :upper-bound 15", "5", "5.000001"),
        ("within 10 s instead of 15 s", ":max-observation-delay 15", "10", "10.000001"),
    ] {
        assert!(told.contains(said), "{said} in {told}");
        assert!(mission.contains(written), "{written} in {mission}");
        let amount = written.split([' ', ')']).nth(1).unwrap();
        let with = |other: &str| mission.replace(written, &written.replacen(amount, other, 1));
        assert_eq!(explanation(&with(enough)), "controllable", "{said}");
        assert_ne!(explanation(&with(less)), "controllable", "{said}");
    }
}

#[test]
fn orders_in_a_circle_are_no_matter_of_amounts() {
    let told = explanation(
        "(define-control-program hold ()
  (declare (primitive) (duration (simple :lower-bound 10 :upper-bound 20))))
(define-control-program inspect ()
  (declare (primitive) (duration (simple :lower-bound 10 :upper-bound 30) :contingent t)))
(define-control-program main ()
  (parallel (:slack t)
    (hold)
    (inspect)
    (between (end hold) (start inspect) (simple-temporal :lower-bound 0))
    (between (end inspect) (start hold) (simple-temporal :lower-bound 0))))
",
    );
    assert!(told.contains("go round in a circle") && told.contains("No one amount helps"), "{told}");
}

#[test]
fn a_contingent_duration_inside_a_tighter_bound() {
    insta::assert_snapshot!(explanation(
        "(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
(define-control-program lecture ()
  (declare (primitive) (duration (simple :lower-bound 50 :upper-bound 60))))
(define-control-program main ()
  (sequence (:slack nil)
    (with-temporal-constraint (simple-temporal :upper-bound 18)
      (drive))
    (lecture)))
"
    ));
}

#[test]
fn two_uncontrollable_ends_forced_together() {
    insta::assert_snapshot!(explanation(
        "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 5) :contingent t)))
(define-control-program b ()
  (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 5) :contingent t)))
(define-control-program main ()
  (parallel (:slack nil)
    (a)
    (b)))
"
    ));
}

#[test]
fn nothing_uncertain_and_still_too_much_to_do() {
    insta::assert_snapshot!(explanation(
        "(define-control-program eat ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 40)
    (sequence () (eat) (eat) (eat))))
"
    ));
}

#[test]
fn joins_alone_are_named() {
    let side_by_side = |part: &str| {
        explanation(&format!(
            "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))
(define-control-program b ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))
(define-control-program main ()
  (parallel (:slack nil)
    (a)
    {part}))
"
        ))
    };
    insta::assert_snapshot!([side_by_side("(sequence ())"), side_by_side("(b)")].join("\n"));
}
