//! Each feature on a text with a `^` for the cursor: the text above, the answer below.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod editor;

use editor::{MISSION, at, marked, problems, view};
use kirk_compiler::{Severity, Span};
use kirk_lsp::{
    CompletionKind, OutlineKind, actions, completion, definition, edited, filled_in, folding, highlight,
    hints, hover, layout, lenses, outline, prepare_rename, references, rename, signature,
};

/// A snapshot with the text above.
macro_rules! shows {
    ($name:literal, $text:expr, $answer:expr) => {
        insta::assert_snapshot!($name, format!("{}\n----\n{}", $text.trim(), $answer.trim_end()))
    };
}

fn hover_at(marked: &str) -> String {
    let (text, offset) = at(marked);
    match hover(&view(&text), offset) {
        Some(hover) => {
            format!("[{}]\n{}", &text[hover.span.start as usize..hover.span.end as usize], hover.markdown)
        }
        None => "nothing".to_string(),
    }
}

#[test]
fn hover_says_what_a_program_is_and_when_it_happens() {
    for (needle, name) in [
        ("(sc^an)", "call_of_a_contingent_program"),
        ("(st^ow 3)", "call_of_an_activity_of_ours"),
        ("program ma^in", "the_mission"),
        ("program sc^an", "definition"),
        ("(seq^uence", "operator"),
        (":upper-bou^nd *limit*", "keyword"),
        ("(:sla^ck t)", "keyword_in_a_list"),
        ("(^with-temporal-constraint", "operator_at_its_first_character"),
        ("*lim^it*", "named_number"),
        ("upper-bound le^ngth", "parameter"),
    ] {
        insta::assert_snapshot!(name, hover_at(&marked(MISSION, needle)));
    }
    assert_eq!(hover_at("(define-control-program main ()^ (sequence ()))"), "nothing");
}

#[test]
fn hover_counts_the_occurrences_of_one_call() {
    let text = "(define-control-program hop () (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 2))))
(define-control-program main () (sequence (:slack t) (dotimes (i 8) (h^op))))";
    insta::assert_snapshot!(hover_at(text));
}

#[test]
fn what_was_known_of_a_text_is_kept_while_it_is_broken() {
    let before = view(MISSION);
    let broken = format!("{MISSION}\n(define-control-program more () (");
    let now = editor::after(&before, &broken);
    assert!(now.analysis.has_errors() && !now.is_current());
    assert_eq!(hints(&now, everything(&broken)), hints(&before, everything(MISSION)));
    assert!(lenses(&now)[0].title.starts_with("before the errors: controllable"), "{:?}", lenses(&now));
    // What has changed itself has no window any more, what stands behind it has.
    let changed = MISSION.replace("(scan)", "(scann)");
    assert_eq!(hints(&editor::after(&before, &changed), everything(&changed)).len(), 1);
}

fn everything(text: &str) -> Span {
    Span::new(0, 0, text.len())
}

fn shown_places(text: &str, places: &[Span]) -> String {
    let mut shown = text.to_string();
    for span in places.iter().rev() {
        shown.insert(span.end as usize, ']');
        shown.insert(span.start as usize, '[');
    }
    shown
}

const NAMES: &str = "(defpackage #:tools)
(in-package #:tools)
(defparameter *Limit* 60)
(define-control-program hop (n)
  (declare (primitive) (duration (simple :upper-bound (* n *limit*)))))
(defpackage #:mission (:use #:tools) (:import-from #:tools #:hop))
(in-package #:mission)
(define-control-program main ()
  (parallel (:slack t)
    (label first (HOP 2))
    (let ((n 3)) (tools:hop n))
    (dotimes (n 3) (hop n))
    (between (end first) (start (hop 3)) (simple-temporal :upper-bound tools:*limit*))))
";

#[test]
fn a_name_leads_to_its_definition_and_to_every_place_in_any_case_and_package() {
    for (needle, name) in [
        ("(HO^P 2)", "program"),
        ("tools:*lim^it*", "named_number"),
        ("(tools:hop n^)", "variable"),
        ("bound (* n^", "parameter"),
        ("(end fir^st)", "label"),
        ("#:too^ls) (:import", "package"),
    ] {
        let (text, offset) = at(&marked(NAMES, needle));
        let view = view(&text);
        let all = references(&view.analysis, offset, true);
        let defined = definition(&view.analysis, offset);
        assert_eq!(references(&view.analysis, offset, false).len() + defined.len(), all.len());
        assert!(defined.iter().all(|place| all.contains(place)));
        let line = view.analysis.lines.line_of(defined[0].start) + 1;
        insta::assert_snapshot!(
            format!("places_of_a_{name}"),
            format!("defined in line {line}\n{}", shown_places(&text, &all))
        );
    }
    let (text, offset) = at("(define-control-program m^ain () (nothing))");
    assert_eq!(references(&view(&text).analysis, offset, false), []);
}

fn renamed(marked: &str, new: &str) -> String {
    let (text, offset) = at(marked);
    match rename(&view(&text).analysis, offset, new) {
        Ok(edits) => edited(&text, &edits),
        Err(why) => format!("refused: {why}"),
    }
}

#[test]
fn renaming_changes_every_place_and_nothing_else() {
    assert_eq!(
        renamed(&marked(NAMES, "(HO^P 2)"), "jump"),
        NAMES.replace("HOP", "jump").replace("hop", "jump")
    );
    assert_eq!(
        renamed(&marked(NAMES, "tools:*lim^it*"), "+limit+"),
        NAMES.replace("*Limit*", "+limit+").replace("*limit*", "+limit+")
    );
    assert_eq!(renamed(&marked(NAMES, "label fir^st"), "x"), NAMES.replace("first", "x"));
    assert_eq!(
        renamed(&marked(NAMES, "(dotimes (n^ 3)"), "i"),
        NAMES.replace("(dotimes (n 3) (hop n))", "(dotimes (i 3) (hop i))")
    );
}

#[test]
fn renaming_reaches_what_packages_export_and_import() {
    let text = "(defpackage #:tools (:export #:HOP #:rover))
(in-package #:tools)
(defclass rover () ((place :accessor place)))
(define-control-program hop () (declare (primitive)))
(defpackage #:mission (:import-from #:tools #:hop #:rover))
(in-package #:mission)
(defclass racer (rover) ())
(define-control-program main () (hop))
";
    let renamed = |needle, new| renamed(&marked(text, needle), new);
    assert_eq!(renamed("(ho^p))", "jump"), text.replace("HOP", "jump").replace("hop", "jump"));
    assert_eq!(renamed("(ro^ver)", "cart"), text.replace("rover", "cart"));
}

#[test]
fn renaming_is_refused_with_a_reason() {
    let of = |needle: &str, new: &str| renamed(&marked(NAMES, needle), new);
    let refusals = [
        of("program ma^in", "mission"),
        of("(paral^lel", "x"),
        of("label fir^st", "a b"),
        of("label fir^st", "12"),
        of("label fir^st", "x:y"),
        of("label fir^st", ""),
        of("label fir^st", "Sequence"),
        of("label fir^st", "hop"),
        of("(HO^P 2)", "first"),
        of("(HO^P 2)", "main"),
        of("bound (* n^", "*limit*"),
        of("#:too^ls) (:import", "x"),
        of("\n^", "x"),
        of("(dotimes (n 3^)", "x"),
        of("(:sla^ck t)", "x"),
        renamed("(define-control-program a () (wh^at))", "x"),
        renamed(
            "(define-control-program a^ () (b)) (define-control-program b () (declare (primitive)))",
            "B",
        ),
    ];
    insta::assert_snapshot!(refusals.join("\n"));
    let (text, offset) = at(&marked(NAMES, "(tools:ho^p n)"));
    let span = prepare_rename(&view(&text).analysis, offset).unwrap();
    assert_eq!(&text[span.start as usize..span.end as usize], "hop");
}

fn offered(marked: &str) -> String {
    let (text, offset) = at(marked);
    let found = completion(&view(&text).analysis, offset);
    found.iter().map(|it| it.label.as_str()).collect::<Vec<_>>().join(" ")
}

#[test]
fn completion_offers_what_may_stand_there() {
    let programs = "(defparameter *limit* 60)
(define-control-program drill (n) (declare (primitive)))
(define-control-program stow () (declare (primitive)))
";
    let cases = [
        "^",
        "(^",
        "(def^",
        "(define-control-program ^",
        "(define-control-program main () ^",
        "(define-control-program main () (^",
        "(define-control-program main () (declare (^",
        "(define-control-program main () (declare (duration ^",
        "(define-control-program main () (declare (duration (simple ^",
        "(define-control-program main () (declare (duration (simple :upper-bound ^",
        "(define-control-program main () (declare (duration (simple :upper-bound 5) ^",
        "(define-control-program main () (declare (duration (simple :upper-bound 5) :contingent ^",
        "(define-control-program main () (sequence ^",
        "(define-control-program main () (sequence (^",
        "(define-control-program main () (sequence (:slack ^",
        "(define-control-program main () (sequence (:slack t) (^)",
        "(define-control-program main () (with-temporal-constraint ^",
        "(define-control-program main () (with-temporal-constraint (simple-temporal ^",
        "(define-control-program main () (with-temporal-constraint (simple-temporal) (d^",
        "(define-control-program main (n) (let ((k 3)) (drill ^)))",
        "(define-control-program main (n) (drill (^)))",
        "(define-control-program main () (parallel () (label x (stow)) (between (^",
        "(define-control-program main () (parallel () (label x (stow)) (between (end ^",
        "(define-control-program main () (parallel () (between (end x) (end y) (^",
        "(define-control-program main () (delay (^",
        "(define-control-program main () (delay 5 (^",
        "(define-control-program main () (delay 5 ^",
        "(defparameter *wait* (^",
        "(define-control-program main () ; (^",
        "(define-control-program main () \"(^",
        "(defclass rover () ((place ^",
        "(defclass rover () ((place :accessor place)))\n(define-control-program go () (declare (requires (^",
        "(defpackage #:a (^",
    ];
    let shown: Vec<String> =
        cases.iter().map(|case| format!("{case}\n    {}", offered(&format!("{programs}{case}")))).collect();
    insta::assert_snapshot!(shown.join("\n"));
}

#[test]
fn a_completion_writes_the_whole_form_and_replaces_the_word() {
    let written = |marked: &str, label: &str| {
        let (text, offset) = at(marked);
        let found = completion(&view(&text).analysis, offset);
        let chosen =
            found.iter().find(|it| it.label == label).unwrap_or_else(|| panic!("no {label} in {marked}"));
        edited(&text, &[(chosen.replace, filled_in(&chosen.snippet))])
    };
    assert_eq!(
        written("(define-control-program main () (seq^))", "sequence"),
        "(define-control-program main () (sequence (:slack t)\n  ))"
    );
    assert_eq!(
        written("(define-control-program main () del^)", "delay"),
        "(define-control-program main () (delay 5 10))"
    );
    assert_eq!(
        written(
            "(define-control-program hop (n) (declare (primitive))) (define-control-program main () (sequence () (h^o",
            "hop"
        ),
        "(define-control-program hop (n) (declare (primitive))) (define-control-program main () (sequence () (hop n)"
    );
    assert_eq!(
        written("(define-control-program main () (declare (duration (simple :lo^wer", ":lower-bound"),
        "(define-control-program main () (declare (duration (simple :lower-bound "
    );
    let kinds = completion(&view("(defparameter *x* 5)\n(define-control-program a () (delay ").analysis, 57);
    assert!(
        kinds.iter().any(|it| it.label == "*x*" && it.kind == CompletionKind::Number && it.detail == "5")
    );
}

fn signature_at(marked: &str) -> String {
    let (text, offset) = at(marked);
    let Some(found) = signature(&view(&text).analysis, offset) else { return "nothing".to_string() };
    let active = found.active.map(|active| found.parameters[active]);
    let mut label = found.label.clone();
    if let Some((start, end)) = active {
        label.insert(end, ']');
        label.insert(start, '[');
    }
    label
}

#[test]
fn the_signature_shows_the_part_the_cursor_is_in() {
    let programs =
        "(define-control-program move (who to) (declare (primitive)))\n(define-control-program main () ";
    let at = |rest: &str| signature_at(&format!("{programs}{rest}"));
    assert_eq!(at("(move ^"), "(move [who] to)");
    assert_eq!(at("(move 'a ^"), "(move who [to])");
    assert_eq!(at("(move 'a \"b\" ^"), "(move who to)");
    assert_eq!(at("(move 'a (+ ^"), "(+ [number...])");
    assert_eq!(at("(move 'a (+ 1 2) ^"), "(move who to)");
    assert_eq!(at("(sequence (^"), "(sequence [(:slack t)] form...)");
    assert_eq!(at("(sequence (:slack t) (a) (b) ^"), "(sequence (:slack t) [form...])");
    assert_eq!(at("(between (end a) ^"), "(between event [event] (simple-temporal ...))");
    assert_eq!(at("(nothing ^"), "(define-control-program name (parameter...) [form...])");
    assert_eq!(signature_at("^(a)"), "nothing");
    assert_eq!(signature_at("(define-control-program a () ; ^"), "nothing");
}

#[test]
fn the_outline_has_every_definition_in_its_place() {
    let text = "(defparameter *limit* (minutes 5))
(defclass rover () ((place :accessor place) (fuel :type integer)))
(define-control-program hop (n) (declare (primitive)))
(define-control-program main () (hop 1))
(define-control-program torn (";
    let view = view(text);
    let found = outline(&view.analysis);
    let shown: Vec<String> = found
        .iter()
        .map(|it| {
            let children: Vec<&str> = it.children.iter().map(|child| child.name.as_str()).collect();
            assert!(it.whole.start <= it.selection.start && it.selection.end <= it.whole.end);
            format!("{:?} {} [{}] {}", it.kind, it.name, it.detail, children.join(" "))
        })
        .collect();
    assert_eq!(
        shown,
        [
            "Number *limit* [(minutes 5)] ",
            "Class rover [] place fuel",
            "Primitive hop [n] ",
            "Program main [] ",
            "Program torn [] "
        ]
    );
    assert_eq!(found[4].kind, OutlineKind::Program);
}

#[test]
fn forms_and_comments_fold() {
    let text = ";; one\n;; two\n\n(define-control-program main ()\n  (sequence ()\n    (a)) ; no\n  (b))\n#| a\nb |#\n(c)\n";
    let shown: Vec<String> = folding(&view(text).analysis)
        .iter()
        .map(|fold| format!("{}-{}{}", fold.first, fold.last, if fold.comment { " comment" } else { "" }))
        .collect();
    assert_eq!(shown, ["0-1 comment", "3-6", "4-5", "7-8 comment"]);
}

#[test]
fn every_word_has_its_colour() {
    let text = "; Größe\n(defparameter *limit* (+ 5 1))\n#| two\nlines |#\n(define-control-program hop (n) \"doc\"\n  (declare (primitive) (duration (simple :upper-bound n) :contingent t)))\n(define-control-program main ()\n  (label first (hop 'x)) (between (end first) (start hop) (simple-temporal :upper-bound *LIMIT*)) (nowhere))";
    let shown: Vec<String> = highlight(&view(text).analysis)
        .iter()
        .map(|it| {
            let piece = &text[it.span.start as usize..it.span.end as usize];
            format!("{:?}{} {piece}", it.kind, if it.definition { "!" } else { "" })
        })
        .collect();
    insta::assert_snapshot!(shown.join("\n"));
}

#[test]
fn hints_and_lenses_show_windows_and_the_verdict() {
    let view = view(MISSION);
    let mut text = MISSION.to_string();
    for hint in hints(&view, everything(MISSION)).into_iter().rev() {
        text.insert_str(hint.offset as usize, &format!(" «{}»", hint.label));
    }
    for lens in lenses(&view).into_iter().rev() {
        let line = MISSION[..lens.span.start as usize].rfind('\n').map_or(0, |at| at + 1);
        text.insert_str(line, &format!("« {} »\n", lens.title));
    }
    insta::assert_snapshot!(text);
    assert_eq!(hints(&view, Span::new(0, 0, 10)), []);
}

/// What each action would make of the text, and whether anything is wrong then.
fn acted(text: &str) -> String {
    let view = view(text);
    let problems = problems(text);
    let mut shown = String::new();
    for action in actions(&view, &problems) {
        let after = edited(text, &action.edits);
        let left: Vec<String> = editor::problems(&after)
            .iter()
            .filter(|it| it.severity == Severity::Error)
            .map(|it| it.code.to_string())
            .collect();
        let left = if left.is_empty() {
            "then no error is left".to_string()
        } else {
            format!("then: {}", left.join(" "))
        };
        shown.push_str(&format!("* {}: {} ({left})\n", problems[action.problem].code, action.title));
        let lines = after.lines().filter(|line| !text.lines().any(|before| before == *line));
        lines.for_each(|line| shown.push_str(&format!("    {line}\n")));
    }
    shown
}

#[test]
fn actions_put_slips_right() {
    let text = "(define-control-program hop ()
  (declare (primitive)
    (duration (simple :lower-bound 5 :uper-bound 3))))
(define-control-program skip ()
  (declare (primitive)
    (duration (simple :lower-bound 9 :upper-bound 3))))
(define-control-program listen ()
  (declare (primitive)
    (duration (simple :upper-bound 3 :max-observation-delay 3))))
(define-control-program main ()
  (sequnce (:slack t)
    (hopp) (skip)
    (fly 1 2)
    (parallel (:slak t) (listen))))
(defclass rover () ((place :type (member \"base\" \"rock\") :accessor place)))
(define-control-program go (who)
  (declare (primitive) (requires (at :start (= (place who) \"bose\")))))
";
    shows!("actions_on_slips", text, acted(text));
}

#[test]
fn actions_settle_a_conflict() {
    let too_late = include_str!("../../examples/rmpl/too-late.rmpl");
    let text = too_late.split_once("\n\n").unwrap().1;
    shows!("actions_on_late_news", text, acted(text));
    let text = "(defparameter *deadline* (minutes 1))
(define-control-program listen ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 40) :contingent t)))
(define-control-program act ()
  (declare (primitive) (duration (simple :lower-bound 30))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound *deadline*)
    (sequence ()
      (listen)
      (act))))
";
    shows!("actions_on_a_named_deadline", text, acted(text));
    let text = "(define-control-program listen (n)
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound n) :contingent t)))
(define-control-program main ()
  (parallel (:slack nil)
    (listen 20)
    (listen 30)))
";
    shows!("actions_on_a_coincidence", text, acted(text));
}

#[test]
fn what_is_offered_settles_every_conflict_and_not_only_the_one_shown() {
    let text = "(define-control-program collect ()
  (declare (primitive)
    (duration (simple :lower-bound 15 :upper-bound 30 :min-observation-delay 5 :max-observation-delay 15)
      :contingent t)))
(define-control-program pack ()
  (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 5))))
(define-control-program main ()
  (sequence (:slack t) (collect) (pack))
  (between (end collect) (start pack) (simple-temporal :upper-bound 3)))
";
    shows!("actions_where_one_conflict_hides_another", text, acted(text));
}

#[test]
fn a_start_that_nobody_knows_of_can_be_given_slack() {
    let text = "(define-control-program listen ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 40 :max-observation-delay 5) :contingent t)))
(define-control-program act () (declare (primitive) (duration (simple :upper-bound 30))))
(define-control-program main ()
  (sequence (:slack nil)
    (listen)
    (label last (act))))
";
    shows!("actions_on_a_start_at_a_late_end", text, acted(text));
    insta::assert_snapshot!("label", hover_at(&marked(text, "label la^st")));
    insta::assert_snapshot!("start_at_a_late_end", hover_at(&marked(text, "(a^ct))))")));
}

#[test]
fn a_new_document_is_no_error() {
    for text in ["", "; soon\n"] {
        let told: Vec<_> = problems(text).iter().map(|it| (it.code.to_string(), it.severity)).collect();
        assert_eq!(told, [("K0109".to_string(), Severity::Note)]);
    }
}

#[test]
fn formatting_is_that_of_kirk_fmt_and_keeps_the_ends_of_lines() {
    let text = "(define-control-program main ()\n(sequence ()\n(a)))\n; end\n";
    let laid_out = |text: &str| {
        let edits = layout(&view(text).analysis)?;
        Some(edited(text, &edits))
    };
    assert_eq!(laid_out(text).unwrap(), kirk_compiler::format(text).unwrap());
    let edits = layout(&view(text).analysis).unwrap();
    assert!(edits.len() == 1 && edits[0].0.start == 32 && edits[0].0.end == 51, "{edits:?}");
    let crlf = text.replace('\n', "\r\n");
    assert_eq!(laid_out(&crlf).unwrap(), kirk_compiler::format(text).unwrap().replace('\n', "\r\n"));
    let formatted = laid_out(text).unwrap();
    assert_eq!(layout(&view(&formatted).analysis), Some(Vec::new()));
    assert_eq!(laid_out("(a"), None);
}

#[test]
fn a_file_without_main_is_a_library() {
    let text = "(define-control-program hop () (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 6) :contingent t)))
(define-control-program twice () (with-temporal-constraint (simple-temporal :upper-bound 11) (hop) (hop)))
(define-control-program far (n) (hop) (delay n))
";
    let told: Vec<String> =
        problems(text).iter().map(|it| format!("{} {:?}", it.code, it.severity)).collect();
    assert_eq!(
        told,
        ["K0601 Error"],
        "the program nobody calls is judged; that there is no `main` is no problem"
    );
    let text = text.replace("11)", "12)").replace("(delay n)", "(elsewhere)");
    let told: Vec<String> =
        problems(&text).iter().map(|it| format!("{} {:?}", it.code, it.severity)).collect();
    assert_eq!(told, ["K0301 Warning"], "it may be defined in another file");
    assert_eq!(lenses(&view(&text)), []);
}

#[test]
fn a_file_of_several_missions_has_a_verdict_for_each() {
    let text = "(defpackage #:a) (in-package #:a) (define-control-program main () (delay 5))
(defpackage #:b) (in-package #:b) (define-control-program main () (with-temporal-constraint (simple-temporal :upper-bound 3) (delay 5)))";
    let told: Vec<String> = problems(text).iter().map(|it| it.code.to_string()).collect();
    assert_eq!(told, ["K0601"]);
    let titles: Vec<String> = lenses(&view(text)).into_iter().map(|lens| lens.title).collect();
    assert_eq!(
        titles,
        [
            "controllable: whatever happens, takes 5 s, 0 contingent durations",
            "not controllable: some bounds do not go together"
        ]
    );
}

#[test]
fn a_name_that_something_has_already_is_refused_though_nothing_means_that() {
    let (text, offset) = at(
        "(define-control-program a^ () (declare (primitive)))\n(define-control-program b () (declare (primitive)))\n",
    );
    let refused = rename(&view(&text).analysis, offset, "b").unwrap_err();
    assert_eq!(refused, "The name `b` is taken: in line 2, it would be defined twice.");
}

/// A robot that is to drill within so many seconds of a talk, of whose end it hears 5 to 15 s later.
fn team(within: u32) -> String {
    format!(
        "(define-team crew (agent astronaut) (agent robot) (link astronaut robot :min-delay 5 :max-delay 15))
(define-control-program talk ()
  (declare (primitive) (agent astronaut) (duration (simple :lower-bound 15 :upper-bound 30) :contingent t)))
(define-control-program drill () (declare (primitive) (agent robot)))
(define-control-program main ()
  (sequence (:slack t) (talk) (drill))
  (between (end talk) (start drill) (simple-temporal :upper-bound {within})))"
    )
}

#[test]
fn the_verdict_on_a_team_is_that_on_all_of_its_agents() {
    let said = |text: &str| {
        let told: Vec<String> = problems(text).iter().map(|it| it.code.to_string()).collect();
        (lenses(&view(text)).remove(0).title, told)
    };
    let yes = "controllable by its team, with 1 promise: whatever happens, takes at least 15 s, 1 contingent duration";
    assert_eq!(said(&team(15)), (yes.to_string(), vec![]));
    // One executive that hears everything at once could do it.
    let (title, told) = said(&team(14));
    assert_eq!(title, "not found possible: no promises make its team sure of it");
    assert_eq!(told, ["K0602"]);
    let hover = hover_at(&marked(&team(15), "cr^ew"));
    assert!(hover.contains("- astronaut promises to start `talk`"), "{hover}");
    // What is left is known of one executive only.
    let hover = hover_at(&marked(&team(15), "(dr^ill))"));
    assert!(hover.contains("starts from") && !hover.contains("guaranteed"), "{hover}");
}

#[test]
fn a_team_and_its_agents_are_offered_where_they_stand() {
    let offered = |marked: &str| -> Vec<String> {
        let (text, offset) = at(marked);
        completion(&view(&text).analysis, offset).into_iter().map(|it| it.label).collect()
    };
    let mut parts = offered("(define-team crew (^");
    parts.sort();
    assert_eq!(parts, ["agent", "link"]);
    let mut agents = offered("(define-team crew (agent rover) (agent base) (link ^))");
    agents.sort();
    assert_eq!(agents, ["base", "rover"]);
}
