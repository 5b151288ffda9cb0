//! What has a name, and every place where that name stands: for editors, which go from one to the other.
//!
//! Resolves names as [`analyse`](fn@super::analyse) does, in a program with errors as well: a name that means nothing is
//! no place of anything.

use std::collections::BTreeMap;

use super::body::occurs;
use super::names::Names;
use crate::ast::{
    self, Amount, AmountKind, Argument, Body, Bounds, Condition, ControlProgram, EventOf, Ident, Import,
    Program, Type, Value, ValueKind,
};
use crate::problem::Problems;
use crate::source::Span;

/// Something that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// What it is.
    pub kind: SymbolKind,
    /// Its name, in lower case.
    pub name: String,
    /// Where it stands, in source order, with the package if one is written before it.
    pub places: Vec<Place>,
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
}

/// One place where a name stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
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
    places: Vec<(Place, u32)>,
}

impl Symbols {
    /// The symbol whose name stands at a byte of a source, or ends there, and that place.
    pub fn at(&self, source: u32, offset: u32) -> Option<(&Symbol, Place)> {
        let is_before = |span: Span| (span.source, span.start) <= (source, offset);
        let after = self.places.partition_point(|(place, _)| is_before(place.span));
        let (place, symbol) = self.places[..after].last().copied()?;
        if place.span.source != source || offset > place.span.end {
            return None;
        }
        Some((&self.symbols[symbol as usize], place))
    }

    /// Every place with its symbol, in source order.
    pub fn places(&self) -> impl Iterator<Item = (Place, &Symbol)> {
        self.places.iter().map(|(place, symbol)| (*place, &self.symbols[*symbol as usize]))
    }
}

/// Finds all symbols of a program, however broken it is.
pub fn symbols(program: &Program) -> Symbols {
    // What is wrong with the names is reported by `analyse`.
    let names = Names::new(program, &mut Problems::default());
    let mut finder = Finder {
        program,
        names: &names,
        symbols: Vec::new(),
        labels: BTreeMap::new(),
        accessors: BTreeMap::new(),
        packages: BTreeMap::new(),
        first: First::default(),
        scope: Vec::new(),
        home: "",
    };
    finder.definitions();
    for definition in &program.programs {
        for body in &definition.body {
            finder.labels_of(body);
        }
    }
    for (index, definition) in program.programs.iter().enumerate() {
        finder.control_program(index, definition);
    }
    let mut symbols = finder.symbols;
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

/// The number of the first symbol of each kind that is numbered as the program is.
#[derive(Default)]
struct First {
    programs: usize,
    numbers: usize,
    classes: usize,
}

struct Finder<'a> {
    program: &'a Program,
    names: &'a Names,
    symbols: Vec<Symbol>,
    labels: BTreeMap<&'a str, usize>,
    accessors: BTreeMap<&'a str, usize>,
    packages: BTreeMap<&'a str, usize>,
    first: First,
    /// The parameters and variables known in the place at hand, from the outside in.
    scope: Vec<(&'a str, usize)>,
    home: &'a str,
}

impl<'a> Finder<'a> {
    fn add(&mut self, kind: SymbolKind, name: &'a Ident) -> usize {
        let places = vec![Place { span: name.span, definition: true }];
        self.symbols.push(Symbol { kind, name: name.name.clone(), places });
        self.symbols.len() - 1
    }

    fn place(&mut self, symbol: usize, span: Span, definition: bool) {
        self.symbols[symbol].places.push(Place { span, definition });
    }

    /// Everything that is defined at the top level, with what its definition refers to.
    fn definitions(&mut self) {
        let program = self.program;
        self.first.programs = self.symbols.len();
        for (index, definition) in program.programs.iter().enumerate() {
            self.add(SymbolKind::Program(index), &definition.name);
        }
        self.first.numbers = self.symbols.len();
        for (index, number) in program.parameters.iter().enumerate() {
            self.add(SymbolKind::NamedNumber(index), &number.name);
        }
        self.first.classes = self.symbols.len();
        for (index, class) in program.classes.iter().enumerate() {
            self.add(SymbolKind::Class(index), &class.name);
        }
        for package in &program.packages {
            let symbol = self.add(SymbolKind::Package, &package.name);
            self.packages.entry(&package.name.name).or_insert(symbol);
        }
        for package in &program.packages {
            for used in &package.uses {
                if let Some(symbol) = self.packages.get(used.name.as_str()) {
                    self.place(*symbol, used.span, false);
                }
            }
            for Import { from, name } in &package.imports {
                if let Some(symbol) = self.packages.get(from.name.as_str()) {
                    self.place(*symbol, from.span, false);
                }
                let name = Ident { package: Some(from.name.clone()), ..name.clone() };
                if let Some(index) = self.names.program(&name, &package.name.name) {
                    self.place(self.first.programs + index, name.span, false);
                } else if let Some(index) = self.names.number(&name, &package.name.name) {
                    self.place(self.first.numbers + index, name.span, false);
                }
            }
        }
        for number in &program.parameters {
            self.home = &number.home;
            self.amount(&number.value);
        }
        for (index, class) in program.classes.iter().enumerate() {
            self.home = &class.home;
            class.supers.iter().for_each(|parent| self.class(parent));
            for slot in &class.slots {
                self.add(SymbolKind::Slot(index), &slot.name);
                let mut open: Vec<&Type> = slot.kind.iter().collect();
                while let Some(kind) = open.pop() {
                    match kind {
                        Type::Named(name) => self.class(name),
                        Type::Or(kinds) => open.extend(kinds),
                        Type::Member(_) | Type::Anything => {}
                    }
                }
                for accessor in &slot.accessors {
                    match self.accessors.get(accessor.name.as_str()).copied() {
                        Some(symbol) => self.place(symbol, accessor.span, true),
                        None => {
                            let symbol = self.add(SymbolKind::Accessor, accessor);
                            self.accessors.insert(&accessor.name, symbol);
                        }
                    }
                }
            }
        }
    }

    fn class(&mut self, name: &Ident) {
        if let Some(index) = self.names.class(name, self.home) {
            self.place(self.first.classes + index, name.span, false);
        }
    }

    fn labels_of(&mut self, body: &'a Body) {
        if let Body::Label(labelled) = body {
            match self.labels.get(labelled.name.name.as_str()).copied() {
                Some(symbol) => self.place(symbol, labelled.name.span, true),
                None => {
                    let symbol = self.add(SymbolKind::Label, &labelled.name);
                    self.labels.insert(&labelled.name.name, symbol);
                }
            }
        }
        body.parts().iter().for_each(|part| self.labels_of(part));
    }

    fn control_program(&mut self, index: usize, definition: &'a ControlProgram) {
        self.home = &definition.home;
        self.scope.clear();
        for parameter in &definition.parameters {
            let symbol = self.add(SymbolKind::Parameter(index), parameter);
            self.scope.push((&parameter.name, symbol));
        }
        if let Some(duration) = &definition.duration {
            self.bounds(&duration.bounds);
            duration.delay.iter().for_each(|delay| self.bounds(delay));
        }
        for condition in [&definition.requires, &definition.effect].into_iter().flatten() {
            self.condition(condition);
        }
        definition.body.iter().for_each(|body| self.body(body));
    }

    fn body(&mut self, body: &'a Body) {
        let outside = self.scope.len();
        match body {
            Body::Call(call) => {
                if let Some(index) = self.names.program(&call.program, self.home) {
                    self.place(self.first.programs + index, call.program.span, false);
                }
                self.arguments(&call.arguments);
            }
            Body::Sequence(_) | Body::Parallel(_) => {}
            Body::WithTemporalConstraint(within) => self.bounds(&within.bounds),
            Body::Delay(wait) => self.bounds(&wait.bounds),
            Body::Let(binding) => {
                let mut names = Vec::new();
                for (name, value) in &binding.bindings {
                    self.argument(value);
                    let symbol = self.add(SymbolKind::Variable, name);
                    match binding.sequential {
                        true => self.scope.push((&name.name, symbol)),
                        false => names.push((name.name.as_str(), symbol)),
                    }
                }
                self.scope.extend(names);
            }
            Body::Dotimes(dotimes) => {
                self.amount(&dotimes.count);
                let symbol = self.add(SymbolKind::Variable, &dotimes.variable);
                self.scope.push((&dotimes.variable.name, symbol));
            }
            Body::Label(labelled) => self.arguments(&labelled.arguments),
            Body::Between(between) => {
                self.event(&between.from);
                self.event(&between.to);
                self.bounds(&between.bounds);
            }
        }
        body.parts().iter().for_each(|part| self.body(part));
        self.scope.truncate(outside);
    }

    fn event(&mut self, event: &EventOf) {
        let label =
            self.labels.get(event.name.name.as_str()).filter(|_| event.name.package.is_none()).copied();
        let program = || self.names.program(&event.name, self.home).map(|index| self.first.programs + index);
        if let Some(symbol) = label.or_else(program) {
            self.place(symbol, event.name.span, false);
        } else if let Some(name) = occurs(&event.name)
            && let Some(index) = self.names.program(&name, self.home)
        {
            self.place(self.first.programs + index, name.span, false);
        }
        event.arguments.iter().for_each(|arguments| self.arguments(arguments));
    }

    fn bounds(&mut self, bounds: &Bounds) {
        [&bounds.lower, &bounds.upper].into_iter().flatten().for_each(|amount| self.amount(amount));
    }

    fn amount(&mut self, amount: &Amount) {
        match &amount.kind {
            AmountKind::Named(name) => self.value_of(name.package.is_none(), name, amount.span),
            AmountKind::Unit(_, _, inner) => self.amount(inner),
            AmountKind::Calculation(_, parts) => parts.iter().for_each(|part| self.amount(part)),
            AmountKind::Number(_) | AmountKind::Infinite | AmountKind::Error => {}
        }
    }

    fn arguments(&mut self, arguments: &[Argument]) {
        arguments.iter().for_each(|argument| self.argument(argument));
    }

    fn argument(&mut self, argument: &Argument) {
        match argument {
            Argument::Value(value) => self.value(value),
            Argument::Amount(amount) => self.amount(amount),
        }
    }

    fn value(&mut self, value: &Value) {
        if let ValueKind::Name(package, name) = &value.kind {
            let ident = Ident { package: package.clone(), name: name.clone(), span: value.span };
            self.value_of(package.is_none(), &ident, value.span);
        }
    }

    /// A parameter, a variable or a named number.
    fn value_of(&mut self, may_be_variable: bool, ident: &Ident, span: Span) {
        let variable = self.scope.iter().rfind(|(name, _)| may_be_variable && *name == ident.name);
        let symbol = match variable {
            Some((_, symbol)) => Some(*symbol),
            None => self.names.number(ident, self.home).map(|index| self.first.numbers + index),
        };
        if let Some(symbol) = symbol {
            self.place(symbol, span, false);
        }
    }

    fn condition(&mut self, condition: &Condition) {
        let mut open = vec![condition];
        while let Some(condition) = open.pop() {
            let slot: &ast::SlotOf = match condition {
                Condition::And(parts) | Condition::Or(parts) => {
                    open.extend(parts);
                    continue;
                }
                Condition::Not(part)
                | Condition::AtStart(part)
                | Condition::AtEnd(part)
                | Condition::OverAll(part) => {
                    open.push(part);
                    continue;
                }
                Condition::Equal(slot, value) => {
                    self.value(value);
                    slot
                }
                Condition::Holds(slot) => slot,
            };
            if let Some(symbol) = self.accessors.get(slot.accessor.name.as_str()) {
                self.place(*symbol, slot.accessor.span, false);
            }
            self.value(&slot.object);
        }
    }
}
