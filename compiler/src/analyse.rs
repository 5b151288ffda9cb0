//! The program as written to the program with every name resolved and every bound checked.

mod body;
mod bounds;
mod calls;
mod classes;
mod expression;
mod names;
pub(crate) mod problem;
pub(crate) mod symbols;
mod team;
mod unused;

use std::collections::BTreeSet;

use crate::Options;
use crate::ast::{self, Ident};
use crate::nearest::nearest;
use crate::parse::DEFAULT_PACKAGE;
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Body, Model, Program, Work};
use expression::{Numbers, Resolver, named_numbers};
use names::Names;
use problem::{Limit, Problem};
use symbols::{SymbolKind, Uses};

/// Resolves all names, checks all declarations, and finds the program to start from.
pub(crate) fn analyse(program: &ast::Program, options: &Options, problems: &mut Problems) -> (Model, Uses) {
    let mut uses = Uses::new(program);
    let names = Names::new(program, &mut uses, problems);
    classes::check(program, &names, &mut uses, problems);
    let numbers = named_numbers(program, &names, &mut uses, problems);
    let team = team::team(program, &names, &numbers, &mut uses, problems);
    let mut model = Model { team, ..Model::default() };
    for (index, definition) in program.programs.iter().enumerate() {
        let mut analyser = Analyser {
            names: &names,
            numbers: &numbers,
            program,
            definition,
            scope: Vec::new(),
            uses: &mut uses,
            problems,
        };
        for parameter in &definition.parameters {
            analyser.variable(SymbolKind::Parameter(index), parameter);
        }
        model.programs.push(analyser.program());
    }
    // What is wrong may be why something is not used.
    if !problems.has_errors() {
        unused::report_parameters(program, &uses, problems);
        unused::report_labels(&uses, problems);
    }
    calls::check_recursion(&model, problems);
    model.entry = entry(program, &names, options, problems);
    if let Some(entry) = model.entry {
        calls::check_use(&model, program, entry, options, problems);
    }
    (model, uses)
}

/// Looks at one program.
pub(crate) struct Analyser<'a> {
    names: &'a Names,
    numbers: &'a Numbers,
    program: &'a ast::Program,
    definition: &'a ast::ControlProgram,
    /// The parameters, and the variables of `let` and `dotimes` around the place at hand.
    scope: Vec<Variable>,
    uses: &'a mut Uses,
    problems: &'a mut Problems,
}

/// A parameter, or a variable of `let` or `dotimes`.
pub(crate) struct Variable {
    name: String,
    symbol: usize,
}

impl Analyser<'_> {
    fn program(mut self) -> Program {
        let definition = self.definition;
        let body: Vec<Body> = self.bodies(&definition.body);
        let work = match (definition.primitive, definition.body.first()) {
            (true, None) => Work::Primitive(self.timing()),
            (true, Some(first)) => {
                let program = definition.name.clone();
                self.problems.push(Problem::PrimitiveWithBody { program, body: first.span() });
                Work::Body(body)
            }
            (false, first) => {
                self.composite(first.is_some());
                Work::Body(body)
            }
        };
        if matches!(work, Work::Body(_)) {
            // It should have no duration, which has been told; the names in it are names all the same.
            self.quietly(|it| drop(it.timing()));
        }
        for condition in [&definition.requires, &definition.effect].into_iter().flatten() {
            self.condition(condition);
        }
        Program {
            name: definition.name.clone(),
            parameters: definition.parameters.clone(),
            agent: definition.agent.as_ref().and_then(|agent| self.resolver().agent(agent)),
            work,
            requires: definition.requires.clone(),
            effect: definition.effect.clone(),
        }
    }

    /// Checks what a program that is not primitive may not have, and must.
    fn composite(&mut self, has_body: bool) {
        let ast::ControlProgram { name: program, duration, body, span, damaged, .. } = self.definition;
        let program = program.clone();
        self.problems.push(match duration {
            Some(duration) if has_body => {
                Problem::DurationOfBody { program, duration: duration.span, limit: limit(duration, body) }
            }
            _ if has_body || *damaged => return,
            Some(duration) => Problem::OnlyADuration { program, duration: duration.span },
            None => Problem::NoBody { program, definition: *span },
        });
    }

    /// Takes down the names in what is no use otherwise, and says nothing about it.
    fn quietly(&mut self, look: impl FnOnce(&mut Self)) {
        let told = std::mem::take(self.problems);
        look(self);
        *self.problems = told;
    }

    /// Knows what the names mean in the place at hand.
    fn resolver(&mut self) -> Resolver<'_> {
        Resolver {
            names: self.names,
            numbers: self.numbers,
            program: self.program,
            home: &self.definition.home,
            scope: &self.scope,
            uses: self.uses,
            problems: self.problems,
        }
    }
}

/// What limits the one form of a body as its program was to be, unless Nature was to decide.
fn limit(duration: &ast::DurationOf, body: &[ast::Body]) -> Option<Limit> {
    let [form] = body else { return None };
    let ast::Bounds { lower, upper, .. } = &duration.bounds;
    let is_ours = !duration.contingent && duration.delay.is_none();
    let place = |amount: &Option<ast::Amount>| amount.as_ref().map(|amount| amount.span);
    is_ours.then(|| Limit { form: form.span(), lower: place(lower), upper: place(upper) })
}

/// Finds the program to start from.
fn entry(program: &ast::Program, names: &Names, options: &Options, problems: &mut Problems) -> Option<usize> {
    let start = Span::default();
    let wanted = options.entry.to_lowercase();
    let defined: Vec<&str> = names.packages();
    let homes: Vec<String> = match &options.package {
        Some(package) => {
            let text = package.trim_start_matches("#:").trim_start_matches(':').to_lowercase();
            let text = names.package("", &text).to_string();
            let has_programs = program.programs.iter().any(|p| p.home == text);
            if !defined.contains(&text.as_str()) && !has_programs {
                let near = nearest(&text, defined.iter().copied()).map(str::to_string);
                problems.push(Problem::NoSuchPackage { name: text, defined: owned(&defined), near });
                return None;
            }
            vec![text]
        }
        None => match holders(program, &wanted).as_slice() {
            // If just one of them has the program, that is the one.
            [only] if defined.len() > 1 => vec![only.home.clone()],
            several @ [_, _, ..] => {
                let places = several.iter().map(|p| (p.home.clone(), p.name.span)).collect();
                problems.push(Problem::SeveralEntries { name: wanted, places });
                return None;
            }
            _ if defined.len() > 1 => {
                let second = program.packages.iter().find(|package| package.name.name == defined[1]);
                let second = second.map_or(start, |package| package.name.span);
                problems.push(Problem::NoPackageChosen { second, defined: owned(&defined) });
                return None;
            }
            // One package or none, whether declared or only entered.
            _ => {
                let mut homes = owned(&defined);
                homes.push(DEFAULT_PACKAGE.to_string());
                homes.extend(program.programs.iter().map(|p| p.home.clone()));
                homes
            }
        },
    };
    let plain = |home: &String| {
        let ident = Ident { package: None, name: wanted.clone(), span: start };
        names.program(&ident, home)
    };
    let found = homes.iter().find_map(plain);
    // Where nothing is defined and something is wrong, that is why.
    let nothing = program.programs.is_empty() && problems.has_errors();
    if found.is_none() && !nothing && !problems.has_lost(&wanted) {
        let there: Vec<&Ident> =
            program.programs.iter().filter(|p| homes.contains(&p.home)).map(|p| &p.name).collect();
        let candidates: Vec<&str> = there.iter().map(|name| name.name.as_str()).collect();
        problems.push(Problem::NoEntry {
            near: nearest(&wanted, candidates.iter().copied()).map(str::to_string),
            name: wanted,
            last: there.last().map_or(start, |name| name.span),
            candidates: owned(&candidates),
        });
    }
    found
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

/// The programs of a name, the first in each package.
fn holders<'a>(program: &'a ast::Program, wanted: &str) -> Vec<&'a ast::ControlProgram> {
    let mut seen = BTreeSet::new();
    let named = program.programs.iter().filter(|p| p.name.name == wanted);
    named.filter(|p| seen.insert(&p.home)).collect()
}
