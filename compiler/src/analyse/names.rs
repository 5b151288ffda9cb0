//! Which definition a name means, across packages.

use std::collections::{BTreeMap, BTreeSet};

use super::problem::{Defined, Missing, Problem};
use super::symbols::{SymbolKind, Uses};
use crate::ast::{Call, Ident, Import, Package, Program};
use crate::nearest::nearest;
use crate::parse::{DEFAULT_PACKAGE, Instead, instead_of_operator};
use crate::problem::Problems;
use crate::source::Span;
use crate::words::Position;

type Table = BTreeMap<(String, String), usize>;

/// All names of a program.
pub(crate) struct Names {
    packages: Vec<String>,
    /// The package each nickname means.
    nicknames: BTreeMap<String, String>,
    /// The package a nickname means inside of another package.
    local_nicknames: BTreeMap<(String, String), String>,
    /// What each package sees besides its own names, in order.
    uses: BTreeMap<String, Vec<String>>,
    imports: BTreeMap<(String, String), String>,
    programs: Table,
    numbers: Table,
    classes: Table,
    /// The slots of classes and their accessors.
    slots: BTreeSet<(String, String)>,
}

impl Names {
    /// Collects all definitions and reports those that are there twice.
    pub(super) fn new(program: &Program, uses: &mut Uses, problems: &mut Problems) -> Names {
        let mut names = Names {
            packages: Vec::new(),
            nicknames: BTreeMap::new(),
            local_nicknames: BTreeMap::new(),
            uses: BTreeMap::new(),
            imports: BTreeMap::new(),
            programs: Table::new(),
            numbers: Table::new(),
            classes: Table::new(),
            slots: BTreeSet::new(),
        };
        let mut firsts: BTreeMap<&str, Span> = BTreeMap::new();
        for package in &program.packages {
            let name = &package.name.name;
            match firsts.get(name.as_str()) {
                Some(first) => problems.push(defined_twice(Defined::Package, &package.name, *first)),
                None => {
                    firsts.insert(name, package.name.span);
                    names.packages.push(name.clone());
                }
            }
        }
        for package in &program.packages {
            for nickname in &package.nicknames {
                match firsts.get(nickname.name.as_str()) {
                    Some(first) if nickname.name != package.name.name => {
                        problems.push(defined_twice(Defined::Package, nickname, *first));
                    }
                    _ => {
                        firsts.insert(&nickname.name, nickname.span);
                        names.nicknames.insert(nickname.name.clone(), package.name.name.clone());
                    }
                }
            }
        }
        let programs = program.programs.iter().map(|p| (&p.home, &p.name));
        fill(&mut names.programs, programs, Defined::Program, problems);
        let numbers = program.parameters.iter().map(|p| (&p.home, &p.name));
        fill(&mut names.numbers, numbers, Defined::NamedNumber, problems);
        let classes = program.classes.iter().map(|c| (&c.home, &c.name));
        fill(&mut names.classes, classes, Defined::Class, problems);
        for class in &program.classes {
            let named = class.slots.iter().flat_map(|slot| slot.accessors.iter().chain([&slot.name]));
            names.slots.extend(named.map(|name| (class.home.clone(), name.name.clone())));
        }
        for package in &program.packages {
            names.open(package, uses, problems);
        }
        names
    }

    /// Takes in what a package sees of others.
    fn open(&mut self, package: &Package, uses: &mut Uses, problems: &mut Problems) {
        let home = &package.name.name;
        for (short, of) in &package.local_nicknames {
            if let Some(of) = self.check_package(home, of, uses, problems) {
                self.local_nicknames.insert((home.clone(), short.name.clone()), of);
            }
        }
        for used in &package.uses {
            if let Some(used) = self.check_package(home, used, uses, problems) {
                self.uses.entry(home.clone()).or_default().push(used);
            }
        }
        for import in &package.imports {
            let Import { from, name } = import;
            let Some(from) = self.check_package(home, from, uses, problems) else { continue };
            let wanted = problems.wants(name.span.source) && !problems.has_lost(&name.name);
            if !self.has(&from, name, uses) && wanted {
                problems.push(self.not_there(&from, name, true));
                // Where it is called, it is not missed again.
                problems.lose_text(&name.name);
            }
            self.imports.insert((home.clone(), name.name.clone()), from);
        }
        for export in &package.exports {
            let wanted = problems.wants(export.span.source) && !problems.has_lost(&export.name);
            if !self.has(home, export, uses) && wanted {
                problems.push(self.not_there(home, export, false));
            }
        }
    }

    /// True if the package has something of this name, or sees it, which is named here then.
    fn has(&self, package: &str, name: &Ident, uses: &mut Uses) -> bool {
        let program = self.program(name, package).map(SymbolKind::Program);
        let number = || self.number(name, package).map(SymbolKind::NamedNumber);
        let class = || self.class(name, package).map(SymbolKind::Class);
        let Some(found) = program.or_else(number).or_else(class) else {
            return self.slots.contains(&(package.to_string(), name.name.clone()));
        };
        uses.global(found, name.span);
        true
    }

    fn not_there(&self, package: &str, name: &Ident, is_imported: bool) -> Problem {
        let tables = [&self.programs, &self.numbers, &self.classes];
        let known = tables.into_iter().flat_map(|table| table.keys());
        let known = known.filter(|(home, _)| home == package).map(|(_, name)| name.as_str());
        let near = nearest(&name.name, known).map(str::to_string);
        Problem::NotInPackage { package: package.to_string(), name: name.clone(), is_imported, near }
    }

    /// The package that a name of a package means in the package `home`.
    pub(super) fn package<'a>(&'a self, home: &str, name: &'a str) -> &'a str {
        let local = self.local_nicknames.get(&(home.to_string(), name.to_string()));
        local.or_else(|| self.nicknames.get(name)).map_or(name, String::as_str)
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

    /// What a call that means nothing may have meant.
    pub(super) fn unknown_program(&self, call: &Call, home: &str, create: Missing) -> Problem {
        let name = call.program.clone();
        if let Some(package) = &name.package
            && !self.packages.iter().any(|known| known == self.package(home, package))
        {
            let near = nearest(package, self.packages()).map(str::to_string);
            return Problem::UnknownPackageOf { name, near };
        }
        if let Some(instead) = instead_of_operator(&name.name).filter(|_| name.package.is_none()) {
            let cure = Instead::word(instead);
            let is_sure = |word: &&str| *word != "delay" || (1..=2).contains(&call.arguments.len());
            return Problem::ForeignOperator { name, instead, cure: cure.filter(is_sure) };
        }
        let from = name.package.as_deref().map_or(home, |package| self.package(home, package));
        let visible = self.programs.keys().filter(|(package, _)| package == from || self.sees(from, package));
        let visible = visible.map(|(_, name)| name.as_str()).chain(Position::Body.names());
        let near = nearest(&name.name, visible).map(str::to_string);
        match near {
            Some(near) if Position::Body.has(&near) => Problem::UnknownOperator { name, near },
            near => {
                let elsewhere = self.programs.keys().find(|(_, program)| *program == name.name);
                let elsewhere = elsewhere.map(|(package, _)| package.clone());
                Problem::UnknownProgram { name, elsewhere, near, create }
            }
        }
    }

    fn find(&self, table: &Table, ident: &Ident, home: &str) -> Option<usize> {
        let get = |package: &str| table.get(&(package.to_string(), ident.name.clone())).copied();
        if let Some(package) = &ident.package {
            return get(self.package(home, package));
        }
        let imported = self.imports.get(&(home.to_string(), ident.name.clone()));
        let used = self.uses.get(home).into_iter().flatten();
        get(home).or_else(|| imported.and_then(|p| get(p))).or_else(|| used.into_iter().find_map(|p| get(p)))
    }

    fn sees(&self, home: &str, package: &str) -> bool {
        self.uses.get(home).is_some_and(|uses| uses.iter().any(|used| used == package))
    }

    /// The package meant, if it is one of the source; reports those that are neither that nor part of Lisp and RMPL.
    fn check_package(
        &self,
        home: &str,
        written: &Ident,
        uses: &mut Uses,
        problems: &mut Problems,
    ) -> Option<String> {
        let span = written.span;
        let name = self.package(home, &written.name);
        let builtin =
            matches!(name, "cl" | "common-lisp" | "rmpl" | DEFAULT_PACKAGE) || name.starts_with("rmpl/");
        if self.packages.iter().any(|known| known == name) {
            uses.package(name, span);
            return Some(name.to_string());
        }
        if !builtin {
            let near = nearest(name, self.packages()).map(str::to_string);
            problems.push(Problem::UnknownPackage { name: name.to_string(), span, near });
        }
        None
    }
}

fn fill<'a>(
    table: &mut Table,
    definitions: impl Iterator<Item = (&'a String, &'a Ident)>,
    what: Defined,
    problems: &mut Problems,
) {
    let mut firsts: BTreeMap<(&str, &str), Span> = BTreeMap::new();

    for (index, (home, name)) in definitions.enumerate() {
        let key = (home.as_str(), name.name.as_str());
        match firsts.get(&key) {
            Some(first) if problems.are_apart(*first, name.span) => {}
            Some(first) => problems.push(defined_twice(what, name, *first)),
            None => {
                firsts.insert(key, name.span);
                table.insert((home.clone(), name.name.clone()), index);
            }
        }
    }
}

fn defined_twice(what: Defined, name: &Ident, first: Span) -> Problem {
    Problem::DefinedTwice { what, name: name.clone(), first }
}
