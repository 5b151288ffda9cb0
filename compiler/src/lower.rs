//! Episodes to a delay STNU, and for every constraint of it the place and the words it comes from.

use std::collections::HashMap;

use kirk_network::{Bound, ContingentLink, Delay, Event, EventId, Name, Network, Requirement};

use crate::episode::{Constraint, Episode, EventOf, Kind, Range};
use crate::origins::{Origin, OriginKind, Origins, Point, Statement, Subject};
use crate::source::Span;
use crate::team::{Team, team};
use crate::typed;

/// What a program is compiled to.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// The network, not merged: every "at the same time" is a requirement [0, 0].
    pub network: Network,
    /// Where its constraints come from.
    pub origins: Origins,
    /// The name of the program to start from, where it is defined.
    pub entry: Span,
    /// Who executes it, if it is not one alone.
    pub team: Option<Team>,
}

/// Builds the network. `None` only if the tree is not what `expand` makes.
pub(crate) fn lower(root: &Episode, written: Option<&typed::Team>) -> Option<Lowered> {
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
    let team = written.map(|written| team(written, root));
    Some(Lowered { network, origins, entry: root.span, team })
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
        let slack = episode.slack == Some(true);
        match episode.kind {
            Kind::Primitive | Kind::Delay => {}
            Kind::Parallel => {
                let kind = if slack { OriginKind::Order } else { OriginKind::SideBySide };
                for &(part, (start, end)) in &parts {
                    self.link((ends.0, start), kind, episode, Statement::Starts(subject(part)));
                    self.link((end, ends.1), kind, episode, Statement::Ends(subject(part)));
                }
            }
            Kind::Program | Kind::Sequence | Kind::WithTemporalConstraint => {
                let kind = if slack { OriginKind::Order } else { OriginKind::Join };
                let mut before: Option<(&Episode, EventId)> = None;
                for &(part, (start, end)) in &parts {
                    let (from, says) = match before {
                        None => (ends.0, Statement::Starts(subject(part))),
                        Some((before, end)) => (end, Statement::Follows(subject(part), subject(before))),
                    };
                    self.link((from, start), kind, episode, says);
                    before = Some((part, end));
                }
                if let Some((last, end)) = before {
                    self.link((end, ends.1), kind, episode, Statement::Closes(subject(last)));
                }
            }
        }
        if episode.parts.is_empty() && !matches!(episode.kind, Kind::Primitive | Kind::Delay) {
            self.link(ends, OriginKind::Empty, episode, Statement::Empty);
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
            let (at, point) = match event.end {
                true => (*end, Point::End(called(episode))),
                false => (*start, Point::Start(called(episode))),
            };
            Some((at, point))
        };
        for Constraint { from, to, interval } in &root.constraints {
            let (Some((from, before)), Some((to, after))) = (find(from), find(to)) else {
                continue;
            };
            let Range { lower, upper, lower_span, upper_span, span } = *interval;
            self.requirements.push(Requirement { from, to, lower: Bound::Finite(lower), upper });
            self.origins.requirements.push(Origin {
                span,
                kind: OriginKind::Between,
                says: Statement::Passes { least: lower.into(), most: upper, news: None },
                subject: Subject::Reach(Box::new([before, after])),
                // What lies between two activities is neither.
                names: vec!["between".to_string()],
                places: [lower_span, upper_span, span, span],
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

    fn link(&mut self, (from, to): Ends, kind: OriginKind, episode: &Episode, says: Statement) {
        let upper = if kind.is_join() { Bound::ZERO } else { Bound::Infinite };
        self.requirements.push(Requirement { from, to, lower: Bound::ZERO, upper });
        let (subject, names) = (subject(episode), names_of(episode));
        let span = episode.span;
        self.origins.requirements.push(Origin { span, kind, says, subject, names, places: [span; 4] });
    }

    fn duration(&mut self, episode: &Episode, interval: &Range, (from, to): Ends) {
        let Range { lower, upper, lower_span, upper_span, span } = *interval;
        let origin = |kind: OriginKind, news: Option<&Range>| Origin {
            span,
            kind,
            says: Statement::Passes {
                least: lower.into(),
                most: upper,
                news: news.map(|late| Delay { min: late.lower, max: late.upper }),
            },
            subject: subject(episode),
            names: names_of(episode),
            places: match news {
                Some(late) => [lower_span, upper_span, late.lower_span, late.upper_span],
                None => [lower_span, upper_span, span, span],
            },
        };
        match upper {
            Bound::Finite(upper) if episode.contingent => {
                let late = episode.delay.as_ref();
                let delay = late.map_or(Delay::NONE, |late| Delay { min: late.lower, max: late.upper });
                self.contingents.push(ContingentLink { from, to, lower, upper, delay });
                self.origins.contingents.push(origin(OriginKind::Contingent, late));
            }
            upper => {
                let kind = match episode.kind {
                    Kind::Primitive | Kind::Delay => OriginKind::Duration,
                    _ => OriginKind::Constraint,
                };
                self.requirements.push(Requirement { from, to, lower: lower.into(), upper });
                self.origins.requirements.push(origin(kind, None));
            }
        }
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

/// What a user knows an episode by.
pub(crate) fn called(episode: &Episode) -> Subject {
    match episode.labels.first() {
        Some(label) => Subject::Named(label.clone()),
        None => subject(episode),
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
