//! The answers of `kirk query` for programs: `kirk-query/1`.

use std::io;

use kirk_network::promise::Promise;
use kirk_network::{Duration, Time};
use kirk_runtime::{Aftermath, Ended, Failure, Heard, Situation};
use serde::Serialize;

use super::text::because;
use super::{Answer, Line, Picture};
use crate::json::line;

pub(super) fn document(answer: &Answer, situation: &Situation) -> io::Result<String> {
    let label = |event| situation.network().label(event).to_string();
    let heard = answer.heard.iter().map(|(event, at, heard)| HeardJson {
        event: label(*event),
        at: *at,
        verdict: if matches!(heard, Heard::Possible) { "possible" } else { "broken-model" },
        detail: if let Heard::Broken(said, _) = heard { Some(said) } else { None },
        aftermath: if let Heard::Broken(_, aftermath) = heard { Some(aftermath) } else { None },
    });
    let why = answer.waits.iter().map(|waits| WhyJson {
        event: label(waits.events[0]),
        chain: waits
            .events
            .iter()
            .map(|&event| StepJson {
                event: label(event),
                time: waits.ahead.known(event).fixed.map(|fixed| fixed.time),
                done: situation.fixed(event).is_some(),
                because: because(waits, situation, event),
            })
            .collect(),
    });
    line(&QueryJson {
        format: "kirk-query/1",
        file: &answer.file,
        program: &answer.program,
        now: PictureJson::new(&answer.before),
        heard: heard.collect(),
        after: answer.after.as_ref().map(PictureJson::new),
        why: why.collect(),
    })
}

/// What is said of a mission that cannot be promised, whose execution does not begin.
pub(super) fn nothing(file: &str) -> io::Result<String> {
    let now = PictureJson {
        now: Time::ZERO,
        outcome: "failed",
        failure: None,
        guaranteed: false,
        events: Vec::new(),
    };
    let (heard, why) = (Vec::new(), Vec::new());
    line(&QueryJson { format: "kirk-query/1", file, program: "", now, heard, after: None, why })
}

#[derive(Serialize)]
struct QueryJson<'a> {
    format: &'static str,
    file: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    program: &'a str,
    #[serde(flatten)]
    now: PictureJson<'a>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    heard: Vec<HeardJson<'a>>,
    /// How things stand when all that has been heard.
    #[serde(skip_serializing_if = "Option::is_none")]
    after: Option<PictureJson<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    why: Vec<WhyJson>,
}

#[derive(Serialize)]
struct PictureJson<'a> {
    now: Time,
    outcome: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<&'a Failure>,
    guaranteed: bool,
    events: Vec<EventJson<'a>>,
}

impl<'a> PictureJson<'a> {
    fn new(picture: &'a Picture) -> PictureJson<'a> {
        let (outcome, failure) = match &picture.ended {
            Some(Ended::Completed) => ("completed", None),
            Some(Ended::Failed(failure)) => ("failed", Some(failure)),
            Some(Ended::NoPlan) => ("failed", None),
            None => ("running", None),
        };
        PictureJson {
            now: picture.now,
            outcome,
            failure,
            guaranteed: picture.guaranteed,
            events: picture.events.iter().map(|line| EventJson::new(line, picture.now)).collect(),
        }
    }
}

#[derive(Serialize)]
struct EventJson<'a> {
    event: &'a str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    names: Vec<&'a str>,
    whose: &'static str,
    earliest: Time,
    /// `null` if there is no limit.
    latest: Option<Time>,
    exact: ExactJson,
    /// How long until then; nothing if it is done.
    #[serde(skip_serializing_if = "Option::is_none")]
    until: Option<RangeJson<Duration>>,
    /// When it was executed, or heard of.
    #[serde(skip_serializing_if = "Option::is_none")]
    done: Option<Time>,
    /// When its news can come.
    #[serde(skip_serializing_if = "Option::is_none")]
    heard: Option<RangeJson<Time>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    with_driver: Option<Time>,
    #[serde(skip_serializing_if = "Option::is_none")]
    promise: Option<PromiseJson>,
}

#[derive(Serialize)]
struct ExactJson {
    earliest: bool,
    latest: bool,
}

#[derive(Serialize)]
struct RangeJson<T> {
    earliest: T,
    latest: Option<T>,
}

#[derive(Serialize)]
struct PromiseJson {
    /// The earliest time by which it can be promised to happen; `null` if there is none.
    by: Option<Time>,
    /// The latest time before which it can be promised not to happen; `null` if it can be of any.
    not_before: Option<Time>,
}

impl<'a> EventJson<'a> {
    fn new(line: &'a Line, now: Time) -> EventJson<'a> {
        let window = line.left.window;
        let until = |time: Time| time.saturating_since(now).max(Duration::ZERO);
        let names: Vec<&str> = line.names.iter().map(String::as_str).collect();
        EventJson {
            event: names.first().copied().unwrap_or_default(),
            names: if names.len() > 1 { names } else { Vec::new() },
            whose: if line.nature { "nature" } else { "ours" },
            earliest: window.earliest,
            latest: window.latest,
            exact: ExactJson { earliest: line.left.earliest_is_exact, latest: line.left.latest_is_exact },
            until: line
                .done
                .is_none()
                .then(|| RangeJson { earliest: until(window.earliest), latest: window.latest.map(until) }),
            done: line.done,
            heard: line.news.map(|(earliest, latest)| RangeJson { earliest, latest }),
            with_driver: line.with_driver,
            promise: line.promise.map(|Promise { by, from }| PromiseJson { by, not_before: from }),
        }
    }
}

#[derive(Serialize)]
struct HeardJson<'a> {
    event: String,
    at: Time,
    verdict: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    detail: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    aftermath: Option<&'a Aftermath>,
}

#[derive(Serialize)]
struct WhyJson {
    event: String,
    chain: Vec<StepJson>,
}

#[derive(Serialize)]
struct StepJson {
    event: String,
    time: Option<Time>,
    done: bool,
    because: String,
}
