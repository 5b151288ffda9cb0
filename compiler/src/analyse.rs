//! The program as written to the program with every name resolved and every bound checked.

mod body;
mod bounds;
mod calls;
mod classes;
mod expression;
mod names;
pub(crate) mod symbols;
mod unused;

use std::collections::BTreeSet;

use crate::Options;
use crate::ast::{self, Ident};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::clip;
use crate::nearest::nearest;
use crate::parse::DEFAULT_PACKAGE;
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Body, Model, Program, Work};
use expression::{Numbers, Resolver, named_numbers};
use names::Names;
use symbols::{SymbolKind, Uses};

pub(crate) use bounds::{negative, reversed};

/// Resolves all names, checks all declarations, and finds the program to start from.
pub(crate) fn analyse(program: &ast::Program, options: &Options, problems: &mut Problems) -> (Model, Uses) {
    let mut uses = Uses::new(program);
    let names = Names::new(program, &mut uses, problems);
    classes::check(program, &names, &mut uses, problems);
    let numbers = named_numbers(program, &names, &mut uses, problems);
    let mut model = Model::default();
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
                let message = format!("the primitive program `{}` has a body", clip(&definition.name.name));
                self.problems.push(
                    Diagnostic::error(Code::PrimitiveWithBody, first.span(), message)
                        .primary("a primitive program has no body")
                        .label(definition.name.span, "declared `(primitive)` here")
                        .help("Take out `(primitive)` if the program consists of others, or the body if it does not."),
                );
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
            work,
            requires: definition.requires.clone(),
            effect: definition.effect.clone(),
        }
    }

    /// Checks what a program that is not primitive may not have, and must.
    fn composite(&mut self, has_body: bool) {
        let definition = self.definition;
        let name = clip(&definition.name.name);
        match &definition.duration {
            Some(duration) if has_body => {
                let message = format!("`{name}` has a body and a duration");
                let problem = Diagnostic::error(Code::DurationOfBody, duration.span, message)
                    .primary("only a primitive program has a duration of its own")
                    .help("To limit how long the body takes, put `(with-temporal-constraint (simple-temporal ...) ...)` around it.");
                self.problems.push(around_the_body(problem, duration, &definition.body));
            }
            Some(_) if definition.damaged => {}
            Some(duration) => self.problems.push(
                Diagnostic::error(Code::NoBody, definition.name.span, format!("`{name}` is neither primitive nor has it a body"))
                    .primary("nothing says what this program does")
                    .label(duration.span, "it only has a duration")
                    .help("Declare it primitive: `(declare (primitive) (duration ...))`.")
                    .suggest("Declare it primitive", [Edit::before(duration.span, "(primitive) ")]),
            ),
            None if !has_body && !definition.damaged => self.problems.push(
                Diagnostic::error(Code::NoBody, definition.name.span, format!("`{name}` has no body"))
                    .primary("nothing says what this program does")
                    .help("Give it a body, or declare it primitive: `(declare (primitive) (duration (simple :upper-bound 10)))`.")
                    .suggest("Declare it primitive", [Edit::before(closing(definition.span), " (declare (primitive))")]),
            ),
            None => {}
        }
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

/// With the suggestion to limit the one form of a body as its program was to be, unless Nature was to decide.
fn around_the_body(problem: Diagnostic, duration: &ast::DurationOf, body: &[ast::Body]) -> Diagnostic {
    let (Some(form), true) = (body.first(), body.len() == 1) else { return problem };
    if duration.contingent || duration.delay.is_some() {
        return problem;
    }
    let start = Span { end: form.span().start, ..form.span() };
    let mut edits = vec![
        Edit::replace(duration.span, ""),
        Edit::before(start, "(with-temporal-constraint (simple-temporal"),
    ];
    let ast::Bounds { lower, upper, .. } = &duration.bounds;
    for (word, amount) in [("lower", lower), ("upper", upper)] {
        if let Some(amount) = amount {
            edits.extend([Edit::before(start, format!(" :{word}-bound ")), Edit::copy(start, amount.span)]);
        }
    }
    edits.extend([Edit::before(start, ") "), Edit::after(form.span(), ")")]);
    problem.suggest("Limit the body instead", edits)
}

/// The parenthesis at the end of a form.
fn closing(form: Span) -> Span {
    Span { start: form.end.saturating_sub(1), ..form }
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
                let near = nearest(&text, defined.iter().copied());
                let known = if defined.is_empty() {
                    "It defines no package at all: leave `-P` out.".to_string()
                } else {
                    format!("It defines `{}`.", defined.join("`, `"))
                };
                problems.push(
                    Diagnostic::error(
                        Code::UnknownPackage,
                        start,
                        format!("the source defines no package `{}`", clip(&text)),
                    )
                    .primary("looked for it here")
                    .help(known)
                    .maybe_help(near.map(|near| format!("Did you mean `{near}`?"))),
                );
                return None;
            }
            vec![text]
        }
        None => match holders(program, &wanted).as_slice() {
            // If just one of them has the program, that is the one.
            [only] if defined.len() > 1 => vec![only.home.clone()],
            [first, second, ..] => {
                problems.push(several(program, first, second));
                return None;
            }
            _ if defined.len() > 1 => {
                problems.push(not_chosen(program, &defined));
                return None;
            }
            // One package or none, whether declared or only entered.
            _ => {
                let mut homes: Vec<String> = defined.iter().map(ToString::to_string).collect();
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
        let candidates: Vec<&str> = program
            .programs
            .iter()
            .filter(|p| homes.contains(&p.home))
            .map(|p| p.name.name.as_str())
            .collect();
        let at = program.programs.iter().rfind(|p| homes.contains(&p.home)).map_or(start, |p| p.name.span);
        let help = match (nearest(&wanted, candidates.iter().copied()), candidates.len()) {
            (Some(near), _) => format!("Did you mean `--entry {near}`?"),
            (None, 0) => "A program is `(define-control-program main () ...)`.".to_string(),
            (None, _) => format!(
                "Define `{}`, or start from another program with `--entry NAME`: {}.",
                clip(&wanted),
                some_of(&candidates)
            ),
        };
        problems.push(
            Diagnostic::error(
                Code::NoEntry,
                at,
                format!("there is no program `{}` to start from", clip(&wanted)),
            )
            .primary(if candidates.is_empty() {
                "no program is defined here"
            } else {
                "the last program defined"
            })
            .help(help),
        );
    }
    found
}

/// The first names, as many as a line has room for.
fn some_of(names: &[&str]) -> String {
    let mut shown = String::new();
    for (index, name) in names.iter().enumerate() {
        let name = clip(name);
        if index > 0 && shown.chars().count() + name.chars().count() > 60 {
            return format!("{shown} and {} more", names.len() - index);
        }
        shown.push_str(if index > 0 { ", " } else { "" });
        shown.push_str(&name);
    }
    shown
}

/// The programs of a name, the first in each package.
fn holders<'a>(program: &'a ast::Program, wanted: &str) -> Vec<&'a ast::ControlProgram> {
    let mut seen = BTreeSet::new();
    let named = program.programs.iter().filter(|p| p.name.name == wanted);
    named.filter(|p| seen.insert(&p.home)).collect()
}

/// Programs to start from in several packages, of which what is outside any package counts as one.
fn several(program: &ast::Program, first: &ast::ControlProgram, second: &ast::ControlProgram) -> Diagnostic {
    let name = &first.name.name;
    let homes: Vec<String> = holders(program, name).iter().map(|p| format!("`{}`", clip(&p.home))).collect();
    let outside = [first, second].iter().any(|p| p.home == DEFAULT_PACKAGE);
    let help = match outside {
        true => format!(
            "Choose the package with `-P`: {}. What is in no package is in `{DEFAULT_PACKAGE}`.",
            homes.join(", ")
        ),
        false => format!("Choose the package with `-P`: {}.", homes.join(", ")),
    };
    Diagnostic::error(
        Code::PackageNotChosen,
        second.name.span,
        format!("several packages have a program `{}` to start from, and none is chosen", clip(name)),
    )
    .primary("the second one")
    .label(first.name.span, "the first one")
    .help(help)
}

fn not_chosen(program: &ast::Program, defined: &[&str]) -> Diagnostic {
    let second = program.packages.iter().find(|p| p.name.name == defined[1]);
    Diagnostic::error(
        Code::PackageNotChosen,
        second.map_or(Span::default(), |package| package.name.span),
        "the source defines several packages and none is chosen",
    )
    .primary("the second one")
    .help(format!("Choose one with `-P`: `{}`.", defined.join("`, `")))
}
