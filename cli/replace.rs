//! A new text in the place of that of a file.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, fchown};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A text that has been written beside a file and is to take its name, so that whatever happens (a full disk, a crash) there is one
/// or the other, and never half of it. A link stays, and leads to the new text.
pub(crate) struct Replacement {
    beside: NamedTempFile,
    path: PathBuf,
}

impl Replacement {
    /// Writes the text beside the file.
    pub(crate) fn prepared(file: &str, text: &str) -> io::Result<Replacement> {
        let path = fs::canonicalize(file)?;
        let about = fs::metadata(&path)?;
        let folder = path.parent().unwrap_or(Path::new("/"));
        let mut beside = tempfile::Builder::new().prefix(".kirk-").tempfile_in(folder)?;
        beside.write_all(text.as_bytes())?;
        // Only root can give a file away; the permissions come after, since giving it away takes some of them.
        let _ = fchown(beside.as_file(), Some(about.uid()), Some(about.gid()));
        beside.as_file().set_permissions(about.permissions())?;
        beside.as_file().sync_all()?;
        Ok(Replacement { beside, path })
    }

    /// Puts it in the place of the file.
    pub(crate) fn put(self) -> io::Result<()> {
        self.beside.persist(&self.path).map_err(|error| error.error)?;
        Ok(())
    }
}

/// Puts a text in the place of that of a file.
pub(crate) fn replace(file: &str, text: &str) -> io::Result<()> {
    if !fs::metadata(file)?.is_file() {
        // There is nothing to keep in a pipe.
        return fs::write(file, text);
    }
    Replacement::prepared(file, text)?.put()
}
