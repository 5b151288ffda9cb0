//! What there is to know about the name under the cursor: what it is, how long it takes, when it happens.

use kirk_compiler::ast::{Amount, AmountKind, Body, ControlProgram, DurationOf};
use kirk_compiler::episode::Kind;
use kirk_compiler::repair::Unit;
use kirk_compiler::words::word;
use kirk_compiler::{Source, Span, Symbol, SymbolKind};
use kirk_network::news::{Treatment, treatments};
use kirk_network::windows::Window;

use crate::analysis::Analysis;
use crate::cursor::{Cursor, pointed_at};
use crate::judged::{Judged, Judgement, Occurrence};
use crate::left;
use crate::view::View;
use crate::waits::{Waits, in_words, waits};

/// What to show, in Markdown, and what it is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The name, or the operator.
    pub span: Span,
    /// What there is to know.
    pub markdown: String,
}

/// How many occurrences of one place are described; the rest are counted.
const MOST_OCCURRENCES: usize = 5;

/// What there is to know about what stands at an offset.
pub fn hover(view: &View, offset: u32) -> Option<Hover> {
    let analysis = &*view.analysis;
    let Some((symbol, place)) = analysis.symbols.at(0, offset) else { return word_at(view, offset) };
    let mut parts = vec![what(analysis, symbol)];
    match symbol.kind {
        SymbolKind::Program(_) if place.definition => parts.extend(occurrences(view, place.span)),
        SymbolKind::Program(_) => parts.extend(occurrences(view, call_around(analysis, place.span))),
        SymbolKind::Label => {
            parts.extend(labelled(analysis, symbol).and_then(|form| occurrences(view, form)))
        }
        SymbolKind::Team => parts.extend(promises(view)),
        _ => {}
    }
    parts.extend(bounds(view, place.span));
    parts.retain(|part| !part.is_empty());
    Some(Hover { span: place.span, markdown: parts.join("\n\n") })
}

/// What the agents promise each other in each mission.
fn promises(view: &View) -> Option<String> {
    let promised = view.missions.iter().filter_map(|mission| match &mission.verdict {
        Judgement::Promised(promises) => Some(promises),
        _ => None,
    });
    let lines: Vec<String> = promised.flatten().map(|promise| format!("- {promise}")).collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

/// What there is to know about a word of the language, or an amount.
fn word_at(view: &View, offset: u32) -> Option<Hover> {
    let analysis = &*view.analysis;
    let cursor = pointed_at(analysis.text(), offset)?;
    // An amount is a number, or a form around it.
    let amount = [Some(cursor.word), form_around(analysis, cursor.word)].into_iter().flatten();
    let left = amount.filter_map(|span| Some((span, bounds(view, span)?))).next();
    match (about_word(view, &cursor), left) {
        (None, left) => left.map(|(span, markdown)| Hover { span, markdown }),
        (Some(about), Some((_, left))) if cursor.first => {
            Some(Hover { span: cursor.word, markdown: format!("{about}\n\n{left}") })
        }
        (Some(markdown), _) => Some(Hover { span: cursor.word, markdown }),
    }
}

/// What a word of the language means, and when its form happens.
fn about_word(view: &View, cursor: &Cursor<'_>) -> Option<String> {
    let analysis = &*view.analysis;
    let written = analysis.slice(cursor.word);
    let Some(word) = word(written).filter(|_| cursor.first) else {
        let name = written.strip_prefix(':')?.to_lowercase();
        let keyword = cursor.keywords().iter().find(|keyword| keyword.name == name)?;
        return Some(keyword.about.to_string());
    };
    let mut markdown = format!("```lisp\n{}\n```\n\n{}", word.shape(), word.about);
    // Forms with a body are known by their word, others as a whole.
    let whole = || occurrences(view, call_around(analysis, cursor.word));
    if let Some(times) = occurrences(view, cursor.word).or_else(whole) {
        markdown.push_str(&format!("\n\n{times}"));
    }
    Some(markdown)
}

/// What a symbol is.
fn what(analysis: &Analysis, symbol: &Symbol) -> String {
    let name = &symbol.name;
    match symbol.kind {
        SymbolKind::Program(index) => {
            let definition = &analysis.program.programs[index];
            program(analysis.source_of(definition.span), definition)
        }
        SymbolKind::Parameter(index) => {
            format!("`{name}`: a parameter of `{}`", analysis.program.programs[index].name.name)
        }
        SymbolKind::Variable => format!("`{name}`: a variable"),
        SymbolKind::Label => format!("`{name}`: a label, which names an occurrence"),
        SymbolKind::NamedNumber(index) => {
            let value = &analysis.program.parameters[index].value;
            format!("`{name}` = {}", amount(analysis.source_of(value.span), value))
        }
        SymbolKind::Class(_) => format!("`{name}`: a class"),
        SymbolKind::Slot(class) => {
            format!("`{name}`: a slot of `{}`", analysis.program.classes[class].name.name)
        }
        SymbolKind::Accessor => format!("`{name}`: reads a slot"),
        SymbolKind::Package => format!("`{name}`: a package"),
        SymbolKind::Team => format!("`{name}`: the team that executes the mission"),
        SymbolKind::Agent => format!("`{name}`: an agent of the team"),
    }
}

/// How a program is called, how long it takes, and what it is for.
pub(crate) fn program(source: &Source, program: &ControlProgram) -> String {
    let mut text = format!("```lisp\n{}\n```", program.shape());
    let takes = match (&program.duration, program.primitive) {
        (Some(duration), _) => takes(source, duration),
        (None, true) => "takes any time, as we choose".to_string(),
        (None, false) => String::new(),
    };
    for part in [Some(takes), program.documentation.clone()].into_iter().flatten() {
        if !part.is_empty() {
            text.push_str("\n\n");
            text.push_str(&part);
        }
    }
    text
}

/// How long a primitive program takes, who decides, and how late its end is heard.
fn takes(source: &Source, duration: &DurationOf) -> String {
    let shown = |written: &Option<Amount>, missing: &str| match written {
        Some(written) => amount(source, written),
        None => missing.to_string(),
    };
    let range = |lower: &Option<Amount>, upper: &Option<Amount>| match (lower, upper) {
        (lower, None) => format!("at least {}", shown(lower, "0 s")),
        (None, Some(upper)) => format!("at most {}", amount(source, upper)),
        (Some(lower), Some(upper)) => match (&lower.kind, &upper.kind) {
            (AmountKind::Number(least), AmountKind::Number(most)) => format!("{least} to {most} s"),
            _ => format!("{} to {}", amount(source, lower), amount(source, upper)),
        },
    };
    let who = if duration.contingent { "Nature decides" } else { "as we choose" };
    let mut text = format!("takes {}, {who}", range(&duration.bounds.lower, &duration.bounds.upper));
    if let Some(delay) = &duration.delay {
        text.push_str(&format!("; the news of its end comes {} later", range(&delay.lower, &delay.upper)));
    }
    text
}

/// A number as seconds, or as it is written.
fn amount(source: &Source, amount: &Amount) -> String {
    match &amount.kind {
        AmountKind::Number(number) => format!("{number} s"),
        AmountKind::Infinite => "any time".to_string(),
        _ => format!("`{}`", source.slice(amount.span)),
    }
}

/// What a label names, if it is given in one place to one call.
fn labelled(analysis: &Analysis, symbol: &Symbol) -> Option<Span> {
    let mut given = symbol.places.iter().filter(|place| place.definition);
    let (Some(only), None) = (given.next(), given.next()) else { return None };
    let mut open: Vec<&Body> = analysis.program.programs.iter().flat_map(|program| &program.body).collect();
    while let Some(body) = open.pop() {
        match body {
            Body::Label(labelled) if labelled.name.span == only.span => {
                return match labelled.body.as_slice() {
                    [one] => Some(one.span()),
                    _ => None,
                };
            }
            _ => open.extend(body.parts()),
        }
    }
    None
}

/// The form whose first word is the name at `name`: the call.
fn call_around(analysis: &Analysis, name: Span) -> Span {
    let mut around = name;
    let mut forms = &analysis.forms[..];
    while let Some(form) =
        forms.iter().find(|form| form.span.start <= name.start && name.end <= form.span.end)
    {
        let Some(items) = form.list() else { break };
        if items.first().is_some_and(|first| first.span == name) {
            around = form.span;
        }
        forms = items;
    }
    around
}

/// The innermost form in which a word stands.
fn form_around(analysis: &Analysis, word: Span) -> Option<Span> {
    let mut around = None;
    let mut forms = &analysis.forms[..];
    while let Some(form) = forms
        .iter()
        .find(|form| form.span.start <= word.start && word.end <= form.span.end && form.list().is_some())
    {
        around = Some(form.span);
        forms = form.list()?;
    }
    around
}

/// How far the bounds that are written at a place can move.
fn bounds(view: &View, place: Span) -> Option<String> {
    let lines: Vec<String> = left::of_bounds(view, place).iter().map(|line| format!("- {line}")).collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

/// When what stands at a place happens, in each mission it belongs to.
fn occurrences(view: &View, form: Span) -> Option<String> {
    let all = view.occurrences(form);
    let mut lines: Vec<String> = Vec::new();
    let mut last: Option<&Judged> = None;
    for (mission, occurrence) in all.iter().take(MOST_OCCURRENCES) {
        let Some(times) = times(mission, occurrence, all.len() == 1) else { continue };
        if !last.is_some_and(|last| std::ptr::eq(last, *mission)) {
            lines.push(format!("From the start of `{}`:\n", mission.program));
            last = Some(mission);
        }
        lines.push(times);
    }
    if all.len() > MOST_OCCURRENCES && !lines.is_empty() {
        lines.push(format!("- and {} more", all.len() - MOST_OCCURRENCES));
    }
    (!lines.is_empty()).then(|| lines.join("\n"))
}

/// When an occurrence happens; in detail also how much is left, what it waits for and what becomes of the news of its end.
fn times(mission: &Judged, occurrence: &Occurrence, detailed: bool) -> Option<String> {
    let network = &mission.lowered.network;
    let (start, end) = (mission.window(occurrence.start)?, mission.window(occurrence.end)?);
    let name = match occurrence.kind {
        Kind::Primitive | Kind::Program => format!("`{}`", occurrence.name),
        kind => format!("this `{}`", kind.word()),
    };
    let mut text =
        format!("- {name} starts {} and ends {}", when(start, mission.unit), when(end, mission.unit));
    let Waits { together, after, link } = waits(network, occurrence.start);
    if link.is_some() {
        text.push_str("; Nature decides when it starts");
    }
    if !detailed {
        return Some(text);
    }
    // Of a team each agent waits for other news.
    if mission.lowered.team.is_some() {
        return Some(text);
    }
    if let Some(left) = left::of_occurrence(mission, occurrence) {
        text.push_str(&format!("\n- {left}"));
    }
    let listed = |events: &[String]| {
        let shown: Vec<String> = events.iter().take(MOST_OCCURRENCES).map(|event| in_words(event)).collect();
        let more = events.len() - shown.len();
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{}{rest}", shown.join(", "))
    };
    let news = treatments(network);
    if !together.is_empty() {
        text.push_str(&format!("\n- its start is one moment with {}", listed(&together)));
        if let Some(Treatment { heard, .. }) = link.and_then(|link| news.get(link)) {
            text.push_str(&format!(", {heard}"));
        }
    }
    if !after.is_empty() {
        text.push_str(&format!("\n- it waits for {}", listed(&after)));
    }
    if let Some(Treatment { heard, how, .. }) =
        network.link_of(occurrence.end).and_then(|link| news.get(link))
    {
        text.push_str(&format!("\n- its end is {heard}; {how}"));
    }
    Some(text)
}

/// `at 5 s`, `from 5 to 20 s`, `from 5 s on`.
fn when(window: Window, unit: Unit) -> String {
    match window.latest {
        Some(latest) if latest == window.earliest => format!("at {}", unit.say_time(latest)),
        Some(latest) => format!("from {}", unit.say_times(window.earliest, " to ", latest)),
        None => format!("from {} on", unit.say_time(window.earliest)),
    }
}
