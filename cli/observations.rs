//! News that is given on the command line or in a file: which event, and when.

use std::fmt;

use kirk_compiler::{Code, Diagnostic, Source, Span};
use kirk_network::json::{ReadProblem, parse};
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::Impossible;
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use crate::input::{read, without_mark};

/// The observations given, and what is wrong with them. Each option is a source of its own to point into.
pub(crate) struct Observations {
    /// What the option is called.
    option: &'static str,
    pub(crate) sources: Vec<Source>,
    pub(crate) by_event: Vec<Heard>,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

/// One observation: the event by the name it was given, and where that stands.
pub(crate) struct Heard {
    pub(crate) event: EventId,
    pub(crate) name: String,
    pub(crate) time: Time,
    pub(crate) span: Span,
}

/// Observation files are small.
const LARGEST_OBSERVATIONS: u64 = 16 << 20;

impl Observations {
    /// What was given by an option, and in a file.
    pub(crate) fn collect(
        option: &'static str,
        given: &[String],
        file: Option<&str>,
        network: &Network,
    ) -> Observations {
        let mut all =
            Observations { option, sources: Vec::new(), by_event: Vec::new(), diagnostics: Vec::new() };
        for observation in given {
            all.option(observation, network);
        }
        if let Some(file) = file {
            all.file(file, network);
        }
        all
    }

    fn option(&mut self, option: &str, network: &Network) {
        let source = self.sources.len() as u32;
        self.sources.push(Source::new(self.option, option));
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

    /// What is wrong with news that cannot come then.
    pub(crate) fn impossible(&self, impossible: &Impossible, network: &Network, what_if: bool) -> Diagnostic {
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
        let rehearse = match what_if {
            true => "what has not begun cannot be heard of, whatever the model says",
            false => "`--what-if` rehearses what becomes of the mission if it comes all the same",
        };
        Diagnostic::error(Code::ImpossibleObservation, span, message)
            .help(format!("given what was dispatched, the model allows this news {window}; {rehearse}"))
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
