//! The layout is canonical: it depends on the forms and comments alone, stays as it is, and changes no meaning.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests may panic and measure stacks")]

mod common;

use kirk_compiler::{Options, Source, compile, format};
use proptest::prelude::*;

#[test]
fn the_examples_are_laid_out() {
    for (name, text) in common::sources("examples/rmpl") {
        assert_eq!(format(&text).unwrap(), text, "{name}");
    }
}

#[test]
fn what_can_be_read_keeps_its_meaning_and_a_second_time_changes_nothing() {
    let mut read = 0;
    for directory in ["tests/rmpl/bad", "tests/rmpl/good"] {
        for (name, text) in common::sources(directory) {
            let Ok(once) = format(&text) else { continue };
            read += 1;
            assert_eq!(format(&once).unwrap(), once, "{name}");
            let options = common::options_in(&text);
            let (before, after) =
                (common::compile_with(&text, &options), common::compile_with(&once, &options));
            let codes = |compilation: &kirk_compiler::Compilation| {
                compilation.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>()
            };
            assert_eq!(codes(&before), codes(&after), "{name}");
            let network = |compilation: kirk_compiler::Compilation| {
                compilation.lowered.map(|lowered| common::network(&lowered))
            };
            assert_eq!(network(before), network(after), "{name}");
        }
    }
    assert!(read > 60, "only {read} files can be read");
}

#[test]
fn every_form_has_its_layout() {
    insta::assert_snapshot!(format(FORMS).unwrap());
}

#[test]
fn comments_stay_where_they_are() {
    let formatted = format(COMMENTS).unwrap();
    assert_eq!(format(&formatted).unwrap(), formatted);
    insta::assert_snapshot!(formatted);
}

#[test]
fn what_cannot_be_read_is_refused_with_the_reasons() {
    for (text, code) in
        [("(a", "K0101"), (")", "K0102"), ("(a \"b)", "K0103"), ("#| a", "K0104"), ("x = 5", "K0108")]
    {
        let problems = format(text).unwrap_err();
        assert!(problems.iter().any(|d| d.code.to_string() == code), "{text}: {problems:?}");
    }
    // What is read but means nothing is laid out as well as anything.
    assert_eq!(format("(foo   (bar)\n\n\n1)").unwrap(), "(foo (bar) 1)\n");
    assert_eq!(format("").unwrap(), "");
    assert_eq!(format("\n\n ; alone").unwrap(), "; alone\n");
}

#[test]
fn long_and_deep_texts_are_laid_out_in_linear_time_on_a_small_stack() {
    let work = || {
        for open in ["(", "(sequence () ", "(a b ", "'(", "(let ((x ", "(duration (simple "] {
            let parentheses = open.matches('(').count() - open.matches(')').count();
            let depth = 990 / parentheses / (1 + open.matches('\'').count());
            let closing = ")".repeat(parentheses * depth);
            let text = format!("(define-control-program a () {}x{closing})", open.repeat(depth));
            let once = format(&text).unwrap();
            assert_eq!(format(&once).unwrap(), once);
        }
        let once = format(&format!("(a {})", "(b ; c\n) #| d |# ".repeat(50_000))).unwrap();
        assert_eq!(format(&once).unwrap(), once);
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(work).unwrap().join().unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn however_the_examples_are_laid_out_they_are_laid_out_the_same(which in any::<prop::sample::Index>(), seed in any::<u64>()) {
        let sources = common::sources("examples/rmpl");
        let (name, text) = &sources[which.index(sources.len())];
        let shaken = shake(text, seed);
        prop_assert_eq!(&format(&shaken).unwrap(), text, "{}:\n{}", name, shaken);
        let options = common::options_in(text);
        let network = |text: &str| compile(&[Source::new("x", text)], &options).lowered.map(|lowered| common::network(&lowered));
        prop_assert_eq!(network(&shaken), network(text));
    }

    #[test]
    fn a_random_program_keeps_its_meaning_and_its_comments(body in body(), gaps in proptest::collection::vec(0..6_usize, 40)) {
        let program = format!(
            "(define-control-program~a~(n)~(declare~(primitive)~(duration~(simple~:upper-bound~(+~n~5)))))\n\
             (define-control-program~main~()~\"what~it~is\"~{body})\n"
        );
        // Every gap becomes blanks, a line break, or a comment with a number of its own.
        let mut text = String::new();
        for (number, part) in program.split('~').enumerate() {
            text.push_str(part);
            let inside_string = text.matches('"').count() == 1;
            text.push_str(&match gaps[number % gaps.len()] {
                _ if inside_string => "~".to_string(),
                0 => "\n".to_string(),
                1 => format!("  ; note {number}\n"),
                2 => format!("\n\n ;; note {number}\n"),
                3 => format!(" #| note {number} |# "),
                _ => " ".to_string(),
            });
        }
        let once = format(&text).unwrap();
        prop_assert_eq!(&format(&once).unwrap(), &once);
        let notes = |text: &str| -> Vec<String> {
            let after = text.split("note ").skip(1);
            after.map(|rest| rest.chars().take_while(char::is_ascii_digit).collect()).collect()
        };
        prop_assert_eq!(notes(&text), notes(&once), "{}\n{}", text, once);
        let lowered = |text: &str| compile(&[Source::new("x", text)], &Options::default()).lowered;
        let before = lowered(&text);
        prop_assert!(before.is_some(), "{}", text);
        prop_assert_eq!(before.map(|lowered| common::network(&lowered)), lowered(&once).map(|lowered| common::network(&lowered)));
    }

    #[test]
    fn any_words_are_laid_out_once_and_for_all(words in proptest::collection::vec(0..WORDS.len(), 0..60)) {
        let text: String = words.iter().map(|word| WORDS[*word]).collect::<Vec<_>>().join(" ");
        for text in [format!("(a {text}"), text] {
            if let Ok(once) = format(&text) {
                prop_assert_eq!(&format(&once).unwrap(), &once);
                let codes = |text: &str| -> Vec<_> {
                    compile(&[Source::new("x", text)], &Options::default()).diagnostics.iter().map(|d| d.code).collect()
                };
                prop_assert_eq!(codes(&text), codes(&once));
            }
        }
    }
}

/// A body form with `~` for every gap.
fn body() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        (0..9_u32).prop_map(|n| format!("(a~{n})")),
        (0..9_u32, 9..20_u32).prop_map(|(low, high)| format!("(delay~{low}~{high})")),
        Just("(sequence~())".to_string()),
    ];
    leaf.prop_recursive(4, 30, 5, |inner| {
        let parts = proptest::collection::vec(inner, 1..5).prop_map(|parts| parts.join("~"));
        (parts, 0..6_usize, 1..4_u32).prop_map(|(parts, kind, n)| match kind {
            0 => format!("(sequence~(:slack~t)~{parts})"),
            1 => format!("(parallel~(:slack~t)~{parts})"),
            2 => format!("(sequence~{parts})"),
            3 => format!("(with-temporal-constraint~(simple-temporal~:lower-bound~{n})~{parts})"),
            4 => format!("(dotimes~(i~{n})~{parts})"),
            _ => format!("(let~((x~{n}))~{parts})"),
        })
    })
}

/// The text with other blanks: every run of blanks outside of strings and comments becomes another one. Blank lines and the
/// lines of comments stay, because they say something.
fn shake(text: &str, seed: u64) -> String {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut shaken = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = match c {
            ';' => rest.find('\n').unwrap_or(rest.len()),
            '"' => 1 + rest[1..].find('"').unwrap() + 1,
            c if c.is_whitespace() => rest.find(|c: char| !c.is_whitespace()).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        rest = after;
        if !c.is_whitespace() {
            shaken.push_str(token);
            continue;
        }
        let blank = token.matches('\n').count() > 1;
        let comment_before = shaken.rsplit('\n').next().is_some_and(|line| line.contains(';'));
        let comment_after = rest.starts_with(';');
        // A blank line says something in the examples wherever it is; `(` in the first column begins a definition.
        shaken.push_str(match (blank, comment_before || comment_after, random.u8(..4)) {
            (true, _, 0) => "\n\n",
            (true, _, 1) => "\n   \n\n\t",
            (true, _, _) => " \n\n\n ",
            (false, true, 0) => "\r\n",
            (false, true, _) => "\n  ",
            (false, false, 0) => " ",
            (false, false, 1) => "\n ",
            (false, false, 2) => "\r\n\t ",
            (false, false, _) => "   ",
        });
    }
    shaken
}

const WORDS: [&str; 26] = [
    "(",
    "(",
    "(",
    ")",
    ")",
    ")",
    "a",
    "'",
    ":k",
    "; c\n",
    "\n\n",
    "\n",
    "#| b |#",
    "#| b\n |#\n",
    "\"t\n u\"",
    "5",
    "(sequence",
    "(define-control-program",
    "(let",
    "(simple",
    ":max-observation-delay",
    "(duration",
    "(between",
    "()",
    "(:slack t)",
    "a-name-that-is-long-enough-to-reach-the-end-of-a-line-after-two-or-three-of-them",
];

const FORMS: &str = r#"
(DEFPARAMETER *x*    5 "What it is for.")
(defconstant +a-long-name-for-a-number-that-is-needed-in-many-places+ (+ (minutes 5) (* 2 (hours 1)) (seconds 30)))
(defpackage #:p (:use #:cl #:tools) (:import-from #:parts #:drive #:+speed+ #:another-name #:yet-another-name))
(in-package #:p)
(defclass c (b) ())
(defclass glider (vehicle) ((id :initarg :id) (location :initarg :location :initform "start" :type (member nil "start" "end") :accessor location)))
(define-control-program a (x y) "What it does." (declare (primitive) (requires (and (over :all (= (location x) y)) (at :start (= (location x) nil)))) (duration (simple :lower-bound 5 :upper-bound 10 :min-observation-delay 1 :max-observation-delay 2) :contingent t)))
(define-control-program short () (declare (primitive)))
(define-control-program none ())
(define-control-program long () (declare (primitive) (duration (simple :lower-bound (* +a-long-name-for-a-number+ 2) :upper-bound (* +a-long-name-for-a-number+ 3)))))
(define-control-program main ()
(with-temporal-constraint (simple-temporal :upper-bound 60) (sequence () (a 1 2)) (parallel (a 3 4)))
(let ((x 5) (y (minutes 2))) (a x y)) (let* ((a-rather-long-name (minutes 5)) (another-rather-long-name (* 2 a-rather-long-name))) (a a-rather-long-name another-rather-long-name))
(dotimes (i 3) (label (step i) (a i 0)) (delay 1 2))
(label the-whole-of-it (sequence (:slack t) (a 1 2) (a 3 4)))
(between (end (step 1)) (start (step 2)) (simple-temporal :upper-bound 5))
(between (end (a-rather-long-name 1 (+ i 1))) (start (another-rather-long-name 2 (+ i 1))) (simple-temporal :lower-bound -5 :upper-bound 5))
(a 'a-quoted-symbol-of-some-length "and a string that is long as well, so that" "it does not fit on one line of the file")
)
"#;

const COMMENTS: &str = r#"

;; At the top.
;;; Another.

#| A block
   of text. |#
(define-control-program a () ; behind the parameters
  ;; before the declaration
  (declare (primitive) ; behind a declaration
    ;; before the duration


    (duration (simple :lower-bound 5 ; the least
                      :upper-bound 10) ; and the most
       :contingent t))) ; at the end
; directly behind



(define-control-program main () (sequence ; no options

   ;; before the first

   (a)
   #| inside |# (a) (a #| nothing |#)
   ;; before the end
   )
  (a)   ; the last
  ;; really
  )
; the end"#;
