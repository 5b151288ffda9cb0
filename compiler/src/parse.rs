//! Forms to the program as written. Looks at the shape of each form alone; names are resolved afterwards.

mod amount;
mod binding;
mod body;
mod class;
mod condition;
mod declaration;
mod elsewhere;
mod label;
mod options;
mod package;

pub(crate) use body::OPERATORS;
pub(crate) use elsewhere::instead_of_operator;

use std::collections::{BTreeMap, BTreeSet};

use crate::ast::{ControlProgram, Ident, NamedNumber, Program};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::read::foreign::DEFINITIONS;
use crate::source::Span;
use declaration::DECLARATIONS;

/// The package of definitions that no `in-package` comes before.
pub(crate) const DEFAULT_PACKAGE: &str = "cl-user";

/// Parses the top-level forms of one source and adds what they define to `program`.
pub(crate) fn parse(forms: &[Form], program: &mut Program, problems: &mut Problems) {
    reserved_names(forms, problems);
    let mut home = DEFAULT_PACKAGE.to_string();
    let defined = defined(forms, program);
    for form in forms {
        let Some((word, rest)) = form.call() else {
            if !form.is_error() {
                unknown_top_level(form, &defined, problems);
            }
            problems.lose(form);
            continue;
        };
        let mut word = word;
        if !DEFINITIONS.contains(&word) {
            unknown_top_level(form, &defined, problems);
            problems.lose(form);
            // A slip in the operator says enough to go on with what was meant.
            match nearest(word, DEFINITIONS).filter(|_| !rest.is_empty()) {
                Some(meant) => word = meant,
                None => continue,
            }
        }
        let before = problems.errors();
        match word {
            "define-control-program" => {
                program.programs.extend(control_program(form, rest, &home, &defined, problems));
            }
            "defclass" => program.classes.extend(class::class(form, rest, &home, problems)),
            "defparameter" | "defconstant" => {
                program.parameters.extend(named_number(form, rest, &home, problems));
            }
            "defpackage" => program.packages.extend(package::package(form, rest, problems)),
            "in-package" => {
                if let Some(entered) = package::entered(form, rest, &program.packages, problems) {
                    home = entered;
                }
            }
            _ => {}
        }
        let is_class = word == "defclass";
        if problems.is_damaged(form.span) || is_class && problems.errors() > before {
            problems.lose(form);
        }
    }
}

/// The names of the programs of earlier sources and of this one: where no definition fits, they are calls.
fn defined(forms: &[Form], program: &Program) -> BTreeSet<String> {
    let here = forms.iter().filter_map(|form| match form.call() {
        Some(("define-control-program", [name, ..])) => name.word().map(str::to_string),
        _ => None,
    });
    program.programs.iter().map(|program| program.name.name.clone()).chain(here).collect()
}

fn control_program(
    form: &Form,
    rest: &[Form],
    home: &str,
    defined: &BTreeSet<String>,
    problems: &mut Problems,
) -> Option<ControlProgram> {
    const SHAPE: &str = "A program is `(define-control-program name (parameter...) (declare ...) body...)`.";
    let Some((name, rest)) = rest.split_first() else {
        problems.push(expected(form, "this program has no name", SHAPE));
        problems.lose_definitions();
        return None;
    };
    // In another dress, it is as clear what the name is.
    let heading = name.list().filter(|items| items.first().is_some_and(|first| first.symbol().is_some()));
    let plain = match (&name.kind, heading) {
        (FormKind::Quote(inner), _) => ident(inner).map(|plain| Ident { span: name.span, ..plain }),
        (FormKind::String(text), _) if !text.is_empty() && !text.contains(char::is_whitespace) => {
            Some(Ident { package: None, name: text.to_lowercase(), span: name.span })
        }
        (_, Some(items)) => ident(&items[0]),
        _ => None,
    };
    if let Some(plain) = &plain
        && form.call().is_some_and(|(word, _)| word == "define-control-program")
    {
        let parameters = heading.map_or("()".to_string(), |items| {
            write(&Form { span: name.span, kind: FormKind::List(items[1..].to_vec()) })
        });
        let help =
            format!("Write `(define-control-program {} {} ...)`.", clip(&plain.name), clip(&parameters));
        problems.push(unexpected(name, "the plain name of the program", &help));
        // Or the name is missing, and these are the parameters.
        if heading.is_some() {
            problems.lose_definitions();
            problems.lose(name);
        }
    }
    let Some(name) = ident(name).or(plain) else {
        if !name.is_error() {
            problems.push(unexpected(name, "the name of the program", SHAPE));
        }
        problems.lose_definitions();
        return None;
    };
    let mut program = ControlProgram {
        home: home.to_string(),
        name,
        parameters: Vec::new(),
        documentation: None,
        primitive: false,
        duration: None,
        requires: None,
        effect: None,
        body: Vec::new(),
        span: form.span,
        damaged: problems.is_damaged(form.span),
    };
    // `(define-control-program (drive site) ...)`: the parameters are with the name.
    let listed = rest.first().and_then(Form::list).is_some_and(|items| !is_body(&rest[1..], items, defined));
    let inside = heading.map(|items| &items[1..]).filter(|inside| !inside.is_empty() || !listed);
    let rest = match (inside, rest.split_first()) {
        (Some(inside), _) => {
            program.parameters = parameters(inside, problems);
            rest
        }
        (_, Some((Form { kind: FormKind::List(items), .. }, rest))) if !is_body(rest, items, defined) => {
            program.parameters = parameters(items, problems);
            rest
        }
        (_, Some((nil, rest))) if nil.word() == Some("nil") => rest,
        _ => {
            let message = format!("the program `{}` has no parameter list", clip(&program.name.name));
            problems.push(
                Diagnostic::error(Code::WrongShape, program.name.span, message)
                    .primary("`()` was expected after this name")
                    .help(SHAPE),
            );
            program.damaged = true;
            rest
        }
    };
    content(rest, &mut program, problems);
    Some(program)
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
            FormKind::List(_) if is_declaration(item, problems) => {
                declaration::declare(&item.list().unwrap_or_default()[1..], program, problems);
            }
            FormKind::Keyword(_) if body.is_empty() && program.duration.is_some() => {
                let value = after.first().filter(|value| value.list().is_none());
                rest = &after[usize::from(value.is_some())..];
                declaration::fallen_out(item, value, program, problems);
                program.damaged = true;
            }
            _ => body.push(item.clone()),
        }
    }
    if declaration::are_bare(&body, program.duration.is_some()) {
        problems.push(expected(
            &body[0],
            "this declaration stands outside of `(declare ...)`",
            "Write `(declare (primitive) (duration (simple ...)))` after the parameter list.",
        ));
        declaration::declare(&body, program, problems);
        return;
    }
    let before = problems.errors();
    program.body = body::bodies(&body, problems);
    program.damaged |= problems.errors() > before || program.body.len() < body.len();
}

/// Refuses programs that have the names of operators: `(delay)` could never mean them.
fn reserved_names(forms: &[Form], problems: &mut Problems) {
    let mut taken: Vec<&str> = Vec::new();
    for form in forms {
        let Some(("define-control-program", [name, ..])) = form.call() else { continue };
        let Some(word) = name.word().filter(|word| is_reserved(word)) else { continue };
        problems.push(reserved(name, word, "a program"));
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
    OPERATORS.contains(&word) || matches!(word, "declare" | "t" | "nil")
}

fn reserved(name: &Form, word: &str, what: &str) -> Diagnostic {
    let meaning = match word {
        "t" => "`t` means yes",
        "nil" => "`nil` means no, or nothing",
        _ => "it is an operator",
    };
    Diagnostic::error(Code::ReservedName, name.span, format!("{what} cannot be called `{word}`"))
        .primary(meaning)
        .help(format!("Give it another name, such as `{word}-1`, here and wherever it is used."))
}

/// True for `(declare ...)`, also if it is misspelt and what is in it leaves no doubt.
fn is_declaration(item: &Form, problems: &mut Problems) -> bool {
    let Some((word, rest)) = item.call() else { return false };
    if word == "declare" {
        return true;
    }
    let inside = rest.first().and_then(Form::call).map(|(word, _)| word);
    let meant =
        nearest(word, ["declare"]).is_some() && inside.is_some_and(|word| DECLARATIONS.contains(&word));
    if meant {
        let message = format!("there is no operator `{}`", clip(word));
        problems.push(
            Diagnostic::error(Code::UnknownOperator, head(item), message)
                .primary("neither an operator nor a program")
                .meant(head(item), Some("declare")),
        );
    }
    meant
}

/// True if a list where the parameters belong is a declaration or a body form: the parameter list was forgotten.
fn is_body(rest: &[Form], items: &[Form], defined: &BTreeSet<String>) -> bool {
    let word = items.first().and_then(Form::word);
    match word {
        Some("declare") => true,
        Some(word) => {
            let is_form = OPERATORS.contains(&word) || defined.contains(word);
            rest.is_empty() && (is_form || items.iter().any(|item| item.list().is_some()))
        }
        None => false,
    }
}

fn parameters(items: &[Form], problems: &mut Problems) -> Vec<Ident> {
    let mut names: Vec<Ident> = Vec::new();
    let mut firsts: BTreeMap<String, Span> = BTreeMap::new();
    for item in items {
        match ident(item) {
            Some(name) if name.name.starts_with('&') => problems.push(
                Diagnostic::error(
                    Code::WrongShape,
                    item.span,
                    format!("`{}` is not understood here", clip(&name.name)),
                )
                .primary("a parameter was expected")
                .help("Every parameter of a control program is given by place; there are no optional ones."),
            ),
            Some(name) if matches!(name.name.as_str(), "t" | "nil") => {
                problems.push(reserved(item, &name.name, "a parameter"));
                names.push(name);
            }
            Some(name) => {
                if let Some(first) = firsts.insert(name.name.clone(), item.span) {
                    let message = format!("the parameter `{}` is there twice", clip(&name.name));
                    problems.push(
                        Diagnostic::error(Code::DefinedTwice, item.span, message)
                            .primary("again here")
                            .label(first, "first here"),
                    );
                }
                names.push(name);
            }
            None if item.is_error() => {}
            None => problems.push(unexpected(
                item,
                "the name of a parameter",
                "Parameters are names: `(glider to)`.",
            )),
        }
    }
    names
}

fn named_number(form: &Form, rest: &[Form], home: &str, problems: &mut Problems) -> Option<NamedNumber> {
    const SHAPE: &str = "A named number is `(defparameter *name* 15)`.";
    match rest {
        [name, value] | [name, value, Form { kind: FormKind::String(_), .. }] => match ident(name) {
            Some(name) => Some(NamedNumber {
                home: home.to_string(),
                name,
                value: amount::amount(value, "this value", problems),
            }),
            None => {
                problems.push(unexpected(name, "a name", SHAPE));
                problems.lose(form);
                None
            }
        },
        _ => {
            problems.push(expected(form, "a name and a number were expected", SHAPE));
            problems.lose(form);
            None
        }
    }
}

fn unknown_top_level(form: &Form, defined: &BTreeSet<String>, problems: &mut Problems) {
    // Of a name with a package, such as `asdf:defsystem`, only the name counts.
    let symbol = form.list().and_then(|items| items.first()).and_then(Form::symbol);
    let word = symbol.map_or("", |symbol| symbol.name.as_str());
    let mut near = None;
    let (message, help) = if OPERATORS.contains(&word) || defined.contains(word) {
        (
            format!("`{}` stands outside of every program", clip(word)),
            Some(
                "It belongs into the body of a `define-control-program`: is there a `)` too many before it?"
                    .to_string(),
            ),
        )
    } else if matches!(word, "duration" | "declare" | "primitive" | "requires" | "effect") {
        (
            format!("`{word}` stands outside of every program"),
            Some(
                "It belongs into a `(declare ...)` of a program: is there a `)` too many before it?"
                    .to_string(),
            ),
        )
    } else if word.is_empty() {
        (format!("{} is not a definition", form.describe()), None)
    } else {
        let instead = elsewhere::instead_of_definition(word).map(str::to_string);
        near = nearest(word, DEFINITIONS).filter(|_| instead.is_none());
        (format!("`{}` is not a definition kirk knows", clip(word)), instead)
    };
    let at = head(form);
    problems.push(
        Diagnostic::error(Code::UnknownTopLevel, at, message)
            .primary("a definition was expected here")
            .help(format!("Kirk knows {}.", one_of(&DEFINITIONS)))
            .maybe_help(help)
            .meant(at, near),
    );
}

/// A name without a package, or with one.
fn ident(form: &Form) -> Option<Ident> {
    let symbol = form.symbol()?;
    Some(Ident { package: symbol.package.clone(), name: symbol.name.clone(), span: form.span })
}

/// The place of the first element of a list, which says what the list is.
fn head(form: &Form) -> Span {
    form.list().and_then(|items| items.first()).map_or(form.span, |first| first.span)
}

/// Something is missing in a form.
fn expected(form: &Form, message: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, head(form), message).primary("in this form").help(help)
}

/// Something is not what belongs here.
fn unexpected(form: &Form, wanted: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, form.span, format!("{wanted} was expected, not {}", form.describe()))
        .primary("found this")
        .help(help)
}

/// A thing is said a second time.
fn twice(what: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(Code::KeywordTwice, again, format!("{what} is given twice"))
        .primary("again here")
        .label(first, "first here")
        .help("Keep one of them.")
}

/// `a`, `b` and `c`.
fn one_of(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// The form as a value that is only carried along.
fn text_of(form: &Form) -> String {
    clip(&write(form))
}
