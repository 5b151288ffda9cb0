//! From a network to GraphML.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Write};

use quick_xml::escape::escape;

use super::exact::{self, is_xml};
use crate::model::{Delay, EventId, Network, Requirement};
use crate::plain::{Intervals, unquoted};
use crate::time::Duration;

/// Writes a network without delays. It reads back equal.
///
/// # Errors
/// Everything about the network that the format cannot say.
pub fn write(network: &Network) -> Result<String, Vec<WriteError>> {
    let mut errors = Vec::new();
    for link in network.contingents() {
        if link.delay != Delay::NONE {
            let (from, to) = (network.label(link.from).to_string(), network.label(link.to).to_string());
            errors.push(WriteError::Delay { from, to });
        }
    }
    if !network.name().chars().all(is_xml) {
        errors.push(WriteError::NetworkName);
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    Ok(Writer::new(network).document())
}

/// What the format cannot say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriteError {
    /// A contingent link has an observation delay.
    Delay {
        /// The event the link starts at.
        from: String,
        /// The event it ends at.
        to: String,
    },
    /// The name of the network has a character that XML does not allow.
    NetworkName,
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WriteError::Delay { from, to } => write!(
                f,
                "the contingent link from `{from}` to `{to}` has an observation delay, which the CSTNU Tool format \
                 cannot express; write the reduced network instead"
            ),
            WriteError::NetworkName => {
                write!(f, "the name of the network has a character that XML does not allow")
            }
        }
    }
}

impl std::error::Error for WriteError {}

struct Writer<'a> {
    network: &'a Network,
    ids: Vec<String>,
    edge_ids: BTreeSet<String>,
}

/// Where an edge leads from and to.
type Ends = (EventId, EventId);

/// What one edge of the file says.
#[derive(Default)]
struct EdgeText {
    label: Option<String>,
    weight: Option<Duration>,
}

impl<'a> Writer<'a> {
    fn new(network: &'a Network) -> Writer<'a> {
        // Names are unique, so a first name is free unless it is `Z` or one that had to be made up.
        let mut taken: BTreeSet<&str> = network.event_ids().map(|event| network.id(event)).collect();
        taken.insert("Z");
        let ids = network.event_ids().map(|event| {
            let id = network.id(event);
            if event == network.origin() {
                "Z".to_string()
            } else if id != "Z" && id == unquoted(id) && id.chars().all(is_xml) {
                id.to_string()
            } else {
                let tries = (0..).map(|n| format!("node{}{}", event.0, "_".repeat(n)));
                tries.into_iter().find(|id| !taken.contains(id.as_str())).unwrap_or_default()
            }
        });
        Writer { network, ids: ids.collect(), edge_ids: BTreeSet::new() }
    }

    fn document(mut self) -> String {
        let (order, edges) = self.edges();
        let mut out = String::from(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <graphml xmlns=\"http://graphml.graphdrawing.org/xmlns/graphml\">\n",
        );
        for (id, element, default) in [
            ("NetworkType", "graph", "CSTNU"),
            ("nContingent", "graph", "0"),
            ("nEdges", "graph", "0"),
            ("nVertices", "graph", "0"),
            ("Name", "graph", ""),
            (exact::KEY, "graph", ""),
            ("Names", "node", ""),
            ("Internal", "node", ""),
            ("Type", "edge", "requirement"),
            ("Value", "edge", ""),
            ("LabeledValue", "edge", ""),
        ] {
            line(
                &mut out,
                format_args!("<key id=\"{id}\" for=\"{element}\"><default>{default}</default></key>"),
            );
        }
        line(&mut out, format_args!("<graph edgedefault=\"directed\">"));
        let network = self.network;
        line(&mut out, format_args!("{}", datum("NetworkType", "STNU")));
        line(&mut out, format_args!("{}", datum("nContingent", &network.contingents().len().to_string())));
        line(&mut out, format_args!("{}", datum("nEdges", &order.len().to_string())));
        line(&mut out, format_args!("{}", datum("nVertices", &network.events().len().to_string())));
        line(&mut out, format_args!("{}", datum("Name", network.name())));
        if !says_all(network, &order, &edges) {
            let rows = exact::rows(network.requirements(), &self.ids);
            line(&mut out, format_args!("{}", datum(exact::KEY, &rows)));
        }
        for (event, id) in network.events().iter().zip(&self.ids) {
            let names: Vec<&str> = event.names.iter().map(|name| name.text.as_str()).collect();
            let internal: Vec<&str> =
                event.names.iter().filter(|name| name.internal).map(|name| name.text.as_str()).collect();
            let mut data = String::new();
            if names != [id.as_str()] {
                data.push_str(&datum("Names", &exact::json_text(&names)));
            }
            if !internal.is_empty() {
                data.push_str(&datum("Internal", &exact::json_text(&internal)));
            }
            line(&mut out, format_args!("<node id=\"{}\">{data}</node>", attribute(id)));
        }
        for pair in order {
            let edge = &edges[&pair];
            let (source, target) = (&self.ids[pair.0.index()], &self.ids[pair.1.index()]);
            let id = unused(&mut self.edge_ids, format!("e_{source}_{target}"));
            let kind = if edge.label.is_some() { "contingent" } else { "requirement" };
            let mut data = datum("Type", kind);
            if let Some(weight) = edge.weight {
                data.push_str(&datum("Value", &weight.to_string()));
            }
            if let Some(label) = &edge.label {
                data.push_str(&datum("LabeledValue", label));
            }
            line(
                &mut out,
                format_args!(
                    "<edge id=\"{}\" source=\"{}\" target=\"{}\">{data}</edge>",
                    attribute(&id),
                    attribute(source),
                    attribute(target)
                ),
            );
        }
        out.push_str("</graph>\n</graphml>\n");
        out
    }

    /// The edges by their ends, and the order to write them in.
    fn edges(&self) -> (Vec<Ends>, BTreeMap<Ends, EdgeText>) {
        let mut order = Vec::new();
        let mut edges: BTreeMap<Ends, EdgeText> = BTreeMap::new();
        let mut edge = |from: EventId, to: EventId, change: &dyn Fn(&mut EdgeText)| {
            change(edges.entry((from, to)).or_insert_with(|| {
                order.push((from, to));
                EdgeText::default()
            }));
        };
        // The links come first: each pair stands where its link does, whatever else is between its events.
        for link in self.network.contingents() {
            let end = &self.ids[link.to.index()];
            let lower = format!("LC({end}):{}", link.lower);
            let upper = format!("UC({end}):{}", -link.upper);
            edge(link.from, link.to, &|edge| edge.label = Some(lower.clone()));
            edge(link.to, link.from, &|edge| edge.label = Some(upper.clone()));
        }
        for (from, to, weight) in self.network.requirements().iter().flat_map(Requirement::edges).flatten() {
            edge(from, to, &|edge| {
                edge.weight = Some(edge.weight.map_or(weight, |known| known.min(weight)));
            });
        }
        (order, edges)
    }
}

/// True if the edges alone are read as the requirements they come from.
fn says_all(network: &Network, order: &[Ends], edges: &BTreeMap<Ends, EdgeText>) -> bool {
    let mut read = Intervals::default();
    for &(from, to) in order {
        if let Some(weight) = edges[&(from, to)].weight {
            read.add(from, to, weight, 0..0);
        }
    }
    read.requirements == network.requirements()
}

fn line(out: &mut String, text: fmt::Arguments<'_>) {
    writeln!(out, "{text}").unwrap_or_else(|_| unreachable!("a string takes whatever is written"));
}

fn datum(key: &str, text: &str) -> String {
    format!("<data key=\"{key}\">{}</data>", escape(text).replace('\r', "&#13;"))
}

fn attribute(text: &str) -> String {
    escape(text).replace('\t', "&#9;").replace('\n', "&#10;").replace('\r', "&#13;")
}

/// This id, or one like it that is not taken.
fn unused(taken: &mut BTreeSet<String>, id: String) -> String {
    let found = (1..)
        .map(|n| if n == 1 { id.clone() } else { format!("{id}#{n}") })
        .find(|id| !taken.contains(id))
        .unwrap_or_default();
    taken.insert(found.clone());
    found
}
