//! What is said about declarations.

use super::{around, last_byte, one_of, unexpected, wrong};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, clip, text_of, write};
use crate::parse::problem::DeclarationSlip;
use crate::source::Span;
use crate::words::{Position, usage};

pub(super) const DURATION: &str = usage("duration");

pub(super) fn told(slip: DeclarationSlip) -> Diagnostic {
    match slip {
        DeclarationSlip::Unknown { at, word, near } => {
            let message = format!("`{}` is not a declaration kirk knows", clip(word));
            Diagnostic::error(Code::UnknownDeclaration, at, message)
                .primary("not understood here")
                .help(format!("The declarations are {}.", one_of(Position::Declaration.names())))
                .meant(at, near)
        }
        DeclarationSlip::NoList { found, word } => {
            let example = match word {
                Some("primitive") | None => "(primitive)".to_string(),
                Some(word) => format!("({word} ...)"),
            };
            let problem =
                unexpected(found, "a declaration", &format!("A declaration is a list: `{example}`."));
            match word {
                Some("primitive") => problem.change(found.span, example),
                _ => problem,
            }
        }
        DeclarationSlip::Bare { first, all } => {
            let problem = wrong(
                first,
                "this declaration stands outside of `(declare ...)`",
                "in this form",
                "Write `(declare (primitive) (duration (simple ...)))` after the parameter list.",
            );
            around(problem, "Put `(declare ...)` around it", Some(all), ["(declare ", ")"])
        }
        DeclarationSlip::Conditions { at, word } => wrong(
            at,
            format!("`{word}` takes one condition"),
            "in this form",
            "Several conditions are joined by `(and ... ...)`.",
        ),
        DeclarationSlip::SecondConditions { at, word } => {
            Diagnostic::error(Code::KeywordTwice, at, format!("`{word}` is given twice"))
                .primary("again here")
                .help("Put the conditions into one: `(and ... ...)`.")
        }
        DeclarationSlip::FallenOut { keyword, meant, value, from } => fallen_out(keyword, meant, value, from),
        DeclarationSlip::TooFarIn { keyword, value, simple } => {
            let both = keyword.to(value.span);
            wrong(
                both,
                "`:contingent` belongs to `duration`, not to `simple`",
                "a parenthesis too far in",
                "Write `(duration (simple ...) :contingent t)`.",
            )
            .suggest(
                "Move it out of `simple`",
                [Edit::replace(both, ""), Edit::after(simple, format!(" :contingent {}", write(value)))],
            )
        }
        DeclarationSlip::ClosedEarly { keyword, word, simple, last } => {
            let problem = wrong(
                keyword,
                format!("`:{word}` belongs to `simple`, which is closed before it"),
                "a parenthesis too far out",
                "Write `(duration (simple :lower-bound 15 :upper-bound 20) :contingent t)`.",
            )
            .label(last_byte(simple), "`simple` already ends here");
            let Some(last) = last else { return problem };
            problem.suggest(
                "Close `simple` after it",
                [Edit::replace(last_byte(simple), ""), Edit::after(last, ")")],
            )
        }
        DeclarationSlip::NoSimple { found, near } => {
            unexpected(found, "`(simple ...)`", DURATION).meant(found.head(), near)
        }
        DeclarationSlip::BareNumbers { found, bounds: [lower, upper], all } => {
            let written = format!("(simple :lower-bound {} :upper-bound {})", write(lower), write(upper));
            let help = format!("Write `(duration {})`.", clip(&written));
            let problem = unexpected(found, "`(simple ...)`", &help);
            match all {
                Some(all) => problem.change(all, written),
                None => problem,
            }
        }
        DeclarationSlip::BareBounds { first, rest, last } => bare_bounds(first, rest, last),
    }
}

fn fallen_out(keyword: Span, meant: &str, value: Option<&Form>, from: Option<(Span, Span)>) -> Diagnostic {
    let (owner, help) = match meant {
        "contingent" => ("duration", "Write `(duration (simple ...) :contingent t)`.".to_string()),
        _ => ("simple", format!("Write `(duration (simple ... :{meant} 5))`.")),
    };
    let message = format!("`:{meant}` belongs to `{owner}`, which is closed before it");
    let problem = wrong(keyword, message, "a parenthesis too far out", help);
    let Some((duration, home)) = from else { return problem };
    let problem = problem.label(last_byte(duration), "the duration already ends here");
    let Some(value) = value else { return problem };
    problem.suggest(
        format!("Move it into `{owner}`"),
        [
            Edit::before(last_byte(home), format!(" :{meant} {}", write(value))),
            Edit::replace(keyword.to(value.span), ""),
        ],
    )
}

/// `(duration simple :lower-bound 1 ...)` or `(duration :lower-bound 1 ...)`.
fn bare_bounds(first: &Form, rest: &[Form], last: Option<Span>) -> Diagnostic {
    let bounds: Vec<String> = rest.iter().map(text_of).collect();
    let (keyword, opening) = match first.keyword() {
        Some(_) => (text_of(first) + " ", "(simple "),
        None => (String::new(), "("),
    };
    let problem = wrong(
        first.span,
        "the bounds of a duration stand in a form of their own",
        "`(simple` was expected here, and a `)` after the bounds",
        format!(
            "Write `(duration (simple {keyword}{}))`; `:contingent t` comes after that form.",
            clip(&bounds.join(" "))
        ),
    );
    let all = last.map(|last| first.span.to(last));
    around(problem, "Put the bounds into `(simple ...)`", all, [opening, ")"])
}
