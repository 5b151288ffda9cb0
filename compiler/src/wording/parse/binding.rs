//! What is said about `let` and `dotimes`.

use super::{around, unexpected, wrong};
use crate::diagnostic::{Diagnostic, Edit};
use crate::parse::problem::BindingSlip;
use crate::words::usage;

pub(super) const LET: &str = usage("let");
pub(super) const DOTIMES: &str = usage("dotimes");

const AROUND: &str = "Put parentheses around them";

pub(super) fn told(slip: BindingSlip) -> Diagnostic {
    match slip {
        BindingSlip::BarePair { name, both } => {
            let message = "every name of a `let` stands in a list of its own";
            let problem = wrong(name, message, "parentheses are missing around this name and its value", LET);
            around(problem, AROUND, both, ["(", ")"])
        }
        BindingSlip::NoNames { found, both } => {
            around(unexpected(found, "a list of names and values", LET), AROUND, both, ["((", "))"])
        }
        BindingSlip::CountFirst { head, swapped } => {
            let problem = unexpected(head, "a name before the number of repetitions", DOTIMES);
            match swapped {
                Some([count, variable]) => problem.suggest(
                    "Put the name first",
                    [Edit::copy(count, variable), Edit::copy(variable, count)],
                ),
                None => problem,
            }
        }
        BindingSlip::NoCount { head, both } => {
            around(unexpected(head, "`(name count)`", DOTIMES), AROUND, both, ["(", ")"])
        }
    }
}
