//! What each event is measured against: the other ends of its requirements, and whether planning anew is worth while.

use kirk_network::stnu::Rows;
use kirk_network::{EventId, Network};

use crate::knowledge::Knowledge;

/// For every event the events that requirements measure it against.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    rows: Rows,
    others: Vec<EventId>,
}

impl Measured {
    pub(crate) fn new(network: &Network) -> Measured {
        let both = |(a, b): (EventId, EventId)| [(a, b), (b, a)];
        let pairs = || network.requirements().iter().flat_map(move |r| both((r.from, r.to)));
        let count = network.events().len() as u32;
        Measured {
            rows: Rows::new(count, pairs().map(|(event, _)| event.index() as u32)),
            others: pairs().map(|(_, other)| other).collect(),
        }
    }

    /// True if news of an event can make a difference to what is left: some of its tree is still to come, or is measured
    /// against something that is. Otherwise planning anew would come to the same plan.
    pub(crate) fn concerns_the_rest(
        &self,
        event: EventId,
        knowledge: &Knowledge,
        to_come: impl Fn(EventId) -> bool,
    ) -> bool {
        knowledge.tree(event).iter().any(|&member| {
            let against = self.rows.of(member.index() as u32).iter();
            to_come(member)
                || member != event && knowledge.of(member).fixed.is_none()
                || against.map(|&at| self.others[at as usize]).any(&to_come)
        })
    }
}
