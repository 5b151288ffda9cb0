//! The forms of a body: what is called, with which values, and which events are meant.

use super::problem::{Missing, Problem};
use super::symbols::SymbolKind;
use super::{Analyser, Variable};
use crate::ast::{self, Ident, Limits};
use crate::evaluate;
use crate::nearest::nearest;
use crate::parse::instead_of_operator;
use crate::source::Span;
use crate::typed::{Between, Body, EventOf, Expression, ExpressionKind};

impl Analyser<'_> {
    /// Resolves the forms of a body.
    pub(super) fn bodies(&mut self, bodies: &[ast::Body]) -> Vec<Body> {
        bodies.iter().filter_map(|body| self.body(body)).collect()
    }

    fn body(&mut self, body: &ast::Body) -> Option<Body> {
        match body {
            ast::Body::Call(call) => self.call(call),
            ast::Body::Sequence(group) => Some(self.group(group, false)),
            ast::Body::Parallel(group) => Some(self.group(group, true)),
            ast::Body::WithTemporalConstraint(within) => Some(self.within(within)),
            ast::Body::Delay(wait) => Some(self.wait(wait)),
            ast::Body::Let(binding) if binding.sequential => Some(self.binding_one_by_one(binding)),
            ast::Body::Let(binding) => Some(self.binding(binding)),
            ast::Body::Dotimes(dotimes) => Some(self.dotimes(dotimes)),
            ast::Body::Label(labelled) => Some(self.label(labelled)),
            ast::Body::Between(between) => self.between(between),
            ast::Body::WithAgent(with) => self.with_agent(with),
        }
    }

    #[inline(never)]
    fn within(&mut self, within: &ast::Within) -> Body {
        let bounds = self.resolver().bounds(&within.bounds, Limits::Duration);
        Body::Within { bounds, body: self.bodies(&within.body), operator: within.operator }
    }

    #[inline(never)]
    fn wait(&mut self, wait: &ast::Wait) -> Body {
        let bounds = self.resolver().bounds(&wait.bounds, Limits::Wait);
        Body::Delay { bounds, span: wait.span }
    }

    #[inline(never)]
    fn binding(&mut self, binding: &ast::Let) -> Body {
        let values = binding.bindings.iter().map(|(_, value)| self.argument(value)).collect();
        let names = binding.bindings.iter().map(|(name, _)| name);
        Body::Let { values, body: self.inside(names, &binding.body) }
    }

    #[inline(never)]
    fn label(&mut self, labelled: &ast::Labelled) -> Body {
        Body::Label {
            name: labelled.name.clone(),
            arguments: labelled.arguments.iter().map(|value| self.argument(value)).collect(),
            body: self.bodies(&labelled.body),
            operator: labelled.operator,
        }
    }

    #[inline(never)]
    fn with_agent(&mut self, with: &ast::WithAgent) -> Option<Body> {
        let agent = self.resolver().agent(&with.agent);
        let body = self.bodies(&with.body);
        Some(Body::WithAgent { agent: agent?, body })
    }

    #[inline(never)]
    fn group(&mut self, group: &ast::Group, parallel: bool) -> Body {
        let body = self.bodies(&group.body);
        Body::Group { parallel, slack: group.slack, body, operator: group.operator }
    }

    /// A body in which more variables are known.
    fn inside<'n>(&mut self, names: impl IntoIterator<Item = &'n Ident>, body: &[ast::Body]) -> Vec<Body> {
        let outside = self.scope.len();
        names.into_iter().for_each(|name| self.variable(SymbolKind::Variable, name));
        let body = self.bodies(body);
        self.scope.truncate(outside);
        body
    }

    /// One more variable is known from here on.
    pub(super) fn variable(&mut self, kind: SymbolKind, name: &Ident) {
        let symbol = self.uses.define(kind, name);
        self.scope.push(Variable { name: name.name.clone(), symbol });
    }

    /// `let*`: one variable after the other, each known to the next.
    #[inline(never)]
    fn binding_one_by_one(&mut self, binding: &ast::Let) -> Body {
        let before = self.scope.len();
        let mut values = Vec::new();
        for (name, value) in &binding.bindings {
            values.push(self.argument(value));
            self.variable(SymbolKind::Variable, name);
        }
        let mut body = self.bodies(&binding.body);
        self.scope.truncate(before);
        let first = (!values.is_empty()).then(|| values.remove(0));
        while let Some(value) = values.pop() {
            body = vec![Body::Let { values: vec![value], body }];
        }
        Body::Let { values: first.into_iter().collect(), body }
    }

    #[inline(never)]
    fn dotimes(&mut self, dotimes: &ast::Dotimes) -> Body {
        let mut count = self.resolver().amount(&dotimes.count);
        if let ExpressionKind::Value(_) = count.kind
            && let Err(problem) = evaluate::count(&count, &[])
        {
            self.resolver().report(problem);
            count.kind = ExpressionKind::Error;
        }
        let body = self.inside([&dotimes.variable], &dotimes.body);
        Body::Repeat { count, variable: dotimes.variable.span, body, operator: dotimes.operator }
    }

    #[inline(never)]
    fn between(&mut self, between: &ast::Between) -> Option<Body> {
        let bounds = self.resolver().signed_bounds(&between.bounds, Limits::Duration);
        let from = self.event(&between.from);
        let to = self.event(&between.to);
        Some(Body::Between(Box::new(Between { from: from?, to: to?, bounds })))
    }

    fn event(&mut self, event: &ast::EventOf) -> Option<EventOf> {
        let arguments: Option<Vec<Expression>> =
            event.arguments.as_ref().map(|values| values.iter().map(|value| self.argument(value)).collect());
        let home = &self.definition.home;
        let of = occurs(&event.name);
        let exactly = self.names.program(&event.name, home);
        let program = exactly.or_else(|| self.names.program(of.as_ref()?, home));
        let is_occurrence = exactly.is_none() && program.is_some();
        match (self.uses.label(&event.name), program) {
            (Some(label), _) => self.uses.place(label, event.name.span),
            (None, Some(program)) => {
                let name = of.filter(|_| is_occurrence).unwrap_or_else(|| event.name.clone());
                self.uses.global(SymbolKind::Program(program), name.span);
            }
            (None, None) => {
                if !self.problems.has_lost(&event.name.name) {
                    self.unknown_event(&event.name);
                }
                return None;
            }
        }
        let name = event.name.clone();
        Some(EventOf { end: event.end, name, program, is_occurrence, arguments, span: event.span })
    }

    fn unknown_event(&mut self, name: &Ident) {
        let labels = self.uses.labels().map(|label| label.name.as_str());
        let programs = self.program.programs.iter().map(|program| program.name.name.as_str());
        let numbered = name.name.split_once('#').map(|(program, _)| program);
        let occurrence_of = numbered.filter(|program| programs.clone().any(|name| name == *program));
        let near = nearest(&name.name, labels.chain(programs)).map(str::to_string);
        let occurrence_of = occurrence_of.map(str::to_string);
        self.problems.push(Problem::UnknownEvent { name: name.clone(), occurrence_of, near });
    }

    #[inline(never)]
    fn call(&mut self, call: &ast::Call) -> Option<Body> {
        let home = &self.definition.home;
        let Some(program) = self.names.program(&call.program, home) else {
            let look = |it: &mut Self| call.arguments.iter().for_each(|value| drop(it.argument(value)));
            // What follows a word of another language is not its arguments.
            match instead_of_operator(&call.program.name) {
                Some(_) => self.quietly(look),
                None => look(self),
            }
            if self.problems.has_lost(&call.program.name) {
                return None;
            }
            let create = Missing { parameters: call.arguments.len(), after: self.definition.span };
            self.problems.push(match self.problems.wants(call.program.span.source) {
                true => self.names.unknown_program(call, home, create),
                false => Problem::UnknownProgram {
                    name: call.program.clone(),
                    elsewhere: None,
                    near: None,
                    create,
                },
            });
            return None;
        };
        self.uses.global(SymbolKind::Program(program), call.program.span);
        let target = &self.program.programs[program];
        let (wanted, given) = (target.parameters.len(), call.arguments.len());
        let unread =
            |argument: &ast::Argument| matches!(argument, ast::Argument::Amount(it) if it.kind.is_error());
        if wanted != given && !target.damaged && !call.arguments.iter().any(unread) {
            self.problems.push(Problem::WrongArguments {
                call: call.span,
                given,
                program: target.name.clone(),
                parameters: target.parameters.clone(),
            });
        }
        let arguments = call.arguments.iter().map(|value| self.argument(value)).collect();
        Some(Body::Call { program, arguments, span: call.span })
    }

    fn argument(&mut self, written: &ast::Argument) -> Expression {
        self.resolver().argument(written)
    }
}

/// The program that `a#2` is an occurrence of: `a`. The first one has no number.
pub(super) fn occurs(ident: &Ident) -> Option<Ident> {
    let (program, number) = ident.name.rsplit_once('#')?;
    let is_number = number.bytes().all(|b| b.is_ascii_digit()) && !number.starts_with('0');
    if !is_number || matches!(number, "" | "1") {
        return None;
    }
    // All of it is written as it is read, so what is cut off is as long in the text.
    let end = ident.span.end.checked_sub(u32::try_from(number.len() + 1).ok()?)?;
    let span = Span { end, ..ident.span };
    Some(Ident { package: ident.package.clone(), name: program.to_string(), span })
}
