//! Any text is read as a network or refused; what is read can be decided and written, and reads back.
#![no_main]

use kirk_network::{check, json, graphml as format};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match format::read(text) {
        Ok(network) => {
            let _ = check(&network);
            let again = json::read(&json::write(&network)).expect("what was written can be read");
            assert_eq!(again.requirements(), network.requirements());
            assert_eq!(again.contingents(), network.contingents());
        }
        Err(problems) => {
            assert!(!problems.is_empty());
            assert!(problems.iter().all(|problem| text.is_char_boundary(problem.offset)));
        }
    }
});
