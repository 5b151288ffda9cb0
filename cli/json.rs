//! JSON documents on standard output: one per line.

use std::io;

use serde::Serialize;

/// A document as one line, with the line end.
pub(crate) fn line(document: &impl Serialize) -> io::Result<String> {
    let mut text = serde_json::to_string(document).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}
