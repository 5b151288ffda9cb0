//! Why a network is not controllable, as a diagnostic and as JSON.

use kirk_compiler::total;
use kirk_compiler::{Code, Diagnostic, Span, explain_conflict};
use kirk_network::json::Seconds;
use kirk_network::{Conflict, Duration, Network, Part, Share};
use serde::Serialize;

use crate::input::Input;
use crate::report::{Reporter, SpanJson};

/// The diagnostic of a "no": in the source if there is one, else in terms of the network file.
pub(crate) fn diagnostic(conflict: &Conflict, network: &Network, input: &Input) -> Diagnostic {
    match input.origins() {
        Some((origins, program)) => explain_conflict(conflict, network, origins, *program),
        None => {
            let message = format!(
                "`{}` cannot be executed in every case: these bounds do not go together",
                network.name()
            );
            let place = |part: Part| {
                let place = input.places().and_then(|places| places.of(part))?;
                Some(Span::new(0, place.start, place.end))
            };
            let mut told = conflict.members.iter().filter_map(|share| Some((place(share.part)?, share)));
            // The message points at the first of them, and the others are beside it.
            let (span, primary) = told
                .next()
                .map_or((Span::default(), String::new()), |(span, share)| (span, sentence(share, network)));
            let mut help = format!("The time they leave: {} < 0.", total(conflict));
            if conflict.conservative {
                help.push_str(
                    " This rests on a chain of links with late news, where kirk is careful: there might be a way.",
                );
            }
            let problem = Diagnostic::error(Code::NotControllable, span, message).primary(primary).help(help);
            told.fold(problem, |problem, (span, share)| problem.label(span, sentence(share, network)))
        }
    }
}

fn sentence(share: &Share, network: &Network) -> String {
    let bound = share.bound(network);
    let ends = |index: usize| {
        let requirement = network.requirements()[index];
        (network.label(requirement.from), network.label(requirement.to))
    };
    let link = |index: usize| network.label(network.contingents()[index].to);
    let text = match share.part {
        Part::RequirementUpper(index) => {
            let (from, to) = ends(index);
            format!("requirements[{index}]: `{to}` at most {bound} s after `{from}`")
        }
        Part::RequirementLower(index) => {
            let (from, to) = ends(index);
            format!("requirements[{index}]: `{to}` at least {bound} s after `{from}`")
        }
        Part::LinkLower(index) => {
            format!("contingents[{index}]: `{}` may happen after only {bound} s", link(index))
        }
        Part::LinkUpper(index) => {
            format!("contingents[{index}]: `{}` may happen after as much as {bound} s", link(index))
        }
        Part::DelayMin(index) => {
            format!("contingents[{index}]: news of `{}` may be only {bound} s late", link(index))
        }
        Part::DelayMax(index) => {
            format!("contingents[{index}]: news of `{}` may be {bound} s late", link(index))
        }
        Part::AfterOrigin => "nothing happens before the origin".to_string(),
        Part::Join(index) => {
            let (from, to) = ends(index);
            format!("requirements[{index}]: `{from}` and `{to}` are one event")
        }
    };
    let times = if share.times > 1 { format!(" ({} times)", share.times) } else { String::new() };
    let sign = if share.amount < Duration::ZERO { "" } else { "+" };
    format!("{text}{times}: {sign}{}", share.amount)
}

/// The members of a conflict for programs.
pub(crate) fn to_json(
    conflict: &Conflict,
    network: &Network,
    input: &Input,
    reporter: &Reporter<'_>,
) -> Vec<MemberJson> {
    conflict
        .members
        .iter()
        .map(|share| {
            let (kind, ends, index) = match share.part {
                Part::RequirementUpper(index) => {
                    ("requirement-upper", requirement_ends(network, index), Some(index))
                }
                Part::RequirementLower(index) => {
                    ("requirement-lower", requirement_ends(network, index), Some(index))
                }
                Part::LinkLower(index) => ("contingent-lower", link_ends(network, index), Some(index)),
                Part::LinkUpper(index) => ("contingent-upper", link_ends(network, index), Some(index)),
                Part::DelayMin(index) => ("delay-min", link_ends(network, index), Some(index)),
                Part::DelayMax(index) => ("delay-max", link_ends(network, index), Some(index)),
                Part::AfterOrigin => ("after-origin", None, None),
                Part::Join(index) => ("join", requirement_ends(network, index), Some(index)),
            };
            let origin = input.origins().and_then(|(origins, _)| match share.part {
                Part::RequirementUpper(index) | Part::RequirementLower(index) | Part::Join(index) => {
                    origins.requirements.get(index)
                }
                Part::AfterOrigin => None,
                Part::LinkLower(index)
                | Part::LinkUpper(index)
                | Part::DelayMin(index)
                | Part::DelayMax(index) => origins.contingents.get(index),
            });
            let (from, to) = ends.unzip();
            MemberJson {
                kind,
                index,
                from,
                to,
                bound: Seconds(share.bound(network)),
                times: share.times,
                amount: Seconds(share.amount),
                text: origin.map_or_else(|| sentence(share, network), |origin| origin.text.clone()),
                span: origin.and_then(|origin| reporter.span_json(origin.span)),
            }
        })
        .collect()
}

fn requirement_ends(network: &Network, index: usize) -> Option<(String, String)> {
    let requirement = network.requirements()[index];
    Some((network.label(requirement.from).to_string(), network.label(requirement.to).to_string()))
}

fn link_ends(network: &Network, index: usize) -> Option<(String, String)> {
    let link = network.contingents()[index];
    Some((network.label(link.from).to_string(), network.label(link.to).to_string()))
}

/// One member; the amounts of all add up to a negative number.
#[derive(Serialize)]
pub(crate) struct MemberJson {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    index: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<String>,
    bound: Seconds,
    times: u32,
    amount: Seconds,
    text: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    span: Option<SpanJson>,
}
