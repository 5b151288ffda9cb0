//! `kirk fmt`: lays out RMPL files as everybody does.

use std::io;

use kirk_compiler::{Diagnostic, Source, Span, format};

use crate::args::{Common, Fmt};
use crate::input::{Unreadable, is_network, shown, text};
use crate::output::{Status, print, print_line};
use crate::replace::replace;
use crate::report::Reporter;
use crate::wording::Problem;

pub(crate) fn fmt(arguments: &Fmt, common: &Common) -> io::Result<Status> {
    let mut worst = Status::Yes;
    for file in &arguments.files {
        worst = worst.max(fmt_one(file, arguments.check, common)?);
    }
    Ok(worst)
}

/// A file that cannot be read is left as it is.
fn fmt_one(file: &str, check: bool, common: &Common) -> io::Result<Status> {
    let name = shown(file);
    let refuse = |text: &str, diagnostics: &[Diagnostic]| {
        Reporter::new(&[Source::new(name, text)]).show(diagnostics, common)?;
        Ok(Status::Wrong)
    };
    let before = match text(file) {
        Ok(text) => text,
        Err(unreadable) => {
            let Unreadable { text, diagnostic } = *unreadable;
            return refuse(&text, &[diagnostic]);
        }
    };
    if is_network(file, &before) {
        return refuse("", &[Problem::NetworkToLayOut(name).at(Span::default())]);
    }
    let after = match format(&before) {
        Ok(after) => after,
        Err(diagnostics) => return refuse(&before, &diagnostics),
    };
    match (check, file) {
        (true, _) if after == before => {}
        (true, _) => {
            print_line(name)?;
            return Ok(Status::No);
        }
        (false, "-") => print(&after)?,
        (false, _) if after == before => {}
        (false, _) => {
            if let Err(error) = replace(file, &after) {
                return refuse("", &[Problem::NotWritten(file, error).at(Span::default())]);
            }
        }
    }
    Ok(Status::Yes)
}
