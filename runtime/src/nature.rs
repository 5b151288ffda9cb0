//! Nature in a simulation: how long contingent links take and how late their news is.

use kirk_network::{Bound, Duration, EventId, Interval, Network, Time};

use crate::knowledge::heard_now;

/// How Nature chooses where the observations given leave a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Temper {
    /// Every duration as long as possible, all news as late as possible (none where that is never).
    #[default]
    Upper,
    /// Every duration as short as possible, all news as early as possible.
    Lower,
    /// Anything possible.
    Random,
}

/// An observation that the model says cannot happen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Impossible {
    /// The event observed.
    pub event: EventId,
    /// When its news was to arrive.
    pub time: Time,
    /// When news of it can arrive at the earliest, the other observations aside.
    pub earliest: Time,
    /// And at the latest; `None` if there is no bound.
    pub latest: Option<Time>,
}

/// What Nature does with one event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deed {
    /// The contingent event.
    pub event: EventId,
    /// When it truly happens.
    pub truth: Time,
    /// When its news arrives, if ever.
    pub observed: Option<Time>,
}

/// All of the model is kept.
const ALL: usize = 0;
/// All of it but the links of what is heard of.
const NOT_THE_HEARD: usize = 1;
/// No more of it than the order.
const ORDER: usize = 2;

/// Decides, for every tree of contingent links, when all its events happen once its root is executed.
#[derive(Debug)]
pub struct Nature<'a> {
    network: &'a Network,
    temper: Temper,
    seed: u64,
    /// News that the model rules out arrives all the same.
    what_if: bool,
    /// For each event, when its news must arrive.
    observations: Vec<Option<Time>>,
    children: Vec<Vec<EventId>>,
    /// Where the observations require each event to be, by how much of the model is kept.
    required: [Vec<Interval>; 3],
    /// Where Nature has put each event.
    truth: Vec<Time>,
}

impl<'a> Nature<'a> {
    /// Nature for a network, with the observations that must come about.
    pub fn new(
        network: &'a Network,
        temper: Temper,
        seed: u64,
        observations: &[(EventId, Time)],
    ) -> Nature<'a> {
        let mut by_event = vec![None; network.events().len()];
        for &(event, time) in observations {
            by_event[event.index()] = Some(time);
        }
        let mut children = vec![Vec::new(); network.events().len()];
        for link in network.contingents() {
            children[link.from.index()].push(link.to);
        }
        let count = network.events().len();
        Nature {
            network,
            temper,
            seed,
            what_if: false,
            observations: by_event,
            children,
            required: std::array::from_fn(|_| vec![Interval::ANYTIME; count]),
            truth: vec![Time::ZERO; count],
        }
    }

    /// Nature who does not keep to the model where the observations do not: what is heard too late took longer, what is heard too early
    /// took less, and news still takes as long as the model says, if that is at all possible.
    pub fn beyond_the_model(self) -> Nature<'a> {
        Nature { what_if: true, ..self }
    }

    /// All that follows from executing `root` at `time`, every event after its activation.
    ///
    /// # Errors
    /// An observation that cannot come about.
    pub fn begin(&mut self, root: EventId, time: Time) -> Result<Vec<Deed>, Impossible> {
        let mut tree: Vec<EventId> = self.children[root.index()].clone();
        let mut at = 0;
        while at < tree.len() {
            tree.extend(&self.children[tree[at].index()]);
            at += 1;
        }
        self.truth[root.index()] = time;
        self.require(&tree, root);
        if let Some(&early) = tree.iter().find(|event| self.required[ORDER][event.index()].latest < time) {
            return Err(self.first_impossible(early, root, time));
        }
        tree.into_iter().map(|event| self.act(event, root, time)).collect()
    }

    /// Where the observations of each event and of all that follows it require it to be. Children come after parents.
    fn require(&mut self, tree: &[EventId], root: EventId) {
        let start = self.truth[root.index()];
        for &event in tree {
            let (told, heard) = (self.told(event), self.observations[event.index()]);
            for kept in [ALL, NOT_THE_HEARD, ORDER] {
                self.required[kept][event.index()] = told;
            }
            // What is heard of sooner than its delay allows has happened by then.
            if let Some(heard) = heard.filter(|_| told.latest < start) {
                self.required[ORDER][event.index()] = Interval::new(Time::MIN, heard);
            }
        }
        for &event in tree.iter().rev() {
            let link = self.link(event);
            let is_heard = self.observations[event.index()].is_some();
            for kept in [ALL, NOT_THE_HEARD, ORDER].into_iter().filter(|_| link.from != root) {
                let here = self.required[kept][event.index()];
                let before = match kept == ALL || kept == NOT_THE_HEARD && !is_heard {
                    true => here.earlier(link.lower, link.upper),
                    false => Interval::new(Time::MIN, here.latest),
                };
                let parent = &mut self.required[kept][link.from.index()];
                *parent = parent.and(before);
            }
        }
    }

    /// Where an event is by its own news alone.
    fn told(&self, event: EventId) -> Interval {
        let observed = self.observations[event.index()];
        observed.map_or(Interval::ANYTIME, |time| heard_now(&self.link(event), time))
    }

    /// Where an event can be: by the model if that goes with all news, else with as much of it as can be kept.
    fn possible(&self, event: EventId) -> Option<Interval> {
        let link = self.link(event);
        let start = self.truth[link.from.index()];
        let by_link = Interval::at(start).later(link.lower, link.upper);
        let required = |kept: usize| self.required[kept][event.index()];
        let within = |other: Interval, kept: usize| {
            Some(required(kept).and(other)).filter(|possible| !possible.is_empty())
        };
        let possible = within(by_link, ALL);
        if !self.what_if {
            return possible;
        }
        let levels = [ALL, NOT_THE_HEARD, ORDER];
        possible.or_else(|| levels.into_iter().find_map(|kept| within(by_link, kept))).or_else(|| {
            // Its own link is broken, no more than it has to be: it happens after what it follows and before it is heard of.
            let after = Interval::new(start, Time::MAX);
            let told = levels.into_iter().find_map(|kept| within(after, kept)).unwrap_or(Interval::at(start));
            Some(Interval::new(told.earliest.max(by_link.earliest.min(told.latest)), told.latest))
        })
    }

    fn act(&mut self, event: EventId, root: EventId, root_time: Time) -> Result<Deed, Impossible> {
        let link = self.link(event);
        let Some(possible) = self.possible(event) else {
            return Err(self.first_impossible(event, root, root_time));
        };
        // Of its own for each event, so that Nature does the same whatever is done first.
        let mut random = fastrand::Rng::with_seed(
            self.seed ^ (u64::from(event.0) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15),
        );
        let truth = match self.temper {
            Temper::Upper => possible.latest,
            Temper::Lower => possible.earliest,
            Temper::Random => any(&mut random, possible),
        };
        self.truth[event.index()] = truth;
        let min = link.delay.min;
        let heard = |max| Interval::at(truth).later(min, max);
        let observed = match (self.observations[event.index()], link.delay.max) {
            (Some(given), _) => Some(given),
            (None, Bound::Finite(max)) => Some(match self.temper {
                Temper::Upper => heard(max).latest,
                Temper::Lower => heard(max).earliest,
                Temper::Random => any(&mut random, heard(max)),
            }),
            (None, Bound::Infinite) => match self.temper {
                Temper::Upper => None,
                Temper::Lower => Some(truth.saturating_add(min)),
                Temper::Random => {
                    let more = link.upper.saturating_mul(2).saturating_add(Duration::from_secs(1));
                    random.bool().then(|| any(&mut random, heard(min.saturating_add(more))))
                }
            },
        };
        Ok(Deed { event, truth, observed })
    }

    fn first_impossible(&self, event: EventId, root: EventId, root_time: Time) -> Impossible {
        let mut open = vec![event];
        let mut first: Option<Impossible> = None;
        while let Some(event) = open.pop() {
            open.extend(&self.children[event.index()]);
            let Some(time) = self.observations[event.index()] else { continue };
            let found = self.impossible(event, time, root, root_time);
            let outside =
                |i: &Impossible| i.time < i.earliest || i.latest.is_some_and(|latest| i.time > latest);
            // An observation that is impossible by itself says more than one that contradicts another.
            if first.as_ref().is_none_or(|first| outside(&found) && !outside(first)) {
                first = Some(found);
            }
        }
        first.unwrap_or(Impossible { event, time: root_time, earliest: root_time, latest: None })
    }

    fn impossible(&self, event: EventId, time: Time, root: EventId, root_time: Time) -> Impossible {
        let delay = self.link(event).delay;
        let mut happens = Interval::at(root_time);
        let mut at = event;
        while at != root {
            let link = self.link(at);
            happens = happens.later(link.lower, link.upper);
            at = link.from;
        }
        let earliest = happens.earliest.saturating_add(delay.min);
        let latest = delay.max.finite().map(|max| happens.latest.saturating_add(max));
        Impossible { event, time, earliest, latest }
    }

    fn link(&self, event: EventId) -> kirk_network::ContingentLink {
        match self.network.link_of(event) {
            Some(link) => self.network.contingents()[link],
            None => unreachable!("only contingent events have children of links followed"),
        }
    }
}

/// Some time of an interval.
fn any(random: &mut fastrand::Rng, Interval { earliest, latest }: Interval) -> Time {
    Time::from_micros(random.i64(earliest.as_micros()..=latest.as_micros()))
}
