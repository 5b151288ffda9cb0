//! Why a network is not controllable, as a diagnostic and as JSON.

use kirk_compiler::repair::Changed;
use kirk_compiler::{Explain, Origin, OriginKind, Side, Span, StoryStep, Told};
use kirk_network::assume::Assumption;
use kirk_network::{Bound, Conflict, Duration, EventId, Network, Part};
use serde::Serialize;

use crate::input::Loaded;
use crate::report::{Reporter, SpanJson};

/// All there is to say about a "no", in the source: every conflict of a network, which is as assumed. `first` is one of them.
pub(crate) fn told(
    first: &Conflict,
    network: &Network,
    input: &Loaded,
    (assumption, theory): (Assumption, bool),
) -> Vec<Told> {
    let Some(origins) = input.origins() else { return Vec::new() };
    let (sources, program) = (&input.sources, input.program_span());
    let explain = Explain { network, origins, sources, program, theory };
    match assumption {
        // What is elongated is judged otherwise than any network that could be asked about.
        Assumption::Elongated => vec![explain.one(first)],
        _ => explain.each().unwrap_or_default(),
    }
}

/// A conflict with all there is to say about it.
#[derive(Serialize)]
pub(crate) struct ConflictJson<'a> {
    pub(crate) members: Vec<MemberJson>,
    /// How much is missing, as a negative amount.
    total: Duration,
    conservative: bool,
    story: Vec<StepJson<'a>>,
    enough: Option<Vec<ChangedJson<'a>>>,
}

/// One step of a story.
#[derive(Serialize)]
struct StepJson<'a> {
    kind: &'static str,
    times: u32,
    needs: Duration,
    text: &'a str,
}

/// One change of the source.
#[derive(Serialize)]
pub(crate) struct ChangedJson<'a> {
    what: String,
    title: String,
    #[serde(flatten)]
    place: SpotJson<'a>,
    from: Option<Bound>,
    to: Option<Bound>,
    applicable: bool,
}

/// Where something is written.
#[derive(Serialize)]
pub(crate) struct SpotJson<'a> {
    file: Option<&'a str>,
    span: Option<SpanJson>,
}

impl<'a> SpotJson<'a> {
    pub(crate) fn new(span: Span, reporter: &'a Reporter<'_>) -> SpotJson<'a> {
        let there = reporter.span_json(span);
        SpotJson { file: there.is_some().then(|| reporter.name(span)), span: there }
    }
}

impl<'a> ChangedJson<'a> {
    pub(crate) fn new(change: &'a Changed, reporter: &'a Reporter<'_>) -> ChangedJson<'a> {
        ChangedJson {
            what: change.what(),
            title: change.title(),
            place: SpotJson::new(change.place, reporter),
            from: change.amounts().map(|(from, _)| from),
            to: change.amounts().map(|(_, to)| to),
            applicable: change.is_editable(),
        }
    }
}

impl<'a> ConflictJson<'a> {
    pub(crate) fn new(
        told: &'a Told,
        network: &Network,
        input: &Loaded,
        reporter: &'a Reporter<'_>,
    ) -> ConflictJson<'a> {
        let Told { conflict, story, enough, .. } = told;
        let step = |StoryStep { part, times, needs, text, .. }: &'a StoryStep| StepJson {
            kind: kind(*part),
            times: *times,
            needs: *needs,
            text,
        };
        let changed = |change: &'a Changed| ChangedJson::new(change, reporter);
        ConflictJson {
            members: members(conflict, network, input, reporter),
            total: conflict.total,
            conservative: conflict.conservative,
            story: story.iter().map(step).collect(),
            enough: enough.as_ref().map(|enough| enough.iter().map(changed).collect()),
        }
    }
}

/// Where a bound is written: of a program the form that says so, of a network file what says this very bound.
fn place(part: Part, origin: &Origin) -> Span {
    match (origin.kind, Side::of(part)) {
        (OriginKind::Requirement | OriginKind::Link, Some(side)) => origin.place(side),
        _ => origin.span,
    }
}

/// What a bound is called.
fn kind(part: Part) -> &'static str {
    match part {
        Part::RequirementUpper(_) => "requirement-upper",
        Part::RequirementLower(_) => "requirement-lower",
        Part::LinkLower(_) => "contingent-lower",
        Part::LinkUpper(_) => "contingent-upper",
        Part::DelayMin(_) => "delay-min",
        Part::DelayMax(_) => "delay-max",
        Part::AfterOrigin => "after-origin",
        Part::Join(_) => "join",
    }
}

/// The members of a conflict for programs.
pub(crate) fn members(
    conflict: &Conflict,
    network: &Network,
    input: &Loaded,
    reporter: &Reporter<'_>,
) -> Vec<MemberJson> {
    conflict
        .members
        .iter()
        .map(|share| {
            let label = |event: EventId| network.label(event).to_string();
            let ends = share.part.ends(network).map(|(from, to)| (label(from), label(to)));
            let index = share.part.requirement().or(share.part.link());
            let origin = input.origins().and_then(|origins| origins.constraint(share.part));
            let (from, to) = ends.unzip();
            MemberJson {
                kind: kind(share.part),
                index,
                from,
                to,
                bound: share.bound(network),
                times: share.times,
                amount: share.amount,
                text: origin.map_or("nothing happens before the origin".to_string(), Origin::text),
                span: origin.and_then(|origin| reporter.span_json(place(share.part, origin))),
            }
        })
        .collect()
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
