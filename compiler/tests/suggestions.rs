//! What a message suggests puts the problem right: every suggestion on every bad program, made.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::collections::BTreeMap;

use kirk_compiler::{Code, Diagnostic, Severity};

/// Problems that hide another one, which is told once they are put right: a name misspelt twice, programs that do
/// nothing, two missions that are one text then.
const UNCOVERED: [(&str, &str); 4] = [
    ("K0307-imported", "the package `tools` has no `wayt`"),
    ("K0205-wrong-shape", "the plain name of the program was expected, not a string"),
    ("K0108-prompt-between-missions", "this is what was typed at a shell prompt, not RMPL"),
    ("K0205-wrong-shape", "`(simple ...)` was expected, not a list"),
];

/// How often each message is given.
fn counted(diagnostics: &[Diagnostic]) -> BTreeMap<(Code, &str), usize> {
    let mut counts = BTreeMap::new();
    for d in diagnostics {
        *counts.entry((d.code, d.message.as_str())).or_default() += 1;
    }
    counts
}

/// How many errors there are, those that are not shown included.
fn errors(diagnostics: &[Diagnostic]) -> usize {
    let counted = |d: &Diagnostic| match d.code {
        Code::TooManyProblems => d.message.split(' ').find_map(|word| word.parse().ok()).unwrap(),
        _ => usize::from(d.severity == Severity::Error),
    };
    diagnostics.iter().map(counted).sum()
}

#[test]
fn every_suggestion_puts_its_problem_right_and_breaks_nothing() {
    let mut failed = String::new();
    for (name, text) in common::sources("tests/rmpl/bad") {
        let options = common::options_in(&text);
        let found = common::compile_with(&text, &options).diagnostics;
        let before = counted(&found);
        // Of those that are like one another, some are enough.
        for d in found.iter().take(50) {
            for suggestion in &d.suggestions {
                let new = common::applied(&text, suggestion);
                let after = common::compile_with(&new, &options).diagnostics;
                let left = counted(&after).get(&(d.code, d.message.as_str())).copied().unwrap_or(0);
                let remaining = errors(&after);
                let more = after.into_iter().filter(|d| !before.contains_key(&(d.code, d.message.as_str())));
                let said = common::diagnostics(&new, &more.collect::<Vec<_>>());
                let title = format!("{name}: {}: {}", d.message, suggestion.title);
                if left >= before[&(d.code, d.message.as_str())] {
                    failed.push_str(&format!("* {title}\nis still there:\n{new}\n{said}\n"));
                } else if UNCOVERED.contains(&(name.as_str(), d.message.as_str())) {
                    assert!(remaining >= errors(&found), "{title}: nothing is uncovered");
                } else if remaining >= errors(&found) && d.severity == Severity::Error {
                    failed.push_str(&format!("* {title}\nbreaks something:\n{new}\n{said}\n"));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{failed}");
}
