//! The examples in `docs/LANGUAGE.md` are programs: each compiles without an error, by itself or inside a mission.

mod common;

use kirk_compiler::Severity;

#[test]
#[expect(clippy::disallowed_methods, reason = "the test reads the document")]
fn the_examples_of_the_language_compile() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/LANGUAGE.md");
    let text = std::fs::read_to_string(path).unwrap();
    let examples: Vec<&str> =
        text.split("```lisp\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 6, "the examples are gone");
    for example in examples {
        let mission = if example.contains("name (parameter...)") {
            continue;
        } else if example.starts_with("(sequence") {
            let primitives = "(define-control-program downlink () (declare (primitive)))\n(define-control-program sync () (declare (primitive)))";
            format!("{primitives}\n(define-control-program main ()\n{example})")
        } else if example.contains("main ()") {
            example.to_string()
        } else {
            format!("{example}\n(define-control-program main () (declare (primitive)))")
        };
        let options = kirk_compiler::Options {
            package: mission.contains("#:scenario1").then(|| "scenario1".to_string()),
            ..Default::default()
        };
        let compiled = common::compile_with(&mission, &options);
        let said = common::diagnostics(&mission, &compiled.diagnostics);
        assert!(compiled.diagnostics.iter().all(|d| d.severity != Severity::Error), "{mission}\n{said}");
    }
}
