//! Every place of every name is known: with another name in all of them, a program means what it meant.

#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests read programs and may panic")]

mod editor;

use std::path::Path;

use kirk_compiler::{Options, Source, compile};
use kirk_lsp::{edited, rename};

/// What a program means but for its names: what is said of it, and its network; `None` if there are errors.
fn meaning(text: &str) -> Option<String> {
    let compiled = compile(&[Source::new("", text)], &Options::default());
    let codes: Vec<String> = compiled.diagnostics.iter().map(|it| it.code.to_string()).collect();
    let network = compiled.lowered?.network;
    Some(format!("{codes:?} {:?} {:?}", network.requirements(), network.contingents()))
}

#[test]
fn with_another_name_wherever_one_stands_every_program_means_the_same() {
    let mut renamed = 0;
    for folder in ["examples/rmpl", "tests/rmpl/good", "tests/rmpl/bad"] {
        for file in std::fs::read_dir(Path::new("..").join(folder)).unwrap() {
            let path = file.unwrap().path();
            let Ok(text) = std::fs::read_to_string(&path) else { continue };
            let view = editor::view(&text);
            let Some(before) = meaning(&text) else { continue };
            for symbol in &view.analysis.symbols.symbols {
                let case = format!("{}: {}", path.display(), symbol.name);
                match rename(&view.analysis, symbol.places[0].span.start, "other-zz") {
                    Ok(edits) => {
                        assert_eq!(meaning(&edited(&text, &edits)).as_ref(), Some(&before), "{case}");
                        renamed += 1;
                    }
                    Err(why) => {
                        let known = ["starts with `main`", "is also named by", "which is meant depends"];
                        assert!(known.iter().any(|known| why.contains(known)), "{case}: {why}");
                    }
                }
            }
        }
    }
    assert!(renamed > 150, "only {renamed} names");
}
