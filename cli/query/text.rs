//! The answers of `kirk query` for people.

use kirk_network::promise::Promise;
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::{Ended, Heard, Situation, Waits};

use super::{Answer, Line, Picture};
use crate::aftermath;
use crate::foreign::one_line;
use crate::why::why_event;

pub(super) fn text(answer: &Answer, situation: &Situation) -> String {
    let network = situation.network();
    let mut lines = Vec::new();
    // What something waits for is an answer by itself.
    if answer.details || answer.waits.is_empty() || !answer.heard.is_empty() {
        lines.push(headline(&answer.program, &answer.before, false));
        if answer.details {
            lines.extend(answer.before.events.iter().flat_map(|line| details(line, answer.before.now)));
        } else if answer.heard.is_empty() && !answer.before.events.is_empty() {
            lines.push(String::new());
            lines.extend(table(&answer.before));
        }
    }
    for (event, time, heard) in &answer.heard {
        let name = network.label(*event);
        match heard {
            Heard::Possible => lines.push(format!("`{name}` heard at {time} s: as the model allows")),
            Heard::Broken(said, aftermath) => {
                lines.push(said.clone());
                lines.extend(aftermath::lines(aftermath));
            }
        }
    }
    if let Some(after) = &answer.after {
        lines.push(headline(&answer.program, after, answer.is_broken()));
        if answer.details {
            lines.extend(after.events.iter().flat_map(|line| details(line, after.now)));
        } else {
            lines.extend(changes(&answer.before, after, situation));
        }
    }
    for waits in &answer.waits {
        if !lines.is_empty() {
            lines.push(String::new());
        }
        lines.extend(chain(waits, situation));
    }
    lines.iter().map(|line| format!("{}\n", one_line(line))).collect()
}

/// How things stand, in a sentence.
fn headline(program: &str, picture: &Picture, broken: bool) -> String {
    let now = picture.now;
    match &picture.ended {
        Some(Ended::Completed) => format!("{program} is completed, at {now} s"),
        Some(Ended::Failed(failure)) => {
            format!("{program} failed at {} s: {} ({})", failure.time, failure.detail, failure.reason.word())
        }
        Some(Ended::NoPlan) => format!("{program} at {now} s: not all can be kept any more"),
        None if !picture.guaranteed => format!("{program} at {now} s: not all can be kept any more"),
        None if picture.events.is_empty() => format!("{program} at {now} s: nothing is to come"),
        None if broken => format!("{program} at {now} s: what is left can be kept"),
        None => format!("{program} at {now} s: all can be kept"),
    }
}

/// What can be earlier or later only as far as anybody knows.
const ROUGHLY: &str = "~ a limit: not before, or not after that, but perhaps not so early, or so late";

fn table(picture: &Picture) -> Vec<String> {
    let now = picture.now;
    let headings = ["from", "to", "in", "event", ""].map(str::to_string);
    let row = |line: &Line| {
        let mut notes = Vec::new();
        if let Some(since) = line.with_driver {
            notes.push(format!("with the driver since {since}"));
        }
        if line.nature {
            notes.push("Nature's".to_string());
        }
        if let Some((from, to)) = line.news {
            notes.push(match to {
                Some(to) => format!("heard from {from} to {to}"),
                None => format!("heard from {from} on, or never"),
            });
        }
        let [from, to] = ends(line);
        [from, to, until(line, now), line.label(), notes.join(", ")]
    };
    let rows: Vec<[String; 5]> = [headings].into_iter().chain(picture.events.iter().map(row)).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let [first, second, third, fourth] = [0, 1, 2, 3].map(width);
    let laid_out = |[from, to, until, event, note]: &[String; 5]| {
        let line = format!("  {from:>first$}  {to:>second$}  {until:>third$}  {event:<fourth$}  {note}");
        line.trim_end().to_string()
    };
    let mut lines: Vec<String> = rows.iter().map(laid_out).collect();
    if picture.events.iter().any(|line| !is_exact(line)) {
        lines.extend([String::new(), format!("  {ROUGHLY}")]);
    }
    lines
}

fn is_exact(line: &Line) -> bool {
    line.left.earliest_is_exact && (line.left.latest_is_exact || line.left.window.latest.is_none())
}

/// Between which times it can happen.
fn ends(line: &Line) -> [String; 2] {
    let mark = |exact: bool| if exact { "" } else { "~" };
    let from = format!("{}{}", mark(line.left.earliest_is_exact), line.left.window.earliest);
    let to = match line.left.window.latest {
        Some(latest) => format!("{}{latest}", mark(line.left.latest_is_exact)),
        None => "any".to_string(),
    };
    [from, to]
}

/// How long it is until then.
fn until(line: &Line, now: Time) -> String {
    let in_so_long = |time: Time| time.saturating_since(now).max(Duration::ZERO);
    let earliest = in_so_long(line.left.window.earliest);
    match line.left.window.latest.map(in_so_long) {
        Some(latest) if latest == earliest => format!("{earliest} s"),
        Some(latest) => format!("{earliest} to {latest} s"),
        None => format!("{earliest} s or more"),
    }
}

/// All there is to say about an event.
fn details(line: &Line, now: Time) -> Vec<String> {
    let whose = if line.nature { "Nature's" } else { "ours" };
    let [from, to] = ends(line);
    let between =
        if line.left.window.latest.is_some() { format!("{from} to {to} s") } else { format!("{from} s on") };
    let mut lines = vec![String::new(), format!("`{}` ({whose})", line.label())];
    let mut say = |what: &str, text: String| lines.push(format!("  {what:<12} {text}"));
    match (line.done, line.nature) {
        (Some(time), false) => say("was", format!("at {time} s")),
        (Some(time), true) => {
            say("was heard", format!("at {time} s"));
            say("happened", between);
        }
        (None, _) => {
            say("can be", format!("{between}, in {}", until(line, now)));
            if !is_exact(line) {
                say("", ROUGHLY.to_string());
            }
        }
    }
    if let Some((from, to)) = line.news {
        say("can be heard", to.map_or(format!("{from} s on, or never"), |to| format!("{from} to {to} s")));
    }
    if let Some(since) = line.with_driver {
        say("is", format!("with the driver since {since} s"));
    }
    if let Some(Promise { by, from: put_off }) = line.promise {
        say("promised", by.map_or("by no time".to_string(), |by| format!("by {by} s at the earliest")));
        say(
            "put off",
            put_off.map_or("to any time".to_string(), |time| format!("to {time} s at the latest")),
        );
    }
    lines
}

/// What has changed for the events that were to come.
fn changes(before: &Picture, after: &Picture, situation: &Situation) -> Vec<String> {
    let row = |line: &Line| {
        let range = |line: &Line| ends(line).join(" to ");
        let then = after.events.iter().find(|then| then.event == line.event);
        let now = match (then, situation.heard_of(line.event), situation.fixed(line.event)) {
            (Some(then), ..) => range(then),
            (None, Some(heard), _) => format!("heard at {heard}"),
            (None, None, Some((time, _))) => format!("was at {time}"),
            _ => return None,
        };
        let was = range(line);
        (was != now).then(|| [was, now, line.label()])
    };
    let headings = ["before", "then", "event"].map(str::to_string);
    let rows: Vec<[String; 3]> = [headings].into_iter().chain(before.events.iter().filter_map(row)).collect();
    if rows.len() == 1 {
        return Vec::new();
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let [first, second] = [0, 1].map(width);
    let laid_out = |[was, now, event]: &[String; 3]| {
        format!("  {was:<first$}  {now:<second$}  {event}").trim_end().to_string()
    };
    let mut lines = vec![String::new()];
    lines.extend(rows.iter().map(laid_out));
    let all = before.events.iter().chain(&after.events);
    if all.into_iter().any(|line| !is_exact(line)) {
        lines.extend([String::new(), format!("  {ROUGHLY}")]);
    }
    lines
}

/// What an event waits for, back to what has happened.
fn chain(waits: &Waits, situation: &Situation) -> Vec<String> {
    let network = situation.network();
    let first = network.label(waits.events[0]);
    if let Some((time, how)) = situation.fixed(waits.events[0]) {
        return vec![format!("`{first}` waits for nothing: {} at {time} s", how.word())];
    }
    let mut lines = vec![format!("`{first}`, if nothing more is heard:")];
    let rows: Vec<[String; 3]> = waits
        .events
        .iter()
        .map(|&event| {
            let time =
                waits.ahead.known(event).fixed.map_or("-".to_string(), |fixed| format!("{} s", fixed.time));
            [time, network.label(event).to_string(), because(waits, situation, event)]
        })
        .collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let [first, second] = [0, 1].map(width);
    lines.extend(rows.iter().map(|[time, event, why]| {
        format!("  {time:>first$}  {event:<second$}  {why}").trim_end().to_string()
    }));
    lines
}

/// What decides the time of an event that is to come, or that it is not.
pub(super) fn because(waits: &Waits, situation: &Situation, event: EventId) -> String {
    if let Some((_, how)) = situation.fixed(event) {
        return format!("done: {}", how.word());
    }
    if let Some(since) = situation.with_driver(event) {
        return format!("with the driver since {since} s");
    }
    match nature(situation.network(), event) {
        Some(words) => words,
        None => why_event(&waits.ahead, event, situation.network().label(event)),
    }
}

/// What Nature decides.
fn nature(network: &Network, event: EventId) -> Option<String> {
    let link = network.contingents()[network.link_of(event)?];
    let heard = match (link.delay.min, link.delay.max.finite()) {
        (Duration::ZERO, Some(Duration::ZERO)) => "heard at once".to_string(),
        (min, Some(max)) if min == max => format!("heard {min} s late"),
        (min, Some(max)) => format!("heard {min} to {max} s late"),
        (min, None) => format!("heard {min} s late or more, or never"),
    };
    let from = network.label(link.from);
    Some(format!("Nature's: {} to {} s after `{from}`, {heard}", link.lower, link.upper))
}
