//! What is said about the shape of forms.

mod binding;
mod body;
mod declaration;
mod definition;
mod elsewhere;
mod keyword;
mod label;
mod number;

pub(crate) use number::suffixed;

use std::fmt::Display;

use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip};
use crate::parse::class::SLOT_OPTIONS;
use crate::parse::package::OPTIONS;
use crate::parse::problem::{ConditionSlip, Expected, Missing, Named, Problem, Twice};
use crate::source::Span;
use crate::words::usage;

impl From<Problem<'_>> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::Unexpected { found, expected } => misplaced(found, expected),
            Problem::Missing { at, what } => missing(at, what),
            Problem::Twice { what, first, again, whole } => twice(what, first, again, whole),
            Problem::Repeated { what, name, first, again } => {
                let name = clip(name);
                let message = match what {
                    Named::Parameter => format!("the parameter `{name}` is there twice"),
                    _ => format!("`{name}` is given two values"),
                };
                Diagnostic::error(Code::DefinedTwice, again, message)
                    .primary("again here")
                    .label(first, "first here")
            }
            Problem::Reserved { what: Named::Label, name, at } => reserved_label(name, at),
            Problem::Reserved { what, name, at } => reserved(what, name, at),
            Problem::UnknownOperator { at, word, near } => {
                let message = format!("there is no operator `{}`", clip(word));
                Diagnostic::error(Code::UnknownOperator, at, message)
                    .primary("neither an operator nor a program")
                    .meant(at, Some(near))
            }
            Problem::ParameterMark { at, word } => {
                Diagnostic::error(Code::WrongShape, at, format!("`{}` is not understood here", clip(word)))
                    .primary("a parameter was expected")
                    .help(
                        "Every parameter of a control program is given by place; there are no optional ones.",
                    )
            }
            Problem::Condition { at, slip } => condition(at, slip),
            Problem::NoBounds { constraint } => {
                Diagnostic::warning(Code::NoBounds, constraint, "this constraint allows everything")
                    .primary("neither a lower nor an upper bound")
                    .help(body::WITHIN)
            }
            Problem::OnlyOrder { constraint } => {
                let message = "this constraint says only that the first event comes first";
                Diagnostic::warning(Code::NoBounds, constraint, message)
                    .primary("neither a lower nor an upper bound: the lower one is 0")
                    .help("If that is what is meant, `(simple-temporal :lower-bound 0)` says so.")
                    .suggest(
                        "Write `:lower-bound 0`",
                        [Edit::before(last_byte(constraint), " :lower-bound 0")],
                    )
            }
            Problem::PackageOption { at, word, near } => {
                let message = format!("a package has no option `:{}`", clip(word));
                Diagnostic::error(Code::UnknownKeyword, at, message)
                    .primary("not an option of `defpackage`")
                    .help(format!("The options are :{}.", OPTIONS.join(", :")))
                    .meant(at, near.map(|near| format!(":{near}")))
            }
            Problem::SlotOption { at, word, near } => {
                let message = format!("a slot has no option `:{}`", clip(word));
                Diagnostic::warning(Code::UnknownSlotOption, at, message)
                    .primary("left out, with its value")
                    .help(format!("The slot options are :{}.", SLOT_OPTIONS.join(", :")))
                    .meant(at, near.map(|near| format!(":{near}")))
            }
            Problem::SlotOptionAlone { at, word } => {
                Diagnostic::error(Code::WrongShape, at, format!("`:{}` has no value", clip(word)))
                    .primary("a value was expected after this option")
            }
            Problem::UnknownPackage { form, at, name, near } => unknown_package(form, at, name, near),
            Problem::Number { form, role, slip } => number::told(form, role, slip),
            Problem::Binding(slip) => binding::told(slip),
            Problem::Body(slip) => body::told(slip),
            Problem::Declaration(slip) => declaration::told(slip),
            Problem::Definition(slip) => definition::told(slip),
            Problem::Label(slip) => label::told(slip),
            Problem::Keyword(slip) => keyword::told(slip),
        }
    }
}

const TEAM: &str = usage("define-team");
const LINK: &str = usage("link");

fn misplaced(found: &Form, expected: Expected) -> Diagnostic {
    const CLASS: &str = usage("defclass");
    const PACKAGE: &str = usage("defpackage");
    let (wanted, help) = match expected {
        Expected::NumberName => ("a name", const { usage("defparameter") }),
        Expected::ClassName => ("the name of the class", CLASS),
        Expected::Superclasses => ("a list of superclasses", CLASS),
        Expected::Superclass => ("the name of a class", CLASS),
        Expected::Slots => ("a list of slots", CLASS),
        Expected::ClassOption => ("an option such as `(:documentation ...)`", CLASS),
        Expected::SlotName => ("the name of a slot", CLASS),
        Expected::SlotOption => ("a slot option", "Slot options are keywords, each followed by its value."),
        Expected::Documentation => ("a string", "Documentation is text in quotation marks."),
        Expected::Type => ("a type", "A type is a name or `(member value...)`."),
        Expected::PackageName => ("the name of the package", PACKAGE),
        Expected::PackageOption => ("an option such as `(:use #:other)`", "Options are lists."),
        Expected::PackageKeyword => ("a keyword such as `:use`", "Options are lists."),
        Expected::LocalNickname => (
            "`(#:short #:package)`",
            "A local nickname and its package stand in a list: `(:local-nicknames (#:t #:tools))`.",
        ),
        Expected::Designator => ("a name", "Names of packages and in packages are written `#:name`."),
        Expected::ProgramName => ("the name of the program", definition::SHAPE),
        Expected::Parameter => ("the name of a parameter", "Parameters are names: `(glider to)`."),
        Expected::Binding => ("`(name value)`", binding::LET),
        Expected::List => ("a list", "Keywords stand inside of the form they belong to."),
        Expected::EndOfPrimitive => {
            ("`)`", "`(primitive)` stands alone; the duration is a declaration of its own.")
        }
        Expected::EndOfBetween => ("`)`", label::BETWEEN),
        Expected::LabelName => ("the name of the label", label::LABEL),
        Expected::Event => ("an event", label::EVENT),
        Expected::Occurrence => ("a label or the name of a program", label::EVENT),
        Expected::TeamName => ("the name of the team", TEAM),
        Expected::PartOfTeam => ("`(agent ...)` or `(link ...)`", TEAM),
        Expected::AgentOfLink => ("the name of an agent", LINK),
        Expected::Observer => ("the name of an agent", declaration::DURATION),
    };
    let problem = unexpected(found, wanted, help);
    match expected {
        Expected::LabelName | Expected::Occurrence => plain_name(problem, found, "Write the plain name"),
        _ => problem,
    }
}

fn missing(at: Span, what: Missing) -> Diagnostic {
    const FORM: &str = "in this form";
    const BETWEEN: &str = "two events and a constraint were expected";
    let (message, primary, help) = match what {
        Missing::NameAndNumber => {
            ("a name and a number were expected", FORM, const { usage("defparameter") })
        }
        Missing::PartsOfClass => {
            ("a class needs a name, its superclasses and its slots", FORM, const { usage("defclass") })
        }
        Missing::PackageName => ("this package has no name", FORM, const { usage("defpackage") }),
        Missing::PackageToEnter => ("`in-package` needs one package", FORM, const { usage("in-package") }),
        Missing::ProgramName => ("this program has no name", FORM, definition::SHAPE),
        Missing::Duration => ("this duration is empty", FORM, declaration::DURATION),
        Missing::PartsOfLet => ("this `let` is empty", FORM, binding::LET),
        Missing::BodyOfLet => ("this `let` has no body", FORM, binding::LET),
        Missing::PartsOfDotimes => ("this `dotimes` is empty", FORM, binding::DOTIMES),
        Missing::BodyOfDotimes => ("this `dotimes` has nothing to repeat", FORM, binding::DOTIMES),
        Missing::LabelName => ("this label has no name", FORM, label::LABEL),
        Missing::Labelled => {
            ("this label names nothing", "a body form was expected after the name", label::LABEL)
        }
        Missing::Wait => ("this delay is empty", FORM, body::DELAY),
        Missing::Constraint => (
            "`with-temporal-constraint` has no constraint",
            "`(simple-temporal ...)` was expected after this",
            body::WITHIN,
        ),
        Missing::Constrained => (
            "`with-temporal-constraint` has nothing to constrain",
            "a body was expected after the constraint",
            body::WITHIN,
        ),
        Missing::Between => ("this `between` is empty", BETWEEN, label::BETWEEN),
        Missing::SecondEvent => ("a `between` with one event", BETWEEN, label::BETWEEN),
        Missing::ConstraintBetween => ("a `between` without a constraint", BETWEEN, label::BETWEEN),
        Missing::PartsOfTeam => ("a team needs a name and its agents", FORM, TEAM),
        Missing::Linked => ("the names of two agents were expected", FORM, LINK),
        Missing::PartsOfWithAgent => {
            ("an agent and a body were expected", FORM, const { usage("with-agent") })
        }
        Missing::Agent => ("the name of one agent was expected", FORM, const { usage("agent") }),
    };
    Diagnostic::error(Code::WrongShape, at, message).primary(primary).help(help)
}

fn twice(what: Twice, first: Span, again: Span, whole: Option<[Span; 2]>) -> Diagnostic {
    let message = match what {
        Twice::Duration => "the duration is given twice".to_string(),
        Twice::Agent => "the agent is given twice".to_string(),
        Twice::Keyword(word) => format!("`:{word}` is given twice"),
    };
    let problem = Diagnostic::error(Code::KeywordTwice, again, message)
        .primary("again here")
        .label(first, "first here")
        .help("Keep one of them.");
    match whole {
        Some([one, other]) => problem.take_out("the first one", one).take_out("the second one", other),
        None => problem,
    }
}

fn reserved(what: Named, name: &str, at: Span) -> Diagnostic {
    let meaning = match name {
        "t" => "`t` means yes",
        "nil" => "`nil` means no, or nothing",
        _ => "it is an operator",
    };
    let owner = if what == Named::Parameter { "a parameter" } else { "a program" };
    let problem = Diagnostic::error(Code::ReservedName, at, format!("{owner} cannot be called `{name}`"))
        .primary(meaning)
        .help(format!("Give it another name, such as `{name}-1`, here and wherever it is used."));
    match what {
        Named::Parameter => problem.change(at, format!("{name}-1")),
        _ => problem,
    }
}

fn reserved_label(name: &str, at: Span) -> Diagnostic {
    let plain = name.replace('#', "-");
    Diagnostic::error(Code::ReservedName, at, format!("a label cannot be called `{}`", clip(name)))
        .primary("`#` numbers occurrences: `a#2` is the second of `a`")
        .help(format!("Give it another name, such as `{}`, here and wherever it is used.", clip(&plain)))
        .change(at, plain)
}

fn condition(at: Span, slip: ConditionSlip) -> Diagnostic {
    let message = match slip {
        ConditionSlip::Time { word, near } => return wrong_time(at, word, near),
        ConditionSlip::No(form) => format!("{} is not a condition", described(form)),
        ConditionSlip::NoSlot(word) => format!("the left side of `{word}` is not a slot of an object"),
        ConditionSlip::Parts(word) => format!("`{word}` has the wrong number of parts"),
    };
    Diagnostic::error(Code::BadCondition, at, message)
        .primary("a condition was expected")
        .help(const { usage("=") })
}

fn wrong_time(at: Span, word: &str, near: Option<&str>) -> Diagnostic {
    let (wanted, help) = match word {
        "at" => ("`:start` or `:end`", "Write `(at :start ...)` or `(at :end ...)`."),
        _ => ("`:all`", "Write `(over :all ...)`."),
    };
    Diagnostic::error(Code::BadCondition, at, format!("`{word}` needs {wanted}"))
        .primary("found this")
        .help(help)
        .meant(at, near.map(|near| format!(":{near}")))
}

fn unknown_package(form: Span, at: Span, name: &str, near: Option<&str>) -> Diagnostic {
    let message = format!("the package `{}` is not defined", clip(name));
    let problem = Diagnostic::error(Code::UnknownPackage, at, message).primary("not defined above");
    let definition = format!("(defpackage #:{name})");
    match near {
        Some(near) => problem.designated(at, Some(near)),
        None => problem
            .help(format!("Put `{}` before it.", clip(&definition)))
            .suggest(format!("Define the package `{name}`"), [Edit::before(form, format!("{definition}\n"))]),
    }
}

/// A form that has not the right shape.
fn wrong(at: Span, message: impl Into<String>, primary: &str, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, at, message).primary(primary).help(help)
}

/// Something that is not what belongs here.
fn unexpected(found: &Form, wanted: &str, help: &str) -> Diagnostic {
    wrong(found.span, format!("{wanted} was expected, not {}", described(found)), "found this", help)
}

/// With the change that takes a quotation mark or a `'` off what stands there, if that leaves a name.
fn plain_name(problem: Diagnostic, found: &Form, title: &str) -> Diagnostic {
    let edit = match &found.kind {
        FormKind::Quote(inner) => Edit::replace(Span { end: inner.span.start, ..found.span }, ""),
        FormKind::String(text) if is_plain_name(text) => Edit::replace(found.span, text),
        _ => return problem,
    };
    problem.suggest(title, [edit])
}

/// True if the text would be read as one name.
fn is_plain_name(text: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "-+*/<>=.!?%&$_~^@".contains(c);
    text.starts_with(char::is_alphabetic) && text.chars().all(plain)
}

/// With the change that puts text around what stands there, if it is clear what that is.
fn around(problem: Diagnostic, title: &str, all: Option<Span>, [before, after]: [&str; 2]) -> Diagnostic {
    match all {
        Some(all) => problem.suggest(title, [Edit::before(all, before), Edit::after(all, after)]),
        None => problem,
    }
}

fn last_byte(span: Span) -> Span {
    Span { start: span.end - 1, ..span }
}

/// `a`, `b` and `c`.
fn one_of(words: impl IntoIterator<Item = impl Display>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// What to call a form: "a list", "the number 15".
fn described(form: &Form) -> String {
    match &form.kind {
        FormKind::List(items) if items.is_empty() => "an empty list".to_string(),
        FormKind::List(_) => match form.call() {
            Some((word, _)) => format!("the form `({} ...)`", clip(word)),
            None => "a list".to_string(),
        },
        FormKind::Symbol(symbol) => format!("the name `{}`", clip(&symbol.name)),
        FormKind::Keyword(name) => format!("the keyword `:{}`", clip(name)),
        FormKind::Uninterned(name) => format!("the name `#:{}`", clip(name)),
        FormKind::Number(text) => format!("the number {}", clip(text)),
        FormKind::String(_) => "a string".to_string(),
        FormKind::Quote(_) => "a quoted form".to_string(),
        FormKind::Error => "something unreadable".to_string(),
    }
}
