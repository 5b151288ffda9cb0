//! Planning anew: when news calls for it, from what is known, and how the new plan is followed.

use kirk_network::{EventId, Time};

use super::{Dispatcher, agenda};
use crate::execution::How;
use crate::rebuild::{Rebuild, Rebuilt};

impl Dispatcher {
    /// What is to be planned anew because of news, if anything is. While events are in flight it is not known from where
    /// to plan, so that has to wait.
    pub fn poll_rebuild(&mut self, now: Time) -> Option<Rebuild> {
        if !self.stale || self.asked || !self.in_flight.is_empty() || self.missed.is_some() {
            return None;
        }
        self.asked = true;
        Some(self.rebuild(self.now.max(now.as_micros())))
    }

    /// Goes on with a new plan. Returns false if it came too late: something has happened since, and it has to be asked for
    /// again.
    pub fn handle_rebuilt(&mut self, rebuilt: Rebuilt) -> bool {
        let current = rebuilt.version == self.version;
        self.asked = false;
        if current {
            // It knows all the news there is.
            self.stale = false;
            self.adopt(rebuilt);
        }
        current
    }

    /// True if the news of an event narrowed what was assumed of it, and that makes a difference to what is left.
    pub(super) fn says_more(&self, event: EventId) -> bool {
        let executed = |event: EventId| self.agenda.executed(self.reduction.places[event.index()].node);
        // Not yet executed: the plan is still to wait for it.
        let Some(node) = executed(event) else { return true };
        let place = self.reduction.places[event.index()];
        let assumed = (node.saturating_add(place.earliest), node.saturating_add(place.latest));
        let to_come = |event| executed(event).is_none();
        self.happened(event) != Some(assumed)
            && self.measured.concerns_the_rest(event, &self.knowledge, to_come)
    }

    /// Puts what is known in place of the links, for what is left to be planned anew.
    pub(super) fn rebuild(&mut self, from: i64) -> Rebuild {
        let network = self.plan.shared_network();
        self.knowledge.settle_ancestors(&network);
        let happened = self.knowledge.all_happened(&network);
        let known = network
            .event_ids()
            .map(|event| match (network.link_of(event), self.knowledge.of(event)) {
                (None, known) => known.fixed.map(|(time, _)| (time, time)),
                (Some(_), known) if known.settled => happened[event.index()]
                    .map(|(low, high)| (Time::from_micros(low), Time::from_micros(high))),
                _ => None,
            })
            .collect();
        Rebuild::new(network, Time::from_micros(from), known, self.version)
    }

    /// Follows a new plan; false if there is none.
    pub(super) fn adopt(&mut self, rebuilt: Rebuilt) -> bool {
        let Some((reduction, net)) = rebuilt.plan else {
            // In a delayed chain the reduction may be too careful to see that there is a way. Then the old plan stands.
            self.fix_heard();
            return false;
        };
        let planned = rebuilt.now.as_micros();
        self.agenda = agenda(&reduction, &net, &self.confirmed, self.settings.lead);
        self.reduction = reduction;
        self.active.clear();
        self.activate_from_origin();
        for event in self.plan.network().event_ids() {
            let known = *self.known(event);
            if known.settled && known.fixed.is_none() {
                let (time, how) = match known.observed.map(Time::as_micros) {
                    // Lateness of ours is not held against the news.
                    Some(heard) if self.recorded(heard, planned, planned) == heard => (heard, How::Observed),
                    Some(_) => (planned, How::Buffered),
                    None => (planned, How::Imagined),
                };
                self.fix(event, time, how);
            }
        }
        true
    }

    /// What was heard and has no place of its own in the plan is fixed when it was heard.
    pub(crate) fn fix_heard(&mut self) {
        for event in self.plan.network().event_ids() {
            let known = *self.known(event);
            if let (Some(heard), None, true) = (known.observed, known.fixed, self.is_hidden(event)) {
                self.fix(event, heard.as_micros(), How::Observed);
            }
        }
    }
}
