//! Body forms as they are written elsewhere, operators misspelt, options and constraints in the wrong place.

use super::{around, bare, text_of, unexpected};
use crate::ast::Bounds;
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::parse::amount::{amount, is_calculation};
use crate::parse::body::{LIMITS, bounds, is_constraint, limits};
use crate::parse::options::pairs;
use crate::problem::Problems;
use crate::source::Span;
use crate::words::{Position, usage};

/// How `with-temporal-constraint` is written.
pub(in crate::parse) const WITHIN: &str = usage("with-temporal-constraint");
const DELAY: &str = usage("delay");

/// Reports what is no list, with what belongs to it; the forms after that.
pub(in crate::parse) fn no_body<'a>(form: &Form, rest: &'a [Form], problems: &mut Problems) -> &'a [Form] {
    let is_call = |items: &[Form]| items.first().is_some_and(|first| first.symbol().is_some());
    match rest.split_first() {
        // The value of a keyword belongs to the same slip.
        Some((value, after)) if form.keyword().is_some() && value.list().is_none() => {
            problems.push(no_list(form));
            after
        }
        // `shower()` and `drive(5)`, as calls are written elsewhere.
        Some((arguments, after))
            if form.symbol().is_some() && arguments.list().is_some_and(|items| !is_call(items)) =>
        {
            problems.push(call_elsewhere(form, arguments));
            after
        }
        _ => {
            if !form.is_error() {
                problems.push(no_list(form));
            }
            rest
        }
    }
}

fn no_list(form: &Form) -> Diagnostic {
    let problem =
        unexpected(form, "a body form", "A body form is a list: `(sequence (:slack t) ...)` or a call.");
    match &form.kind {
        FormKind::Symbol(symbol) => problem
            .help(format!("To call the program `{0}`, write `({0})`.", clip(&symbol.name)))
            .change(form.span, format!("({})", write(form))),
        FormKind::Quote(inner) => problem
            .help(format!("Take the quote out: `{}`.", text_of(inner)))
            .suggest("Take the quote out", bare(form)),
        FormKind::Keyword(_) => {
            problem.help("A keyword belongs to the list before it: is there a `)` too early?")
        }
        _ => problem,
    }
}

fn call_elsewhere(name: &Form, arguments: &Form) -> Diagnostic {
    let inside = match arguments.list() {
        Some([_, ..]) => format!("({} ...)", text_of(name)),
        _ => format!("({})", text_of(name)),
    };
    let span = name.span.to(arguments.span);
    let values = arguments.list().unwrap_or_default().iter().map(|value| format!(" {}", write(value)));
    let call = format!("({}{})", write(name), values.collect::<String>());
    let help = format!("The name of what is called stands inside the parentheses: `{inside}`.");
    let problem = unexpected(name, "a body form", &help).change(span, call);
    Diagnostic { span, ..problem }
}

/// A word that is no operator, but close to one, with forms that a call does not have: a call has no lists for
/// arguments, except to calculate.
#[inline(never)]
pub(in crate::parse) fn misspelt(
    first: &Form,
    rest: &[Form],
    problems: &mut Problems,
) -> Option<&'static str> {
    let word = first.word()?;
    let takes_lists = rest.iter().any(|form| form.list().is_some() && !is_calculation(form));
    let meant = nearest(word, Position::Body.names()).filter(|_| takes_lists && word != "declare")?;
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

/// Reports a form that begins neither with an operator nor with a name.
#[inline(never)]
pub(in crate::parse) fn no_call(form: &Form, first: &Form, rest: &[Form], problems: &mut Problems) {
    let unknown = |help: &str| unexpected(first, "an operator or a program", help);
    problems.push(match (&first.kind, rest) {
        (FormKind::Error, _) => return,
        (FormKind::Symbol(_), _) => {
            Diagnostic::error(Code::WrongShape, first.span, "`declare` stands inside of a form")
                .primary("not a body form")
                .help("Declarations belong to the program itself, right after its parameter list.")
        }
        (FormKind::List(_), []) => {
            let edges =
                [Span { end: first.span.start, ..form.span }, Span { start: first.span.end, ..form.span }];
            unknown(&format!("There is a pair of parentheses too many: write `{}`.", text_of(first)))
                .suggest("Take the outer parentheses out", edges.map(|edge| Edit::replace(edge, "")))
        }
        (FormKind::List(_), _) => {
            unknown("To do several things, write `(sequence (:slack t) ...)` around them.").suggest(
                "Write `sequence (:slack t)` before them",
                [Edit::before(first.span, "sequence (:slack t) ")],
            )
        }
        (FormKind::Keyword(name), _) if name == "slack" => {
            unknown("Options stand before the body: `(sequence (:slack t) ...)`.")
        }
        (FormKind::String(text), _) => {
            let problem = unknown(&format!("Names have no quotation marks: `({} ...)`.", clip(text)));
            match bare(first) {
                Some(edit) => problem.suggest("Take the quotation marks out", [edit]),
                None => problem,
            }
        }
        _ => unknown("A body form begins with an operator or with the name of a program: `(shower)`."),
    });
}

/// True for `(slack t)`, whose colon is missing.
pub(in crate::parse) fn is_option_list(form: &Form) -> bool {
    form.list().is_some_and(|items| {
        matches!(items, [first, value] if first.word() == Some("slack") && matches!(value.word(), Some("t" | "nil")))
    })
}

/// Reports options without their list; the forms after them.
pub(in crate::parse) fn bare_options<'a>(
    operator: &Form,
    rest: &'a [Form],
    problems: &mut Problems,
) -> &'a [Form] {
    let last = rest.get(1).filter(|value| value.list().is_none()).unwrap_or(&rest[0]);
    problems.push(
        Diagnostic::error(Code::WrongShape, rest[0].span, "options stand in a list of their own")
            .primary("parentheses are missing around this option")
            .help(format!("Write `({} (:slack t) ...)`.", operator.word().unwrap_or("sequence")))
            .suggest("Put parentheses around it", around(&rest[0], last, "(", ")")),
    );
    rest.get(2..).unwrap_or_default()
}

/// Reports what is wrong with the constraint and the body of a `with-temporal-constraint`; what of them is clear.
pub(in crate::parse) fn within<'a>(
    operator: &Form,
    rest: &'a [Form],
    problems: &mut Problems,
) -> (Option<Bounds>, &'a [Form]) {
    let slipped = rest.first().and_then(Form::call).is_some_and(|(_, inside)| {
        inside.last().is_some_and(|last| last.list().is_some() && !is_calculation(last))
    });
    let (found, rest) = constraint(operator, rest, problems);
    // A body that stands inside of the constraint has been reported.
    if rest.is_empty() && !slipped {
        problems.push(
            Diagnostic::error(
                Code::WrongShape,
                operator.span,
                "`with-temporal-constraint` has nothing to constrain",
            )
            .primary("a body was expected after the constraint")
            .help(WITHIN),
        );
    }
    (found, rest)
}

fn constraint<'a>(
    operator: &Form,
    rest: &'a [Form],
    problems: &mut Problems,
) -> (Option<Bounds>, &'a [Form]) {
    match rest.split_first() {
        Some((first, _)) if first.keyword().is_some() => {
            let (given, body) = rest.split_at(keywords(rest));
            problems.push(unwrapped(given));
            (Some(limits(given, operator.span, problems)), body)
        }
        Some((first, [body @ .., last]))
            if is_constraint(last) && first.call().is_some_and(|(word, _)| !word.starts_with("simple")) =>
        {
            let problem =
                Diagnostic::error(Code::WrongShape, last.span, "the constraint stands after the body")
                    .primary("`(simple-temporal ...)` comes first")
                    .help(WITHIN);
            problems.push(match body {
                [] => problem.suggest(
                    "Put the constraint first",
                    [Edit::copy(first.span, last.span), Edit::copy(last.span, first.span)],
                ),
                _ => problem,
            });
            (bounds(last, problems), &rest[..=body.len()])
        }
        Some((first, after))
            if first.call().is_none_or(|(word, _)| {
                word.starts_with("simple") || after.len() == 1 && !Position::Body.has(word)
            }) =>
        {
            (bounds(first, problems), after)
        }
        _ => {
            problems.push(
                Diagnostic::error(
                    Code::WrongShape,
                    operator.span,
                    "`with-temporal-constraint` has no constraint",
                )
                .primary("`(simple-temporal ...)` was expected after this")
                .help(WITHIN),
            );
            (None, rest)
        }
    }
}

/// How many of the forms are keywords with their values.
pub(super) fn keywords(forms: &[Form]) -> usize {
    let pairs = forms.chunks(2).take_while(|pair| pair[0].keyword().is_some()).count();
    (2 * pairs).min(forms.len())
}

/// Bounds without the form they belong in.
pub(super) fn unwrapped(given: &[Form]) -> Diagnostic {
    let words: Vec<String> = given.iter().map(text_of).collect();
    Diagnostic::error(Code::WrongShape, given[0].span, "the bounds stand in a form of their own")
        .primary("`(simple-temporal` was expected before this")
        .help(format!("Write `(simple-temporal {})`.", clip(&words.join(" "))))
        .suggest(
            "Put them into `(simple-temporal ...)`",
            around(&given[0], &given[given.len() - 1], "(simple-temporal ", ")"),
        )
}

/// Reports what is no `(simple-temporal ...)`.
pub(in crate::parse) fn no_constraint(form: &Form, problems: &mut Problems) {
    if form.is_error() {
        return;
    }
    let near = form.call().and_then(|(found, _)| nearest(found, ["simple-temporal"]));
    problems.push(
        unexpected(form, "`(simple-temporal ...)`", usage("simple-temporal")).meant(super::head(form), near),
    );
}

/// Reports what is wrong with a `delay`.
pub(in crate::parse) fn no_delay(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) {
    let problem = |message: &str| {
        Diagnostic::error(Code::WrongShape, operator.span, message).primary("in this form").help(DELAY)
    };
    let written = |limits: &Bounded| format!("(delay {} {})", limits.0, limits.1);
    problems.push(match rest {
        [] => problem("this delay is empty"),
        [limits] if limits.call().is_some_and(|(word, _)| word.starts_with("simple")) => {
            let message = "the bounds of a delay stand in it as plain numbers";
            let problem = Diagnostic::error(Code::WrongShape, limits.span, message)
                .primary("not understood in a `delay`")
                .help(DELAY);
            let given = limits.call().and_then(|(_, given)| bounded(given));
            given.iter().fold(problem, |problem, given| problem.change(form.span, written(given)))
        }
        [first, ..] if first.keyword().is_some() => {
            let problem = problem("the bounds of a delay have no keywords");
            bounded(rest).iter().fold(problem, |problem, given| problem.change(form.span, written(given)))
        }
        [both] => match super::amount::range(both) {
            Some(problem) => problem,
            None => {
                amount(both, "the shortest wait", problems);
                return;
            }
        },
        _ => problem(&format!("a delay has two bounds, not {}", rest.len())),
    });
}

/// The bounds of a wait, as text.
type Bounded = (String, String);

/// The bounds given by keywords, if nothing else is.
fn bounded(given: &[Form]) -> Option<Bounded> {
    let [lower, upper] = pairs(given, LIMITS)?;
    let lower = lower.map_or("0".to_string(), write);
    Some((lower, upper.map_or(":infinity".to_string(), write)))
}
