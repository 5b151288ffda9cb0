//! From XML to nodes, edges and their data, each with its place in the text. No meaning yet.

use std::collections::BTreeMap;
use std::fmt;

use quick_xml::XmlVersion;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use crate::json::ReadProblem;

/// Everything of a GraphML file that can matter.
#[derive(Default)]
pub(super) struct Document {
    pub(super) graph_offset: usize,
    pub(super) graph_data: Vec<Data>,
    pub(super) nodes: Vec<Element>,
    pub(super) edges: Vec<Element>,
    /// What the keys say of edges that say nothing.
    pub(super) edge_defaults: BTreeMap<String, Data>,
}

/// A node or an edge.
#[derive(Default)]
pub(super) struct Element {
    pub(super) offset: usize,
    pub(super) id: Option<String>,
    pub(super) source: Option<String>,
    pub(super) target: Option<String>,
    pub(super) data: Vec<Data>,
}

/// The data of nodes and edges that can matter.
const KEYS: [&str; 10] = [
    "Names",
    "Internal",
    "Obs",
    "Label",
    "Type",
    "Value",
    "LabeledValue",
    "LabeledValues",
    "UpperCaseLabeledValues",
    "LowerCaseLabeledValues",
];

/// The text of a `<data key="..">`, and where it begins.
#[derive(Default)]
pub(super) struct Data {
    pub(super) key: String,
    pub(super) text: String,
    pub(super) offset: usize,
}

impl Element {
    /// How a message names it: by its id, else by its ends.
    pub(super) fn describe<'e>(&'e self, what: &'static str) -> impl fmt::Display + 'e {
        Description(self, what)
    }

    /// True if there is anything at all under this key.
    pub(super) fn says(&self, key: &str) -> bool {
        self.data.iter().any(|data| data.key == key && !data.text.trim().is_empty())
    }
}

struct Description<'e>(&'e Element, &'static str);

impl fmt::Display for Description<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Description(element, what) = self;
        let end = |id: &Option<String>| id.clone().unwrap_or("?".to_string());
        match &element.id {
            Some(id) => write!(f, "{what} `{id}`"),
            None => write!(f, "{what} `{}` -> `{}`", end(&element.source), end(&element.target)),
        }
    }
}

/// Reads the XML. `None` if there is no graph in it, or not all of it: half a graph is full of nodes that do not exist.
pub(super) fn scan(text: &str) -> (Option<Document>, Vec<ReadProblem>) {
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut scanner = Scanner {
        start: text.len() - body.len(),
        stack: Vec::new(),
        document: Document::default(),
        keys: BTreeMap::new(),
        data: Data::default(),
        seen_root: false,
        seen_graph: false,
        problems: Vec::new(),
    };
    let whole = scanner.run(body);
    ((whole && scanner.seen_graph).then_some(scanner.document), scanner.problems)
}

/// The attributes that can matter.
#[derive(Default)]
struct Attributes {
    id: Option<String>,
    source: Option<String>,
    target: Option<String>,
    key: Option<String>,
    of: Option<String>,
    name: Option<String>,
}

impl Attributes {
    fn slot(&mut self, key: &str) -> Option<&mut Option<String>> {
        match key {
            "id" => Some(&mut self.id),
            "source" => Some(&mut self.source),
            "target" => Some(&mut self.target),
            "key" => Some(&mut self.key),
            "for" => Some(&mut self.of),
            "attr.name" => Some(&mut self.name),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Graphml,
    Graph,
    Node,
    Edge,
    Data,
    Key,
    Default,
    /// Something without meaning here, with everything in it.
    Skipped,
}

struct Key {
    name: String,
    of_edges: bool,
}

struct Scanner {
    /// Where the XML begins in the text.
    start: usize,
    stack: Vec<Tag>,
    document: Document,
    keys: BTreeMap<String, Key>,
    /// The data or default in progress.
    data: Data,
    seen_root: bool,
    seen_graph: bool,
    problems: Vec<ReadProblem>,
}

impl Scanner {
    /// True if it has reached the end of the graph.
    fn run(&mut self, body: &str) -> bool {
        let mut reader = Reader::from_str(body);
        loop {
            let offset = self.start + reader.buffer_position() as usize;
            let event = match reader.read_event() {
                Ok(event) => event,
                Err(error) => {
                    let at = self.start + reader.error_position() as usize;
                    self.problem(at, format!("this is not XML: {error}"));
                    return false;
                }
            };
            match event {
                Event::Start(tag) => {
                    if !self.open(&tag, offset, self.start + reader.buffer_position() as usize) {
                        return false;
                    }
                }
                Event::Empty(tag) => {
                    if !self.open(&tag, offset, offset) {
                        return false;
                    }
                    self.close();
                }
                Event::End(_) => self.close(),
                Event::Text(text) => self.text(&text.xml10_content(), offset),
                Event::CData(text) => self.text(&text.xml10_content(), offset),
                Event::GeneralRef(reference) => {
                    let known = match reference.resolve_char_ref() {
                        Ok(Some(char)) => Some(char.to_string()),
                        Ok(None) => resolve_predefined_entity(&reference).map(str::to_string),
                        Err(_) => None,
                    };
                    match known {
                        Some(text) => self.text(&text, offset),
                        None => {
                            let name = &*reference;
                            self.problem(offset, format!("the entity `&{name};` is not one of XML itself"));
                        }
                    }
                }
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
                Event::Eof => break,
            }
        }
        if !self.stack.is_empty() {
            let end = self.start + body.len();
            self.problem(end, "the file ends in the middle: expected `</graphml>`".to_string());
        } else if !self.seen_root {
            self.problem(0, "expected a GraphML file, with `<graphml>` as its outermost element".to_string());
        } else if !self.seen_graph {
            self.problem(self.start + body.len(), "there is no `<graph>` in `<graphml>`".to_string());
        }
        self.stack.is_empty()
    }

    /// Enters an element; false if there is no point in reading on.
    fn open(&mut self, tag: &BytesStart<'_>, offset: usize, inside: usize) -> bool {
        let name = tag.local_name();
        let name: &str = name.as_ref();
        let mut attributes = Attributes::default();
        // Its own search for duplicates compares each with each.
        for attribute in tag.attributes().with_checks(false) {
            let (key, value) = match &attribute {
                Ok(attribute) => {
                    (attribute.key.as_ref(), attribute.normalized_value(XmlVersion::Implicit1_0))
                }
                Err(error) => {
                    self.problem(offset, format!("`<{name}>`: its attributes cannot be read: {error}"));
                    break;
                }
            };
            match (attributes.slot(key), value) {
                (Some(slot), Ok(value)) => {
                    if slot.replace(value.into_owned()).is_some() {
                        self.problem(offset, format!("`<{name}>`: it has `{key}` twice"));
                    }
                }
                (None, Ok(_)) => {}
                (_, Err(error)) => {
                    self.problem(offset, format!("`<{name}>`: its `{key}` cannot be read: {error}"));
                }
            }
        }
        let tag = match (self.stack.last(), name) {
            (None, "graphml") if !self.seen_root => {
                self.seen_root = true;
                Tag::Graphml
            }
            (None, _) => {
                let message = format!(
                    "expected a GraphML file, with `<graphml>` as its outermost element, not `<{name}>`"
                );
                self.seen_root = true;
                self.problem(offset, message);
                return false;
            }
            (Some(Tag::Graphml), "graph") if !self.seen_graph => {
                self.seen_graph = true;
                self.document.graph_offset = offset;
                Tag::Graph
            }
            (Some(Tag::Graphml), "key") => {
                let id = attributes.id.unwrap_or_default();
                let name = attributes.name.unwrap_or_else(|| id.clone());
                let of_edges = attributes.of.is_some_and(|of| of == "edge");
                self.data = Data { key: id.clone(), ..Data::default() };
                self.keys.insert(id, Key { name, of_edges });
                Tag::Key
            }
            (Some(Tag::Key), "default") => {
                self.data.offset = inside;
                Tag::Default
            }
            (Some(Tag::Graph), "node" | "edge") => {
                let element = Element {
                    offset,
                    id: attributes.id,
                    source: attributes.source,
                    target: attributes.target,
                    data: Vec::new(),
                };
                if name == "node" {
                    self.document.nodes.push(element);
                    Tag::Node
                } else {
                    self.document.edges.push(element);
                    Tag::Edge
                }
            }
            (Some(Tag::Graph | Tag::Node | Tag::Edge), "data") => {
                let id = attributes.key.unwrap_or_default();
                let key = self.keys.get(&id).map_or(id, |key| key.name.clone());
                self.data = Data { key, text: String::new(), offset: inside };
                Tag::Data
            }
            (Some(Tag::Graphml | Tag::Graph | Tag::Node | Tag::Edge), other)
                if other != "desc" && other != "data" =>
            {
                self.problem(offset, format!("`<{other}>` is not understood here"));
                Tag::Skipped
            }
            (Some(_), _) => Tag::Skipped,
        };
        self.stack.push(tag);
        true
    }

    fn close(&mut self) {
        let Some(tag) = self.stack.pop() else { return };
        let data = match tag {
            Tag::Data | Tag::Default => std::mem::take(&mut self.data),
            _ => return,
        };
        match (tag, self.stack.last()) {
            (Tag::Default, _) => {
                if let Some(key) = self.keys.get(&data.key).filter(|key| key.of_edges) {
                    let name = key.name.clone();
                    self.document.edge_defaults.insert(name.clone(), Data { key: name, ..data });
                }
            }
            (_, Some(tag @ (Tag::Node | Tag::Edge))) => {
                let (elements, what) = match tag {
                    Tag::Node => (&mut self.document.nodes, "node"),
                    _ => (&mut self.document.edges, "edge"),
                };
                let Some(element) = elements.last_mut().filter(|_| KEYS.contains(&data.key.as_str())) else {
                    return;
                };
                if element.data.iter().any(|known| known.key == data.key) {
                    let message = format!("{}: it has `{}` twice", element.describe(what), data.key);
                    self.problem(data.offset, message);
                } else {
                    element.data.push(data);
                }
            }
            _ => self.document.graph_data.push(data),
        }
    }

    fn text(&mut self, text: &str, offset: usize) {
        match self.stack.last() {
            Some(Tag::Data | Tag::Default) => self.data.text.push_str(text),
            Some(Tag::Skipped) => {}
            _ if text.trim().is_empty() => {}
            None if !self.seen_root => {}
            _ => self.problem(offset, format!("unexpected text `{}`", excerpt(text))),
        }
    }

    fn problem(&mut self, offset: usize, message: String) {
        self.problems.push(ReadProblem { offset, message });
    }
}

fn excerpt(text: &str) -> String {
    let text = text.trim();
    let short: String = text.chars().take(30).collect();
    if short.len() < text.len() { format!("{short}...") } else { short }
}
