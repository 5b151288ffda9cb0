//! One slip costs one message: every word of a mission misspelt, every token taken out, every parenthesis moved.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::collections::BTreeSet;

use kirk_compiler::{Code, Diagnostic, LineIndex, Severity};

const MISSION: &str = "(defparameter *pause* (minutes 5))
(defclass glider ()
  ((location :initform \"start\" :type (member \"start\" \"end\") :accessor location)))
(define-control-program drive (site)
  (declare (primitive)
    (requires (at :start (= (location site) \"start\")))
    (duration (simple :lower-bound 15 :upper-bound 200
                      :min-observation-delay 1
                      :max-observation-delay 3)
      :contingent t)))
(define-control-program look (least most)
  (declare (primitive)
    (duration (simple :lower-bound least :upper-bound most))))
(define-control-program visit (number)
  (sequence (:slack t)
    (drive number)
    (label after (look 10 *pause*))
    (between (end drive) (start after) (simple-temporal :upper-bound (* 2 *pause*)))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 5000)
    (parallel (:slack t)
      (let ((sites 3))
        (dotimes (index sites)
          (visit index)))
      (delay 5 10))))
";

fn errors(text: &str) -> Vec<Diagnostic> {
    let mut found = common::compile(text).diagnostics;
    found.retain(|d| d.severity == Severity::Error);
    found
}

/// The words of the mission: where they begin and end.
fn words() -> Vec<(usize, usize)> {
    let mut words = Vec::new();
    let mut start = None;
    for (at, c) in MISSION.char_indices() {
        let inside = !c.is_whitespace() && !matches!(c, '(' | ')');
        match (inside, start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                words.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    words
}

#[test]
fn a_misspelt_word_costs_one_message_that_knows_the_word() {
    assert_eq!(errors(MISSION), []);
    let mut told = 0;
    for (from, to) in words() {
        let word = &MISSION[from..to];
        let letters: Vec<char> = word.chars().collect();
        if letters.len() < 4 || word.starts_with('"') || word.chars().any(|c| c.is_ascii_digit()) {
            continue;
        }
        // Two letters in the middle change places.
        let middle = (1..letters.len() - 1).find(|i| *i > 1 && letters[*i] != letters[*i - 1]).unwrap_or(1);
        let mut slip = letters;
        slip.swap(middle, middle - 1);
        let slip: String = slip.into_iter().collect();
        let text = format!("{}{slip}{}", &MISSION[..from], &MISSION[to..]);
        let found = errors(&text);
        // A definition misspelt is missed wherever it is used; each place is told.
        let helps: BTreeSet<String> = found.iter().filter_map(|d| d.help.clone()).collect();
        assert!(helps.len() <= 1, "{word} -> {slip}: {found:#?}");
        told += usize::from(helps.iter().any(|help| help.contains(word) || help.contains(&slip)));
    }
    assert!(told > 50, "only {told} words were guessed");
}

#[test]
fn a_missing_word_costs_one_message_and_one_where_it_is_missed() {
    for (from, to) in words() {
        let found = errors(&format!("{}{}", &MISSION[..from], &MISSION[to..]));
        let kinds: BTreeSet<(Code, String)> = found.into_iter().map(|d| (d.code, d.message)).collect();
        assert!(kinds.len() <= 2, "without {}: {kinds:#?}", &MISSION[from..to]);
    }
}

#[test]
fn a_parenthesis_too_few_or_too_many_costs_one_message() {
    for (at, c) in MISSION.char_indices().filter(|(_, c)| matches!(c, '(' | ')')) {
        let (before, after) = MISSION.split_at(at);
        for text in [format!("{before}{}", &after[1..]), format!("{before}{c}{after}")] {
            let found = errors(&text);
            assert_eq!(found.len(), 1, "{text}\n{found:#?}");
        }
    }
}

/// The message about a parenthesis too many knows the line that the indentation speaks of.
#[test]
fn the_indentation_shows_where_a_parenthesis_is_wrong() {
    for (from, to, line) in [
        ("\"start\")))\n", "\"start\"))))\n", 7),
        ("(declare (primitive)\n    (requires", "declare (primitive)\n    (requires", 6),
        ("(let ((sites 3))\n", "(let ((sites 3)))\n", 23),
        ("(parallel (:slack t)\n", "(parallel (:slack t))\n", 22),
    ] {
        assert!(MISSION.contains(from), "{from}");
        let text = MISSION.replacen(from, to, 1);
        let found = errors(&text);
        let index = LineIndex::new(&text);
        let lines: Vec<usize> =
            found[0].labels.iter().map(|label| index.line_column(&text, label.span.start).0).collect();
        assert!(lines.contains(&line), "{from} -> {to}: {lines:?} {found:#?}");
    }
}
