//! What is said about names, declarations and calls.

use crate::analyse::problem::{Allowed, Defined, Limit, Problem};
use crate::ast::{Ident, Limits, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::parse::{DEFAULT_PACKAGE, suffixed};
use crate::source::Span;
use crate::wording::parse;
use crate::words::usage;

impl From<Problem> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::Amount(problem) => problem.into(),
            Problem::PrimitiveWithBody { program, body } => {
                let message = format!("the primitive program `{}` has a body", clip(&program.name));
                Diagnostic::error(Code::PrimitiveWithBody, body, message)
                    .primary("a primitive program has no body")
                    .label(program.span, "declared `(primitive)` here")
                    .help("Take out `(primitive)` if the program consists of others, or the body if it does not.")
            }
            Problem::DurationOfBody { program, duration, limit } => {
                let message = format!("`{}` has a body and a duration", clip(&program.name));
                let problem = Diagnostic::error(Code::DurationOfBody, duration, message)
                    .primary("only a primitive program has a duration of its own")
                    .help("To limit how long the body takes, put `(with-temporal-constraint (simple-temporal ...) ...)` around it.");
                limit.into_iter().fold(problem, |problem, limit| around_the_body(problem, duration, &limit))
            }
            Problem::OnlyADuration { program, duration } => {
                let message = format!("`{}` is neither primitive nor has it a body", clip(&program.name));
                Diagnostic::error(Code::NoBody, program.span, message)
                    .primary("nothing says what this program does")
                    .label(duration, "it only has a duration")
                    .help("Declare it primitive: `(declare (primitive) (duration ...))`.")
                    .suggest("Declare it primitive", [Edit::before(duration, "(primitive) ")])
            }
            Problem::NoBody { program, definition } => {
                let closing = Span { start: definition.end.saturating_sub(1), ..definition };
                Diagnostic::error(Code::NoBody, program.span, format!("`{}` has no body", clip(&program.name)))
                    .primary("nothing says what this program does")
                    .help("Give it a body, or declare it primitive: `(declare (primitive) (duration (simple :upper-bound 10)))`.")
                    .suggest("Declare it primitive", [Edit::before(closing, " (declare (primitive))")])
            }
            Problem::ContingentUnbounded { program, upper } => {
                let message =
                    format!("the contingent duration of `{}` has no upper bound", clip(&program.name));
                Diagnostic::error(Code::ContingentUnbounded, upper, message)
                    .primary("Nature could take forever")
                    .help("Nothing could be promised about what comes after it: give the longest time it may take as `:upper-bound`.")
            }
            Problem::DelayNotContingent { program, delay, duration, bounds, nil } => {
                let (at, label, help, edit) = match nil {
                    Some(nil) => (
                        nil,
                        "not contingent, as is said here",
                        "Change `:contingent nil` to `:contingent t`, or take the delay out.",
                        Edit::replace(nil, "t"),
                    ),
                    None => (
                        duration,
                        "`:contingent t` is missing in this duration",
                        "Add `:contingent t` after `(simple ...)`, or take the delay out.",
                        Edit::after(bounds, " :contingent t"),
                    ),
                };
                let name = clip(&program.name);
                let message = format!("the end of `{name}` has an observation delay but is not contingent");
                Diagnostic::error(Code::DelayNotContingent, delay, message)
                    .primary("only what Nature decides has to be observed")
                    .label(at, label)
                    .help(help)
                    .suggest("Let Nature decide: `:contingent t`", [edit])
            }
            Problem::ObserverNotContingent { program, observer } => {
                let name = clip(&program.name);
                let message = format!("the end of `{name}` is observed by somebody but is not contingent");
                Diagnostic::error(Code::DelayNotContingent, observer, message)
                    .primary("only what Nature decides has to be observed")
                    .help("Add `:contingent t`, or take `:observed-by` out: of what an agent decides it knows itself.")
            }
            Problem::NoLongestDelay { limits, delay } => {
                let [_, longest] = limits.words();
                let help = match limits {
                    Limits::Message => "Add `:max-delay`; `:infinity` says that messages may be lost.",
                    _ => "Add `:max-observation-delay`; `:infinity` says that the news may never come.",
                };
                Diagnostic::error(Code::DelayReversed, delay, format!("{longest} is missing"))
                    .primary("only the shortest one is given")
                    .help(help)
            }
            Problem::DefinedTwice { what, name, first } => {
                let what = match what {
                    Defined::Package => "package",
                    Defined::Program => "program",
                    Defined::NamedNumber => "named number",
                    Defined::Class => "class",
                    Defined::Agent => "agent",
                };
                let message = format!("the {what} `{}` is defined twice", clip(&name.name));
                Diagnostic::error(Code::DefinedTwice, name.span, message)
                    .primary("again here")
                    .label(first, "first defined here")
                    .help("Rename one of them, or take one out.")
            }
            Problem::UnknownPackage { name, span, near } => {
                let message = format!("the package `{}` is not defined", clip(&name));
                Diagnostic::error(Code::UnknownPackage, span, message)
                    .primary("not a package of this source")
                    .designated(span, near.as_deref())
            }
            Problem::UnknownPackageOf { name, near } => {
                let package = name.package.as_deref().unwrap_or_default();
                let message = format!("there is no package `{}`", clip(package));
                Diagnostic::error(Code::UnknownPackage, name.span, message)
                    .primary("not a package of this source")
                    .meant(name.span, near.map(|near| format!("{near}:{}", name.name)))
            }
            Problem::NoSuchPackage { name, defined, near } => {
                let message = format!("the source defines no package `{}`", clip(&name));
                let known = match defined.is_empty() {
                    true => "It defines no package at all: leave `-P` out.".to_string(),
                    false => format!("It defines `{}`.", defined.join("`, `")),
                };
                Diagnostic::error(Code::UnknownPackage, Span::default(), message)
                    .primary("looked for it here")
                    .help(near.map_or(known, |near| format!("Did you mean `{near}`?")))
            }
            Problem::NotInPackage { package, name, is_imported, near } => {
                let message = format!("the package `{}` has no `{}`", clip(&package), clip(&name.name));
                let problem = match is_imported {
                    true => Diagnostic::error(Code::UnknownName, name.span, message).primary("imported here"),
                    false => {
                        Diagnostic::warning(Code::UnknownName, name.span, message).primary("exported here")
                    }
                };
                problem
                    .help("A package has the programs, classes and named numbers that are defined after its `in-package`.")
                    .designated(name.span, near.as_deref())
            }
            Problem::SeveralEntries { name, places } => several_entries(&name, &places),
            Problem::NoPackageChosen { second, defined } => {
                let message = "the source defines several packages and none is chosen";
                Diagnostic::error(Code::PackageNotChosen, second, message)
                    .primary("the second one")
                    .help(format!("Choose one with `-P`: `{}`.", defined.join("`, `")))
            }
            Problem::NoEntry { name, last, candidates, near } => {
                let shown = clip(&name);
                let help = match near {
                    Some(near) => format!("Did you mean `--entry {near}`?"),
                    None if candidates.is_empty() => {
                        "A program is `(define-control-program main () ...)`.".to_string()
                    }
                    None => format!(
                        "Define `{shown}`, or start from another program with `--entry NAME`: {}.",
                        some_of(&candidates)
                    ),
                };
                let at = if candidates.is_empty() {
                    "no program is defined here"
                } else {
                    "the last program defined"
                };
                Diagnostic::error(Code::NoEntry, last, format!("there is no program `{shown}` to start from"))
                    .primary(at)
                    .help(help)
                    .lacking(name)
            }
            Problem::UnknownProgram { name, elsewhere, near, create } => {
                let problem = unknown_program(&name, elsewhere, near).lacking(name.name.as_str());
                if name.package.is_some() {
                    return problem;
                }
                let definition = Edit::after(create.after, definition(&name, create.parameters));
                problem.suggest(format!("Create the program `{}`", name.name), [definition])
            }
            Problem::ForeignOperator { name, instead, cure } => {
                let problem = unknown_operator(&name, format!("RMPL has no `{}`", clip(&name.name)))
                    .help(instead.help());
                cure.into_iter().fold(problem, |problem, word| problem.change(name.span, word))
            }
            Problem::UnknownOperator { name, near } => {
                unknown_operator(&name, format!("there is no operator `{}`", clip(&name.name)))
                    .meant(name.span, Some(near))
            }
            Problem::UnknownEvent { name, occurrence_of, near } => {
                let shown = clip(&name.name);
                let problem = Diagnostic::error(
                    Code::UnknownLabel,
                    name.span,
                    format!("nothing is labelled `{shown}`"),
                )
                .primary("neither a label nor a program");
                match (occurrence_of.as_deref().map(clip), near) {
                    (Some(program), _) => problem.help(format!(
                        "The second occurrence is `{program}#2`. For the first of several, give it a name: `(label x ({program} ...))`."
                    )),
                    (None, Some(near)) => problem.meant(name.span, Some(name.with_name(&near))),
                    (None, None) => problem.help(format!("Name the occurrence you mean: `(label {shown} (...))`.")),
                }
            }
            Problem::WrongArguments { call, given, program, parameters } => {
                let count =
                    |n: usize| if n == 1 { "1 argument".to_string() } else { format!("{n} arguments") };
                let name = clip(&program.name);
                let shape: Vec<String> =
                    [&program].into_iter().chain(&parameters).map(|it| clip(&it.name)).collect();
                let message = format!("`{name}` takes {}, not {given}", count(parameters.len()));
                Diagnostic::error(Code::WrongArguments, call, message)
                    .primary(format!("{} here", count(given)))
                    .label(program.span, "defined here")
                    .help(format!("Call it as `({})`.", shape.join(" ")))
            }
            Problem::UsedBeforeDefined { name, definition } => {
                let message = format!("`{}` is used before it is defined", clip(&name.name));
                Diagnostic::error(Code::UnknownName, name.span, message)
                    .primary("not known yet")
                    .label(definition, "defined only here")
                    .help("A named number may be calculated from those above it: move this one up.")
            }
            Problem::UnknownName { name, near } => {
                let problem = unknown_name(&name)
                    .help("A value is a number, a string, `t`, `nil`, a parameter, a name from `let`, `dotimes` or `defparameter`. A symbol is quoted: `'name`.");
                suffixed(&name.name)
                    .into_iter()
                    .fold(problem, |problem, number| parse::suffixed(problem, name.span, number))
                    .meant(name.span, near.map(|near| name.with_name(&near)))
            }
            Problem::StrayUnit { name, unit } => unknown_name(&name)
                .help(format!("A unit stands before its number, in a list with it: `({unit} 5)`.")),
            Problem::CurlyQuote { name, mark, quoted } => {
                let message = format!(
                    "the mark before `{}` is no quote: it is U+{:04X}",
                    clip(&quoted),
                    u32::from(mark)
                );
                Diagnostic::error(Code::UnknownName, name.span, message)
                    .primary("read as a name that begins with this mark")
                    .help("A symbol is quoted with the straight apostrophe of the keyboard, U+0027. Word processors change it.")
                    .change(name.span, format!("'{quoted}"))
            }
            Problem::UnknownParameter { name, span, program, near } => {
                Diagnostic::error(Code::UnknownName, span, format!("nothing is called `{}`", clip(&name)))
                    .primary(format!("not a parameter of `{}`", clip(&program.name)))
                    .meant(span, near)
            }
            Problem::UnknownClass { name, near } => {
                let message = format!("the class `{}` is not defined", clip(&name.name));
                Diagnostic::error(Code::UnknownClass, name.span, message)
                    .primary("extended here")
                    .meant(name.span, near.map(|near| name.with_name(&near)))
            }
            Problem::UnknownType { name, near } => {
                let message = format!("`{}` is not a type kirk knows", clip(&name.name));
                Diagnostic::warning(Code::UnknownType, name.span, message)
                    .primary("values of this slot are not checked")
                    .meant(name.span, near.map(|near| name.with_name(&near)))
            }
            Problem::UnknownAccessor { name, is_slot, near } => {
                let message = format!("no class has an accessor `{}`", clip(&name.name));
                let problem = Diagnostic::error(Code::UnknownAccessor, name.span, message)
                    .primary("not the `:reader` or `:accessor` of any slot");
                match is_slot {
                    true => {
                        problem.help("There is a slot of this name, but it has no `:reader` or `:accessor`.")
                    }
                    false => problem.meant(name.span, near.map(|near| name.with_name(&near))),
                }
            }
            Problem::WrongType { slot, allowed, value, near } => wrong_type(&slot, &allowed, &value, near),
            Problem::NotPlannedWith { program } => {
                let message =
                    format!("the conditions and effects of `{}` are not planned with", clip(&program.name));
                Diagnostic::note(Code::NotPlannedWith, program.span, message)
                    .primary("its conditions are read and checked, and kept with the episode")
                    .help("Kirk does not plan: it takes for granted that the program as written brings about what it requires.")
            }
            Problem::CircularClass { circle, at } => {
                let (first, path) = path(&circle, circle.len());
                let problem =
                    Diagnostic::error(Code::CircularClass, at, format!("the class `{first}` extends itself"))
                        .primary("this closes the circle")
                        .help(format!("{path}: take one of the superclasses out."));
                on_the_circle(problem, &circle)
            }
            Problem::Recursion { circle, length, call } => {
                let (first, path) = path(&circle, length);
                let problem = Diagnostic::error(Code::Recursion, call, format!("the program `{first}` calls itself"))
                    .primary(match length {
                        1 => "it is called from its own body",
                        _ => "this call closes the circle",
                    })
                    .help(format!(
                        "{path}: a mission that never ends cannot be scheduled. To repeat something, use `dotimes`."
                    ));
                on_the_circle(problem, &circle)
            }
            Problem::NeverCalled { program, entry, package } => {
                let (name, entry) = (clip(&program.name), clip(&entry));
                let choice = match package {
                    None => format!("--entry {name}"),
                    Some(package) => format!("-P {} --entry {name}", clip(&package)),
                };
                let message = format!("the program `{name}` is never used");
                Diagnostic::warning(Code::NeverUsed, program.span, message).primary("defined here").help(
                    format!("Nothing that `{entry}` does leads to it. To start from it, use `{choice}`."),
                )
            }
            Problem::UnusedParameter { name, span, program } => {
                let message =
                    format!("the parameter `{}` of `{}` is never used", clip(&name), clip(&program.name));
                Diagnostic::warning(Code::NeverUsed, span, message)
                    .primary("whatever is given for it makes no difference")
                    .help("Use it in the body, or take it out here and in the calls.")
            }
            Problem::UnusedLabel { name, span } => {
                let name = clip(&name);
                Diagnostic::note(Code::NeverUsed, span, format!("no `between` means the label `{name}`"))
                    .primary("it only gives events another name")
                    .help(format!(
                        "If a constraint was to be about it: `(between (end {name}) (start ...) ...)`."
                    ))
            }
            Problem::SecondTeam { team, first } => {
                let message = format!("`{}` is a second team", clip(&team.name));
                Diagnostic::error(Code::DefinedTwice, team.span, message)
                    .primary("again here")
                    .label(first, "the first team")
                    .help("A mission is executed by one team: put all its agents and links into one `define-team`.")
            }
            Problem::EmptyTeam { team } => {
                let message = format!("nobody belongs to the team `{}`", clip(&team.name));
                Diagnostic::error(Code::WrongShape, team.span, message)
                    .primary("a team without agents")
                    .help(usage("define-team"))
            }
            Problem::UnknownAgent { name, team, near } => {
                let message = format!("`{}` is no agent", clip(&name.name));
                let problem = Diagnostic::error(Code::UnknownAgent, name.span, message);
                match team {
                    Some(team) => problem
                        .primary("nobody of this name is in the team")
                        .label(team.span, "the team")
                        .help(format!("Add `(agent {})` to the team.", clip(&name.name)))
                        .meant(name.span, near),
                    None => problem.primary("no team is defined").help(usage("define-team")),
                }
            }
            Problem::LinkToItself { agent, link } => {
                let message = format!("a link from `{}` to itself", clip(&agent.name));
                Diagnostic::error(Code::WrongShape, link, message)
                    .primary("both ends are the same agent")
                    .help("An agent knows of its own events at once. How late it hears of what Nature decides is its `:max-observation-delay`.")
            }
        }
    }
}

/// With the suggestion to limit the one form of a body as its program was to be.
fn around_the_body(problem: Diagnostic, duration: Span, limit: &Limit) -> Diagnostic {
    let Limit { form, lower, upper } = limit;
    let start = Span { end: form.start, ..*form };
    let mut edits =
        vec![Edit::replace(duration, ""), Edit::before(start, "(with-temporal-constraint (simple-temporal")];
    for (word, amount) in [("lower", lower), ("upper", upper)] {
        if let Some(amount) = amount {
            edits.extend([Edit::before(start, format!(" :{word}-bound ")), Edit::copy(start, *amount)]);
        }
    }
    edits.extend([Edit::before(start, ") "), Edit::after(*form, ")")]);
    problem.suggest("Limit the body instead", edits)
}

fn several_entries(name: &str, places: &[(String, Span)]) -> Diagnostic {
    let homes: Vec<String> = places.iter().map(|(home, _)| format!("`{}`", clip(home))).collect();
    let at = |index: usize| places.get(index).map_or(Span::default(), |(_, span)| *span);
    let outside = match places.iter().take(2).any(|(home, _)| home == DEFAULT_PACKAGE) {
        true => format!(" What is in no package is in `{DEFAULT_PACKAGE}`."),
        false => String::new(),
    };
    let message =
        format!("several packages have a program `{}` to start from, and none is chosen", clip(name));
    Diagnostic::error(Code::PackageNotChosen, at(1), message)
        .primary("the second one")
        .label(at(0), "the first one")
        .help(format!("Choose the package with `-P`: {}.{outside}", homes.join(", ")))
}

/// The first names, as many as a line has room for.
fn some_of(names: &[String]) -> String {
    let mut shown = String::new();
    for (index, name) in names.iter().enumerate() {
        let name = clip(name);
        if index > 0 && shown.chars().count() + name.chars().count() > 60 {
            return format!("{shown} and {} more", names.len() - index);
        }
        shown.push_str(if index > 0 { ", " } else { "" });
        shown.push_str(&name);
    }
    shown
}

fn unknown_program(name: &Ident, elsewhere: Option<String>, near: Option<String>) -> Diagnostic {
    let shown = clip(&name.name);
    let problem =
        Diagnostic::error(Code::UnknownProgram, name.span, format!("the program `{shown}` is not defined"))
            .primary("called here");
    match (elsewhere, near) {
        (Some(package), _) => problem
            .help(format!("The package `{package}` has one: write `{package}:{shown}`."))
            .change(name.span, format!("{package}:{}", name.name)),
        (None, Some(near)) => problem.meant(name.span, Some(name.with_name(&near))),
        (None, None) => problem.help(format!(
            "Define it: `(define-control-program {shown} () (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))`."
        )),
    }
}

/// A definition of the program that is missing.
fn definition(name: &Ident, parameters: usize) -> String {
    let parameters: Vec<String> = (1..=parameters).map(|number| format!("x{number}")).collect();
    format!(
        "\n\n(define-control-program {} ({})\n  (declare (primitive)\n    (duration (simple :lower-bound 5 :upper-bound 10))))",
        name.name,
        parameters.join(" ")
    )
}

fn unknown_operator(name: &Ident, message: String) -> Diagnostic {
    Diagnostic::error(Code::UnknownOperator, name.span, message).primary("neither an operator nor a program")
}

fn unknown_name(name: &Ident) -> Diagnostic {
    Diagnostic::error(Code::UnknownName, name.span, format!("nothing is called `{}`", clip(&name.name)))
        .primary("neither a parameter or variable here nor a named number")
}

fn wrong_type(slot: &Ident, allowed: &Allowed, value: &Value, near: Option<String>) -> Diagnostic {
    let allowed = match allowed {
        Allowed::OneOf(values) => {
            format!("one of {}", values.iter().map(show).collect::<Vec<_>>().join(", "))
        }
        Allowed::OfType(name) => format!("a value of type `{}`", clip(&name.name)),
        Allowed::Other => "a value of another type".to_string(),
    };
    let message = format!("the slot `{}` cannot be {}", clip(&slot.name), show(&value.kind));
    let problem = Diagnostic::error(Code::WrongType, value.span, message)
        .primary(format!("{allowed} was expected"))
        .label(slot.span, "the slot is defined here");
    match near.map(|near| write(&Form { span: value.span, kind: FormKind::String(near) })) {
        Some(near) => problem.help(format!("Did you mean {near}?")).change(value.span, near),
        None => problem,
    }
}

fn show(kind: &ValueKind) -> String {
    match kind {
        ValueKind::Number(number) => number.to_string(),
        ValueKind::Text(text) => format!("\"{}\"", clip(text)),
        ValueKind::True => "t".to_string(),
        ValueKind::Nil => "nil".to_string(),
        ValueKind::Symbol(name) | ValueKind::Name(_, name) | ValueKind::Other(name) => clip(name),
    }
}

/// The first on a circle of so many, and the way round.
fn path(circle: &[Ident], length: usize) -> (String, String) {
    let mut path: Vec<String> = circle.iter().map(|name| clip(&name.name)).collect();
    let first = path.first().cloned().unwrap_or_default();
    if length > circle.len() {
        path.push("...".to_string());
    }
    path.push(first.clone());
    (first, path.join(" -> "))
}

fn on_the_circle(problem: Diagnostic, circle: &[Ident]) -> Diagnostic {
    circle.iter().fold(problem, |problem, name| problem.label(name.span, "on the circle"))
}
