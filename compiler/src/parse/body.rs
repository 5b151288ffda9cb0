//! What a program does: calls, `sequence`, `parallel`, `with-temporal-constraint`, `delay`.

use super::amount::{amount, is_calculation, number};
use super::options::{flag, options};
use super::{binding, head, ident, label, text_of, unexpected};
use crate::ast::{Argument, Body, Bounds, Call, Group, Value, ValueKind, Wait, Within};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;

/// The operators of bodies.
pub(crate) const OPERATORS: [&str; 9] = [
    "sequence",
    "parallel",
    "with-temporal-constraint",
    "delay",
    "let",
    "let*",
    "dotimes",
    "label",
    "between",
];

/// Parses the forms of a body.
pub(super) fn bodies(forms: &[Form], problems: &mut Problems) -> Vec<Body> {
    let mut found = Vec::new();
    let mut rest = forms.iter().peekable();
    while let Some(form) = rest.next() {
        if form.keyword().is_some() {
            // Its value belongs to the same slip.
            rest.next_if(|next| next.list().is_none());
        }
        // `shower()` and `drive(5)`, as calls are written elsewhere.
        let arguments = rest.next_if(|next| {
            let is_call = |items: &[Form]| items.first().is_some_and(|first| first.symbol().is_some());
            form.symbol().is_some() && next.list().is_some_and(|items| !is_call(items))
        });
        match arguments {
            Some(arguments) => call_elsewhere(form, arguments, problems),
            None => found.extend(body(form, problems)),
        }
    }
    found
}

#[inline(never)]
fn call_elsewhere(name: &Form, arguments: &Form, problems: &mut Problems) {
    let inside = match arguments.list() {
        Some([_, ..]) => format!("({} ...)", text_of(name)),
        _ => format!("({})", text_of(name)),
    };
    let problem = unexpected(
        name,
        "a body form",
        &format!("The name of what is called stands inside the parentheses: `{inside}`."),
    );
    problems.push(Diagnostic { span: name.span.to(arguments.span), ..problem });
}

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
        Some("delay") => delay(form, first, rest, problems),
        Some(word @ ("let" | "let*")) => binding::binding(form, first, rest, word == "let*", problems),
        Some("dotimes") => binding::dotimes(form, first, rest, problems),
        Some("label") => label::label(form, first, rest, problems),
        Some("between") => label::between(form, first, rest, problems),
        Some("declare") => {
            misplaced_declaration(first, problems);
            None
        }
        _ => call(form, first, rest, problems),
    }
}

#[inline(never)]
fn misplaced_declaration(word: &Form, problems: &mut Problems) {
    problems.push(
        Diagnostic::error(Code::WrongShape, word.span, "`declare` stands inside of a form")
            .primary("not a body form")
            .help("Declarations belong to the program itself, right after its parameter list."),
    );
}

#[inline(never)]
fn call(form: &Form, first: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    match ident(first) {
        Some(program) => {
            let arguments = arguments(rest, problems);
            Some(Body::Call(Call { program, arguments, span: form.span }))
        }
        None => {
            if !first.is_error() {
                let help = match (&first.kind, rest) {
                    (FormKind::List(_), []) => {
                        format!("There is a pair of parentheses too many: write `{}`.", text_of(first))
                    }
                    (FormKind::List(_), _) => {
                        "To do several things, write `(sequence (:slack t) ...)` around them.".to_string()
                    }
                    (FormKind::Keyword(name), _) if name == "slack" => {
                        "Options stand before the body: `(sequence (:slack t) ...)`.".to_string()
                    }
                    (FormKind::String(text), _) => {
                        format!("Names have no quotation marks: `({} ...)`.", clip(text))
                    }
                    _ => "A body form begins with an operator or with the name of a program: `(shower)`."
                        .to_string(),
                };
                problems.push(unexpected(first, "an operator or a program", &help));
            }
            None
        }
    }
}

/// The word a body form begins with. A call has no lists for arguments, except to
/// calculate: with one, a name close to an operator is a slip.
#[inline(never)]
fn operator<'a>(first: &'a Form, rest: &[Form], problems: &mut Problems) -> Option<&'a str> {
    let word = first.word()?;
    let takes_lists = rest.iter().any(|form| form.list().is_some() && !is_calculation(form));
    if OPERATORS.contains(&word) || word == "declare" || !takes_lists {
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
        .meant(first.span, Some(meant)),
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
                let near = found.and_then(|(found, _)| nearest(found, [word]));
                problems.push(problem.meant(head(form), near));
            }
            None
        }
    }
}

/// The arguments of a call or of a label.
pub(super) fn arguments(forms: &[Form], problems: &mut Problems) -> Vec<Argument> {
    forms.iter().filter(|form| !form.is_error()).map(|form| argument(form, problems)).collect()
}

/// An argument: a number to calculate, or a value.
pub(super) fn argument(form: &Form, problems: &mut Problems) -> Argument {
    match is_calculation(form) {
        true => Argument::Amount(amount(form, "this argument", problems)),
        false => Argument::Value(value(form)),
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

#[inline(never)]
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
    let body = bodies(rest, problems);
    Group { slack, body, operator: operator.span, span: form.span }
}

#[inline(never)]
fn within(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Body {
    const SHAPE: &str = "Write `(with-temporal-constraint (simple-temporal :upper-bound 60) body...)`.";
    let mut limits = Bounds { lower: None, upper: None, span: operator.span };
    let mut rest = rest;
    let slipped = rest.first().and_then(Form::call).is_some_and(|(_, inside)| {
        inside.last().is_some_and(|last| last.list().is_some() && !is_calculation(last))
    });
    match rest.split_first() {
        Some((first, _)) if first.keyword().is_some() => {
            let given = keywords(rest);
            problems.push(unwrapped(first, &rest[..given]));
            let [lower, upper] =
                options(&rest[..given], ["lower-bound", "upper-bound"], "simple-temporal", problems);
            limits.lower = lower.map(|form| amount(form, "the lower bound", problems));
            limits.upper = upper.map(|form| amount(form, "the upper bound", problems));
            rest = &rest[given..];
        }
        Some((_, [body @ .., last]))
            if last.call().is_some_and(|(word, _)| word == "simple-temporal")
                && rest[0].call().is_some_and(|(word, _)| !word.starts_with("simple")) =>
        {
            problems.push(
                Diagnostic::error(Code::WrongShape, last.span, "the constraint stands after the body")
                    .primary("`(simple-temporal ...)` comes first")
                    .help(SHAPE),
            );
            limits = bounds(last, "simple-temporal", problems).unwrap_or(limits);
            rest = &rest[..=body.len()];
        }
        Some((first, after))
            if first.call().is_none_or(|(word, _)| {
                word.starts_with("simple") || after.len() == 1 && !OPERATORS.contains(&word)
            }) =>
        {
            if let Some(found) = bounds(first, "simple-temporal", problems) {
                warn_of_no_bounds(first, SHAPE, problems);
                limits = found;
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
    // A body that stands inside of the constraint has been reported.
    if rest.is_empty() && !slipped {
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
    let body = bodies(rest, problems);
    Body::WithTemporalConstraint(Within { bounds: limits, body, operator: operator.span, span: form.span })
}

/// How many of the forms are keywords with their values.
pub(super) fn keywords(forms: &[Form]) -> usize {
    let pairs = forms.chunks(2).take_while(|pair| pair[0].keyword().is_some()).count();
    (2 * pairs).min(forms.len())
}

/// Bounds without the form they belong in.
pub(super) fn unwrapped(first: &Form, given: &[Form]) -> Diagnostic {
    let words: Vec<String> = given.iter().map(text_of).collect();
    let problem = Diagnostic::error(Code::WrongShape, first.span, "the bounds stand in a form of their own");
    problem
        .primary("`(simple-temporal` was expected before this")
        .help(format!("Write `(simple-temporal {})`.", clip(&words.join(" "))))
}

/// Says that `(simple-temporal)` means nothing.
pub(super) fn warn_of_no_bounds(form: &Form, shape: &str, problems: &mut Problems) {
    if form.list().is_some_and(|items| items.len() == 1) {
        problems.push(
            Diagnostic::warning(Code::NoBounds, form.span, "this constraint allows everything")
                .primary("neither a lower nor an upper bound")
                .help(shape),
        );
    }
}

#[inline(never)]
fn delay(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    const SHAPE: &str =
        "Write `(delay 5 10)`: a wait of 5 to 10 s. `(delay 5 :infinity)` is a wait of at least 5 s.";
    let (lower, upper) = match rest {
        [limits] if limits.call().is_some_and(|(word, _)| word.starts_with("simple")) => {
            let message = "the bounds of a delay stand in it as plain numbers";
            let problem = Diagnostic::error(Code::WrongShape, limits.span, message);
            problems.push(problem.primary("not understood in a `delay`").help(SHAPE));
            return None;
        }
        [both] if both.keyword().is_none() => (both, both),
        [lower, upper] if lower.keyword().is_none() => (lower, upper),
        _ => {
            let message = match rest.first() {
                None => "this delay is empty".to_string(),
                Some(first) if first.keyword().is_some() => {
                    "the bounds of a delay have no keywords".to_string()
                }
                Some(_) => format!("a delay has two bounds, not {}", rest.len()),
            };
            let problem = Diagnostic::error(Code::WrongShape, operator.span, message);
            problems.push(problem.primary("in this form").help(SHAPE));
            return None;
        }
    };
    let lower = amount(lower, "the shortest wait", problems);
    let upper = amount(upper, "the longest wait", problems);
    let bounds = Bounds { lower: Some(lower), upper: Some(upper), span: form.span };
    Some(Body::Delay(Wait { bounds, span: form.span }))
}

/// True for `()`, lists that begin with a keyword, and `(slack t)`, whose colon is missing.
fn is_option_list(form: &Form) -> bool {
    form.list().is_some_and(|items| match items {
        [first, value] if first.word() == Some("slack") => matches!(value.word(), Some("t" | "nil")),
        items => items.first().is_none_or(|first| first.keyword().is_some()),
    })
}

fn not_a_body(form: &Form, problems: &mut Problems) {
    if form.is_error() {
        return;
    }
    let problem =
        unexpected(form, "a body form", "A body form is a list: `(sequence (:slack t) ...)` or a call.");
    problems.push(match &form.kind {
        FormKind::Symbol(symbol) => {
            problem.help(format!("To call the program `{0}`, write `({0})`.", clip(&symbol.name)))
        }
        FormKind::Quote(inner) => problem.help(format!("Take the quote out: `{}`.", text_of(inner))),
        FormKind::Keyword(_) => {
            problem.help("A keyword belongs to the list before it: is there a `)` too early?")
        }
        _ => problem,
    });
}
