//! Why no promises were found: the cuts that no promise keeps, added up so that the promises cancel. What is left are bounds and
//! delays of the author's, with a negative sum; and which link would have to be faster.

use std::collections::BTreeMap;

use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Delay, Duration, Part, Share};

use crate::cuts::Blame;
use crate::distances::Step;
use crate::find::{Options, is_found};
use crate::model::{AgentId, Link, Team};
use crate::search::{Failure, Finder};
use crate::views::{Numbered, Told};
use crate::whole::Whole;

/// What is missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotFound {
    /// How much is missing, at least a microsecond; `None` if the search came to no end that says so.
    pub lacks: Option<Duration>,
    /// What that is the sum of.
    pub members: Vec<Member>,
}

/// One bound or delay in what is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Which.
    pub what: Cause,
    /// How many times.
    pub times: i64,
}

/// A bound or a delay of the author's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// A bound of the team's network.
    Part(Part),
    /// The longest delay of a link, by its number.
    Longest(u32),
    /// The shortest delay of a link, by its number.
    Shortest(u32),
}

/// What would do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remedy {
    /// The link, by its number.
    pub link: usize,
    /// How it would have to be.
    pub change: Change,
}

/// Another link in the place of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Messages take at most so long. With a microsecond more nothing is found.
    Within(Duration),
    /// Messages say when they were told.
    Stamped,
}

pub(crate) fn shortage(finder: &Finder<'_>, failure: &Failure) -> NotFound {
    let mut times: BTreeMap<Cause, i64> = BTreeMap::new();
    let mut total = 0_i128;
    for (cut, factor) in &failure.core {
        total += i128::from(*factor) * i128::from(cut.constant);
        for (cause, by) in behind(finder, failure, &cut.blame) {
            *times.entry(cause).or_default() += by * factor;
        }
    }
    let is_known = failure.core.iter().any(|(_, factor)| *factor != 0);
    let lacks = i64::try_from(-total).unwrap_or(i64::MAX).max(1);
    times.retain(|_, times| *times != 0);
    NotFound {
        lacks: is_known.then(|| Duration::from_micros(lacks)),
        members: times.into_iter().map(|(what, times)| Member { what, times }).collect(),
    }
}

/// What a cut rests on that is the author's, and how many times.
fn behind(finder: &Finder<'_>, failure: &Failure, blame: &Blame) -> Vec<(Cause, i64)> {
    let (team, whole) = (finder.team, finder.whole);
    match blame {
        Blame::Order => Vec::new(),
        Blame::Window(promise) => {
            let cause = |step: Step| match step {
                Step::Side(side) => side_causes(whole, side),
                Step::LinkUpper(link) => vec![Cause::Part(Part::LinkUpper(link as usize))],
                Step::LinkLower(link) => vec![Cause::Part(Part::LinkLower(link as usize))],
                Step::AfterOrigin => Vec::new(),
            };
            let steps = finder.why(failure.promises[*promise]);
            steps.into_iter().flat_map(cause).map(|cause| (cause, 1)).collect()
        }
        Blame::View(agent, conflict) => {
            let view = &failure.views[agent.index()];
            let of = |share: &Share| {
                let times = i64::from(share.times);
                causes(team, whole, view, *agent, share.part).into_iter().map(move |cause| (cause, times))
            };
            conflict.members.iter().flat_map(of).collect()
        }
    }
}

/// The bounds of the team's network that a side of the whole is made of.
fn side_causes(whole: &Whole, side: u32) -> Vec<Cause> {
    let original = |part: &Part| match *part {
        Part::RequirementUpper(index) => Part::RequirementUpper(whole.merged.requirement_of[index]),
        Part::RequirementLower(index) => Part::RequirementLower(whole.merged.requirement_of[index]),
        other => other,
    };
    let parts = whole.sides[side as usize].parts.iter().filter(|part| **part != Part::AfterOrigin);
    parts.map(|part| Cause::Part(original(part))).collect()
}

/// The author's bounds and delays behind a part of a conflict of a view; none behind a promise.
fn causes(team: &Team, whole: &Whole, view: &Numbered, agent: AgentId, part: Part) -> Vec<Cause> {
    let nature = |link: usize, part: fn(usize) -> Part| match view.told[link] {
        Told::Nature(link) => vec![Cause::Part(part(link as usize))],
        Told::Promise(_) => Vec::new(),
    };
    let links = |link: usize, which: usize, cause: fn(u32) -> Cause| {
        let event = view.event_of(view.network.contingents()[link].to);
        let ways = whole.owner[event.index()].map(|owner| team.reach().ways(team.arcs(), owner, agent));
        let way = ways.map_or(Vec::new(), |ways| ways[which].clone());
        way.into_iter().map(move |arc| cause(team.arcs()[arc as usize].link))
    };
    match part {
        Part::RequirementUpper(_) | Part::RequirementLower(_) => {
            view.side_of(part).map_or(Vec::new(), |side| side_causes(whole, side))
        }
        Part::LinkLower(link) => nature(link, Part::LinkLower),
        Part::LinkUpper(link) => nature(link, Part::LinkUpper),
        Part::DelayMax(link) => {
            nature(link, Part::DelayMax).into_iter().chain(links(link, 0, Cause::Longest)).collect()
        }
        Part::DelayMin(link) => {
            nature(link, Part::DelayMin).into_iter().chain(links(link, 1, Cause::Shortest)).collect()
        }
        Part::AfterOrigin | Part::Join(_) => Vec::new(),
    }
}

/// The links that would do if they were other than they are, each alone. It takes dozens of searches.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn remedies(team: &Team, missing: &NotFound, options: &Options) -> Result<Vec<Remedy>, TooLarge> {
    let mut remedies = Vec::new();
    let lacks = missing.lacks.map_or(1, Duration::as_micros);
    for (number, link) in team.links().iter().enumerate() {
        let cause = Cause::Longest(number as u32);
        let uses = missing.members.iter().find(|member| member.what == cause).map_or(1, |it| it.times.max(1));
        let hint = link.delay.max.finite().map(|max| max.as_micros() - (lacks + uses - 1) / uses);
        if let Some(within) = slowest(team, number, hint, options)? {
            remedies.push(Remedy { link: number, change: Change::Within(Duration::from_micros(within)) });
        }
        if !link.stamped {
            let stamped = Link { stamped: true, ..link.clone() };
            let stamped = team.with_link(number, stamped);
            if stamped.map_or(Ok(false), |team| is_found(&team, options))? {
                remedies.push(Remedy { link: number, change: Change::Stamped });
            }
        }
    }
    Ok(remedies)
}

/// The longest a message may take over a link for promises to be found, in microseconds; `None` if even none is too long.
fn slowest(
    team: &Team,
    number: usize,
    hint: Option<i64>,
    options: &Options,
) -> Result<Option<i64>, TooLarge> {
    let link = &team.links()[number];
    let is_enough = |max: i64| {
        let max = Duration::from_micros(max);
        let delay = Delay { min: link.delay.min.min(max), max: Bound::Finite(max) };
        let faster = team.with_link(number, Link { delay, ..link.clone() });
        faster.map_or(Ok(false), |team| is_found(&team, options))
    };
    if let Some(hint) = hint.filter(|hint| *hint >= 0)
        && is_enough(hint)?
        && !is_enough(hint + 1)?
    {
        return Ok(Some(hint));
    }
    if !is_enough(0)? {
        return Ok(None);
    }
    let (mut yes, mut step) = (0, 1_000_000);
    let mut no = link.delay.max.finite().map(Duration::as_micros);
    // Without an end: double until it is too much.
    while no.is_none() && step < Duration::MAX.as_micros() / 2 {
        if is_enough(step)? {
            (yes, step) = (step, 2 * step);
        } else {
            no = Some(step);
        }
    }
    let Some(mut no) = no else { return Ok(Some(yes)) };
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        *(if is_enough(middle)? { &mut yes } else { &mut no }) = middle;
    }
    Ok(Some(yes))
}
