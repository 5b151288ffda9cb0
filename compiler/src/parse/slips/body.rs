//! Body forms as they are written elsewhere, operators misspelt, options and constraints in the wrong place.

use crate::ast::{Bounds, Limits, Role};
use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::parse::amount::{amount, is_calculation};
use crate::parse::body::{LIMITS, bounds, is_constraint, limits};
use crate::parse::options::pairs;
use crate::parse::problem::{BodySlip, Missing, Problem};
use crate::problem::Problems;
use crate::words::Position;

/// Reports what is no list, with what belongs to it; the forms after that.
pub(in crate::parse) fn no_body<'a>(form: &Form, rest: &'a [Form], problems: &mut Problems) -> &'a [Form] {
    let is_call = |items: &[Form]| items.first().is_some_and(|first| first.symbol().is_some());
    let (slip, rest) = match rest.split_first() {
        // The value of a keyword belongs to the same slip.
        Some((value, after)) if form.keyword().is_some() && value.list().is_none() => {
            (BodySlip::NoList { found: form }, after)
        }
        // `shower()` and `drive(5)`, as calls are written elsewhere.
        Some((arguments, after))
            if form.symbol().is_some() && arguments.list().is_some_and(|items| !is_call(items)) =>
        {
            (BodySlip::CallElsewhere { name: form, arguments }, after)
        }
        _ if form.is_error() => return rest,
        _ => (BodySlip::NoList { found: form }, rest),
    };
    problems.push(Problem::Body(slip));
    rest
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
    let near = nearest(word, Position::Body.names()).filter(|_| takes_lists && word != "declare")?;
    problems.push(Problem::UnknownOperator { at: first.span, word, near });
    Some(near)
}

/// Reports a form that begins neither with an operator nor with a name.
#[inline(never)]
pub(in crate::parse) fn no_call(form: &Form, first: &Form, rest: &[Form], problems: &mut Problems) {
    problems.push(Problem::Body(match (&first.kind, rest) {
        (FormKind::Error, _) => return,
        (FormKind::Symbol(_), _) => BodySlip::Declare { at: first.span },
        (FormKind::List(_), []) => BodySlip::Parentheses { form: form.span, inner: first },
        (FormKind::List(_), _) => BodySlip::NoSequence { first },
        (FormKind::Keyword(name), _) if name == "slack" => BodySlip::Options { found: first },
        (FormKind::String(name), _) => BodySlip::Quoted { found: first, name },
        _ => BodySlip::NoCall { found: first },
    }));
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
    let keyword = rest[0].span;
    let last = rest.get(1).filter(|value| value.list().is_none()).unwrap_or(&rest[0]);
    problems.push(Problem::Body(BodySlip::BareOptions {
        keyword,
        all: keyword.to(last.span),
        operator: operator.word().unwrap_or("sequence"),
    }));
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
        problems.push(Problem::Missing { at: operator.span, what: Missing::Constrained });
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
            problems.push(Problem::Body(BodySlip::BareBounds { given }));
            (Some(limits(given, operator.span, problems)), body)
        }
        Some((first, [body @ .., last]))
            if is_constraint(last) && first.call().is_some_and(|(word, _)| !word.starts_with("simple")) =>
        {
            let alone = body.is_empty().then_some(first.span);
            problems.push(Problem::Body(BodySlip::ConstraintLast { constraint: last.span, body: alone }));
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
            problems.push(Problem::Missing { at: operator.span, what: Missing::Constraint });
            (None, rest)
        }
    }
}

/// How many of the forms are keywords with their values.
fn keywords(forms: &[Form]) -> usize {
    let pairs = forms.chunks(2).take_while(|pair| pair[0].keyword().is_some()).count();
    (2 * pairs).min(forms.len())
}

/// Reports what is no `(simple-temporal ...)`.
pub(in crate::parse) fn no_constraint(form: &Form, problems: &mut Problems) {
    if form.is_error() {
        return;
    }
    let near = form.call().and_then(|(found, _)| nearest(found, ["simple-temporal"]));
    problems.push(Problem::Body(BodySlip::NoConstraint { found: form, near }));
}

/// Reports what is wrong with a `delay`.
pub(in crate::parse) fn no_delay(form: &Form, operator: &Form, rest: &[Form], problems: &mut Problems) {
    let (at, delay) = (operator.span, form.span);
    problems.push(match rest {
        [] => Problem::Missing { at, what: Missing::Wait },
        [limits] if limits.call().is_some_and(|(word, _)| word.starts_with("simple")) => {
            let bounds = limits.call().and_then(|(_, given)| pairs(given, LIMITS));
            Problem::Body(BodySlip::WaitInForm { at: limits.span, delay, bounds })
        }
        [first, ..] if first.keyword().is_some() => {
            Problem::Body(BodySlip::WaitByKeywords { at, delay, bounds: pairs(rest, LIMITS) })
        }
        [both] => {
            let role = Role::Lower(Limits::Wait);
            match super::amount::range(both) {
                Some(slip) => Problem::Number { form: both, role, slip },
                None => {
                    amount(both, role, problems);
                    return;
                }
            }
        }
        _ => Problem::Body(BodySlip::WaitCount { at, given: rest.len() }),
    });
}
