//! What leaves the program: standard output, standard error, the exit status.

use std::io::{self, Write};

use crate::args::Color;
use crate::foreign::{one_line, visible};

/// The exit status of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(crate) enum Status {
    /// Controllable, completed, verified.
    Yes = 0,
    /// Not controllable, failed, violated.
    No = 1,
    /// The input or the command line is wrong.
    Wrong = 2,
}

/// Prints a text to standard output as it is.
pub(crate) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Prints a text to standard output, or writes it to a file if one is named.
pub(crate) fn deliver(text: &str, file: Option<&str>) -> io::Result<Status> {
    match file.map(|file| (file, std::fs::write(file, text))) {
        None => print(text)?,
        Some((_, Ok(()))) => {}
        Some((file, Err(error))) => {
            complain(&format!("cannot write `{file}`: {error}"));
            return Ok(Status::Wrong);
        }
    }
    Ok(Status::Yes)
}

/// Prints a line for people to standard output.
pub(crate) fn print_line(text: &str) -> io::Result<()> {
    print(&format!("{}\n", one_line(text)))
}

/// Prints a text for people to standard error.
pub(crate) fn eprint(text: &str) -> io::Result<()> {
    io::stderr().lock().write_all(visible(text).as_bytes())
}

/// Prints a message about the command line to standard error.
pub(crate) fn complain(message: &str) {
    // If standard error is closed there is nobody to tell.
    let _ = writeln!(io::stderr().lock(), "error: {}", visible(message));
}

/// Prints a remark that is not part of what was asked for to standard error.
pub(crate) fn remark(message: &str) {
    // If standard error is closed there is nobody to tell.
    let _ = writeln!(io::stderr().lock(), "{}", visible(message));
}

/// True if a terminal is to show colours: as asked for, or unless `NO_COLOR` asks for none.
pub(crate) fn colors(asked: Color) -> bool {
    match asked {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()),
    }
}
