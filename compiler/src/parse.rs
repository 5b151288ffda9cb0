//! Forms to the program as written. Looks at the shape of each form alone; names are resolved afterwards.

mod amount;
mod binding;
mod body;
mod class;
mod condition;
mod declaration;
mod label;
mod options;

pub(crate) use body::OPERATORS;

use crate::ast::{ControlProgram, Ident, NamedNumber, Package, Program};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::{did_you_mean, nearest};
use crate::problem::Problems;
use crate::read::foreign::DEFINITIONS;
use crate::source::Span;
use declaration::DECLARATIONS;

/// The package of definitions that no `in-package` comes before.
pub const DEFAULT_PACKAGE: &str = "cl-user";

/// Parses the top-level forms of one source and adds what they define to `program`.
pub fn parse(forms: &[Form], program: &mut Program, problems: &mut Problems) {
    let mut home = DEFAULT_PACKAGE.to_string();
    for form in forms {
        let Some((word, rest)) = form.call() else {
            if !form.is_error() {
                unknown_top_level(form, problems);
            }
            problems.lose(form);
            continue;
        };
        let mut word = word;
        if !DEFINITIONS.contains(&word) {
            unknown_top_level(form, problems);
            problems.lose(form);
            // A slip in the operator says enough to go on with what was meant.
            match nearest(word, DEFINITIONS).filter(|_| !rest.is_empty()) {
                Some(meant) => word = meant,
                None => continue,
            }
        }
        let before = problems.errors();
        match word {
            "define-control-program" => program.programs.extend(control_program(form, rest, &home, problems)),
            "defclass" => program.classes.extend(class::class(form, rest, &home, problems)),
            "defparameter" | "defconstant" => {
                program.parameters.extend(named_number(form, rest, &home, problems));
            }
            "defpackage" => program.packages.extend(package(form, rest, problems)),
            "in-package" => match rest {
                [name] if name.designator().is_some() => {
                    home = name.designator().unwrap_or_default();
                    let known = program.packages.iter().map(|package| package.name.name.as_str());
                    let known: Vec<&str> = known.chain([DEFAULT_PACKAGE]).collect();
                    if !known.contains(&home.as_str()) {
                        problems.push(
                            Diagnostic::error(
                                Code::UnknownPackage,
                                name.span,
                                format!("the package `{}` is not defined", clip(&home)),
                            )
                            .primary("not defined above")
                            .maybe_help(Some(
                                nearest(&home, known.iter().copied().filter(|name| *name != DEFAULT_PACKAGE))
                                    .map_or_else(
                                        || format!("Put `(defpackage #:{})` before it.", clip(&home)),
                                        |name| format!("Did you mean `{name}`?"),
                                    ),
                            )),
                        );
                    }
                }
                _ => problems.push(expected(
                    form,
                    "`in-package` needs one package",
                    "Write `(in-package #:name)`.",
                )),
            },
            _ => {}
        }
        let is_class = word == "defclass";
        if problems.is_damaged(form.span) || is_class && problems.errors() > before {
            problems.lose(form);
        }
    }
}

fn control_program(
    form: &Form,
    rest: &[Form],
    home: &str,
    problems: &mut Problems,
) -> Option<ControlProgram> {
    const SHAPE: &str = "A program is `(define-control-program name (parameter...) (declare ...) body...)`.";
    let Some((name, rest)) = rest.split_first() else {
        problems.push(expected(form, "this program has no name", SHAPE));
        problems.lose_definitions();
        return None;
    };
    let Some(name) = ident(name) else {
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
    let rest = match rest.split_first() {
        Some((Form { kind: FormKind::List(items), .. }, rest)) if !is_body(rest, items) => {
            program.parameters = parameters(items, problems);
            rest
        }
        Some((nil, rest)) if nil.word() == Some("nil") => rest,
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
    for (index, item) in rest.iter().enumerate() {
        match &item.kind {
            FormKind::String(text)
                if program.documentation.is_none() && program.body.is_empty() && index < 2 =>
            {
                program.documentation = Some(text.clone());
            }
            FormKind::List(_) if is_declaration(item, problems) => {
                declaration::declare(item, &mut program, problems);
            }
            _ => {
                let before = program.body.len();
                program.body.extend(body::body(item, problems));
                program.damaged |= program.body.len() == before;
            }
        }
    }
    Some(program)
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
        let at = item.list().and_then(|items| items.first()).map_or(item.span, |first| first.span);
        let message = format!("there is no operator `{}`", clip(word));
        problems.push(
            Diagnostic::error(Code::UnknownOperator, at, message)
                .primary("neither an operator nor a program")
                .help("Did you mean `declare`?"),
        );
    }
    meant
}

/// True if a list where the parameters belong is a declaration or a body form: the parameter list was forgotten.
fn is_body(rest: &[Form], items: &[Form]) -> bool {
    let word = items.first().and_then(Form::word);
    match word {
        Some("declare") => true,
        Some(word) => {
            rest.is_empty() && (OPERATORS.contains(&word) || items.iter().any(|item| item.list().is_some()))
        }
        None => false,
    }
}

fn parameters(items: &[Form], problems: &mut Problems) -> Vec<Ident> {
    let mut names: Vec<Ident> = Vec::new();
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
            Some(name) => {
                if let Some(first) = names.iter().find(|known| known.name == name.name) {
                    let message = format!("the parameter `{}` is there twice", clip(&name.name));
                    problems.push(
                        Diagnostic::error(Code::DefinedTwice, item.span, message)
                            .primary("again here")
                            .label(first.span, "first here"),
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

fn package(form: &Form, rest: &[Form], problems: &mut Problems) -> Option<Package> {
    const OPTIONS: [&str; 8] =
        ["use", "import-from", "export", "nicknames", "documentation", "shadow", "size", "local-nicknames"];
    let Some((name, rest)) = rest.split_first() else {
        problems.push(expected(form, "this package has no name", "Write `(defpackage #:name)`."));
        return None;
    };
    let Some(text) = name.designator() else {
        if !name.is_error() {
            problems.push(unexpected(name, "the name of the package", "Write `(defpackage #:name)`."));
        }
        return None;
    };
    let name = Ident { package: None, name: text, span: name.span };
    let mut package = Package { name, uses: Vec::new(), imports: Vec::new() };
    let designated = |item: &Form| Some(Ident { package: None, name: item.designator()?, span: item.span });
    for option in rest {
        let Some((keyword, values)) = option.list().and_then(|items| items.split_first()) else {
            if !option.is_error() {
                problems.push(unexpected(option, "an option such as `(:use #:other)`", "Options are lists."));
            }
            continue;
        };
        match keyword.keyword() {
            Some("use") => package.uses.extend(values.iter().filter_map(designated)),
            Some("import-from") => {
                let from = values.first().and_then(Form::designator);
                package.imports.extend(
                    values
                        .iter()
                        .skip(1)
                        .filter_map(designated)
                        .map(|name| Ident { package: from.clone(), ..name }),
                );
            }
            Some(word) if OPTIONS.contains(&word) => {}
            Some(word) => problems.push(
                Diagnostic::error(
                    Code::UnknownKeyword,
                    keyword.span,
                    format!("a package has no option `:{}`", clip(word)),
                )
                .primary("not an option of `defpackage`")
                .maybe_help(
                    did_you_mean(word, OPTIONS).map(|help| help.replace('`', "`:").replace("`:?", "`?")),
                ),
            ),
            None => problems.push(unexpected(keyword, "a keyword such as `:use`", "Options are lists.")),
        }
    }
    Some(package)
}

fn unknown_top_level(form: &Form, problems: &mut Problems) {
    let word = form.call().map_or("", |(word, _)| word);
    let (message, help) = if OPERATORS.contains(&word) {
        (
            format!("`{word}` stands outside of every program"),
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
        (format!("`{}` is not a definition kirk knows", clip(word)), did_you_mean(word, DEFINITIONS))
    };
    let at = form.list().and_then(|items| items.first()).map_or(form.span, |first| first.span);
    problems.push(
        Diagnostic::error(Code::UnknownTopLevel, at, message)
            .primary("a definition was expected here")
            .help(format!("Kirk knows {}.", one_of(&DEFINITIONS)))
            .maybe_help(help),
    );
}

/// A name without a package, or with one.
fn ident(form: &Form) -> Option<Ident> {
    let symbol = form.symbol()?;
    Some(Ident { package: symbol.package.clone(), name: symbol.name.clone(), span: form.span })
}

/// Something is missing in a form.
fn expected(form: &Form, message: &str, help: &str) -> Diagnostic {
    let at = form.list().and_then(|items| items.first()).map_or(form.span, |first| first.span);
    Diagnostic::error(Code::WrongShape, at, message).primary("in this form").help(help)
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
