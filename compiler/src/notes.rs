//! Notes on models that are legal and may surprise.

mod bounds;
mod latency;
pub(crate) mod problem;

use bounds::notes_on_bounds;
use latency::notes_on_latency;
use problem::Problem;

use std::collections::HashMap;

use kirk_network::merge::merge;
use kirk_network::{ContingentLink, Delay, EventId, Network};

use crate::episode::{Episode, Kind};
use crate::lower::{Lowered, events_of};
use crate::origins::{Origins, Side};

/// All notes on a program that was unfolded and lowered.
pub(crate) fn notes<'a>(lowered: &'a Lowered, root: &'a Episode) -> Vec<Problem<'a>> {
    let Lowered { network, origins, .. } = lowered;
    let mut notes = notes_on_bounds(root);
    notes.extend(notes_on_merging(network, origins, root));
    notes.extend(notes_on_latency(network, origins, root));
    notes
}

/// Notes the activities that start at the true end of one whose end is heard late.
///
/// "At the same time" makes the two events one, so the start happens when the end does, and not when it is heard.
fn notes_on_merging<'a>(network: &Network, origins: &'a Origins, root: &'a Episode) -> Vec<Problem<'a>> {
    let is_delayed = |link: &ContingentLink| link.delay != Delay::NONE;
    if !network.contingents().iter().any(is_delayed) {
        return Vec::new();
    }
    let event_of = merge(network).event_of;
    // For every merged event, the delayed link that ends in it.
    let delayed: HashMap<EventId, usize> = network
        .contingents()
        .iter()
        .enumerate()
        .filter(|(_, link)| is_delayed(link))
        .map(|(index, link)| (event_of[link.to.index()], index))
        .collect();
    let mut notes = Vec::new();
    for (episode, (start, _)) in events_of(root) {
        if episode.kind == Kind::Primitive
            && let Some(link) = delayed.get(&event_of[start.index()])
        {
            let Some(origin) = origins.contingents.get(*link) else { break };
            notes.push(Problem::StartsAtDelayedEnd {
                activity: episode,
                before: &origin.subject,
                delay: network.contingents()[*link].delay,
                news: origin.place(Side::MaxDelay),
            });
        }
    }
    notes
}
