//! `kirk lsp`: the language server on standard input and output.

use std::io;

use crate::output::Status;

/// Serves one editor; 0 if it took leave as the protocol wants it, else 1.
pub(crate) fn lsp() -> Status {
    match kirk_lsp::serve(io::BufReader::new(io::stdin()), io::stdout()) {
        true => Status::Yes,
        false => Status::No,
    }
}
