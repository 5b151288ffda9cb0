//! The editors know every word of the language.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests read files and may panic")]

use std::collections::BTreeSet;
use std::path::Path;

use kirk_compiler::words::{DECLARATIONS, DEFINITIONS, OPERATORS, UNITS};

const GRAMMARS: [&str; 3] =
    ["vscode/syntaxes/rmpl.tmLanguage.json", "neovim/syntax/rmpl.vim", "emacs/rmpl-mode.el"];

#[test]
fn the_grammars_of_the_editors_have_every_word() {
    // In a pattern, `let*` and an optional `s` are marks of the pattern.
    let stem = |word: &'static str| word.trim_end_matches(['*', 's']);
    let units = UNITS.map(|(unit, _)| unit);
    let words = DEFINITIONS.iter().chain(&OPERATORS).chain(&DECLARATIONS).chain(&units);
    let words: BTreeSet<&str> = words.map(|word| stem(word)).collect();
    for grammar in GRAMMARS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../editors").join(grammar);
        let text = std::fs::read_to_string(path).unwrap();
        let known: BTreeSet<&str> = text
            .split(|c: char| !(c.is_alphanumeric() || c == '-'))
            .map(|word| word.trim_end_matches('s'))
            .collect();
        let missing: Vec<&&str> = words.iter().filter(|word| !known.contains(*word)).collect();
        assert!(missing.is_empty(), "{grammar} does not know {missing:?}");
    }
}
