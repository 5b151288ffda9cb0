//! What an editor would have of a text, without the protocol.

#![allow(dead_code, unreachable_pub, reason = "every test file uses only some of it")]

use std::sync::Arc;

use kirk_compiler::Diagnostic;
use kirk_lsp::{Shift, View, analyse, judge};

/// A mission with a bit of everything.
pub const MISSION: &str = "; Öffnen 𝄞
(defparameter *limit* (minutes 2))

(define-control-program scan ()
  \"Scans a rock.\"
  (declare (primitive)
    (duration (simple :lower-bound 20 :upper-bound 40 :max-observation-delay 15) :contingent t)))

(define-control-program stow (length)
  (declare (primitive) (duration (simple :lower-bound 1 :upper-bound length))))

(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound *limit*)
    (sequence (:slack t)
      (scan)
      (stow 3))))
";

/// Everything known of a text.
pub fn view(text: &str) -> View {
    let (analysis, unjudged) = analyse(text.to_string());
    let (missions, _) = judge(unjudged);
    View { analysis: Arc::new(analysis), missions: Arc::new(missions), shift: Shift::default() }
}

/// Everything known of a text that has just replaced another.
pub fn after(before: &View, text: &str) -> View {
    let (analysis, _) = analyse(text.to_string());
    let shift = Shift::new(before.analysis.text(), text);
    View { analysis: Arc::new(analysis), missions: before.missions.clone(), shift }
}

/// Everything there is to say about a text.
pub fn problems(text: &str) -> Vec<Diagnostic> {
    let (analysis, unjudged) = analyse(text.to_string());
    let (_, judged) = judge(unjudged);
    analysis.diagnostics.into_iter().chain(judged).collect()
}

/// The text without the `^`, and where that was.
pub fn at(marked: &str) -> (String, u32) {
    let offset = marked.find('^').expect("a cursor");
    (marked.replacen('^', "", 1), offset as u32)
}

/// A text with the cursor put where it is in a piece of it that occurs there.
pub fn marked(text: &str, needle: &str) -> String {
    let plain = needle.replacen('^', "", 1);
    assert!(text.contains(&plain), "{plain:?} is not in the text");
    text.replacen(&plain, needle, 1)
}
