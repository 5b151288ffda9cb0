//! A conflict in the words and places of the program: why it cannot be executed in every case.

mod amounts;

use kirk_network::{Conflict, Duration, Network, Part, Share};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::lower::{EMPTY, Origin, OriginKind, Origins};
use crate::source::Span;

/// How origins speak of the joins of a `parallel`.
const PARALLEL: &str = "this `parallel`";
/// What the joins of a `parallel` come to where Nature has no say.
const JOINED: &str = "joined here: without slack, all parts start together and end together";

/// Another amount alone would not do, whatever it is.
const NOT_ALONE: &str = " No change of one amount alone is enough: several have to change, or what comes before what, or what is joined.";

/// What is found is one conflict, not all of them.
const AFTERWARDS: &str = "; another conflict may show then.";

/// Words a conflict. Its indices are those of `network`, which is the network of the plan, not merged.
pub fn explain_conflict(
    conflict: &Conflict,
    network: &Network,
    origins: &Origins,
    program: Span,
) -> Diagnostic {
    let name = network.name();
    let message = format!("`{name}` cannot be executed in every case: these bounds do not go together");
    let mut problem = Diagnostic::error(Code::NotControllable, program, message)
        .primary("there is no way to execute this that works whatever happens");
    let mut places: Vec<(Span, Vec<String>)> = Vec::new();
    for share in &conflict.members {
        let Some((span, text)) = say(share, network, origins) else { continue };
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
    for (span, texts) in places {
        problem = problem.label(span, texts.join("; "));
    }
    problem.help(advice(conflict, network, origins))
}

/// The sum, and what to change.
fn advice(conflict: &Conflict, network: &Network, origins: &Origins) -> String {
    let mut text = format!("The time they leave: {} < 0.", total(conflict));
    let has = |wanted: &dyn Fn(Part) -> bool| conflict.members.iter().any(|share| wanted(share.part));
    let late = has(&|part| matches!(part, Part::DelayMax(_)));
    let joined = has(&|part| match part {
        Part::RequirementUpper(index) | Part::RequirementLower(index) => {
            let ends = network.requirements().get(index);
            origins.requirements.get(index).is_some_and(|origin| origin.kind == OriginKind::Join)
                && ends.is_some_and(|r| network.link_of(r.from).is_some() || network.link_of(r.to).is_some())
        }
        _ => false,
    });
    let side_by_side = has(&|part| {
        matches!(part, Part::Join(index)
        if origins.requirements.get(index).is_some_and(|origin| origin.subject == PARALLEL))
    });
    let bounded = has(&|part| {
        matches!(part, Part::RequirementUpper(index)
        if origins.requirements.get(index).is_some_and(|origin| origin.kind != OriginKind::Join))
    });
    let amounts = amounts::enough_alone(conflict, network, origins);
    let mut advice = Vec::new();
    if bounded && amounts.is_none() {
        advice.push("a longer upper bound");
    }
    if joined {
        advice.push("slack (`:slack t`) where an end that Nature decides has to meet another event");
    }
    if side_by_side && !joined {
        advice.push("slack (`:slack t`) in the `parallel`");
    }
    if amounts.is_none() && has(&|part| matches!(part, Part::LinkUpper(_) | Part::LinkLower(_))) {
        advice.push("a narrower contingent duration");
    }
    if late && amounts.is_none() {
        advice.push("news that comes sooner");
    }
    match amounts.as_deref() {
        Some([]) => text.push_str(NOT_ALONE),
        Some([one]) => text.push_str(&format!(" This alone is enough: {one}.")),
        Some(several) => text.push_str(&format!(" Each of these alone is enough: {}.", several.join("; "))),
        None => {}
    }
    let takes = match amounts.as_deref() {
        Some([_, ..]) => "Or it takes",
        _ => "It would take",
    };
    let advice = match advice.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            format!(" {takes} {} or {last}{AFTERWARDS}", rest.join(", "))
        }
        Some((last, _)) => format!(" {takes} {last}{AFTERWARDS}"),
        None => String::new(),
    };
    text.push_str(&advice);
    if conflict.conservative {
        text.push_str(
            " This \"no\" rests on a chain of activities of which the first is heard late; a cleverer use of that news \
             might still find a way.",
        );
    }
    text
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
pub(crate) fn say(share: &Share, network: &Network, origins: &Origins) -> Option<(Span, String)> {
    if share.times == 0 && !matches!(share.part, Part::Join(_)) {
        return None;
    }
    let amount = match share.amount {
        amount if amount > Duration::ZERO => format!(": +{amount}"),
        amount if amount < Duration::ZERO => format!(": {amount}"),
        _ => String::new(),
    };
    let times = if share.times > 1 { format!(" ({} times)", share.times) } else { String::new() };
    let requirement =
        |index: usize| Some((network.requirements().get(index)?, origins.requirements.get(index)?));
    let contingent =
        |index: usize| Some((network.contingents().get(index)?, origins.contingents.get(index)?));
    let (span, text) = match share.part {
        Part::RequirementUpper(index) => {
            let (requirement, origin) = requirement(index)?;
            (place(origin, 1), upper(origin, requirement.upper.finite()?))
        }
        Part::RequirementLower(index) => {
            let (requirement, origin) = requirement(index)?;
            let by_nature =
                network.link_of(requirement.from).is_some() || network.link_of(requirement.to).is_some();
            if origin.kind == OriginKind::Order && !by_nature {
                return None;
            }
            (place(origin, 0), lower(origin, requirement.lower.finite()?))
        }
        Part::LinkLower(index) => {
            let (link, origin) = contingent(index)?;
            (origin.places[0], format!("Nature may take only {} s for {}", link.lower, origin.subject))
        }
        Part::LinkUpper(index) => {
            let (link, origin) = contingent(index)?;
            (origin.places[1], format!("Nature may take up to {} s for {}", link.upper, origin.subject))
        }
        Part::DelayMin(index) => {
            let (link, origin) = contingent(index)?;
            (
                origin.places[2],
                format!("the news of the end of {} may be only {} s late", origin.subject, link.delay.min),
            )
        }
        Part::DelayMax(index) => {
            let (link, origin) = contingent(index)?;
            let text = match link.delay.max.finite() {
                Some(max) => format!("the news of the end of {} may be {max} s late", origin.subject),
                None => format!("the end of {} may never be heard", origin.subject),
            };
            (origin.places[3], text)
        }
        // That one follows the other goes without saying; that they run side by side, or that nothing takes time, not.
        Part::Join(index) => {
            let (requirement, origin) = requirement(index)?;
            let by_nature =
                network.link_of(requirement.from).is_some() || network.link_of(requirement.to).is_some();
            match (origin.subject == PARALLEL, by_nature) {
                (true, true) => (origin.span, origin.text.clone()),
                (true, false) => (origin.span, JOINED.to_string()),
                (false, _) if origin.text.ends_with(EMPTY) => {
                    (origin.span, format!("joined here: {}", origin.text))
                }
                (false, _) => return None,
            }
        }
        Part::AfterOrigin => return None,
    };
    Some((span, format!("{text}{times}{amount}")))
}

fn place(origin: &Origin, which: usize) -> Span {
    match origin.kind {
        OriginKind::Join | OriginKind::Order => origin.span,
        _ => origin.places[which],
    }
}

fn upper(origin: &Origin, bound: Duration) -> String {
    match origin.kind {
        OriginKind::Constraint => format!("at most {bound} s from start to end of this"),
        OriginKind::Between => format!("at most {bound} s {}", origin.subject),
        OriginKind::Duration | OriginKind::Contingent => {
            format!("{} takes at most {bound} s", origin.subject)
        }
        OriginKind::Join | OriginKind::Order => origin.text.clone(),
    }
}

fn lower(origin: &Origin, bound: Duration) -> String {
    match origin.kind {
        OriginKind::Constraint => format!("at least {bound} s from start to end of this"),
        OriginKind::Between => format!("at least {bound} s {}", origin.subject),
        OriginKind::Duration | OriginKind::Contingent => {
            format!("{} takes at least {bound} s", origin.subject)
        }
        OriginKind::Join | OriginKind::Order => origin.text.clone(),
    }
}
