//! The delay STNU: events, requirements, contingent links, observation delays.
//!
//! Thesis of C. Pittman (MIT, 2023), definitions 5 and 16; N. Bhargava, C. Muise, B. Williams, *Variable-delay
//! controllability*, IJCAI 2018. A [`Network`] is valid by construction: [`Network::new`] is the only way to one.

use std::fmt;
use std::sync::Arc;

use crate::time::{Bound, Duration};

/// An event of a network, an index into [`Network::events`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EventId(pub u32);

impl EventId {
    /// The position in [`Network::events`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A time point with all the names it goes by. The first name is its id; several names come from merging.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// At least one name. Networks are copied again and again to be asked about, and their names are not.
    pub names: Arc<[Name]>,
}

impl Event {
    /// The names to show: those a user wrote, or all if there are none.
    pub fn shown_names(&self) -> impl Iterator<Item = &str> {
        let written = self.names.iter().any(|name| !name.internal);
        self.names.iter().filter(move |name| !(written && name.internal)).map(|name| name.text.as_str())
    }
}

/// One name of an event, in lower case: `shower:start`, or `main.1:start` for an event no user wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The name itself.
    pub text: String,
    /// True for the events of forms a user gave no name (`sequence`, `parallel`, ...).
    pub internal: bool,
}

/// `lower <= to - from <= upper`; that is the edges `from -> to` of weight `upper` and `to -> from` of weight `-lower`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// The event the interval is measured from.
    pub from: EventId,
    /// The event it is measured to.
    pub to: EventId,
    /// `Infinite` is minus infinity here.
    pub lower: Bound,
    /// `Infinite` is plus infinity here.
    pub upper: Bound,
}

impl Requirement {
    /// True if it says that its events are one.
    pub fn is_join(&self) -> bool {
        (self.lower, self.upper) == (Bound::ZERO, Bound::ZERO)
    }

    /// What it says as edges `(a, b, weight)` of a distance graph, `b - a <= weight`: that of the upper bound, then that of
    /// the lower one; `None` for a bound that is infinite.
    pub fn edges(&self) -> [Option<(EventId, EventId, Duration)>; 2] {
        let upper = self.upper.finite().map(|upper| (self.from, self.to, upper));
        let lower = self.lower.finite().map(|lower| (self.to, self.from, -lower));
        [upper, lower]
    }
}

/// Nature picks `to - from` in `[lower, upper]`, `0 <= lower <= upper`, and lets it be known after a delay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContingentLink {
    /// The activation: executable, or the end of another link (a chain).
    pub from: EventId,
    /// The contingent event. Every contingent event ends exactly one link.
    pub to: EventId,
    /// The shortest duration.
    pub lower: Duration,
    /// The longest duration.
    pub upper: Duration,
    /// How late the news of `to` may be.
    pub delay: Delay,
}

/// The observation delay: news of an event at `t` arrives in `[t + min, t + max]`; it does not say when that was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Delay {
    /// The shortest delay, not negative.
    pub min: Duration,
    /// The longest delay; `Infinite` if the news may never come.
    pub max: Bound,
}

impl Delay {
    /// Observed the moment it happens.
    pub const NONE: Delay = Delay { min: Duration::ZERO, max: Bound::ZERO };
}

/// A delay STNU. Valid: names are unique, every contingent event ends one link, links form no cycle, bounds are in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Network {
    name: String,
    origin: EventId,
    events: Arc<[Event]>,
    requirements: Vec<Requirement>,
    contingents: Vec<ContingentLink>,
    /// For every event, the index of the contingent link that ends there.
    link_of: Vec<Option<u32>>,
}

impl Network {
    /// Builds a network, or says everything that is wrong with its parts.
    ///
    /// The origin is executed first, at time 0; no executable event comes before it, whether or not a requirement says so.
    pub fn new(
        name: String,
        origin: EventId,
        events: Vec<Event>,
        requirements: Vec<Requirement>,
        contingents: Vec<ContingentLink>,
    ) -> Result<Network, Vec<ModelError>> {
        let errors = faults_of_names(&events);
        Network::valid(name, origin, events, requirements, contingents, errors)
    }

    /// The same for events whose names are those of a valid network, shared out anew: they are not looked at again.
    pub(crate) fn with_known_names(
        name: String,
        origin: EventId,
        events: Vec<Event>,
        requirements: Vec<Requirement>,
        contingents: Vec<ContingentLink>,
    ) -> Result<Network, Vec<ModelError>> {
        debug_assert_eq!(faults_of_names(&events), []);
        Network::valid(name, origin, events, requirements, contingents, Vec::new())
    }

    /// The network, if neither these errors nor others are found.
    fn valid(
        name: String,
        origin: EventId,
        events: impl Into<Arc<[Event]>>,
        requirements: Vec<Requirement>,
        contingents: Vec<ContingentLink>,
        mut errors: Vec<ModelError>,
    ) -> Result<Network, Vec<ModelError>> {
        let events = events.into();
        let link_of = vec![None; events.len()];
        let mut network = Network { name, origin, link_of, events, requirements, contingents };
        network.validate(&mut errors);
        if errors.is_empty() { Ok(network) } else { Err(errors) }
    }

    /// The name of the network.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The event executed first, at time 0.
    pub fn origin(&self) -> EventId {
        self.origin
    }

    /// All events; an [`EventId`] is an index into this.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// All requirements, in the order they were given.
    pub fn requirements(&self) -> &[Requirement] {
        &self.requirements
    }

    /// All contingent links, in the order they were given.
    pub fn contingents(&self) -> &[ContingentLink] {
        &self.contingents
    }

    /// The index of the contingent link that ends in `event`, `None` if the event is executable.
    pub fn link_of(&self, event: EventId) -> Option<usize> {
        self.link_of[event.index()].map(|link| link as usize)
    }

    /// A requirement to vary. Its ends must stay, and no event may be joined or parted by it in what was merged.
    pub(crate) fn requirement_mut(&mut self, index: usize) -> &mut Requirement {
        &mut self.requirements[index]
    }

    /// A contingent link to vary. Its ends must stay.
    pub(crate) fn link_mut(&mut self, index: usize) -> &mut ContingentLink {
        &mut self.contingents[index]
    }

    /// One more requirement between events of this network; its index.
    pub(crate) fn require(&mut self, requirement: Requirement) -> usize {
        self.requirements.push(requirement);
        self.requirements.len() - 1
    }

    /// Takes the last requirement out again.
    pub(crate) fn forget_last_requirement(&mut self) {
        self.requirements.pop();
    }

    /// Makes the event at the end of a link ours: the link ends in a new event, the last, which nothing else is about.
    pub(crate) fn take_over_end(&mut self, link: usize) {
        let ours = self.contingents[link].to;
        let taken = |text: &str| self.events.iter().any(|event| event.names.iter().any(|it| it.text == text));
        let mut text = format!("{}'", self.id(ours));
        while taken(&text) {
            text.push('\'');
        }
        let event = Event { names: [Name { text, internal: true }].into() };
        let new = EventId(self.events.len() as u32);
        self.events = self.events.iter().cloned().chain([event]).collect();
        self.contingents[link].to = new;
        self.link_of[ours.index()] = None;
        self.link_of.push(Some(link as u32));
    }

    /// The same events with other constraints.
    ///
    /// # Errors
    /// Everything that is wrong with those.
    pub fn with(
        &self,
        requirements: Vec<Requirement>,
        contingents: Vec<ContingentLink>,
    ) -> Result<Network, Vec<ModelError>> {
        let (name, events) = (self.name.clone(), self.events.clone());
        Network::valid(name, self.origin, events, requirements, contingents, Vec::new())
    }

    /// The ids of all events, in order.
    pub fn event_ids(&self) -> impl Iterator<Item = EventId> + use<> {
        (0..self.events.len() as u32).map(EventId)
    }

    /// The first name of an event.
    pub fn id(&self, event: EventId) -> &str {
        &self.events[event.index()].names[0].text
    }

    /// The names of an event that a user wrote.
    pub fn written(&self, event: EventId) -> impl Iterator<Item = &str> {
        let names = self.events[event.index()].names.iter();
        names.filter(|name| !name.internal).map(|name| name.text.as_str())
    }

    /// The name to show for an event: the first a user wrote, else the first.
    pub fn label(&self, event: EventId) -> &str {
        self.written(event).next().unwrap_or(self.id(event))
    }

    /// The event a name means, whichever of its names it is: as written, else in any case, else in the original's
    /// spelling `+SHOWER::START+`.
    pub fn find(&self, name: &str) -> Option<EventId> {
        let position = |matches: &dyn Fn(&str) -> bool| {
            self.events.iter().position(|event| event.names.iter().any(|n| matches(&n.text)))
        };
        let wanted = normal_name(name);
        position(&|text| text == name)
            .or_else(|| position(&|text| text.to_lowercase() == wanted))
            .map(|index| EventId(index as u32))
    }

    /// Finds what is wrong with anything but the names, and fills in `link_of`.
    fn validate(&mut self, errors: &mut Vec<ModelError>) {
        let count = self.events.len() as u32;
        let known = |event: EventId| event.0 < count;
        if !known(self.origin) {
            errors.push(ModelError::UnknownEvent);
            return;
        }
        for (index, requirement) in self.requirements.iter().enumerate() {
            if !known(requirement.from) || !known(requirement.to) {
                errors.push(ModelError::UnknownEvent);
                return;
            }
            if let (Bound::Finite(lower), Bound::Finite(upper)) = (requirement.lower, requirement.upper)
                && lower > upper
            {
                errors.push(ModelError::RequirementReversed { index, lower, upper });
            }
        }
        for (index, link) in self.contingents.iter().enumerate() {
            if !known(link.from) || !known(link.to) {
                errors.push(ModelError::UnknownEvent);
                return;
            }
            if link.lower < Duration::ZERO || link.upper < link.lower {
                errors.push(ModelError::LinkBounds { index, lower: link.lower, upper: link.upper });
            }
            let late = link.delay.max.finite().is_some_and(|max| max < link.delay.min);
            if link.delay.min < Duration::ZERO || late {
                errors.push(ModelError::DelayBounds { index, min: link.delay.min, max: link.delay.max });
            }
            if link.to == self.origin {
                errors.push(ModelError::ContingentOrigin { index });
            }
            match &mut self.link_of[link.to.index()] {
                Some(_) => errors
                    .push(ModelError::TwoLinksEndThere { index, event: self.label(link.to).to_string() }),
                slot => *slot = Some(index as u32),
            }
        }
        if errors.is_empty()
            && let Some(event) = self.link_cycle()
        {
            errors.push(ModelError::LinkCycle { event: self.label(event).to_string() });
        }
    }

    /// An event on a cycle of contingent links, if there is one.
    fn link_cycle(&self) -> Option<EventId> {
        // 0: not seen, 1: on the walk in progress, 2: known to lead to an executable event.
        let mut state = vec![0_u8; self.events.len()];
        let mut walk = Vec::new();
        for start in self.event_ids() {
            let mut event = start;
            while state[event.index()] == 0 {
                state[event.index()] = 1;
                walk.push(event);
                match self.link_of(event) {
                    Some(link) => event = self.contingents[link].from,
                    None => break,
                }
            }
            if state[event.index()] == 1 && self.link_of(event).is_some() {
                return Some(event);
            }
            for event in walk.drain(..) {
                state[event.index()] = 2;
            }
        }
        None
    }
}

/// Every event has a name, and no two names are the same.
fn faults_of_names(events: &[Event]) -> Vec<ModelError> {
    let mut errors = Vec::new();
    let mut names: Vec<&str> =
        events.iter().flat_map(|event| &*event.names).map(|name| name.text.as_str()).collect();
    names.sort_unstable();
    let mut reported = None;
    for pair in names.windows(2) {
        if pair[0] == pair[1] && reported != Some(pair[0]) {
            reported = Some(pair[0]);
            errors.push(ModelError::DuplicateName(pair[0].to_string()));
        }
    }
    if events.iter().any(|event| event.names.is_empty()) {
        errors.push(ModelError::Nameless);
    }
    errors
}

/// The lower-case form of an event name: `+SHOWER::START+` and `Shower:Start` are `shower:start`, `+Z+` is `z`.
pub fn normal_name(name: &str) -> String {
    let bare = name.strip_prefix('+').and_then(|rest| rest.strip_suffix('+')).filter(|bare| !bare.is_empty());
    match bare {
        Some(bare) => bare.replacen("::", ":", 1).to_lowercase(),
        None => name.to_lowercase(),
    }
}

/// Why parts do not make a network. `index` counts requirements or contingent links from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelError {
    /// An event id is out of range.
    UnknownEvent,
    /// An event has no name.
    Nameless,
    /// Two events, or one event twice, go by this name.
    DuplicateName(String),
    /// A requirement's lower bound is above its upper bound.
    RequirementReversed {
        /// Which requirement.
        index: usize,
        /// Its lower bound.
        lower: Duration,
        /// Its upper bound.
        upper: Duration,
    },
    /// A link's bounds are not `0 <= lower <= upper`.
    LinkBounds {
        /// Which link.
        index: usize,
        /// Its lower bound.
        lower: Duration,
        /// Its upper bound.
        upper: Duration,
    },
    /// A delay is not `0 <= min <= max`.
    DelayBounds {
        /// Which link.
        index: usize,
        /// The shortest delay.
        min: Duration,
        /// The longest delay.
        max: Bound,
    },
    /// The origin ends a contingent link.
    ContingentOrigin {
        /// Which link.
        index: usize,
    },
    /// A second contingent link ends in the same event.
    TwoLinksEndThere {
        /// The second link.
        index: usize,
        /// The event.
        event: String,
    },
    /// Contingent links lead in a circle.
    LinkCycle {
        /// An event on the circle.
        event: String,
    },
}

impl ModelError {
    /// The number of the requirement that is wrong.
    pub fn requirement(&self) -> Option<usize> {
        if let ModelError::RequirementReversed { index, .. } = self { Some(*index) } else { None }
    }

    /// The number of the contingent link that is wrong.
    pub fn link(&self) -> Option<usize> {
        match self {
            ModelError::LinkBounds { index, .. }
            | ModelError::DelayBounds { index, .. }
            | ModelError::ContingentOrigin { index }
            | ModelError::TwoLinksEndThere { index, .. } => Some(*index),
            _ => None,
        }
    }

    /// What is wrong, without the number that means nothing to the author of some files.
    pub fn what(&self) -> String {
        match self {
            ModelError::UnknownEvent => {
                "a constraint or the origin names an event that does not exist".to_string()
            }
            ModelError::Nameless => "an event has no name".to_string(),
            ModelError::DuplicateName(name) => format!("the event name `{name}` is used twice"),
            ModelError::RequirementReversed { lower, upper, .. } => {
                format!("the lower bound {lower} is above the upper bound {upper}")
            }
            ModelError::LinkBounds { lower, upper, .. } if lower > upper && *lower >= Duration::ZERO => {
                format!(
                    "the lower bound {lower} is above the upper bound {upper}: Nature has no duration to choose from. \
                     Only what is required may contradict itself: two requirements in `.json`, two ordinary edges in \
                     `.stnu` and `.plainstnu`"
                )
            }
            ModelError::LinkBounds { lower, upper, .. } => format!(
                "the bounds [{lower}, {upper}] are not 0 <= lower <= upper; Nature needs a duration to choose from"
            ),
            ModelError::DelayBounds { min, max: Bound::Finite(max), .. } => {
                format!("the delay [{min}, {max}] is not 0 <= min <= max")
            }
            ModelError::DelayBounds { min, .. } => format!("the shortest delay {min} is negative"),
            ModelError::ContingentOrigin { .. } => {
                "the link ends in the origin, which is executed first".to_string()
            }
            ModelError::TwoLinksEndThere { event, .. } => {
                format!("`{event}` already ends another contingent link; an event happens once")
            }
            ModelError::LinkCycle { event } => {
                format!(
                    "the contingent links lead from `{event}` back to itself: none of them could ever start"
                )
            }
        }
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(index) = self.requirement() {
            write!(f, "requirements[{index}]: ")?;
        }
        if let Some(index) = self.link() {
            write!(f, "contingents[{index}]: ")?;
        }
        f.write_str(&self.what())
    }
}

impl std::error::Error for ModelError {}
