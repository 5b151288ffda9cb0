//! Definitions by another name, names in another dress, a parameter list that is forgotten.

use std::collections::BTreeSet;

use super::elsewhere::instead_of_definition;
use super::{expected, head, one_of, unexpected};
use crate::ast::Ident;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::parse::ident;
use crate::problem::Problems;
use crate::source::Span;
use crate::words::{DEFINITIONS, Position, usage};

const SHAPE: &str = usage("define-control-program");

/// Reports a top-level form that is no definition. A slip in its first word says enough to go on with what was meant.
pub(in crate::parse) fn misspelt<'a>(
    form: &'a Form,
    defined: &BTreeSet<String>,
    problems: &mut Problems,
) -> Option<(&'a str, &'a [Form])> {
    if !form.is_error() {
        problems.push(unknown(form, defined));
    }
    problems.lose(form);
    let (word, rest) = form.call()?;
    nearest(word, DEFINITIONS).filter(|_| !rest.is_empty()).map(|meant| (meant, rest))
}

fn unknown(form: &Form, defined: &BTreeSet<String>) -> Diagnostic {
    // Of a name with a package, such as `asdf:defsystem`, only the name counts.
    let symbol = form.list().and_then(|items| items.first()).and_then(Form::symbol);
    let word = symbol.map_or("", |symbol| symbol.name.as_str());
    let problem = |message: String| {
        Diagnostic::error(Code::UnknownTopLevel, head(form), message)
            .primary("a definition was expected here")
            .help(format!("Kirk knows {}.", one_of(DEFINITIONS)))
    };
    let outside = || problem(format!("`{}` stands outside of every program", clip(word)));
    if Position::Body.has(word) || defined.contains(word) {
        outside().help(
            "It belongs into the body of a `define-control-program`: is there a `)` too many before it?",
        )
    } else if Position::Declaration.has(word) || word == "declare" {
        outside().help("It belongs into a `(declare ...)` of a program: is there a `)` too many before it?")
    } else if word.is_empty() {
        problem(format!("{} is not a definition", form.describe()))
    } else {
        let problem = problem(format!("`{}` is not a definition kirk knows", clip(word)));
        match instead_of_definition(word) {
            Some(instead) => instead.told(problem, form),
            None => problem.meant(head(form), nearest(word, DEFINITIONS)),
        }
    }
}

/// Reports a definition with nothing in it.
pub(in crate::parse) fn no_name(form: &Form, problems: &mut Problems) {
    problems.push(expected(form, "this program has no name", SHAPE));
    problems.lose_definitions();
}

/// Reports what is no plain name. In another dress, it is as clear what the name is; the parameters may be with it.
pub(in crate::parse) fn dressed_name<'a>(
    form: &Form,
    name: &'a Form,
    listed: bool,
    problems: &mut Problems,
) -> Option<(Ident, Option<&'a [Form]>)> {
    // `(define-control-program (drive site) ...)`: the parameters are with the name.
    let heading = name.list().filter(|items| items.first().is_some_and(|first| first.symbol().is_some()));
    let plain = match (&name.kind, heading) {
        (FormKind::Quote(inner), _) => ident(inner).map(|plain| Ident { span: name.span, ..plain }),
        (FormKind::String(text), _) if !text.is_empty() && !text.contains(char::is_whitespace) => {
            Some(Ident { package: None, name: text.to_lowercase(), span: name.span })
        }
        (_, Some(items)) => ident(&items[0]),
        _ => None,
    };
    let Some(plain) = plain else {
        if !name.is_error() {
            problems.push(unexpected(name, "the name of the program", SHAPE));
        }
        problems.lose_definitions();
        return None;
    };
    if form.call().is_some_and(|(word, _)| word == "define-control-program") {
        problems.push(dressed(name, heading, &plain, listed));
        // Or the name is missing, and these are the parameters.
        if heading.is_some() {
            problems.lose_definitions();
            problems.lose(name);
        }
    }
    let inside = heading.map(|items| &items[1..]).filter(|inside| !inside.is_empty() || !listed);
    Some((plain, inside))
}

fn dressed(name: &Form, heading: Option<&[Form]>, plain: &Ident, listed: bool) -> Diagnostic {
    let parameters = heading.map_or("()".to_string(), |items| {
        write(&Form { span: name.span, kind: FormKind::List(items[1..].to_vec()) })
    });
    let help = format!("Write `(define-control-program {} {} ...)`.", clip(&plain.name), clip(&parameters));
    let problem = unexpected(name, "the plain name of the program", &help);
    let edits = match (heading, listed) {
        (Some([_, _, ..]), true) => return problem,
        // `(drive site)` to `drive (site)`.
        (Some([first, second, ..]), false) => vec![
            Edit::replace(Span { end: first.span.start, ..name.span }, ""),
            Edit::replace(Span { start: first.span.end, end: second.span.start, ..name.span }, " ("),
        ],
        (_, true) => vec![Edit::replace(name.span, &plain.name)],
        (_, false) => vec![Edit::replace(name.span, format!("{} ()", plain.name))],
    };
    problem.suggest("Write the plain name", edits)
}

/// A program without a list of parameters.
pub(in crate::parse) fn no_parameters(name: &Ident) -> Diagnostic {
    let message = format!("the program `{}` has no parameter list", clip(&name.name));
    Diagnostic::error(Code::WrongShape, name.span, message)
        .primary("`()` was expected after this name")
        .help(SHAPE)
        .suggest("Add `()`", [Edit::after(name.span, " ()")])
}

/// True if a list where the parameters belong is a declaration or a body form: the parameter list was forgotten.
pub(in crate::parse) fn is_body(items: &[Form], rest: &[Form], defined: &BTreeSet<String>) -> bool {
    match items.first().and_then(Form::word) {
        Some("declare") => true,
        Some(word) => {
            let is_form = Position::Body.has(word) || defined.contains(word);
            rest.is_empty() && (is_form || items.iter().any(|item| item.list().is_some()))
        }
        None => false,
    }
}

/// True for a `declare` that is misspelt, if what is in it leaves no doubt; it is reported.
pub(in crate::parse) fn is_declare(item: &Form, problems: &mut Problems) -> bool {
    let Some((word, rest)) = item.call() else { return false };
    let inside = rest.first().and_then(Form::call).map(|(word, _)| word);
    let meant =
        nearest(word, ["declare"]).is_some() && inside.is_some_and(|word| Position::Declaration.has(word));
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
