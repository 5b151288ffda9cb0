//! What is said about conflicts: in one message, and step by step.

use kirk_network::stnu::TooLarge;
use kirk_network::walk::Step;
use kirk_network::{Bound, Conflict, Duration, Network, Part, Share};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::explain::amounts::Enough;
use crate::explain::problem::{Kind, Problem, Remedy, Says, Stated};
use crate::explain::{Explain, StoryStep};
use crate::origins::{Origin, OriginKind, Side};
use crate::repair::{Changed, Unit, amount};
use crate::source::{Source, Span};

/// No line is longer: with what a terminal shows before it, it fits 80 columns.
const WIDTH: usize = 74;
/// Of a longer story so many steps at its beginning and at its end are told, and of places where bounds are so many.
const SHOWN: usize = 12;

/// All there is to say about a conflict.
pub(crate) fn told(problem: &Problem<'_>) -> Diagnostic {
    let Explain { network, sources, program, theory, .. } = problem.explain;
    let what = match problem.kind {
        Kind::Circle => "these go round in a circle, each after the one before",
        Kind::Ends => "these ends cannot be made to meet",
        Kind::Bounds => "these bounds do not go together",
    };
    let message = format!("`{}` cannot be executed in every case: {what}", network.name());
    let mut places: Vec<(Span, Vec<String>)> = Vec::new();
    for bound in most_telling(&problem.bounds) {
        let text = stated(bound, sources, theory);
        match places.iter_mut().find(|(known, _)| *known == bound.span) {
            Some((_, texts)) if !texts.contains(&text) => texts.push(text),
            Some(_) => {}
            None => places.push((bound.span, vec![text])),
        }
    }
    let mut told = places.into_iter().map(|(span, texts)| (span, folded(&texts).join("; ")));
    let everywhere = "there is no way to execute this that works whatever happens".to_string();
    // Where no program is named the message points at the first bound.
    let (span, primary) = match program {
        Some(span) => (span, everywhere),
        None => told.next().unwrap_or((Span::default(), everywhere)),
    };
    let mut diagnostic = Diagnostic::error(Code::NotControllable, span, message).primary(primary);
    diagnostic = told.fold(diagnostic, |diagnostic, (span, text)| diagnostic.label(span, text));
    let changes = problem.enough.map(|enough| enough.changes.as_slice()).unwrap_or_default();
    diagnostic.suggestions = changes.iter().filter_map(Changed::suggestion).collect();
    let help = help(problem);
    if help.is_empty() { diagnostic } else { diagnostic.help(help.join("\n")) }
}

/// What is said where no verdict is to be had, as the durations add up to too much.
pub fn too_large(at: Span) -> Diagnostic {
    Diagnostic::error(Code::NumbersTooLarge, at, TooLarge.to_string())
}

/// Says that there are so many more conflicts than are told; `at_least`, if nobody counted further.
pub(crate) fn and_more(last: &mut Diagnostic, more: usize, at_least: bool) {
    let least = if at_least { "at least " } else { "" };
    let text = format!("{least}{more} more conflicts are not shown.");
    last.help = Some(last.help.take().map_or(text.clone(), |help| format!("{help}\n{text}")));
}

/// The bounds that are marked: where there are very many, what is allowed and then the largest that are needed.
fn most_telling<'a, 'b>(bounds: &'b [Stated<'a>]) -> Vec<&'b Stated<'a>> {
    let mut places: Vec<(Duration, Span)> = bounds.iter().map(|it| (-it.share.amount, it.span)).collect();
    let is_there = |place: &(Duration, Span)| place.0 < Duration::ZERO;
    places.sort_by_key(|place| (!is_there(place), -place.0, place.1));
    let mut marked: Vec<Span> = Vec::new();
    for (_, span) in places {
        if marked.len() < 2 * SHOWN && !marked.contains(&span) {
            marked.push(span);
        }
    }
    bounds.iter().filter(|it| marked.contains(&it.span)).collect()
}

/// Texts at one place; those that differ only in the repetition they are about, as one.
fn folded(texts: &[String]) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&String>)> = Vec::new();
    for text in texts {
        let whole = of_any(text);
        match groups.iter_mut().find(|(known, _)| *known == whole) {
            Some((_, group)) => group.push(text),
            None => groups.push((whole, vec![text])),
        }
    }
    let mut folded = Vec::new();
    for (_, group) in groups {
        match group[..] {
            [_, _, _, ..] => folded.push(several(group.len(), group[0])),
            _ => folded.extend(group.into_iter().cloned()),
        }
    }
    folded
}

/// The same text about so many repetitions.
pub(crate) fn several(times: usize, text: &str) -> String {
    format!("{times} times: {}", of_any(text))
}

/// A text with the numbers of repetitions left out: about `a` where it is about `a#3`.
pub(crate) fn of_any(text: &str) -> String {
    let mut parts = text.split('#');
    let mut whole = parts.next().unwrap_or_default().to_string();
    for part in parts {
        match part.trim_start_matches(|c: char| c.is_ascii_digit()) {
            rest if rest.len() < part.len() => whole.push_str(rest),
            _ => whole.extend(["#", part]),
        }
    }
    whole
}

/// The story, the sum, and what would settle it, in lines.
fn help(problem: &Problem<'_>) -> Vec<String> {
    let mut lines = story(problem);
    if problem.explain.theory {
        lines.extend(wrapped("", &format!("The time they leave: {} < 0.", total(problem.conflict))));
    }
    let settles = if problem.is_one_of_several { "settles this conflict" } else { "is enough" };
    let are_all = problem.enough.is_some_and(|enough| enough.are_all);
    match problem.enough.map(|enough| enough.changes.as_slice()) {
        None => {}
        Some([]) if !are_all => {}
        Some([]) if problem.kind == Kind::Circle => lines.extend(wrapped(
            "",
            "No one amount helps: what comes before what has to change. `kirk repair` tries which order could be left out.",
        )),
        Some([]) => lines.extend(wrapped(
            "",
            "No change of one amount alone is enough: several have to change, or what comes before what, or what is \
             joined. `kirk repair` looks for that.",
        )),
        Some([one]) => lines.extend(wrapped("", &format!("This alone {settles}: {}.", one.title()))),
        Some(several) => {
            lines.push(format!("Each of these alone {settles}:"));
            several.iter().for_each(|one| lines.extend(wrapped("- ", &one.title())));
        }
    }
    if problem.enough.is_some() && !are_all {
        lines.extend(wrapped("", "There are more amounts than were tried; `kirk repair` tries more."));
    }
    let is_enough = problem.enough.is_some_and(|enough| !enough.changes.is_empty());
    let takes = if is_enough { "Or it takes" } else { "It would take" };
    let remedies: Vec<&str> = problem.remedies.iter().copied().map(remedy).collect();
    if let Some((last, rest)) = remedies.split_last() {
        let list = if rest.is_empty() { last.to_string() } else { format!("{} or {last}", rest.join(", ")) };
        lines.extend(wrapped("", &format!("{takes} {list}.")));
    }
    if problem.conflict.conservative {
        lines.extend(wrapped(
            "",
            "This \"no\" rests on a chain of activities of which the first is heard late; a cleverer use of that news \
             might still find a way.",
        ));
    }
    lines
}

fn remedy(remedy: Remedy) -> &'static str {
    match remedy {
        Remedy::LongerUpperBound => "a longer upper bound",
        Remedy::SlackForNature => {
            "slack (`:slack t`) where an end that Nature decides has to meet another event"
        }
        Remedy::SlackInParallel => "slack (`:slack t`) in the `parallel`",
        Remedy::NarrowerContingent => "a narrower contingent duration",
        Remedy::SoonerNews => "news that comes sooner",
    }
}

/// What one part of a conflict says; with `theory`, what it adds to the sum as well.
pub(crate) fn stated(stated: &Stated<'_>, sources: &[Source], theory: bool) -> String {
    let Stated { says, origin, span, share } = stated;
    let written = |value: Duration| amount(value, *span, sources);
    let text = match *says {
        Says::AtLeast(least) => limit(origin, "at least", &written(least)),
        Says::AtMost(most) => limit(origin, "at most", &written(most)),
        Says::NatureAtLeast(least) => format!("Nature may take only {} {}", written(least), origin.about()),
        Says::NatureAtMost(most) => format!("Nature may take up to {} {}", written(most), origin.about()),
        Says::NewsAtLeast(least) => {
            format!("the news of {} may be only {} late", origin.end(), written(least))
        }
        Says::NewsAtMost(Bound::Finite(most)) => {
            format!("the news of {} may be {} late", origin.end(), written(most))
        }
        Says::NewsAtMost(Bound::Infinite) => format!("{} may never be heard", origin.end()),
        Says::Joined => "joined here: without slack, all parts start together and end together".to_string(),
        Says::Nothing => format!("joined here: {}", origin.text()),
        Says::Itself => origin.text(),
    };
    let times = if share.times > 1 { format!(" ({} times)", share.times) } else { String::new() };
    let amount = match share.amount {
        amount if theory && amount > Duration::ZERO => format!(": +{amount}"),
        amount if theory && amount < Duration::ZERO => format!(": {amount}"),
        _ => String::new(),
    };
    format!("{text}{times}{amount}")
}

fn limit(origin: &Origin, word: &str, bound: &str) -> String {
    match origin.kind {
        OriginKind::Constraint => format!("{word} {bound} from start to end of this"),
        OriginKind::Between | OriginKind::Requirement | OriginKind::Link => {
            format!("{word} {bound} {}", origin.subject)
        }
        OriginKind::Duration | OriginKind::Contingent => format!("{} takes {word} {bound}", origin.subject),
        OriginKind::Join | OriginKind::SideBySide | OriginKind::Empty | OriginKind::Order => origin.text(),
    }
}

/// A story in numbered lines, with the middle left out where it is very long.
fn story(problem: &Problem<'_>) -> Vec<String> {
    let story = problem.story;
    if story.is_empty() {
        return Vec::new();
    }
    let is_circle = problem.kind == Kind::Circle;
    let mut lines = match is_circle {
        true => vec!["Each of these comes after the one before, and the first after the last:".to_string()],
        false => vec!["Step by step:".to_string()],
    };
    let left_out = match story.len() {
        many if many > 2 * SHOWN + 1 => SHOWN..many - SHOWN,
        _ => 0..0,
    };
    let unit = unit(story);
    for (at, StoryStep { text, .. }) in story.iter().enumerate() {
        if at == left_out.start && !left_out.is_empty() {
            let (needed, there) = sums(&story[left_out.clone()]);
            let allowed = match there {
                Duration::ZERO => String::new(),
                there => format!(" and allow {}", unit.say(there)),
            };
            let text = format!("{} more steps need {}{allowed}", left_out.len(), unit.say(needed));
            lines.extend(wrapped("  - ", &text));
        }
        if !left_out.contains(&at) {
            lines.extend(wrapped(&format!("{:>2}. ", at + 1), text));
        }
    }
    if !is_circle {
        lines.extend(wrapped("", &balance(problem, sums(story), unit)));
    }
    lines
}

/// What is needed and what is there, and what is missing where that is what has to change.
fn balance(problem: &Problem<'_>, (needed, there): (Duration, Duration), unit: Unit) -> String {
    let count = |amount: Duration| match amount {
        Duration::ZERO => "nothing is".to_string(),
        amount => be(unit.say(amount)),
    };
    let sum = format!("That needs {}, and {} there", unit.say(needed), count(there));
    let Some(Enough { changes, witness, .. }) = problem.enough else {
        return format!("{sum}: this way round, and more may be missing.");
    };
    let first = changes.first().and_then(Changed::amount_changed);
    match (witness, first) {
        (Some(witness), _) if witness.times <= 1 => {
            format!("{sum}: {} missing.", be(unit.say(needed.checked_sub(there).unwrap_or_default())))
        }
        (Some(witness), Some(by)) => format!(
            "{sum}: {} missing, but what is named first here counts {} times, so {by} will do.",
            be(unit.say(needed.checked_sub(there).unwrap_or_default())),
            witness.times
        ),
        (None, Some(by)) => format!("{sum}, this way round; in all, {} missing.", be(by)),
        _ => format!("{sum}, this way round."),
    }
}

/// An amount as the subject of a sentence: `1 minute is`, `20 s are`.
fn be(amount: String) -> String {
    let is_one = amount == "1 s" || amount.starts_with("1 ") && !amount.ends_with('s');
    let verb = if is_one { "is" } else { "are" };
    format!("{amount} {verb}")
}

/// What steps need, and what they allow.
fn sums(story: &[StoryStep]) -> (Duration, Duration) {
    let all = |is_meant: fn(&Duration) -> bool| {
        let needs = story.iter().map(|step| step.needs).filter(is_meant);
        needs.fold(Duration::ZERO, |sum, amount| sum.checked_add(amount).unwrap_or(Duration::MAX))
    };
    (all(|needs| *needs > Duration::ZERO), -all(|needs| *needs < Duration::ZERO))
}

/// The unit for sums: the smallest that is written.
fn unit(story: &[StoryStep]) -> Unit {
    let units = story.iter().filter(|step| step.needs != Duration::ZERO).map(|step| step.unit);
    units.min().unwrap_or_default()
}

/// One step of a story; the first has nothing before it that it could be a "but" to.
pub(crate) fn step(
    step: &Step,
    origin: &Origin,
    network: &Network,
    sources: &[Source],
    is_first: bool,
) -> String {
    let place = Side::of(step.part).map_or(origin.span, |side| origin.place(side));
    let needs = amount(step.needs.abs(), place, sources);
    let but = if is_first { "" } else { "but " };
    let end = || origin.end();
    match step.part {
        Part::LinkUpper(_) => format!("Nature may take {needs} {}", origin.about()),
        Part::LinkLower(_) => format!("{but}Nature may take only {needs} {}", origin.about()),
        Part::DelayMax(link) if step.needs == Duration::ZERO => match network.contingents()[link].delay.max {
            Bound::Infinite => format!("{} may never be heard", end()),
            Bound::Finite(most) => {
                format!(
                    "the news of {} may be {} late, too late to be of use",
                    end(),
                    amount(most, place, sources)
                )
            }
        },
        Part::DelayMax(_) => format!("the news of {} may take {needs}", end()),
        Part::DelayMin(_) => format!("{but}the news of {} may take only {needs}", end()),
        _ if !origin.kind.is_amount() => origin.told_elsewhere(),
        _ if step.needs == Duration::ZERO => match step.part {
            Part::RequirementUpper(_) => format!("you allow no time {}", origin.about()),
            Part::Join(_) => origin.told_elsewhere(),
            _ => format!("the order {}", origin.about()),
        },
        // A bound below zero is one the other way round.
        Part::RequirementUpper(_) if step.needs > Duration::ZERO => {
            format!("you need at least {needs} {}", origin.back())
        }
        Part::RequirementLower(_) if step.needs < Duration::ZERO => {
            format!("you allow at most {needs} {}", origin.back())
        }
        Part::RequirementLower(_) => format!("you need at least {needs} {}", origin.about()),
        _ => format!("you allow at most {needs} {}", origin.about()),
    }
}

/// A text in lines that are not too long, those after the first indented below it.
fn wrapped(lead: &str, text: &str) -> Vec<String> {
    let mut lines = vec![lead.to_string()];
    for word in text.split(' ') {
        let indent = lead.chars().count();
        if let Some(last) = lines.last_mut() {
            let length = last.chars().count();
            if length > indent && length + 1 + word.chars().count() > WIDTH {
                lines.push(format!("{:indent$}{word}", ""));
            } else {
                let blank = if length > indent { " " } else { "" };
                last.push_str(&format!("{blank}{word}"));
            }
        }
    }
    lines
}

/// The amounts as a sum with its result: `20 - 10 - 15 = -5`.
fn total(conflict: &Conflict) -> String {
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
