//! Notes activities that can never be executed late, because bounds that nobody wrote side by side leave one moment.

use std::collections::HashMap;

use kirk_network::punctual::{Group, Punctuality, punctual};
use kirk_network::{Duration, EventId, Network, Share};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{Episode, Kind};
use crate::explain::{say, sum};
use crate::form::clip;
use crate::lower::{called, events_of};
use crate::origins::Origins;
use crate::source::Span;

/// Networks of more events than this are not looked at: it takes as long as the verdict, and nobody wrote them by hand.
const MOST_EVENTS: usize = 5_000;
/// How many notes one program gets.
const MOST_NOTES: usize = 10;

/// Notes the activities of a controllable program whose earliest start is their latest. The network is not merged.
pub(super) fn notes_on_latency(network: &Network, origins: &Origins, root: &Episode) -> Vec<Diagnostic> {
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

fn note(
    found: &Punctuality,
    group: &Group,
    episodes: &Episodes<'_>,
    network: &Network,
    origins: &Origins,
) -> Option<Diagnostic> {
    let mut late = group.others.iter().filter_map(|exact| {
        let episode = episodes.activity(&exact.events)?;
        let shares = found.because(group, exact, network).ok()??;
        Some((episode, exact, shares))
    });
    let (episode, exact, shares) = late.next()?;
    let name = clip(&episode.name);
    let (when, moment) = episodes.moment(group, exact.after, network);
    let message = format!("`{name}` can never start late: it has to start {when}");
    let mut note = Diagnostic::note(Code::NeverLate, episode.span, message)
        .primary("the first moment at which this can start is also the last");
    let mut places: Vec<(Span, String)> = moment.into_iter().collect();
    for share in shares.iter().filter(|share| share.amount != Duration::ZERO) {
        places.extend(say(share, network, origins, &[], true).filter(|place| !places.contains(place)));
    }
    for (span, text) in places {
        note = note.label(span, text);
    }
    for (other, ..) in late.take(3) {
        note = note.label(other.span, format!("`{}` can never start late either", clip(&other.name)));
    }
    let written: Vec<Share> = shares.into_iter().filter(|share| share.amount != Duration::ZERO).collect();
    let because = match written.is_empty() {
        true => String::new(),
        false => format!("No time is left between these bounds: {} = 0. ", sum(&written)),
    };
    Some(note.help(format!(
        "{because}Every computer, radio and person takes a moment to react, and then this plan is broken: leave some \
         time, by a longer upper bound or a shorter lower one."
    )))
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

    /// The form a user gave no name to that starts or ends there: its end, if that is it.
    fn form(&self, events: &[EventId]) -> Option<(&'a Episode, bool)> {
        let ending = events.iter().find_map(|event| Some((*self.ends.get(event)?, true)));
        ending.or_else(|| events.iter().find_map(|event| Some((*self.starts.get(event)?, false))))
    }

    /// "exactly 5 s after `a` ends", and where that is, if its name does not say it.
    fn moment(&self, group: &Group, after: Duration, network: &Network) -> (String, Option<(Span, String)>) {
        let mut place = None;
        let ending = group
            .first
            .iter()
            .find_map(|event| self.ends.get(event).filter(|episode| episode.kind == Kind::Primitive));
        let what = if group.first.contains(&network.origin()) {
            "the mission starts".to_string()
        } else {
            match (ending, self.activity(&group.first)) {
                (Some(before), _) if group.news && before.delay.is_some() => {
                    format!("the news of the end of `{}` comes", clip(&before.name))
                }
                (Some(before), _) if before.contingent => format!("`{}` ends", clip(&before.name)),
                (_, Some(start)) => format!("`{}` starts", clip(&start.name)),
                (Some(before), None) => format!("`{}` ends", clip(&before.name)),
                (None, None) => match self.form(&group.first) {
                    Some((episode, end)) => {
                        let happens = if end { "ends" } else { "starts" };
                        let called = called(episode);
                        if episode.internal {
                            place = Some((episode.span, format!("{called} that {happens} then")));
                        }
                        format!("{called} {happens}")
                    }
                    None => "this can happen".to_string(),
                },
            }
        };
        let when = match after == Duration::ZERO {
            true => format!("the moment {what}"),
            false => format!("exactly {after} s after {what}"),
        };
        (when, place)
    }
}
