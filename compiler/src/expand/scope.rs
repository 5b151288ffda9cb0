//! Which occurrence a name means: what was labelled or called, where, and how far a name reaches.
//!
//! A scope is the body of a program as it was called once, or one repetition of a `dotimes`. A name in a `between` is looked
//! for in the scope the `between` stands in, with everything called from there, and then in the scopes around it, from the
//! inside out. Labels come before programs. The first scope that has any decides; it must have exactly one. `a#2`, the name of an
//! occurrence, means that one wherever it is written.

use std::collections::{BTreeMap, HashMap};

use crate::ast::{Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
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
                let shown = shown(name, &named.arguments);
                problems.push(
                    Diagnostic::error(Code::DefinedTwice, named.span, format!("the label `{shown}` is given twice"))
                        .primary("again here")
                        .label(*first, "first here")
                        .help("A label names one occurrence: rename one of them, or tell them apart by an argument, as in `(label (x 1) ...)`."),
                );
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
    pub(super) fn find(&self, wanted: &Wanted<'_>) -> Result<&str, Box<Diagnostic>> {
        let arguments: Option<Vec<ValueKind>> =
            wanted.arguments.as_ref().map(|values| values.iter().map(|value| value.kind.clone()).collect());
        let arguments_key = arguments.as_deref().map(key);
        let label = Target::Label(wanted.name.to_string());
        let program = wanted.program.map(Target::Program);
        if wanted.is_occurrence {
            return self.occurrence(wanted, arguments.as_deref());
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
                    several => return Err(self.ambiguous(wanted, arguments.as_deref(), several).into()),
                }
            }
        }
        Err(self.missing(wanted, arguments.as_deref(), &targets).into())
    }

    /// The occurrence whose name is written out: `a#2`.
    fn occurrence(
        &self,
        wanted: &Wanted<'_>,
        arguments: Option<&[ValueKind]>,
    ) -> Result<&str, Box<Diagnostic>> {
        let found = self.episodes.get(wanted.name).map(|position| &self.scopes.named[*position]);
        let is_meant = |named: &&Named| {
            wanted.program.map(Target::Program).as_ref() == Some(&named.target)
                && arguments.is_none_or(|arguments| key(arguments) == key(&named.arguments))
        };
        if let Some(named) = found.filter(is_meant) {
            return Ok(&named.episode);
        }
        let name = written(wanted.name, arguments);
        let problem = Diagnostic::error(Code::UnknownLabel, wanted.span, format!("`{name}` does not occur"))
            .primary("looked for in the whole mission");
        let of_it = |named: &&Named| wanted.program.map(Target::Program).as_ref() == Some(&named.target);
        let mut all = self.scopes.named.iter().filter(of_it);
        let problem = match (all.next(), all.next_back()) {
            (None, _) => problem.help("It is defined, but nothing that the mission does leads to it."),
            (Some(only), None) => problem.help(format!("There is `{}` alone.", only.episode)),
            (Some(first), Some(last)) => {
                problem.help(format!("There is `{}` up to `{}`.", first.episode, last.episode))
            }
        };
        Err(problem.into())
    }

    fn ambiguous(
        &self,
        wanted: &Wanted<'_>,
        arguments: Option<&[ValueKind]>,
        several: &[Entry],
    ) -> Diagnostic {
        let name = written(wanted.name, arguments);
        let found: Vec<&Named> = several.iter().map(|(_, position)| &self.scopes.named[*position]).collect();
        let count = found.len();
        let mut list: Vec<String> =
            found.iter().take(6).map(|named| format!("`{}`", named.episode)).collect();
        if count > 6 {
            list.push(format!("{} more", count - 6));
        }
        let message = format!("`{name}` could be any of {count} occurrences: {}", list.join(", "));
        let by_argument = arguments.is_none() && found.iter().any(|named| !named.arguments.is_empty());
        let short = clip(wanted.name);
        let help = match (by_argument, found.first()) {
            (true, Some(first)) => {
                format!("Say which one by its arguments: `{}`.", written(wanted.name, Some(&first.arguments)))
            }
            (_, Some(Named { target: Target::Label(_), .. })) => format!(
                "Tell them apart by an argument, as in `(label ({short} i) ...)`, or put the `between` into the program that gives the label."
            ),
            _ => format!(
                "Give the one you mean a name, `(label x ({short} ...))`, and write `x` here. In a `dotimes` the name has an argument: `(label (x i) ({short} ...))`."
            ),
        };
        let mut problem = Diagnostic::error(Code::AmbiguousLabel, wanted.span, message)
            .primary("which one is meant?")
            .help(help);
        let places: BTreeMap<Span, &str> =
            found.iter().rev().map(|named| (named.span, named.episode.as_str())).collect();
        for (span, episode) in places.into_iter().take(6) {
            problem = problem.label(span, format!("`{}`", clip(episode)));
        }
        problem
    }

    fn missing(
        &self,
        wanted: &Wanted<'_>,
        arguments: Option<&[ValueKind]>,
        targets: &[Option<&Target>; 2],
    ) -> Diagnostic {
        let name = written(wanted.name, arguments);
        let others = targets.iter().flatten().find_map(|target| self.places.get(&(*target, None)));
        let problem = Diagnostic::error(Code::UnknownLabel, wanted.span, format!("`{name}` does not occur"))
            .primary("looked for in the whole mission");
        let Some(others) = others else {
            return problem.help("It is defined, but nothing that the mission does leads to it.");
        };
        let mut list: Vec<String> = Vec::new();
        let mut first = None;
        for (_, position) in others {
            let other = &self.scopes.named[*position];
            first.get_or_insert(other.span);
            let text = format!("`{}`", written(wanted.name, Some(&other.arguments)));
            if !list.contains(&text) {
                list.push(text);
            }
            if list.len() > 6 {
                list.pop();
                list.push("others".to_string());
                break;
            }
        }
        let list = match list.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
            _ => list.concat(),
        };
        let problem = problem.help(format!("There is {list}. Repetitions count from 0."));
        first.into_iter().fold(problem, |problem, span| problem.label(span, "one of this name is here"))
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

/// As it would be written: `(confirm 0 1)`.
fn written(name: &str, arguments: Option<&[ValueKind]>) -> String {
    let parts: Vec<String> = arguments.unwrap_or_default().iter().map(source).collect();
    match parts.is_empty() {
        true => clip(name),
        false => clip(&format!("({name} {})", parts.join(" "))),
    }
}

fn source(value: &ValueKind) -> String {
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
