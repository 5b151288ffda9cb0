//! Which events are one, by painting: one after the other, each [0, 0] requirement paints what is of the colour of one of its events
//! in that of the other, unless that would make one of two events that are not ours to place, or a link lead back to its start.

use kirk_network::{Bound, Duration, EventId, Network};

/// For each event the colour of all that are one with it.
pub fn joined(network: &Network) -> Vec<usize> {
    let zero = Bound::Finite(Duration::ZERO);
    let joins = network.requirements().iter().filter(|it| it.lower == zero && it.upper == zero);
    let mut colours: Vec<usize> = (0..network.events().len()).collect();
    let all: Vec<(usize, usize)> = joins.map(|it| (it.from.index(), it.to.index())).collect();
    for allowed in [|_: &Network, _: &[usize]| true, leads_on] {
        colours = (0..network.events().len()).collect();
        for &(from, to) in &all {
            let (old, new) = (colours[from], colours[to]);
            let painted: Vec<usize> = colours.iter().map(|&it| if it == old { new } else { it }).collect();
            if old == new || has_one_at_most(network, &painted) && allowed(network, &painted) {
                colours = painted;
            }
        }
        if leads_on(network, &colours) {
            break;
        }
    }
    colours
}

/// No two events that are not ours to place are one.
fn has_one_at_most(network: &Network, colours: &[usize]) -> bool {
    let is_given = |event: EventId| event == network.origin() || network.link_of(event).is_some();
    let given: Vec<usize> =
        network.event_ids().filter(|&it| is_given(it)).map(|it| colours[it.index()]).collect();
    given.iter().enumerate().all(|(at, colour)| !given[..at].contains(colour))
}

/// No link, followed by those that start where it ends, comes back to where it started.
fn leads_on(network: &Network, colours: &[usize]) -> bool {
    let links: Vec<(usize, usize)> =
        network.contingents().iter().map(|it| (colours[it.from.index()], colours[it.to.index()])).collect();
    links.iter().all(|&(start, end)| {
        let mut reached = vec![end];
        for _ in &links {
            let next: Vec<usize> =
                links.iter().filter(|(from, _)| reached.contains(from)).map(|(_, to)| *to).collect();
            reached.extend(next);
        }
        !reached.contains(&start)
    })
}
