//! A conflict in the words and places of the program: why it cannot be executed in every case.

mod amounts;
mod story;

pub use story::Said;

use kirk_network::conflicts::{conflicts, without};
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Duration, Network, Part, Requirement, Share};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::lower::Lowered;
use crate::origins::{Origin, OriginKind, Origins, Side};
use crate::repair::{Changed, amount as amount_in};
use crate::source::{Source, Span};
use story::{lines, steps, wrapped};

/// What the joins of a `parallel` come to where Nature has no say.
const JOINED: &str = "joined here: without slack, all parts start together and end together";

/// Another amount alone would not do, whatever it is.
const NOT_ALONE: &str = "No change of one amount alone is enough: several have to change, or what comes before what, or what is \
     joined. `kirk repair` looks for that.";

/// Nothing is allowed too little here.
const CIRCLE: &str = "No one amount helps: what comes before what has to change. `kirk repair` tries which order could be left out.";

/// A "no" that a cleverer use of news might turn.
const CONSERVATIVE: &str = "This \"no\" rests on a chain of activities of which the first is heard late; a cleverer use of that news \
     might still find a way.";

/// How many conflicts are told; of more only how many there are.
const MOST: usize = 10;
/// How many are counted.
const COUNTED: usize = 100;
/// With more events than this a verdict takes its time.
const LARGE: usize = 1_000;

/// What is to be explained: a network that is not controllable, where it comes from, and how.
#[derive(Clone, Copy, Debug)]
pub struct Explain<'a> {
    /// The network of the plan, not merged.
    pub network: &'a Network,
    /// Where its constraints come from.
    pub origins: &'a Origins,
    /// The texts they point into.
    pub sources: &'a [Source],
    /// Where what is executed is named, if it is.
    pub program: Option<Span>,
    /// The signed sum as well.
    pub theory: bool,
}

/// A conflict, and all there is to say about it.
#[derive(Clone, Debug)]
pub struct Told {
    /// Its indices are those of the network that was explained.
    pub conflict: Conflict,
    /// In words and places.
    pub diagnostic: Diagnostic,
    /// Step by step, from event to event; nothing if the walk would be too long to tell anything.
    pub story: Vec<Said>,
    /// The changes of one amount each that settle it, each alone; `None` if the mission is too large to look for them.
    pub enough: Option<Vec<Changed>>,
}

impl<'a> Explain<'a> {
    /// Of a program that was compiled from these sources.
    pub fn of(lowered: &'a Lowered, sources: &'a [Source]) -> Explain<'a> {
        let Lowered { network, origins, entry } = lowered;
        Explain { network, origins, sources, program: Some(*entry), theory: false }
    }

    /// Every conflict that has no bound of ours in common with another, each with what would settle it; none if the network is
    /// controllable.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub fn each(&self) -> Result<Vec<Told>, TooLarge> {
        // Each costs a verdict: of large missions no more are looked for than are told.
        let counted = if self.network.events().len() > LARGE { MOST + 1 } else { COUNTED };
        let found = conflicts(self.network, counted)?;
        let told = found.len().min(MOST);
        let mut all = Vec::new();
        for (index, conflict) in found.iter().take(MOST).enumerate() {
            // What settles one is seen when the others are out of the way.
            let others = found.iter().enumerate().filter(|(other, _)| *other != index);
            let rest = without(self.network, others.map(|(_, other)| other));
            let enough = amounts::enough_alone(conflict, self.network, &rest, self.origins, self.sources);
            all.push(self.told(conflict, enough, found.len() > 1));
        }
        if found.len() > told {
            let more = found.len() - told;
            let least = if found.len() == counted { "at least " } else { "" };
            let text = format!("{least}{more} more conflicts are not shown.");
            if let Some(Told { diagnostic: last, .. }) = all.last_mut() {
                last.help = Some(last.help.take().map_or(text.clone(), |help| format!("{help}\n{text}")));
            }
        }
        Ok(all)
    }

    /// The same, of each no more than its diagnostic.
    ///
    /// # Errors
    /// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
    pub fn all(&self) -> Result<Vec<Diagnostic>, TooLarge> {
        Ok(self.each()?.into_iter().map(|told| told.diagnostic).collect())
    }

    /// One conflict of it, or of what it is under an assumption. Its indices are those of the network. What would settle it is not
    /// looked for.
    pub fn one(&self, conflict: &Conflict) -> Told {
        self.told(conflict, None, false)
    }

    /// Words a conflict that these changes settle, each alone.
    fn told(&self, conflict: &Conflict, enough: Option<Vec<Changed>>, is_one_of_several: bool) -> Told {
        let Explain { network, origins, sources, program, theory } = *self;
        let mut places: Vec<(Span, Vec<String>)> = Vec::new();
        for share in &conflict.members {
            let Some((span, text)) = say(share, network, origins, sources, theory) else { continue };
            // That the parts are joined goes without saying where it is said what is joined.
            if text == JOINED && places.iter().any(|(known, _)| *known == span) {
                continue;
            }
            match places.iter_mut().find(|(known, _)| *known == span) {
                Some((_, texts)) if !texts.contains(&text) => texts.push(text),
                Some(_) => {}
                None => places.push((span, vec![text])),
            }
        }
        let name = network.name();
        let message =
            format!("`{name}` cannot be executed in every case: {}", what_kind(conflict, network, origins));
        let mut told = places.into_iter().map(|(span, texts)| (span, texts.join("; ")));
        let everywhere = "there is no way to execute this that works whatever happens".to_string();
        // Where no program is named the message points at the first bound.
        let (span, primary) = match program {
            Some(span) => (span, everywhere),
            None => told.next().unwrap_or((Span::default(), everywhere)),
        };
        let problem = Diagnostic::error(Code::NotControllable, span, message).primary(primary);
        let problem = told.fold(problem, |problem, (span, text)| problem.label(span, text));
        let story = steps(conflict, network, origins, sources).unwrap_or_default();
        let mut help = lines(conflict, &story);
        if theory {
            help.extend(wrapped("", &format!("The time they leave: {} < 0.", total(conflict))));
        }
        help.extend(advice(conflict, network, origins, enough.as_deref(), is_one_of_several));
        if conflict.conservative {
            help.extend(wrapped("", CONSERVATIVE));
        }
        let suggestions = enough.iter().flatten().filter_map(Changed::suggestion).collect();
        let problem = Diagnostic { suggestions, ..problem };
        let diagnostic = if help.is_empty() { problem } else { problem.help(help.join("\n")) };
        Told { conflict: conflict.clone(), diagnostic, story, enough }
    }
}

/// What does not go together, for the headline.
fn what_kind(conflict: &Conflict, network: &Network, origins: &Origins) -> &'static str {
    let parts = || conflict.members.iter().map(|share| share.part);
    let of_ours = |part: Part| {
        let bound = part.bound(network) != Duration::ZERO || matches!(part, Part::RequirementUpper(_));
        let is_ours = matches!(part, Part::RequirementUpper(_) | Part::RequirementLower(_));
        bound && is_ours && origins.constraint(part).is_some_and(|origin| origin.kind.is_amount())
    };
    let is_joined = |part: Part| origins.constraint(part).is_some_and(|origin| origin.kind.is_join());
    if is_circle(conflict) {
        "these go round in a circle, each after the one before"
    } else if !parts().any(of_ours) && parts().any(is_joined) {
        "these ends cannot be made to meet"
    } else {
        "these bounds do not go together"
    }
}

/// True if every step leads on, and none back.
fn is_circle(conflict: &Conflict) -> bool {
    let leads_back = |part| {
        matches!(
            part,
            Part::RequirementUpper(_)
                | Part::LinkLower(_)
                | Part::DelayMin(_)
                | Part::Join(_)
                | Part::AfterOrigin
        )
    };
    !conflict.members.iter().any(|share| leads_back(share.part))
}

/// What would settle a conflict, in lines.
fn advice(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    enough: Option<&[Changed]>,
    is_one_of_several: bool,
) -> Vec<String> {
    let has = |wanted: &dyn Fn(Part) -> bool| conflict.members.iter().any(|share| wanted(share.part));
    let late = has(&|part| matches!(part, Part::DelayMax(_)));
    let is_of = |part: Part, is: &dyn Fn(OriginKind) -> bool| {
        origins.constraint(part).is_some_and(|origin| is(origin.kind))
    };
    let joined = has(&|part| match part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => {
            is_of(part, &OriginKind::is_join) && is_natures(network, network.requirements()[index])
        }
        _ => false,
    });
    let side_by_side =
        has(&|part| matches!(part, Part::Join(_)) && is_of(part, &|kind| kind == OriginKind::SideBySide));
    let bounded =
        has(&|part| matches!(part, Part::RequirementUpper(_)) && is_of(part, &|kind| !kind.is_join()));
    let mut other = Vec::new();
    if bounded && enough.is_none() {
        other.push("a longer upper bound");
    }
    if joined {
        other.push("slack (`:slack t`) where an end that Nature decides has to meet another event");
    }
    if side_by_side && !joined {
        other.push("slack (`:slack t`) in the `parallel`");
    }
    if enough.is_none() && has(&|part| matches!(part, Part::LinkUpper(_) | Part::LinkLower(_))) {
        other.push("a narrower contingent duration");
    }
    if late && enough.is_none() {
        other.push("news that comes sooner");
    }
    let mut lines = Vec::new();
    let settles = if is_one_of_several { "settles this conflict" } else { "is enough" };
    match enough {
        Some([]) if is_circle(conflict) => lines.extend(wrapped("", CIRCLE)),
        Some([]) => lines.extend(wrapped("", NOT_ALONE)),
        Some([one]) => lines.extend(wrapped("", &format!("This alone {settles}: {}.", one.title))),
        Some(several) => {
            lines.push(format!("Each of these alone {settles}:"));
            several.iter().for_each(|one| lines.extend(wrapped("- ", &one.title)));
        }
        None => {}
    }
    let takes = if enough.is_some_and(|enough| !enough.is_empty()) { "Or it takes" } else { "It would take" };
    if let Some((last, rest)) = other.split_last() {
        let list = if rest.is_empty() { last.to_string() } else { format!("{} or {last}", rest.join(", ")) };
        lines.extend(wrapped("", &format!("{takes} {list}.")));
    }
    lines
}

/// True if Nature decides when one of the events of a requirement is.
fn is_natures(network: &Network, Requirement { from, to, .. }: Requirement) -> bool {
    network.link_of(from).is_some() || network.link_of(to).is_some()
}

/// The amounts as a sum with its result: `20 - 10 - 15 = -5`.
pub fn total(conflict: &Conflict) -> String {
    let (sum, total) = (sum(&conflict.members), conflict.total.to_string());
    if sum == total { total } else { format!("{sum} = {total}") }
}

/// The amounts as a sum: `20 - 10 - 15`.
pub(crate) fn sum(members: &[Share]) -> String {
    let mut shares: Vec<&Share> = members.iter().filter(|share| share.amount != Duration::ZERO).collect();
    shares.sort_by_key(|share| share.amount < Duration::ZERO);
    let mut sum = String::new();
    for share in &shares {
        let magnitude = share.amount.abs();
        let sign = match (share.amount < Duration::ZERO, sum.is_empty()) {
            (true, true) => "-",
            (true, false) => " - ",
            (false, true) => "",
            (false, false) => " + ",
        };
        sum.push_str(&format!("{sign}{magnitude}"));
    }
    sum
}

/// What one part of the conflict says, and where. `None` for what a user need not know.
pub(crate) fn say(
    share: &Share,
    network: &Network,
    origins: &Origins,
    sources: &[Source],
    theory: bool,
) -> Option<(Span, String)> {
    if share.times == 0 && !matches!(share.part, Part::Join(_)) {
        return None;
    }
    let amount = match share.amount {
        amount if theory && amount > Duration::ZERO => format!(": +{amount}"),
        amount if theory && amount < Duration::ZERO => format!(": {amount}"),
        _ => String::new(),
    };
    let times = if share.times > 1 { format!(" ({} times)", share.times) } else { String::new() };
    let written =
        |value: Duration, origin: &Origin, side: Side| amount_in(value, origin.place(side), sources);
    let requirement =
        |index: usize| Some((network.requirements().get(index)?, origins.requirements.get(index)?));
    let contingent =
        |index: usize| Some((network.contingents().get(index)?, origins.contingents.get(index)?));
    let (span, text) = match share.part {
        Part::RequirementUpper(index) => {
            let (requirement, origin) = requirement(index)?;
            (
                place(origin, Side::Upper),
                limit(origin, "at most", &written(requirement.upper.finite()?, origin, Side::Upper)),
            )
        }
        Part::RequirementLower(index) => {
            let (requirement, origin) = requirement(index)?;
            let by_nature = is_natures(network, *requirement);
            if origin.kind == OriginKind::Order && !by_nature {
                return None;
            }
            (
                place(origin, Side::Lower),
                limit(origin, "at least", &written(requirement.lower.finite()?, origin, Side::Lower)),
            )
        }
        Part::LinkLower(index) => {
            let (link, origin) = contingent(index)?;
            (
                origin.place(Side::Lower),
                format!(
                    "Nature may take only {} {}",
                    written(link.lower, origin, Side::Lower),
                    origin.about()
                ),
            )
        }
        Part::LinkUpper(index) => {
            let (link, origin) = contingent(index)?;
            (
                origin.place(Side::Upper),
                format!(
                    "Nature may take up to {} {}",
                    written(link.upper, origin, Side::Upper),
                    origin.about()
                ),
            )
        }
        Part::DelayMin(index) => {
            let (link, origin) = contingent(index)?;
            (
                origin.place(Side::MinDelay),
                format!(
                    "the news of {} may be only {} late",
                    origin.end,
                    written(link.delay.min, origin, Side::MinDelay)
                ),
            )
        }
        Part::DelayMax(index) => {
            let (link, origin) = contingent(index)?;
            let text = match link.delay.max.finite() {
                Some(max) => {
                    format!("the news of {} may be {} late", origin.end, written(max, origin, Side::MaxDelay))
                }
                None => format!("{} may never be heard", origin.end),
            };
            (origin.place(Side::MaxDelay), text)
        }
        // That one follows the other goes without saying; that they run side by side, or that nothing takes time, not.
        Part::Join(index) => {
            let (requirement, origin) = requirement(index)?;
            let by_nature = is_natures(network, *requirement);
            match origin.kind {
                OriginKind::SideBySide if by_nature => (origin.span, origin.text.clone()),
                OriginKind::SideBySide => (origin.span, JOINED.to_string()),
                OriginKind::Empty => (origin.span, format!("joined here: {}", origin.text)),
                OriginKind::Between | OriginKind::Requirement => (origin.span, origin.text.clone()),
                _ => return None,
            }
        }
        Part::AfterOrigin => return None,
    };
    Some((span, format!("{text}{times}{amount}")))
}

fn place(origin: &Origin, side: Side) -> Span {
    if origin.kind.is_amount() { origin.place(side) } else { origin.span }
}

fn limit(origin: &Origin, word: &str, bound: &str) -> String {
    match origin.kind {
        OriginKind::Constraint => format!("{word} {bound} from start to end of this"),
        OriginKind::Between | OriginKind::Requirement | OriginKind::Link => {
            format!("{word} {bound} {}", origin.subject)
        }
        OriginKind::Duration | OriginKind::Contingent => format!("{} takes {word} {bound}", origin.subject),
        OriginKind::Join | OriginKind::SideBySide | OriginKind::Empty | OriginKind::Order => {
            origin.text.clone()
        }
    }
}
