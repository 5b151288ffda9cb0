//! Which definition a name means, across packages.

use std::collections::BTreeMap;

use crate::ast::{Ident, Program};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::nearest::nearest;
use crate::parse::{DEFAULT_PACKAGE, OPERATORS};
use crate::problem::Problems;
use crate::source::Span;

type Table = BTreeMap<(String, String), usize>;

/// All names of a program.
pub(crate) struct Names {
    packages: Vec<String>,
    /// What each package sees besides its own names, in order.
    uses: BTreeMap<String, Vec<String>>,
    imports: BTreeMap<(String, String), String>,
    programs: Table,
    numbers: Table,
    classes: Table,
}

impl Names {
    /// Collects all definitions and reports those that are there twice.
    pub(super) fn new(program: &Program, problems: &mut Problems) -> Names {
        let mut names = Names {
            packages: Vec::new(),
            uses: BTreeMap::new(),
            imports: BTreeMap::new(),
            programs: Table::new(),
            numbers: Table::new(),
            classes: Table::new(),
        };
        let mut firsts: BTreeMap<&str, Span> = BTreeMap::new();
        for package in &program.packages {
            let name = &package.name.name;
            match firsts.get(name.as_str()) {
                Some(first) => problems.push(defined_twice("package", &package.name, *first)),
                None => {
                    firsts.insert(name, package.name.span);
                    names.packages.push(name.clone());
                }
            }
        }
        for package in &program.packages {
            let home = &package.name.name;
            for used in &package.uses {
                if names.check_package(&used.name, used.span, problems) {
                    names.uses.entry(home.clone()).or_default().push(used.name.clone());
                }
            }
            for import in &package.imports {
                if let Some(from) = &import.package
                    && names.check_package(from, import.span, problems)
                {
                    names.imports.insert((home.clone(), import.name.clone()), from.clone());
                }
            }
        }
        let programs = program.programs.iter().map(|p| (&p.home, &p.name));
        fill(&mut names.programs, programs, "program", problems);
        let numbers = program.parameters.iter().map(|p| (&p.home, &p.name));
        fill(&mut names.numbers, numbers, "named number", problems);
        fill(&mut names.classes, program.classes.iter().map(|c| (&c.home, &c.name)), "class", problems);
        names
    }

    /// The packages defined, in source order.
    pub(super) fn packages(&self) -> Vec<&str> {
        self.packages.iter().map(String::as_str).collect()
    }

    pub(super) fn program(&self, ident: &Ident, home: &str) -> Option<usize> {
        self.find(&self.programs, ident, home)
    }

    pub(super) fn number(&self, ident: &Ident, home: &str) -> Option<usize> {
        self.find(&self.numbers, ident, home)
    }

    pub(super) fn class(&self, ident: &Ident, home: &str) -> Option<usize> {
        self.find(&self.classes, ident, home)
    }

    /// Says that a call means nothing, and what it may have meant.
    pub(super) fn unknown_program(&self, ident: &Ident, home: &str) -> Diagnostic {
        let name = clip(&ident.name);
        if let Some(package) = &ident.package
            && !self.packages.contains(package)
        {
            let near = nearest(package, self.packages()).map(|near| format!("Did you mean `{near}:{name}`?"));
            return Diagnostic::error(
                Code::UnknownPackage,
                ident.span,
                format!("there is no package `{}`", clip(package)),
            )
            .primary("not a package of this source")
            .maybe_help(near);
        }
        let from = ident.package.as_deref().unwrap_or(home);
        let visible = self.programs.keys().filter(|(package, _)| package == from || self.sees(from, package));
        let near = nearest(&ident.name, visible.map(|(_, name)| name.as_str()).chain(OPERATORS));
        if let Some(near) = near.filter(|near| OPERATORS.contains(near)) {
            return Diagnostic::error(
                Code::UnknownOperator,
                ident.span,
                format!("there is no operator `{name}`"),
            )
            .primary("neither an operator nor a program")
            .help(format!("Did you mean `{near}`?"));
        }
        let elsewhere = self.programs.keys().find(|(_, program)| *program == ident.name);
        let help = match (elsewhere, near) {
            (Some((package, _)), _) => format!("The package `{package}` has one: write `{package}:{name}`."),
            (None, Some(near)) => format!("Did you mean `{near}`?"),
            (None, None) => format!(
                "Define it: `(define-control-program {name} () (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))`."
            ),
        };
        Diagnostic::error(Code::UnknownProgram, ident.span, format!("the program `{name}` is not defined"))
            .primary("called here")
            .help(help)
    }

    fn find(&self, table: &Table, ident: &Ident, home: &str) -> Option<usize> {
        let get = |package: &str| table.get(&(package.to_string(), ident.name.clone())).copied();
        if let Some(package) = &ident.package {
            return get(package);
        }
        let imported = self.imports.get(&(home.to_string(), ident.name.clone()));
        let used = self.uses.get(home).into_iter().flatten();
        get(home).or_else(|| imported.and_then(|p| get(p))).or_else(|| used.into_iter().find_map(|p| get(p)))
    }

    fn sees(&self, home: &str, package: &str) -> bool {
        self.uses.get(home).is_some_and(|uses| uses.iter().any(|used| used == package))
    }

    /// True if the package is one of the source; reports those that are neither that nor part of Lisp and RMPL.
    fn check_package(&self, name: &str, span: Span, problems: &mut Problems) -> bool {
        let builtin =
            matches!(name, "cl" | "common-lisp" | "rmpl" | DEFAULT_PACKAGE) || name.starts_with("rmpl/");
        if self.packages.iter().any(|known| known == name) {
            return true;
        }
        if !builtin {
            let near = nearest(name, self.packages()).map(|near| format!("Did you mean `{near}`?"));
            problems.push(
                Diagnostic::error(
                    Code::UnknownPackage,
                    span,
                    format!("the package `{}` is not defined", clip(name)),
                )
                .primary("not a package of this source")
                .maybe_help(near),
            );
        }
        false
    }
}

fn fill<'a>(
    table: &mut Table,
    definitions: impl Iterator<Item = (&'a String, &'a Ident)>,
    what: &str,
    problems: &mut Problems,
) {
    let mut firsts: BTreeMap<(&str, &str), Span> = BTreeMap::new();

    for (index, (home, name)) in definitions.enumerate() {
        let key = (home.as_str(), name.name.as_str());
        match firsts.get(&key) {
            Some(first) => {
                problems.push(defined_twice(what, name, *first));
            }
            None => {
                firsts.insert(key, name.span);
                table.insert((home.clone(), name.name.clone()), index);
            }
        }
    }
}

fn defined_twice(what: &str, name: &Ident, first: Span) -> Diagnostic {
    Diagnostic::error(
        Code::DefinedTwice,
        name.span,
        format!("the {what} `{}` is defined twice", clip(&name.name)),
    )
    .primary("again here")
    .label(first, "first defined here")
    .help("Rename one of them, or take one out.")
}
