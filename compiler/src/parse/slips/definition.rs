//! Definitions by another name, names in another dress, a parameter list that is forgotten.

use std::collections::BTreeSet;

use super::elsewhere::instead_of_definition;
use crate::ast::Ident;
use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::parse::ident;
use crate::parse::problem::{DefinitionSlip, Expected, Missing, Problem};
use crate::problem::Problems;
use crate::words::{DEFINITIONS, Position};

/// Reports a top-level form that is no definition. A slip in its first word says enough to go on with what was meant.
pub(in crate::parse) fn misspelt<'a>(
    form: &'a Form,
    defined: &BTreeSet<String>,
    problems: &mut Problems,
) -> Option<(&'a str, &'a [Form])> {
    if !form.is_error() {
        problems.push(Problem::Definition(unknown(form, defined)));
    }
    problems.lose(form);
    let (word, rest) = form.call()?;
    nearest(word, DEFINITIONS).filter(|_| !rest.is_empty()).map(|meant| (meant, rest))
}

fn unknown<'a>(form: &'a Form, defined: &BTreeSet<String>) -> DefinitionSlip<'a> {
    // Of a name with a package, such as `asdf:defsystem`, only the name counts.
    let symbol = form.list().and_then(|items| items.first()).and_then(Form::symbol);
    let word = symbol.map_or("", |symbol| symbol.name.as_str());
    let at = form.head();
    if Position::Body.has(word) || defined.contains(word) {
        DefinitionSlip::BodyOutside { at, word }
    } else if Position::Declaration.has(word) || word == "declare" {
        DefinitionSlip::DeclarationOutside { at, word }
    } else if word.is_empty() {
        DefinitionSlip::No { found: form }
    } else if let Some(instead) = instead_of_definition(word) {
        DefinitionSlip::Foreign { form, word, instead }
    } else {
        DefinitionSlip::Unknown { form, word, near: nearest(word, DEFINITIONS) }
    }
}

/// Reports a definition with nothing in it.
pub(in crate::parse) fn no_name(form: &Form, problems: &mut Problems) {
    problems.push(Problem::Missing { at: form.head(), what: Missing::ProgramName });
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
            problems.push(Problem::Unexpected { found: name, expected: Expected::ProgramName });
        }
        problems.lose_definitions();
        return None;
    };
    if form.call().is_some_and(|(word, _)| word == "define-control-program") {
        let slip = DefinitionSlip::DressedName { found: name, plain: &plain.name, heading, listed };
        problems.push(Problem::Definition(slip));
        // Or the name is missing, and these are the parameters.
        if heading.is_some() {
            problems.lose_definitions();
            problems.lose(name);
        }
    }
    let inside = heading.map(|items| &items[1..]).filter(|inside| !inside.is_empty() || !listed);
    Some((plain, inside))
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
    let near =
        nearest(word, ["declare"]).filter(|_| inside.is_some_and(|word| Position::Declaration.has(word)));
    if let Some(near) = near {
        problems.push(Problem::UnknownOperator { at: item.head(), word, near });
    }
    near.is_some()
}
