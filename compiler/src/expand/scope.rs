//! Which occurrence a name means: what was labelled or called, where, and how far a name reaches.
//!
//! A scope is the body of a program as it was called once, or one repetition of a `dotimes`. A name in a `between` is looked
//! for in the scope the `between` stands in, with everything called from there, and then in the scopes around it, from the
//! inside out. Labels come before programs. The first scope that has any decides; it must have exactly one. `a#2`, the name of an
//! occurrence, means that one wherever it is written.

use std::collections::{BTreeMap, HashMap};

use super::problem::{Apart, Found, MOST_TOLD, Name, Problem, There};
use crate::ast::{Value, ValueKind};
use crate::problem::Problems;
use crate::source::Span;

/// What a name may refer to.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    Label(String),
    Program(usize),
}

/// An occurrence that can be referred to.
pub(super) struct Named {
    pub(super) scope: usize,
    pub(super) target: Target,
    pub(super) arguments: Vec<ValueKind>,
    /// The name of the episode.
    pub(super) episode: String,
    /// Where the label or the call is written.
    pub(super) span: Span,
}

/// A name to look up.
pub(super) struct Wanted<'a> {
    pub(super) scope: usize,
    pub(super) name: &'a str,
    /// False if a package was written before it.
    pub(super) may_be_label: bool,
    pub(super) program: Option<usize>,
    /// True if the name is not that of the program, but of one occurrence of it: `a#2`.
    pub(super) is_occurrence: bool,
    pub(super) arguments: Option<Vec<Value>>,
    pub(super) span: Span,
}

struct Scope {
    parent: Option<usize>,
    /// The last scope inside it.
    last: usize,
}

/// The scopes of a mission and what occurs in them.
#[derive(Default)]
pub(super) struct Scopes {
    scopes: Vec<Scope>,
    pub(super) named: Vec<Named>,
    /// Where labels were given, to find those given twice.
    labels: HashMap<(usize, String, String), Span>,
}

impl Scopes {
    /// Enters a new scope inside of `parent`.
    pub(super) fn open(&mut self, parent: Option<usize>) -> usize {
        let scope = self.scopes.len();
        self.scopes.push(Scope { parent, last: scope });
        scope
    }

    /// Leaves a scope: those opened since are inside it.
    pub(super) fn close(&mut self, scope: usize) {
        self.scopes[scope].last = self.scopes.len() - 1;
    }

    pub(super) fn add(&mut self, named: Named, problems: &mut Problems) {
        if let Target::Label(name) = &named.target {
            let key = (named.scope, name.clone(), key(&named.arguments));
            if let Some(first) = self.labels.get(&key) {
                let label = shown(name, &named.arguments);
                problems.push(Problem::LabelTwice { label, span: named.span, first: *first });
                return;
            }
            self.labels.insert(key, named.span);
        }
        self.named.push(named);
    }

    /// Prepares looking up; afterwards nothing may be added.
    pub(super) fn index(&self) -> Index<'_> {
        let mut index = Index { scopes: self, places: BTreeMap::new(), episodes: HashMap::new() };
        for (position, named) in self.named.iter().enumerate() {
            if matches!(named.target, Target::Program(_)) {
                index.episodes.insert(&named.episode, position);
            }
            for arguments in [None, Some(key(&named.arguments))] {
                let found = index.places.entry((&named.target, arguments)).or_default();
                found.push((named.scope, position));
            }
        }
        for found in index.places.values_mut() {
            found.sort_unstable();
        }
        index
    }
}

/// A scope, and the position of what occurs in it.
type Entry = (usize, usize);

/// Everything that occurs, by name, sorted by scope; with and without the arguments.
pub(super) struct Index<'a> {
    scopes: &'a Scopes,
    places: BTreeMap<(&'a Target, Option<String>), Vec<Entry>>,
    /// The occurrences of programs by the names of their episodes, which are all different.
    episodes: HashMap<&'a str, usize>,
}

impl Index<'_> {
    /// The episode a name means.
    pub(super) fn find(&self, wanted: &Wanted<'_>) -> Result<&str, Box<Problem>> {
        let arguments: Option<Vec<ValueKind>> =
            wanted.arguments.as_ref().map(|values| values.iter().map(|value| value.kind.clone()).collect());
        let arguments_key = arguments.as_deref().map(key);
        let label = Target::Label(wanted.name.to_string());
        let program = wanted.program.map(Target::Program);
        let name = Name { name: wanted.name.to_string(), arguments, span: wanted.span };
        if wanted.is_occurrence {
            return self.occurrence(program.as_ref(), name);
        }
        let targets = [wanted.may_be_label.then_some(&label), program.as_ref()];
        for target in targets.into_iter().flatten() {
            let Some(places) = self.places.get(&(target, arguments_key.clone())) else { continue };
            let mut scope = Some(wanted.scope);
            while let Some(at) = scope {
                let from = places.partition_point(|(scope, _)| *scope < at);
                let to = places.partition_point(|(scope, _)| *scope <= self.scopes.scopes[at].last);
                match &places[from..to] {
                    [] => scope = self.scopes.scopes[at].parent,
                    [(_, only)] => return Ok(&self.scopes.named[*only].episode),
                    several => return Err(self.ambiguous(name, several).into()),
                }
            }
        }
        let others = targets.iter().flatten().find_map(|target| self.places.get(&(*target, None)));
        let there = others.map_or(There::Nothing, |others| self.others(others));
        Err(Problem::NoOccurrence { name, there }.into())
    }

    /// The occurrence whose name is written out: `a#2`.
    fn occurrence(&self, program: Option<&Target>, name: Name) -> Result<&str, Box<Problem>> {
        let found = self.episodes.get(name.name.as_str()).map(|position| &self.scopes.named[*position]);
        let of_it = |named: &&Named| program == Some(&named.target);
        let is_meant = |named: &&Named| {
            let arguments = name.arguments.as_deref();
            of_it(named) && arguments.is_none_or(|arguments| key(arguments) == key(&named.arguments))
        };
        if let Some(named) = found.filter(is_meant) {
            return Ok(&named.episode);
        }
        let mut all = self.scopes.named.iter().filter(of_it).map(|named| named.episode.clone());
        let there = match (all.next(), all.next_back()) {
            (None, _) => There::Nothing,
            (Some(only), None) => There::Only(only),
            (Some(first), Some(last)) => There::Between(first, last),
        };
        Err(Problem::NoOccurrence { name, there }.into())
    }

    fn ambiguous(&self, name: Name, several: &[Entry]) -> Problem {
        let found: Vec<&Named> = several.iter().map(|(_, position)| &self.scopes.named[*position]).collect();
        let has_arguments = found.iter().any(|named| !named.arguments.is_empty());
        let apart = match found.first() {
            Some(first) if name.arguments.is_none() && has_arguments => {
                Apart::Arguments(first.arguments.clone())
            }
            Some(Named { target: Target::Label(_), .. }) => Apart::ArgumentOfLabel,
            _ => Apart::Label,
        };
        let places: BTreeMap<Span, &String> =
            found.iter().rev().map(|named| (named.span, &named.episode)).collect();
        let places = places.into_iter().take(MOST_TOLD).map(|(span, episode)| (span, episode.clone()));
        let episodes = found.iter().take(MOST_TOLD).map(|named| named.episode.clone()).collect();
        let found = Found { count: found.len(), episodes, places: places.collect() };
        Problem::Ambiguous { name, found, apart }
    }

    /// Those of a name with other arguments: one more than is told, if there are so many.
    fn others(&self, others: &[Entry]) -> There {
        let mut different: Vec<Vec<ValueKind>> = Vec::new();
        let named = others.iter().map(|(_, position)| &self.scopes.named[*position]);
        let first = named.clone().next().map_or(Span::default(), |named| named.span);
        for named in named {
            if !different.contains(&named.arguments) {
                different.push(named.arguments.clone());
            }
            if different.len() > MOST_TOLD {
                break;
            }
        }
        There::Others(different, first)
    }
}

/// What a label is called where names cannot have arguments: `confirm/0-1`.
pub(super) fn shown(name: &str, arguments: &[ValueKind]) -> String {
    let parts: Vec<String> = arguments.iter().map(plain).collect();
    match parts.is_empty() {
        true => name.to_string(),
        false => format!("{name}/{}", parts.join("-")),
    }
}

/// A value as it would be written.
pub(crate) fn source(value: &ValueKind) -> String {
    match value {
        ValueKind::Number(number) => number.to_string(),
        ValueKind::Text(text) => format!("\"{text}\""),
        ValueKind::True => "t".to_string(),
        ValueKind::Nil => "nil".to_string(),
        ValueKind::Symbol(name) if name.starts_with(':') => name.clone(),
        ValueKind::Symbol(name) => format!("'{name}"),
        ValueKind::Name(_, name) | ValueKind::Other(name) => name.clone(),
    }
}

/// The value as part of a name: without blanks and what has a meaning of its own.
fn plain(value: &ValueKind) -> String {
    let text = match value {
        ValueKind::Text(text) | ValueKind::Symbol(text) => text.to_lowercase(),
        _ => source(value),
    };
    text.chars()
        .map(|c| if c.is_alphanumeric() || matches!(c, '-' | '.' | '_' | '+') { c } else { '_' })
        .collect()
}

fn key(arguments: &[ValueKind]) -> String {
    let parts: Vec<String> = arguments.iter().map(|value| format!("{value:?}")).collect();
    parts.join(" ")
}
