//! Any text goes the whole way of `kirk check`: compiled, decided, and a conflict explained in the source.
#![no_main]

use kirk_compiler::{Explain, Options, Severity, Source, compile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let sources = [Source::new("fuzz", text)];
    let compiled = compile(&sources, &Options::default());
    let errors = compiled.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
    assert_eq!(compiled.lowered.is_none(), errors);
    for diagnostic in &compiled.diagnostics {
        let spans = diagnostic.labels.iter().map(|label| label.span).chain([diagnostic.span]);
        for span in spans {
            assert!(text.get(span.start as usize..span.end as usize).is_some(), "{diagnostic:?}");
        }
    }
    if let Some(plan) = compiled.lowered {
        let _ = Explain::of(&plan, &sources).all();
    }
});
