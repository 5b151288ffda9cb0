//! From a journal to the executive as it was when the journal ends.

use std::collections::VecDeque;
use std::sync::Arc;

use kirk_network::merge::merge;
use kirk_network::{EventId, Network, Time};

use crate::checkpoint::Checkpoint;
use crate::executive::{Executive, Output};
use crate::input::{Answer, Input, Why};
use crate::journal::{BadJournal, Journal, Line, Record, Trace};

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
    let followed = |line: &Line| matches!(line.record, Record::In(Input::Rebuilt { known: Some(_), .. }));
    let Some(last) = journal.lines.iter().rposition(followed) else {
        let executive = journal.start.executive().map_err(at_start)?;
        let mut repetition = Repetition::of(executive, Trail::default());
        repetition.drain(Time::ZERO, &mut |_, _, _| {});
        return repetition.go_through(journal, 0, Plans::AsRecorded, &mut |_, _, _| {});
    };
    let (mut trail, mut all, mut planned) = (Trail::default(), Checkpoint::default(), Time::ZERO);
    for line in &journal.lines[..=last] {
        trail.follow(line);
        if let Record::In(Input::Rebuilt { from, known: Some(known), .. }) = &line.record {
            all.followed_by(known);
            planned = *from;
        }
    }
    let network = Arc::new(merge(&journal.start.network().map_err(at_start)?).network);
    let setup = journal.start.setup(&network).map_err(at_start)?;
    let now = journal.lines[last].at;
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
    trail: Trail,
    /// What is to be handed over and is not recorded yet.
    sends: VecDeque<(String, Time, u32)>,
}

impl Repetition {
    fn of(executive: Executive, trail: Trail) -> Repetition {
        Repetition { executive, trail, sends: VecDeque::new() }
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
            self.drain(line.at, watch);
        }
        let Repetition { executive, trail: Trail { at, mut unsent, ahead }, sends, .. } = self;
        unsent.extend(sends.into_iter().map(|(id, ..)| id));
        Ok(Replay { executive, at, unsent, ahead })
    }

    fn step(&mut self, line: &Line, plans: Plans) -> Result<(), String> {
        match &line.record {
            Record::Start(_) => Err("a mission starts once".to_string()),
            Record::In(input) => self.happens(line.at, input, plans),
            Record::Out(Trace::Dispatch { id, due, attempt }) => self.expect(id, *due, *attempt),
            Record::Out(Trace::End { execution })
                if self.executive.execution(line.at, false) != *execution =>
            {
                Err("the mission ended otherwise than what is recorded before leads to".to_string())
            }
            Record::Out(_) => Ok(()),
        }
    }

    fn happens(&mut self, at: Time, input: &Input, plans: Plans) -> Result<(), String> {
        let given = match input {
            // What was known then is found again; of a plan that was not there it is enough to know that.
            Input::Rebuilt { from, known, .. } => {
                let is_none = known.is_none() && plans == Plans::AsRecorded;
                let rebuild = is_none.then(|| self.executive.rebuild_from(*from)).flatten();
                let made = rebuild.map(|rebuild| Box::new(rebuild.without_plan()));
                Input::Rebuilt { from: *from, known: None, made }
            }
            input => input.clone(),
        };
        if let Input::Resumed { .. } = input {
            // What was to leave leaves now, as part of being back.
            self.sends.clear();
        }
        let handled = self.executive.handle(at, given);
        match (handled.answer, input, handled.record) {
            (Answer::Ignored(Why::UnknownEvent), Input::Observed { event }, _) => {
                Err(format!("there is no event `{event}`"))
            }
            (_, Input::Rebuilt { known, .. }, Some(Input::Rebuilt { known: ours, .. })) if ours == *known => {
                Ok(())
            }
            (_, Input::Rebuilt { .. }, _) => {
                Err("planning anew does not lead to what is recorded".to_string())
            }
            _ => Ok(()),
        }
    }

    /// What was to be handed over next is what is recorded.
    fn expect(&mut self, id: &str, due: Time, attempt: u32) -> Result<(), String> {
        let expected = self.sends.pop_front();
        if expected
            .as_ref()
            .is_some_and(|expected| (expected.0.as_str(), expected.1, expected.2) == (id, due, attempt))
        {
            return Ok(());
        }
        let expected = expected.map_or("nothing".to_string(), |(id, due, _)| format!("`{id}`, due at {due}"));
        Err(format!(
            "`{id}`, due at {due}, was dispatched here, but what is recorded before leads to {expected}"
        ))
    }

    fn drain(&mut self, at: Time, watch: &mut impl FnMut(Time, &Executive, &Output)) {
        while let Some(output) = self.executive.poll_output() {
            if let Output::Send(sending) = &output {
                self.sends.push_back((sending.id.clone(), sending.due, sending.attempt));
            }
            watch(at, &self.executive, &output);
        }
    }
}

impl Trail {
    fn follow(&mut self, line: &Line) {
        match &line.record {
            Record::In(Input::Resumed { .. }) => self.unsent.clear(),
            Record::Out(Trace::Dispatch { id, .. }) => self.unsent.push(id.clone()),
            Record::In(Input::Sent { id }) => self.unsent.retain(|unsent| unsent != id),
            _ => {}
        }
        match line.record {
            Record::Out(Trace::Ahead { due, .. }) => self.ahead = Some(due),
            _ if self.ahead.is_some_and(|due| line.at >= due) => self.ahead = None,
            _ => {}
        }
        // News and confirmations may be of a time shortly before something else was done.
        self.at = self.at.max(line.at);
    }
}

/// Every name of every event.
pub(crate) fn names(network: &Network) -> impl Iterator<Item = (&str, EventId)> {
    network.event_ids().flat_map(|event| {
        network.events()[event.index()].names.iter().map(move |name| (name.text.as_str(), event))
    })
}
