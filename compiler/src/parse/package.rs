//! `(defpackage #:p (:use #:q) ...)` and `(in-package #:p)`.

use super::DEFAULT_PACKAGE;
use super::slips::{expected, unexpected};
use crate::ast::{Ident, Import, Package};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, clip};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::words::usage;

/// Those that say nothing about names are read and have no effect.
const OPTIONS: [&str; 9] = [
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
        problems.push(expected(form, "this package has no name", usage("defpackage")));
        return None;
    };
    let Some(text) = name.designator() else {
        if !name.is_error() {
            problems.push(unexpected(name, "the name of the package", usage("defpackage")));
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
                problems.push(unexpected(option, "an option such as `(:use #:other)`", "Options are lists."));
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
                        _ => problems.push(unexpected(pair, "`(#:short #:package)`", "A local nickname and its package stand in a list: `(:local-nicknames (#:t #:tools))`.")),
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
            Some(word) => problems.push(
                Diagnostic::error(
                    Code::UnknownKeyword,
                    keyword.span,
                    format!("a package has no option `:{}`", clip(word)),
                )
                .primary("not an option of `defpackage`")
                .help(format!("The options are :{}.", OPTIONS.join(", :")))
                .meant(keyword.span, nearest(word, OPTIONS).map(|near| format!(":{near}"))),
            ),
            None => problems.push(unexpected(keyword, "a keyword such as `:use`", "Options are lists.")),
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
        problems.push(expected(form, "`in-package` needs one package", usage("in-package")));
        return None;
    };
    if let Some(known) = packages.iter().find(|package| package.is_called(&wanted)) {
        return Some(known.name.name.clone());
    }
    if wanted != DEFAULT_PACKAGE {
        let known = packages.iter().map(|package| package.name.name.as_str());
        let problem = Diagnostic::error(
            Code::UnknownPackage,
            name.span,
            format!("the package `{}` is not defined", clip(&wanted)),
        )
        .primary("not defined above");
        let definition = format!("(defpackage #:{wanted})");
        problems.push(match nearest(&wanted, known) {
            Some(near) => problem.designated(name.span, Some(near)),
            None => problem.help(format!("Put `{}` before it.", clip(&definition))).suggest(
                format!("Define the package `{wanted}`"),
                [Edit::before(form.span, format!("{definition}\n"))],
            ),
        });
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
            None => problems.push(unexpected(
                form,
                "a name",
                "Names of packages and in packages are written `#:name`.",
            )),
        }
    }
    found
}
