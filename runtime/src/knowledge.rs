//! What is known of each event: when it was fixed and heard, and the interval in which it must have happened.
//!
//! Contingent links form trees whose roots are executable. Once the root is executed, news of one event narrows where
//! the others of its tree can be; one pass up and one pass down the tree find the exact intervals.

use kirk_network::{ContingentLink, EventId, Interval, Network, Time};
use serde::{Deserialize, Serialize};

use crate::checkpoint::micros;
use crate::execution::How;

/// What is known of one event. The names and the order of its fields are what checkpoints are written with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// When and how the executive fixed it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed: Option<Fixed>,
    /// When its news arrived.
    #[serde(default, with = "micros", skip_serializing_if = "Option::is_none")]
    pub observed: Option<Time>,
    /// Where it happened, by its own news or by the lack of it. There is no such time if they contradict each other.
    #[serde(default, with = "micros", skip_serializing_if = "Option::is_none")]
    pub(crate) evidence: Option<Interval>,
    /// It is known to have happened: heard, imagined, or implied by news of what follows it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) settled: bool,
    /// The news contradicts the model: the evidence stands against the link.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) overruled: bool,
}

/// When and how an event was fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "(i64, How, u32)", into = "(i64, How, u32)")]
pub struct Fixed {
    /// When.
    pub time: Time,
    /// How.
    pub how: How,
    /// Its place among the events fixed so far.
    pub sequence: u32,
}

impl From<(i64, How, u32)> for Fixed {
    fn from((time, how, sequence): (i64, How, u32)) -> Fixed {
        Fixed { time: Time::from_micros(time), how, sequence }
    }
}

impl From<Fixed> for (i64, How, u32) {
    fn from(Fixed { time, how, sequence }: Fixed) -> (i64, How, u32) {
        (time.as_micros(), how, sequence)
    }
}

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
        self.fixed = self.fixed.max(known.fixed.map_or(0, |fixed| fixed.sequence + 1));
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
    pub(crate) fn fix(&mut self, event: EventId, time: Time, how: How) -> bool {
        if self.of(event).fixed.is_some() {
            return false;
        }
        let sequence = self.fixed;
        self.change(event).fixed = Some(Fixed { time, how, sequence });
        self.fixed += 1;
        true
    }

    pub(crate) fn hear(&mut self, event: EventId, now: Time) {
        self.change(event).observed = Some(now);
    }

    /// The event happened in this interval, as far as its own news or silence tells.
    pub(crate) fn add_evidence(&mut self, event: EventId, evidence: Interval) {
        let known = self.change(event);
        known.evidence = Some(known.evidence.unwrap_or(Interval::ANYTIME).and(evidence));
        known.settled = true;
    }

    /// News of an event arrived that the model rules out: the event happened when its delay or its link says, one of which is wrong;
    /// or as both say, and what follows it did not. False if what it follows has not happened.
    pub(crate) fn hear_against(&mut self, network: &Network, event: EventId, arrived: Time) -> bool {
        let link = link_to(network, event);
        let heard = heard_now(link, arrived);
        let activation = |knowledge: &Knowledge| knowledge.happened(network, link.from);
        let Some(before) = activation(self) else { return false };
        self.hear(event, arrived);
        let own = before.later(link.lower, link.upper).and(heard);
        if !own.is_empty() {
            self.break_links_after(network, event, own);
            self.add_evidence(event, heard);
            return true;
        }
        // By its delay it happened no later than this, or its delay is wrong and it happened by now: what it follows is before both.
        let start = self.of(self.root(event)).fixed.map_or(arrived, |fixed| fixed.time);
        self.happened_by(network, link.from, heard.latest.max(start), arrived);
        let evidence = heard_against(link, activation(self).unwrap_or(before), arrived);
        self.overrule(event, evidence);
        true
    }

    /// An event happened in an interval; the links from it that do not go with that are broken.
    fn break_links_after(&mut self, network: &Network, event: EventId, within: Interval) {
        for child in self.tree(event).to_vec() {
            let ContingentLink { from, lower, upper, .. } = *link_to(network, child);
            let Some(known) = self.happened(network, child).filter(|_| from == event) else { continue };
            if known.earlier(lower, upper).and(within).is_empty() {
                self.overrule(child, Interval::new(known.earliest.min(within.earliest), known.latest));
            }
        }
    }

    /// True if the model rules out news of an event that arrives now: by when it happened, or can have by now, and how late it is
    /// heard.
    pub(crate) fn rules_out(&self, network: &Network, event: EventId, now: Time) -> bool {
        let evidence = heard_now(link_to(network, event), now);
        self.happened(network, event)
            .is_none_or(|before| before.and(evidence).is_empty() || before.earliest > now)
    }

    /// An event may have happened by a time already, whatever the model says, and has by now, and so has all that it follows.
    fn happened_by(&mut self, network: &Network, event: EventId, time: Time, now: Time) {
        let Some(within) = self.happened(network, event) else { return };
        if event == self.root(event) || within.earliest <= time {
            return;
        }
        let from = link_to(network, event).from;
        self.happened_by(network, from, time, now);
        let earliest = self.happened(network, from).map_or(time, |within| within.earliest);
        self.overrule(event, Interval::new(earliest, within.latest.min(now)));
    }

    /// The event happened in this interval, whatever the model says.
    fn overrule(&mut self, event: EventId, evidence: Interval) {
        let known = self.change(event);
        known.evidence = Some(evidence);
        known.settled = true;
        known.overruled = true;
    }

    /// How far the execution has got, for planning what is left of it: when our events were executed, and the intervals in
    /// which Nature's happened that are known to have.
    pub(crate) fn progress(&mut self, network: &Network) -> Vec<Option<Interval>> {
        self.settle_ancestors(network);
        let happened = self.all_happened(network);
        let known = network.event_ids().map(|event| match (network.link_of(event), self.of(event)) {
            (None, known) => known.fixed.map(|fixed| Interval::at(fixed.time)),
            (Some(_), known) if known.settled => happened[event.index()],
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
        let start = self.of(root).fixed?.time;
        if event == root {
            return Some(Interval::at(start));
        }
        Some(self.intervals(network, root, start)[self.number[event.index()] as usize])
    }

    /// When news of a contingent event comes at the latest, by the model and whatever else was heard; `None` if it may never, or
    /// its tree has not begun.
    pub(crate) fn observed_by(&self, network: &Network, event: EventId) -> Option<Time> {
        let mut latest = link_to(network, event).delay.max.finite()?;
        let (mut at, root) = (event, self.root[event.index()]);
        while at != root {
            let link = link_to(network, at);
            latest = latest.checked_add(link.upper)?;
            at = link.from;
        }
        self.of(root).fixed?.time.checked_add(latest)
    }

    /// The same for all events.
    pub(crate) fn all_happened(&self, network: &Network) -> Vec<Option<Interval>> {
        let mut all = vec![None; self.events.len()];
        for root in network.event_ids().filter(|&event| self.root[event.index()] == event) {
            let Some(Fixed { time: start, .. }) = self.of(root).fixed else { continue };
            all[root.index()] = Some(Interval::at(start));
            for (event, interval) in self.trees[root.index()].iter().zip(self.intervals(network, root, start))
            {
                all[event.index()] = Some(interval);
            }
        }
        all
    }

    /// The intervals of the contingent events of a tree that began at `start`.
    ///
    /// Of a link that is broken the order is left, and so it is of the links above it: which of them is broken nobody knows.
    fn intervals(&self, network: &Network, root: EventId, start: Time) -> Vec<Interval> {
        let tree = &self.trees[root.index()];
        let link = |event: EventId| link_to(network, event);
        // Up: what the evidence of an event and of all that follows it allows, and by when it was before what follows it.
        let evidence = tree.iter().map(|&event| self.of(event).evidence.unwrap_or(Interval::ANYTIME));
        let mut allowed: Vec<Interval> = evidence.collect();
        let mut by = vec![Time::MAX; tree.len()];
        let mut is_broken = false;
        for at in (0..tree.len()).rev() {
            let ContingentLink { from, lower, upper, .. } = *link(tree[at]);
            let parent = self.number[from.index()] as usize;
            let overruled = self.of(tree[at]).overruled;
            is_broken |= overruled;
            if from != root {
                by[parent] = by[parent].min(by[at]);
                match overruled {
                    true => by[parent] = by[parent].min(allowed[at].latest),
                    false => allowed[parent] = allowed[parent].and(allowed[at].earlier(lower, upper)),
                }
            }
        }
        // Down: what the parent and the link allow of that.
        for at in 0..tree.len() {
            let ContingentLink { from, lower, upper, .. } = *link(tree[at]);
            let parent =
                if from == root { Interval::at(start) } else { allowed[self.number[from.index()] as usize] };
            let here = Interval::new(allowed[at].earliest, allowed[at].latest.min(by[at]));
            let model = parent.later(lower, upper);
            let by_link = here.and(model);
            allowed[at] = if self.of(tree[at]).overruled {
                Interval::new(here.earliest.max(parent.earliest).min(here.latest), here.latest)
            } else if is_broken && by_link.is_empty() {
                // As near to the model as it can be.
                let earliest = here.earliest.max(parent.earliest).min(here.latest);
                Interval::new(earliest, here.latest.min(model.latest.max(earliest)))
            } else {
                by_link
            };
        }
        allowed
    }
}

/// The interval in which an event happened if its news arrives now.
pub(crate) fn heard_now(link: &ContingentLink, now: Time) -> Interval {
    let earliest = link.delay.max.finite().map_or(Time::MIN, |max| now.saturating_sub(max));
    Interval::new(earliest, now.saturating_sub(link.delay.min))
}

/// The interval in which an event happened whose news the model rules out, if its activation happened in another: what the
/// news proves, if either the duration or the delay was other than the model says and nobody knows which.
fn heard_against(link: &ContingentLink, activation: Interval, now: Time) -> Interval {
    let heard = heard_now(link, now);
    let by_link = activation.later(link.lower, link.upper);
    if by_link.latest < heard.earliest {
        // It took longer, or the news did.
        return Interval::new(by_link.earliest, heard.latest);
    }
    // It took less, or the news did. It was after it had begun in any case, and before it was heard of.
    let earliest = heard.earliest.max(activation.earliest).min(now);
    let latest = if now >= by_link.earliest || heard.latest < earliest { now } else { heard.latest };
    Interval::new(earliest, latest)
}

fn link_to(network: &Network, event: EventId) -> &ContingentLink {
    match network.link_of(event) {
        Some(link) => &network.contingents()[link],
        None => unreachable!("trees hold contingent events only"),
    }
}
