//! `kirk fmt`: lays out RMPL files as everybody does.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, fchown};
use std::path::Path;

use kirk_compiler::{Code, Diagnostic, Source, Span, format};

use crate::args::{Common, Fmt};
use crate::input::{Unreadable, is_network, text};
use crate::output::{Status, print, print_line};
use crate::report::Reporter;

pub(crate) fn fmt(arguments: &Fmt, common: &Common) -> io::Result<Status> {
    let mut worst = Status::Yes;
    for file in &arguments.files {
        worst = worst.max(fmt_one(file, arguments.check, common)?);
    }
    Ok(worst)
}

/// A file that cannot be read is left as it is.
fn fmt_one(file: &str, check: bool, common: &Common) -> io::Result<Status> {
    let name = if file == "-" { "<stdin>" } else { file };
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
        let message = format!("`{name}` is a network, and no program to lay out");
        return refuse("", &[Diagnostic::error(Code::CannotRead, Span::default(), message)]);
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
                let message = format!("cannot write `{file}`, which is as it was: {error}");
                return refuse("", &[Diagnostic::error(Code::CannotRead, Span::default(), message)]);
            }
        }
    }
    Ok(Status::Yes)
}

/// Puts a text in the place of that of a file: it is written beside the file and then takes its name, so that whatever happens
/// (a full disk, a crash) there is one or the other, and never half of it. A link stays, and leads to the new text.
fn replace(file: &str, text: &str) -> io::Result<()> {
    let path = fs::canonicalize(file)?;
    let about = fs::metadata(&path)?;
    if !about.is_file() {
        // There is nothing to keep in a pipe.
        return fs::write(&path, text);
    }
    let folder = path.parent().unwrap_or(Path::new("/"));
    let mut beside = tempfile::Builder::new().prefix(".kirk-fmt-").tempfile_in(folder)?;
    beside.write_all(text.as_bytes())?;
    // Only root can give a file away; the permissions come after, since giving it away takes some of them.
    let _ = fchown(beside.as_file(), Some(about.uid()), Some(about.gid()));
    beside.as_file().set_permissions(about.permissions())?;
    beside.as_file().sync_all()?;
    beside.persist(&path).map_err(|error| error.error)?;
    Ok(())
}
