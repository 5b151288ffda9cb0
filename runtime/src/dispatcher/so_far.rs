//! How far an execution has got, as far as the dispatcher knows, for asking what is left of it.

use kirk_network::left::{Seen, SoFar};
use kirk_network::{EventId, Interval, Time};

use super::Dispatcher;
use crate::execution::How;

impl Dispatcher {
    /// What is known of every event at a time up to which nothing else was heard. `begun`: what was handed over and when, and is not
    /// confirmed.
    pub fn so_far(&self, now: Time, begun: &[(EventId, Time)]) -> SoFar {
        let mut as_if = self.clone();
        for &(event, since) in begun {
            as_if.knowledge.fix(event, since, How::Dispatched);
        }
        let happened = as_if.happened_by(now);
        let mut settled = vec![false; happened.len()];
        for event in self.network.event_ids().filter(|&event| self.known(event).settled) {
            // What it follows has happened before it.
            let mut at = event;
            while !settled[at.index()] {
                settled[at.index()] = true;
                at = self.network.link_of(at).map_or(at, |link| self.network.contingents()[link].from);
            }
        }
        let seen = |event: EventId| {
            let since = |event: EventId| begun.iter().find(|begun| begun.0 == event).map(|begun| begun.1);
            let known = self.known(event);
            match (self.network.link_of(event), known.fixed, happened[event.index()]) {
                (None, Some(fixed), _) => Seen::Executed(fixed.time),
                (None, None, _) => since(event).map_or(Seen::ToCome, Seen::Begun),
                (Some(_), _, None) => Seen::ToCome,
                (Some(_), _, Some(happened)) => {
                    // What it follows may be executed later than it was handed over.
                    let open = since(self.root(event)).is_some();
                    let latest = if open { Time::MAX } else { happened.latest };
                    let happened = Interval { latest, ..happened };
                    Seen::Nature {
                        happened,
                        heard: known.observed.is_some(),
                        settled: settled[event.index()],
                    }
                }
            }
        };
        SoFar { now, events: self.network.event_ids().map(seen).collect() }
    }

    /// True if news has come that stands against the link of the event.
    pub(crate) fn is_overruled(&self, event: EventId) -> bool {
        self.known(event).overruled
    }
}
