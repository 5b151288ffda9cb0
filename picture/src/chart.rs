//! What is to be seen: activities in rows, with when each starts and ends, or can.

use std::collections::{BTreeMap, BTreeSet};

use kirk_compiler::episode::{Episode, Kind};
use kirk_compiler::events_of;
use kirk_network::conflicts::{conflicts, without};
use kirk_network::windows::{Window, windows};
use kirk_network::{Duration, EventId, Interval, Network, Part, Time};
use kirk_runtime::{Execution, How, Outcome, Plan, Simulation, simulate};
use kirk_team::record::{Record, Row};

use crate::lanes::{Place, packed, placed};

/// A mission, or an execution of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// What it is called.
    pub title: String,
    /// What there is to say of it as a whole.
    pub says: String,
    /// How many rows there are.
    pub rows: usize,
    /// Whose rows begin where, if they are several agents'.
    pub lanes: Vec<(String, usize)>,
    /// News from one row to another.
    pub news: Vec<News>,
    /// Activities, and the forms around them that have a name or a limit.
    pub bars: Vec<Bar>,
    /// When all is over, at the latest that is to be seen.
    pub end: Time,
    /// True if it was executed: what is seen happened, and need not.
    pub happened: bool,
    /// What stands below it.
    pub notes: Vec<String>,
}

/// News that one agent tells another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct News {
    /// The row of what happened, and when it did.
    pub from: (usize, Time),
    /// The row of who heard of it, and when that was.
    pub to: (usize, Time),
    /// What it is of.
    pub event: String,
}

/// An activity, or a form around activities.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// What it is called.
    pub name: String,
    /// The row it is in, from the top.
    pub row: usize,
    /// The rows below that belong to it, if it is a form.
    pub around: usize,
    /// Who decides how long it takes.
    pub whose: Whose,
    /// When it starts.
    pub start: Moment,
    /// When it ends.
    pub end: Moment,
    /// Between when and when Nature ends it, having begun it then.
    pub open: Option<Interval>,
    /// By when it has to end, from its start.
    pub limit: Option<Duration>,
    /// True if nobody has given it a name.
    pub is_nameless: bool,
    /// True if it is a part of what cannot be kept.
    pub is_blamed: bool,
}

/// Who decides how long something takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// We do.
    Ours,
    /// Nature does.
    Natures,
}

/// When something happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// Not before this.
    pub earliest: Time,
    /// Not after this; `None` if nothing limits it.
    pub latest: Option<Time>,
    /// When it happens if Nature takes the most and news as long as it can.
    pub at_most: Time,
    /// When it was executed, or acted on, and how.
    pub done: Option<(Time, How)>,
    /// When news of it arrived, or does if Nature takes the most.
    pub heard: Option<Time>,
    /// When it truly happened, if that is known.
    pub truth: Option<Time>,
}

impl Bar {
    /// When the last of it is over that is drawn in its row.
    pub(crate) fn over(&self) -> Time {
        let open = self.open.map_or(Time::ZERO, |open| open.latest);
        self.start.at().max(self.end.at()).max(open).max(self.end.heard.unwrap_or(Time::ZERO))
    }

    /// Of an execution it is known in what interval Nature ended it.
    fn where_it_ended(&mut self) {
        let Moment { earliest, latest, .. } = self.end;
        let latest = latest.unwrap_or(earliest.max(self.end.at()));
        self.open = (self.whose == Whose::Natures).then_some(Interval::new(earliest, latest));
    }
}

impl Moment {
    /// When it is drawn: when it was done, else when it happens if Nature takes the most.
    pub fn at(&self) -> Time {
        self.done.map_or(self.at_most, |(time, _)| time)
    }

    /// The last of it: when it can happen, was done, and was heard of.
    fn last(&self) -> Time {
        let latest = self.latest.unwrap_or(self.earliest);
        latest.max(self.at()).max(self.heard.unwrap_or(latest))
    }
}

/// When events happen, by name.
type Moments = BTreeMap<String, Moment>;

impl Chart {
    /// A program, unfolded, and its network as it was lowered.
    pub fn of_mission(title: &str, episodes: &Episode, network: &Network) -> Chart {
        let (moments, says) = foreseen(network);
        let blamed = blamed(network);
        let places = placed(episodes);
        let bars = events_of(episodes).into_iter().zip(&places.of).filter_map(|((episode, ends), place)| {
            let Place { row, around } = (*place)?;
            let moment = |event: EventId| moments.get(network.id(event)).copied();
            let (start, end) = (moment(ends.0)?, moment(ends.1)?);
            let upper = episode.duration.as_ref().and_then(|duration| duration.upper.finite());
            Some(Bar {
                name: called(episode),
                row,
                around,
                whose: if episode.contingent { Whose::Natures } else { Whose::Ours },
                start,
                end,
                open: open(network, ends.1, start),
                limit: upper.filter(|_| !is_leaf(episode)),
                is_nameless: episode.internal && episode.labels.is_empty(),
                is_blamed: blamed.contains(&ends),
            })
        });
        Chart::new(title, says, places.rows, bars.collect(), false)
    }

    /// A network: its links, and what is called `x:start` and `x:end`.
    pub fn of_network(title: &str, network: &Network) -> Chart {
        let (moments, says) = foreseen(network);
        let blamed = blamed(network);
        let mut bars =
            pairs(&moments, |name| network.find(name).and_then(|event| network.link_of(event)).is_some());
        for link in network.contingents() {
            let (from, to) = (network.label(link.from), network.label(link.to));
            let is_known =
                to.strip_suffix(":end").is_some_and(|stem| moments.contains_key(&format!("{stem}:start")));
            if let (false, Some(start), Some(end)) = (is_known, moments.get(from), moments.get(to)) {
                let named = bar(format!("{from} \u{2192} {to}"), Whose::Natures, *start, *end);
                bars.push(Bar { open: open(network, link.to, *start), ..named });
            }
        }
        for bar in bars.iter_mut().filter(|bar| bar.open.is_none()) {
            let ends = |suffix: &str| network.find(&format!("{}{suffix}", bar.name));
            bar.open = ends(":end").and_then(|end| open(network, end, bar.start));
            bar.is_blamed = match (ends(":start"), ends(":end")) {
                (Some(start), Some(end)) => blamed.contains(&(start, end)),
                _ => false,
            };
        }
        let rows = packed(&mut bars);
        Chart::new(title, says, rows, bars, false)
    }

    /// An execution, of which nothing is known but its record.
    pub fn of_execution(execution: &Execution) -> Chart {
        let moments = recorded(execution);
        let natures =
            |name: &str| execution.rows.iter().any(|row| row.event == name && row.observed.is_some());
        let mut bars = pairs(&moments, natures);
        bars.iter_mut().for_each(Bar::where_it_ended);
        let rows = packed(&mut bars);
        Chart::new(&execution.program, outcome(execution), rows, bars, true)
    }

    /// The execution of a team: the rows of each agent, one below the other, and who heard of what when.
    pub fn of_team(record: &Record) -> Chart {
        // Even who observes it first hears of what Nature ends.
        let is_natures = |row: &Row| row.agent.as_ref().is_some_and(|agent| row.heard.contains_key(agent));
        let moment = |row: &Row| {
            let at = row.happened?;
            let moment = Moment {
                earliest: at,
                latest: Some(at),
                at_most: at,
                done: None,
                heard: None,
                truth: Some(at),
            };
            Some((row.event.clone(), moment))
        };
        let moments: Moments = record.rows.iter().filter_map(moment).collect();
        let (mut bars, mut lanes, mut rows) = (Vec::new(), Vec::new(), 0);
        for agent in &record.agents {
            lanes.push((agent.clone(), rows));
            let mut own =
                pairs(&moments, |name| record.rows.iter().any(|row| row.event == name && is_natures(row)));
            let is_own = |event: &str| {
                record.rows.iter().any(|row| row.event == event && row.agent.as_ref() == Some(agent))
            };
            own.retain(|bar| is_own(&format!("{}:start", bar.name)));
            let height = packed(&mut own).max(1);
            own.iter_mut().for_each(|bar| bar.row += rows + 1);
            bars.append(&mut own);
            rows += 1 + height;
        }
        let lane = |agent: &str| lanes.iter().find(|(name, _)| name == agent).map_or(0, |(_, row)| *row);
        let row_of = |event: &str, agent: &str| {
            let own = |bar: &&Bar| {
                event.strip_suffix(":end") == Some(&bar.name)
                    || event.strip_suffix(":start") == Some(&bar.name)
            };
            bars.iter().find(own).map_or(lane(agent) + 1, |bar| bar.row)
        };
        let mut news = Vec::new();
        for row in &record.rows {
            let (Some(agent), Some(at)) = (&row.agent, row.happened) else { continue };
            for (listener, heard) in &row.heard {
                if let Some(heard) = heard.at.filter(|_| listener != agent) {
                    let from = (row_of(&row.event, agent), at);
                    news.push(News { from, to: (lane(listener) + 1, heard), event: row.event.clone() });
                }
            }
        }
        let says = match &record.failure {
            Some(failure) => format!("at {} s: {}", failure.time, failure.detail),
            None => format!("completed in {} s", record.makespan),
        };
        let chart = Chart::new(&format!("{}, {}", record.program, record.team), says, rows, bars, true);
        let last = news.iter().map(|news| news.to.1).max().unwrap_or(Time::ZERO);
        Chart { lanes, end: chart.end.max(last), news, ..chart }
    }

    /// The same with what happened in an execution of it.
    pub fn executed(mut self, execution: &Execution) -> Chart {
        let moments = recorded(execution);
        // A form nobody has named has no events of its own in most records.
        self.bars.retain(|bar| !bar.is_nameless || moments.contains_key(&format!("{}:end", bar.name)));
        for bar in &mut self.bars {
            for (moment, end) in [(&mut bar.start, "start"), (&mut bar.end, "end")] {
                if let Some(recorded) = moments.get(&format!("{}:{end}", bar.name)) {
                    *moment = *recorded;
                }
            }
            bar.where_it_ended();
        }
        Chart::new(&self.title, outcome(execution), self.rows, self.bars, true)
    }

    /// The same with something to say below it.
    pub fn noted(self, notes: Vec<String>) -> Chart {
        Chart { notes, ..self }
    }

    fn new(title: &str, says: String, rows: usize, bars: Vec<Bar>, happened: bool) -> Chart {
        let end = bars.iter().flat_map(|bar| [bar.start.last(), bar.end.last()]).max().unwrap_or(Time::ZERO);
        Chart { title: title.to_string(), says, rows, bars, end, happened, ..Chart::default() }
    }
}

/// True of what has no parts.
pub(crate) fn is_leaf(episode: &Episode) -> bool {
    matches!(episode.kind, Kind::Primitive | Kind::Delay) || episode.parts.is_empty()
}

fn called(episode: &Episode) -> String {
    episode.labels.first().cloned().unwrap_or_else(|| episode.name.clone())
}

fn bar(name: String, whose: Whose, start: Moment, end: Moment) -> Bar {
    Bar {
        name,
        row: 0,
        around: 0,
        whose,
        start,
        end,
        open: None,
        limit: None,
        is_nameless: false,
        is_blamed: false,
    }
}

/// What is called `x:start` and `x:end`.
fn pairs(moments: &Moments, is_natures: impl Fn(&str) -> bool) -> Vec<Bar> {
    let ends = moments.iter().filter_map(|(name, end)| Some((name, name.strip_suffix(":end")?, end)));
    ends.filter_map(|(name, stem, end)| {
        let start = moments.get(&format!("{stem}:start"))?;
        let whose = if is_natures(name) { Whose::Natures } else { Whose::Ours };
        Some(bar(stem.to_string(), whose, *start, *end))
    })
    .collect()
}

/// When Nature ends something that started then.
fn open(network: &Network, end: EventId, start: Moment) -> Option<Interval> {
    let link = network.contingents()[network.link_of(end)?];
    Some(Interval::at(start.at()).later(link.lower, link.upper))
}

/// When each event can happen, and does if Nature takes the most; and the verdict. Of what cannot be promised: with the conflicts out
/// of the way.
fn foreseen(network: &Network) -> (Moments, String) {
    let found = conflicts(network, MOST_CONFLICTS).unwrap_or_default();
    let says = match found.len() {
        0 => "can be executed whatever happens",
        1 => "cannot be executed in every case: what is marked does not go together",
        _ => "cannot be executed in every case: what is marked are several things that do not go together",
    };
    let possible = without(network, &found);
    let longest = Simulation { internal: true, ..Simulation::default() };
    let execution = Plan::new(&possible).ok().and_then(|plan| simulate(&plan, "", &longest).ok());
    let course = execution.as_ref().map(recorded).unwrap_or_default();
    let mut moments = Moments::new();
    for (event, window) in network.event_ids().zip(windows(&possible).unwrap_or_default()) {
        let Window { earliest, latest } = window;
        for name in network.events()[event.index()].names.iter() {
            let at = course.get(&name.text);
            let at_most = at.map_or(earliest, |at| at.truth.unwrap_or(at.at()));
            let heard = at.and_then(|at| at.heard);
            let moment = Moment { earliest, latest, at_most, done: None, heard, truth: None };
            moments.insert(name.text.clone(), moment);
        }
    }
    (moments, says.to_string())
}

/// More conflicts than that are not looked for.
const MOST_CONFLICTS: usize = 20;

/// Between which events something is bounded that a conflict rests on.
fn blamed(network: &Network) -> BTreeSet<(EventId, EventId)> {
    let found = conflicts(network, MOST_CONFLICTS).unwrap_or_default();
    let ends = |part: Part| match part {
        Part::RequirementLower(index) | Part::RequirementUpper(index) => {
            network.requirements().get(index).map(|requirement| (requirement.from, requirement.to))
        }
        part => part.link().and_then(|link| network.contingents().get(link)).map(|link| (link.from, link.to)),
    };
    found.iter().flat_map(|conflict| &conflict.members).filter_map(|share| ends(share.part)).collect()
}

/// What a record says of each event.
fn recorded(execution: &Execution) -> Moments {
    let mut moments = Moments::new();
    for row in &execution.rows {
        let Interval { earliest, latest } =
            row.happened.or(row.time.map(Interval::at)).unwrap_or(Interval::at(execution.makespan));
        let moment = Moment {
            earliest,
            latest: Some(latest).filter(|latest| *latest < Time::MAX),
            at_most: row.time.unwrap_or(earliest),
            done: row.time.map(|time| (time, row.how)),
            heard: row.observed.flatten(),
            truth: row.truth,
        };
        moments.insert(row.event.clone(), moment);
    }
    moments
}

fn outcome(execution: &Execution) -> String {
    match (execution.outcome, &execution.failure) {
        (Outcome::Completed, _) => format!("completed in {} s", execution.makespan),
        (Outcome::Running, _) => format!("running, {} s", execution.makespan),
        (Outcome::Failed | Outcome::BrokenModel, Some(failure)) => {
            format!("at {} s: {}", failure.time, failure.detail)
        }
        (Outcome::Failed | Outcome::BrokenModel, None) => "failed".to_string(),
    }
}
