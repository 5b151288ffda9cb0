//! `kirk slack`: how much is left of a "yes": how far each bound can move, and how late everything may start.

use std::collections::HashMap;
use std::io;

use kirk_compiler::episode::{Episode, Kind};
use kirk_compiler::repair::{Unit, what, written_unit};
use kirk_compiler::{
    Explain, Origin, Origins, Side, Source, Span, StoryStep, Written, events_of, measurable, too_large,
    usual_unit,
};
use kirk_network::merge::{Merged, merge};
use kirk_network::promise::{promises, stretch};
use kirk_network::slack::{Factor, Slack, beyond, common_factor, slack};
use kirk_network::stnu::TooLarge;
use kirk_network::vary::Knob;
use kirk_network::windows::windows;
use kirk_network::{Bound, ContingentLink, Duration, EventId, Network, Part, Time};
use serde::Serialize;

use crate::args::{Common, SlackOf, TextOrJson};
use crate::foreign::one_line;
use crate::input::{Loaded, load_all};
use crate::json::line;
use crate::judge::{Judged, judge};
use crate::output::{Status, print, print_line};
use crate::report::{Reporter, SpanJson};
use crate::table::{Row, table, wrapped};

pub(crate) fn slack_of(arguments: &SlackOf, common: &Common) -> io::Result<Status> {
    let mut input = load_all(&arguments.files, &arguments.selection);
    input.for_one_alone("`kirk slack`");
    let judged = judge(&mut input);
    let file = arguments.files.join(" ");
    let is_yes = judged.as_ref().is_some_and(Judged::is_yes);
    let left = match (&input.network, is_yes) {
        (Some(network), true) => measure(network, &input),
        _ => Ok(None),
    };
    let Ok(left) = left else {
        // What can be decided may be too large to be measured.
        input.diagnostics.push(too_large(Span::default()));
        Reporter::new(&input.sources).show(&input.diagnostics, common)?;
        return Ok(Status::Wrong);
    };
    let reporter = Reporter::new(&input.sources);
    let Some(left) = left else {
        reporter.show(&input.diagnostics, common)?;
        let status = if judged.is_some() { Status::No } else { Status::Wrong };
        if arguments.format == TextOrJson::Json {
            print(&line(&SlackJson::nothing(&file))?)?;
        } else if status == Status::No {
            print_line(&format!("{file}: nothing is left: it is not controllable, `kirk check` says why"))?;
        }
        return Ok(status);
    };
    match arguments.format {
        TextOrJson::Json => print(&line(&SlackJson::new(&file, &left, &reporter))?)?,
        TextOrJson::Text => {
            print_line(&format!(
                "{file}: `{}` is controllable, and this is left",
                input.program(&arguments.selection)
            ))?;
            for text in left.lines(&reporter) {
                print_line(&one_line(&text))?;
            }
        }
    }
    Ok(Status::Yes)
}

/// All that is left.
struct Left<'a> {
    /// What loses the guarantee first comes first, and what cannot lose it last.
    bounds: Vec<Measured<'a>>,
    critical: Option<Critical>,
    activities: Vec<Activity>,
    news: Vec<News>,
    factor: Option<Factor>,
    /// The unit in which times are told.
    unit: Unit,
}

struct Measured<'a> {
    slack: Slack,
    what: String,
    written: Written<'a>,
    unit: Unit,
    /// The least and the greatest value that is written there.
    values: (Bound, Bound),
    now: String,
    may_be: String,
}

/// What the tightest bound rests on: the conflict a microsecond further, told of what is written.
struct Critical {
    of: String,
    steps: Vec<Step>,
    /// What is needed and what is there for it, if the rest is what is left.
    sum: Option<(Duration, Duration)>,
}

/// One step: what it is, in words, and what it needs.
#[derive(Serialize)]
struct Step {
    what: String,
    text: String,
    needs: Duration,
}

/// An activity of which the start or the duration is ours.
#[derive(Serialize)]
struct Activity {
    name: String,
    #[serde(flatten)]
    start: Start,
    earliest_start: Option<Time>,
    latest_start: Option<Time>,
    may_take: Option<Bound>,
    #[serde(skip)]
    unit: Unit,
}

/// Who decides when it starts.
#[derive(Serialize)]
#[serde(tag = "decided_by", rename_all = "lowercase")]
enum Start {
    /// We do, and can put it off so long in any case.
    Us { put_off_to: Option<Time> },
    /// It is the start of the mission.
    #[serde(rename = "start")]
    Mission,
    /// It is an end that Nature decides.
    Nature {
        event: String,
        #[serde(skip)]
        end: String,
    },
}

/// How late the news of an event may be alone: its longest delay, and the longest it could have.
#[derive(Serialize)]
struct News {
    event: String,
    value: Bound,
    most: Bound,
    #[serde(skip)]
    unit: Unit,
}

fn measure<'a>(network: &Network, input: &'a Loaded) -> Result<Option<Left<'a>>, TooLarge> {
    let Some(origins) = input.origins() else { return Ok(None) };
    let unit = usual_unit(origins, &input.sources);
    let knobs = knobs(network, origins);
    let all: Vec<Knob> = knobs.iter().map(|(knob, ..)| knob.clone()).collect();
    let Some(found) = slack(network, &all)? else { return Ok(None) };
    let news = news(network, origins, &found, (unit, &input.sources))?;
    let measured = found.into_iter().zip(knobs).map(|(slack, (_, what, written))| {
        let unit = written.unit(unit, &input.sources);
        let (now, may_be) = (written.now(network, unit), written.may_be(&slack, network, unit));
        let values = written.values(network);
        Measured { slack, what, written, unit, values, now, may_be }
    });
    let mut bounds: Vec<Measured<'_>> = measured.collect();
    bounds.sort_by_key(|bound| bound.room().map_or(i64::MAX, Duration::as_micros));
    let explain = Explain { network, origins, sources: &input.sources, program: None, theory: false };
    let critical =
        bounds.iter().take_while(|bound| bound.slack.loses).find_map(|bound| bound.critical(&explain));
    let activities = activities(network, input, origins, unit)?;
    let factor = common_factor(network)?;
    Ok(Some(Left { bounds, critical, activities, news, factor, unit }))
}

/// What can be moved: each bound that is written, with what it is. What is written once moves together.
fn knobs<'a>(network: &Network, origins: &'a Origins) -> Vec<(Knob, String, Written<'a>)> {
    let knob = |written: Written<'a>| {
        let mut what = what(written.parts[0], written.origin)?;
        if written.parts.len() > 1 {
            what.push_str(&format!(" ({} occurrences together)", written.parts.len()));
        }
        Some((Knob::together(written.parts.clone())?, what, written))
    };
    measurable(network, origins).into_iter().filter_map(knob).collect()
}

/// The news of each event of Nature's alone, also where several are written once; what has been measured is not measured again.
fn news(
    network: &Network,
    origins: &Origins,
    measured: &[Slack],
    (usual, sources): (Unit, &[Source]),
) -> Result<Vec<News>, TooLarge> {
    let knobs: Vec<Knob> =
        (0..network.contingents().len()).filter_map(|index| Knob::of(Part::DelayMax(index))).collect();
    let known = |knob: &Knob| measured.iter().find(|slack| slack.knob == *knob);
    let unknown: Vec<Knob> = knobs.iter().filter(|knob| known(knob).is_none()).cloned().collect();
    let alone = slack(network, &unknown)?.unwrap_or_default();
    let mut alone = alone.iter();
    let all = knobs.iter().zip(network.contingents()).zip(&origins.contingents);
    let line = |((knob, link), origin): ((&Knob, &ContingentLink), &Origin)| {
        let found = known(knob).or_else(|| alone.next())?;
        let unit = written_unit(origin.place(Side::MaxDelay), sources).unwrap_or(usual);
        let event = network.label(link.to).to_string();
        Some(News { event, value: found.value, most: found.most, unit })
    };
    Ok(all.filter_map(line).collect())
}

impl Measured<'_> {
    /// How far it can move before the guarantee is lost; `None` if that loses none.
    fn room(&self) -> Option<Duration> {
        self.slack.room.filter(|_| self.slack.loses)
    }

    fn named(&self) -> String {
        format!("{}, {}", self.what, self.written.side.word())
    }

    /// What stops it, if that can be told.
    fn critical(&self, explain: &Explain<'_>) -> Option<Critical> {
        let conflict = beyond(explain.network, &self.slack).ok()??;
        let step = |StoryStep { part, needs, text, .. }: StoryStep| {
            let what = what(part, explain.origins.of(part)?.0).unwrap_or_default();
            Some(Step { what, text, needs })
        };
        let steps: Vec<Step> = explain.one(&conflict).story.into_iter().filter_map(step).collect();
        let sum = |is_meant: fn(&Duration) -> bool| {
            let all = steps.iter().map(|step| step.needs).filter(is_meant);
            all.fold(Duration::ZERO, |sum, needs| sum.checked_add(needs).unwrap_or(Duration::MAX))
        };
        let (needed, there) = (sum(|needs| *needs > Duration::ZERO), -sum(|needs| *needs < Duration::ZERO));
        // Of a bound in which the chain comes several times only a part is left; and a chain may cease to hold sooner than its
        // sum is mended.
        let is_left = there.checked_sub(needed) == self.slack.room;
        (!steps.is_empty()).then(|| Critical {
            of: self.named(),
            steps,
            sum: is_left.then_some((needed, there)),
        })
    }
}

/// What may start an activity: its name, its start, the requirement that is its duration, and whether Nature decides that.
struct Occurrence {
    name: String,
    start: EventId,
    takes: Option<usize>,
    is_natures: bool,
}

/// The activities of which something is ours, with when they start and how long each may be made to take. Of a network, the
/// events of ours.
fn activities(
    network: &Network,
    input: &Loaded,
    origins: &Origins,
    usual: Unit,
) -> Result<Vec<Activity>, TooLarge> {
    let Merged { network: merged, event_of, .. } = merge(network);
    let is_ours = |event: EventId| {
        let event = event_of[event.index()];
        merged.link_of(event).is_none() && event != merged.origin()
    };
    let mut all = occurrences(network, input);
    all.retain(|it| is_ours(it.start) || it.takes.is_some() && !it.is_natures);
    let events: Vec<EventId> = all.iter().map(|it| it.start).collect();
    let promised = promises(network, &events)?.unwrap_or_default();
    let windows = windows(network);
    let mut activities = Vec::new();
    for (Occurrence { name, start, takes, .. }, promise) in all.into_iter().zip(promised) {
        let window = windows.as_ref().map(|windows| windows[start.index()]);
        let (earliest_start, latest_start) =
            (window.map(|window| window.earliest), window.and_then(|window| window.latest));
        let place = takes.map(|index| origins.requirements[index].place(Side::Upper));
        let unit = place.and_then(|place| written_unit(place, &input.sources)).unwrap_or(usual);
        let start = match merged.link_of(event_of[start.index()]) {
            Some(link) => Start::Nature {
                event: network.label(network.contingents()[link].to).to_string(),
                end: origins.contingents[link].end(),
            },
            None if is_ours(start) => Start::Us { put_off_to: promise.from },
            None => Start::Mission,
        };
        let may_take = takes.map(|index| stretch(network, index)).transpose()?.flatten();
        activities.push(Activity { name, start, earliest_start, latest_start, may_take, unit });
    }
    Ok(activities)
}

fn occurrences(network: &Network, input: &Loaded) -> Vec<Occurrence> {
    let Some(root) = input.compilation().and_then(|it| it.episodes.as_ref()) else {
        let event = |event| Occurrence {
            name: network.label(event).to_string(),
            start: event,
            takes: None,
            is_natures: false,
        };
        return network.event_ids().map(event).collect();
    };
    // The first one between two events is that of the activity; what else is said of them comes behind.
    let mut requirement_of: HashMap<(EventId, EventId), usize> = HashMap::new();
    for (index, it) in network.requirements().iter().enumerate() {
        requirement_of.entry((it.from, it.to)).or_insert(index);
    }
    let primitives = events_of(root).into_iter().filter(|(episode, _)| episode.kind == Kind::Primitive);
    let occurrence = |(episode, ends): (&Episode, (EventId, EventId))| Occurrence {
        name: episode.name.clone(),
        start: ends.0,
        takes: requirement_of.get(&ends).copied().filter(|_| !episode.contingent),
        is_natures: episode.contingent,
    };
    primitives.map(occurrence).collect()
}

impl Left<'_> {
    fn lines(&self, reporter: &Reporter<'_>) -> Vec<String> {
        let mut lines = self.of_bounds(reporter);
        lines.extend(self.critical.iter().flat_map(|critical| critical.lines(self.unit)));
        if !self.activities.is_empty() {
            let rows: Vec<Row<3>> = self.activities.iter().map(|it| it.row(self.unit)).collect();
            lines.extend(table(["starts", "can wait to", "may take"], "activity", &rows));
        }
        if !self.news.is_empty() {
            let row = |News { event, value, most, unit }: &News| Row {
                cells: [unit.say_bound(*value), unit.say_bound(*most)],
                text: event.clone(),
                place: None,
            };
            let rows: Vec<Row<2>> = self.news.iter().map(row).collect();
            lines.extend(table(["late by", "at most"], "news of", &rows));
        }
        match self.factor {
            Some(Factor::Unlimited) => lines.push("all news together may be as late as it likes".to_string()),
            Some(Factor::Millionths(millionths)) => {
                lines.push(format!(
                    "all news together may be {} times as late",
                    Duration::from_micros(millionths)
                ));
            }
            None => {}
        }
        lines
    }

    fn of_bounds(&self, reporter: &Reporter<'_>) -> Vec<String> {
        // News that comes at once is among the news.
        let is_told = |it: &&Measured<'_>| {
            it.written.side != Side::MaxDelay || it.slack.value != Bound::Finite(Duration::ZERO)
        };
        let row = |it: &Measured<'_>| Row {
            cells: [it.unit.say_bound(limit(it.room())), it.now.clone(), it.may_be.clone()],
            text: it.named(),
            place: reporter.at(it.written.place()),
        };
        let rows: Vec<Row<3>> = self.bounds.iter().filter(is_told).map(row).collect();
        table(["room", "now", "may be"], "what", &rows)
    }
}

impl Critical {
    fn lines(&self, unit: Unit) -> Vec<String> {
        let mut lines = vec![String::new()];
        lines.extend(wrapped("", &format!("What the tightest rests on ({}):", self.of)));
        for (number, Step { text, .. }) in self.steps.iter().enumerate() {
            lines.extend(wrapped(&format!("{:>3}. ", number + 1), text));
        }
        if let Some((needed, there)) = self.sum {
            let (needed, there) = (unit.say(needed), unit.say(there));
            lines.extend(wrapped("", &format!("That needs {needed}, and {there} are there.")));
        }
        lines
    }
}

impl Activity {
    fn row(&self, usual: Unit) -> Row<3> {
        let Activity { name, start, earliest_start, latest_start, may_take, unit } = self;
        let time = |time: Time| Duration::from_micros(time.as_micros());
        let starts = match (earliest_start, latest_start) {
            (Some(earliest), Some(latest)) if earliest == latest => usual.say_time(*earliest),
            (Some(earliest), Some(latest)) => usual.say_times(*earliest, " to ", *latest),
            (Some(earliest), None) => format!("{} or later", usual.say_time(*earliest)),
            (None, _) => String::new(),
        };
        let (can_wait, text) = match start {
            Start::Us { put_off_to } => (usual.say_bound(limit(put_off_to.map(time))), name.clone()),
            Start::Mission => (String::new(), format!("{name}, starts with the mission")),
            Start::Nature { end, .. } => (String::new(), format!("{name}, starts at {end}, Nature decides")),
        };
        let may_take = may_take.map_or(String::new(), |may_take| unit.say_bound(may_take));
        Row { cells: [starts, can_wait, may_take], text, place: None }
    }
}

/// What has no limit is not bounded.
fn limit(limit: Option<Duration>) -> Bound {
    limit.map_or(Bound::Infinite, Bound::Finite)
}

/// `kirk-slack/1`. What has no limit is `null`.
#[derive(Serialize)]
struct SlackJson<'a> {
    format: &'static str,
    file: &'a str,
    controllable: bool,
    slack: Vec<BoundJson<'a>>,
    critical: &'a [Step],
    activities: &'a [Activity],
    budget: &'a [News],
    /// By what factor all longest delays may grow together; absent if no news is late.
    #[serde(skip_serializing_if = "Option::is_none")]
    factor: Option<Option<Duration>>,
}

#[derive(Serialize)]
struct BoundJson<'a> {
    what: &'a str,
    file: &'a str,
    span: Option<SpanJson>,
    bound: Side,
    #[serde(flatten)]
    range: RangeJson,
    room: Option<Duration>,
}

/// Where it may lie; of several values only what they are.
#[derive(Serialize)]
#[serde(untagged)]
enum RangeJson {
    One { value: Bound, least: Bound, most: Bound },
    Several { values: [Bound; 2] },
}

impl<'a> SlackJson<'a> {
    fn nothing(file: &'a str) -> SlackJson<'a> {
        SlackJson {
            format: "kirk-slack/1",
            file,
            controllable: false,
            slack: Vec::new(),
            critical: &[],
            activities: &[],
            budget: &[],
            factor: None,
        }
    }

    fn new(file: &'a str, left: &'a Left<'a>, reporter: &'a Reporter<'_>) -> SlackJson<'a> {
        let bound = |it: &'a Measured<'a>| {
            let place = it.written.place();
            let Slack { value, least, most, .. } = it.slack;
            let (lowest, highest) = it.values;
            let range = match lowest == highest {
                true => RangeJson::One { value, least, most },
                false => RangeJson::Several { values: [lowest, highest] },
            };
            BoundJson {
                what: &it.what,
                file: reporter.name(place),
                span: reporter.span_json(place),
                bound: it.written.side,
                range,
                room: it.room(),
            }
        };
        SlackJson {
            controllable: true,
            slack: left.bounds.iter().map(bound).collect(),
            critical: left.critical.as_ref().map_or(&[], |critical| &critical.steps),
            activities: &left.activities,
            budget: &left.news,
            factor: left.factor.map(|factor| match factor {
                Factor::Millionths(millionths) => Some(Duration::from_micros(millionths)),
                Factor::Unlimited => None,
            }),
            ..SlackJson::nothing(file)
        }
    }
}
