//! What is said about body forms.

use super::{around, plain_name, unexpected, wrong};
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, text_of, write};
use crate::parse::problem::BodySlip;
use crate::source::Span;
use crate::words::usage;

pub(super) const WITHIN: &str = usage("with-temporal-constraint");
pub(super) const DELAY: &str = usage("delay");

pub(super) fn told(slip: BodySlip) -> Diagnostic {
    let no_call = |found: &Form, help: &str| unexpected(found, "an operator or a program", help);
    match slip {
        BodySlip::NoList { found } => no_list(found),
        BodySlip::CallElsewhere { name, arguments } => call_elsewhere(name, arguments),
        BodySlip::Declare { at } => wrong(
            at,
            "`declare` stands inside of a form",
            "not a body form",
            "Declarations belong to the program itself, right after its parameter list.",
        ),
        BodySlip::Parentheses { form, inner } => {
            let edges = [Span { end: inner.span.start, ..form }, Span { start: inner.span.end, ..form }];
            no_call(inner, &format!("There is a pair of parentheses too many: write `{}`.", text_of(inner)))
                .suggest("Take the outer parentheses out", edges.map(|edge| Edit::replace(edge, "")))
        }
        BodySlip::NoSequence { first } => {
            no_call(first, "To do several things, write `(sequence (:slack t) ...)` around them.").suggest(
                "Write `sequence (:slack t)` before them",
                [Edit::before(first.span, "sequence (:slack t) ")],
            )
        }
        BodySlip::Options { found } => {
            no_call(found, "Options stand before the body: `(sequence (:slack t) ...)`.")
        }
        BodySlip::Quoted { found, name } => plain_name(
            no_call(found, &format!("Names have no quotation marks: `({} ...)`.", clip(name))),
            found,
            "Take the quotation marks out",
        ),
        BodySlip::NoCall { found } => {
            no_call(found, "A body form begins with an operator or with the name of a program: `(shower)`.")
        }
        BodySlip::BareOptions { keyword, all, operator } => {
            let problem = wrong(
                keyword,
                "options stand in a list of their own",
                "parentheses are missing around this option",
                format!("Write `({operator} (:slack t) ...)`."),
            );
            around(problem, "Put parentheses around it", Some(all), ["(", ")"])
        }
        BodySlip::ConstraintLast { constraint, body } => {
            let message = "the constraint stands after the body";
            let problem = wrong(constraint, message, "`(simple-temporal ...)` comes first", WITHIN);
            match body {
                Some(body) => problem.suggest(
                    "Put the constraint first",
                    [Edit::copy(body, constraint), Edit::copy(constraint, body)],
                ),
                None => problem,
            }
        }
        BodySlip::BareBounds { given } => bare_bounds(given),
        BodySlip::NoConstraint { found, near } => {
            const SHAPE: &str = usage("simple-temporal");
            unexpected(found, "`(simple-temporal ...)`", SHAPE).meant(found.head(), near)
        }
        BodySlip::WaitInForm { at, delay, bounds } => {
            let message = "the bounds of a delay stand in it as plain numbers";
            wait(wrong(at, message, "not understood in a `delay`", DELAY), delay, bounds)
        }
        BodySlip::WaitByKeywords { at, delay, bounds } => {
            wait(wrong(at, "the bounds of a delay have no keywords", "in this form", DELAY), delay, bounds)
        }
        BodySlip::WaitCount { at, given } => {
            wrong(at, format!("a delay has two bounds, not {given}"), "in this form", DELAY)
        }
    }
}

fn no_list(found: &Form) -> Diagnostic {
    let help = match &found.kind {
        FormKind::Symbol(symbol) => {
            format!("To call the program `{0}`, write `({0})`.", clip(&symbol.name))
        }
        FormKind::Quote(inner) => format!("Take the quote out: `{}`.", text_of(inner)),
        FormKind::Keyword(_) => {
            "A keyword belongs to the list before it: is there a `)` too early?".to_string()
        }
        _ => "A body form is a list: `(sequence (:slack t) ...)` or a call.".to_string(),
    };
    let problem = unexpected(found, "a body form", &help);
    match &found.kind {
        FormKind::Symbol(_) => problem.change(found.span, format!("({})", write(found))),
        FormKind::Quote(_) => plain_name(problem, found, "Take the quote out"),
        _ => problem,
    }
}

fn call_elsewhere(name: &Form, arguments: &Form) -> Diagnostic {
    let values = arguments.list().unwrap_or_default();
    let more = if values.is_empty() { "" } else { " ..." };
    let help =
        format!("The name of what is called stands inside the parentheses: `({}{more})`.", text_of(name));
    let span = name.span.to(arguments.span);
    let values: String = values.iter().map(|value| format!(" {}", write(value))).collect();
    let problem = unexpected(name, "a body form", &help).change(span, format!("({}{values})", write(name)));
    Diagnostic { span, ..problem }
}

fn bare_bounds(given: &[Form]) -> Diagnostic {
    let words: Vec<String> = given.iter().map(text_of).collect();
    let (first, last) = (given[0].span, given[given.len() - 1].span);
    let problem = wrong(
        first,
        "the bounds stand in a form of their own",
        "`(simple-temporal` was expected before this",
        format!("Write `(simple-temporal {})`.", clip(&words.join(" "))),
    );
    let title = "Put them into `(simple-temporal ...)`";
    around(problem, title, Some(first.to(last)), ["(simple-temporal ", ")"])
}

/// With the bounds of a wait as they are written, if that is clear.
fn wait(problem: Diagnostic, delay: Span, bounds: Option<[Option<&Form>; 2]>) -> Diagnostic {
    let Some([lower, upper]) = bounds else { return problem };
    let lower = lower.map_or("0".to_string(), write);
    let upper = upper.map_or(":infinity".to_string(), write);
    problem.change(delay, format!("(delay {lower} {upper})"))
}
