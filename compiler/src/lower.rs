//! Episodes to a delay STNU, and for every constraint of it the place and the words it comes from.

use std::collections::HashMap;

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement};

use crate::episode::{Constraint, Episode, EventOf, Interval, Kind};
use crate::origins::{Origin, OriginKind, Origins, Subject};
use crate::source::Span;

/// What a program is compiled to.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// The network, not merged: every "at the same time" is a requirement [0, 0].
    pub network: Network,
    /// Where its constraints come from.
    pub origins: Origins,
    /// The name of the program to start from, where it is defined.
    pub entry: Span,
}

/// Builds the network. `None` only if the tree is not what `expand` makes.
pub(crate) fn lower(root: &Episode) -> Option<Lowered> {
    let mut lowering = Lowering {
        events: Vec::new(),
        requirements: Vec::new(),
        contingents: Vec::new(),
        origins: Origins::default(),
    };
    lowering.episode(root);
    lowering.constraints(root);
    let Lowering { events, requirements, contingents, origins } = lowering;
    let network = Network::new(root.name.clone(), EventId(0), events, requirements, contingents).ok()?;
    Some(Lowered { network, origins, entry: root.span })
}

struct Lowering {
    events: Vec<Event>,
    requirements: Vec<Requirement>,
    contingents: Vec<ContingentLink>,
    origins: Origins,
}

/// The start and the end of an episode.
pub(crate) type Ends = (EventId, EventId);

impl Lowering {
    /// Adds an episode with all its parts; returns its start and its end. Events are numbered in the order in which they
    /// can happen: the start, the parts, the end.
    fn episode(&mut self, episode: &Episode) -> Ends {
        let start = self.event(episode, "start");
        let parts: Vec<(&Episode, Ends)> =
            episode.parts.iter().map(|part| (part, self.episode(part))).collect();
        let ends = (start, self.event(episode, "end"));
        if let Some(interval) = &episode.duration {
            self.duration(episode, interval, ends);
        }
        let subject = subject(episode);
        let slack = episode.slack == Some(true);
        match episode.kind {
            Kind::Primitive | Kind::Delay => {}
            Kind::Parallel => {
                for &(part, (start, end)) in &parts {
                    let inner = described(part);
                    let (kind, starts, stops) = if slack {
                        (
                            OriginKind::Order,
                            format!("{inner} starts after {subject} starts"),
                            format!("{inner} ends before {subject} ends"),
                        )
                    } else {
                        (
                            OriginKind::SideBySide,
                            format!("{inner} starts together with the others here (no slack)"),
                            format!("{inner} ends together with the others here (no slack)"),
                        )
                    };
                    self.link(ends.0, start, kind, episode, starts);
                    self.link(end, ends.1, kind, episode, stops);
                }
            }
            Kind::Program | Kind::Sequence | Kind::WithTemporalConstraint => {
                let kind = if slack { OriginKind::Order } else { OriginKind::Join };
                let mut last = ends.0;
                let mut before: Option<String> = None;
                for &(part, (start, end)) in &parts {
                    let inner = described(part);
                    let text = match (&before, slack) {
                        (None, true) => format!("{inner} starts after {subject} starts"),
                        (None, false) => format!("{inner} starts when {subject} starts"),
                        (Some(before), true) => format!("{inner} starts after {before} ends"),
                        (Some(before), false) => format!("{inner} starts when {before} ends (no slack)"),
                    };
                    self.link(last, start, kind, episode, text);
                    last = end;
                    before = Some(inner);
                }
                if let Some(before) = before {
                    let text = match slack {
                        true => format!("{subject} ends after {before} ends"),
                        false => format!("{subject} ends when {before} ends"),
                    };
                    self.link(last, ends.1, kind, episode, text);
                }
            }
        }
        if episode.parts.is_empty() && !matches!(episode.kind, Kind::Primitive | Kind::Delay) {
            let text = format!("{subject} is empty and takes no time");
            self.link(ends.0, ends.1, OriginKind::Empty, episode, text);
        }
        ends
    }

    /// What `between` says.
    fn constraints(&mut self, root: &Episode) {
        if root.constraints.is_empty() {
            return;
        }
        let events: HashMap<&str, (&Episode, Ends)> = events_of(root)
            .into_iter()
            .map(|(episode, ends)| (episode.name.as_str(), (episode, ends)))
            .collect();
        let find = |event: &EventOf| {
            let (episode, (start, end)) = events.get(event.episode.as_str())?;
            let words = format!("the {} of {}", if event.end { "end" } else { "start" }, called(episode));
            Some((if event.end { *end } else { *start }, words, names_of(episode)))
        };
        for Constraint { from, to, interval } in &root.constraints {
            let (Some((from, before, mut names)), Some((to, after, others))) = (find(from), find(to)) else {
                continue;
            };
            names.extend(others);
            let Interval { lower, upper, lower_span, upper_span, span } = *interval;
            self.requirements.push(Requirement { from, to, lower: Bound::Finite(lower), upper });
            let subject = Subject::Reach(format!("from {before} to {after}"));
            let text = format!("{} {subject}", range(interval));
            let places = [lower_span, upper_span, span, span];
            self.origins.requirements.push(Origin {
                span,
                text,
                kind: OriginKind::Between,
                subject,
                end: after,
                names,
                places,
            });
        }
    }

    fn event(&mut self, episode: &Episode, end: &str) -> EventId {
        let own = Name { text: format!("{}:{end}", episode.name), internal: episode.internal };
        let labels =
            episode.labels.iter().map(|label| Name { text: format!("{label}:{end}"), internal: false });
        self.events.push(Event { names: std::iter::once(own).chain(labels).collect() });
        EventId(self.events.len() as u32 - 1)
    }

    fn link(&mut self, from: EventId, to: EventId, kind: OriginKind, episode: &Episode, text: String) {
        let zero = Bound::Finite(Duration::ZERO);
        let upper = if kind.is_join() { zero } else { Bound::Infinite };
        self.requirements.push(Requirement { from, to, lower: zero, upper });
        let (span, subject, end) = (episode.span, subject(episode), end_of(episode));
        let names = names_of(episode);
        self.origins.requirements.push(Origin { span, text, kind, subject, end, names, places: [span; 4] });
    }

    fn duration(&mut self, episode: &Episode, interval: &Interval, (from, to): Ends) {
        let subject = subject(episode);
        let takes = range(interval);
        let mut places = [interval.lower_span, interval.upper_span, interval.span, interval.span];
        let upper = match interval.upper {
            Bound::Finite(upper) if episode.contingent => upper,
            bound => {
                let (kind, text) = match episode.kind {
                    Kind::Primitive | Kind::Delay => {
                        (OriginKind::Duration, format!("{subject} takes {takes}"))
                    }
                    _ => (OriginKind::Constraint, format!("this takes {takes} from start to end")),
                };
                self.requirements.push(Requirement {
                    from,
                    to,
                    lower: Bound::Finite(interval.lower),
                    upper: bound,
                });
                let (end, names) = (end_of(episode), names_of(episode));
                self.origins.requirements.push(Origin {
                    span: interval.span,
                    text,
                    kind,
                    subject,
                    end,
                    names,
                    places,
                });
                return;
            }
        };
        let mut text = format!("{subject} takes {takes}, Nature decides");
        let mut delay = Delay::NONE;
        if let Some(late) = &episode.delay {
            delay = Delay { min: late.lower, max: late.upper };
            places[2] = late.lower_span;
            places[3] = late.upper_span;
            text.push_str(&format!(", and the news of its end comes {} later", range(late)));
        }
        self.contingents.push(ContingentLink { from, to, lower: interval.lower, upper, delay });
        self.origins.contingents.push(Origin {
            span: interval.span,
            text,
            kind: OriginKind::Contingent,
            subject,
            end: end_of(episode),
            names: names_of(episode),
            places,
        });
    }
}

/// All episodes with their events, in source order, each before its parts.
pub fn events_of(root: &Episode) -> Vec<(&Episode, Ends)> {
    let mut found: Vec<(&Episode, Ends)> = Vec::new();
    let mut next = 0;
    let mut number = || {
        next += 1;
        EventId(next - 1)
    };
    // An episode to enter, or the position of one to leave.
    let mut open: Vec<Result<&Episode, usize>> = vec![Ok(root)];
    while let Some(step) = open.pop() {
        match step {
            Ok(episode) => {
                let start = number();
                open.push(Err(found.len()));
                found.push((episode, (start, start)));
                open.extend(episode.parts.iter().rev().map(Ok));
            }
            Err(position) => found[position].1.1 = number(),
        }
    }
    found
}

/// The name a user knows an episode by.
pub(crate) fn called(episode: &Episode) -> String {
    match (episode.internal, episode.labels.first()) {
        (_, Some(label)) => format!("`{label}`"),
        (false, None) => format!("`{}`", episode.name),
        (true, None) => format!("the `{}`", episode.kind.word()),
    }
}

/// What a constraint of an episode is about.
fn subject(episode: &Episode) -> Subject {
    match episode.internal {
        true => Subject::Form(episode.kind.word()),
        false => Subject::Named(episode.name.clone()),
    }
}

/// What a user may call an episode: by its name, that of its program, a label, or the word of its form.
fn names_of(episode: &Episode) -> Vec<String> {
    let own = match episode.internal {
        true => vec![episode.kind.word().to_string()],
        false => vec![episode.name.clone(), episode.name.split('#').next().unwrap_or_default().to_string()],
    };
    own.into_iter().chain(episode.labels.iter().cloned()).collect()
}

/// What the end of an episode is called in a sentence.
fn end_of(episode: &Episode) -> String {
    format!("the end of {}", subject(episode))
}

/// An episode in a sentence about the one around it.
fn described(episode: &Episode) -> String {
    match episode.internal {
        true => format!("the `{}` inside", episode.kind.word()),
        false => format!("`{}`", episode.name),
    }
}

/// `15 to 20 s`.
fn range(interval: &Interval) -> String {
    match interval.upper {
        Bound::Finite(upper) if upper == interval.lower => format!("{upper} s"),
        Bound::Finite(upper) if interval.lower == Duration::ZERO => format!("at most {upper} s"),
        Bound::Finite(upper) => format!("{} to {upper} s", interval.lower),
        Bound::Infinite if interval.lower == Duration::ZERO => "any time".to_string(),
        Bound::Infinite => format!("at least {} s", interval.lower),
    }
}
