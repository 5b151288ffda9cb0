//! `(defpackage #:p (:use #:q) ...)` and `(in-package #:p)`.

use super::DEFAULT_PACKAGE;
use super::problem::{Expected, Missing, Problem};
use crate::ast::{Ident, Import, Package};
use crate::form::Form;
use crate::nearest::nearest;
use crate::problem::Problems;

/// Those that say nothing about names are read and have no effect.
pub(crate) const OPTIONS: [&str; 9] = [
    "use",
    "import-from",
    "shadowing-import-from",
    "export",
    "nicknames",
    "local-nicknames",
    "documentation",
    "shadow",
    "size",
];

/// Parses the definition of a package.
pub(super) fn package(form: &Form, rest: &[Form], problems: &mut Problems) -> Option<Package> {
    let Some((name, rest)) = rest.split_first() else {
        problems.push(Problem::Missing { at: form.head(), what: Missing::PackageName });
        return None;
    };
    let Some(text) = name.designator() else {
        if !name.is_error() {
            problems.push(Problem::Unexpected { found: name, expected: Expected::PackageName });
        }
        return None;
    };
    let name = Ident { package: None, name: text, span: name.span };
    let mut package = Package {
        name,
        uses: Vec::new(),
        imports: Vec::new(),
        nicknames: Vec::new(),
        local_nicknames: Vec::new(),
        exports: Vec::new(),
    };
    for option in rest {
        let Some((keyword, values)) = option.list().and_then(|items| items.split_first()) else {
            if !option.is_error() {
                problems.push(Problem::Unexpected { found: option, expected: Expected::PackageOption });
            }
            continue;
        };
        match keyword.keyword() {
            Some("use") => package.uses.extend(names(values, problems)),
            Some("export") => package.exports.extend(names(values, problems)),
            Some("nicknames") => package.nicknames.extend(names(values, problems)),
            Some("local-nicknames") => {
                for pair in values {
                    match names(pair.list().unwrap_or_default(), problems).as_slice() {
                        [short, of] => package.local_nicknames.push((short.clone(), of.clone())),
                        _ => {
                            let expected = Expected::LocalNickname;
                            problems.push(Problem::Unexpected { found: pair, expected });
                        }
                    }
                }
            }
            // Names of one's own come before all others, so that there is no difference between the two.
            Some("import-from" | "shadowing-import-from") => {
                let listed = names(values, problems);
                if let Some((from, imported)) = listed.split_first() {
                    let import = |name: &Ident| Import { from: from.clone(), name: name.clone() };
                    package.imports.extend(imported.iter().map(import));
                }
            }
            Some(word) if OPTIONS.contains(&word) => {}
            Some(word) => {
                let near = nearest(word, OPTIONS);
                problems.push(Problem::PackageOption { at: keyword.span, word, near });
            }
            None => {
                problems.push(Problem::Unexpected { found: keyword, expected: Expected::PackageKeyword });
            }
        }
    }
    Some(package)
}

/// Parses `in-package`: the name of the package whose definitions follow.
pub(super) fn entered(
    form: &Form,
    rest: &[Form],
    packages: &[Package],
    problems: &mut Problems,
) -> Option<String> {
    let (Some(wanted), [name]) = (rest.first().and_then(Form::designator), rest) else {
        problems.push(Problem::Missing { at: form.head(), what: Missing::PackageToEnter });
        return None;
    };
    if let Some(known) = packages.iter().find(|package| package.is_called(&wanted)) {
        return Some(known.name.name.clone());
    }
    if wanted != DEFAULT_PACKAGE {
        let known = packages.iter().map(|package| package.name.name.as_str());
        let near = nearest(&wanted, known);
        problems.push(Problem::UnknownPackage { form: form.span, at: name.span, name: &wanted, near });
    }
    Some(wanted)
}

/// The names that forms designate; reports those that do not.
fn names(forms: &[Form], problems: &mut Problems) -> Vec<Ident> {
    let mut found = Vec::new();
    for form in forms {
        match form.designator() {
            Some(name) => found.push(Ident { package: None, name, span: form.span }),
            None if form.is_error() => {}
            None => problems.push(Problem::Unexpected { found: form, expected: Expected::Designator }),
        }
    }
    found
}
