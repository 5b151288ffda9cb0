//! What is said about conflicts: in one message, and step by step.

use kirk_network::stnu::TooLarge;
use kirk_network::walk::Step;
use kirk_network::{Bound, Conflict, Duration, Part, Share};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::explain::problem::{Kind, Problem, Remedy, Says, Stated};
use crate::explain::{Explain, StoryStep};
use crate::origins::{Origin, OriginKind, Side};
use crate::repair::{Changed, amount};
use crate::source::{Source, Span};

/// No line is longer: with what a terminal shows before it, it fits 80 columns.
const WIDTH: usize = 74;

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
    for bound in &problem.bounds {
        let text = stated(bound, sources, theory);
        match places.iter_mut().find(|(known, _)| *known == bound.span) {
            Some((_, texts)) if !texts.contains(&text) => texts.push(text),
            Some(_) => {}
            None => places.push((bound.span, vec![text])),
        }
    }
    let mut told = places.into_iter().map(|(span, texts)| (span, texts.join("; ")));
    let everywhere = "there is no way to execute this that works whatever happens".to_string();
    // Where no program is named the message points at the first bound.
    let (span, primary) = match program {
        Some(span) => (span, everywhere),
        None => told.next().unwrap_or((Span::default(), everywhere)),
    };
    let mut diagnostic = Diagnostic::error(Code::NotControllable, span, message).primary(primary);
    diagnostic = told.fold(diagnostic, |diagnostic, (span, text)| diagnostic.label(span, text));
    diagnostic.suggestions =
        problem.enough.unwrap_or_default().iter().filter_map(Changed::suggestion).collect();
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

/// The story, the sum, and what would settle it, in lines.
fn help(problem: &Problem<'_>) -> Vec<String> {
    let mut lines = story(problem.story, problem.kind);
    if problem.explain.theory {
        lines.extend(wrapped("", &format!("The time they leave: {} < 0.", total(problem.conflict))));
    }
    let settles = if problem.is_one_of_several { "settles this conflict" } else { "is enough" };
    match problem.enough {
        None => {}
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
    let is_enough = problem.enough.is_some_and(|enough| !enough.is_empty());
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

/// A story in numbered lines.
fn story(story: &[StoryStep], kind: Kind) -> Vec<String> {
    if story.is_empty() {
        return Vec::new();
    }
    let is_circle = kind == Kind::Circle;
    let mut lines = vec![match is_circle {
        true => "Each of these comes after the one before, and the first after the last:".to_string(),
        false => "Step by step:".to_string(),
    }];
    for (number, StoryStep { text, .. }) in story.iter().enumerate() {
        lines.extend(wrapped(&format!("{:>2}. ", number + 1), text));
    }
    if !is_circle {
        let all = |is_meant: fn(&Duration) -> bool| {
            let needs = story.iter().map(|step| step.needs).filter(is_meant);
            needs.fold(Duration::ZERO, |sum, amount| sum.checked_add(amount).unwrap_or(Duration::MAX))
        };
        let needed = all(|needs| *needs > Duration::ZERO);
        let there = -all(|needs| *needs < Duration::ZERO);
        lines.push(format!("That needs {needed} s, and {there} s are there."));
    }
    lines
}

/// One step of a story; the first has nothing before it that it could be a "but" to.
pub(crate) fn step(
    step: &Step,
    (origin, side): (&Origin, Side),
    sources: &[Source],
    is_first: bool,
) -> String {
    let needs = amount(step.needs.abs(), origin.place(side), sources);
    let but = if is_first { "" } else { "but " };
    let end = || origin.end();
    match step.part {
        Part::LinkUpper(_) => format!("Nature may take {needs} {}", origin.about()),
        Part::LinkLower(_) => format!("{but}Nature may take only {needs} {}", origin.about()),
        Part::DelayMax(_) => format!("the news of {} may take {needs}", end()),
        Part::DelayMin(_) => format!("{but}the news of {} may take only {needs}", end()),
        _ if !origin.kind.is_amount() => origin.text(),
        _ if step.needs == Duration::ZERO => format!("the order {}", origin.about()),
        Part::RequirementLower(_) if step.needs > Duration::ZERO => {
            format!("you need at least {needs} {}", origin.about())
        }
        Part::RequirementUpper(_) if step.needs > Duration::ZERO => {
            format!("you need at least {needs} the other way than {}", origin.about())
        }
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
