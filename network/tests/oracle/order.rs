//! What must not come before what, by transitive closure.

use kirk_network::{Duration, EventId, Network};

/// For two events: as it is written the first must not come after the second, and the second may come after the first. What is
/// written of one event may be left out.
pub fn precedes(network: &Network, without: Option<EventId>) -> impl Fn(EventId, EventId) -> bool + use<> {
    let count = network.events().len();
    let mut before = vec![vec![false; count]; count];
    let counts = |ends: [EventId; 2]| without.is_none_or(|event| !ends.contains(&event));
    for requirement in network.requirements().iter().filter(|r| counts([r.from, r.to])) {
        let (from, to) = (requirement.from.index(), requirement.to.index());
        before[from][to] |= requirement.lower.finite().is_some_and(|lower| lower >= Duration::ZERO);
        before[to][from] |= requirement.upper.finite().is_some_and(|upper| upper <= Duration::ZERO);
    }
    for link in network.contingents().iter().filter(|link| counts([link.from, link.to])) {
        before[link.from.index()][link.to.index()] = true;
    }
    for by in 0..count {
        for from in 0..count {
            for to in 0..count {
                before[from][to] |= before[from][by] && before[by][to];
            }
        }
    }
    move |a, b| before[a.index()][b.index()] && !before[b.index()][a.index()]
}
