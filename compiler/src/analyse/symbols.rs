//! What has a name, and every place where that name stands: taken down while names are resolved, for editors, which go from
//! one to the other, and to know what is never used. In a program with errors, a name that means nothing is no place of anything.

use std::collections::BTreeMap;

use crate::ast::{Body, Ident, Labelled, Program};
use crate::source::Span;

/// Something that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// What it is.
    pub kind: SymbolKind,
    /// Its name, in lower case.
    pub name: String,
    /// Where it stands, in source order, with the package if one is written before it.
    pub places: Vec<Mention>,
}

/// The kinds of things that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolKind {
    /// A control program, by its position in the [`Program`].
    Program(usize),
    /// A parameter of the program at this position.
    Parameter(usize),
    /// A name from `let` or `dotimes`.
    Variable,
    /// A name from `label`; all labels of one name are one symbol.
    Label,
    /// A name from `defparameter` or `defconstant`.
    NamedNumber(usize),
    /// A class.
    Class(usize),
    /// A slot, by its class.
    Slot(usize),
    /// What reads a slot; those of one name are one symbol.
    Accessor,
    /// A package.
    Package,
    /// A team.
    Team,
    /// An agent of the team.
    Agent,
}

/// One place where a name is mentioned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mention {
    /// The name.
    pub span: Span,
    /// True if the thing is defined here.
    pub definition: bool,
}

/// All symbols of a program.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    /// In no particular order but a stable one.
    pub symbols: Vec<Symbol>,
    /// All places with the number of the symbol, sorted.
    places: Vec<(Mention, u32)>,
}

impl Symbols {
    /// The symbol whose name stands at a byte of a source, or ends there, and that place.
    pub fn at(&self, source: u32, offset: u32) -> Option<(&Symbol, Mention)> {
        let is_before = |span: Span| (span.source, span.start) <= (source, offset);
        let after = self.places.partition_point(|(place, _)| is_before(place.span));
        let (place, symbol) = self.places[..after].last().copied()?;
        if place.span.source != source || offset > place.span.end {
            return None;
        }
        Some((&self.symbols[symbol as usize], place))
    }

    /// Every place with its symbol, in source order.
    pub fn places(&self) -> impl Iterator<Item = (Mention, &Symbol)> {
        self.places.iter().map(|(place, symbol)| (*place, &self.symbols[*symbol as usize]))
    }
}

/// The names that are defined and used, as far as they are found.
#[derive(Clone, Debug, Default)]
pub struct Uses {
    symbols: Vec<Symbol>,
    /// The numbers of the first named number and of the first class; programs come first.
    numbers: usize,
    classes: usize,
    packages: BTreeMap<String, usize>,
    accessors: BTreeMap<String, usize>,
    labels: BTreeMap<String, usize>,
    agents: BTreeMap<String, usize>,
}

impl Uses {
    /// Everything that is defined at the top level, and every label; nothing of it is used yet.
    pub(super) fn new(program: &Program) -> Uses {
        let mut uses = Uses::default();
        for (index, definition) in program.programs.iter().enumerate() {
            uses.define(SymbolKind::Program(index), &definition.name);
        }
        uses.numbers = uses.symbols.len();
        for (index, number) in program.parameters.iter().enumerate() {
            uses.define(SymbolKind::NamedNumber(index), &number.name);
        }
        uses.classes = uses.symbols.len();
        for (index, class) in program.classes.iter().enumerate() {
            uses.define(SymbolKind::Class(index), &class.name);
        }
        for package in &program.packages {
            let symbol = uses.define(SymbolKind::Package, &package.name);
            uses.packages.entry(package.name.name.clone()).or_insert(symbol);
        }
        for (index, class) in program.classes.iter().enumerate() {
            for slot in &class.slots {
                uses.define(SymbolKind::Slot(index), &slot.name);
                for accessor in &slot.accessors {
                    let known = uses.accessors.get(&accessor.name).copied();
                    let symbol = uses.define_again(known, SymbolKind::Accessor, accessor);
                    uses.accessors.insert(accessor.name.clone(), symbol);
                }
            }
        }
        for team in &program.teams {
            uses.define(SymbolKind::Team, &team.name);
            for agent in &team.agents {
                let known = uses.agents.get(&agent.name).copied();
                let symbol = uses.define_again(known, SymbolKind::Agent, agent);
                uses.agents.insert(agent.name.clone(), symbol);
            }
        }
        let mut open: Vec<&Body> = program.programs.iter().flat_map(|program| &program.body).rev().collect();
        while let Some(body) = open.pop() {
            if let Body::Label(Labelled { name, .. }) = body {
                let symbol = uses.define_again(uses.label(name), SymbolKind::Label, name);
                uses.labels.insert(name.name.clone(), symbol);
            }
            open.extend(body.parts().iter().rev());
        }
        uses
    }

    /// Takes down a definition; the number of its symbol.
    pub(super) fn define(&mut self, kind: SymbolKind, name: &Ident) -> usize {
        self.define_again(None, kind, name)
    }

    /// The same of a symbol that may be known already.
    fn define_again(&mut self, known: Option<usize>, kind: SymbolKind, name: &Ident) -> usize {
        let symbol = known.unwrap_or(self.symbols.len());
        if known.is_none() {
            self.symbols.push(Symbol { kind, name: name.name.clone(), places: Vec::new() });
        }
        self.symbols[symbol].places.push(Mention { span: name.span, definition: true });
        symbol
    }

    /// Takes down that a symbol is named.
    pub(super) fn place(&mut self, symbol: usize, span: Span) {
        self.symbols[symbol].places.push(Mention { span, definition: false });
    }

    /// Takes down that a program, a named number or a class is named.
    pub(super) fn global(&mut self, kind: SymbolKind, span: Span) {
        match kind {
            SymbolKind::Program(index) => self.place(index, span),
            SymbolKind::NamedNumber(index) => self.place(self.numbers + index, span),
            SymbolKind::Class(index) => self.place(self.classes + index, span),
            _ => {}
        }
    }

    /// Takes down that a package is named.
    pub(super) fn package(&mut self, name: &str, span: Span) {
        if let Some(symbol) = self.packages.get(name) {
            self.place(*symbol, span);
        }
    }

    /// Takes down that an accessor is named.
    pub(super) fn accessor(&mut self, name: &Ident) {
        if let Some(symbol) = self.accessors.get(&name.name) {
            self.place(*symbol, name.span);
        }
    }

    /// Takes down that an agent is named.
    pub(super) fn agent(&mut self, name: &Ident) {
        if let Some(symbol) = self.agents.get(&name.name) {
            self.place(*symbol, name.span);
        }
    }

    /// The symbol of a label, if it is one.
    pub(super) fn label(&self, name: &Ident) -> Option<usize> {
        self.labels.get(&name.name).filter(|_| name.package.is_none()).copied()
    }

    /// All labels, sorted by name.
    pub(super) fn labels(&self) -> impl Iterator<Item = &Symbol> {
        self.labels.values().map(|symbol| &self.symbols[*symbol])
    }

    /// All parameters with the programs they belong to.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (usize, &Symbol)> {
        self.symbols.iter().filter_map(|symbol| match symbol.kind {
            SymbolKind::Parameter(program) => Some((program, symbol)),
            _ => None,
        })
    }

    /// The symbols with their places in order.
    pub fn sorted(self) -> Symbols {
        let mut symbols = self.symbols;
        let mut places = Vec::new();
        for (number, symbol) in symbols.iter_mut().enumerate() {
            symbol.places.sort();
            symbol.places.dedup_by_key(|place| place.span);
            places.extend(symbol.places.iter().map(|place| (*place, number as u32)));
        }
        places.sort_unstable();
        places.dedup_by_key(|(place, _)| place.span);
        Symbols { symbols, places }
    }
}

impl Symbol {
    /// True if it is named anywhere but in its definitions.
    pub(super) fn is_used(&self) -> bool {
        self.places.iter().any(|place| !place.definition)
    }
}
