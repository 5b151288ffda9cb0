//! Why a network is not controllable, as a diagnostic and as JSON.

use kirk_compiler::{Diagnostic, Explain};
use kirk_network::{Conflict, Duration, Network, Part};
use serde::Serialize;

use crate::input::Input;
use crate::report::{Reporter, SpanJson};

/// The diagnostics of a "no", in the source: one for every conflict.
pub(crate) fn diagnostics(network: &Network, input: &Input, theory: bool) -> Vec<Diagnostic> {
    let Some(origins) = input.origins() else { return Vec::new() };
    let (sources, program) = (&input.sources, input.program_span());
    Explain { network, origins, sources, program, theory }.all().unwrap_or_default()
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
            let origin = input.origins().and_then(|origins| origins.constraint(share.part));
            let (from, to) = ends.unzip();
            MemberJson {
                kind,
                index,
                from,
                to,
                bound: share.bound(network),
                times: share.times,
                amount: share.amount,
                text: origin.map_or("nothing happens before the origin".to_string(), |it| it.text.clone()),
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
    bound: Duration,
    times: u32,
    amount: Duration,
    text: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    span: Option<SpanJson>,
}
