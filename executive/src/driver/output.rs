//! What commands of the driver print: whole lines, each with whom it is from, and no more than a person can read.
//!
//! Commands run side by side, so each has a pipe of its own; its lines are handed on whole. A command that floods is read on,
//! so that it does not stand still, but not shown.

use std::io;
use std::process::Stdio;
use std::sync::mpsc::Sender;
use std::time::Duration as Real;

use tokio::net::unix::pipe::Receiver;
use tokio::sync::mpsc;
use tokio::time::{Instant, timeout};

/// A line that a command of the driver has printed, without its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// The event it was started for, or `driver`.
    pub who: String,
    /// What it printed. Foreign text: whatever bytes there were, as far as they are UTF-8.
    pub line: String,
}

/// Where the lines go.
#[derive(Clone, Debug)]
pub(crate) struct Ear {
    out: Sender<Said>,
    /// Held by everybody who may still say something.
    _alive: mpsc::Sender<()>,
}

/// Waits until everybody has said everything.
pub(super) struct Silence(mpsc::Receiver<()>);

/// Of a longer line only the beginning is shown.
const LONGEST_LINE: usize = 1000;
/// So many lines a second of one command are shown.
const MOST_LINES: u32 = 100;
/// After so long a silence it is said how much was not shown.
const QUIET: Real = Real::from_secs(1);
/// What is in a pipe when its command has ended is read in no time; whoever still has it open is not waited for longer.
const PATIENCE: Real = Real::from_millis(50);

impl Ear {
    pub(super) fn new(out: Sender<Said>) -> (Ear, Silence) {
        let (_alive, silence) = mpsc::channel(1);
        (Ear { out, _alive }, Silence(silence))
    }

    /// A pipe for what a command prints, both its output and its errors, which is listened to from now on.
    pub(super) fn listen(&self, who: &str) -> io::Result<(Stdio, Stdio)> {
        let (reader, writer) = io::pipe()?;
        let pipe = Receiver::from_owned_fd(reader.into())?;
        let listener = Listener { ear: self.clone(), lines: Lines::new(who) };
        tokio::spawn(listener.listen(pipe));
        Ok((writer.try_clone()?.into(), writer.into()))
    }
}

/// Listens to one command. Whatever ends that, what was heard last is passed on.
struct Listener {
    ear: Ear,
    lines: Lines,
}

impl Listener {
    async fn listen(mut self, pipe: Receiver) {
        let mut bytes = [0; 4096];
        loop {
            match pipe.try_read(&mut bytes) {
                Ok(0) => return,
                Ok(length) => {
                    let said = self.lines.take(&bytes[..length], Instant::now());
                    self.pass_on(said);
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    match timeout(QUIET, pipe.readable()).await {
                        Ok(Ok(())) => {}
                        Ok(Err(_)) => return,
                        Err(_) => {
                            let said = self.lines.admit();
                            self.pass_on(said.into_iter().collect());
                        }
                    }
                }
                Err(_) => return,
            }
        }
    }

    fn pass_on(&self, said: Vec<Said>) {
        // Nobody may be interested.
        said.into_iter().for_each(|said| drop(self.ear.out.send(said)));
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        let said = self.lines.end();
        self.pass_on(said);
    }
}

impl Silence {
    /// To be awaited when no command is running any more.
    pub(super) async fn come(mut self, ear: Ear) {
        drop(ear);
        let _ = timeout(PATIENCE, self.0.recv()).await;
    }
}

/// Bytes, cut into lines, with a limit on how many there are.
struct Lines {
    who: String,
    /// The beginning of a line.
    begun: Vec<u8>,
    /// How many bytes of it were left out.
    cut: usize,
    /// Since when lines are counted, how many were shown since, and how many were not.
    since: Instant,
    shown: u32,
    dropped: u64,
}

impl Lines {
    fn new(who: &str) -> Lines {
        let (begun, since) = (Vec::new(), Instant::now());
        Lines { who: who.to_string(), begun, cut: 0, since, shown: 0, dropped: 0 }
    }

    /// The lines that are whole with these bytes.
    fn take(&mut self, bytes: &[u8], now: Instant) -> Vec<Said> {
        let mut said = Vec::new();
        for part in bytes.split_inclusive(|&byte| byte == b'\n') {
            let (part, whole) = part.strip_suffix(b"\n").map_or((part, false), |part| (part, true));
            let room = LONGEST_LINE.saturating_sub(self.begun.len()).min(part.len());
            self.begun.extend_from_slice(&part[..room]);
            self.cut += part.len() - room;
            if whole {
                self.line(now, &mut said);
            }
        }
        said
    }

    /// What is left when there will be nothing more.
    fn end(&mut self) -> Vec<Said> {
        let mut said = Vec::new();
        if !self.begun.is_empty() {
            self.line(self.since, &mut said);
        }
        said.extend(self.admit());
        said
    }

    fn line(&mut self, now: Instant, said: &mut Vec<Said>) {
        let (line, cut) = (std::mem::take(&mut self.begun), std::mem::take(&mut self.cut));
        if now - self.since >= Real::from_secs(1) {
            (self.since, self.shown) = (now, 0);
            said.extend(self.admit());
        }
        if self.shown == MOST_LINES {
            self.dropped += 1;
            return;
        }
        self.shown += 1;
        let text = String::from_utf8_lossy(&line);
        // A terminal would show what was printed last over the rest: bars of progress are made so.
        let text = text.rsplit('\r').find(|text| !text.is_empty()).unwrap_or_default();
        let more = if cut > 0 { format!(" ... ({cut} bytes more)") } else { String::new() };
        said.push(Said { who: self.who.clone(), line: format!("{text}{more}") });
    }

    /// How much was not shown, if that was not said yet.
    fn admit(&mut self) -> Option<Said> {
        let dropped = std::mem::take(&mut self.dropped);
        let line = format!("({dropped} lines more, not shown)");
        (dropped > 0).then(|| Said { who: self.who.clone(), line })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(said: Vec<Said>) -> Vec<String> {
        said.into_iter().map(|said| said.line).collect()
    }

    #[test]
    fn lines_are_whole_however_the_bytes_come() {
        let text = "one\ntwo \u{e9}\n\n10 %\r 99 %\rdone\r\nfour".as_bytes();
        for cut in 0..text.len() {
            let mut lines = Lines::new("a:start");
            let now = lines.since;
            let mut said = lines.take(&text[..cut], now);
            said.extend(lines.take(&text[cut..], now));
            said.extend(lines.end());
            assert!(said.iter().all(|said| said.who == "a:start"));
            assert_eq!(texts(said), ["one", "two \u{e9}", "", "done", "four"], "cut at {cut}");
        }
    }

    #[test]
    fn a_flood_is_counted_and_a_long_line_is_cut() {
        let mut lines = Lines::new("driver");
        let now = lines.since;
        let said = lines.take("x\n".repeat(1_000_000).as_bytes(), now);
        assert_eq!(said.len(), MOST_LINES as usize);
        // In the next second there is room again, and what was left out is told.
        let later = texts(lines.take(b"y\n", now + Real::from_secs(1)));
        assert_eq!(later, ["(999900 lines more, not shown)", "y"]);
        assert!(texts(lines.take(&[b'z'; 10_000_000], now)).is_empty());
        assert!(lines.begun.len() <= LONGEST_LINE);
        let end = texts(lines.end());
        assert_eq!(end, [format!("{} ... (9999000 bytes more)", "z".repeat(LONGEST_LINE))]);
    }
}
