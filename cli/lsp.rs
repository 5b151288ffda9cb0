//! `kirk lsp`: the language server on standard input and output.

use std::fs;
use std::io;
use std::path::Path;

use crate::input::LARGEST_PROGRAM;
use crate::output::Status;

/// Serves one editor; 0 if it took leave as the protocol wants it, else 1.
pub(crate) fn lsp() -> Status {
    match kirk_lsp::serve(io::BufReader::new(io::stdin()), io::stdout(), Box::new(program)) {
        true => Status::Yes,
        false => Status::No,
    }
}

/// A program that is not open in the editor, if it is one.
fn program(path: &Path) -> Option<String> {
    let about = fs::metadata(path).ok()?;
    let is_program = about.is_file() && about.len() <= LARGEST_PROGRAM;
    if is_program { fs::read_to_string(path).ok() } else { None }
}
