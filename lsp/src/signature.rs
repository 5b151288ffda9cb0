//! How the form around the cursor is written, and which part of it the cursor is in.

use kirk_compiler::words::word;

use crate::analysis::Analysis;
use crate::cursor::cursor;
use crate::hover::program;

/// The form around the cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// How it is written.
    pub label: String,
    /// Its parts, as bytes of the label.
    pub parameters: Vec<(usize, usize)>,
    /// The part the cursor is in.
    pub active: Option<usize>,
    /// What it means, in Markdown.
    pub about: String,
}

/// The innermost form around an offset that is a call or begins with a word of the language.
pub fn signature(analysis: &Analysis, offset: u32) -> Option<Signature> {
    let cursor = cursor(analysis.text(), offset)?;
    for (level, open) in cursor.open.iter().rev().enumerate() {
        // The head itself is still being written.
        if level == 0 && cursor.first {
            continue;
        }
        let head = cursor.head(level);
        let part = open.before.saturating_sub(1 + usize::from(level > 0));
        let called = analysis.program.programs.iter().find(|program| program.name.name == head);
        let (label, about) = match (called, word(&head)) {
            (Some(called), _) => (called.shape(), program(analysis.source_of(called.span), called)),
            (None, Some(word)) => (word.shape(), word.about.to_string()),
            (None, None) => continue,
        };
        let parameters = parts(&label);
        let repeats = parameters.last().is_some_and(|(start, end)| label[*start..*end].ends_with("..."));
        let active = match parameters.len() {
            0 => None,
            count if part < count => Some(part),
            count if repeats => Some(count - 1),
            _ => None,
        };
        return Some(Signature { label, parameters, active, about });
    }
    None
}

/// The parts of a shape after its head: what blanks separate outside of inner parentheses.
fn parts(shape: &str) -> Vec<(usize, usize)> {
    let inner = shape.len() - 1;
    let mut found = Vec::new();
    let (mut depth, mut start) = (0_usize, 1);
    for (at, c) in shape.char_indices().skip(1) {
        match c {
            '(' => depth += 1,
            ')' if depth > 0 => depth -= 1,
            _ => {}
        }
        if depth == 0 && (c == ' ' || at == inner) {
            found.push((start, at));
            start = at + 1;
        }
    }
    found.into_iter().skip(1).filter(|(start, end)| start < end).collect()
}
