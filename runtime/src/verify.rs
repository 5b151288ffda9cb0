//! The independent verifier: does a recorded execution keep every requirement of a network?
//!
//! It knows nothing of the dispatcher. From the record it takes when executable events were dispatched and when news
//! arrived; what contingent events did follows from the network. A requirement holds if it holds in every course of
//! Nature that agrees with the news (or in the one that is recorded as true). Events without a row (those no user
//! wrote) are ours: it is enough that there are times for them.

use std::collections::{BTreeMap, VecDeque};

use kirk_network::merge::merge;
use kirk_network::precedence::{precedence, written_pairs};
use kirk_network::{Duration, EventId, Interval, Network, Time};

use crate::execution::{Execution, FORMAT, How, Outcome, Row};

/// What must come so long before something else goes round in a circle: no sum of bounds is as long.
const FAR: Duration = Duration::from_micros(1 << 61);

/// Something in the record that contradicts the network. Worded for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The event it is about, if it is about one.
    pub event: Option<String>,
    /// What is wrong, with the numbers.
    pub message: String,
}

/// What of a network does not hold in every course of Nature that agrees with what was heard, though it held in the one that is
/// recorded as true: the execution was lucky. Empty for a record that is wrong in itself.
pub fn lucky(network: &Network, execution: &Execution) -> Vec<Violation> {
    if execution.rows.iter().all(|row| row.truth.is_none()) || !verify(network, execution).is_empty() {
        return Vec::new();
    }
    let mut heard = execution.clone();
    heard.rows.iter_mut().for_each(|row| row.truth = None);
    verify(network, &heard)
}

/// Checks a recorded execution against a network (as written, not merged). An empty list means it is right.
pub fn verify(network: &Network, execution: &Execution) -> Vec<Violation> {
    let network = &merge(network).network;
    let mut verifier = Verifier {
        network,
        makespan: execution.makespan,
        facts: vec![None; network.events().len()],
        nature: vec![Vec::new(); network.events().len()],
        latest: Vec::new(),
        known: Vec::new(),
        violations: Vec::new(),
    };
    verifier.read(execution);
    if verifier.violations.is_empty() {
        verifier.build_nature();
    }
    if verifier.violations.is_empty() {
        verifier.check_claims(execution);
        verifier.check_requirements();
    }
    verifier.violations
}

struct Verifier<'a> {
    network: &'a Network,
    makespan: Time,
    /// What the record says of each event.
    facts: Vec<Option<Fact>>,
    /// What Nature must respect.
    nature: Graph,
    /// When each event had happened at the latest, whether heard of or not.
    latest: Vec<Option<Time>>,
    /// Where each event must have been by what was heard.
    known: Vec<Option<Interval>>,
    violations: Vec<Violation>,
}

/// From each event, edges (to, most that `to` comes after it).
type Graph = Vec<Vec<(EventId, Duration)>>;

#[derive(Clone, Copy, PartialEq)]
struct Fact {
    time: Option<Time>,
    how: How,
    observed: Option<Time>,
    truth: Option<Time>,
    happened: Option<Interval>,
}

impl Verifier<'_> {
    fn say(&mut self, event: Option<&str>, message: String) {
        self.violations.push(Violation { event: event.map(str::to_string), message });
    }

    /// Reads the rows: every name once, names of one event in agreement.
    fn read(&mut self, execution: &Execution) {
        if execution.format != FORMAT {
            let format = &execution.format;
            self.say(None, format!("the format of the execution is `{format}`, expected `{FORMAT}`"));
        }
        if execution.outcome == Outcome::Failed {
            let detail = execution.failure.as_ref().map_or(String::new(), |f| format!(": {}", f.detail));
            self.say(None, format!("the execution is recorded as failed{detail}"));
        }
        if execution.outcome == Outcome::BrokenModel {
            let detail = execution.failure.as_ref().map_or(String::new(), |f| format!(": {}", f.detail));
            self.say(None, format!("it is recorded that Nature did not keep to the model{detail}"));
        }
        if execution.outcome == Outcome::Running {
            self.say(None, "the execution is recorded before its end".to_string());
        }
        let mut rows: BTreeMap<String, &Row> = BTreeMap::new();
        for row in &execution.rows {
            if rows.insert(row.event.to_lowercase(), row).is_some() {
                self.say(Some(&row.event), format!("`{}` has more than one row", row.event));
            }
            match self.network.find(&row.event) {
                None => {
                    self.say(Some(&row.event), format!("there is no event `{}` in the network", row.event))
                }
                Some(event) => self.take(event, row),
            }
        }
        self.read_order(execution);
        let untold = execution.rows.iter().find(|row| row.truth.is_none());
        if let (Some(row), true) = (untold, execution.rows.iter().any(|row| row.truth.is_some())) {
            let message = format!("`{}` does not say when it truly happened, where others do", row.event);
            self.say(Some(&row.event), message);
        }
        for event in self.network.event_ids() {
            for name in self.network.written(event) {
                if !rows.contains_key(&name.to_lowercase()) {
                    self.say(Some(name), format!("`{name}` has no row"));
                }
            }
        }
    }

    /// The rows are in time order, and what is written to precede something else comes before it at one time.
    fn read_order(&mut self, execution: &Execution) {
        let when = |row: &Row| row.time.or(row.happened.map(|happened| happened.latest));
        let mut rows: Vec<Option<usize>> = vec![None; self.facts.len()];
        let mut last: Option<(&Row, Time)> = None;
        for (at, row) in execution.rows.iter().enumerate() {
            let time = when(row).unwrap_or(Time::MAX);
            if let Some((before, _)) = last.filter(|&(_, last)| time < last) {
                let message = format!(
                    "the rows are not in time order: `{}` is listed after `{}`",
                    row.event, before.event
                );
                self.say(Some(&row.event), message);
            }
            last = Some((row, time));
            if let Some(event) = self.network.find(&row.event) {
                rows[event.index()].get_or_insert(at);
            }
        }
        // Events that are written to precede one another are one moment.
        let rank = precedence(self.network, |_| 0);
        let row = |event: EventId| rows[event.index()].map(|at| (at, &execution.rows[at]));
        let mut wrong = Vec::new();
        for (to, from) in written_pairs(self.network) {
            let (Some((at, earlier)), Some((then, later))) = (row(from), row(to)) else { continue };
            let ordered = rank[from.index()] < rank[to.index()];
            if ordered && at > then && earlier.time.is_some() && earlier.time == later.time {
                wrong.push([from, to].map(|event| self.network.label(event).to_string()));
            }
        }
        for [from, to] in wrong {
            self.say(Some(&from), format!("`{from}` must not come after `{to}`, but is listed after it"));
        }
    }

    fn take(&mut self, event: EventId, row: &Row) {
        let fact = Fact {
            time: row.time,
            how: row.how,
            observed: row.observed.flatten(),
            truth: row.truth,
            happened: row.happened,
        };
        if self.facts[event.index()].is_some_and(|other| other != fact) {
            let label = self.network.label(event);
            self.say(
                Some(&row.event),
                format!("`{}` and `{label}` are one event, but their rows differ", row.event),
            );
        }
        self.facts[event.index()] = Some(fact);
        let name = &row.event;
        if self.network.link_of(event).is_none() {
            match fact {
                Fact { time: Some(time), how: How::Dispatched, observed: None, truth, happened } => {
                    if happened.is_some_and(|claim| claim != Interval::at(time)) {
                        self.say(
                            Some(name),
                            format!("`{name}` is dispatched, but said to have happened at another time"),
                        );
                    }
                    if truth.is_some_and(|truth| truth != time) {
                        self.say(Some(name), format!("`{name}` is dispatched, but true at another time"));
                    }
                    if time < Time::ZERO || event == self.network.origin() && time != Time::ZERO {
                        self.say(Some(name), format!("`{name}` does not respect the origin, which is at 0"));
                    }
                }
                _ => self.say(
                    Some(name),
                    format!("`{name}` is ours to execute, but its row is not that of a dispatched event"),
                ),
            }
            return;
        }
        let agrees = match (fact.how, fact.time, fact.observed) {
            (How::Dispatched, ..) => false,
            (How::Observed, Some(time), Some(observed)) => time == observed,
            // What is acted on when it is heard is not held back.
            (How::Buffered, Some(time), Some(observed)) => time > observed,
            (How::Imagined, Some(time), observed) => observed.is_none_or(|observed| observed >= time),
            (How::Never, None, observed) => observed.is_none(),
            _ => false,
        };
        if !agrees {
            let how = fact.how.word();
            self.say(
                Some(name),
                format!("`{name}` is Nature's; time and news of its row do not fit `{how}`"),
            );
        }
    }

    /// The bounds on Nature: links, news, silence; and that they can all be true.
    fn build_nature(&mut self) {
        let origin = self.network.origin();
        let fix = |nature: &mut Graph, event: EventId, within: Interval| {
            if within.latest < Time::MAX {
                nature[origin.index()].push((event, within.latest.since_origin()));
            }
            if within.earliest > Time::MIN {
                nature[event.index()].push((origin, -within.earliest.since_origin()));
            }
        };
        // The same without any news.
        let mut unheard = vec![Vec::new(); self.nature.len()];
        for event in self.network.event_ids() {
            let Some(fact) = self.facts[event.index()] else { continue };
            match self.network.link_of(event) {
                None => {
                    let time = Interval::at(fact.time.unwrap_or_default());
                    fix(&mut self.nature, event, time);
                    fix(&mut unheard, event, time);
                }
                Some(link) => {
                    let link = self.network.contingents()[link];
                    self.nature[link.from.index()].push((event, link.upper));
                    self.nature[event.index()].push((link.from, -link.lower));
                    unheard[link.from.index()].push((event, link.upper));
                    // News that has not come by the end will come later, or never.
                    let heard = fact.observed.unwrap_or(self.makespan);
                    let low = link.delay.max.finite().map_or(Time::MIN, |max| heard.saturating_sub(max));
                    let high =
                        fact.observed.map_or(Time::MAX, |observed| observed.saturating_sub(link.delay.min));
                    fix(&mut self.nature, event, Interval::new(low, high));
                }
            }
        }
        // What is known is known without the truth, which nobody in the execution was told.
        let latest = self.longest(origin).unwrap_or_default();
        let earliest = self.longest_to(origin).unwrap_or_default();
        let after = |most: Option<Duration>| most.map(Time::after_origin);
        self.latest = longest(&unheard, origin).unwrap_or_default().into_iter().map(after).collect();
        let known = |(latest, earliest): (Option<Duration>, Option<Duration>)| {
            Some(Interval::new(Time::after_origin(-earliest?), Time::after_origin(latest?)))
        };
        self.known = latest.into_iter().zip(earliest).map(known).collect();
        for event in self.network.event_ids() {
            if self.network.link_of(event).is_some()
                && let Some(truth) = self.facts[event.index()].and_then(|fact| fact.truth)
            {
                fix(&mut self.nature, event, Interval::at(truth));
            }
        }
        let Some(from_origin) = self.longest(origin) else {
            self.say(
                None,
                "no course of Nature agrees with the record: some duration or some delay is outside of its bounds"
                    .to_string(),
            );
            for link in self.network.contingents() {
                self.say_impossible_link(link.from, link.to);
                self.say_lost_news(link.to);
            }
            return;
        };
        debug_assert_eq!(from_origin[origin.index()], Some(Duration::ZERO));
    }

    /// Names an event that was never heard of although its news was to come before the end.
    fn say_lost_news(&mut self, event: EventId) {
        let Some(link) = self.network.link_of(event).map(|link| self.network.contingents()[link]) else {
            return;
        };
        let silent = self.facts[event.index()].is_some_and(|fact| fact.observed.is_none());
        let latest = self.latest.get(event.index()).copied().flatten();
        if let (true, Some(latest), Some(max)) = (silent, latest, link.delay.max.finite()) {
            let by = latest.saturating_add(max);
            if by < self.makespan {
                let name = self.network.label(event).to_string();
                self.say(
                    Some(&name),
                    format!("`{name}` was never heard of, though its news was to come by {by} s"),
                );
            }
        }
    }

    /// Names a link whose duration is out of bounds, where both ends are recorded.
    fn say_impossible_link(&mut self, from: EventId, to: EventId) {
        let time = |event: EventId| {
            let fact = self.facts[event.index()]?;
            if self.network.link_of(event).is_none() { fact.time } else { fact.truth }
        };
        let Some(link) = self.network.link_of(to).map(|link| self.network.contingents()[link]) else {
            return;
        };
        if let (Some(start), Some(end)) = (time(from), time(to)) {
            let length = end.saturating_since(start);
            if length < link.lower || length > link.upper {
                let name = self.network.label(to).to_string();
                let message = format!(
                    "`{name}` took {length} s, outside of its bounds [{}, {}]",
                    link.lower, link.upper
                );
                self.say(Some(&name), message);
            }
        }
    }

    /// What the record claims to follow from itself: where each event must have happened, and when all was over.
    fn check_claims(&mut self, execution: &Execution) {
        // The last event was over when it was executed or acted on, or had happened in any case.
        let (mut over, mut last) = (Time::ZERO, None);
        let all_recorded = self.network.event_ids().all(|event| self.facts[event.index()].is_some());
        for row in &execution.rows {
            let Some(event) = self.network.find(&row.event) else { continue };
            let known = self.known.get(event.index()).copied().flatten();
            let Some(fact) = self.facts[event.index()] else { continue };
            let contingent = self.network.link_of(event).is_some();
            if let (Some(claim), Some(known), true) = (fact.happened, known, contingent)
                && claim != known
            {
                let message = format!(
                    "`{}` is said to have happened in [{}, {}], but what was heard says [{}, {}]",
                    row.event, claim.earliest, claim.latest, known.earliest, known.latest
                );
                self.say(Some(&row.event), message);
            }
            let end = fact.time.max(known.map(|known| known.latest)).unwrap_or_default();
            if end > over {
                (over, last) = (end, Some(row.event.as_str()));
            }
        }
        // Events without a row may come after all the others.
        if self.makespan < over || all_recorded && self.makespan > over {
            let message = format!(
                "the makespan is said to be {} s, but the last event, `{}`, came at {} s",
                self.makespan,
                last.unwrap_or_else(|| self.network.label(self.network.origin())),
                over
            );
            self.say(last, message);
        }
    }

    /// For every event the most it can come after `from` in any course of Nature; `None` if there is no such course.
    fn longest(&self, from: EventId) -> Option<Vec<Option<Duration>>> {
        longest(&self.nature, from)
    }

    /// For every event the most that `to` can come after it.
    fn longest_to(&self, to: EventId) -> Option<Vec<Option<Duration>>> {
        let mut reversed: Graph = vec![Vec::new(); self.nature.len()];
        for (from, edges) in self.nature.iter().enumerate() {
            for &(to, weight) in edges {
                reversed[to.index()].push((EventId(from as u32), weight));
            }
        }
        longest(&reversed, to)
    }

    fn check_requirements(&mut self) {
        // What must hold between events, worst case: those with a row at once, the others in the end.
        let mut free: Vec<(EventId, EventId, Duration)> = Vec::new();
        let mut memo: BTreeMap<EventId, Vec<Option<Duration>>> = BTreeMap::new();
        for requirement in self.network.requirements() {
            let upper = requirement.upper.finite().map(|upper| (requirement.from, requirement.to, upper));
            let lower = requirement.lower.finite().map(|lower| (requirement.to, requirement.from, -lower));
            for (from, to, weight) in [upper, lower].into_iter().flatten() {
                if self.facts[from.index()].is_none() || self.facts[to.index()].is_none() {
                    free.push((from, to, weight));
                    continue;
                }
                let most = memo.entry(from).or_insert_with(|| self.longest(from).unwrap_or_default());
                let most = most.get(to.index()).copied().flatten();
                if most.is_none_or(|most| most > weight) {
                    self.violated(from, to, weight, most);
                }
            }
        }
        self.check_unrecorded(&free);
    }

    fn violated(&mut self, from: EventId, to: EventId, weight: Duration, most: Option<Duration>) {
        let (a, b) = (self.network.label(from).to_string(), self.network.label(to).to_string());
        let found = most.map_or("any time".to_string(), |most| format!("{most} s"));
        let message = if weight < Duration::ZERO {
            let found = most.map_or("any time".to_string(), |most| format!("{} s", -most));
            format!(
                "`{a}` must come at least {} s after `{b}`, but came (or may have come) {found} after it",
                -weight
            )
        } else {
            format!(
                "`{b}` must come at most {weight} s after `{a}`, but came (or may have come) {found} after it"
            )
        };
        self.say(Some(&b), message);
    }

    /// Are there times for the events without a row? They are ours, so they must suit every course of Nature.
    fn check_unrecorded(&mut self, requirements: &[(EventId, EventId, Duration)]) {
        let origin = self.network.origin();
        let latest = self.longest(origin).unwrap_or_default();
        // What is known of an event: the least and the most that it comes after the origin.
        let since_origin = |event: EventId| -> Option<(Duration, Duration)> {
            let most = latest.get(event.index()).copied().flatten()?;
            let least = self.longest(event)?.get(origin.index()).copied().flatten().map(|most| -most)?;
            Some((least, most))
        };
        let mut edges: Vec<(usize, usize, Duration)> = Vec::new();
        for event in self.network.event_ids().filter(|event| self.facts[event.index()].is_none()) {
            edges.push((event.index(), origin.index(), Duration::ZERO));
        }
        for &(from, to, weight) in requirements {
            let mut weight = weight;
            let mut end = |event: EventId, latest: bool| {
                if self.facts[event.index()].is_none() {
                    return Some(event.index());
                }
                let (least, most) = since_origin(event)?;
                // `to - from <= weight` with a recorded end becomes a bound against the origin.
                weight = if latest { weight.saturating_sub(most) } else { weight.saturating_add(least) };
                Some(origin.index())
            };
            let (Some(from), Some(to)) = (end(from, false), end(to, true)) else { continue };
            edges.push((from, to, weight));
        }
        let mut most = vec![Duration::ZERO; self.network.events().len()];
        for _ in 0..=most.len() {
            let mut changed = None;
            for &(from, to, weight) in &edges {
                let candidate = most[from].saturating_add(weight);
                if candidate < most[to] {
                    most[to] = candidate;
                    changed = Some(to);
                }
            }
            match changed {
                None => return,
                Some(event) if most[event] < -FAR => break,
                Some(_) => {}
            }
        }
        self.say(
            None,
            "there are no times for the events without a row that keep all requirements".to_string(),
        );
    }
}

/// Bellman-Ford: for every event the length of the shortest path from `from`; `None` if there is a negative cycle.
fn longest(edges: &Graph, from: EventId) -> Option<Vec<Option<Duration>>> {
    let count = edges.len();
    let mut most: Vec<Option<Duration>> = vec![None; count];
    let mut length = vec![0_usize; count];
    most[from.index()] = Some(Duration::ZERO);
    let mut open = VecDeque::from([from]);
    let mut queued = vec![false; count];
    while let Some(event) = open.pop_front() {
        queued[event.index()] = false;
        let Some(here) = most[event.index()] else { continue };
        for &(to, weight) in &edges[event.index()] {
            let candidate = here.saturating_add(weight);
            if most[to.index()].is_none_or(|known| candidate < known) {
                most[to.index()] = Some(candidate);
                length[to.index()] = length[event.index()] + 1;
                if length[to.index()] > count {
                    return None;
                }
                if !std::mem::replace(&mut queued[to.index()], true) {
                    open.push_back(to);
                }
            }
        }
    }
    Some(most)
}
