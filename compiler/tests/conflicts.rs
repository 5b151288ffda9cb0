//! Missions that cannot be executed in every case, and how that is explained: the constraints to blame, in the source.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use kirk_compiler::explain_conflict;
use kirk_network::Verdict;

/// The explanation of a mission that is not controllable.
fn explanation(text: &str) -> String {
    let compiled = common::compile(text);
    let plan =
        compiled.plan.unwrap_or_else(|| panic!("{}", common::diagnostics(text, &compiled.diagnostics)));
    match kirk_network::check(&plan.network).unwrap() {
        Verdict::Uncontrollable(conflict) => {
            let problem = explain_conflict(&conflict, &plan.network, &plan.origins, plan.entry);
            format!("{text}\n---\n{}", common::diagnostics(text, &[problem]))
        }
        Verdict::Controllable => "controllable".to_string(),
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
