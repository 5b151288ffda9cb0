//! Any text is read, and laid out or refused; a second layout changes nothing.
#![no_main]

use kirk_compiler::Problems;
use kirk_compiler::{Source, format, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let mut problems = Problems::default();
    let forms = read::read(&Source::new("fuzz", text), 0, &mut problems);
    for diagnostic in problems.into_sorted() {
        assert!(text.get(diagnostic.span.start as usize..diagnostic.span.end as usize).is_some());
    }
    if let Ok(once) = format(text) {
        assert_eq!(format(&once).as_ref(), Ok(&once));
        let mut problems = Problems::default();
        assert_eq!(read::read(&Source::new("fuzz", once), 0, &mut problems).len(), forms.len());
    }
});
