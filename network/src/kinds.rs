//! The kinds of temporal network that other tools know, and which of them kirk reads.

/// What is said of a kind that kirk does not read, by the name files give it.
///
/// # Errors
/// The kind and what it is, as the end of a sentence.
pub fn check(kind: &str) -> Result<(), String> {
    if ["", "STN", "STNU"].iter().any(|read| kind.eq_ignore_ascii_case(read)) {
        return Ok(());
    }
    let meaning = MEANINGS.iter().find(|(known, _)| kind.eq_ignore_ascii_case(known));
    let meaning = meaning.map_or(String::new(), |(_, meaning)| format!(", {meaning}"));
    Err(format!("`{kind}`{meaning}; this kirk reads `STNU` and `STN`"))
}

/// The kinds of the CSTNU Tool (R. Posenato, University of Verona).
const MEANINGS: [(&str, &str); 7] = [
    ("OSTNU", "an STNU with oracles (events that tell how long something will take before it is over)"),
    ("CSTN", "a conditional network (what must hold depends on what is observed)"),
    ("CSTNU", "a conditional network with uncertainty (what must hold depends on what is observed)"),
    ("CSTNPSU", "a conditional network whose uncertain durations may be shrunk in part"),
    ("PCSTNU", "a conditional network with parameters"),
    ("PSTN", "a probabilistic network (durations have distributions, not bounds)"),
    ("PSTNU", "a probabilistic network (durations have distributions, not bounds)"),
];
