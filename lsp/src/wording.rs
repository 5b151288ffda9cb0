//! The words of what is wrong with the files a document names. Those of programs are the compiler's.

use kirk_compiler::{Code, Diagnostic, Span};

/// What is wrong with a file, and what is known about it.
pub(crate) enum Problem<'a> {
    /// The file of this name cannot be read.
    Unreadable(&'a str),
    /// It has an error, of which this is the first: nothing is judged before it is put right.
    Broken(&'a Diagnostic),
}

impl Problem<'_> {
    /// What is said about it where the file is named.
    pub(crate) fn at(self, place: Span) -> Diagnostic {
        match self {
            Problem::Unreadable(name) => {
                Diagnostic::error(Code::CannotRead, place, format!("`{name}` cannot be read"))
                    .primary("named here as one program with this file")
                    .help("The name is relative to the folder of this file.")
            }
            Problem::Broken(error) => {
                Diagnostic::warning(error.code, place, format!("in this file, {}", error.message))
                    .primary("there is no verdict before it is put right")
                    .label(error.span, error.primary.clone())
            }
        }
    }
}
