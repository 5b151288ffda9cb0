//! Networks as one line of JSON.

use serde::Serialize;

use super::FORMAT;
use crate::controllability::Wait;
use crate::dispatchable::Dispatchable;
use crate::model::{ContingentLink, Delay, Event, Network, Requirement};
use crate::stnu::{Edge, Link, NONE};
use crate::time::Duration;

/// Writes a network as one line of JSON that reads back equal, except for the names no user wrote: the file has them
/// only for events that have no other.
pub fn write(network: &Network) -> String {
    line(&NetworkFile {
        format: FORMAT,
        name: network.name(),
        time_unit: "s",
        origin: network.label(network.origin()),
        events: network.events().iter().map(EventFile::new).collect(),
        requirements: network.requirements().iter().map(|r| RequirementFile::new(r, network)).collect(),
        contingents: network.contingents().iter().map(|link| ContingentFile::new(link, network)).collect(),
    })
}

fn line(file: &impl Serialize) -> String {
    serde_json::to_string(file)
        .unwrap_or_else(|error| unreachable!("a network has only strings and numbers: {error}"))
}

#[derive(Serialize)]
struct NetworkFile<'a> {
    format: &'a str,
    name: &'a str,
    time_unit: &'a str,
    origin: &'a str,
    events: Vec<EventFile<'a>>,
    requirements: Vec<RequirementFile<'a>>,
    contingents: Vec<ContingentFile<'a>>,
}

/// A network file has no internal names: of an event that has others they are left out.
#[derive(Serialize)]
struct EventFile<'a> {
    id: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    names: Option<Vec<&'a str>>,
}

#[derive(Serialize)]
struct RequirementFile<'a> {
    from: &'a str,
    to: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    lower: Option<Duration>,
    #[serde(skip_serializing_if = "Option::is_none")]
    upper: Option<Duration>,
}

#[derive(Serialize)]
struct ContingentFile<'a> {
    from: &'a str,
    to: &'a str,
    lower: Duration,
    upper: Duration,
    #[serde(skip_serializing_if = "Option::is_none")]
    delay: Option<(Duration, Option<Duration>)>,
}

impl<'a> EventFile<'a> {
    fn new(event: &'a Event) -> EventFile<'a> {
        let names: Vec<&str> = event.shown_names().collect();
        EventFile { id: names[0], names: (names.len() > 1).then_some(names) }
    }
}

impl<'a> RequirementFile<'a> {
    fn new(requirement: &Requirement, network: &'a Network) -> RequirementFile<'a> {
        RequirementFile {
            from: network.label(requirement.from),
            to: network.label(requirement.to),
            lower: requirement.lower.finite(),
            upper: requirement.upper.finite(),
        }
    }
}

impl<'a> ContingentFile<'a> {
    fn new(link: &ContingentLink, network: &'a Network) -> ContingentFile<'a> {
        ContingentFile {
            from: network.label(link.from),
            to: network.label(link.to),
            lower: link.lower,
            upper: link.upper,
            delay: (link.delay != Delay::NONE).then_some((link.delay.min, link.delay.max.finite())),
        }
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
        weight: Duration,
    }
    #[derive(Serialize)]
    struct WaitFile {
        event: String,
        r#for: String,
        until: Duration,
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
        lower: Duration,
        upper: Duration,
    }
    let micros = Duration::from_micros;
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
    line(&file)
}
