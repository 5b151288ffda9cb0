//! The journal on disk: locked, only ever added to, and synced when it matters.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use kirk_runtime::journal::{Journal, Line, read, write};

/// A journal that is being written.
#[derive(Debug)]
pub(crate) struct JournalFile {
    file: File,
    checksum: u32,
    buffer: String,
}

impl JournalFile {
    /// Begins a new journal.
    ///
    /// # Errors
    /// A sentence: a file with something in it is never overwritten.
    pub(crate) fn create(path: &Path, start: &Line) -> Result<JournalFile, String> {
        let cannot =
            |error: std::io::Error| format!("cannot write the journal `{}`: {error}", path.display());
        let file = OpenOptions::new().create(true).append(true).read(true).open(path).map_err(cannot)?;
        lock(&file, path)?;
        if file.metadata().map_err(cannot)?.len() > 0 {
            return Err(format!(
                "`{0}` is there already, and kirk does not overwrite what may be a journal; go on with it by `kirk resume {0}`, \
                 or name another file",
                path.display()
            ));
        }
        let mut journal = JournalFile { file, checksum: 0, buffer: String::new() };
        journal.push(start);
        journal.commit(true).map_err(cannot)?;
        // The name of the file is to survive as well.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
        Ok(journal)
    }

    /// Opens a journal to go on with it; what is torn at its end is cut off.
    ///
    /// # Errors
    /// A sentence.
    pub(crate) fn open(path: &Path) -> Result<(JournalFile, Journal), String> {
        let cannot = |error: std::io::Error| format!("cannot go on with `{}`: {error}", path.display());
        let mut file = OpenOptions::new().append(true).read(true).open(path).map_err(cannot)?;
        lock(&file, path)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(cannot)?;
        let journal = read(&bytes).map_err(|bad| format!("`{}`, {bad}", path.display()))?;
        if journal.torn > 0 {
            file.set_len(journal.length as u64).map_err(cannot)?;
            file.seek(SeekFrom::End(0)).map_err(cannot)?;
            file.sync_data().map_err(cannot)?;
        }
        Ok((JournalFile { file, checksum: journal.checksum, buffer: String::new() }, journal))
    }

    /// Adds a line, which is written with the next commit.
    pub(crate) fn push(&mut self, line: &Line) {
        let (text, checksum) = write(line, self.checksum);
        self.checksum = checksum;
        self.buffer.push_str(&text);
    }

    /// Writes what was added; with `sync` it is on the disk when this returns.
    pub(crate) fn commit(&mut self, sync: bool) -> std::io::Result<()> {
        if !self.buffer.is_empty() {
            self.file.write_all(self.buffer.as_bytes())?;
            self.buffer.clear();
        }
        if sync { self.file.sync_data() } else { Ok(()) }
    }
}

fn lock(file: &File, path: &Path) -> Result<(), String> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            Err(format!("`{}` is in use: another kirk is executing this mission", path.display()))
        }
        // Some file systems cannot lock; that is no reason not to execute.
        Err(TryLockError::Error(_)) => Ok(()),
    }
}
