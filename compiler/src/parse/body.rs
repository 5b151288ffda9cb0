//! What a program does: calls, `sequence`, `parallel`, `with-temporal-constraint`.

use super::amount::{amount, number};
use super::options::{flag, options};
use super::{ident, text_of, unexpected};
use crate::ast::{Body, Bounds, Call, Group, Value, ValueKind, Within};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::{did_you_mean, nearest};
use crate::problem::Problems;

/// The operators of bodies.
pub(crate) const OPERATORS: [&str; 3] = ["sequence", "parallel", "with-temporal-constraint"];

/// What the language has and kirk does not have yet.
pub(crate) const NOT_YET: [&str; 5] = ["let", "dotimes", "label", "between", "delay"];

/// Parses one body form; `None` if it makes no sense, which is reported.
pub(super) fn body(form: &Form, problems: &mut Problems) -> Option<Body> {
    let Some((first, rest)) = form.list().and_then(|items| items.split_first()) else {
        not_a_body(form, problems);
        return None;
    };
    match operator(first, rest, problems) {
        Some(word @ ("sequence" | "parallel")) => {
            let group = group(form, first, rest, problems);
            Some(if word == "sequence" { Body::Sequence(group) } else { Body::Parallel(group) })
        }
        Some("with-temporal-constraint") => Some(within(form, first, rest, problems)),
        Some(word) if NOT_YET.contains(&word) => {
            problems.push(
                Diagnostic::error(Code::NotYet, first.span, format!("kirk does not have `{word}` yet"))
                    .primary("part of the language, but not built yet")
                    .help(match word {
                        "let" => "Until then use `(defparameter *name* number)` or a parameter of the program.",
                        "dotimes" => "Until then write the repetitions out.",
                        "label" => "Until then each occurrence of a program is named by its place: `drive`, `drive#2`.",
                        "between" => "Until then put `with-temporal-constraint` around the activities in question.",
                        _ => "Until then define a primitive program with that duration and call it.",
                    }),
            );
            None
        }
        Some("declare") => {
            problems.push(
                Diagnostic::error(Code::WrongShape, first.span, "`declare` stands inside of a form")
                    .primary("not a body form")
                    .help("Declarations belong to the program itself, right after its parameter list."),
            );
            None
        }
        _ => match ident(first) {
            Some(program) => {
                let arguments = rest.iter().filter(|form| !form.is_error()).map(value).collect();
                Some(Body::Call(Call { program, arguments, span: form.span }))
            }
            None => {
                if !first.is_error() {
                    let help =
                        "A body form begins with an operator or with the name of a program: `(shower)`.";
                    problems.push(unexpected(first, "an operator or a program", help));
                }
                None
            }
        },
    }
}

/// The word a body form begins with. A call has no lists for arguments: with one, a name close to an operator is a slip.
fn operator<'a>(first: &'a Form, rest: &[Form], problems: &mut Problems) -> Option<&'a str> {
    let word = first.word()?;
    let known = OPERATORS.contains(&word) || NOT_YET.contains(&word) || word == "declare";
    if known || !rest.iter().any(|form| form.list().is_some()) {
        return Some(word);
    }
    let Some(meant) = nearest(word, OPERATORS) else { return Some(word) };
    problems.push(
        Diagnostic::error(
            Code::UnknownOperator,
            first.span,
            format!("there is no operator `{}`", clip(word)),
        )
        .primary("neither an operator nor a program")
        .help(format!("Did you mean `{meant}`?")),
    );
    Some(meant)
}

/// `(simple-temporal :lower-bound l :upper-bound u)`.
pub(super) fn bounds(form: &Form, word: &str, problems: &mut Problems) -> Option<Bounds> {
    match form.call() {
        Some((found, rest)) if found == word => {
            let [lower, upper] = options(rest, ["lower-bound", "upper-bound"], word, problems);
            let lower = lower.map(|form| amount(form, "the lower bound", problems));
            let upper = upper.map(|form| amount(form, "the upper bound", problems));
            Some(Bounds { lower, upper, span: form.span })
        }
        found => {
            if !form.is_error() {
                let problem = unexpected(
                    form,
                    &format!("`({word} ...)`"),
                    &format!(
                        "Write `({word} :lower-bound 5 :upper-bound 10)`; either bound may be left out."
                    ),
                );
                problems.push(problem.maybe_help(found.and_then(|(found, _)| did_you_mean(found, [word]))));
            }
            None
        }
    }
}

/// A value as an argument or in a class.
pub(super) fn value(form: &Form) -> Value {
    let kind = match &form.kind {
        FormKind::Number(text) => {
            number(text, 1_000_000).map_or_else(|_| ValueKind::Other(text.clone()), ValueKind::Number)
        }
        FormKind::String(text) => ValueKind::Text(text.clone()),
        FormKind::Keyword(name) => ValueKind::Symbol(format!(":{name}")),
        FormKind::Symbol(symbol) => match symbol.name.as_str() {
            "t" => ValueKind::True,
            "nil" => ValueKind::Nil,
            _ => ValueKind::Name(symbol.package.clone(), symbol.name.clone()),
        },
        FormKind::Quote(inner) => match &inner.kind {
            FormKind::Symbol(symbol) => ValueKind::Symbol(symbol.name.clone()),
            _ => value(inner).kind,
        },
        FormKind::List(items) if items.is_empty() => ValueKind::Nil,
        _ => ValueKind::Other(text_of(form)),
    };
    Value { kind, span: form.span }
}

fn group(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Group {
    let (slack, rest) = match rest.split_first() {
        Some((list, rest)) if is_option_list(list) => {
            let word = operator.word().unwrap_or_default();
            let [slack] = options(list.list().unwrap_or_default(), ["slack"], word, problems);
            (slack.is_some_and(|form| flag(form, "slack", problems)), rest)
        }
        Some((keyword, after)) if keyword.keyword().is_some() => {
            problems.push(
                Diagnostic::error(Code::WrongShape, keyword.span, "options stand in a list of their own")
                    .primary("parentheses are missing around this option")
                    .help(format!("Write `({} (:slack t) ...)`.", operator.word().unwrap_or("sequence"))),
            );
            (true, after.get(1..).unwrap_or_default())
        }
        _ => (false, rest),
    };
    let body = rest.iter().filter_map(|form| body(form, problems)).collect();
    Group { slack, body, operator: operator.span, span: form.span }
}

fn within(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Body {
    const SHAPE: &str = "Write `(with-temporal-constraint (simple-temporal :upper-bound 60) body...)`.";
    let mut limits = Bounds { lower: None, upper: None, span: operator.span };
    let mut rest = rest;
    match rest.split_first() {
        Some((first, after))
            if first.call().is_none_or(|(word, _)| {
                word.starts_with("simple") || after.len() == 1 && !OPERATORS.contains(&word)
            }) =>
        {
            match bounds(first, "simple-temporal", problems) {
                Some(found) if first.list().is_some_and(|items| items.len() == 1) => {
                    problems.push(
                        Diagnostic::warning(Code::NoBounds, first.span, "this constraint allows everything")
                            .primary("neither a lower nor an upper bound")
                            .help(SHAPE),
                    );
                    limits = found;
                }
                Some(found) => limits = found,
                None => {}
            }
            rest = after;
        }
        _ => problems.push(
            Diagnostic::error(
                Code::WrongShape,
                operator.span,
                "`with-temporal-constraint` has no constraint",
            )
            .primary("`(simple-temporal ...)` was expected after this")
            .help(SHAPE),
        ),
    }
    if rest.is_empty() {
        problems.push(
            Diagnostic::error(
                Code::WrongShape,
                operator.span,
                "`with-temporal-constraint` has nothing to constrain",
            )
            .primary("a body was expected after the constraint")
            .help(SHAPE),
        );
    }
    let body = rest.iter().filter_map(|form| body(form, problems)).collect();
    Body::WithTemporalConstraint(Within { bounds: limits, body, operator: operator.span, span: form.span })
}

/// True for `()` and lists that begin with a keyword.
fn is_option_list(form: &Form) -> bool {
    form.list().is_some_and(|items| items.first().is_none_or(|first| first.keyword().is_some()))
}

fn not_a_body(form: &Form, problems: &mut Problems) {
    if form.is_error() {
        return;
    }
    let problem =
        unexpected(form, "a body form", "A body form is a list: `(sequence (:slack t) ...)` or a call.");
    problems.push(match form.symbol() {
        Some(symbol) => {
            problem.help(format!("To call the program `{0}`, write `({0})`.", clip(&symbol.name)))
        }
        None => problem,
    });
}
