//! The parser knows every word of the table, and so do the editors.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests read and write files and may panic"
)]

mod common;

use std::collections::BTreeSet;
use std::path::Path;

use kirk_compiler::Code;
use kirk_compiler::words::{DEFINITIONS, Keyword, Layout, Position, SLOT, UNITS, WORDS, Word, word};

const GRAMMARS: [&str; 3] =
    ["vscode/syntaxes/rmpl.tmLanguage.json", "neovim/syntax/rmpl.vim", "emacs/rmpl-mode.el"];

/// Whether kirk says of a text that there is something in it that it does not know.
fn is_unknown(text: &str) -> bool {
    let unknown = [
        Code::UnknownTopLevel,
        Code::UnknownOperator,
        Code::UnknownProgram,
        Code::UnknownDeclaration,
        Code::UnknownKeyword,
        Code::UnknownSlotOption,
        Code::UnknownUnit,
    ];
    common::compile(text).diagnostics.iter().any(|d| unknown.contains(&d.code))
}

#[test]
fn every_word_is_one_where_the_table_says_that_it_stands() {
    let mut known = BTreeSet::new();
    for Word { name, position, about, .. } in WORDS {
        assert!(known.insert(name) && !about.is_empty(), "{name}");
        let around = |form: &str| match position {
            Position::Definition => form.to_string(),
            Position::Declare | Position::Body => format!("(define-control-program main () {form})"),
            Position::Declaration => format!("(define-control-program main () (declare {form}))"),
            Position::Number => format!("(define-control-program main () (delay {form}))"),
            // What else stands in these places is told as something else.
            Position::Team
            | Position::Duration
            | Position::Constraint
            | Position::Event
            | Position::Condition => String::new(),
        };
        assert!(!is_unknown(&around(&format!("({name} 1 1)"))), "{name}");
        let other = around(&format!("({name}-other 1 1)"));
        assert!(other.is_empty() || is_unknown(&other), "{name}-other");
    }
    assert_eq!(BTreeSet::from(DEFINITIONS), Position::Definition.names().collect());
    assert!(UNITS.iter().all(|(unit, _)| Position::Number.has(unit)));
}

#[test]
fn every_keyword_is_one_of_its_form() {
    let knows = |keywords: &[Keyword], around: &dyn Fn(&str) -> String| {
        for Keyword { name, about, .. } in keywords {
            assert!(!about.is_empty() && !is_unknown(&around(name)), "{}", around(name));
        }
        assert!(is_unknown(&around("other")), "{}", around("other"));
    };
    knows(SLOT, &|keyword| format!("(defclass a () ((b :{keyword} t)))"));
    for Word { name, keywords, .. } in WORDS.iter().filter(|word| !word.keywords.is_empty()) {
        knows(keywords, &|keyword| match *name {
            "defpackage" => format!("(defpackage #:a (:{keyword} #:cl))"),
            "sequence" | "parallel" => format!("(define-control-program main () ({name} (:{keyword} t)))"),
            "duration" => format!(
                "(define-control-program main () (declare (primitive) (duration (simple) :{keyword} t)))"
            ),
            "simple" => format!(
                "(define-control-program main () (declare (primitive) (duration (simple :{keyword} 5))))"
            ),
            "simple-temporal" => format!(
                "(define-control-program main () (with-temporal-constraint (simple-temporal :{keyword} 5) (delay 5)))"
            ),
            "link" => format!("(define-team crew (agent a) (agent b) (link a b :{keyword} 5))"),
            name => panic!("say here how the keywords of `{name}` are written"),
        });
    }
}

#[test]
fn a_form_is_written_and_filled_in_as_its_parts_say() {
    let between = word("BETWEEN").unwrap();
    assert_eq!(between.shape(), "(between event event (simple-temporal ...))");
    assert_eq!(word("+").unwrap().snippet(), "+ ${0}");
    assert_eq!((between.part(0), between.part(9)), (Some(between.parts[0].1), Some(between.parts[2].1)));
    assert!(word("nothing").is_none());
}

#[test]
fn the_editors_have_every_word_and_the_forms_from_here() {
    let operators =
        |star: &str| -> Vec<String> { Position::Body.names().map(|name| name.replace('*', star)).collect() };
    let has_body = |word: &&Word| matches!(word.layout, Layout::Hanging(_) | Layout::Block(_));
    let bodies: Vec<String> = WORDS.iter().filter(has_body).map(|word| word.name.to_string()).collect();
    // There, a label is coloured with its name, by a pattern of its own.
    let unnamed: Vec<String> = operators(r"\\*").into_iter().filter(|name| name != "label").collect();
    held(GRAMMARS[0], "|", ")", &unnamed);
    held(GRAMMARS[1], r"\|", r"\)", &operators(r"\*"));
    held(GRAMMARS[2], "\" \"", "\")", &operators("*"));
    held("vscode/src/indent.js", "\",\n  \"", "\",\n]", &bodies);
    held("neovim/indent/rmpl.vim", "', '", "']", &bodies);
    held("emacs/rmpl-mode.el", " ", ")", &bodies);
    // In a pattern, an optional `s` and the `*` of `let*` are marks of the pattern.
    let stem = |word: &'static str| word.trim_end_matches(['*', 's']);
    let letters = WORDS.iter().filter(|word| word.name.starts_with(char::is_alphabetic));
    let words: BTreeSet<&str> = letters.map(|word| stem(word.name)).collect();
    for grammar in GRAMMARS {
        let (_, text) = editor_file(grammar);
        let known: BTreeSet<&str> = text
            .split(|c: char| !(c.is_alphanumeric() || c == '-'))
            .map(|word| word.trim_end_matches('s'))
            .collect();
        let missing: Vec<&&str> = words.iter().filter(|word| !known.contains(*word)).collect();
        assert!(missing.is_empty(), "{grammar} does not know {missing:?}");
    }
}

/// Holds the list in a file of an editor that begins with the first two of these words to them.
fn held(file: &str, separator: &str, end: &str, words: &[String]) {
    let (path, text) = editor_file(file);
    let start =
        text.find(&words[..2].join(separator)).unwrap_or_else(|| panic!("the list is gone from {file}"));
    let length = text[start..].find(end).unwrap();
    let wanted = words.join(separator);
    if text[start..start + length] != wanted && std::env::var("INSTA_UPDATE").as_deref() == Ok("always") {
        std::fs::write(path, [&text[..start], &wanted, &text[start + length..]].concat()).unwrap();
        return;
    }
    assert_eq!(&text[start..start + length], wanted, "{file} is behind; run with INSTA_UPDATE=always");
}

fn editor_file(name: &str) -> (std::path::PathBuf, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../editors").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    (path, text)
}
