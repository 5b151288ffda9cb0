//! What an event waits for: the events it happens together with, and those right before it.

use std::collections::BTreeSet;

use kirk_network::merge::merge;
use kirk_network::{Bound, Duration, EventId, Network};

/// What comes right before an event that a user wrote.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Waits {
    /// The events it is one with, as `scan:end`.
    pub(crate) together: Vec<String>,
    /// The events it comes after.
    pub(crate) after: Vec<String>,
    /// The contingent link that decides when it happens, if one does.
    pub(crate) link: Option<usize>,
}

/// Looks back from an event to the nearest ones that a user wrote.
pub(crate) fn waits(network: &Network, event: EventId) -> Waits {
    let merged = merge(network);
    let own = |name: &String| network.events()[event.index()].names.iter().any(|known| known.text == *name);
    let names =
        |event: EventId| -> Vec<String> { merged.network.written(event).map(str::to_string).collect() };
    let here = merged.event_of[event.index()];
    let mut waits = Waits { together: names(here), after: Vec::new(), link: merged.network.link_of(here) };
    waits.together.retain(|name| !own(name));
    let mut before: Vec<Vec<EventId>> = vec![Vec::new(); merged.network.events().len()];
    for requirement in merged.network.requirements() {
        if matches!(requirement.lower, Bound::Finite(lower) if lower >= Duration::ZERO) {
            before[requirement.to.index()].push(requirement.from);
        }
        // The same said the other way round.
        if matches!(requirement.upper, Bound::Finite(upper) if upper <= Duration::ZERO) {
            before[requirement.from.index()].push(requirement.to);
        }
    }
    let mut seen = BTreeSet::from([here]);
    let mut open = before[here.index()].clone();
    while let Some(event) = open.pop() {
        if !seen.insert(event) {
            continue;
        }
        match names(event) {
            names if names.is_empty() => open.extend(&before[event.index()]),
            names => waits.after.extend(names),
        }
    }
    waits.after.sort();
    waits.after.dedup();
    waits
}

/// `scan:end` in words.
pub(crate) fn in_words(event: &str) -> String {
    match event.rsplit_once(':') {
        Some((name, "end")) => format!("the end of `{name}`"),
        Some((name, "start")) => format!("the start of `{name}`"),
        _ => format!("`{event}`"),
    }
}
