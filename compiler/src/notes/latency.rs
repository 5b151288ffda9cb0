//! Notes activities that can never be executed late, because bounds that nobody wrote side by side leave one moment.

use std::collections::HashMap;

use kirk_network::punctual::{Group, Punctuality, punctual};
use kirk_network::{Duration, EventId, Network, Share};

use super::problem::{Moment, NeverLate, Problem};
use crate::episode::{Episode, Kind};
use crate::explain::stated;
use crate::lower::events_of;
use crate::origins::Origins;

/// Networks of more events than this are not looked at: it takes as long as the verdict, and nobody wrote them by hand.
const MOST_EVENTS: usize = 5_000;
/// How many notes one program gets.
const MOST_NOTES: usize = 10;
/// How many other activities one note names.
const MOST_OTHERS: usize = 3;

/// Notes the activities of a controllable program whose earliest start is their latest. The network is not merged.
pub(super) fn notes_on_latency<'a>(
    network: &Network,
    origins: &'a Origins,
    root: &'a Episode,
) -> Vec<Problem<'a>> {
    if network.events().len() > MOST_EVENTS {
        return Vec::new();
    }
    let Ok(Some(found)) = punctual(network) else { return Vec::new() };
    if found.groups.is_empty() {
        return Vec::new();
    }
    let episodes = Episodes::new(root);
    found
        .groups
        .iter()
        .filter_map(|group| note(&found, group, &episodes, network, origins))
        .take(MOST_NOTES)
        .collect()
}

fn note<'a>(
    found: &Punctuality,
    group: &Group,
    episodes: &Episodes<'a>,
    network: &Network,
    origins: &'a Origins,
) -> Option<Problem<'a>> {
    let mut late = group.others.iter().filter_map(|exact| {
        let episode = episodes.activity(&exact.events)?;
        let shares = found.because(group, exact, network).ok()??;
        Some((episode, exact, shares))
    });
    let (activity, exact, shares) = late.next()?;
    let amounts: Vec<Share> = shares.into_iter().filter(|share| share.amount != Duration::ZERO).collect();
    Some(Problem::NeverLate(NeverLate {
        activity,
        others: late.take(MOST_OTHERS).map(|(other, ..)| other).collect(),
        after: exact.after,
        moment: episodes.moment(group, network),
        bounds: amounts.iter().filter_map(|share| stated(share, network, origins)).collect(),
        amounts,
    }))
}

/// Which episode starts or ends with an event.
struct Episodes<'a> {
    starts: HashMap<EventId, &'a Episode>,
    ends: HashMap<EventId, &'a Episode>,
}

impl<'a> Episodes<'a> {
    fn new(root: &'a Episode) -> Episodes<'a> {
        let mut episodes = Episodes { starts: HashMap::new(), ends: HashMap::new() };
        for (episode, (start, end)) in events_of(root) {
            episodes.starts.insert(start, episode);
            episodes.ends.insert(end, episode);
        }
        episodes
    }

    /// The activity that starts there.
    fn activity(&self, events: &[EventId]) -> Option<&'a Episode> {
        let starting = events.iter().filter_map(|event| self.starts.get(event));
        starting.copied().find(|episode| episode.kind == Kind::Primitive)
    }

    /// What a form does there: it ends, if any does.
    fn form(&self, events: &[EventId]) -> Moment<'a> {
        let ending = events.iter().find_map(|event| Some(Moment::Ends(self.ends.get(event)?)));
        let starting = || events.iter().find_map(|event| Some(Moment::Starts(self.starts.get(event)?)));
        ending.or_else(starting).unwrap_or(Moment::Unknown)
    }

    /// What happens first in a group.
    fn moment(&self, group: &Group, network: &Network) -> Moment<'a> {
        if group.first.contains(&network.origin()) {
            return Moment::MissionStarts;
        }
        let is_activity = |episode: &&&Episode| episode.kind == Kind::Primitive;
        let mut ending = group.first.iter().filter_map(|event| self.ends.get(event).filter(is_activity));
        match (ending.next().copied(), self.activity(&group.first)) {
            (Some(before), _) if group.news && before.delay.is_some() => Moment::NewsComes(before),
            (Some(before), _) if before.contingent => Moment::Ends(before),
            (_, Some(start)) => Moment::Starts(start),
            (Some(before), None) => Moment::Ends(before),
            (None, None) => self.form(&group.first),
        }
    }
}
