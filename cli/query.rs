//! `kirk query`: what can still happen in an execution, what it waits for, and what if.

mod json;
mod text;

use std::io;

use kirk_compiler::nearest;
use kirk_network::left::Left;
use kirk_network::promise::Promise;
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::execution::is_record;
use kirk_runtime::journal::{is_journal, read as read_journal};
use kirk_runtime::{Ended, Heard, Situation, Waits};

use crate::args::{Common, Query, Selection, TextOrJson};
use crate::input::{Bytes, load_begun, read};
use crate::observations::Observations;
use crate::output::{Status, complain, print, remark};
use crate::replay::LARGEST_JOURNAL;
use crate::report::Reporter;
use crate::run::plan_of;
use crate::verify::execution_of;
use crate::wording::{Problem, no_event};

pub(crate) fn query(arguments: &Query, common: &Common) -> io::Result<Status> {
    let wrong = |message: String| {
        complain(&message);
        Ok(Status::Wrong)
    };
    let at = match arguments.at.as_deref().map(moment).transpose() {
        Ok(at) => at,
        Err(message) => return wrong(message),
    };
    let Subject { program, mut situation } = match subject(arguments, at, common)? {
        Ok(subject) => subject,
        Err(status) => {
            if status == Status::No && arguments.format == TextOrJson::Json {
                print(&json::nothing(&arguments.files.join(" "))?)?;
            }
            return Ok(status);
        }
    };
    let network = situation.network().clone();
    let find = |names: &[String]| -> Result<Vec<EventId>, String> {
        names.iter().map(|name| event(&network, name)).collect()
    };
    let named = find(&arguments.event).and_then(|events| Ok((events, find(&arguments.why)?)));
    let (events, whys) = match named {
        Ok(named) => named,
        Err(message) => return wrong(message),
    };
    let mut given = Observations::collect("--heard", &arguments.heard, None, &network);
    given.by_event.sort_by_key(|heard| heard.time);
    let chosen = (!arguments.event.is_empty()).then_some(events.as_slice());
    let mut answer = Answer {
        file: arguments.files.join(" "),
        program,
        before: picture(&situation, chosen),
        details: chosen.is_some(),
        heard: Vec::new(),
        after: None,
        waits: Vec::new(),
    };
    let asked = if given.diagnostics.is_empty() { given.by_event.as_slice() } else { &[] };
    for observation in asked {
        match situation.hear(observation.event, observation.time) {
            Ok(heard) => answer.heard.push((observation.event, observation.time, heard)),
            Err(unheard) => {
                let (name, time) = (observation.name.as_str(), observation.time);
                let problem =
                    Problem::Unheard { name, time, why: unheard, network: &network, now: situation.now() };
                given.diagnostics.push(problem.at(observation.span));
                break;
            }
        }
    }
    if !given.diagnostics.is_empty() {
        Reporter::new(&given.sources).show(&given.diagnostics, common)?;
        return Ok(Status::Wrong);
    }
    if !answer.heard.is_empty() {
        answer.after = Some(picture(&situation, chosen));
    }
    answer.waits = whys.into_iter().map(|event| situation.waits(event)).collect();
    print(&match arguments.format {
        TextOrJson::Json => json::document(&answer, &situation)?,
        TextOrJson::Text => text::text(&answer, &situation),
    })?;
    Ok(answer.status())
}

/// All that was asked for.
struct Answer {
    file: String,
    program: String,
    before: Picture,
    /// All is to be said about some events.
    details: bool,
    heard: Vec<(EventId, Time, Heard)>,
    after: Option<Picture>,
    waits: Vec<Waits>,
}

impl Answer {
    /// Yes if all can be kept, and Nature has kept to the model.
    fn status(&self) -> Status {
        let last = self.after.as_ref().unwrap_or(&self.before);
        if last.guaranteed && !self.is_broken() { Status::Yes } else { Status::No }
    }

    fn is_broken(&self) -> bool {
        self.heard.iter().any(|(.., heard)| matches!(heard, Heard::Broken(..)))
    }
}

/// How things stand at a time.
struct Picture {
    now: Time,
    ended: Option<Ended>,
    /// Whatever Nature does, as the model says, all can be kept.
    guaranteed: bool,
    events: Vec<Line>,
}

/// How it stands with an event.
struct Line {
    event: EventId,
    names: Vec<String>,
    nature: bool,
    left: Left,
    /// When it was executed or heard of, if it was.
    done: Option<Time>,
    /// When its news can come.
    news: Option<(Time, Option<Time>)>,
    with_driver: Option<Time>,
    /// By when it can be promised, and not before when.
    promise: Option<Promise>,
}

impl Line {
    fn label(&self) -> String {
        self.names.join(", ")
    }
}

/// How it stands with the events that are chosen, or with all that are to come, in order.
fn picture(situation: &Situation, chosen: Option<&[EventId]>) -> Picture {
    let ended = situation.ended().cloned();
    let guaranteed = situation.can_be_kept();
    let left = if guaranteed { situation.left() } else { Vec::new() };
    let network = situation.network();
    let line = |event: EventId| {
        let left = *left.get(event.index())?;
        let mut names: Vec<String> = network.written(event).map(str::to_string).collect();
        if names.is_empty() && chosen.is_some() {
            names.push(network.label(event).to_string());
        }
        let nature = network.link_of(event).is_some();
        let heard = situation.heard_of(event);
        let done = if nature { heard } else { situation.fixed(event).map(|(time, _)| time) };
        let over =
            done.is_some() || nature && left.window.latest.is_some_and(|latest| latest <= situation.now());
        if names.is_empty() || chosen.is_none() && over {
            return None;
        }
        Some(Line {
            event,
            names,
            nature,
            left,
            done,
            news: if heard.is_none() { situation.news(&left, event) } else { None },
            with_driver: situation.with_driver(event),
            promise: if chosen.is_some() && !nature && done.is_none() {
                situation.promise(event)
            } else {
                None
            },
        })
    };
    let mut events: Vec<Line> = match chosen {
        Some(events) => events.iter().filter_map(|&event| line(event)).collect(),
        None => network.event_ids().filter_map(line).collect(),
    };
    if chosen.is_none() {
        let latest = |line: &Line| line.left.window.latest.unwrap_or(Time::MAX);
        events.sort_by_key(|line| (line.left.window.earliest, latest(line), situation.order(line.event)));
    }
    Picture { now: situation.now(), ended, guaranteed, events }
}

/// What is asked.
struct Subject {
    program: String,
    situation: Situation,
}

/// What the files lead to; otherwise what is wrong with them has been said. The first says what it is, and is read once: it may be
/// a pipe.
fn subject(arguments: &Query, at: Option<Time>, common: &Common) -> io::Result<Result<Subject, Status>> {
    let first = read(&arguments.files[0], LARGEST_JOURNAL);
    match &first {
        Ok(bytes) if is_journal(bytes) => Ok(of_journal(arguments, bytes, at, common)),
        Ok(bytes) if is_record(bytes) => of_record(arguments, first, at, common),
        _ => {
            let mission = mission(&arguments.files, Some(first), &arguments.selection, common)?;
            Ok(mission.map(|(program, plan)| {
                let mut situation = Situation::of_mission(&plan);
                situation.pass(at.unwrap_or(Time::ZERO));
                Subject { program, situation }
            }))
        }
    }
}

/// A journal is read as it is, without its lock: the mission may be running, and its last record half written.
fn of_journal(arguments: &Query, bytes: &[u8], at: Option<Time>, common: &Common) -> Result<Subject, Status> {
    let file = &arguments.files[0];
    let Selection { package, entry, .. } = &arguments.selection;
    if arguments.files.len() > 1 || package.is_some() || entry.is_some() {
        complain(&format!("`{file}` is a journal, which says what its mission is: name nothing else"));
        return Err(Status::Wrong);
    }
    let found = read_journal(bytes).and_then(|journal| {
        if journal.torn > 0 && !common.quiet {
            remark(&format!("the last record is not whole, {} bytes of it; it is left out", journal.torn));
        }
        let situation = Situation::of_journal(&journal, at)?;
        Ok(Subject { program: journal.start.program, situation })
    });
    found.map_err(|bad| {
        complain(&format!("`{file}`, {bad}"));
        Status::Wrong
    })
}

fn of_record(
    arguments: &Query,
    bytes: Bytes,
    at: Option<Time>,
    common: &Common,
) -> io::Result<Result<Subject, Status>> {
    let (file, files) = (&arguments.files[0], &arguments.files[1..]);
    if files.is_empty() {
        complain(&format!(
            "`{file}` is a record, which does not say what its mission was: name that after it"
        ));
        return Ok(Err(Status::Wrong));
    }
    if file == "-" && files.iter().any(|file| file == "-") {
        complain("the record and the mission cannot both be standard input");
        return Ok(Err(Status::Wrong));
    }
    let execution = match execution_of(file, bytes) {
        Ok(execution) => execution,
        Err(wrong) => {
            let (source, diagnostic) = *wrong;
            Reporter::new(&[source]).show(&[diagnostic], common)?;
            return Ok(Err(Status::Wrong));
        }
    };
    let selection = Selection { otherwise: Some(execution.program.clone()), ..arguments.selection.clone() };
    let (program, plan) = match mission(files, None, &selection, common)? {
        Ok(mission) => mission,
        Err(status) => return Ok(Err(status)),
    };
    Ok(Situation::of_record(&plan, &execution, at).map(|situation| Subject { program, situation }).map_err(
        |message| {
            complain(&format!("`{file}` is no record of `{}`: {message}", files.join(" ")));
            Status::Wrong
        },
    ))
}

/// A mission that is proven, and what it is called. The first of its files may have been read already.
fn mission(
    files: &[String],
    first: Option<Bytes>,
    selection: &Selection,
    common: &Common,
) -> io::Result<Result<(String, kirk_runtime::Plan), Status>> {
    let mut input = load_begun(files, first, selection);
    input.for_one_alone("`kirk query`");
    let plan = plan_of(&mut input);
    // Notes on the mission are no answer.
    let quiet = Common { quiet: true, ..common.clone() };
    Reporter::new(&input.sources)
        .show(&input.diagnostics, if matches!(plan, Some(Ok(_))) { &quiet } else { common })?;
    Ok(match plan {
        None => Err(Status::Wrong),
        Some(Err(_)) => Err(Status::No),
        Some(Ok(plan)) => Ok((input.program(selection), plan)),
    })
}

/// A time of the mission that is given in seconds.
fn moment(text: &str) -> Result<Time, String> {
    match Duration::parse_seconds(text) {
        Ok(time) if time >= Duration::ZERO => Ok(Time::after_origin(time)),
        Ok(_) => {
            Err(format!("`--at {text}` is before the mission starts: times are seconds after the start"))
        }
        Err(error) => {
            Err(format!("`--at {text}`: {error}; a time is in seconds after the start, such as 17.5"))
        }
    }
}

/// The event of a name.
fn event(network: &Network, name: &str) -> Result<EventId, String> {
    network.find(name).ok_or_else(|| {
        let names = network.event_ids().flat_map(|event| network.written(event));
        no_event(name, nearest(name, names))
    })
}
