//! `kirk slack`: how much is left of a "yes": how far each bound can move, and how late everything may start.

use std::io;

use kirk_compiler::episode::Kind;
use kirk_compiler::repair::what;
use kirk_compiler::{Origins, Side, Span, Written, events_of, measurable};
use kirk_network::merge::{Merged, merge};
use kirk_network::promise::{promises, stretch};
use kirk_network::slack::{Factor, Slack, beyond, common_factor, slack};
use kirk_network::stnu::TooLarge;
use kirk_network::vary::Knob;
use kirk_network::walk::{self, walk};
use kirk_network::{Bound, Duration, EventId, Network, Part, Time};
use serde::Serialize;

use crate::args::{Common, SlackOf, TextOrJson};
use crate::foreign::one_line;
use crate::input::{Loaded, load_all};
use crate::json::line;
use crate::judge::{Judged, judge};
use crate::output::{Status, print, print_line};
use crate::report::{Reporter, SpanJson};

pub(crate) fn slack_of(arguments: &SlackOf, common: &Common) -> io::Result<Status> {
    let mut input = load_all(&arguments.files, &arguments.selection);
    input.for_one_alone("`kirk slack`");
    let judged = judge(&mut input);
    let reporter = Reporter::new(&input.sources);
    let file = arguments.files.join(" ");
    let is_yes = judged.as_ref().is_some_and(Judged::is_yes);
    let left = match (&input.network, is_yes) {
        (Some(network), true) => measure(network, &input).unwrap_or_default(),
        _ => None,
    };
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
struct Left {
    /// The tightest first.
    bounds: Vec<Measured>,
    /// What the tightest rests on.
    critical: Vec<Step>,
    activities: Vec<Activity>,
    news: Vec<News>,
    factor: Option<Factor>,
}

struct Measured {
    slack: Slack,
    what: String,
    side: Side,
    place: Span,
}

/// One step of what a bound rests on: what it is, and what it needs.
#[derive(Serialize)]
struct Step {
    what: String,
    needs: Duration,
}

/// An activity of ours.
#[derive(Serialize)]
struct Activity {
    name: String,
    latest_start: Option<Time>,
    may_take: Option<Bound>,
}

/// How late the news of an event may be alone: its longest delay, and the longest it could have.
#[derive(Serialize)]
struct News {
    event: String,
    value: Bound,
    most: Bound,
}

fn measure(network: &Network, input: &Loaded) -> Result<Option<Left>, TooLarge> {
    let Some(origins) = input.origins() else { return Ok(None) };
    let knobs = knobs(network, origins);
    let all: Vec<Knob> = knobs.iter().map(|(knob, ..)| knob.clone()).collect();
    let Some(found) = slack(network, &all)? else { return Ok(None) };
    let measured = found.into_iter().zip(knobs).map(|(slack, (_, what, written))| Measured {
        slack,
        what,
        side: written.side,
        place: written.place(),
    });
    let mut bounds: Vec<Measured> = measured.collect();
    bounds.sort_by_key(|bound| bound.slack.room.map_or(i64::MAX, Duration::as_micros));
    let tightest = bounds.iter().find(|bound| bound.slack.room.is_some());
    let conflict = match tightest {
        Some(tightest) => beyond(network, &tightest.slack)?,
        None => None,
    };
    let steps = conflict.and_then(|conflict| walk(network, &conflict)).unwrap_or_default();
    // A microsecond further it would be one too many; what is told is what is written.
    let step = |step: walk::Step| {
        let bound = step.part.bound(network);
        let needs = if step.needs < Duration::ZERO { -bound } else { bound };
        Some(Step { what: what(step.part, origins.of(step.part)?.0)?, needs })
    };
    let critical = steps.into_iter().filter_map(step).collect();
    let news = bounds.iter().filter_map(|bound| match bound.slack.knob.parts()[0] {
        Part::DelayMax(index) => {
            let event = network.label(network.contingents()[index].to).to_string();
            Some(News { event, value: bound.slack.value, most: bound.slack.most })
        }
        _ => None,
    });
    let news = news.collect();
    let (activities, factor) = (activities(network, input)?, common_factor(network)?);
    Ok(Some(Left { bounds, critical, activities, news, factor }))
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

/// The activities of ours, with the latest start that can be promised and how long each may be made to take. Of a network, the
/// events of ours.
fn activities(network: &Network, input: &Loaded) -> Result<Vec<Activity>, TooLarge> {
    let Merged { network: merged, event_of, .. } = merge(network);
    let ours = |event: EventId| {
        let event = event_of[event.index()];
        merged.link_of(event).is_none() && event != merged.origin()
    };
    let starts: Vec<(String, EventId, Option<usize>)> =
        match input.compilation().and_then(|it| it.episodes.as_ref()) {
            Some(root) => events_of(root)
                .into_iter()
                .filter(|(episode, (start, _))| episode.kind == Kind::Primitive && ours(*start))
                .map(|(episode, (start, end))| {
                    let takes = network.requirements().iter().position(|it| (it.from, it.to) == (start, end));
                    (episode.name.clone(), start, takes)
                })
                .collect(),
            None => {
                let events = network.event_ids().filter(|&event| ours(event));
                events.map(|event| (network.label(event).to_string(), event, None)).collect()
            }
        };
    let events: Vec<EventId> = starts.iter().map(|(_, event, _)| *event).collect();
    let promised = promises(network, &events)?.unwrap_or_default();
    let mut activities = Vec::new();
    for ((name, _, takes), promise) in starts.into_iter().zip(promised) {
        let stretch = takes.map(|index| stretch(network, index)).transpose()?.flatten();
        activities.push(Activity { name, latest_start: promise.from, may_take: stretch });
    }
    Ok(activities)
}

impl Left {
    fn lines(&self, reporter: &Reporter<'_>) -> Vec<String> {
        let mut lines = vec![String::new(), format!("{:>12}  {:>10}  {:<22}  what", "room", "now", "may be")];
        for Measured { slack, what, place, side } in &self.bounds {
            // News that comes at once is among the news.
            if *side == Side::MaxDelay && slack.value == Bound::ZERO {
                continue;
            }
            let room = slack.room.map_or("any".to_string(), |room| format!("{room} s"));
            let at = reporter.at(*place).map_or(String::new(), |at| format!("  {at}"));
            lines.push(format!(
                "{room:>12}  {:>10}  {:<22}  {what}, {}{at}",
                value(slack.value),
                slack.range(),
                side.word()
            ));
        }
        if !self.critical.is_empty() {
            lines.extend([String::new(), "what the tightest of them rests on".to_string()]);
            for Step { what, needs } in &self.critical {
                let needed = if *needs < Duration::ZERO {
                    format!("{} s are there", -*needs)
                } else {
                    format!("needs {needs} s")
                };
                lines.push(format!("{needed:>22}  {what}"));
            }
        }
        if !self.activities.is_empty() {
            lines.extend([String::new(), format!("{:>12}  {:>12}  activity", "latest start", "may take")]);
            for Activity { name, latest_start, may_take } in &self.activities {
                let latest = latest_start.map_or("any".to_string(), |latest| format!("{latest} s"));
                let takes = may_take.map_or(String::new(), value);
                lines.push(format!("{latest:>12}  {takes:>12}  {name}"));
            }
        }
        if !self.news.is_empty() {
            lines.extend([String::new(), format!("{:>12}  {:>12}  news of", "late by", "at most")]);
            for News { event, value: now, most } in &self.news {
                lines.push(format!("{:>12}  {:>12}  {event}", value(*now), value(*most)));
            }
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
}

fn value(bound: Bound) -> String {
    bound.finite().map_or("any".to_string(), |bound| format!("{bound} s"))
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
    value: Bound,
    least: Bound,
    most: Bound,
    room: Option<Duration>,
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

    fn new(file: &'a str, left: &'a Left, reporter: &'a Reporter<'_>) -> SlackJson<'a> {
        let bound = |Measured { slack, what, side, place }: &'a Measured| BoundJson {
            what,
            file: reporter.name(*place),
            span: reporter.span_json(*place),
            bound: *side,
            value: slack.value,
            least: slack.least,
            most: slack.most,
            room: slack.room,
        };
        SlackJson {
            controllable: true,
            slack: left.bounds.iter().map(bound).collect(),
            critical: &left.critical,
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
