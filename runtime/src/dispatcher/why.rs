//! Why an event was fixed when it was: what the agenda waited for, in terms of events.

use std::fmt;

use kirk_network::{Duration, EventId, Requirement, Time};

use super::Dispatcher;
use crate::agenda::Hold;
use crate::cause::Cause;
use crate::execution::How;

/// For each event what decided when it was fixed, if that is known. It is for people only: no decision depends on it, and no
/// journal has it of what was before a new plan. So it is no part of the state that an execution is in, nor shown as one.
#[derive(Clone)]
pub(super) struct Causes(pub(super) Vec<Option<Cause>>);

impl fmt::Debug for Causes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Causes")
    }
}

impl Dispatcher {
    /// What decided when an event was fixed; `None` if it was not, or before the plan with which the execution was resumed. Events that
    /// nobody wrote are left out where something before them says as much.
    pub fn why(&self, event: EventId) -> Option<Cause> {
        let mut cause = self.cause_in_full(event)?;
        while let Some(before) = self.by_way_of(cause) {
            cause = before;
        }
        Some(cause)
    }

    /// What decided when a node of ours is due that nothing holds back.
    pub(super) fn cause_of_due(&self, node: u32, due: Time) -> Cause {
        match (self.agenda.hold(node), self.anew) {
            (Hold::Nothing | Hold::After { node: 0, distance: Duration::ZERO }, None) => Cause::Start,
            (Hold::Nothing | Hold::After { node: 0, .. }, Some(anew)) => anew,
            (Hold::After { node, distance }, _) => Cause::After { event: self.acted_on(node), distance },
            (Hold::Order { node }, _) => Cause::Order { event: self.acted_on(node) },
            (Hold::Wait { link, distance }, _) => {
                let event = self.acted_on(self.reduction.stnu.links[link as usize].contingent);
                let (since, distance) = self.since(link, event, due, distance);
                Cause::Unobserved { event, since, distance }
            }
        }
    }

    /// What decided when a contingent node of the plan happens, by the news of an event or without.
    pub(super) fn cause_of_acting(&self, node: u32, event: EventId, time: Time, how: How) -> Cause {
        let Some(link) = self.agenda.ending(node).filter(|_| how != How::Observed) else {
            return Cause::Observed;
        };
        let start =
            self.agenda.executed(self.reduction.stnu.links[link as usize].activation).unwrap_or(Time::ZERO);
        let (since, distance) = self.since(link, event, time, time.saturating_since(start));
        match how {
            How::Imagined => Cause::Unobserved { event, since, distance },
            _ => Cause::Held { since, distance },
        }
    }

    /// A new plan, by the news it was made with.
    pub(super) fn anew(&self) -> Cause {
        let heard = self.network.event_ids().filter(|&event| self.known(event).observed.is_some());
        Cause::Anew { news: heard.max_by_key(|&event| self.known(event).observed) }
    }

    /// From where a time is measured that is so long after the activation of a link: where a new plan has the origin for all
    /// that has happened, from what Nature measures from.
    fn since(&self, link: u32, event: EventId, time: Time, distance: Duration) -> (EventId, Duration) {
        let activation = self.reduction.stnu.links[link as usize].activation;
        let from = self.network.link_of(event).map(|link| self.network.contingents()[link].from);
        let fixed = from.and_then(|from| Some((from, self.known(from).fixed?.time)));
        match fixed.filter(|_| activation == 0 && self.anew.is_some()) {
            Some((from, start)) => (from, time.saturating_since(start)),
            None => (self.acted_on(activation), distance),
        }
    }

    /// A new plan has the origin for all that has happened: which of it was it?
    fn cause_in_full(&self, event: EventId) -> Option<Cause> {
        let cause = self.causes.0[event.index()]?;
        let ours = self.network.link_of(event).is_none();
        match cause {
            Cause::Anew { .. } if ours => Some(self.by_requirement(event).unwrap_or(cause)),
            _ => Some(cause),
        }
    }

    /// The last event that a requirement keeps just as far before another as it was.
    fn by_requirement(&self, event: EventId) -> Option<Cause> {
        let fixed = self.known(event).fixed?;
        let before = |other: EventId, distance: Duration| {
            let earlier = self.known(other).fixed.filter(|other| other.sequence < fixed.sequence)?;
            let latest = self.happened(other)?.latest;
            if latest.checked_add(distance) != Some(fixed.time) {
                return None;
            }
            let cause = match earlier.time == latest {
                true => Cause::After { event: other, distance },
                false => Cause::Surely { event: other, latest, distance },
            };
            Some((earlier.sequence, cause))
        };
        let keeps = |&Requirement { from, to, lower, upper }: &Requirement| {
            let (other, distance) = match event {
                event if event == to => (from, lower.finite()),
                event if event == from => (to, upper.finite().map(|upper| -upper)),
                _ => return None,
            };
            before(other, distance.filter(|&distance| distance >= Duration::ZERO)?)
        };
        self.network
            .requirements()
            .iter()
            .filter_map(keeps)
            .max_by_key(|(last, _)| *last)
            .map(|(_, cause)| cause)
    }

    /// The same said of what was before, if the event it is measured from is one that nobody wrote.
    fn by_way_of(&self, cause: Cause) -> Option<Cause> {
        let (event, distance) = match cause {
            Cause::After { event, distance } => (event, distance),
            Cause::Order { event } => (event, Duration::ZERO),
            _ => return None,
        };
        if event == self.network.origin() || self.network.written(event).next().is_some() {
            return None;
        }
        match self.cause_in_full(event)? {
            Cause::After { event, distance: before } => {
                Some(Cause::After { event, distance: before.checked_add(distance)? })
            }
            Cause::Start if distance > Duration::ZERO => {
                Some(Cause::After { event: self.network.origin(), distance })
            }
            Cause::Start => Some(Cause::Start),
            before @ (Cause::Order { .. }
            | Cause::Unobserved { .. }
            | Cause::Surely { .. }
            | Cause::Anew { .. })
                if distance == Duration::ZERO =>
            {
                Some(before)
            }
            _ => None,
        }
    }
}
