//! Journals of former versions are read, repeated and gone on with, and every line of theirs is still written as it was.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use kirk_network::Time;
use kirk_runtime::journal::{Line, Record, read, write};
use kirk_runtime::{recover, replay};

/// Of a mission of two names of one event, an attempt that failed, news that came early, and news that the model rules out.
const OLD: &str = include_str!("journals/0.1.0.journal");

#[test]
fn every_line_of_an_old_journal_is_written_as_it_was() {
    let journal = read(OLD.as_bytes()).unwrap();
    let start = Line::new(Time::ZERO, Record::Start(Box::new(journal.start)));
    let (mut text, mut checksum) = (String::new(), 0);
    for line in std::iter::once(&start).chain(&journal.lines) {
        let (written, next) = write(line, checksum);
        text.push_str(&written);
        checksum = next;
    }
    assert_eq!(text, OLD);
}

#[test]
fn an_old_journal_leads_to_the_same_state_with_all_its_plans_and_with_the_last_alone() {
    let ends: Vec<usize> = OLD.match_indices('\n').map(|(at, _)| at + 1).collect();
    assert_eq!(OLD.matches(r#""versions":"#).count(), 3, "the plans that were followed");
    for end in ends {
        let journal = read(&OLD.as_bytes()[..end]).unwrap();
        let mut replayed = replay(&journal, |_, _, _| {}).unwrap();
        let mut recovered = recover(&journal).unwrap();
        assert_eq!(recovered.at, replayed.at, "{end}");
        assert_eq!(recovered.unsent, replayed.unsent, "{end}");
        let (at, one, other) = (replayed.at, &mut recovered.executive, &mut replayed.executive);
        assert_eq!(one.execution(at, true), other.execution(at, true), "{end}");
        assert_eq!(one.pending(), other.pending(), "{end}");
        assert_eq!(one.poll_timeout(), other.poll_timeout(), "{end}");
        assert_eq!(one.version(), other.version(), "{end}");
    }
}
