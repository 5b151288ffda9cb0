//! From a delay STNU to a plain one: the reduction that makes every algorithm for plain STNUs work with late news.
//!
//! Lemmas 7 to 13 of the thesis (N. Bhargava's variable-delay to fixed-delay transformations), read as one linear pass.
//! Every event is *placed*: its true time lies in `[earliest, latest]` after the time of a node of the plain STNU.
//! - An executable event is its own node, with no uncertainty.
//! - A contingent event that is **heard**, with link [l, u] and delay [g-, g+], gets a node for the moment we act as if
//!   the news had come, at the end of a link [l + g+, u + g-]; it happened between g+ and g- before that node.
//! - A **hidden** one (l = u, or news that may never come, or delays so different that the news tells nothing) gets no
//!   node: it is somewhere in [l, u] after its activation.
//!
//! A requirement `t_j - t_i <= w` must hold wherever the two really are: `node_j - node_i <= w - latest_j + earliest_i`.
//!
//! Chains (a link that starts at a contingent event) are placed from the parent's place, which is sound, and exact
//! unless the parent's news is delayed. A requirement within one tree of links is decided here: only Nature has a say.
//! A child at a fixed distance from its parent is the same uncertainty, heard by whichever news says more.

use crate::model::{ContingentLink, Delay, Event, EventId, Name, Network, Requirement};
use crate::stnu::{Edge, Link, Stnu, TooLarge, add};
use crate::time::{Bound, Duration, Interval, Time};
use crate::trees::{Trees, link_to};

/// A plain STNU that is dynamically controllable iff the network it is from is variable-delay controllable (with the
/// exception of delayed chains, where it is at least never too hopeful), and the way back.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The plain STNU; node 0 is the origin.
    pub stnu: Stnu,
    /// What each node of `stnu` stands for: an executable event, or the contingent event at the root of a group.
    pub event_of: Vec<EventId>,
    /// Where each event of the network is.
    pub places: Vec<Whereabouts>,
    pub(crate) sources: Vec<Source>,
}

/// Where an event is: truly in `[earliest, latest]` after the time of `node`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whereabouts {
    /// A node of the plain STNU.
    pub node: u32,
    /// The least the event comes after the node (often negative: before it).
    pub earliest: Duration,
    /// The most the event comes after the node.
    pub latest: Duration,
    /// The contingent event by whose news the node happens, if the node is the moment of acting on news.
    pub heard_by: Option<EventId>,
    /// The first of the events at a fixed distance from one another that share this node; the event itself otherwise.
    pub root: EventId,
    /// The ancestor from whose place the window of this one was worked out; the event itself if there is none.
    pub(crate) base: EventId,
    /// True if a cleverer use of the news in a delayed chain might know more.
    pub(crate) inexact: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Upper(usize),
    Lower(usize),
    AfterOrigin,
}

/// Why there is no plain STNU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReduceError {
    /// Nature alone can violate a requirement: not controllable.
    Never(Violation),
    /// The numbers are too large to compute with.
    TooLarge,
}

/// A side of a requirement that no strategy keeps: both its events are in one tree of links, and Nature may let `to`
/// come too long after `from`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    pub(crate) source: Source,
    pub(crate) from: EventId,
    pub(crate) to: EventId,
}

impl From<TooLarge> for ReduceError {
    fn from(_: TooLarge) -> ReduceError {
        ReduceError::TooLarge
    }
}

/// How far an execution has got, for reducing what is left of it.
#[derive(Clone, Debug)]
pub struct Progress {
    /// Nothing more can happen before this.
    pub now: Time,
    /// For every event the interval in which it happened, if anything is known: a point for what we executed.
    pub known: Vec<Option<Interval>>,
}

/// Reduces a merged network.
pub fn reduce(network: &Network) -> Result<Reduction, ReduceError> {
    Reducer::new(network, None)?.reduce()
}

/// Reduces what is left of an execution: everything known is placed at the origin, nothing else happens before `now`. What is
/// known only roughly is placed where news still to come, of an event at a fixed distance, tells of it more exactly.
pub fn reduce_rest(network: &Network, progress: &Progress) -> Result<Reduction, ReduceError> {
    Reducer::new(network, Some(progress))?.reduce()
}

impl Reduction {
    /// What to call each node: the name of its event, with a prime if the node is the moment of acting on late news.
    pub fn labels(&self, merged: &Network) -> Vec<String> {
        let mut labels: Vec<String> = Vec::with_capacity(self.event_of.len());
        for (node, &event) in self.event_of.iter().enumerate() {
            let place = self.places[event.index()];
            let mut label = merged.label(event).to_string();
            let late = place.node == node as u32
                && (place.earliest, place.latest) != (Duration::ZERO, Duration::ZERO);
            if late {
                label.push('\'');
                while merged.find(&label).is_some() {
                    label.push('\'');
                }
            }
            labels.push(label);
        }
        labels
    }

    /// The plain STNU as a network of its own, for people and for other tools.
    pub fn to_network(&self, merged: &Network) -> Network {
        let names = self.event_of.iter().zip(self.labels(merged)).map(|(&event, label)| {
            let names = &merged.events()[event.index()].names;
            if names.iter().any(|name| name.text == label) {
                Event { names: names.clone() }
            } else {
                Event { names: [Name { text: label, internal: false }].into() }
            }
        });
        let requirement = |edge: &Edge| Requirement {
            from: EventId(edge.from),
            to: EventId(edge.to),
            lower: Bound::Infinite,
            upper: Duration::from_micros(edge.weight).into(),
        };
        // That nothing comes before the origin goes without saying.
        let said =
            self.stnu.edges.iter().zip(&self.sources).filter(|(_, source)| **source != Source::AfterOrigin);
        let links = self.stnu.links.iter().map(|link| ContingentLink {
            from: EventId(link.activation),
            to: EventId(link.contingent),
            lower: Duration::from_micros(link.lower),
            upper: Duration::from_micros(link.upper),
            delay: Delay::NONE,
        });
        Network::new(
            merged.name().to_string(),
            EventId(0),
            names.collect(),
            said.map(|(edge, _)| requirement(edge)).collect(),
            links.collect(),
        )
        .unwrap_or_else(|errors| unreachable!("the reduction of a valid network is valid: {errors:?}"))
    }
}

/// The news a group is acted on by: it arrives in `[min, max]` after the root of the group.
#[derive(Clone, Copy)]
struct BestNews {
    of: EventId,
    min: i64,
    max: i64,
    /// There is other news of the same group that could say more, or sooner, and is not made use of.
    rivals: bool,
}

impl Whereabouts {
    /// True if the event is not known the moment it happens: news of its children may tell of it first, or more.
    fn is_heard_late(&self) -> bool {
        self.earliest != self.latest || self.heard_by.is_some() && self.latest != Duration::ZERO
    }
}

struct Reducer<'a> {
    network: &'a Network,
    progress: Option<&'a Progress>,
    trees: Trees,
    places: Vec<Option<Whereabouts>>,
    event_of: Vec<EventId>,
    links: Vec<Link>,
}

impl<'a> Reducer<'a> {
    fn new(network: &'a Network, progress: Option<&'a Progress>) -> Result<Reducer<'a>, TooLarge> {
        Ok(Reducer {
            network,
            progress,
            trees: Trees::new(network)?,
            places: vec![None; network.events().len()],
            event_of: Vec::new(),
            links: Vec::new(),
        })
    }

    fn reduce(mut self) -> Result<Reduction, ReduceError> {
        self.place_known_and_executable()?;
        for at in 0..self.trees.parents_first.len() {
            let event = self.trees.parents_first[at];
            if self.places[event.index()].is_none() {
                self.place_group(event)?;
            }
        }
        let places: Vec<Whereabouts> = self.places.iter().copied().flatten().collect();
        debug_assert_eq!(places.len(), self.network.events().len());
        let (edges, sources) = self.edges(&places)?;
        let stnu = Stnu { nodes: self.event_of.len() as u32, edges, links: self.links };
        Ok(Reduction { stnu, event_of: self.event_of, places, sources })
    }

    fn place_known_and_executable(&mut self) -> Result<(), TooLarge> {
        let origin = self.network.origin();
        self.event_of.push(origin);
        let told_later = self.told_later()?;
        for event in self.network.event_ids() {
            let (node, earliest, latest) = match self.known(event) {
                Some(_) if told_later[event.index()] => continue,
                Some((earliest, latest)) => (0, earliest, latest),
                None if event == origin => (0, 0, 0),
                None if self.network.link_of(event).is_some() => continue,
                None => {
                    self.event_of.push(event);
                    (self.event_of.len() as u32 - 1, 0, 0)
                }
            };
            let place = Whereabouts {
                node,
                earliest: Duration::from_micros(earliest),
                latest: Duration::from_micros(latest),
                heard_by: None,
                root: event,
                base: event,
                inexact: false,
            };
            self.places[event.index()] = Some(place);
        }
        Ok(())
    }

    /// The interval in which an event happened, if anything is known of it.
    fn known(&self, event: EventId) -> Option<(i64, i64)> {
        let Interval { earliest, latest } = self.progress?.known[event.index()]?;
        Some((earliest.as_micros(), latest.as_micros()))
    }

    /// For each event: it has happened, but news that is still to come, of its group, says more exactly when.
    fn told_later(&self) -> Result<Vec<bool>, TooLarge> {
        let mut later = vec![false; self.network.events().len()];
        for &event in &self.trees.parents_first {
            let Some((earliest, latest)) = self.known(event) else { continue };
            if earliest == latest || later[event.index()] {
                continue;
            }
            let group = self.trees.twins_of(self.network, event);
            let Some(news) = self.best_news(&group)? else { continue };
            let to_come = add(earliest, news.max)?.max(self.now()) < add(latest, news.min)?;
            if to_come && self.known(news.of).is_none() && latest - earliest > news.max - news.min {
                group.into_iter().for_each(|(member, _)| later[member.index()] = true);
            }
        }
        Ok(later)
    }

    /// Places a contingent event whose parent is placed, with all that follow it at a fixed distance.
    fn place_group(&mut self, root: EventId) -> Result<(), TooLarge> {
        let group = self.trees.twins_of(self.network, root);
        // What is known roughly is measured from the origin, as is what can be measured from nothing else.
        let known = self.known(root);
        let mut from_origin = known.is_some();
        let parent = if from_origin { root } else { self.link(root).from };
        let mut base = parent;
        let (mut lower, mut upper) = known.map_or_else(|| self.window(root, base), Ok)?;
        let mut inexact = !from_origin && (self.place(parent).is_heard_late() || self.place(parent).inexact);
        // A single value, or news that may be equally late whatever happened, tells nothing.
        let news = self.best_news(&group)?.filter(|news| upper - lower > news.max - news.min);
        if let Some(news) = &news {
            // The moment of acting on the news must not come before the node it is measured from.
            while !from_origin && add(lower, news.max)? < 0 {
                let above = self.place(base).base;
                if above == base {
                    (lower, upper) = self.path(root, base, self.known(base).unwrap_or_default())?;
                    (base, from_origin) = (root, true);
                } else {
                    base = above;
                    (lower, upper) = self.window(root, base)?;
                }
            }
            inexact |= base != parent || news.rivals;
        }
        if inexact {
            self.places[parent.index()].iter_mut().for_each(|place| place.inexact = true);
        }
        let activation = if from_origin { 0 } else { self.place(base).node };
        let mut node = activation;
        if let Some(news) = &news {
            let (mut earliest, latest) = (add(lower, news.max)?, add(upper, news.min)?);
            if activation == 0 {
                earliest = earliest.max(self.now());
            }
            if earliest < latest {
                node = self.event_of.len() as u32;
                self.event_of.push(root);
                self.links.push(Link { activation, contingent: node, lower: earliest, upper: latest });
                (lower, upper) = (-news.max, -news.min);
            } else {
                // Acted on at `latest` at the latest, and that is now.
                (lower, upper) = (add(latest, -news.max)?, add(latest, -news.min)?);
            }
        }
        for (event, offset) in group {
            let place = Whereabouts {
                node,
                earliest: Duration::from_micros(add(lower, offset)?),
                latest: Duration::from_micros(add(upper, offset)?),
                heard_by: news.as_ref().map(|news| news.of).filter(|_| node != activation),
                root,
                base,
                inexact,
            };
            self.places[event.index()].get_or_insert(place);
        }
        Ok(())
    }

    /// Of all the news that tell of the root of a group: that which varies least, then the earliest.
    fn best_news(&self, group: &[(EventId, i64)]) -> Result<Option<BestNews>, TooLarge> {
        let mut all = Vec::new();
        for &(of, offset) in group {
            let delay = self.link(of).delay;
            if let Bound::Finite(max) = delay.max {
                let (min, max) = (add(offset, delay.min.as_micros())?, add(offset, max.as_micros())?);
                all.push(BestNews { of, min, max, rivals: false });
            }
        }
        let best = all.iter().copied().min_by_key(|news| (news.max - news.min, news.max));
        Ok(best.map(|best| BestNews {
            // Exact news that comes before all other news is all there is to know.
            rivals: all
                .iter()
                .any(|other| other.of != best.of && (best.min != best.max || other.min < best.max)),
            ..best
        }))
    }

    fn now(&self) -> i64 {
        self.progress.map_or(0, |progress| progress.now.as_micros())
    }

    /// The window of `event` after the node of its ancestor `base`.
    fn window(&self, event: EventId, base: EventId) -> Result<(i64, i64), TooLarge> {
        let place = self.place(base);
        self.path(event, base, (place.earliest.as_micros(), place.latest.as_micros()))
    }

    /// The window of `event` if its ancestor `base` has this one.
    fn path(&self, event: EventId, base: EventId, window: (i64, i64)) -> Result<(i64, i64), TooLarge> {
        let (mut lower, mut upper) = window;
        let mut at = event;
        while at != base {
            let link = self.link(at);
            lower = add(lower, link.lower.as_micros())?;
            upper = add(upper, link.upper.as_micros())?;
            at = link.from;
        }
        Ok((lower, upper))
    }

    fn link(&self, contingent: EventId) -> &'a ContingentLink {
        link_to(self.network, contingent)
    }

    /// Parents are placed before their children.
    fn place(&self, event: EventId) -> Whereabouts {
        match self.places[event.index()] {
            Some(place) => place,
            None => unreachable!("a contingent event is placed after its activation"),
        }
    }

    fn edges(&self, places: &[Whereabouts]) -> Result<(Vec<Edge>, Vec<Source>), ReduceError> {
        let mut edges = Vec::new();
        let mut sources = Vec::new();
        for (node, _) in self.event_of.iter().enumerate().skip(1) {
            edges.push(Edge { from: node as u32, to: 0, weight: -self.now() });
            sources.push(Source::AfterOrigin);
        }
        for (index, requirement) in self.network.requirements().iter().enumerate() {
            for (source, edge) in
                [Source::Upper(index), Source::Lower(index)].into_iter().zip(requirement.edges())
            {
                let Some((from, to, weight)) = edge else { continue };
                let weight = weight.as_micros();
                if let Some(worst) = self.trees.nature_alone(self.network, from, to)? {
                    // Nature alone decides this one. While executing it is not asked again: the plan has proven it, or news
                    // against the model has broken it, and no plan mends that.
                    if worst > weight && self.progress.is_none() {
                        return Err(ReduceError::Never(Violation { source, from, to }));
                    }
                    continue;
                }
                let (from, to) = (places[from.index()], places[to.index()]);
                let weight = add(add(weight, -to.latest.as_micros())?, from.earliest.as_micros())?;
                // Both at the origin: two events of the past.
                if from.node != to.node {
                    edges.push(Edge { from: from.node, to: to.node, weight });
                    sources.push(source);
                }
            }
        }
        Ok((edges, sources))
    }
}
