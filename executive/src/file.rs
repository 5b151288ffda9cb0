//! The journal on disk: locked, only ever added to, and synced when it matters.
//!
//! What is written survives the process; what is synced survives the machine. Writing takes microseconds and is done by the
//! loop, syncing takes milliseconds and is done beside it: a ticket says when. A journal that is not as we have written it
//! any more, since somebody deleted, replaced or changed it, is lost, and that is noticed.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};

use kirk_runtime::journal::{Journal, Line, read, write};

use crate::desk::{Desk, Ticket};
use crate::lock::{Held, hold, lock};

/// A journal that is being written.
#[derive(Debug)]
pub(crate) struct JournalFile {
    file: File,
    /// How many bytes are in it.
    length: u64,
    /// Its file system counts the names of a file.
    counts_names: bool,
    checksum: u32,
    buffer: String,
    syncer: Option<Sender<Ticket>>,
    /// The last that was asked for.
    ticket: Ticket,
    _held: Held,
}

/// Journals are written by machines, but a robot does not do more in its life.
const LARGEST: u64 = 1 << 30;

impl JournalFile {
    /// Begins a new journal of a run.
    ///
    /// # Errors
    /// A sentence: a file with something in it is never overwritten.
    pub(crate) fn create(path: &Path, run: &str, start: &Line) -> Result<JournalFile, String> {
        let cannot =
            |error: std::io::Error| format!("cannot write the journal `{}`: {error}", path.display());
        let file = OpenOptions::new().create(true).append(true).read(true).open(path).map_err(cannot)?;
        lock(&file, path)?;
        let about = file.metadata().map_err(cannot)?;
        check_kind(&about, path)?;
        if about.len() > 0 {
            return Err(format!(
                "`{0}` is there already, and kirk does not overwrite what may be a journal; go on with it by `kirk resume {0}`, \
                 or name another file",
                path.display()
            ));
        }
        let mut journal = JournalFile::of(file, &about, 0, 0, hold(run)?);
        journal.push(start);
        journal
            .write()
            .and_then(|()| journal.file.sync_data().map_err(unwritten))
            .map_err(|lost| format!("cannot begin the journal `{}`: {lost}", path.display()))?;
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
        check_kind(&file.metadata().map_err(cannot)?, path)?;
        lock(&file, path)?;
        let about = file.metadata().map_err(cannot)?;
        if about.len() > LARGEST {
            return Err(format!(
                "`{}` has more than {LARGEST} bytes; kirk does not read that",
                path.display()
            ));
        }
        let mut bytes = Vec::new();
        (&mut file).take(LARGEST).read_to_end(&mut bytes).map_err(cannot)?;
        let journal = read(&bytes).map_err(|bad| format!("`{}`, {bad}", path.display()))?;
        let held =
            hold(&journal.start.run).map_err(|held| format!("`{}` is in use: {held}", path.display()))?;
        if journal.torn > 0 {
            file.set_len(journal.length as u64).map_err(cannot)?;
            file.seek(SeekFrom::End(0)).map_err(cannot)?;
            file.sync_data().map_err(cannot)?;
        }
        Ok((JournalFile::of(file, &about, journal.length as u64, journal.checksum, held), journal))
    }

    fn of(file: File, about: &Metadata, length: u64, checksum: u32, held: Held) -> JournalFile {
        let counts_names = about.nlink() > 0;
        let buffer = String::new();
        JournalFile { file, length, counts_names, checksum, buffer, syncer: None, ticket: 0, _held: held }
    }

    /// From now on tickets can be asked for; the desk hears of it when what they stand for is on the disk.
    pub(crate) fn begin_syncing(&mut self, desk: Desk) -> Result<(), String> {
        let file =
            self.file.try_clone().map_err(|error| format!("the journal cannot be opened twice: {error}"))?;
        let (sender, tickets) = channel::<Ticket>();
        std::thread::spawn(move || {
            while let Ok(ticket) = tickets.recv() {
                let ticket = tickets.try_iter().last().unwrap_or(ticket);
                desk.synced(ticket, file.sync_data().map_err(unwritten));
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
    ///
    /// # Errors
    /// A sentence that says how the journal was lost.
    pub(crate) fn write(&mut self) -> Result<(), String> {
        if !self.buffer.is_empty() {
            self.check()?;
            self.file.write_all(self.buffer.as_bytes()).map_err(unwritten)?;
            self.length += self.buffer.len() as u64;
            self.buffer.clear();
        }
        Ok(())
    }

    /// Is it as we have written it? That costs a microsecond.
    ///
    /// # Errors
    /// A sentence that says how the journal was lost.
    pub(crate) fn check(&self) -> Result<(), String> {
        let found = self.file.metadata().map_err(unwritten)?;
        if self.counts_names && found.nlink() == 0 {
            return Err(
                "the journal was deleted, or another file put in its place, during the mission".to_string()
            );
        }
        if found.len() != self.length {
            return Err(format!(
                "somebody has changed the journal during the mission: it has {} bytes, and kirk has written {}",
                found.len(),
                self.length
            ));
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
    ///
    /// # Errors
    /// A sentence that says how the journal was lost.
    pub(crate) fn finish(mut self) -> Result<(), String> {
        self.write()?;
        self.check()?;
        self.file.sync_data().map_err(unwritten)
    }
}

fn check_kind(about: &Metadata, path: &Path) -> Result<(), String> {
    if about.is_file() {
        Ok(())
    } else {
        Err(format!("`{}` is no file, and a journal has to be one", path.display()))
    }
}

fn unwritten(error: std::io::Error) -> String {
    format!("the journal cannot be written: {error}")
}
