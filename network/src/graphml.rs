//! Reads and writes the GraphML of the CSTNU Tool (`.stnu`, R. Posenato, University of Verona).
//!
//! An edge `A -> B` of `Value` w reads `B - A <= w`; the origin is the node `Z`. A contingent link from A to C with
//! bounds [x, y] is a pair of edges of `Type` contingent, written in one of two ways:
//!
//! | | `A -> C` | `C -> A` |
//! | --- | --- | --- |
//! | labelled | `LabeledValue` `LC(C):x` | `LabeledValue` `UC(C):-y` |
//! | plain | `Value` y | `Value` -x |
//!
//! A `Value` beside a `LabeledValue` is an ordinary edge of its own. Waits (dispatchable networks), observations and
//! propositional labels (conditional networks) are refused; drawing positions and the like are skipped. Quotes around a name
//! are no part of it. The format knows no delays. It allows one edge from one node to another, so of several requirements
//! between two events the tightest bounds are written. The tool itself reads whole numbers only.
//!
//! What is our own, and skipped by others: a node may carry `Names`, the names of its event as a JSON list, when its id
//! is not its only name, and `Internal`, those of them that no user chose; the graph may carry `Requirements`, when its
//! edges alone would be read as other requirements (see `exact`).

mod exact;
mod scan;
mod write;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::ops::Range;

use crate::json::ReadProblem;
use crate::kinds;
use crate::model::{ContingentLink, Delay, Event, EventId, Name, Network, normal_name};
use crate::plain::{Intervals, unquoted};
use crate::source_map::SourceMap;
use crate::time::Duration;
use scan::{Data, Document, Element, scan};

pub use write::{WriteError, write};

/// Reads a `.stnu` file, or lists everything that is wrong with it.
///
/// Edges in opposite directions between two events become one requirement, where the first of the two stands. Entities
/// other than those of XML itself are not expanded.
pub fn read(text: &str) -> Result<Network, Vec<ReadProblem>> {
    read_with_source_map(text).map(|(network, _)| network)
}

/// Reads a `.stnu` file as [`read`] does, and remembers where its constraints stand.
pub fn read_with_source_map(text: &str) -> Result<(Network, SourceMap), Vec<ReadProblem>> {
    let (document, problems) = scan(text);
    let mut reader = Reader { text, problems };
    let network = document.and_then(|document| reader.network(&document));
    let mut problems = reader.problems;
    problems.sort_by_key(|problem| problem.offset);
    network.filter(|_| problems.is_empty()).ok_or(problems)
}

/// A value with case label: `LC(C):4` or `UC(C):-6`.
#[derive(Clone, Copy)]
struct CaseLabel {
    upper: bool,
    of: EventId,
    value: Duration,
}

struct Edge<'d> {
    element: &'d Element,
    from: EventId,
    to: EventId,
    contingent: bool,
    value: Option<Duration>,
    label: Option<CaseLabel>,
}

struct Reader<'t> {
    text: &'t str,
    problems: Vec<ReadProblem>,
}

impl Reader<'_> {
    fn network(&mut self, document: &Document) -> Option<(Network, SourceMap)> {
        let mut name = String::new();
        for data in &document.graph_data {
            match data.key.as_str() {
                "Name" => name.clone_from(&data.text),
                "NetworkType" => {
                    if let Err(refused) = kinds::check(data.text.trim()) {
                        self.problem(data.offset, format!("the network type is {refused}"));
                    }
                }
                _ => {}
            }
        }
        let mut events = Vec::new();
        let mut ids: BTreeMap<&str, EventId> = BTreeMap::new();
        let mut names: BTreeSet<String> = BTreeSet::new();
        for node in &document.nodes {
            let event = EventId(events.len() as u32);
            let Some(id) = node.id.as_deref().map(unquoted) else {
                self.problem(node.offset, "a node has no `id`".to_string());
                continue;
            };
            if ids.insert(id, event).is_some() {
                self.problem(node.offset, format!("node `{id}`: there is another node with this id"));
                continue;
            }
            let own = self.names(node, id);
            for Name { text, .. } in &own {
                if !names.insert(normal_name(text)) {
                    let message =
                        format!("node `{id}`: the name `{text}` is used already (case does not count)");
                    self.problem(node.offset, message);
                }
            }
            events.push(Event { names: own.into() });
        }
        let mut edge_ids = BTreeSet::new();
        let mut edges = Vec::new();
        for element in &document.edges {
            if let Some(id) = &element.id
                && !edge_ids.insert(id)
            {
                self.problem(element.offset, format!("edge `{id}`: there is another edge with this id"));
            }
            edges.extend(self.edge(element, &ids, document));
        }
        let mut intervals = Intervals::default();
        for edge in &edges {
            let ordinary = !edge.contingent || edge.label.is_some();
            if let Some(weight) = edge.value.filter(|_| ordinary) {
                intervals.add(edge.from, edge.to, weight, self.tag(edge.element));
            }
        }
        self.restore(document, &ids, &mut intervals);
        let links = self.links(&edges, &ids);
        let origin = ids.get("Z").copied();
        if origin.is_none() {
            let message =
                "there is no node `Z`: the origin, executed first at time 0, is the node with that id";
            self.problem(document.graph_offset, message.to_string());
        }
        if !self.problems.is_empty() {
            return None;
        }
        let contingents = links.iter().map(|(_, link)| *link).collect();
        match Network::new(name, origin?, events, intervals.requirements, contingents) {
            Ok(network) => {
                let tags = |says: &[&Element; 2]| says.map(|element| self.tag(element));
                let contingents = links.iter().map(|(says, _)| tags(says)).collect();
                Some((network, SourceMap { requirements: intervals.places, contingents }))
            }
            Err(errors) => {
                for error in errors {
                    match error.link().and_then(|link| links.get(link)) {
                        Some(([one, other], _)) => {
                            let edge = if one.offset < other.offset { one } else { other };
                            let message = format!("{}: {}", edge.describe("edge"), error.what());
                            self.problem(edge.offset, message);
                        }
                        None => self.problem(document.graph_offset, error.to_string()),
                    }
                }
                None
            }
        }
    }

    /// The opening tag of an element.
    fn tag(&self, element: &Element) -> Range<usize> {
        let rest = self.text.get(element.offset..).unwrap_or("");
        element.offset..element.offset + rest.find('>').map_or(rest.len(), |at| at + 1)
    }

    /// Takes the requirements from the file's own list of them, if its edges still say the same.
    fn restore(&mut self, document: &Document, ids: &BTreeMap<&str, EventId>, joined: &mut Intervals) {
        let Some(data) = document.graph_data.iter().find(|data| data.key == exact::KEY) else { return };
        if data.text.trim().is_empty() {
            return;
        }
        let listed = match exact::requirements(data.text.trim(), ids) {
            Ok(Some(listed)) if exact::tightest(&listed) == exact::tightest(&joined.requirements) => listed,
            Ok(_) => return,
            Err(message) => return self.problem(data.offset, message),
        };
        let mut said: BTreeMap<(EventId, EventId), Range<usize>> = BTreeMap::new();
        for (requirement, [upper, lower]) in joined.requirements.iter().zip(&joined.places) {
            for (edge, place) in requirement.edges().into_iter().zip([upper, lower]) {
                let Some((from, to, _)) = edge else { continue };
                said.entry((from, to)).or_insert_with(|| place.clone());
            }
        }
        let place = |from, to| said.get(&(from, to)).or_else(|| said.get(&(to, from))).cloned();
        let start = data.offset..data.offset;
        let places = listed.iter().map(|requirement| {
            let (from, to) = (requirement.from, requirement.to);
            [place(from, to), place(to, from)].map(|place| place.unwrap_or(start.clone()))
        });
        joined.places = places.collect();
        joined.requirements = listed;
    }

    /// The names of a node: its `Names`, else its id. Those of its `Internal` are internal.
    fn names(&mut self, node: &Element, id: &str) -> Vec<Name> {
        let mut own = vec![id.to_string()];
        let mut internal: Option<(&Data, Vec<String>)> = None;
        for data in &node.data {
            match data.key.as_str() {
                key @ ("Names" | "Internal") if !data.text.trim().is_empty() => {
                    match serde_json::from_str::<Vec<String>>(data.text.trim()) {
                        Ok(names) if key == "Internal" => internal = Some((data, names)),
                        Ok(names) if !names.is_empty() => own = names,
                        _ => {
                            let message = format!(
                                "node `{id}`: `{key}` must be a JSON list of names, like [\"a\", \"b\"]"
                            );
                            self.problem(data.offset, message);
                        }
                    }
                }
                "Obs" | "Label" if !is_empty_label(&data.text) => {
                    let message = format!(
                        "node `{id}` has the {} `{}`: conditional networks (CSTN, CSTNU) are not read",
                        if data.key == "Obs" { "observation" } else { "label" },
                        data.text.trim()
                    );
                    self.problem(data.offset, message);
                }
                _ => {}
            }
        }
        let (own_set, mut marked) = (own.iter().cloned().collect::<BTreeSet<_>>(), BTreeSet::new());
        if let Some((data, names)) = internal {
            if let Some(other) = names.iter().find(|name| !own_set.contains(*name)) {
                let message = format!("node `{id}`: `Internal` has `{other}`, which is none of its names");
                self.problem(data.offset, message);
            }
            marked.extend(names);
        }
        own.into_iter().map(|text| Name { internal: marked.contains(&text), text }).collect()
    }

    fn edge<'d>(
        &mut self,
        element: &'d Element,
        ids: &BTreeMap<&str, EventId>,
        document: &Document,
    ) -> Option<Edge<'d>> {
        let name = element.describe("edge");
        let mut end = |what: &str, id: &Option<String>| {
            let found = id.as_deref().and_then(|id| ids.get(unquoted(id))).copied();
            if found.is_none() {
                let message = match id {
                    None => format!("{name} has no `{what}`"),
                    Some(id) => format!("{name}: its {what}, the node `{id}`, does not exist"),
                };
                self.problem(element.offset, message);
            }
            found
        };
        let (from, to) = (end("source", &element.source), end("target", &element.target));
        let datum = |key: &str| {
            let default = document.edge_defaults.get(key);
            element.data.iter().find(|data| data.key == key).or(default)
        };
        let contingent = match datum("Type").map(|data| (data, data.text.trim())) {
            Some((_, "contingent")) => true,
            None | Some((_, "requirement" | "normal" | "constraint" | "derived" | "internal" | "")) => false,
            Some((data, other)) => {
                let message =
                    format!("{name}: expected the type `requirement` or `contingent`, not `{other}`");
                self.problem(data.offset, message);
                false
            }
        };
        let value = datum("Value").and_then(|data| match data.text.trim() {
            "" | "∞" | "+∞" => None,
            text => self.seconds(&name, data, text),
        });
        let labelled = datum("LabeledValue").filter(|data| !data.text.trim().is_empty());
        let label = labelled.and_then(|data| self.case_label(&name, data, ids));
        if let Some(data) = labelled
            && !contingent
        {
            let message = format!(
                "{name}: only a contingent edge has a `LabeledValue`; waits belong to dispatchable networks, which \
                 are not read"
            );
            self.problem(data.offset, message);
        }
        for data in &element.data {
            if ["LabeledValues", "UpperCaseLabeledValues", "LowerCaseLabeledValues"]
                .contains(&data.key.as_str())
                && !is_empty_label(&data.text)
            {
                let message =
                    format!("{name}: `{}` belongs to conditional networks, which are not read", data.key);
                self.problem(data.offset, message);
            }
        }
        Some(Edge { element, from: from?, to: to?, contingent, value, label })
    }

    /// Joins pairs of contingent edges to links, each with the edge that says its upper bound and that which says its lower one.
    fn links<'d>(
        &mut self,
        edges: &[Edge<'d>],
        ids: &BTreeMap<&str, EventId>,
    ) -> Vec<([&'d Element; 2], ContingentLink)> {
        let id_of: BTreeMap<EventId, &str> = ids.iter().map(|(id, event)| (*event, *id)).collect();
        let mut at: BTreeMap<(EventId, EventId), usize> = BTreeMap::new();
        for (index, edge) in edges.iter().enumerate().filter(|(_, edge)| edge.contingent) {
            if at.insert((edge.from, edge.to), index).is_some() {
                let message = format!(
                    "{}: there is another contingent edge from `{}` to `{}`",
                    edge.element.describe("edge"),
                    id_of[&edge.from],
                    id_of[&edge.to]
                );
                self.problem(edge.element.offset, message);
            }
        }
        let mut links = Vec::new();
        for (index, edge) in edges.iter().enumerate().filter(|(_, edge)| edge.contingent) {
            if at.get(&(edge.from, edge.to)) != Some(&index) {
                continue;
            }
            match at.get(&(edge.to, edge.from)) {
                // An edge from a node to itself is its own opposite.
                Some(&other) if other != index => {
                    if index < other {
                        let pair = [edge, &edges[other]];
                        let link = self.link(edge, &edges[other], &id_of);
                        links.extend(link.map(|link| (upper_and_lower(pair, link), link)));
                    }
                }
                _ => {
                    let message = format!(
                        "{}: a contingent link is a pair of edges; there is no contingent edge from `{}` back to `{}`",
                        edge.element.describe("edge"),
                        id_of[&edge.to],
                        id_of[&edge.from]
                    );
                    self.problem(edge.element.offset, message);
                }
            }
        }
        links
    }

    fn link(
        &mut self,
        first: &Edge<'_>,
        second: &Edge<'_>,
        id_of: &BTreeMap<EventId, &str>,
    ) -> Option<ContingentLink> {
        let link = |forward: &Edge<'_>, lower, upper| ContingentLink {
            from: forward.from,
            to: forward.to,
            lower,
            upper,
            delay: Delay::NONE,
        };
        match (first.label, second.label) {
            (None, None) => {
                let missing = [first, second].into_iter().find(|edge| edge.value.is_none());
                let (Some(a), Some(b)) = (first.value, second.value) else {
                    let edge = missing?;
                    // A value that is there and wrong is a problem already.
                    if !edge.element.says("Value") && !edge.element.says("LabeledValue") {
                        let message = format!(
                            "{}: expected a `LabeledValue` (`LC(C):lower` towards the contingent event C, `UC(C):-upper` \
                             away from it) or a `Value` (`upper` towards, `-lower` away)",
                            edge.element.describe("edge")
                        );
                        self.problem(edge.element.offset, message);
                    }
                    return None;
                };
                let zero = Duration::ZERO;
                if a > zero && b <= zero {
                    Some(link(first, -b, a))
                } else if b > zero && a <= zero {
                    Some(link(second, -a, b))
                } else {
                    let message = format!(
                        "{} and {}: their values {a} and {b} do not say which end is contingent; one must be the \
                         upper bound, above 0, the other the lower bound with a minus sign",
                        first.element.describe("edge"),
                        second.element.describe("edge"),
                    );
                    self.problem(first.element.offset, message);
                    None
                }
            }
            (Some(a), Some(b)) => {
                let (forward, lower, back, upper) =
                    if b.upper || a.of == first.to { (first, a, second, b) } else { (second, b, first, a) };
                let contingent = forward.to;
                let fits = !lower.upper && upper.upper && lower.of == contingent && upper.of == contingent;
                if !fits {
                    let (start, end) = (id_of[&forward.from], id_of[&contingent]);
                    let message = format!(
                        "{} and {}: expected `LC({end}):lower` from `{start}` to `{end}` and `UC({end}):-upper` back, \
                         with the event the edges lead to and from",
                        forward.element.describe("edge"),
                        back.element.describe("edge"),
                    );
                    self.problem(first.element.offset, message);
                    return None;
                }
                Some(link(forward, lower.value, -upper.value))
            }
            (one, _) => {
                let edge = if one.is_none() { first } else { second };
                if !edge.element.says("LabeledValue") {
                    let message = format!(
                        "{}: the edge back has a `LabeledValue`, so this one needs one as well",
                        edge.element.describe("edge")
                    );
                    self.problem(edge.element.offset, message);
                }
                None
            }
        }
    }

    fn case_label(
        &mut self,
        name: &dyn Display,
        data: &Data,
        ids: &BTreeMap<&str, EventId>,
    ) -> Option<CaseLabel> {
        let text = data.text.trim();
        let upper = text.starts_with("UC(");
        let parts = text.strip_prefix(if upper { "UC(" } else { "LC(" }).and_then(|t| t.rsplit_once("):"));
        let Some((event, value)) = parts else {
            let message = format!("{name}: expected `LC(C):lower` or `UC(C):-upper`, not `{text}`");
            self.problem(data.offset, message);
            return None;
        };
        let value = self.seconds(name, data, value.trim());
        let of = ids.get(unquoted(event)).copied();
        if of.is_none() {
            self.problem(data.offset, format!("{name}: there is no node `{event}`, which `{text}` names"));
        }
        Some(CaseLabel { upper, of: of?, value: value? })
    }

    fn seconds(&mut self, name: &dyn Display, data: &Data, text: &str) -> Option<Duration> {
        Duration::parse_seconds(text)
            .map_err(|error| self.problem(data.offset, format!("{name}: the value `{text}`: {error}")))
            .ok()
    }

    fn problem(&mut self, offset: usize, message: String) {
        self.problems.push(ReadProblem { offset, message });
    }
}

fn is_empty_label(text: &str) -> bool {
    matches!(text.trim(), "" | "⊡" | "{}")
}

/// Of a pair of contingent edges the one that says the upper bound of their link, and the other. With labels that is the way back, with
/// plain values the way there.
fn upper_and_lower<'d>(pair: [&Edge<'d>; 2], link: ContingentLink) -> [&'d Element; 2] {
    let [first, second] = pair.map(|edge| edge.element);
    let is_way_there = pair[0].from == link.from;
    if is_way_there == pair[0].label.is_none() { [first, second] } else { [second, first] }
}
