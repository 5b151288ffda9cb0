//! What the README shows is what the program prints.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, stderr, stdout};

#[test]
fn the_commands_of_the_readme_print_what_it_says() {
    let readme = std::fs::read_to_string("README.md").unwrap();
    let mut tried = 0;
    for block in readme.split("```console\n").skip(1) {
        let block = block.split("```").next().unwrap();
        let (command, shown) = block.split_once('\n').unwrap();
        let Some(arguments) = command.strip_prefix("$ kirk ") else { continue };
        let output = kirk(&arguments.split_whitespace().collect::<Vec<_>>());
        let printed = stderr(&output) + &stdout(&output);
        assert_eq!(printed.trim_end(), shown.trim_end(), "{command}");
        tried += 1;
    }
    assert_eq!(tried, 4);
}
