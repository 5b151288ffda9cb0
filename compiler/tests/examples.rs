//! Every file in `examples/rmpl` compiles, and every stage of it is as it was: a new file is a case by existing.
#![allow(clippy::disallowed_methods, reason = "tests read the examples")]

mod common;

use kirk_compiler::{Severity, to_sexpr};

#[test]
fn every_stage_of_every_example() {
    let sources = common::sources("examples/rmpl");
    assert!(sources.len() >= 12, "the examples are gone: {sources:?}");
    for (name, text) in sources {
        let compiled = common::compile_with(&text, &common::options_in(&text));
        let said = common::diagnostics(&text, &compiled.diagnostics);
        assert!(compiled.diagnostics.iter().all(|d| d.severity != Severity::Error), "{name}:\n{said}");
        let (episodes, lowered) =
            (compiled.episodes.expect("episodes"), compiled.lowered.expect("a network"));
        assert_eq!(lowered.origins.requirements.len(), lowered.network.requirements().len());
        assert_eq!(lowered.origins.contingents.len(), lowered.network.contingents().len());
        let result = format!(
            "{text}\n--- ast\n{}\n--- episodes\n{}\n--- network\n{}--- diagnostics\n{said}",
            to_sexpr(&compiled.ast).unwrap(),
            to_sexpr(&episodes).unwrap(),
            common::network(&lowered),
        );
        insta::with_settings!({prepend_module_to_snapshot => false, omit_expression => true}, {
            insta::assert_snapshot!(name, result);
        });
    }
}

#[test]
fn the_examples_can_be_executed_except_the_one_that_explains_why_not() {
    for (name, text) in common::sources("examples/rmpl") {
        let compiled = common::compile_with(&text, &common::options_in(&text));
        let lowered = compiled.lowered.expect("a network");
        let verdict = kirk_network::check(&lowered.network).unwrap();
        let expected = name != "too-late";
        assert_eq!(matches!(verdict, kirk_network::Verdict::Controllable), expected, "{name}: {verdict:?}");
    }
}
