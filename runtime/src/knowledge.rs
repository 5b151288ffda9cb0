//! What is known of each event: when it was fixed and heard, and the interval in which it must have happened.
//!
//! Contingent links form trees whose roots are executable. Once the root is executed, news of one event narrows where
//! the others of its tree can be; one pass up and one pass down the tree find the exact intervals.

use kirk_network::{Bound, ContingentLink, EventId, Network, Time};

use crate::execution::How;

/// What is known of one event.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// When and how the executive fixed it.
    pub fixed: Option<(Time, How)>,
    /// Its place among the events fixed so far.
    pub sequence: u32,
    /// When its news arrived.
    pub observed: Option<Time>,
    /// It is known to have happened: heard, imagined, or implied by news of what follows it.
    pub(crate) settled: bool,
    /// An interval in which it happened, from its own news or from the lack of it.
    pub(crate) evidence: Option<Interval>,
    /// The news contradicts the model: the evidence stands against the link.
    pub(crate) overruled: bool,
}

/// From the earliest to the latest, in microseconds after the origin.
pub(crate) type Interval = (i64, i64);

const ANYTIME: Interval = (i64::MIN, i64::MAX);

/// All that is known.
#[derive(Clone, Debug)]
pub(crate) struct Knowledge {
    events: Vec<Known>,
    fixed: u32,
    /// For each event its root, and for each root the contingent events of its tree, every one after its parent.
    root: Vec<EventId>,
    trees: Vec<Vec<EventId>>,
    /// The number of an event in its tree.
    number: Vec<u32>,
    /// The events of which something has become known since that was last asked.
    touched: Vec<EventId>,
}

impl Knowledge {
    /// Nothing is known yet.
    pub(crate) fn new(network: &Network) -> Knowledge {
        let count = network.events().len();
        let mut children: Vec<Vec<EventId>> = vec![Vec::new(); count];
        for link in network.contingents() {
            children[link.from.index()].push(link.to);
        }
        let mut root: Vec<EventId> = network.event_ids().collect();
        let mut trees = vec![Vec::new(); count];
        let mut number = vec![0; count];
        for event in network.event_ids().filter(|&event| network.link_of(event).is_none()) {
            let tree: &mut Vec<EventId> = &mut trees[event.index()];
            tree.extend(&children[event.index()]);
            let mut at = 0;
            while at < tree.len() {
                let member = tree[at];
                root[member.index()] = event;
                number[member.index()] = at as u32;
                tree.extend(&children[member.index()]);
                at += 1;
            }
        }
        let events = vec![Known::default(); count];
        Knowledge { events, fixed: 0, root, trees, number, touched: Vec::new() }
    }

    pub(crate) fn of(&self, event: EventId) -> &Known {
        &self.events[event.index()]
    }

    /// The one way to change what is known.
    fn change(&mut self, event: EventId) -> &mut Known {
        self.touched.push(event);
        &mut self.events[event.index()]
    }

    /// The events of which something has become known since this was last asked.
    pub(crate) fn take_touched(&mut self) -> Vec<EventId> {
        std::mem::take(&mut self.touched)
    }

    /// What was known of an event is known again.
    pub(crate) fn recall(&mut self, event: EventId, known: Known) {
        self.fixed = self.fixed.max(known.fixed.map_or(0, |_| known.sequence + 1));
        self.events[event.index()] = known;
    }

    pub(crate) fn root(&self, event: EventId) -> EventId {
        self.root[event.index()]
    }

    /// The contingent events of the tree of links that a contingent event belongs to.
    pub(crate) fn tree(&self, event: EventId) -> &[EventId] {
        &self.trees[self.root[event.index()].index()]
    }

    /// Fixes an event; false if it is fixed already.
    pub(crate) fn fix(&mut self, event: EventId, time: i64, how: How) -> bool {
        if self.of(event).fixed.is_some() {
            return false;
        }
        let sequence = self.fixed;
        let known = self.change(event);
        known.fixed = Some((Time::from_micros(time), how));
        known.sequence = sequence;
        self.fixed += 1;
        true
    }

    pub(crate) fn hear(&mut self, event: EventId, now: i64) {
        self.change(event).observed = Some(Time::from_micros(now));
    }

    /// The event happened in this interval, as far as its own news or silence tells.
    pub(crate) fn add_evidence(&mut self, event: EventId, (low, high): Interval) {
        let known = self.change(event);
        let before = known.evidence.unwrap_or(ANYTIME);
        known.evidence = Some((before.0.max(low), before.1.min(high)));
        known.settled = true;
    }

    /// The event happened in this interval, whatever the model says.
    pub(crate) fn overrule(&mut self, event: EventId, evidence: Interval) {
        let known = self.change(event);
        known.evidence = Some(evidence);
        known.settled = true;
        known.overruled = true;
    }

    /// How far the execution has got, for planning what is left of it: when our events were executed, and the intervals in
    /// which Nature's happened that are known to have.
    pub(crate) fn progress(&mut self, network: &Network) -> Vec<Option<(Time, Time)>> {
        self.settle_ancestors(network);
        let happened = self.all_happened(network);
        let known = network.event_ids().map(|event| match (network.link_of(event), self.of(event)) {
            (None, known) => known.fixed.map(|(time, _)| (time, time)),
            (Some(_), known) if known.settled => {
                happened[event.index()].map(|(low, high)| (Time::from_micros(low), Time::from_micros(high)))
            }
            _ => None,
        });
        known.collect()
    }

    /// What follows an event that happened has to be preceded by it: its ancestors happened too.
    fn settle_ancestors(&mut self, network: &Network) {
        for at in 0..self.events.len() as u32 {
            let mut event = EventId(at);
            while self.events[event.index()].settled
                && let Some(link) = network.link_of(event)
            {
                event = network.contingents()[link].from;
                if network.link_of(event).is_none() || self.events[event.index()].settled {
                    break;
                }
                self.change(event).settled = true;
            }
        }
    }

    /// The interval in which an event happened or will happen; `None` while its tree has not begun.
    pub(crate) fn happened(&self, network: &Network, event: EventId) -> Option<Interval> {
        let root = self.root[event.index()];
        let start = self.of(root).fixed?.0.as_micros();
        if event == root {
            return Some((start, start));
        }
        Some(self.intervals(network, root, start)[self.number[event.index()] as usize])
    }

    /// When news of a contingent event comes at the latest, by the model and whatever else was heard; `None` if it may never, or
    /// its tree has not begun.
    pub(crate) fn news_by(&self, network: &Network, event: EventId) -> Option<Time> {
        let mut latest = link_to(network, event).delay.max.finite()?;
        let (mut at, root) = (event, self.root[event.index()]);
        while at != root {
            let link = link_to(network, at);
            latest = latest.checked_add(link.upper)?;
            at = link.from;
        }
        self.of(root).fixed?.0.checked_add(latest)
    }

    /// The same for all events.
    pub(crate) fn all_happened(&self, network: &Network) -> Vec<Option<Interval>> {
        let mut all = vec![None; self.events.len()];
        for root in network.event_ids().filter(|&event| self.root[event.index()] == event) {
            let Some((start, _)) = self.of(root).fixed else { continue };
            let start = start.as_micros();
            all[root.index()] = Some((start, start));
            for (event, interval) in self.trees[root.index()].iter().zip(self.intervals(network, root, start))
            {
                all[event.index()] = Some(interval);
            }
        }
        all
    }

    /// The intervals of the contingent events of a tree that began at `start`.
    fn intervals(&self, network: &Network, root: EventId, start: i64) -> Vec<Interval> {
        let tree = &self.trees[root.index()];
        let link = |event: EventId| link_to(network, event);
        // Up: what the evidence of an event and of all that follows it allows.
        let mut allowed: Vec<Interval> =
            tree.iter().map(|event| self.of(*event).evidence.unwrap_or(ANYTIME)).collect();
        for at in (0..tree.len()).rev() {
            let ContingentLink { from, lower, upper, .. } = *link(tree[at]);
            if from != root && !self.of(tree[at]).overruled {
                let (low, high) = allowed[at];
                let parent = &mut allowed[self.number[from.index()] as usize];
                parent.0 = parent.0.max(low.saturating_sub(upper.as_micros()));
                parent.1 = parent.1.min(high.saturating_sub(lower.as_micros()));
            }
        }
        // Down: what the parent and the link allow of that.
        for at in 0..tree.len() {
            let ContingentLink { from, lower, upper, .. } = *link(tree[at]);
            let (low, high) =
                if from == root { (start, start) } else { allowed[self.number[from.index()] as usize] };
            let here = &mut allowed[at];
            if self.of(tree[at]).overruled {
                // All that is left of the model: it did not happen before what it follows.
                here.0 = here.0.max(low).min(here.1);
                continue;
            }
            here.0 = here.0.max(low.saturating_add(lower.as_micros()));
            here.1 = here.1.min(high.saturating_add(upper.as_micros()));
        }
        allowed
    }
}

/// The interval in which an event happened if its news arrives now.
pub(crate) fn heard_now(link: &ContingentLink, now: i64) -> Interval {
    let earliest = match link.delay.max {
        Bound::Finite(max) => now.saturating_sub(max.as_micros()),
        Bound::Infinite => i64::MIN,
    };
    (earliest, now.saturating_sub(link.delay.min.as_micros()))
}

/// The interval in which an event happened whose news the model rules out, if its activation happened in another: what the
/// news proves, if either the duration or the delay was other than the model says and nobody knows which.
pub(crate) fn heard_against(link: &ContingentLink, activation: Interval, now: i64) -> Interval {
    let (low, high) = heard_now(link, now);
    let earliest = activation.0.saturating_add(link.lower.as_micros());
    let latest = activation.1.saturating_add(link.upper.as_micros());
    if latest < low {
        // It took longer, or the news did.
        return (earliest, high);
    }
    // It took less, or the news did. It was after it had begun in any case, and before it was heard of.
    let low = low.max(activation.0).min(now);
    let high = if now >= earliest || high < low { now } else { high };
    (low, high)
}

fn link_to(network: &Network, event: EventId) -> &ContingentLink {
    match network.link_of(event) {
        Some(link) => &network.contingents()[link],
        None => unreachable!("trees hold contingent events only"),
    }
}
