//! Any text is read as the record of an execution or refused; what is read can be verified against a mission.
#![no_main]

use std::sync::LazyLock;

use kirk_compiler::{Options, Source, compile};
use kirk_network::Network;
use kirk_runtime::{Execution, verify};
use libfuzzer_sys::fuzz_target;

static MISSION: LazyLock<Network> = LazyLock::new(|| {
    let text = include_str!("../../examples/rmpl/robot.rmpl");
    compile(&[Source::new("robot.rmpl", text)], &Options::default()).lowered.expect("a network").network
});

fuzz_target!(|text: &str| {
    if let Ok(execution) = serde_json::from_str::<Execution>(text) {
        verify(&MISSION, &execution);
    }
});
