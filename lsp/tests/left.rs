//! What is left, as an editor shows it: with the text at a figure it can be promised, a microsecond beyond it cannot.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod editor;

use editor::{MISSION, at, marked, view};
use kirk_compiler::Span;
use kirk_lsp::{Judgement, View, hints, hover};
use kirk_network::Duration;

/// What ours does depends on when Nature is done: where it can be is not how late it may be put off.
const AFTER: &str = "(define-control-program heat ()
  (declare (primitive)
    (duration (simple :lower-bound 10 :upper-bound 30 :max-observation-delay 4) :contingent t)))
(define-control-program pour () (declare (primitive) (duration (simple :lower-bound 2 :upper-bound 8))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (sequence (:slack t) (heat) (pour))
    (between (end heat) (start pour) (simple-temporal :upper-bound 9))))
";

fn is_promised(text: &str) -> bool {
    let missions = view(text).missions;
    assert_eq!(missions.len(), 1, "{text}");
    missions[0].verdict == Judgement::Controllable
}

fn hover_at(text: &str, needle: &str) -> String {
    let (plain, offset) = at(&marked(text, needle));
    assert_eq!(plain, text);
    hover(&view(text), offset).unwrap().markdown
}

/// The number behind some words.
fn figure(said: &str, words: &str) -> Duration {
    let (_, rest) = said.split_once(words).unwrap_or_else(|| panic!("no `{words}` in {said}"));
    Duration::parse_seconds(rest.split([' ', ';', ',']).next().unwrap()).unwrap()
}

const MICRO: Duration = Duration::from_micros(1);

/// With `written` in the place of `old` it can be promised up to the figure, and not beyond it.
fn is_tight(text: &str, old: &str, figure: Duration, beyond: Duration, written: impl Fn(Duration) -> String) {
    assert!(text.contains(old), "{old}");
    let promised = |amount: Duration| is_promised(&text.replacen(old, &written(amount), 1));
    assert!(promised(figure), "{old} at {figure} s");
    let beyond = figure.checked_add(beyond).unwrap();
    assert!(!promised(beyond), "{old} at {beyond} s");
}

#[test]
fn what_an_activity_has_left_is_exact() {
    let scan = hover_at(MISSION, "(sc^an)");
    let start = figure(&scan, "its start can be put off to ");
    is_tight(MISSION, "(scan)", start, MICRO, |amount| format!("(delay {amount}) (scan)"));
    let most = figure(&scan, "Nature may take up to ");
    is_tight(MISSION, ":upper-bound 40", most, MICRO, |amount| format!(":upper-bound {amount}"));
    // What comes after it can wait until it is certainly over.
    assert!(scan.contains("its news need never come"), "{scan}");
    assert!(is_promised(&MISSION.replace(":max-observation-delay 15", ":max-observation-delay 1000000")));
    let stow = hover_at(MISSION, "(st^ow 3)");
    let stretched = figure(&stow, "it may be stretched to ");
    let takes = ":lower-bound 1 :upper-bound length";
    is_tight(MISSION, takes, stretched, MICRO, |amount| format!(":lower-bound {amount}"));
}

#[test]
fn what_is_put_off_depends_on_nature() {
    let pour = hover_at(AFTER, "(po^ur)");
    let start = figure(&pour, "its start can be put off to ");
    let sequence = "(sequence (:slack t) (heat) (pour))";
    let at_least = |amount: Duration| {
        format!(
            "(parallel (:slack t) (label gate (delay {amount})) {sequence})
             (between (end gate) (start pour) (simple-temporal :lower-bound 0))"
        )
    };
    is_tight(AFTER, sequence, start, MICRO, at_least);
    let stretched = figure(&pour, "it may be stretched to ");
    let takes = ":lower-bound 2 :upper-bound 8";
    is_tight(AFTER, takes, stretched, MICRO, |amount| format!(":lower-bound {amount}"));
    let heat = hover_at(AFTER, "(he^at)");
    let most = figure(&heat, "Nature may take up to ");
    is_tight(AFTER, ":upper-bound 30", most, MICRO, |amount| format!(":upper-bound {amount}"));
    let late = figure(&heat, "its news may be up to ");
    let news = ":max-observation-delay 4";
    is_tight(AFTER, news, late, MICRO, |amount| format!(":max-observation-delay {amount}"));
}

#[test]
fn how_far_a_bound_can_move_is_told_where_it_is_written() {
    let less = -MICRO;
    for (text, needle, written) in [
        (MISSION, ":upper-bound *lim^it*", ":upper-bound *limit*"),
        (AFTER, ":upper-bound 6^0", ":upper-bound 60"),
        (AFTER, ":upper-bound ^9", ":upper-bound 9"),
    ] {
        let said = hover_at(text, needle);
        let least = figure(&said, " may be ");
        is_tight(text, written, least, less, |amount| format!(":upper-bound {amount}"));
    }
    let said = hover_at(AFTER, ":lower-bound ^2");
    // Its own upper bound is the limit.
    assert_eq!(figure(&said, " may be "), Duration::from_secs(8), "{said}");
    let minutes = AFTER.replace(":upper-bound 60", ":upper-bound (minutes 1)");
    for needle in ["(minu^tes 1)", "(minutes ^1)"] {
        assert!(
            hover_at(&minutes, needle).contains("at most: 1 minute, and may be "),
            "{}",
            hover_at(&minutes, needle)
        );
    }
}

#[test]
fn what_is_written_once_moves_together_and_what_has_many_values_is_told_by_how_much() {
    let text = "(define-control-program hop (most) (declare (primitive) (duration (simple :lower-bound 1 :upper-bound most))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 10) (sequence (:slack t) (hop 3) (hop 5))))
";
    let least = hover_at(text, ":lower-bound ^1");
    assert!(least.contains("1 s, and may be 3 s or less in all 2 occurrences together"), "{least}");
    let most = hover_at(text, ":upper-bound mo^st");
    assert!(most.contains("3 to 5 s, and may be up to 2 s less in all 2 occurrences together"), "{most}");
}

#[test]
fn of_a_no_and_of_what_is_very_large_nothing_is_measured() {
    let no = MISSION.replace("(minutes 2)", "30");
    assert!(!is_promised(&no));
    let said = hover_at(&no, "(sc^an)");
    assert!(!said.contains("put off"), "{said}");
    let large = "(define-control-program hop () (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 2))))
(define-control-program wait () (declare (primitive)))
(define-control-program main () (sequence (:slack t) (wait) (dotimes (i 10000) (hop))))";
    for needle in ["(wa^it)", ":upper-bound ^2"] {
        let said = hover_at(large, needle);
        assert!(said.contains("not measured here, as the mission is large"), "{said}");
    }
}

#[test]
fn hints_tell_the_latest_start_of_small_missions() {
    let shown = |view: &View, text: &str| -> Vec<String> {
        hints(view, Span::new(0, 0, text.len())).into_iter().map(|hint| hint.label).collect()
    };
    let scan = figure(&hover_at(MISSION, "(sc^an)"), "its start can be put off to ");
    let stow = figure(&hover_at(MISSION, "(st^ow 3)"), "its start can be put off to ");
    let expected = [format!("0-119 s, can wait to {scan} s"), format!("20-120 s, can wait to {stow} s")];
    assert_eq!(shown(&view(MISSION), MISSION), expected);
    let larger =
        MISSION.replace("(stow 3)", "(dotimes (i 100) (stow 1))").replace("(minutes 2)", "(minutes 9)");
    assert!(shown(&view(&larger), &larger).iter().all(|label| !label.contains("can wait to")));
}
