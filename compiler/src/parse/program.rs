//! `(define-control-program name (parameter...) (declare ...) body...)`.

use std::collections::{BTreeMap, BTreeSet};

use super::body::bodies;
use super::problem::{DefinitionSlip, Expected, Named, Problem};
use super::{declaration, ident, slips};
use crate::ast::{ControlProgram, Ident};
use crate::form::{Form, FormKind};
use crate::problem::Problems;
use crate::source::Span;
use crate::words::Position;

/// Parses the definition of a program; `defined` are the names of all programs.
pub(super) fn control_program(
    form: &Form,
    rest: &[Form],
    home: &str,
    defined: &BTreeSet<String>,
    problems: &mut Problems,
) -> Option<ControlProgram> {
    let Some((name, rest)) = rest.split_first() else {
        slips::definition::no_name(form, problems);
        return None;
    };
    let listed = rest.split_first().filter(|(list, rest)| is_parameters(list, rest, defined));
    let (name, inside) = match ident(name) {
        Some(name) => (name, None),
        None => slips::definition::dressed_name(form, name, listed.is_some(), problems)?,
    };
    let mut program = ControlProgram {
        home: home.to_string(),
        name,
        parameters: Vec::new(),
        documentation: None,
        primitive: false,
        duration: None,
        agent: None,
        requires: None,
        effect: None,
        body: Vec::new(),
        span: form.span,
        damaged: problems.is_damaged(form.span),
    };
    let rest = match (inside, listed) {
        (Some(inside), _) => {
            program.parameters = parameters(inside, problems);
            rest
        }
        (None, Some((list, rest))) => {
            program.parameters = parameters(list.list().unwrap_or_default(), problems);
            rest
        }
        (None, None) => {
            problems.push(Problem::Definition(DefinitionSlip::NoParameters { name: &program.name }));
            program.damaged = true;
            rest
        }
    };
    content(rest, &mut program, problems);
    Some(program)
}

/// True for a list of parameters; where it is forgotten, a declaration or a body form stands in its place.
fn is_parameters(form: &Form, rest: &[Form], defined: &BTreeSet<String>) -> bool {
    match form.list() {
        Some(items) => !slips::definition::is_body(items, rest, defined),
        None => form.word() == Some("nil"),
    }
}

/// What stands after the parameters: documentation, declarations, the body.
fn content(items: &[Form], program: &mut ControlProgram, problems: &mut Problems) {
    let mut body: Vec<Form> = Vec::new();
    let mut rest = items;
    while let Some((item, after)) = rest.split_first() {
        rest = after;
        match &item.kind {
            FormKind::String(text)
                if program.documentation.is_none() && body.is_empty() && items.len() - after.len() < 3 =>
            {
                program.documentation = Some(text.clone());
            }
            FormKind::List(_) if is_declaration(item) || slips::definition::is_declare(item, problems) => {
                declaration::declare(&item.list().unwrap_or_default()[1..], program, problems);
            }
            FormKind::Keyword(_) if body.is_empty() && program.duration.is_some() => {
                rest = slips::declaration::fallen_out(item, rest, program, problems);
                program.damaged = true;
            }
            _ => body.push(item.clone()),
        }
    }
    if slips::declaration::are_bare(&body, program.duration.is_some()) {
        problems.push(slips::declaration::bare(&body));
        declaration::declare(&body, program, problems);
        return;
    }
    let before = problems.errors();
    program.body = bodies(&body, problems);
    program.damaged |= problems.errors() > before || program.body.len() < body.len();
}

/// True for `(declare ...)`.
fn is_declaration(item: &Form) -> bool {
    item.call().is_some_and(|(word, _)| word == "declare")
}

fn parameters(items: &[Form], problems: &mut Problems) -> Vec<Ident> {
    let mut names: Vec<Ident> = Vec::new();
    let mut firsts: BTreeMap<String, Span> = BTreeMap::new();
    for item in items {
        match ident(item) {
            Some(name) if name.name.starts_with('&') => {
                problems.push(Problem::ParameterMark { at: item.span, word: &name.name });
            }
            Some(name) if matches!(name.name.as_str(), "t" | "nil") => {
                problems.push(Problem::Reserved { what: Named::Parameter, name: &name.name, at: item.span });
                names.push(name);
            }
            Some(name) => {
                if let Some(first) = firsts.insert(name.name.clone(), item.span) {
                    let (what, again) = (Named::Parameter, item.span);
                    problems.push(Problem::Repeated { what, name: &name.name, first, again });
                }
                names.push(name);
            }
            None if item.is_error() => {}
            None => problems.push(Problem::Unexpected { found: item, expected: Expected::Parameter }),
        }
    }
    names
}

/// Refuses programs that have the names of operators: `(delay)` could never mean them.
pub(super) fn reserved_names(forms: &[Form], problems: &mut Problems) {
    let mut taken: Vec<&str> = Vec::new();
    for form in forms {
        let Some(("define-control-program", [name, ..])) = form.call() else { continue };
        let Some(word) = name.word().filter(|word| is_reserved(word)) else { continue };
        problems.push(Problem::Reserved { what: Named::Program, name: word, at: name.span });
        taken.push(word);
    }
    // What is wrong with the calls of such a program, read as the operator, follows from that.
    let mut open: Vec<&Form> = if taken.is_empty() { Vec::new() } else { forms.iter().collect() };
    while let Some(form) = open.pop() {
        match form.call() {
            Some((word, _)) if taken.contains(&word) => problems.mute(form.span),
            _ => open.extend(form.list().unwrap_or_default()),
        }
    }
}

fn is_reserved(word: &str) -> bool {
    Position::Body.has(word) || matches!(word, "declare" | "t" | "nil")
}
