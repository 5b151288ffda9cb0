//! Labels without a name, and events as they are named elsewhere.

use crate::form::Form;
use crate::nearest::nearest;
use crate::parse::problem::{BodySlip, Expected, LabelSlip, Missing, Problem};
use crate::problem::Problems;

/// Reports what is no name.
pub(in crate::parse) fn bad_name(head: &Form, problems: &mut Problems) {
    if !head.is_error() {
        problems.push(Problem::Unexpected { found: head, expected: Expected::LabelName });
    }
}

/// A `between` that has not two events and a constraint.
pub(in crate::parse) fn no_between<'a>(operator: &'a Form, rest: &'a [Form]) -> Problem<'a> {
    let missing = |what| Problem::Missing { at: operator.span, what };
    match rest {
        [] => missing(Missing::Between),
        [_] => missing(Missing::SecondEvent),
        [_, _] => missing(Missing::ConstraintBetween),
        [_, _, given @ ..] if given[0].keyword().is_some() => Problem::Body(BodySlip::BareBounds { given }),
        [_, _, _, extra @ ..] => {
            Problem::Unexpected { found: extra.first().unwrap_or(operator), expected: Expected::EndOfBetween }
        }
    }
}

/// Reports what is no event.
pub(in crate::parse) fn no_event(form: &Form, problems: &mut Problems) {
    let slip = match form.list() {
        _ if form.is_error() => return,
        Some([first, what @ ..]) if matches!(first.word(), Some("start" | "end")) => match what {
            [what] if what.is_error() => return,
            [what] => {
                problems.push(Problem::Unexpected { found: what, expected: Expected::Occurrence });
                return;
            }
            _ => of_what(form, first.word().unwrap_or_default(), what),
        },
        Some([first, ..]) => first.word().map(|word| no_side(first, word)),
        None | Some([]) => no_list(form),
    };
    problems.push(match slip {
        Some(slip) => Problem::Label(slip),
        None => Problem::Unexpected { found: form, expected: Expected::Event },
    });
}

/// `(start)`, `(end a 1)`.
fn of_what<'a>(event: &'a Form, side: &'a str, what: &'a [Form]) -> Option<LabelSlip<'a>> {
    let (Some(first), Some(last)) = (what.first(), what.last()) else {
        return Some(LabelSlip::OfNothing { event: event.span, word: side });
    };
    let all = first.span.to(last.span);
    first.symbol().map(|symbol| LabelSlip::Arguments { event, side, name: &symbol.name, all })
}

/// `(begin a)`.
fn no_side<'a>(first: &Form, word: &'a str) -> LabelSlip<'a> {
    let near = match word {
        "begin" | "begins" | "from" | "starts" => Some("start"),
        "finish" | "stop" | "ends" | "until" => Some("end"),
        _ => nearest(word, ["start", "end"]),
    };
    LabelSlip::NoSide { at: first.span, word, near }
}

/// A name alone.
fn no_list(event: &Form) -> Option<LabelSlip<'_>> {
    let symbol = event.symbol()?;
    let (name, side) = match &symbol.package {
        // `drive:end`, as events are named elsewhere.
        Some(package) => (Some(package.as_str()), symbol.name.as_str()),
        None => symbol.name.split_once('-').map_or((None, ""), |(side, name)| (Some(name), side)),
    };
    Some(match name.filter(|_| matches!(side, "start" | "end")) {
        Some(name) => LabelSlip::Joined { event, side, name, outside: symbol.package.is_some() },
        None => LabelSlip::WhichSide { event, name: &symbol.name },
    })
}
