//! The files that a document names as one program with it: where they are, and what is in them.

use std::path::{Component, Path, PathBuf};

use kirk_compiler::{Companion, Diagnostic, Source, companions};

use crate::analysis::Companions;
use crate::wording::Problem;

/// Reads what is not open in the editor; `None` if it cannot be read.
pub type ReadFile = Box<dyn Fn(&Path) -> Option<String> + Send>;

/// What a document at an address names, and what there is to say about that. `text_of` knows the text of a file.
pub(crate) fn gather(
    uri: &str,
    text: &str,
    text_of: impl Fn(&Path) -> Option<String>,
) -> (Companions, Vec<Diagnostic>) {
    let named = companions(text);
    let own = path_of(uri);
    let (Some(folder), false) = (own.as_deref().and_then(Path::parent), named.is_empty()) else {
        return (Companions::default(), Vec::new());
    };
    let mut found = Companions { others: Vec::new(), places: Vec::new(), order: Vec::new() };
    let mut missing = Vec::new();
    for Companion { name, span } in named {
        let path = plain(&folder.join(&name));
        if Some(&path) == own.as_ref() {
            found.order.push(0);
        } else if let Some(text) = text_of(&path) {
            found.others.push(Source::new(address(&path), text));
            found.places.push(span);
            found.order.push(found.others.len());
        } else {
            missing.push(Problem::Unreadable(&name).at(span));
        }
    }
    if !found.order.contains(&0) {
        found.order.push(0);
    }
    (found, missing)
}

/// The file at an address, if it is one.
pub(crate) fn path_of(uri: &str) -> Option<PathBuf> {
    let encoded = uri.strip_prefix("file://")?;
    let mut bytes = Vec::with_capacity(encoded.len());
    let mut rest = encoded.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digit = |byte: Option<u8>| char::from(byte?).to_digit(16);
        let (high, low) = (digit(rest.next())?, digit(rest.next())?);
        bytes.push((high * 16 + low) as u8);
    }
    Some(plain(Path::new(&String::from_utf8(bytes).ok()?)))
}

/// The address of a file.
fn address(path: &Path) -> String {
    let mut address = String::from("file://");
    for byte in path.to_string_lossy().bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                address.push(char::from(byte));
            }
            _ => address.push_str(&format!("%{byte:02X}")),
        }
    }
    address
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_and_paths_lead_to_one_another() {
        for (uri, path) in [("file:///a/b.rmpl", "/a/b.rmpl"), ("file:///%C3%B6/x%20y.rmpl", "/ö/x y.rmpl")]
        {
            assert_eq!(path_of(uri), Some(PathBuf::from(path)));
            assert_eq!(address(Path::new(path)), uri);
        }
        assert_eq!(path_of("file:///a/../b/./c"), Some(PathBuf::from("/b/c")));
        assert_eq!(path_of("untitled:1"), None);
        assert_eq!(path_of("file:///%zz"), None);
    }

    #[test]
    fn files_follow_one_another_as_they_are_named() {
        let text = ";;; kirk: files ../lib.rmpl m.rmpl gone.rmpl\n";
        let known = |path: &Path| (path == Path::new("/lib.rmpl")).then(|| "(a)".to_string());
        let (found, missing) = gather("file:///d/m.rmpl", text, known);
        assert_eq!(found.order, [1, 0]);
        assert_eq!(found.others[0].name, "file:///lib.rmpl");
        assert!(missing.len() == 1 && missing[0].message.contains("`gone.rmpl`"), "{missing:?}");
        assert_eq!(gather("file:///d/m.rmpl", "(a)", known).0, Companions::default());
    }
}
