//! Whatever is typed, every question gets an answer: no panic, and no place outside of the text.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod editor;

use std::panic::{AssertUnwindSafe, catch_unwind};

use editor::{MISSION, after, problems, view};
use kirk_compiler::Span;
use kirk_lsp::{
    View, actions, completion, definition, edited, folding, highlight, hints, hover, layout, lenses, outline,
    prepare_rename, references, rename, signature,
};

fn is_inside(text: &str, span: Span) {
    let (start, end) = (span.start as usize, span.end as usize);
    assert!(start <= end && text.is_char_boundary(start) && text.is_char_boundary(end), "{span:?}");
}

/// Everything that is asked of a text as a whole.
fn ask_about_the_text(view: &View) {
    let text = view.analysis.text();
    let all = Span::new(0, 0, text.len());
    for outline in outline(&view.analysis) {
        is_inside(text, outline.whole);
        is_inside(text, outline.selection);
    }
    let lines = view.analysis.lines.count() as u32;
    assert!(folding(&view.analysis).iter().all(|fold| fold.first < fold.last && fold.last < lines));
    let mut last = 0;
    for piece in highlight(&view.analysis) {
        is_inside(text, piece.span);
        assert!(piece.span.start >= last && piece.span.start < piece.span.end, "{piece:?} after {last}");
        assert!(!text[piece.span.start as usize..piece.span.end as usize].contains('\n'));
        last = piece.span.end;
    }
    hints(view, all).iter().for_each(|hint| is_inside(text, Span::new(0, 0, hint.offset as usize)));
    lenses(view).iter().for_each(|lens| is_inside(text, lens.span));
    layout(&view.analysis).into_iter().for_each(|edits| drop(edited(text, &edits)));
    for action in actions(view, &problems(text)) {
        edited(text, &action.edits);
    }
}

/// Everything that is asked about a place.
fn ask_at(view: &View, offset: usize) {
    let text = view.analysis.text();
    let at = offset as u32;
    hover(view, at).into_iter().for_each(|hover| is_inside(text, hover.span));
    for place in definition(&view.analysis, at).into_iter().chain(references(&view.analysis, at, true)) {
        is_inside(text, place);
    }
    for offered in completion(&view.analysis, at) {
        edited(text, &[(offered.replace, offered.snippet)]);
    }
    if let Some(signature) = signature(&view.analysis, at) {
        assert!(signature.parameters.iter().all(|(start, end)| signature.label.get(*start..*end).is_some()));
        assert!(signature.active.is_none_or(|active| active < signature.parameters.len()));
    }
    if prepare_rename(&view.analysis, at).is_ok() {
        drop(rename(&view.analysis, at, "some-other-name").map(|edits| edited(text, &edits)));
    }
}

/// Asks, and says for which text there was no answer.
fn answered(text: &str, how: &str, ask: impl FnOnce()) {
    assert!(catch_unwind(AssertUnwindSafe(ask)).is_ok(), "{how}: no answer for\n{text}");
}

fn boundaries(text: &str) -> Vec<usize> {
    text.char_indices().map(|(at, _)| at).chain([text.len()]).collect()
}

#[test]
fn a_mission_typed_character_by_character_is_followed() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut before = view("");
    for cut in boundaries(MISSION) {
        let text = &MISSION[..cut];
        answered(text, "typed", || {
            let now = view(text);
            for view in [after(&before, text), now.clone()] {
                ask_about_the_text(&view);
                ask_at(&view, cut);
                let places = boundaries(text);
                ask_at(&view, places[random.usize(..places.len())]);
            }
            if !now.missions.is_empty() {
                before = now;
            }
        });
    }
}

#[test]
fn every_place_of_every_small_text_has_an_answer() {
    for text in [
        MISSION,
        "",
        "(",
        ")",
        "\"",
        "#|",
        "(define-control-program",
        "(define-control-program main () (sequence (:slack",
        "(label x (label x (between (end x) (start",
        "(defclass a (b) ((c :accessor c)))\r\n(define-control-program m (x) (declare (requires (= (c x) 'y))))",
        "(define-control-program 𝄞 () (𝄞))\r(define-control-program main () (𝄞) (ö 'é \"ü",
        "((((((((((((((((",
        "'''''(a)",
        "(defpackage \"A\" (:use \"B\") (:import-from \"A\" \"x\"))(in-package \"A\")(defparameter x 5)(defparameter y A:x)",
    ] {
        answered(text, "as it is", || {
            let view = view(text);
            ask_about_the_text(&view);
            boundaries(text).into_iter().for_each(|offset| ask_at(&view, offset));
        });
    }
}

#[test]
fn a_mission_that_is_torn_and_shuffled_is_followed() {
    let cases = std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(200);
    let sources = [
        MISSION,
        include_str!("../../examples/rmpl/glider.rmpl"),
        include_str!("../../examples/rmpl/too-late.rmpl"),
        include_str!("../../examples/rmpl/antennas.rmpl"),
    ];
    let known: Vec<View> = sources.iter().map(|source| view(source)).collect();
    for seed in 0..cases {
        let mut random = fastrand::Rng::with_seed(seed);
        let number = random.usize(..sources.len());
        let mut text = sources[number].to_string();
        for _ in 0..=random.usize(..4) {
            let places = boundaries(&text);
            let (a, b) = (places[random.usize(..places.len())], places[random.usize(..places.len())]);
            let (start, end) = (a.min(b), a.max(b));
            match random.usize(..5) {
                // A short piece goes, or a long one, or comes twice, or moves to the front, or something strange comes.
                0 => text.replace_range(
                    start..boundaries(&text).into_iter().find(|at| *at > start).unwrap_or(end),
                    "",
                ),
                1 => text.replace_range(start..end, ""),
                2 => text = [&text[..end], &text[start..]].concat(),
                3 => text = [&text[start..end], &text[..start], &text[end..]].concat(),
                _ => text.insert_str(
                    start,
                    ["(", ")", "\"", "#|", "|#", ";", "'", "𝄞", "\r", ":"][random.usize(..10)],
                ),
            }
        }
        answered(&text, &format!("seed {seed}"), || {
            let places = boundaries(&text);
            for view in [view(&text), after(&known[number], &text)] {
                ask_about_the_text(&view);
                (0..5).for_each(|_| ask_at(&view, places[random.usize(..places.len())]));
            }
        });
    }
}

#[test]
fn deep_nesting_exhausts_no_stack() {
    for unit in ["(", "(sequence () ", "(minutes ", "'", "(label x ", "(let ((x ", "(and "] {
        let text = format!("(define-control-program main () {}", unit.repeat(5_000));
        let view = view(&text);
        ask_about_the_text(&view);
        ask_at(&view, text.len());
    }
}
