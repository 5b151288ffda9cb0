//! `kirk repair`: what would make a mission controllable, each proposal proven of the edited source, and made if that is wanted.

use std::fs;
use std::io;

use kirk_compiler::nearest::nearest;
use kirk_compiler::repair::{Changed, Preference, Proposal, Proposals, Wishes, names, proposals, what};
use kirk_compiler::{Edit, Source, Span, Text, too_large};
use kirk_network::stnu::TooLarge;
use kirk_network::{Duration, Verdict, check};
use serde::Serialize;
use similar::TextDiff;

use crate::args::{Common, Prefer, RepairOf, TextOrJson};
use crate::conflict::{ChangedJson, SpotJson};
use crate::foreign::one_line;
use crate::input::{Loaded, STDIN, load_all, without_mark};
use crate::json::line;
use crate::output::{Status, complain, print, print_line, remark};
use crate::replace::Replacement;
use crate::report::Reporter;

pub(crate) fn repair_of(arguments: &RepairOf, common: &Common) -> io::Result<Status> {
    let mut input = load_all(&arguments.files, &arguments.selection);
    input.for_one_alone("`kirk repair`");
    let file = arguments.files.join(" ");
    let wishes = match wishes(arguments, &input) {
        Ok(wishes) => wishes,
        Err(wrong) => return refuse(&wrong),
    };
    let found = match (&input.network, input.origins()) {
        (Some(network), Some(origins)) => proposals(network, origins, &input.sources, &wishes),
        _ => {
            let reporter = Reporter::new(&input.sources);
            reporter.show(&input.diagnostics, common)?;
            if arguments.format == TextOrJson::Json {
                let nothing = RepairJson { controllable: None, ..RepairJson::new(&file, None, &reporter) };
                print(&line(&nothing)?)?;
            }
            return Ok(Status::Wrong);
        }
    };
    let mut found = match found {
        Ok(found) => found,
        Err(TooLarge) => {
            input.diagnostics.push(too_large(Span::default()));
            Reporter::new(&input.sources).show(&input.diagnostics, common)?;
            return Ok(Status::Wrong);
        }
    };
    let dropped = found.as_mut().map_or(0, |found| drop_unproven(found, &input, arguments));
    if arguments.apply.is_some() || arguments.diff {
        return edit(arguments, &input, found.as_ref());
    }
    let reporter = Reporter::new(&input.sources);
    match (arguments.format, &found) {
        (TextOrJson::Json, _) => print(&line(&RepairJson::new(&file, found.as_ref(), &reporter))?)?,
        (TextOrJson::Text, None) => {
            let program = input.program(&arguments.selection);
            print_line(&format!("{file}: `{program}` is controllable: there is nothing to repair"))?;
        }
        (TextOrJson::Text, Some(found)) => {
            let program = input.program(&arguments.selection);
            for text in lines(&file, &program, found, &reporter, arguments) {
                print_line(&one_line(&text))?;
            }
            if dropped > 0 {
                remark(&format!(
                    "{dropped} more left out: what it would be in this text is not proven to be enough"
                ));
            }
        }
    }
    Ok(match found {
        Some(found) if found.proposals.is_empty() => Status::No,
        _ => Status::Yes,
    })
}

fn refuse(wrong: &str) -> io::Result<Status> {
    complain(wrong);
    Ok(Status::Wrong)
}

/// What the command line wishes for, or what is wrong with that.
fn wishes(arguments: &RepairOf, input: &Loaded) -> Result<Wishes, String> {
    let known = |name: &str| -> Result<String, String> {
        let all: Vec<&str> = input.origins().map(|origins| names(origins).collect()).unwrap_or_default();
        if input.network.is_none() || all.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            return Ok(name.to_string());
        }
        let near = nearest(name, all).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        Err(format!("nothing here is called `{name}`{near}"))
    };
    let weight = |option: &String| -> Result<(String, u64), String> {
        let expected = || format!("`--weight {option}`: expected NAME=W, as in `--weight drive=3`");
        let (name, weight) = option.rsplit_once('=').ok_or_else(expected)?;
        let weight = Duration::parse_seconds(weight).map_err(|_| expected())?.as_micros();
        let weight = u64::try_from(weight).ok().filter(|weight| *weight > 0).ok_or_else(|| {
            format!("`--weight {option}`: a weight is more than 0; `--keep {name}` leaves it as it is")
        })?;
        Ok((known(name)?, weight))
    };
    Ok(Wishes {
        nature: arguments.nature,
        keep: arguments.keep.iter().map(|name| known(name)).collect::<Result<_, _>>()?,
        prefer: arguments.prefer.map(|prefer| match prefer {
            Prefer::News => Preference::News,
            Prefer::Deadlines => Preference::Deadlines,
            Prefer::Durations => Preference::Durations,
        }),
        weights: arguments.weight.iter().map(weight).collect::<Result<_, _>>()?,
        limit: arguments.limit,
        ..Wishes::default()
    })
}

/// Leaves the proposals whose edits, read afresh, are controllable, and returns how many others there were. What cannot be edited is
/// proven of the network.
fn drop_unproven(found: &mut Proposals, input: &Loaded, arguments: &RepairOf) -> usize {
    let before = found.proposals.len();
    found.proposals.retain(|proposal| {
        let Some(sources) = edited(proposal, &input.sources) else { return true };
        let after = input.with_sources(sources, &arguments.selection);
        after.network.is_some_and(|network| check(&network) == Ok(Verdict::Controllable))
    });
    before - found.proposals.len()
}

/// The sources with a proposal made; `None` if it is of what cannot be edited.
fn edited(proposal: &Proposal, sources: &[Source]) -> Option<Vec<Source>> {
    if !proposal.is_applicable() {
        return None;
    }
    let mut edits: Vec<&Edit> = proposal.changes.iter().flat_map(|change| &change.edits).collect();
    edits.sort_by_key(|edit| (edit.span.source, edit.span.start));
    let mut sources = sources.to_vec();
    for edit in edits.iter().rev() {
        let Text::Plain(text) = &edit.text else { return None };
        let range = edit.span.start as usize..edit.span.end as usize;
        sources.get_mut(edit.span.source as usize)?.text.replace_range(range, text);
    }
    Some(sources)
}

/// Makes a proposal, or prints it as a patch.
fn edit(arguments: &RepairOf, input: &Loaded, found: Option<&Proposals>) -> io::Result<Status> {
    let Some(found) = found else {
        return refuse("it is controllable: there is nothing to repair");
    };
    let number = arguments.apply.unwrap_or(1);
    let Some(proposal) = number.checked_sub(1).and_then(|at| found.proposals.get(at)) else {
        let there = match found.proposals.len() {
            0 => "nothing was found that could be applied".to_string(),
            1 => "there is only proposal 1".to_string(),
            count => format!("there are proposals 1 to {count}"),
        };
        return refuse(&format!("there is no proposal {number}: {there}"));
    };
    let Some(sources) = edited(proposal, &input.sources) else {
        return refuse(&format!(
            "kirk cannot write proposal {number} in the file: make it by hand, where the proposal says"
        ));
    };
    let changed = input.sources.iter().zip(&sources).filter(|(before, after)| before.text != after.text);
    if arguments.diff {
        for (before, after) in changed {
            print(&patch(before, after))?;
        }
        return Ok(Status::Yes);
    }
    // All are written before the first takes the place of the old one.
    let mut ready = Vec::new();
    for (before, after) in changed {
        match prepared(before, after) {
            Ok(prepared) => ready.push((before, prepared)),
            Err(why) => {
                return refuse(&format!("cannot change `{}`, so nothing is changed: {why}", before.name));
            }
        }
    }
    for (before, prepared) in ready {
        if let Err(why) = prepared.put() {
            return refuse(&format!("cannot change `{}`, which is as it was: {why}", before.name));
        }
    }
    for change in &proposal.changes {
        print_line(&format!("changed: {}", change.title()))?;
    }
    Ok(Status::Yes)
}

fn patch(before: &Source, after: &Source) -> String {
    // After a tab `patch` reads no further, and so takes blanks for a part of the name.
    let end = if before.name.contains(char::is_whitespace) { "\t" } else { "" };
    let named = |side: &str| match before.name.starts_with('/') {
        true => format!("{}{end}", before.name),
        false => format!("{side}/{}{end}", before.name),
    };
    TextDiff::from_lines(&before.text, &after.text)
        .unified_diff()
        .header(&named("a"), &named("b"))
        .to_string()
}

/// Writes the new text beside the old one, if that is what is still there.
fn prepared(before: &Source, after: &Source) -> Result<Replacement, String> {
    if before.name == STDIN {
        return Err("it came from standard input; `--diff` prints the change".to_string());
    }
    let about = fs::metadata(&before.name).map_err(|error| error.to_string())?;
    if !about.is_file() || about.permissions().readonly() {
        return Err("it is no file that may be written".to_string());
    }
    let there = fs::read_to_string(&before.name).map_err(|error| error.to_string())?;
    let rest = without_mark(&there);
    if rest != without_mark(&before.text) {
        return Err("somebody has changed it meanwhile".to_string());
    }
    let mark = &there[..there.len() - rest.len()];
    let text = format!("{mark}{}", without_mark(&after.text));
    Replacement::prepared(&before.name, &text).map_err(|error| error.to_string())
}

fn lines(
    file: &str,
    program: &str,
    found: &Proposals,
    reporter: &Reporter<'_>,
    arguments: &RepairOf,
) -> Vec<String> {
    let mut lines = Vec::new();
    if found.proposals.is_empty() {
        lines
            .push(format!("{file}: `{program}` is not controllable, and nothing was found that makes it so"));
        if !arguments.nature {
            lines.push("With `--nature` the durations that Nature decides may change, too.".to_string());
        }
    } else {
        lines.push(format!(
            "{file}: `{program}` is not controllable; each of these makes it so, which is proven"
        ));
    }
    for (number, proposal) in found.proposals.iter().enumerate() {
        lines.push(String::new());
        for (at, change) in proposal.changes.iter().enumerate() {
            let lead = if at == 0 { format!("{:>3}  ", number + 1) } else { "     and ".to_string() };
            let place = reporter.at(change.place).map_or(String::new(), |at| format!("  {at}"));
            lines.push(format!("{lead}{}{place}", change.title()));
        }
        if !proposal.is_applicable() {
            lines.push("     by hand: kirk cannot write this change in the file".to_string());
        }
    }
    if found.gave_up {
        lines.extend([
            String::new(),
            match found.proposals.is_empty() {
                true => "The search was given up before its end: there may be some.".to_string(),
                false => "The search was given up before its end: there may be cheaper ones.".to_string(),
            },
        ]);
    }
    if let Some(first) = found.proposals.iter().position(Proposal::is_applicable) {
        lines.push(String::new());
        lines.push(how_to_make(file, first + 1));
    }
    lines
}

/// How the first proposal that can be made is made.
fn how_to_make(file: &str, number: usize) -> String {
    match (file, number) {
        ("-", 1) => "With `--diff` the first is printed as a patch.".to_string(),
        ("-", _) => format!("With `--diff --apply {number}` number {number} is printed as a patch."),
        (_, 1) => {
            "With `--apply 1` the first of them is made, with `--diff` it is printed as a patch.".to_string()
        }
        _ => format!(
            "With `--apply {number}` number {number} is made, with `--diff` as well it is printed as a patch."
        ),
    }
}

#[derive(Serialize)]
struct RepairJson<'a> {
    format: &'static str,
    file: &'a str,
    controllable: Option<bool>,
    repairs: Vec<ProposalJson<'a>>,
    not_alone: Vec<PlaceJson<'a>>,
    gave_up: bool,
}

#[derive(Serialize)]
struct ProposalJson<'a> {
    /// The amounts of all changes, added up.
    total: Duration,
    changes: Vec<ChangedJson<'a>>,
    proven: bool,
    /// Whether `--apply` can make it.
    applicable: bool,
}

#[derive(Serialize)]
struct PlaceJson<'a> {
    what: String,
    #[serde(flatten)]
    place: SpotJson<'a>,
}

impl<'a> RepairJson<'a> {
    fn new(file: &'a str, found: Option<&'a Proposals>, reporter: &'a Reporter<'_>) -> RepairJson<'a> {
        let by = |change: &Changed| {
            let (from, to) = change.amounts()?;
            Some(to.finite()?.checked_sub(from.finite()?)?.abs())
        };
        let total = |proposal: &Proposal| {
            let amounts = proposal.changes.iter().filter_map(by);
            amounts.fold(Duration::ZERO, |sum, by| sum.saturating_add(by))
        };
        let repairs = found.iter().flat_map(|found| &found.proposals).map(|proposal| ProposalJson {
            total: total(proposal),
            changes: proposal.changes.iter().map(|change| ChangedJson::new(change, reporter)).collect(),
            proven: true,
            applicable: proposal.is_applicable(),
        });
        let not_alone = found.iter().flat_map(|found| &found.not_alone);
        RepairJson {
            format: "kirk-repair/1",
            file,
            controllable: Some(found.is_none()),
            repairs: repairs.collect(),
            not_alone: not_alone
                .filter_map(|(part, origin, span)| {
                    let place = SpotJson::new(*span, reporter);
                    Some(PlaceJson { what: what(*part, origin)?, place })
                })
                .collect(),
            gave_up: found.is_some_and(|found| found.gave_up),
        }
    }
}
