//! From a journal to the executive as it was when the journal ends.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use kirk_network::json::Seconds;
use kirk_network::merge::merge;
use kirk_network::{Duration, EventId, Network, Time};

use crate::checkpoint::Checkpoint;
use crate::executive::{Executive, Output, Replanned};
use crate::journal::{BadJournal, Journal, Line, Record};

/// What a journal leads to.
#[derive(Debug)]
pub struct Replay {
    /// The executive as it was.
    pub executive: Executive,
    /// The time of the last record.
    pub at: Time,
    /// Dispatches that were decided on and of which no record says that they left.
    pub unsent: Vec<String>,
    /// What was to be due next, written ahead, of which no record says that it happened.
    pub ahead: Option<Time>,
}

/// Repeats all that a journal records, every plan that was made included. `watch` sees every output at its time, and the
/// executive that brought it about.
///
/// # Errors
/// A record that does not follow from those before it: the journal is not of this kirk, or not of this mission.
pub fn replay(
    journal: &Journal,
    mut watch: impl FnMut(Time, &Executive, &Output),
) -> Result<Replay, BadJournal> {
    let executive = journal.start.executive().map_err(|message| BadJournal { line: 1, message })?;
    let mut repetition = Repetition::of(executive, Trail::default());
    repetition.drain(Time::ZERO, &mut watch);
    repetition.go_through(journal, 0, Plans::Made, &mut watch)
}

/// The same state, without what is not needed to go on: of all plans only the one that is followed at the end is made.
///
/// # Errors
/// As for [`replay`], as far as it is noticed.
pub fn recover(journal: &Journal) -> Result<Replay, BadJournal> {
    let at_start = |message| BadJournal { line: 1, message };
    let followed = |line: &Line| matches!(line.record, Record::Rebuilt { known: Some(_), .. });
    let Some(last) = journal.lines.iter().rposition(followed) else {
        let executive = journal.start.executive().map_err(at_start)?;
        let mut repetition = Repetition::of(executive, Trail::default());
        repetition.drain(Time::ZERO, &mut |_, _, _| {});
        return repetition.go_through(journal, 0, Plans::AsRecorded, &mut |_, _, _| {});
    };
    let (mut trail, mut all, mut planned) = (Trail::default(), Checkpoint::default(), Time::ZERO);
    for line in &journal.lines[..=last] {
        trail.follow(line);
        if let Record::Rebuilt { from, known: Some(known) } = &line.record {
            all.followed_by(known);
            planned = time(*from);
        }
    }
    let network = Arc::new(merge(&journal.start.network().map_err(at_start)?).network);
    let setup = journal.start.setup(&network).map_err(at_start)?;
    let now = journal.lines[last].time();
    let executive = Executive::restored(&network, setup, &all, planned, now)
        .map_err(|message| BadJournal { line: last + 2, message })?;
    let mut repetition = Repetition::of(executive, trail);
    repetition.drain(now, &mut |_, _, _| {});
    repetition.go_through(journal, last + 1, Plans::AsRecorded, &mut |_, _, _| {})
}

/// Are the plans made that a journal says were made?
#[derive(Clone, Copy, PartialEq)]
enum Plans {
    Made,
    /// That there was none is taken as it stands.
    AsRecorded,
}

/// What the records say by themselves.
#[derive(Debug, Default)]
struct Trail {
    at: Time,
    unsent: Vec<String>,
    ahead: Option<Time>,
}

struct Repetition {
    executive: Executive,
    events: HashMap<String, EventId>,
    trail: Trail,
    /// What is to be handed over and is not recorded yet.
    sends: VecDeque<(String, Seconds, u32)>,
}

impl Repetition {
    fn of(executive: Executive, trail: Trail) -> Repetition {
        let events = names(executive.network()).map(|(name, event)| (name.to_string(), event)).collect();
        Repetition { executive, events, trail, sends: VecDeque::new() }
    }

    /// Repeats the lines of a journal from one on.
    fn go_through(
        mut self,
        journal: &Journal,
        from: usize,
        plans: Plans,
        watch: &mut impl FnMut(Time, &Executive, &Output),
    ) -> Result<Replay, BadJournal> {
        for (index, line) in journal.lines.iter().enumerate().skip(from) {
            self.step(line, plans).map_err(|message| BadJournal { line: index + 2, message })?;
            self.trail.follow(line);
            self.drain(line.time(), watch);
        }
        let Repetition { executive, trail: Trail { at, mut unsent, ahead }, sends, .. } = self;
        unsent.extend(sends.into_iter().map(|(id, ..)| id));
        Ok(Replay { executive, at, unsent, ahead })
    }

    fn step(&mut self, line: &Line, plans: Plans) -> Result<(), String> {
        let at = line.time();
        let executive = &mut self.executive;
        match &line.record {
            Record::Start(_) => return Err("a mission starts once".to_string()),
            Record::Timeout {} => executive.handle_timeout(at),
            Record::News { event } => {
                let event = self.events.get(event).ok_or(format!("there is no event `{event}`"))?;
                executive.handle_news(at, *event);
            }
            Record::Executed { id, ago } => executive.handle_executed(at, id, ago.map(|ago| ago.0)),
            Record::Failed { id, reason, doubt } => executive.handle_failed(at, id, reason, *doubt),
            Record::Rebuilt { from, known } => {
                let rebuild =
                    executive.poll_rebuild(time(*from)).ok_or("there is nothing to plan anew here")?;
                let none = plans == Plans::AsRecorded && known.is_none();
                let rebuilt = if none { rebuild.without_plan() } else { rebuild.run() };
                match (executive.handle_rebuilt(at, rebuilt), known) {
                    (Replanned::Followed(ours), Some(known)) if ours == *known => {}
                    (Replanned::NoPlan, None) => {}
                    _ => return Err("planning anew does not lead to what is recorded".to_string()),
                }
            }
            Record::Resumed { unsent, .. } => {
                // What was to leave leaves now, as part of being back.
                self.sends.clear();
                executive.handle_resumed(at, unsent);
            }
            Record::Stopped { reason, detail } => executive.handle_stopped(at, reason, detail),
            Record::Dispatch { id, due, attempt } => self.expect(id, *due, *attempt)?,
            Record::Sent { id } => {
                executive.handle_sent(at, id);
            }
            Record::Began { .. } | Record::Ahead { .. } | Record::Warning { .. } | Record::Ignored { .. } => {
            }
            Record::End { execution } => {
                let ours = executive.execution(at, false);
                if ours != *execution {
                    return Err(
                        "the mission ended otherwise than what is recorded before leads to".to_string()
                    );
                }
            }
        }
        Ok(())
    }

    /// What was to be handed over next is what is recorded.
    fn expect(&mut self, id: &str, due: Seconds, attempt: u32) -> Result<(), String> {
        let expected = self.sends.pop_front();
        if expected
            .as_ref()
            .is_some_and(|expected| (expected.0.as_str(), expected.1, expected.2) == (id, due, attempt))
        {
            return Ok(());
        }
        let expected =
            expected.map_or("nothing".to_string(), |(id, due, _)| format!("`{id}`, due at {}", due.0));
        Err(format!(
            "`{id}`, due at {}, was dispatched here, but what is recorded before leads to {expected}",
            due.0
        ))
    }

    fn drain(&mut self, at: Time, watch: &mut impl FnMut(Time, &Executive, &Output)) {
        while let Some(output) = self.executive.poll_output() {
            if let Output::Send(sending) = &output {
                let due = Seconds(Duration::from_micros(sending.due.as_micros()));
                self.sends.push_back((sending.id.clone(), due, sending.attempt));
            }
            watch(at, &self.executive, &output);
        }
    }
}

impl Trail {
    fn follow(&mut self, line: &Line) {
        match &line.record {
            Record::Resumed { .. } => self.unsent.clear(),
            Record::Dispatch { id, .. } => self.unsent.push(id.clone()),
            Record::Sent { id } => self.unsent.retain(|unsent| unsent != id),
            _ => {}
        }
        match line.record {
            Record::Ahead { due, .. } => self.ahead = Some(time(due)),
            _ if self.ahead.is_some_and(|due| line.time() >= due) => self.ahead = None,
            _ => {}
        }
        // News and confirmations may be of a time shortly before something else was done.
        self.at = self.at.max(line.time());
    }
}

/// Every name of every event.
pub(crate) fn names(network: &Network) -> impl Iterator<Item = (&str, EventId)> {
    network.event_ids().flat_map(|event| {
        network.events()[event.index()].names.iter().map(move |name| (name.text.as_str(), event))
    })
}

fn time(seconds: Seconds) -> Time {
    Time::from_micros(seconds.0.as_micros())
}
