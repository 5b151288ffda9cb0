//! News that is given on the command line or in a file: which event, and when.

use std::fmt;

use kirk_compiler::{Diagnostic, Source, Span};
use kirk_network::json::{ReadProblem, parse};
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::Impossible;
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use crate::input::{read, without_mark};
use crate::wording::Problem;

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
        let Some(at) = option.rfind('@') else { return self.wrong(Problem::NoTime, whole) };
        match Duration::parse_seconds(&option[at + 1..]) {
            Ok(time) => self.add(&option[..at], time, Span::new(source, 0, at), network),
            Err(error) => {
                let span = Span::new(source, at + 1, option.len());
                self.wrong(Problem::BadTime(&option[at + 1..], error), span);
            }
        }
    }

    fn file(&mut self, file: &str, network: &Network) {
        let source = self.sources.len() as u32;
        let bytes = match read(file, LARGEST_OBSERVATIONS) {
            Ok(bytes) => bytes,
            Err(message) => {
                self.sources.push(Source::new(file, ""));
                return self.wrong(Problem::Unreadable(message), Span::new(source, 0, 0));
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
                self.wrong(Problem::BadObservations(message), Span::new(source, offset, offset));
            }
        }
    }

    fn add(&mut self, name: &str, time: Duration, span: Span, network: &Network) {
        let Some(event) = network.find(name) else {
            let names = network.event_ids().filter(|&event| network.link_of(event).is_some());
            let known: Vec<&str> = names.flat_map(|event| network.written(event)).collect();
            let near = kirk_compiler::nearest(name, known.iter().copied());
            return self.wrong(Problem::UnknownEvent { name, known: &known, near }, span);
        };
        if network.link_of(event).is_none() {
            return self.wrong(Problem::NotNatures(name), span);
        }
        if time < Duration::ZERO {
            return self.wrong(Problem::BeforeStart(name), span);
        }
        match self.by_event.iter().find(|heard| heard.event == event) {
            // Another name of a merged event may say the same again.
            Some(known) if known.time.since_origin() == time => {}
            Some(known) => {
                let problem = Problem::HeardTwice { name, other: &known.name }.at(span);
                self.diagnostics.push(problem);
            }
            None => {
                let time = Time::after_origin(time);
                self.by_event.push(Heard { event, name: name.to_string(), time, span });
            }
        }
    }

    fn wrong(&mut self, problem: Problem<'_>, span: Span) {
        self.diagnostics.push(problem.at(span));
    }

    /// What is wrong with news that cannot come then.
    pub(crate) fn impossible(&self, impossible: &Impossible, network: &Network, what_if: bool) -> Diagnostic {
        let heard = self.by_event.iter().find(|heard| heard.event == impossible.event);
        let span = heard.map_or(Span::default(), |heard| heard.span);
        Problem::Impossible { name: network.label(impossible.event), impossible, what_if }.at(span)
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
