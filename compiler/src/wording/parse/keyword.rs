//! What is said about keywords and their values.

use super::{one_of, unexpected, wrong};
use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{Form, clip, text_of, write};
use crate::parse::problem::{KeywordSlip, Owner, Stray};

pub(super) fn told(slip: KeywordSlip) -> Diagnostic {
    match slip {
        KeywordSlip::NoColon { at, word } => wrong(
            at,
            format!("the colon of `:{word}` is missing"),
            "a keyword was expected",
            format!("Write `:{word}`: without the colon it is the name of something else."),
        )
        .change(at, format!(":{word}")),
        KeywordSlip::NoValue { at, word, flag } => {
            let example = if flag { "t" } else { "5" };
            let message = format!("`:{word}` has no value");
            let help = format!("Write `:{word} {example}`.");
            let problem = wrong(at, message, "a value was expected after this keyword", help);
            match flag {
                true => problem.change(at, format!(":{word} t")),
                false => problem,
            }
        }
        KeywordSlip::NoFlag { found, keyword, near } => {
            let wanted = format!("`t` or `nil` after `:{keyword}`");
            unexpected(found, &wanted, "`t` means yes and `nil` means no.").meant(found.span, near)
        }
        KeywordSlip::Unknown { at, word, owner, near, cures } => {
            let names: Vec<String> = near.iter().map(|name| format!(":{name}")).collect();
            let help = match near.is_empty() {
                false => format!("Did you mean `{}`?", names.join("` or `")),
                true => understood(owner),
            };
            let message = format!("`{}` has no keyword `:{}`", owner.word, clip(word));
            let problem = Diagnostic::error(Code::UnknownKeyword, at, message)
                .primary("not understood here")
                .help(help);
            cures.iter().fold(problem, |problem, name| problem.change(at, format!(":{name}")))
        }
        KeywordSlip::NoKeyword { found, owner, is } => no_keyword(found, owner, is),
    }
}

fn no_keyword(found: &Form, owner: Owner, is: Stray) -> Diagnostic {
    let problem = unexpected(found, &format!("a keyword of `{}`", owner.word), &understood(owner));
    match is {
        Stray::Other => problem,
        Stray::Unit { number, unit } => {
            let written = format!("({unit} {})", write(number));
            problem
                .help(format!("A unit stands before its number: `{}`.", clip(&written)))
                .change(number.span.to(found.span), written)
        }
        Stray::Call => problem.help("Is a `)` missing before it?"),
        Stray::Bound(bound) => problem
            .help(format!("`:{bound}` is missing before it: `:{bound} {}`.", text_of(found)))
            .suggest(format!("Add `:{bound}` before it"), [Edit::before(found.span, format!(":{bound} "))]),
        Stray::Bounds { bounds: [lower, upper], all } => {
            let bounds = format!(":lower-bound {} :upper-bound {}", write(lower), write(upper));
            let problem =
                problem.help(format!("Every bound has its keyword: `({} {})`.", owner.word, clip(&bounds)));
            match all {
                Some(all) => problem.change(all, bounds),
                None => problem,
            }
        }
    }
}

/// The keywords to write. `simple` knows `:contingent` only to say that it belongs to `duration`.
fn understood(owner: Owner) -> String {
    let wanted = owner.known.iter().filter(|word| owner.word != "simple" || **word != "contingent");
    format!("`{}` understands {}.", owner.word, one_of(wanted.map(|word| format!(":{word}"))))
}
