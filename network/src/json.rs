//! The network file `kirk-network/1`: seconds in decimal, exact to a microsecond, nothing unknown.

mod fields;

use serde::de::{Deserializer, Error as _, MapAccess, Visitor};
use serde::ser::{SerializeMap, SerializeSeq, Serializer};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use fields::{CONTINGENT, Content, REQUIREMENT, nearest, problem};

pub use fields::locate;

use crate::controllability::Wait;
use crate::dispatchable::Dispatchable;
use crate::model::{
    ContingentLink, Delay, Event, EventId, ModelError, Name, Network, Requirement, normal_name,
};
use crate::places::Places;
use crate::stnu::{Edge, Link, NONE};
use crate::time::{Bound, Duration};

/// The `format` of the files read and written here.
pub const FORMAT: &str = "kirk-network/1";

/// What is wrong with a network file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadProblem {
    /// Byte offset into the text.
    pub offset: usize,
    /// What was expected, what is there, and which element it is in (`requirements[3]`).
    pub message: String,
}

/// Reads a network file, or lists everything that is wrong with it.
pub fn read(text: &str) -> Result<Network, Vec<ReadProblem>> {
    read_with_places(text).map(|(network, _)| network)
}

/// Reads a network file as [`read`] does, and remembers where its constraints stand.
pub fn read_with_places(text: &str) -> Result<(Network, Places), Vec<ReadProblem>> {
    let Fields(fields) = serde_json::from_str(text).map_err(|error| vec![locate(text, &error)])?;
    let mut reader = Reader { text, problems: Vec::new() };
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

/// Writes a network as one line of JSON that reads back equal, except for the names no user wrote: the file has them
/// only for events that have no other.
pub fn write(network: &Network) -> String {
    serde_json::to_string(&Document(network))
        .unwrap_or_else(|error| unreachable!("a network has only strings and numbers: {error}"))
}

/// The fields of the file, not yet looked into.
#[derive(Default)]
struct FileText<'a> {
    format: Option<&'a RawValue>,
    name: Option<&'a RawValue>,
    time_unit: Option<&'a RawValue>,
    origin: Option<&'a RawValue>,
    events: Option<&'a RawValue>,
    requirements: Option<&'a RawValue>,
    contingents: Option<&'a RawValue>,
}

/// A JSON object, field by field, in order, nothing lost.
struct Fields<'a>(Vec<(String, &'a RawValue)>);

impl<'de> Deserialize<'de> for Fields<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Fields<'de>, D::Error> {
        struct FieldsVisitor;
        impl<'de> Visitor<'de> for FieldsVisitor {
            type Value = Fields<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "a network: a JSON object with `format`, `origin` and `events`")
            }

            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Fields<'de>, M::Error> {
                let mut fields = Vec::new();
                while let Some(field) = map.next_entry()? {
                    fields.push(field);
                }
                Ok(Fields(fields))
            }
        }
        deserializer.deserialize_map(FieldsVisitor)
    }
}

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
    lower: Option<Seconds>,
    #[serde(default)]
    upper: Option<Seconds>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ContingentText {
    from: String,
    to: String,
    lower: Seconds,
    upper: Seconds,
    #[serde(default)]
    delay: Option<(Seconds, Option<Seconds>)>,
}

/// A duration as a JSON number of seconds, read and written digit by digit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Seconds(pub Duration);

/// Shorthand for [`Seconds`].
pub fn seconds(duration: Duration) -> Seconds {
    Seconds(duration)
}

impl Serialize for Seconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        number(&self.0).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Seconds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Seconds, D::Error> {
        let raw: &RawValue = <&RawValue>::deserialize(deserializer)?;
        let text = raw.get();
        Duration::parse_seconds(text)
            .map(Seconds)
            .map_err(|error| D::Error::custom(format!("`{text}`: {error}")))
    }
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
}

impl<'a> Reader<'a> {
    fn file(&mut self, fields: Vec<(String, &'a RawValue)>) -> FileText<'a> {
        let mut file = FileText::default();
        for (name, raw) in fields {
            let slot = match name.as_str() {
                "format" => &mut file.format,
                "name" => &mut file.name,
                "time_unit" => &mut file.time_unit,
                "origin" => &mut file.origin,
                "events" => &mut file.events,
                "requirements" => &mut file.requirements,
                "contingents" => &mut file.contingents,
                _ => {
                    let known =
                        "`format`, `name`, `time_unit`, `origin`, `events`, `requirements` and `contingents`";
                    self.problem(raw, format!("a network has no field `{name}`; it has {known}"));
                    continue;
                }
            };
            if slot.replace(raw).is_some() {
                self.problem(raw, format!("the field `{name}` is there twice"));
            }
        }
        for (name, there) in [
            ("format", file.format.is_some()),
            ("origin", file.origin.is_some()),
            ("events", file.events.is_some()),
        ] {
            if !there {
                self.problems
                    .push(ReadProblem { offset: 0, message: format!("the field `{name}` is missing") });
            }
        }
        file
    }

    /// The elements of a field that is a list; none if the field is not there.
    fn list(&mut self, name: &str, field: Option<&'a RawValue>) -> Vec<&'a RawValue> {
        field.and_then(|raw| self.element(name, raw)).unwrap_or_default()
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
        serde_json::from_str(raw.get())
            .map_err(|error| {
                let before = self.problems.len();
                self.look_into(name, raw, fields);
                if self.problems.len() == before {
                    let at = self.offset(raw);
                    self.problems.push(problem(self.text, at, name, raw.get(), &error));
                }
            })
            .ok()
    }

    /// Says what is wrong with the fields of an object that could not be read, each in its place.
    fn look_into(&mut self, name: &str, raw: &'a RawValue, fields: &[(&'static str, Content)]) {
        let Ok(Fields(found)) = serde_json::from_str::<Fields<'a>>(raw.get()) else { return };
        for (index, (field, value)) in found.iter().enumerate() {
            let Some((known, content)) = fields.iter().find(|(known, _)| known == field) else {
                let names: Vec<String> = fields.iter().map(|(known, _)| (*known).to_string()).collect();
                let near = match nearest(field, names.iter()) {
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

    fn network(&mut self, file: &FileText<'a>) -> Option<(Network, Places)> {
        if let Some(raw) = file.format
            && let Some(format) = self.element::<String>("format", raw)
            && format != FORMAT
        {
            self.problem(raw, format!("the format is `{format}`; this kirk reads `{FORMAT}`"));
        }
        let name: String = file.name.and_then(|raw| self.element("name", raw)).unwrap_or_default();
        if let Some(raw) = file.time_unit
            && let Some(unit) = self.element::<String>("time_unit", raw)
            && unit != "s"
        {
            self.problem(raw, format!("the time unit is `{unit}`; kirk networks are in seconds, `s`"));
        }
        let event_list = self.list("events", file.events);
        let requirement_list = self.list("requirements", file.requirements);
        let contingent_list = self.list("contingents", file.contingents);
        let mut events = Vec::new();
        let mut index: std::collections::BTreeMap<String, EventId> = std::collections::BTreeMap::new();
        for (at, &raw) in event_list.iter().enumerate() {
            let Some(event) = self.element::<EventText>(&format!("events[{at}]"), raw) else { continue };
            let id = EventId(events.len() as u32);
            let mut names = vec![event.id];
            names.extend(event.names.into_iter().filter(|name| *name != names[0]).collect::<Vec<_>>());
            for name in &names {
                if name.is_empty() {
                    self.problem(raw, format!("events[{at}]: an event needs a name"));
                }
                if index.insert(normal_name(name), id).is_some() {
                    self.problem(
                        raw,
                        format!("events[{at}]: the name `{name}` is used already (case does not count)"),
                    );
                }
            }
            let names = names.into_iter().map(|text| Name { text, internal: false }).collect();
            events.push(Event { names });
        }
        let find = |reader: &mut Reader<'a>, raw: &'a RawValue, element: &str, name: &str| {
            let found = index.get(&normal_name(name)).copied();
            if found.is_none() {
                let near = nearest(name, index.keys());
                let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                reader.problem(raw, format!("{element}: there is no event `{name}`{help}"));
            }
            found
        };
        let origin = file.origin.and_then(|raw| {
            let name = self.element::<String>("origin", raw)?;
            find(self, raw, "origin", &name)
        });
        let mut requirements = Vec::new();
        for (at, &raw) in requirement_list.iter().enumerate() {
            let element = format!("requirements[{at}]");
            let Some(requirement) = self.object::<RequirementText>(&element, raw, &REQUIREMENT) else {
                continue;
            };
            let from = find(self, raw, &element, &requirement.from);
            let to = find(self, raw, &element, &requirement.to);
            let bound = |seconds: Option<Seconds>| seconds.map_or(Bound::Infinite, |s| Bound::Finite(s.0));
            if let (Some(from), Some(to)) = (from, to) {
                let (lower, upper) = (bound(requirement.lower), bound(requirement.upper));
                requirements.push(Requirement { from, to, lower, upper });
            }
        }
        let mut contingents = Vec::new();
        for (at, &raw) in contingent_list.iter().enumerate() {
            let element = format!("contingents[{at}]");
            let Some(link) = self.object::<ContingentText>(&element, raw, &CONTINGENT) else { continue };
            let from = find(self, raw, &element, &link.from);
            let to = find(self, raw, &element, &link.to);
            let delay = link.delay.map_or(Delay::NONE, |(min, max)| Delay {
                min: min.0,
                max: max.map_or(Bound::Infinite, |max| Bound::Finite(max.0)),
            });
            if let (Some(from), Some(to)) = (from, to) {
                let (lower, upper) = (link.lower.0, link.upper.0);
                contingents.push(ContingentLink { from, to, lower, upper, delay });
            }
        }
        if !self.problems.is_empty() {
            return None;
        }
        match Network::new(name, origin?, events, requirements, contingents) {
            Ok(network) => {
                let range = |raw: &RawValue| {
                    let start = self.offset(raw);
                    start..start + raw.get().len()
                };
                let requirements = requirement_list.iter().map(|raw| [range(raw), range(raw)]).collect();
                let contingents = contingent_list.iter().map(|raw| range(raw)).collect();
                Some((network, Places { requirements, contingents }))
            }
            Err(errors) => {
                for error in errors {
                    let raw = match &error {
                        ModelError::RequirementReversed { index, .. } => requirement_list[*index],
                        ModelError::LinkBounds { index, .. }
                        | ModelError::DelayBounds { index, .. }
                        | ModelError::ContingentOrigin { index }
                        | ModelError::TwoLinksEndThere { index, .. } => contingent_list[*index],
                        _ => file.origin?,
                    };
                    self.problem(raw, error.to_string());
                }
                None
            }
        }
    }

    fn element<T: Deserialize<'a>>(&mut self, name: &str, raw: &'a RawValue) -> Option<T> {
        match serde_json::from_str(raw.get()) {
            Ok(value) => Some(value),
            Err(error) => {
                let at = self.offset(raw);
                self.problems.push(problem(self.text, at, name, raw.get(), &error));
                None
            }
        }
    }

    fn problem(&mut self, raw: &'a RawValue, message: String) {
        self.problems.push(ReadProblem { offset: self.offset(raw), message });
    }

    /// Where a borrowed value is in the text.
    fn offset(&self, raw: &RawValue) -> usize {
        (raw.get().as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len())
    }
}

struct Document<'a>(&'a Network);

impl Serialize for Document<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let network = self.0;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("format", FORMAT)?;
        map.serialize_entry("name", network.name())?;
        map.serialize_entry("time_unit", "s")?;
        map.serialize_entry("origin", network.label(network.origin()))?;
        map.serialize_entry("events", &List(network.events(), EventDocument))?;
        let requirement = |requirement| RequirementDocument { network, requirement };
        map.serialize_entry("requirements", &List(network.requirements(), requirement))?;
        map.serialize_entry(
            "contingents",
            &List(network.contingents(), |link| LinkDocument { network, link }),
        )?;
        map.end()
    }
}

/// Writes a dispatchable network (`kirk-dispatchable/1`) as one line of JSON.
///
/// An edge says `to - from <= weight`; a wait says that `event` comes after `after`, and until `for` has happened not
/// before `until` seconds after it; an event that is simultaneous with another is executed at the same time, after it.
pub fn write_dispatchable(net: &Dispatchable, name: &str, label: impl Fn(u32) -> String) -> String {
    #[derive(Serialize)]
    struct File<'a> {
        format: &'a str,
        name: &'a str,
        time_unit: &'a str,
        origin: String,
        events: Vec<String>,
        edges: Vec<EdgeFile>,
        waits: Vec<WaitFile>,
        simultaneous: Vec<TogetherFile>,
        contingents: Vec<LinkFile>,
    }
    #[derive(Serialize)]
    struct EdgeFile {
        from: String,
        to: String,
        weight: Seconds,
    }
    #[derive(Serialize)]
    struct WaitFile {
        event: String,
        r#for: String,
        until: Seconds,
        after: String,
    }
    #[derive(Serialize)]
    struct TogetherFile {
        event: String,
        with: String,
    }
    #[derive(Serialize)]
    struct LinkFile {
        from: String,
        to: String,
        lower: Seconds,
        upper: Seconds,
    }
    let micros = |micros| Seconds(Duration::from_micros(micros));
    let edge =
        |edge: &Edge| EdgeFile { from: label(edge.from), to: label(edge.to), weight: micros(edge.weight) };
    let wait = |wait: &Wait| {
        let link = net.links[wait.link as usize];
        WaitFile {
            event: label(wait.waiter),
            r#for: label(link.contingent),
            until: micros(-wait.weight),
            after: label(link.activation),
        }
    };
    let link = |link: &Link| LinkFile {
        from: label(link.activation),
        to: label(link.contingent),
        lower: micros(link.lower),
        upper: micros(link.upper),
    };
    let together = |(node, &leader): (usize, &u32)| {
        (leader != NONE).then(|| TogetherFile { event: label(node as u32), with: label(leader) })
    };
    let file = File {
        format: "kirk-dispatchable/1",
        name,
        time_unit: "s",
        origin: label(0),
        events: (0..net.nodes).map(&label).collect(),
        edges: net.edges.iter().map(edge).collect(),
        waits: net.waits.iter().map(wait).collect(),
        simultaneous: net.simultaneous.iter().enumerate().filter_map(together).collect(),
        contingents: net.links.iter().map(link).collect(),
    };
    serde_json::to_string(&file)
        .unwrap_or_else(|error| unreachable!("a network has only strings and numbers: {error}"))
}

struct List<'a, T, F>(&'a [T], F);

impl<'a, T, U: Serialize, F: Fn(&'a T) -> U> Serialize for List<'a, T, F> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.0.len()))?;
        for item in self.0 {
            list.serialize_element(&(self.1)(item))?;
        }
        list.end()
    }
}

struct EventDocument<'a>(&'a Event);

impl Serialize for EventDocument<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // A network file has no internal names: of an event that has others they are left out.
        let names: Vec<&str> = self.0.shown_names().collect();
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("id", names[0])?;
        if names.len() > 1 {
            map.serialize_entry("names", &names)?;
        }
        map.end()
    }
}

struct RequirementDocument<'a> {
    network: &'a Network,
    requirement: &'a Requirement,
}

impl Serialize for RequirementDocument<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("from", self.network.label(self.requirement.from))?;
        map.serialize_entry("to", self.network.label(self.requirement.to))?;
        if let Bound::Finite(lower) = self.requirement.lower {
            map.serialize_entry("lower", &Seconds(lower))?;
        }
        if let Bound::Finite(upper) = self.requirement.upper {
            map.serialize_entry("upper", &Seconds(upper))?;
        }
        map.end()
    }
}

struct LinkDocument<'a> {
    network: &'a Network,
    link: &'a ContingentLink,
}

impl Serialize for LinkDocument<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("from", self.network.label(self.link.from))?;
        map.serialize_entry("to", self.network.label(self.link.to))?;
        map.serialize_entry("lower", &Seconds(self.link.lower))?;
        map.serialize_entry("upper", &Seconds(self.link.upper))?;
        if self.link.delay != Delay::NONE {
            let max = self.link.delay.max.finite().map(Seconds);
            map.serialize_entry("delay", &(Seconds(self.link.delay.min), max))?;
        }
        map.end()
    }
}

/// Seconds as a JSON number with all its digits.
fn number(seconds: &impl std::fmt::Display) -> Box<RawValue> {
    RawValue::from_string(seconds.to_string())
        .unwrap_or_else(|error| unreachable!("seconds are a JSON number: {error}"))
}
