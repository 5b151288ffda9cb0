//! The journal on disk: locked, only ever added to, and synced when it matters.
//!
//! What is written survives the process; what is synced survives the machine. Writing takes microseconds and is done by the
//! loop, syncing takes milliseconds and is done beside it: a ticket says when.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::mpsc::{Sender, channel};

use kirk_runtime::journal::{Journal, Line, read, write};

use crate::desk::Desk;

/// A journal that is being written.
#[derive(Debug)]
pub(crate) struct JournalFile {
    file: File,
    checksum: u32,
    buffer: String,
    syncer: Option<Sender<Ticket>>,
    /// The last that was asked for.
    ticket: Ticket,
}

/// Stands for everything that was written before it was asked for. Later tickets are greater.
pub(crate) type Ticket = u64;

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
        let mut journal = JournalFile::of(file, 0);
        journal.push(start);
        journal.write().and_then(|()| journal.file.sync_data()).map_err(cannot)?;
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
        Ok((JournalFile::of(file, journal.checksum), journal))
    }

    fn of(file: File, checksum: u32) -> JournalFile {
        JournalFile { file, checksum, buffer: String::new(), syncer: None, ticket: 0 }
    }

    /// From now on tickets can be asked for; the desk hears of it when what they stand for is on the disk.
    pub(crate) fn begin_syncing(&mut self, desk: Desk) -> Result<(), String> {
        let file =
            self.file.try_clone().map_err(|error| format!("the journal cannot be opened twice: {error}"))?;
        let (sender, tickets) = channel::<Ticket>();
        std::thread::spawn(move || {
            while let Ok(ticket) = tickets.recv() {
                let ticket = tickets.try_iter().last().unwrap_or(ticket);
                desk.synced(ticket, file.sync_data());
            }
        });
        self.syncer = Some(sender);
        Ok(())
    }

    /// Adds a line, which is written with the next `write`.
    pub(crate) fn push(&mut self, line: &Line) {
        let (text, checksum) = write(line, self.checksum);
        self.checksum = checksum;
        self.buffer.push_str(&text);
    }

    /// Writes what was added.
    pub(crate) fn write(&mut self) -> std::io::Result<()> {
        if !self.buffer.is_empty() {
            self.file.write_all(self.buffer.as_bytes())?;
            self.buffer.clear();
        }
        Ok(())
    }

    /// Has everything that was written synced.
    pub(crate) fn sync(&mut self) -> Ticket {
        self.ticket += 1;
        if let Some(syncer) = &self.syncer {
            // The thread lives as long as this.
            let _ = syncer.send(self.ticket);
        }
        self.ticket
    }

    /// Writes and syncs all there is, and waits for it.
    pub(crate) fn finish(mut self) -> std::io::Result<()> {
        self.write()?;
        self.file.sync_data()
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
