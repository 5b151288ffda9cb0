//! Forms to the program as written. Looks at the shape of each form alone; names are resolved afterwards.
//!
//! What has the right shape is matched first, here and in `parse/`; what has not goes to `slips`.

mod amount;
mod binding;
mod body;
pub(crate) mod class;
mod condition;
mod declaration;
mod label;
mod options;
pub(crate) mod package;
pub(crate) mod problem;
mod program;
mod slips;
mod team;

pub(crate) use slips::amount::suffixed;
pub(crate) use slips::elsewhere::{Cure, Instead, instead_of_operator};

use std::collections::BTreeSet;

use crate::ast::{Ident, NamedNumber, Program, Role};
use crate::form::{Form, FormKind};
use crate::problem::Problems;
use crate::words::DEFINITIONS;
use problem::{Expected, Missing, Problem};

/// The package of definitions that no `in-package` comes before.
pub(crate) const DEFAULT_PACKAGE: &str = "cl-user";

/// Parses the top-level forms of one source and adds what they define to `program`.
pub(crate) fn parse(forms: &[Form], program: &mut Program, problems: &mut Problems) {
    program::reserved_names(forms, problems);
    let mut home = DEFAULT_PACKAGE.to_string();
    let defined = defined(forms, program);
    for form in forms {
        let known = form.call().filter(|(word, _)| DEFINITIONS.contains(word));
        let meant = known.or_else(|| slips::definition::misspelt(form, &defined, problems));
        let Some((word, rest)) = meant else { continue };
        let before = problems.errors();
        match word {
            "define-control-program" => {
                program.programs.extend(program::control_program(form, rest, &home, &defined, problems));
            }
            "defclass" => program.classes.extend(class::class(form, rest, &home, problems)),
            "defparameter" | "defconstant" => {
                program.parameters.extend(named_number(form, rest, &home, problems));
            }
            "define-team" => program.teams.extend(team::team(form, rest, &home, problems)),
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

fn named_number(form: &Form, rest: &[Form], home: &str, problems: &mut Problems) -> Option<NamedNumber> {
    match rest {
        [name, value] | [name, value, Form { kind: FormKind::String(_), .. }] => match ident(name) {
            Some(name) => Some(NamedNumber {
                home: home.to_string(),
                name,
                value: amount::amount(value, Role::Named, problems),
            }),
            None => {
                problems.push(Problem::Unexpected { found: name, expected: Expected::NumberName });
                problems.lose(form);
                None
            }
        },
        _ => {
            problems.push(Problem::Missing { at: form.head(), what: Missing::NameAndNumber });
            problems.lose(form);
            None
        }
    }
}

/// A name without a package, or with one.
fn ident(form: &Form) -> Option<Ident> {
    let symbol = form.symbol()?;
    Some(Ident { package: symbol.package.clone(), name: symbol.name.clone(), span: form.span })
}
