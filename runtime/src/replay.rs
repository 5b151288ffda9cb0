//! From a journal to the executive as it was when the journal ends.

use std::collections::VecDeque;

use kirk_network::Time;
use kirk_network::json::Seconds;

use crate::executive::{Executive, Output};
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

/// Repeats what a journal records. `watch` sees every output at its time, and the executive that brought it about.
///
/// # Errors
/// A record that does not follow from those before it: the journal is not of this kirk, or not of this mission.
pub fn replay(
    journal: &Journal,
    mut watch: impl FnMut(Time, &Executive, &Output),
) -> Result<Replay, BadJournal> {
    let executive = journal.start.executive().map_err(|message| BadJournal { line: 1, message })?;
    let mut replay = Replay { executive, at: Time::ZERO, unsent: Vec::new(), ahead: None };
    let mut sends: VecDeque<(String, Seconds, u32)> = VecDeque::new();
    replay.drain(Time::ZERO, &mut sends, &mut watch);
    for (index, line) in journal.lines.iter().enumerate() {
        let bad = |message: String| BadJournal { line: index + 2, message };
        replay.step(line, &mut sends).map_err(bad)?;
        replay.drain(line.time(), &mut sends, &mut watch);
        // News and confirmations may be of a time shortly before something else was done.
        replay.at = replay.at.max(line.time());
    }
    replay.unsent.extend(sends.into_iter().map(|(id, ..)| id));
    Ok(replay)
}

impl Replay {
    fn step(&mut self, line: &Line, sends: &mut VecDeque<(String, Seconds, u32)>) -> Result<(), String> {
        let at = line.time();
        let executive = &mut self.executive;
        match &line.record {
            Record::Start(_) => return Err("a mission starts once".to_string()),
            Record::Timeout {} => executive.handle_timeout(at),
            Record::News { event } => {
                let event = executive.network().find(event).ok_or(format!("there is no event `{event}`"))?;
                executive.handle_news(at, event);
            }
            Record::Executed { id, ago } => executive.handle_executed(at, id, ago.map(|ago| ago.0)),
            Record::Failed { id, reason, doubt } => executive.handle_failed(at, id, reason, *doubt),
            Record::Rebuilt { from } => {
                let from = Time::from_micros(from.0.as_micros());
                let rebuild = executive.poll_rebuild(from).ok_or("there is nothing to plan anew here")?;
                executive.handle_rebuilt(at, rebuild.run());
            }
            Record::Resumed { unsent, .. } => {
                // What was to leave leaves now, as part of being back.
                sends.clear();
                self.unsent.clear();
                executive.handle_resumed(at, unsent);
            }
            Record::Stopped { reason, detail } => executive.handle_stopped(at, reason, detail),
            Record::Dispatch { id, due, attempt } => {
                let expected = sends.pop_front();
                if expected
                    .as_ref()
                    .is_none_or(|expected| (&expected.0, expected.1, expected.2) != (id, *due, *attempt))
                {
                    let expected = expected
                        .map_or("nothing".to_string(), |(id, due, _)| format!("`{id}`, due at {}", due.0));
                    return Err(format!(
                        "`{id}`, due at {}, was dispatched here, but what is recorded before leads to {expected}",
                        due.0
                    ));
                }
                self.unsent.push(id.clone());
            }
            Record::Sent { id } => {
                executive.handle_sent(at, id);
                self.unsent.retain(|unsent| unsent != id);
            }
            Record::Ahead { due, .. } => self.ahead = Some(Time::from_micros(due.0.as_micros())),
            Record::Warning { .. } | Record::Ignored { .. } => {}
            Record::End { execution } => {
                let ours = executive.execution(at, false);
                if ours != *execution {
                    return Err(
                        "the mission ended otherwise than what is recorded before leads to".to_string()
                    );
                }
            }
        }
        if self.ahead.is_some_and(|due| at >= due && !matches!(line.record, Record::Ahead { .. })) {
            self.ahead = None;
        }
        Ok(())
    }

    fn drain(
        &mut self,
        at: Time,
        sends: &mut VecDeque<(String, Seconds, u32)>,
        watch: &mut impl FnMut(Time, &Executive, &Output),
    ) {
        while let Some(output) = self.executive.poll_output() {
            if let Output::Send(sending) = &output {
                let due = Seconds(kirk_network::Duration::from_micros(sending.due.as_micros()));
                sends.push_back((sending.id.clone(), due, sending.attempt));
            }
            watch(at, &self.executive, &output);
        }
    }
}
