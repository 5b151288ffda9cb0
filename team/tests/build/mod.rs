//! Teams written shortly: events with owners, seconds for times.

#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(unreachable_pub, reason = "it is a module of several tests")]
#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use kirk_network::{Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement};
use kirk_team::{Link, Team, TeamError};

/// No bound, or a message that may never come.
pub const NEVER: i64 = i64::MAX;

/// A team in the making; event 0 is the origin.
#[derive(Clone, Debug)]
pub struct Builder {
    pub events: Vec<(String, Option<String>)>,
    pub requirements: Vec<Requirement>,
    pub contingents: Vec<ContingentLink>,
    pub agents: Vec<String>,
    pub links: Vec<Link>,
    /// Microseconds in a unit of time.
    pub unit: i64,
}

pub const ORIGIN: EventId = EventId(0);

impl Builder {
    pub fn new(agents: &[&str]) -> Builder {
        Builder {
            events: vec![("start".to_string(), None)],
            requirements: Vec::new(),
            contingents: Vec::new(),
            agents: agents.iter().map(|name| name.to_string()).collect(),
            links: Vec::new(),
            unit: 1_000_000,
        }
    }

    fn time(&self, units: i64) -> Duration {
        Duration::from_micros(units * self.unit)
    }

    fn bound(&self, units: i64) -> Bound {
        if units.abs() == NEVER { Bound::Infinite } else { Bound::Finite(self.time(units)) }
    }

    /// An executable event of an agent; of nobody if that is empty.
    pub fn event(&mut self, name: &str, owner: &str) -> EventId {
        let owner = (!owner.is_empty()).then(|| owner.to_string());
        self.events.push((name.to_string(), owner));
        EventId(self.events.len() as u32 - 1)
    }

    /// A contingent event and its link.
    pub fn contingent(
        &mut self,
        name: &str,
        owner: &str,
        from: EventId,
        range: [i64; 2],
        delay: [i64; 2],
    ) -> EventId {
        let to = self.event(name, owner);
        let [lower, upper] = range.map(|units| self.time(units));
        let delay = Delay { min: self.time(delay[0]), max: self.bound(delay[1]) };
        self.contingents.push(ContingentLink { from, to, lower, upper, delay });
        to
    }

    pub fn require(&mut self, from: EventId, to: EventId, range: [i64; 2]) {
        let [lower, upper] = range.map(|units| self.bound(units));
        self.requirements.push(Requirement { from, to, lower, upper });
    }

    pub fn link(&mut self, from: &str, to: &str, delay: [i64; 2], one_way: bool) -> &mut Link {
        let delay = Delay { min: self.time(delay[0]), max: self.bound(delay[1]) };
        let [from, to] = [from, to].map(str::to_string);
        self.links.push(Link { from, to, delay, one_way, stamped: false });
        self.links.last_mut().unwrap()
    }

    pub fn network(&self) -> Network {
        let event = |(text, _): &(String, Option<String>)| Event {
            names: [Name { text: text.clone(), internal: false }].into(),
        };
        Network::new(
            "team".to_string(),
            ORIGIN,
            self.events.iter().map(event).collect(),
            self.requirements.clone(),
            self.contingents.clone(),
        )
        .unwrap()
    }

    pub fn build(&self) -> Result<Team, Vec<TeamError>> {
        let owners: Vec<Option<String>> = self.events.iter().map(|(_, owner)| owner.clone()).collect();
        Team::new(self.network(), self.agents.clone(), self.links.clone(), &owners)
    }
}

/// Two events that are to be one moment, after something that ends 3 to 8 s after the start, and within so many seconds of it.
pub fn together(within: i64, news: [i64; 2]) -> Builder {
    let mut b = Builder::new(&["one", "two"]);
    let c = b.contingent("c", "one", ORIGIN, [3, 8], [0, 0]);
    let x = b.event("x1", "one");
    let y = b.event("x2", "two");
    b.require(c, x, [0, within]);
    b.require(c, y, [0, within]);
    b.require(x, y, [0, 0]);
    b.link("one", "two", news, false);
    b
}
