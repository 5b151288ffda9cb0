//! The requirements as they were, beside the edges they became.
//!
//! Edges do not say which of them belong together, nor that a bound stood there twice. A file that would otherwise be
//! read differently carries its requirements as rows `[from, to, lower, upper]` too: ids of nodes, and seconds as text,
//! `null` for no bound. The rows count as long as the edges say the same; after an edit in another tool the edges do.

use std::collections::BTreeMap;

use crate::model::{EventId, Requirement};
use crate::time::{Bound, Duration};

/// The key of the graph's datum.
pub(super) const KEY: &str = "Requirements";

/// From node, to node, lower bound, upper bound.
type Row = (String, String, Option<String>, Option<String>);

/// The rows as text.
pub(super) fn rows(requirements: &[Requirement], ids: &[String]) -> String {
    let seconds = |bound: Bound| bound.finite().map(|bound| bound.to_string());
    let row = |requirement: &Requirement| -> Row {
        let id = |event: EventId| ids[event.index()].clone();
        let (lower, upper) = (seconds(requirement.lower), seconds(requirement.upper));
        (id(requirement.from), id(requirement.to), lower, upper)
    };
    json_text(&requirements.iter().map(row).collect::<Vec<Row>>())
}

/// The requirements of the rows, `Ok(None)` if a node is no longer there.
///
/// # Errors
/// The text is not a list of rows.
pub(super) fn requirements(
    text: &str,
    ids: &BTreeMap<&str, EventId>,
) -> Result<Option<Vec<Requirement>>, String> {
    const SHAPE: &str = "`Requirements` must be a JSON list of rows, like [[\"Z\", \"A\", \"1.5\", null]]";
    let rows: Vec<Row> = serde_json::from_str(text).map_err(|_| SHAPE.to_string())?;
    let bound = |text: Option<String>| match text {
        None => Ok(Bound::Infinite),
        Some(text) => Duration::parse_seconds(&text)
            .map(Bound::Finite)
            .map_err(|error| format!("`Requirements`: the bound `{text}`: {error}")),
    };
    let mut found = Some(Vec::new());
    for (from, to, lower, upper) in rows {
        let (lower, upper) = (bound(lower)?, bound(upper)?);
        match (ids.get(from.as_str()), ids.get(to.as_str()), &mut found) {
            (Some(&from), Some(&to), Some(found)) => found.push(Requirement { from, to, lower, upper }),
            _ => found = None,
        }
    }
    Ok(found)
}

/// The tightest bound on `to - from` for each pair `(from, to)` that has one.
pub(super) fn tightest(requirements: &[Requirement]) -> BTreeMap<(EventId, EventId), Duration> {
    let mut edges = BTreeMap::new();
    for (from, to, weight) in requirements.iter().flat_map(Requirement::edges).flatten() {
        let known = edges.entry((from, to)).or_insert(weight);
        *known = weight.min(*known);
    }
    edges
}

/// JSON in which every character is one that XML allows.
pub(super) fn json_text(value: &impl serde::Serialize) -> String {
    let json = serde_json::to_string(value).unwrap_or_default();
    json.chars()
        .map(|char| if is_xml(char) { char.to_string() } else { format!("\\u{:04x}", char as u32) })
        .collect()
}

/// What may be in XML.
pub(super) fn is_xml(char: char) -> bool {
    matches!(char, '\t' | '\n' | '\r') || (char >= ' ' && !matches!(char, '\u{fffe}' | '\u{ffff}'))
}
