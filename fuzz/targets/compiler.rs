//! Any text goes the whole way of `kirk check`: compiled, decided, and a conflict explained in the source.
#![no_main]

use kirk_compiler::{Options, Severity, Source, compile, explain_conflict};
use kirk_network::{Verdict, check};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let compiled = compile(&[Source::new("fuzz", text)], &Options::default());
    let errors = compiled.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
    assert_eq!(compiled.lowered.is_none(), errors);
    for diagnostic in &compiled.diagnostics {
        let spans = diagnostic.labels.iter().map(|label| label.span).chain([diagnostic.span]);
        for span in spans {
            assert!(text.get(span.start as usize..span.end as usize).is_some(), "{diagnostic:?}");
        }
    }
    if let Some(lowered) = compiled.lowered
        && let Ok(Verdict::Uncontrollable(conflict)) = check(&lowered.network)
    {
        explain_conflict(&conflict, &lowered.network, &lowered.origins, lowered.entry);
    }
});
