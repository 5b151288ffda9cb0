//! Whatever the text, there is a result: no panic, no exhausted stack, places inside the text, few messages.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests measure stacks in threads of their own"
)]

mod common;

use kirk_compiler::{Compilation, Explain, Options, Severity, Source, compile, to_sexpr};
use proptest::prelude::*;

/// Compiles and checks what must hold for every text.
fn result(text: &str) -> Compilation {
    let compiled = compile(&[Source::new("x", text)], &Options::default());
    for d in &compiled.diagnostics {
        for span in d.labels.iter().map(|label| label.span).chain([d.span]) {
            let (start, end) = (span.start as usize, span.end as usize);
            assert!(
                start <= end && end <= text.len(),
                "{span:?} is not in the text of {} bytes: {d:?}",
                text.len()
            );
            assert!(
                text.is_char_boundary(start) && text.is_char_boundary(end),
                "{span:?} cuts a character: {d:?}"
            );
        }
        assert!(!d.message.is_empty() && d.message.len() < 1_000, "{d:?}");
    }
    assert!(compiled.diagnostics.len() <= 201);
    assert_eq!(
        compiled.lowered.is_none(),
        compiled.diagnostics.iter().any(|d| d.severity == Severity::Error)
    );
    compiled
}

/// Does it on a stack of 2 MB, as a thread has.
fn on_a_small_stack(work: impl FnOnce() + Send + 'static) {
    std::thread::Builder::new().stack_size(2 << 20).spawn(work).unwrap().join().unwrap();
}

#[test]
fn a_mission_cut_anywhere_gives_a_result() {
    for (_, text) in common::sources("examples/rmpl") {
        for cut in (0..text.len()).filter(|cut| text.is_char_boundary(*cut)) {
            result(&text[..cut]);
            if cut % 3 == 0 {
                result(&text[cut..]);
            }
        }
    }
}

/// What fuzzing found: every file in `tests/crashes` once ended in a panic.
#[test]
fn what_once_crashed_gives_a_result() {
    let kept = common::sources("tests/crashes");
    assert!(!kept.is_empty());
    for (_, text) in kept {
        result(&text);
    }
}

#[test]
fn nesting_of_any_depth_gives_a_result() {
    on_a_small_stack(|| {
        for unit in [
            "(",
            "'",
            "((",
            "[",
            "#|",
            "(sequence ",
            "(minutes ",
            "`(",
            ")",
            "\"",
            "(and ",
            "(+ ",
            "(let ((x ",
            "(label x ",
            "(dotimes (i 2) ",
            "(between (start ",
        ] {
            for depth in [10, 1_000, 100_000] {
                result(&unit.repeat(depth));
                result(&format!(
                    "(define-control-program main () {}{})",
                    unit.repeat(depth),
                    ")".repeat(depth)
                ));
                result(&format!("(define-control-program main () (a {}))", unit.repeat(depth)));
                result(&format!(
                    "(define-control-program main () (declare (primitive) (requires {})))",
                    unit.repeat(depth)
                ));
            }
        }
    });
}

#[test]
fn what_may_be_nested_is_compiled_and_written_on_a_small_stack() {
    on_a_small_stack(|| {
        let opens = [
            ("(sequence (:slack t) ", 1),
            ("(parallel () ", 1),
            ("(let ((x 1)) ", 0),
            ("(dotimes (i 1) ", 0),
            ("(label (x i) (dotimes (i 1) ", 0),
        ];
        for (open, episodes) in opens {
            let depth = 990 / open.matches(" (").count().max(1);
            let text = format!(
                "(define-control-program a () (declare (primitive)))\n(define-control-program main ()\n(let ((i 0)) {}(a){}))\n",
                open.repeat(depth),
                ")".repeat(open.matches('(').count() * depth - open.matches(')').count() * depth)
            );
            let compiled = result(&text);
            let said = common::diagnostics(&text, &compiled.diagnostics);
            let plan = compiled.lowered.unwrap_or_else(|| panic!("{open}: {said}"));
            assert_eq!(plan.network.events().len(), 2 * (episodes * depth + 2));
            assert!(to_sexpr(&compiled.ast).unwrap().len() > depth);
            assert!(to_sexpr(&compiled.episodes).unwrap().len() > episodes * depth);
        }
        let calls: String =
            (1..=990).map(|n| format!("(define-control-program p{n} () (p{}))\n", n - 1)).collect();
        let text = format!(
            "(define-control-program p0 () (declare (primitive)))\n{calls}(define-control-program main () (p990))"
        );
        assert!(to_sexpr(&result(&text).episodes).unwrap().contains("p990"));
    });
}

#[test]
fn long_programs_are_compiled_in_linear_time() {
    on_a_small_stack(|| {
        let forms = "    (a)\n".repeat(50_000);
        let text = format!(
            "(define-control-program a () (declare (primitive)))\n(define-control-program main ()\n  (sequence ()\n{forms}))"
        );
        let compiled = result(&text);
        let network = &compiled.lowered.as_ref().expect("a network").network;
        assert_eq!(network.events().len(), 2 * 50_002);
        assert!(network.find("a#50000:end").is_some());
        assert!(to_sexpr(&compiled.episodes).unwrap().contains("a#50000"));
        // Half a million tokens, everything wrong.
        result(&"(a b) ".repeat(100_000));
        result(&"x (".repeat(100_000));
        result(&")(".repeat(100_000));
        result(&"\"a\n".repeat(100_000));
        result(&format!("(define-control-program main () (a {}))", "1,".repeat(200_000)));
        result(&format!("(define-control-program main () (a {}))", "‘ ".repeat(100_000)));
        result(&format!("(define-control-program main () {})", "(missing) ".repeat(100_000)));
        let programs: String =
            (0..20_000).map(|n| format!("(define-control-program p{n} () (q{n}))\n")).collect();
        result(&programs);
    });
}

#[test]
fn a_source_that_is_too_long_is_not_read() {
    let compiled = result(&"(ä) ".repeat(5_000_000));
    let codes: Vec<String> = compiled.diagnostics.iter().map(|d| d.code.to_string()).collect();
    assert_eq!(codes, ["K0112"]);
}

#[test]
fn names_are_unique_whatever_programs_are_called() {
    let text = "(define-control-program a () (declare (primitive)))
(define-control-program a#2 () (declare (primitive)))
(define-control-program main.1 () (declare (primitive)))
(define-control-program main () (sequence () (a) (a) (a#2) (main.1) (a#2) (a)))";
    let compiled = result(text);
    let network = compiled.lowered.expect("a network").network;
    let names: Vec<&str> =
        network.event_ids().map(|event| network.id(event)).filter(|id| id.ends_with(":start")).collect();
    assert_eq!(
        names,
        [
            "main:start",
            "main.2:start",
            "a:start",
            "a#3:start",
            "a#2:start",
            "main.1:start",
            "a#2#2:start",
            "a#4:start"
        ]
    );
}

#[test]
fn lisp_spellings_mean_the_same() {
    let plain = "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 90 :upper-bound 120))))
(define-control-program main () (sequence (:slack nil) (a)))";
    let odd = "\u{feff}#| one #| two |# |# (RMPL/LANG:Define-Control-Program A nil ; comment\r
\t(DECLARE (Primitive) (Duration (SIMPLE :Lower-Bound 9d1 :UPPER-BOUND (minute 2.)) :contingent nil)))\r
(rmpl/lang:define-control-program MAIN () (cl-user::a))";
    let events = |text| {
        let plan = result(text).lowered.expect("a network");
        plan.network
            .requirements()
            .iter()
            .map(|r| (r.lower, r.upper))
            .filter(|(l, _)| l.finite().is_some_and(|l| l.as_micros() > 0))
            .collect::<Vec<_>>()
    };
    assert_eq!(events(plain), events(odd));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_text_gives_a_result(text in ".{0,200}") {
        result(&text);
    }

    #[test]
    fn any_bytes_give_a_result(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        result(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_words_of_the_language_give_a_result(words in proptest::collection::vec(0..WORDS.len(), 0..80)) {
        let text: String = words.iter().map(|word| WORDS[*word]).collect::<Vec<_>>().join(" ");
        let compiled = result(&text);
        result(&format!("(define-control-program main () {text})"));
        if let Some(plan) = compiled.lowered
        {
            let _ = Explain::of(&plan, &[Source::new("test.rmpl", text)]).all();
        }
    }

    #[test]
    fn a_mission_with_one_slip_gives_a_result(which in 0..12_usize, at in any::<prop::sample::Index>(), c in "[()\"'#|;:a5 \n\\[]?") {
        let sources = common::sources("examples/rmpl");
        let text = &sources[which % sources.len()].1;
        let at = at.index(text.len());
        prop_assume!(text.is_char_boundary(at) && text.is_char_boundary(at + 1));
        let (before, after) = text.split_at(at);
        let after = after.get(1..).unwrap_or("");
        result(&format!("{before}{c}{after}"));
    }
}

const WORDS: [&str; 56] = [
    "(dotimes (i 3)",
    "(dotimes (i",
    "(let ((x 5))",
    "(let*",
    "(label x",
    "(label (x i)",
    "(between (start x) (end a) (simple-temporal :upper-bound 5))",
    "(between",
    "(start",
    "(end",
    "(delay 1 2)",
    "(delay",
    "x",
    "i",
    "(+ i 1)",
    "(* 2",
    "(",
    "(",
    "(",
    ")",
    ")",
    ")",
    "\n(define-control-program",
    "a",
    "main",
    "()",
    "(declare",
    "(primitive)",
    "(duration",
    "(simple",
    ":lower-bound",
    ":upper-bound",
    "5",
    "1/2",
    "-3",
    ":infinity",
    ":contingent t",
    ":max-observation-delay",
    "(sequence (:slack t)",
    "(parallel",
    "(with-temporal-constraint",
    "(simple-temporal",
    "(minutes 5)",
    "'",
    "\"text\"",
    "(defclass",
    "(defpackage #:p)",
    "(in-package #:p)",
    "(requires",
    "(and",
    "(= (x a) nil)",
    "nil",
    "t",
    "#|",
    "|#",
    ";",
];
