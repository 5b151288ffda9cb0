//! Notes on models that are legal and may surprise.

mod bounds;
mod latency;

use bounds::notes_on_bounds;
use latency::notes_on_latency;

use std::collections::HashMap;

use kirk_network::merge::merge;
use kirk_network::{Bound, ContingentLink, Delay, Duration, EventId, Network};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{Episode, Kind};
use crate::form::clip;
use crate::lower::{Lowered, events_of};
use crate::origins::Origins;
use crate::source::Span;

/// All notes on a program that was unfolded and lowered.
pub(crate) fn notes(lowered: &Lowered, root: &Episode) -> Vec<Diagnostic> {
    let Lowered { network, origins, .. } = lowered;
    let mut notes = notes_on_bounds(root);
    notes.extend(notes_on_merging(network, origins, root));
    notes.extend(notes_on_latency(network, origins, root));
    notes
}

/// Notes the activities that start at the true end of one whose end is heard late.
///
/// "At the same time" makes the two events one, so the start happens when the end does, and not when it is heard.
fn notes_on_merging(network: &Network, origins: &Origins, root: &Episode) -> Vec<Diagnostic> {
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
            let contingent = &network.contingents()[*link];
            let Some(origin) = origins.contingents.get(*link) else { break };
            notes.push(note(episode, &origin.subject.to_string(), contingent.delay, origin.places));
        }
    }
    notes
}

fn note(episode: &Episode, before: &str, delay: Delay, places: [Span; 4]) -> Diagnostic {
    let heard = match delay.max {
        Bound::Finite(max) if max == delay.min => format!("heard {max} s later"),
        Bound::Finite(max) => format!("heard {}-{max} s later", delay.min),
        Bound::Infinite if delay.min == Duration::ZERO => "perhaps never heard".to_string(),
        Bound::Infinite => format!("heard {} s later or never", delay.min),
    };
    let name = clip(&episode.name);
    Diagnostic::note(
        Code::StartsAtDelayedEnd,
        episode.span,
        format!("`{name}` starts at the true end of {before}, which is {heard}"),
    )
    .primary("starts without slack after an end that is heard late")
    .label(places[3], "the news is this late")
    .help(format!(
        "The two events are one moment, and nobody knows of it before the news. If `{name}` is started by the executive, \
         put the two into a `(sequence (:slack t) ...)`."
    ))
}
