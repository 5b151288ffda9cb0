//! What becomes of the requirements once Nature has broken the model, in words.

use kirk_network::Duration;
use kirk_runtime::{Aftermath, Lost, Side};

/// One line for each bound that is not kept, and one for all that are.
pub(crate) fn lines(aftermath: &Aftermath) -> Vec<String> {
    let Aftermath { violated, in_doubt, given_up, kept, .. } = aftermath;
    let of = |what: &str, lost: &[Lost], found: &str| -> Vec<String> {
        let found = |lost: &Lost| lost.found.map_or(String::new(), |length| format!(": {found} {length} s"));
        let line = |lost: &Lost| format!("  {what:<9} {}{}", words(lost), found(lost));
        once(lost.iter().map(line))
    };
    let lost = violated.len() + in_doubt.len() + given_up.len();
    let mut lines = of("broken", violated, "it was");
    lines.extend(of("in doubt", in_doubt, "it may have been"));
    lines.extend(of("given up", given_up, ""));
    lines.push(match lost {
        0 => format!("  {:<9} all {kept} bounds", "kept"),
        _ => format!("  {:<9} {kept} of {} bounds", "kept", kept + lost),
    });
    lines
}

/// Lines that say the same, as a form and a `between` may, as one.
fn once(lines: impl Iterator<Item = String>) -> Vec<String> {
    let mut counted: Vec<(String, usize)> = Vec::new();
    for line in lines {
        match counted.iter_mut().find(|(known, _)| *known == line) {
            Some((_, count)) => *count += 1,
            None => counted.push((line, 1)),
        }
    }
    let told = |(line, count)| if count > 1 { format!("{line} ({count} bounds)") } else { line };
    counted.into_iter().map(told).collect()
}

/// A bound as a clause.
fn words(Lost { from, to, bound, value, .. }: &Lost) -> String {
    let (least, most) = match bound {
        Side::Lower => ("at least", "at most"),
        Side::Upper => ("at most", "at least"),
    };
    match *value < Duration::ZERO {
        false => format!("`{to}` {least} {value} s after `{from}`"),
        true => format!("`{to}` {most} {} s before `{from}`", -*value),
    }
}
