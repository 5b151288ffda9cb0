//! From the text of a network file to a network, or everything that is wrong with it, each in its place.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;

use super::element::Element;
use super::fields::{CONTINGENT, Content, Fields, REQUIREMENT};
use super::parse::parse;
use super::{FORMAT, ReadProblem};
use crate::model::{
    ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement, normal_name,
};
use crate::nearest::nearest;
use crate::source_map::SourceMap;
use crate::time::{Bound, Duration};

/// Reads a network file, and remembers where its constraints stand.
pub(super) fn read(text: &str) -> Result<(Network, SourceMap), Vec<ReadProblem>> {
    let Fields(fields) = parse(text).map_err(|problem| vec![problem])?;
    let mut reader = Reader { text, problems: Vec::new(), event_of: BTreeMap::new() };
    let file = reader.file(fields);
    let network = reader.network(&file);
    match network {
        Some(found) if reader.problems.is_empty() => Ok(found),
        _ => {
            reader.problems.sort_by_key(|problem| problem.offset);
            Err(reader.problems)
        }
    }
}

/// The fields of a network, and those that it has to have.
const FIELDS: [&str; 7] = ["format", "name", "time_unit", "origin", "events", "requirements", "contingents"];
const REQUIRED: [&str; 3] = ["format", "origin", "events"];

/// The fields that are there, not yet looked into.
type File<'a> = BTreeMap<String, &'a RawValue>;

struct EventText {
    id: String,
    names: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RequirementText {
    from: String,
    to: String,
    #[serde(default)]
    lower: Option<Duration>,
    #[serde(default)]
    upper: Option<Duration>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ContingentText {
    from: String,
    to: String,
    lower: Duration,
    upper: Duration,
    #[serde(default)]
    delay: Option<(Duration, Option<Duration>)>,
}

impl<'de> Deserialize<'de> for EventText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<EventText, D::Error> {
        struct EventVisitor;
        impl<'de> Visitor<'de> for EventVisitor {
            type Value = EventText;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "an event: a name, or {{\"id\": name, \"names\": [name, ...]}}")
            }

            fn visit_str<E>(self, id: &str) -> Result<EventText, E> {
                Ok(EventText { id: id.to_string(), names: Vec::new() })
            }

            fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<EventText, M::Error> {
                #[derive(Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Fields {
                    id: String,
                    #[serde(default)]
                    names: Vec<String>,
                }
                let Fields { id, names } =
                    Fields::deserialize(serde::de::value::MapAccessDeserializer::new(map))?;
                Ok(EventText { id, names })
            }
        }
        deserializer.deserialize_any(EventVisitor)
    }
}

struct Reader<'a> {
    text: &'a str,
    problems: Vec<ReadProblem>,
    /// Every name, in lower case.
    event_of: BTreeMap<String, EventId>,
}

/// What a network is made of, where it stands.
struct Elements<'a> {
    origin: Option<&'a RawValue>,
    requirements: Vec<&'a RawValue>,
    contingents: Vec<&'a RawValue>,
}

impl<'a> Elements<'a> {
    /// The element that something is wrong with.
    fn at_fault(&self, error: &ModelError) -> Option<&'a RawValue> {
        match (error.requirement(), error.link()) {
            (Some(index), _) => self.requirements.get(index).copied(),
            (_, Some(index)) => self.contingents.get(index).copied(),
            (None, None) => self.origin,
        }
    }
}

fn bound(duration: Option<Duration>) -> Bound {
    duration.map_or(Bound::Infinite, Bound::Finite)
}

impl<'a> Reader<'a> {
    fn file(&mut self, fields: Vec<(String, &'a RawValue)>) -> File<'a> {
        let mut file = File::new();
        for (name, raw) in fields {
            if !FIELDS.contains(&name.as_str()) {
                let [others @ .., last] = FIELDS;
                let known = format!("`{}` and `{last}`", others.join("`, `"));
                self.problem(raw, format!("a network has no field `{name}`; it has {known}"));
            } else if file.insert(name.clone(), raw).is_some() {
                self.problem(raw, format!("the field `{name}` is there twice"));
            }
        }
        for name in REQUIRED.iter().filter(|name| !file.contains_key(**name)) {
            let message = format!("the field `{name}` is missing");
            self.problems.push(ReadProblem { offset: 0, message });
        }
        file
    }

    /// What a field says, or its default if it is not there.
    fn field<T: Deserialize<'a> + Default>(&mut self, file: &File<'a>, name: &str) -> T {
        file.get(name).and_then(|raw| self.element(name, raw)).unwrap_or_default()
    }

    /// An element that has to be an object with these fields.
    fn object<T: Deserialize<'a>>(
        &mut self,
        name: &str,
        raw: &'a RawValue,
        fields: &[(&'static str, Content)],
    ) -> Option<T> {
        if !raw.get().starts_with('{') {
            self.problem(raw, format!("{name}: expected an object, {{\"from\": ..., \"to\": ..., ...}}"));
            return None;
        }
        if let Ok(found) = serde_json::from_str(raw.get()) {
            return Some(found);
        }
        let before = self.problems.len();
        self.look_into(name, raw, fields);
        if self.problems.len() == before { self.element(name, raw) } else { None }
    }

    /// Says what is wrong with the fields of an object that could not be read, each in its place.
    fn look_into(&mut self, name: &str, raw: &'a RawValue, fields: &[(&'static str, Content)]) {
        let Ok(Fields(found)) = serde_json::from_str::<Fields<'a>>(raw.get()) else { return };
        for (index, (field, value)) in found.iter().enumerate() {
            let Some((known, content)) = fields.iter().find(|(known, _)| known == field) else {
                let names: Vec<&str> = fields.iter().map(|(known, _)| *known).collect();
                let near = match nearest(field, names.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("the fields are `{}`", names.join("`, `")),
                };
                self.problem(value, format!("{name}: there is no field `{field}`; {near}"));
                continue;
            };
            if found[..index].iter().any(|(other, _)| other == field) {
                self.problem(value, format!("{name}: the field `{field}` is there twice"));
            } else if let Err(why) = content.check(value.get()) {
                self.problem(value, format!("{name}: `{known}` must be {}, not {why}", content.describe()));
            }
        }
        for (known, content) in fields {
            let required = !matches!(content, Content::Bound | Content::Delay);
            if required && !found.iter().any(|(field, _)| field == known) {
                self.problem(raw, format!("{name}: the field `{known}` is missing"));
            }
        }
    }

    fn network(&mut self, file: &File<'a>) -> Option<(Network, SourceMap)> {
        self.expect(file, "format", FORMAT, |format| {
            format!("the format is `{format}`; this kirk reads `{FORMAT}`")
        });
        self.expect(file, "time_unit", "s", |unit| {
            format!("the time unit is `{unit}`; kirk networks are in seconds, `s`")
        });
        let name: String = self.field(file, "name");
        let events: Vec<&RawValue> = self.field(file, "events");
        let elements = Elements {
            origin: file.get("origin").copied(),
            requirements: self.field(file, "requirements"),
            contingents: self.field(file, "contingents"),
        };
        let events = self.events(&events);
        let origin = self.origin(&elements);
        let requirements = self.requirements(&elements);
        let contingents = self.contingents(&elements);
        if !self.problems.is_empty() {
            return None;
        }
        match Network::new(name, origin?, events, requirements, contingents) {
            Ok(network) => Some((network, self.places(&elements))),
            Err(errors) => {
                for error in errors {
                    self.problem(elements.at_fault(&error)?, error.to_string());
                }
                None
            }
        }
    }

    /// Refuses a field that is there and says anything but what it has to.
    fn expect(&mut self, file: &File<'a>, name: &str, wanted: &str, message: impl Fn(&str) -> String) {
        if let Some(raw) = file.get(name)
            && let Some(found) = self.element::<String>(name, raw)
            && found != wanted
        {
            self.problem(raw, message(&found));
        }
    }

    fn events(&mut self, list: &[&'a RawValue]) -> Vec<Event> {
        let mut events = Vec::new();
        for (at, &raw) in list.iter().enumerate() {
            let Some(event) = self.element::<EventText>(&format!("events[{at}]"), raw) else { continue };
            let id = EventId(events.len() as u32);
            let mut names = vec![event.id];
            names.extend(event.names.into_iter().filter(|name| *name != names[0]).collect::<Vec<_>>());
            for name in &names {
                if name.is_empty() {
                    self.problem(raw, format!("events[{at}]: an event needs a name"));
                }
                if self.event_of.insert(normal_name(name), id).is_some() {
                    let message =
                        format!("events[{at}]: the name `{name}` is used already (case does not count)");
                    self.problem(raw, message);
                }
            }
            let names = names.into_iter().map(|text| Name { text, internal: false }).collect();
            events.push(Event { names });
        }
        events
    }

    fn origin(&mut self, elements: &Elements<'a>) -> Option<EventId> {
        let raw = elements.origin?;
        let name = self.element::<String>("origin", raw)?;
        self.find(&name, "origin", raw)
    }

    fn requirements(&mut self, elements: &Elements<'a>) -> Vec<Requirement> {
        let mut requirements = Vec::new();
        for (at, &raw) in elements.requirements.iter().enumerate() {
            let element = format!("requirements[{at}]");
            let Some(found) = self.object::<RequirementText>(&element, raw, &REQUIREMENT) else { continue };
            let ends = (self.find(&found.from, &element, raw), self.find(&found.to, &element, raw));
            if let (Some(from), Some(to)) = ends {
                let (lower, upper) = (bound(found.lower), bound(found.upper));
                requirements.push(Requirement { from, to, lower, upper });
            }
        }
        requirements
    }

    fn contingents(&mut self, elements: &Elements<'a>) -> Vec<ContingentLink> {
        let mut contingents = Vec::new();
        for (at, &raw) in elements.contingents.iter().enumerate() {
            let element = format!("contingents[{at}]");
            let Some(found) = self.object::<ContingentText>(&element, raw, &CONTINGENT) else { continue };
            let ends = (self.find(&found.from, &element, raw), self.find(&found.to, &element, raw));
            let delay = found.delay.map_or(Delay::NONE, |(min, max)| Delay { min, max: bound(max) });
            if let (Some(from), Some(to)) = ends {
                let ContingentText { lower, upper, .. } = found;
                contingents.push(ContingentLink { from, to, lower, upper, delay });
            }
        }
        contingents
    }

    fn find(&mut self, name: &str, element: &str, raw: &'a RawValue) -> Option<EventId> {
        let found = self.event_of.get(&normal_name(name)).copied();
        if found.is_none() {
            let near = nearest(name, self.event_of.keys().map(String::as_str));
            let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            self.problem(raw, format!("{element}: there is no event `{name}`{help}"));
        }
        found
    }

    fn places(&self, elements: &Elements<'a>) -> SourceMap {
        let range = |raw: &&RawValue| {
            let start = self.offset(raw);
            start..start + raw.get().len()
        };
        SourceMap {
            requirements: elements.requirements.iter().map(|raw| [range(raw), range(raw)]).collect(),
            contingents: elements.contingents.iter().map(|raw| [range(raw), range(raw)]).collect(),
        }
    }

    fn element<T: Deserialize<'a>>(&mut self, name: &str, raw: &'a RawValue) -> Option<T> {
        let problem = match parse(raw.get()) {
            Ok(value) => return Some(value),
            Err(problem) => problem,
        };
        let offset = self.offset(raw) + problem.offset;
        self.problems.push(ReadProblem { offset, message: format!("{name}: {}", problem.message) });
        None
    }

    fn problem(&mut self, raw: &'a RawValue, message: String) {
        self.problems.push(ReadProblem { offset: self.offset(raw), message });
    }

    /// Where a borrowed value is in the text.
    fn offset(&self, raw: &'a RawValue) -> usize {
        Element { text: self.text, raw }.offset()
    }
}
