//! What is said about definitions.

use super::{described, one_of, unexpected, wrong};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::parse::Cure;
use crate::parse::problem::DefinitionSlip;
use crate::source::Span;
use crate::words::{DEFINITIONS, usage};

pub(super) const SHAPE: &str = usage("define-control-program");

pub(super) fn told(slip: DefinitionSlip) -> Diagnostic {
    match slip {
        DefinitionSlip::BodyOutside { at, word } => outside(at, word).help(
            "It belongs into the body of a `define-control-program`: is there a `)` too many before it?",
        ),
        DefinitionSlip::DeclarationOutside { at, word } => outside(at, word)
            .help("It belongs into a `(declare ...)` of a program: is there a `)` too many before it?"),
        DefinitionSlip::No { found } => {
            no_definition(found.head(), format!("{} is not a definition", described(found)))
        }
        DefinitionSlip::Unknown { form, word, near } => unknown(form, word).meant(form.head(), near),
        DefinitionSlip::Foreign { form, word, instead } => {
            let problem = unknown(form, word).help(instead.help());
            match instead.cure() {
                Cure::Write(text) => problem.change(form.head(), text),
                Cure::TakeOut => problem.suggest("Take it out", [Edit::replace(form.span, "")]),
                Cure::Unknown => problem,
            }
        }
        DefinitionSlip::DressedName { found, plain, heading, listed } => {
            dressed_name(found, plain, heading, listed)
        }
        DefinitionSlip::NoParameters { name } => {
            let message = format!("the program `{}` has no parameter list", clip(&name.name));
            wrong(name.span, message, "`()` was expected after this name", SHAPE)
                .suggest("Add `()`", [Edit::after(name.span, " ()")])
        }
    }
}

fn outside(at: Span, word: &str) -> Diagnostic {
    no_definition(at, format!("`{}` stands outside of every program", clip(word)))
}

fn unknown(form: &Form, word: &str) -> Diagnostic {
    no_definition(form.head(), format!("`{}` is not a definition kirk knows", clip(word)))
}

fn no_definition(at: Span, message: String) -> Diagnostic {
    Diagnostic::error(Code::UnknownTopLevel, at, message)
        .primary("a definition was expected here")
        .help(format!("Kirk knows {}.", one_of(DEFINITIONS)))
}

fn dressed_name(found: &Form, plain: &str, heading: Option<&[Form]>, listed: bool) -> Diagnostic {
    let parameters = heading.map_or("()".to_string(), |items| {
        write(&Form { span: found.span, kind: FormKind::List(items[1..].to_vec()) })
    });
    let help = format!("Write `(define-control-program {} {} ...)`.", clip(plain), clip(&parameters));
    let problem = unexpected(found, "the plain name of the program", &help);
    let edits = match (heading, listed) {
        (Some([_, _, ..]), true) => return problem,
        // `(drive site)` to `drive (site)`.
        (Some([first, second, ..]), false) => vec![
            Edit::replace(Span { end: first.span.start, ..found.span }, ""),
            Edit::replace(Span { start: first.span.end, end: second.span.start, ..found.span }, " ("),
        ],
        (_, true) => vec![Edit::replace(found.span, plain)],
        (_, false) => vec![Edit::replace(found.span, format!("{plain} ()"))],
    };
    problem.suggest("Write the plain name", edits)
}
