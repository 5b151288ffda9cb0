//! What is said about teams.

use kirk_network::{Bound, Delay};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::team::Problem;

impl From<Problem> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::NotTheSameMoment { join, event, agent, end, news, at } => {
                let (event, agent, end) = (clip(&event), clip(&agent), clip(&end));
                let message =
                    format!("`{event}` and `{end}` cannot be the same moment: {}", how_late(&agent, news));
                Diagnostic::error(Code::NotTheSameMoment, join, message)
                    .primary("joined here, without slack")
                    .label(at, "Nature decides when it ends")
                    .help("Write `(:slack t)`: then the one comes after the other, as soon as the news is there.")
            }
            Problem::Unreachable { constraint, agents } => {
                let [one, other] = agents.map(|agent| clip(&agent));
                let message = format!("`{one}` and `{other}` never hear of each other");
                Diagnostic::error(Code::Unreachable, constraint, message)
                    .primary("this constrains both of them")
                    .help(format!("Add a link to the team, to each other or over others: `(link {one} {other} :min-delay 5 :max-delay 15)`."))
            }
        }
    }
}

fn how_late(agent: &str, news: Option<Delay>) -> String {
    match news {
        None => format!("`{agent}` never hears of it"),
        Some(Delay { min, max: Bound::Infinite }) => {
            format!("the news takes at least {min} s to `{agent}`, and may be lost")
        }
        Some(Delay { min, max: Bound::Finite(max) }) if min == max => {
            format!("the news takes {min} s to `{agent}`")
        }
        Some(Delay { min, max: Bound::Finite(max) }) => {
            format!("the news takes {min} to {max} s to `{agent}`")
        }
    }
}
