//! `kirk run`: compiles, proves and executes a mission, and prints its timetable.

use std::fmt;
use std::io;

use kirk_compiler::{Code, Diagnostic, Severity, Source, Span};
use kirk_network::assume::Assumption;
use kirk_network::json::{ReadProblem, parse};
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::execution::FORMAT;
use kirk_runtime::{
    Execution, Failure, Impossible, NoPlan, Outcome, Plan, Reason, Simulation, Strategy, Temper, explained,
};
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use crate::args::{Common, Nature, Run, StrategyName, TextOrJson};
use crate::conflict;
use crate::execute::{self, Show};
use crate::input::{load_all, read, without_mark};
use crate::json::line;
use crate::judge::too_large;
use crate::news::treatment;
use crate::output::{Status, complain, eprint, print};
use crate::report::Reporter;

pub(crate) fn run(arguments: &Run, common: &Common) -> io::Result<Status> {
    if arguments.why && arguments.format == TextOrJson::Json {
        complain(
            "`--why` adds a column to the timetable for people, and `--format json` prints none: leave out one of them",
        );
        return Ok(Status::Wrong);
    }
    let mut input = load_all(&arguments.files, &arguments.selection);
    let plan = match input.network.as_ref().map(Plan::new) {
        None => None,
        Some(Ok(plan)) => Some(Ok(plan)),
        Some(Err(NoPlan::TooLarge)) => {
            input.diagnostics.push(too_large());
            None
        }
        Some(Err(NoPlan::Uncontrollable(conflict))) => Some(Err(conflict)),
    };
    if let (Some(Err(conflict)), Some(network)) = (&plan, &input.network) {
        let told = conflict::told(conflict, network, &input, (Assumption::AsWritten, false));
        input.diagnostics.extend(told.into_iter().map(|told| told.diagnostic));
    }
    let reported = |diagnostic: &Diagnostic| match arguments.format {
        // Nothing but the execution goes to standard output, and nobody looks at notes beside JSON.
        TextOrJson::Json => diagnostic.severity == Severity::Error,
        TextOrJson::Text => true,
    };
    let shown: Vec<Diagnostic> = input.diagnostics.iter().filter(|d| reported(d)).cloned().collect();
    Reporter::new(&input.sources).show(&shown, common)?;
    let plan = match plan {
        None => return Ok(Status::Wrong),
        Some(Err(_)) => {
            if arguments.format == TextOrJson::Json {
                print(&line(&not_executed(&input.program(&arguments.selection)))?)?;
            }
            return Ok(Status::No);
        }
        Some(Ok(plan)) => plan,
    };
    if common.verbose {
        eprint(&treatment(plan.network()))?;
    }
    if !arguments.simulate {
        return execute::execute(arguments, common, &input, plan);
    }
    let given = Observations::collect(arguments, plan.network());
    if !given.diagnostics.is_empty() {
        Reporter::new(&given.sources).show(&given.diagnostics, common)?;
        return Ok(Status::Wrong);
    }
    let simulation = Simulation {
        strategy: match arguments.strategy() {
            StrategyName::Buffer => Strategy::Buffer,
            StrategyName::Optimistic => Strategy::Optimistic,
        },
        nature: match arguments.nature {
            Nature::Upper => Temper::Upper,
            Nature::Lower => Temper::Lower,
            Nature::Random => Temper::Random,
        },
        seed: arguments.seed,
        observations: given.by_event.iter().map(|heard| (heard.event, heard.time)).collect(),
        internal: arguments.internal,
    };
    let explained = match explained(&plan, &input.program(&arguments.selection), &simulation) {
        Ok(explained) => explained,
        Err(impossible) => {
            let diagnostic = given.impossible(&impossible, plan.network());
            Reporter::new(&given.sources).show(&[diagnostic], common)?;
            return Ok(Status::Wrong);
        }
    };
    Show::of_run(arguments).execution(&explained.execution, Some(&explained.dispatcher))
}

/// The record of a mission that was not started because it cannot be promised.
fn not_executed(program: &str) -> Execution {
    Execution {
        format: FORMAT.to_string(),
        program: program.to_string(),
        outcome: Outcome::Failed,
        failure: Some(Failure {
            event: program.to_string(),
            time: Time::ZERO,
            reason: Reason::NotControllable,
            detail: "there is no strategy that works in every case: some bounds do not go together"
                .to_string(),
        }),
        makespan: Time::ZERO,
        seed: None,
        rows: Vec::new(),
    }
}

/// The observations given, and what is wrong with them. Each option is a source of its own to point into.
struct Observations {
    sources: Vec<Source>,
    by_event: Vec<Heard>,
    diagnostics: Vec<Diagnostic>,
}

/// One observation: the event by the name it was given, and where that stands.
struct Heard {
    event: EventId,
    name: String,
    time: Time,
    span: Span,
}

/// Observation files are small.
const LARGEST_OBSERVATIONS: u64 = 16 << 20;

impl Observations {
    fn collect(arguments: &Run, network: &Network) -> Observations {
        let mut given = Observations { sources: Vec::new(), by_event: Vec::new(), diagnostics: Vec::new() };
        for option in &arguments.observe {
            given.option(option, network);
        }
        if let Some(file) = &arguments.observations {
            given.file(file, network);
        }
        given
    }

    fn option(&mut self, option: &str, network: &Network) {
        let source = self.sources.len() as u32;
        self.sources.push(Source::new("--observe", option));
        let whole = Span::new(source, 0, option.len());
        let Some(at) = option.rfind('@') else {
            let message = "an observation is written EVENT@T, such as `drive:end@17.5`";
            self.diagnostics.push(Diagnostic::error(Code::BadObservation, whole, message));
            return;
        };
        match Duration::parse_seconds(&option[at + 1..]) {
            Ok(time) => self.add(&option[..at], time, Span::new(source, 0, at), network),
            Err(error) => {
                let span = Span::new(source, at + 1, option.len());
                let message = format!("`{}`: {error}", &option[at + 1..]);
                let help = "an observation is written EVENT@T, with T in seconds after the start";
                self.diagnostics.push(Diagnostic::error(Code::BadObservation, span, message).help(help));
            }
        }
    }

    fn file(&mut self, file: &str, network: &Network) {
        let source = self.sources.len() as u32;
        let bytes = match read(file, LARGEST_OBSERVATIONS) {
            Ok(bytes) => bytes,
            Err(message) => {
                self.sources.push(Source::new(file, ""));
                self.diagnostics.push(Diagnostic::error(Code::CannotRead, Span::new(source, 0, 0), message));
                return;
            }
        };
        let text = without_mark(&String::from_utf8_lossy(&bytes)).to_string();
        let parsed = parse(&text);
        self.sources.push(Source::new(file, text.as_str()));
        match parsed {
            Ok(ObservationFile(entries)) => {
                for (name, time) in entries {
                    let at = text.find(&format!("\"{name}\"")).map_or(0, |at| at + 1);
                    self.add(&name, time, Span::new(source, at, at + name.len()), network);
                }
            }
            Err(ReadProblem { offset, message }) => {
                let span = Span::new(source, offset, offset);
                let help =
                    "the file is a JSON object of event: time in seconds, such as {\"drive:end\": 17.5}";
                self.diagnostics.push(Diagnostic::error(Code::BadObservation, span, message).help(help));
            }
        }
    }

    fn add(&mut self, name: &str, time: Duration, span: Span, network: &Network) {
        let problem = match network.find(name) {
            None => {
                let names = network.event_ids().filter(|&event| network.link_of(event).is_some());
                let known: Vec<String> = names
                    .flat_map(|event| network.events()[event.index()].names.iter())
                    .filter(|name| !name.internal)
                    .map(|name| name.text.clone())
                    .collect();
                let near = kirk_compiler::nearest(name, known.iter().map(String::as_str));
                let near = near.map(|near| format!("did you mean `{near}`?"));
                let list = match known.as_slice() {
                    [] => "nothing in this mission is Nature's; there is nothing to observe".to_string(),
                    known if known.len() <= 12 => format!("what can be observed: {}", known.join(", ")),
                    known => format!(
                        "what can be observed: {} and {} more",
                        known[..10].join(", "),
                        known.len() - 10
                    ),
                };
                Some((format!("there is no event `{name}`"), near.unwrap_or(list)))
            }
            Some(event) if network.link_of(event).is_none() => Some((
                format!("`{name}` is not Nature's to decide: kirk dispatches it"),
                "only the ends of contingent durations are observed".to_string(),
            )),
            Some(_) if time < Duration::ZERO => Some((
                format!("`{name}` cannot be heard before the mission starts"),
                "times are seconds after the start".to_string(),
            )),
            Some(event) => match self.by_event.iter().find(|heard| heard.event == event) {
                // Another name of a merged event may say the same again.
                Some(known) if known.time.since_origin() == time => None,
                Some(known) => Some((
                    format!("`{name}` is observed twice"),
                    match known.name.eq_ignore_ascii_case(name) {
                        true => "news of an event arrives once".to_string(),
                        false => format!(
                            "`{}` and `{name}` are names of one event, and news of an event arrives once",
                            known.name
                        ),
                    },
                )),
                None => {
                    let time = Time::after_origin(time);
                    self.by_event.push(Heard { event, name: name.to_string(), time, span });
                    None
                }
            },
        };
        if let Some((message, help)) = problem {
            self.diagnostics.push(Diagnostic::error(Code::BadObservation, span, message).help(help));
        }
    }

    fn impossible(&self, impossible: &Impossible, network: &Network) -> Diagnostic {
        let Impossible { event, time, earliest, latest } = impossible;
        let name = network.label(*event);
        let span = self
            .by_event
            .iter()
            .find(|heard| heard.event == *event)
            .map_or(Span::default(), |heard| heard.span);
        let message = match latest {
            _ if time < earliest => {
                format!("news of `{name}` at {time} s is too early: it cannot arrive before {earliest} s")
            }
            Some(latest) if time > latest => {
                format!("news of `{name}` at {time} s is too late: it cannot arrive after {latest} s")
            }
            _ => format!("news of `{name}` at {time} s contradicts the other observations"),
        };
        let window = match latest {
            Some(latest) => format!("from {earliest} to {latest} s"),
            None => format!("from {earliest} s on"),
        };
        Diagnostic::error(Code::ImpossibleObservation, span, message)
            .help(format!("given what was dispatched, the model allows this news {window}"))
    }
}

/// A JSON object of event: time, in order, nothing lost.
struct ObservationFile(Vec<(String, Duration)>);

impl<'de> Deserialize<'de> for ObservationFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ObservationFile, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = ObservationFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a JSON object of event: time")
            }

            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<ObservationFile, M::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(ObservationFile(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}
