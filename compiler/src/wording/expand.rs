//! What is said about a program as it is unfolded.

use crate::ast::ValueKind;
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{MAX_DEPTH, MAX_EPISODES};
use crate::expand::problem::{Apart, Found, MOST_TOLD, Name, Problem, There, Unfolded};
use crate::expand::source;
use crate::form::clip;
use crate::source::Span;

impl From<Problem> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::Amount { problem, call } => {
                let problem = Diagnostic::from(problem);
                let is_shown = problem.span == call || problem.labels.iter().any(|label| label.span == call);
                if is_shown { problem } else { called(problem, call) }
            }
            Problem::FreeParameters { program, parameters } => {
                let names: Vec<String> = parameters.iter().map(|it| format!("`{}`", clip(&it.name))).collect();
                let message = format!("`{}` is started without arguments", clip(&program.name));
                Diagnostic::note(Code::FreeParameters, program.span, message)
                    .primary(format!("nothing is known about {}", names.join(" and ")))
                    .help("That does no harm as long as no time depends on them. To start with arguments, call it from a program `main`.")
            }
            Problem::ContingentUnbounded { program, upper, call } => {
                let message = format!("the contingent duration of `{}` has no upper bound", clip(&program.name));
                let problem = Diagnostic::error(Code::ContingentUnbounded, upper, message);
                called(problem.primary("Nature could take forever"), call)
            }
            Problem::NobodyExecutes { program, call } => {
                let name = clip(&program.name);
                Diagnostic::error(Code::NobodyExecutes, program.span, format!("no agent of the team executes `{name}`"))
                    .primary("an activity of nobody")
                    .label(call, "called here")
                    .help(format!("Say who: `(agent ...)` in the `declare` of `{name}`, or `(with-agent ... ({name}))` around the call."))
            }
            Problem::NoAgent { named, value, agents, call } => {
                let agents: Vec<String> = agents.iter().map(|agent| format!("`{}`", clip(agent))).collect();
                let message = format!("{} is no agent of the team", clip(&source(&value.kind)));
                called(Diagnostic::error(Code::UnknownAgent, named, message), call)
                    .primary("this stands for it")
                    .help(format!("The agents are {}.", agents.join(", ")))
            }
            Problem::TooManyEpisodes { program, episodes, most } => {
                let count = match episodes {
                    u64::MAX => "more episodes than can be counted".to_string(),
                    episodes => format!("{episodes} episodes"),
                };
                let message = format!("`{}` unfolds to {count}", clip(&program.name));
                let problem = Diagnostic::error(Code::TooManyEpisodes, program.span, message)
                    .primary(format!("at most {MAX_EPISODES} are possible"))
                    .help("Every call is an episode of its own, and so is everything it calls in turn; every repetition counts.");
                most.into_iter().fold(problem, |problem, (from, call)| {
                    problem.label(call, format!("most of them come from `{}`", clip(&from.name)))
                })
            }
            Problem::TooDeep { program, depth } => {
                let message = format!("`{}` unfolds to a depth of {depth}", clip(&program.name));
                Diagnostic::error(Code::CallsTooDeep, program.span, message)
                    .primary(format!("at most {MAX_DEPTH} programs and forms can be nested"))
                    .help("Call the programs one after the other instead of each from the one before.")
            }
            Problem::TooMany { what, span, call } => {
                let what = match what {
                    Unfolded::Episodes => "episodes",
                    Unfolded::Repetitions => "repetitions",
                    Unfolded::Constraints => "constraints",
                };
                let message = format!("the mission unfolds to more than {MAX_EPISODES} {what}");
                let problem = Diagnostic::error(Code::TooManyEpisodes, span, message)
                    .primary("this is one too many")
                    .help("Every call is an episode of its own, and every repetition of a `dotimes` is unfolded.");
                call.into_iter().fold(problem, called)
            }
            Problem::SameEvent { from, to } => {
                Diagnostic::error(Code::SameEvent, to, "a constraint between an event and itself")
                    .primary("this is the same event")
                    .label(from, "as this one")
                    .help("From an event to itself it is always 0 s. Did you mean its other end?")
            }
            Problem::LabelTwice { label, span, first } => {
                Diagnostic::error(Code::DefinedTwice, span, format!("the label `{label}` is given twice"))
                    .primary("again here")
                    .label(first, "first here")
                    .help("A label names one occurrence: rename one of them, or tell them apart by an argument, as in `(label (x 1) ...)`.")
            }
            Problem::NoOccurrence { name, there } => {
                let message = format!("`{}` does not occur", written(&name.name, name.arguments.as_deref()));
                let problem = Diagnostic::error(Code::UnknownLabel, name.span, message)
                    .primary("looked for in the whole mission");
                match there {
                    There::Nothing => {
                        problem.help("It is defined, but nothing that the mission does leads to it.")
                    }
                    There::Only(only) => problem.help(format!("There is `{only}` alone.")),
                    There::Between(first, last) => problem.help(format!("There is `{first}` up to `{last}`.")),
                    There::Others(others, first) => problem
                        .help(format!("There is {}. Repetitions count from 0.", list(&name.name, &others)))
                        .label(first, "one of this name is here"),
                }
            }
            Problem::Ambiguous { name, found: Found { count, episodes, places }, apart } => {
                let shown = written(&name.name, name.arguments.as_deref());
                let mut list: Vec<String> = episodes.iter().map(|episode| format!("`{episode}`")).collect();
                if count > episodes.len() {
                    list.push(format!("{} more", count - episodes.len()));
                }
                let message = format!("`{shown}` could be any of {count} occurrences: {}", list.join(", "));
                let problem = Diagnostic::error(Code::AmbiguousLabel, name.span, message)
                    .primary("which one is meant?")
                    .help(tell_apart(&name, &apart));
                places.into_iter().fold(problem, |problem, (span, episode)| {
                    problem.label(span, format!("`{}`", clip(&episode)))
                })
            }
        }
    }
}

fn called(problem: Diagnostic, call: Span) -> Diagnostic {
    problem.label(call, "with the arguments of this call")
}

fn tell_apart(name: &Name, apart: &Apart) -> String {
    let short = clip(&name.name);
    match apart {
        Apart::Arguments(first) => {
            format!("Say which one by its arguments: `{}`.", written(&name.name, Some(first)))
        }
        Apart::ArgumentOfLabel => format!(
            "Tell them apart by an argument, as in `(label ({short} i) ...)`, or put the `between` into the program that gives the label."
        ),
        Apart::Label => format!(
            "Give the one you mean a name, `(label x ({short} ...))`, and write `x` here. In a `dotimes` the name has an argument: `(label (x i) ({short} ...))`."
        ),
    }
}

/// What there is of a name, by its arguments.
fn list(name: &str, arguments: &[Vec<ValueKind>]) -> String {
    let mut list: Vec<String> =
        arguments.iter().map(|arguments| format!("`{}`", written(name, Some(arguments)))).collect();
    if list.len() > MOST_TOLD {
        list.truncate(MOST_TOLD);
        list.push("others".to_string());
    }
    match list.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => list.concat(),
    }
}

/// As it would be written: `(confirm 0 1)`.
fn written(name: &str, arguments: Option<&[ValueKind]>) -> String {
    let parts: Vec<String> = arguments.unwrap_or_default().iter().map(source).collect();
    match parts.is_empty() {
        true => clip(name),
        false => clip(&format!("({name} {})", parts.join(" "))),
    }
}
