//! A journal as text: how a line is written, and what is still right of a file in which something is wrong.

use std::fmt;

use super::{FORMAT, Line, Record, Start};

/// A journal that has been read.
#[derive(Clone, Debug)]
pub struct Journal {
    /// What it says about the mission.
    pub start: Start,
    /// All lines after the first.
    pub lines: Vec<Line>,
    /// How many bytes of the file are right; what follows was torn.
    pub length: usize,
    /// How many bytes are torn.
    pub torn: usize,
    /// The checksum of the last line, for the next one.
    pub checksum: u32,
}

/// What is wrong with a journal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadJournal {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub message: String,
}

impl fmt::Display for BadJournal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for BadJournal {}

/// No line is shorter than `01234567 {"at":0,"record":{"in":{"timeout":{}}}}` and its end.
const SHORTEST_LINE: usize = 49;

/// Writes a line to follow one with a checksum (0 for the first), and returns it with its own checksum.
pub fn write(line: &Line, before: u32) -> (String, u32) {
    let text = serde_json::to_string(line)
        .unwrap_or_else(|error| unreachable!("a line has only strings and numbers: {error}"));
    let checksum = checksum(before, text.as_bytes());
    (format!("{checksum:08x} {text}\n"), checksum)
}

/// Reads a journal.
///
/// # Errors
/// A line that is damaged, unless it is the last one: that was torn, and is left out.
pub fn read(bytes: &[u8]) -> Result<Journal, BadJournal> {
    let mut lines = Vec::new();
    let mut before = 0;
    let mut at = 0;
    while at < bytes.len() {
        let end = bytes[at..].iter().position(|&byte| byte == b'\n').map(|length| at + length);
        let line = end.ok_or("it has no end".to_string()).and_then(|end| read_line(&bytes[at..end], before));
        match (line, end) {
            (Ok((line, checksum)), Some(end)) => {
                if let (Record::Start(start), true) = (&line.record, lines.is_empty()) {
                    check_format(&start.format, &start.version)?;
                }
                lines.push(line);
                before = checksum;
                at = end + 1;
            }
            // It was being written when the machine or the process died.
            (Err(_), _) if !lines.is_empty() && is_torn(&bytes[at..]) => break,
            (Err(message), end) => {
                if let (true, Some(end)) = (lines.is_empty(), end) {
                    check_format_of(&bytes[at..end])?;
                }
                let message = lost(&bytes[at..], at).filter(|_| !lines.is_empty()).unwrap_or(message);
                return Err(BadJournal { line: lines.len() + 1, message });
            }
            (Ok(_), None) => unreachable!("a line is read up to its end"),
        }
    }
    let mut lines = lines.into_iter();
    let start = match lines.next().map(|line| line.record) {
        Some(Record::Start(start)) => *start,
        Some(_) => return Err(BadJournal { line: 1, message: "it does not say what is executed".into() }),
        None => return Err(BadJournal { line: 1, message: "there is nothing in it".into() }),
    };
    Ok(Journal { start, lines: lines.collect(), length: at, torn: bytes.len() - at, checksum: before })
}

/// True if a file looks like a journal.
pub fn is_journal(bytes: &[u8]) -> bool {
    bytes.len() > 9
        && bytes[8] == b' '
        && bytes[9] == b'{'
        && bytes[..8].iter().all(|byte| byte.is_ascii_hexdigit())
}

/// True if these last bytes of a file are the beginning of one line, the rest of which never reached the disk: it is not
/// there, or reads as zeros.
fn is_torn(bytes: &[u8]) -> bool {
    let begun = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    let (begun, zeros) = bytes.split_at(begun);
    let (checksum, json) = begun.split_at(begun.len().min(9));
    let is_beginning = || {
        let whole = serde_json::from_slice::<serde_json::Value>(json);
        checksum.iter().all(|byte| byte.is_ascii_hexdigit() || *byte == b' ')
            && whole.map_or_else(|error| error.is_eof(), |_| true)
    };
    zeros.iter().all(|&byte| byte == 0)
        && (zeros.len() <= SHORTEST_LINE || bytes.len() < 2 * SHORTEST_LINE)
        && !begun.contains(&b'\n')
        && is_beginning()
}

/// What is wrong if these last bytes of a file, which begin at `at`, are zeros.
fn lost(bytes: &[u8], at: usize) -> Option<String> {
    let begun = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    let zeros = bytes.len() - begun;
    (zeros > SHORTEST_LINE && !bytes[..begun].contains(&b'\n')).then(|| {
        format!(
            "the last {zeros} bytes of the file are zeros, where there may have been more than one record. What comes before is \
             right, {at} bytes: cut the rest off (`truncate -s {at}`) if the mission is to go on from there"
        )
    })
}

fn read_line(bytes: &[u8], before: u32) -> Result<(Line, u32), String> {
    if !is_journal(bytes) {
        return Err("a line is a checksum of 8 digits, a blank and a JSON object; this is not".to_string());
    }
    let written = std::str::from_utf8(&bytes[..8]).ok().and_then(|text| u32::from_str_radix(text, 16).ok());
    let found = checksum(before, &bytes[9..]);
    if written != Some(found) {
        return Err(format!(
            "it is damaged, or a line before it is missing (its checksum is not {found:08x})"
        ));
    }
    let line = serde_json::from_slice(&bytes[9..]).map_err(|error| error.to_string())?;
    Ok((line, found))
}

/// The first line of a journal of another version may say things we do not know, but it says of which version it is.
fn check_format_of(line: &[u8]) -> Result<(), BadJournal> {
    let line = line.get(9..).and_then(|json| serde_json::from_slice::<serde_json::Value>(json).ok());
    let said = |key| line.as_ref()?.pointer(&format!("/record/start/{key}"))?.as_str();
    match (said("format"), said("version")) {
        (Some(format), Some(version)) => check_format(format, version),
        _ => Ok(()),
    }
}

fn check_format(format: &str, version: &str) -> Result<(), BadJournal> {
    if format == FORMAT {
        return Ok(());
    }
    let message = format!(
        "this is a journal of format `{format}`, written by kirk {version}, and this kirk reads `{FORMAT}`; go on with it by a \
         kirk that knows that format"
    );
    Err(BadJournal { line: 1, message })
}

fn checksum(before: u32, text: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&before.to_be_bytes());
    hasher.update(text);
    hasher.finalize()
}

#[cfg(test)]
mod tests {
    use kirk_network::{Duration, Time, json};
    use serde_json::value::RawValue;

    use super::*;
    use crate::dispatcher::Settings;
    use crate::executive::Setup;
    use crate::input::Input;
    use crate::journal::{Clocks, Trace};
    use crate::order::Patience;
    use crate::speed::Speed;

    #[test]
    fn a_journal_of_another_format_is_refused_by_its_name() {
        for start in [
            r#"{"format":"kirk-journal/2","version":"0.1.0"}"#,
            r#"{"format":"kirk-journal/9","version":"9.0.0","tea":"green"}"#,
        ] {
            let json = format!(r#"{{"at":0,"record":{{"start":{start}}}}}"#);
            let text = format!("{:08x} {json}\n", checksum(0, json.as_bytes()));
            let bad = read(text.as_bytes()).unwrap_err();
            let format = &start[11..25];
            assert!(bad.line == 1 && bad.message.contains(format), "{bad}");
            assert!(bad.message.contains("written by kirk") && bad.message.contains(FORMAT), "{bad}");
        }
    }

    #[test]
    fn every_damage_is_noticed_and_only_a_torn_end_is_forgiven() {
        let line = |n: i64| {
            let text = format!("line {n}");
            Line::new(Time::from_micros(n), Record::Out(Trace::Warning { text }))
        };
        let network = json::read(r#"{"format": "kirk-network/1", "origin": "z", "events": ["z"]}"#).unwrap();
        let setup = Setup {
            program: "p".into(),
            run: "r".into(),
            settings: Settings::default(),
            handovers: Vec::new(),
            driver: false,
            patience: Patience { first: Duration::ZERO, most: Duration::ZERO },
        };
        let shell = RawValue::from_string("null".into()).unwrap();
        let start = Start::new(
            &network,
            &setup,
            Speed::REAL,
            Clocks { boot: None, since_boot: 0, calendar: 0 },
            shell,
            "0",
        );
        let mut text = String::new();
        let mut before = 0;
        let first = Line::new(Time::ZERO, Record::Start(Box::new(start)));
        for line in [first, line(1), line(2), line(3)] {
            let (written, checksum) = write(&line, before);
            text.push_str(&written);
            before = checksum;
        }
        let whole = text.as_bytes();
        assert_eq!(read(whole).unwrap().lines.len(), 3);
        let starts: Vec<usize> = std::iter::once(0)
            .chain((0..whole.len()).filter(|&at| whole[at] == b'\n').map(|at| at + 1))
            .collect();
        // Cut anywhere: what is whole is kept, and without a first line there is no journal.
        for cut in 0..whole.len() {
            let kept = starts.iter().filter(|&&at| at > 0 && at <= cut).count();
            match read(&whole[..cut]) {
                Ok(journal) => {
                    assert_eq!((journal.lines.len() + 1, journal.length), (kept, starts[kept]), "{cut}")
                }
                Err(bad) => assert!(kept == 0 && bad.line == 1, "{cut}: {bad}"),
            }
        }
        // Changed anywhere: an error, in the line that is changed.
        for at in 0..whole.len() {
            let mut changed = whole.to_vec();
            changed[at] ^= 1;
            let line = starts.iter().filter(|&&start| start <= at).count();
            let found = read(&changed).map(|journal| journal.torn).map_err(|bad| bad.line);
            assert_eq!(found, Err(line), "byte {at}");
        }
        // What never reached the disk reads as zeros.
        let mut zeros = whole[..starts[3] + 20].to_vec();
        zeros.resize(whole.len(), 0);
        assert_eq!(read(&zeros).unwrap().lines.len(), 2);
        // Zeros in the place of more than one line are no torn line, wherever they begin.
        for zeros in starts[2]..starts[3] - 1 {
            let mut lost = whole[..zeros].to_vec();
            lost.resize(whole.len(), 0);
            let bad = read(&lost).unwrap_err();
            assert!(bad.line == 3 && bad.message.contains("zeros"), "{zeros}: {bad}");
            assert!(bad.message.contains(&format!("right, {} bytes", starts[2])), "{bad}");
        }
        let shortest = write(&Line::new(Time::ZERO, Record::In(Input::Timeout {})), 0).0;
        assert_eq!(shortest.len(), SHORTEST_LINE);
        // A line that is missing, doubled, or in another place.
        let part = |n: usize| &text[starts[n]..starts[n + 1]];
        for order in [vec![0, 2, 3], vec![0, 1, 1, 2, 3], vec![0, 2, 1, 3]] {
            let moved: String = order.iter().map(|&n| part(n)).collect();
            assert!(read(moved.as_bytes()).is_err(), "{order:?}");
        }
    }
}
