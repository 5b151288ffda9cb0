//! Puts a generated network together.

use crate::model::{ContingentLink, Delay, Event, EventId, Name, Network, Requirement};
use crate::time::{Bound, Duration};

use super::Link;

/// A network in progress. Its first event is the origin, `start`.
pub(super) struct Builder {
    events: Vec<Event>,
    requirements: Vec<Requirement>,
    contingents: Vec<ContingentLink>,
}

impl Builder {
    pub(super) const ORIGIN: EventId = EventId(0);

    pub(super) fn new() -> Builder {
        let mut builder = Builder { events: Vec::new(), requirements: Vec::new(), contingents: Vec::new() };
        builder.event("start".to_string());
        builder
    }

    pub(super) fn event(&mut self, text: String) -> EventId {
        self.events.push(Event { names: [Name { text, internal: false }].into() });
        EventId(self.events.len() as u32 - 1)
    }

    pub(super) fn requirement(
        &mut self,
        from: EventId,
        to: EventId,
        lower: Duration,
        upper: impl Into<Bound>,
    ) {
        self.requirements.push(Requirement { from, to, lower: Bound::Finite(lower), upper: upper.into() });
    }

    pub(super) fn contingent(
        &mut self,
        from: EventId,
        to: EventId,
        (lower, upper): (Duration, Duration),
        delay: Delay,
    ) {
        self.contingents.push(ContingentLink { from, to, lower, upper, delay });
    }

    /// One or the other, not delayed.
    pub(super) fn link(
        &mut self,
        kind: Link,
        from: EventId,
        to: EventId,
        (lower, upper): (Duration, Duration),
    ) {
        match kind {
            Link::Requirement => self.requirement(from, to, lower, upper),
            Link::Contingent => self.contingent(from, to, (lower, upper), Delay::NONE),
        }
    }

    pub(super) fn finish(self, name: String) -> Network {
        Network::new(name, Builder::ORIGIN, self.events, self.requirements, self.contingents)
            .unwrap_or_else(|errors| unreachable!("the parts of a generated network fit: {errors:?}"))
    }
}

/// `lower + more`, of numbers of seconds that are small.
pub(super) fn plus(lower: Duration, more: Duration) -> Duration {
    Duration::from_micros(lower.as_micros() + more.as_micros())
}

/// News that comes at once or up to `max` later.
pub(super) fn up_to(max: Duration) -> Delay {
    Delay { min: Duration::ZERO, max: Bound::Finite(max) }
}
