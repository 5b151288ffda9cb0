//! The program as written to the program with every name resolved and every bound checked.

mod bounds;
mod calls;
mod classes;
mod names;

use crate::Options;
use crate::ast::{self, Ident, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::nearest::nearest;
use crate::parse::DEFAULT_PACKAGE;
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Argument, Body, Model, Program, Work};
use classes::Classes;
use names::Names;

pub(crate) use bounds::reversed;
pub(crate) use calls::calls_of;

/// Resolves all names, checks all declarations, and finds the program to start from.
pub fn analyse(program: &ast::Program, options: &Options, problems: &mut Problems) -> Model {
    let names = Names::new(program, problems);
    let classes = Classes::new(program, &names, problems);
    let mut model = Model::default();
    for definition in &program.programs {
        model.programs.push(Analyser { names: &names, program, definition, problems }.program(&classes));
    }
    calls::check_recursion(&model, problems);
    model.entry = entry(program, &names, options, problems);
    if let Some(entry) = model.entry {
        calls::check_use(&model, entry, options.entry.eq_ignore_ascii_case("main"), problems);
    }
    model
}

/// Looks at one program.
pub(crate) struct Analyser<'a> {
    names: &'a Names,
    program: &'a ast::Program,
    definition: &'a ast::ControlProgram,
    problems: &'a mut Problems,
}

impl Analyser<'_> {
    fn program(&mut self, classes: &Classes<'_>) -> Program {
        let definition = self.definition;
        let body: Vec<Body> = definition.body.iter().filter_map(|body| self.body(body)).collect();
        let work = match (definition.primitive, definition.body.first()) {
            (true, None) => Work::Primitive(self.timing()),
            (true, Some(first)) => {
                let message = format!("the primitive program `{}` has a body", clip(&definition.name.name));
                self.problems.push(
                    Diagnostic::error(Code::PrimitiveWithBody, span_of(first), message)
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
        for condition in [&definition.requires, &definition.effect].into_iter().flatten() {
            classes.check(condition, definition, self.program, self.names, self.problems);
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
            Some(duration) if has_body => self.problems.push(
                Diagnostic::error(Code::DurationOfBody, duration.span, format!("`{name}` has a body and a duration"))
                    .primary("only a primitive program has a duration of its own")
                    .help("To limit how long the body takes, put `(with-temporal-constraint (simple-temporal ...) ...)` around it."),
            ),
            Some(duration) => self.problems.push(
                Diagnostic::error(Code::NoBody, definition.name.span, format!("`{name}` is neither primitive nor has it a body"))
                    .primary("nothing says what this program does")
                    .label(duration.span, "it only has a duration")
                    .help("Declare it primitive: `(declare (primitive) (duration ...))`."),
            ),
            None if !has_body && !definition.damaged => self.problems.push(
                Diagnostic::error(Code::NoBody, definition.name.span, format!("`{name}` has no body"))
                    .primary("nothing says what this program does")
                    .help("Give it a body, or declare it primitive: `(declare (primitive) (duration (simple :upper-bound 10)))`."),
            ),
            None => {}
        }
    }

    fn body(&mut self, body: &ast::Body) -> Option<Body> {
        Some(match body {
            ast::Body::Call(call) => return self.call(call),
            ast::Body::Sequence(group) | ast::Body::Parallel(group) => Body::Group {
                parallel: matches!(body, ast::Body::Parallel(_)),
                slack: group.slack,
                body: group.body.iter().filter_map(|body| self.body(body)).collect(),
                operator: group.operator,
            },
            ast::Body::WithTemporalConstraint(within) => Body::Within {
                bounds: self.bounds(&within.bounds, "the lower bound", "the upper bound"),
                body: within.body.iter().filter_map(|body| self.body(body)).collect(),
                operator: within.operator,
            },
        })
    }

    fn call(&mut self, call: &ast::Call) -> Option<Body> {
        let home = &self.definition.home;
        let program = match self.names.program(&call.program, home) {
            Some(program) => program,
            None => {
                let span = call.program.span;
                if self.problems.has_lost_definitions() {
                    return None;
                }
                let problem = match self.problems.wants(span.source) {
                    true => self.names.unknown_program(&call.program, home),
                    false => Diagnostic::error(Code::UnknownProgram, span, ""),
                };
                self.problems.push(problem);
                return None;
            }
        };
        let target = &self.program.programs[program];
        let (wanted, given) = (target.parameters.len(), call.arguments.len());
        if wanted != given {
            let count = |n: usize| if n == 1 { "1 argument".to_string() } else { format!("{n} arguments") };
            let name = clip(&target.name.name);
            self.problems.push(
                Diagnostic::error(
                    Code::WrongArguments,
                    call.span,
                    format!("`{name}` takes {}, not {given}", count(wanted)),
                )
                .primary(format!("{} here", count(given)))
                .label(target.name.span, "defined here")
                .help(format!("Call it as `{}`.", shape(target))),
            );
        }
        let arguments = call.arguments.iter().map(|value| self.argument(value)).collect();
        Some(Body::Call { program, arguments, span: call.span })
    }

    fn argument(&mut self, value: &ast::Value) -> Argument {
        if let ValueKind::Name(package, name) = &value.kind {
            let ident = Ident { package: package.clone(), name: name.clone(), span: value.span };
            if let Some(index) = self.parameter(&ident) {
                return Argument::Parameter(index);
            }
            if let Some(number) = self.names.number(&ident, &self.definition.home) {
                if let ast::AmountKind::Number(number) = self.program.parameters[number].value.kind {
                    return Argument::Value(ast::Value { kind: ValueKind::Number(number), span: value.span });
                }
            } else {
                self.unknown_name(&ident);
            }
        }
        Argument::Value(value.clone())
    }

    /// The place of a parameter of this program.
    fn parameter(&self, ident: &Ident) -> Option<usize> {
        let mine = |parameter: &Ident| ident.package.is_none() && parameter.name == ident.name;
        self.definition.parameters.iter().position(mine)
    }

    fn unknown_name(&mut self, ident: &Ident) {
        let parameters = self.definition.parameters.iter().map(|p| p.name.as_str());
        let numbers = self.program.parameters.iter().map(|p| p.name.name.as_str());
        let help =
            nearest(&ident.name, parameters.chain(numbers)).map(|near| format!("Did you mean `{near}`?"));
        self.problems.push(
            Diagnostic::error(Code::UnknownName, ident.span, format!("nothing is called `{}`", clip(&ident.name)))
                .primary("neither a parameter of this program nor a named number")
                .help("A value is a number, a string, `t`, `nil`, a parameter, or a name from `defparameter`. A symbol is quoted: `'name`.")
                .maybe_help(help),
        );
    }
}

/// Finds the program to start from.
fn entry(program: &ast::Program, names: &Names, options: &Options, problems: &mut Problems) -> Option<usize> {
    let start = Span::default();
    let wanted = options.entry.to_lowercase();
    let defined: Vec<&str> = names.packages();
    let homes: Vec<String> = match &options.package {
        Some(package) => {
            let text = package.trim_start_matches("#:").trim_start_matches(':').to_lowercase();
            let has_programs = program.programs.iter().any(|p| p.home == text);
            if !defined.contains(&text.as_str()) && !has_programs {
                let near =
                    nearest(&text, defined.iter().copied()).map(|near| format!("Did you mean `{near}`?"));
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
                    .maybe_help(near),
                );
                return None;
            }
            vec![text]
        }
        None if defined.len() > 1 => {
            let second = program.packages.iter().find(|p| p.name.name == defined[1]);
            problems.push(
                Diagnostic::error(
                    Code::PackageNotChosen,
                    second.map_or(start, |package| package.name.span),
                    "the source defines several packages and none is chosen",
                )
                .primary("the second one")
                .help(format!("Choose one with `-P`: `{}`.", defined.join("`, `"))),
            );
            return None;
        }
        None => {
            // One package or none, whether declared or only entered.
            let mut homes: Vec<String> = defined.iter().map(ToString::to_string).collect();
            homes.push(DEFAULT_PACKAGE.to_string());
            homes.extend(program.programs.iter().map(|p| p.home.clone()));
            homes
        }
    };
    let plain = |home: &String| {
        let ident = Ident { package: None, name: wanted.clone(), span: start };
        names.program(&ident, home)
    };
    let found = homes.iter().find_map(plain);
    if found.is_none() && !problems.has_lost_definitions() {
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
                clip(&candidates.join(", "))
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

fn shape(target: &ast::ControlProgram) -> String {
    let words = std::iter::once(&target.name).chain(&target.parameters).map(|ident| clip(&ident.name));
    format!("({})", words.collect::<Vec<_>>().join(" "))
}

fn span_of(body: &ast::Body) -> Span {
    match body {
        ast::Body::Call(call) => call.span,
        ast::Body::Sequence(group) | ast::Body::Parallel(group) => group.span,
        ast::Body::WithTemporalConstraint(within) => within.span,
    }
}
