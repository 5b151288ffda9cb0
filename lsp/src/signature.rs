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
        let ((label, parameters), repeats, about) = match (called, word(&head)) {
            (Some(called), _) => {
                let names = called.parameters.iter().map(|parameter| parameter.name.as_str());
                (written(&head, names), false, program(analysis.source_of(called.span), called))
            }
            (None, Some(word)) => (written(word.name, word.pieces()), word.repeats(), word.about.to_string()),
            (None, None) => continue,
        };
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

/// A form as it is written, and which bytes of that its parts are.
fn written<'a>(head: &str, parts: impl Iterator<Item = &'a str>) -> (String, Vec<(usize, usize)>) {
    let mut label = format!("({head}");
    let mut places = Vec::new();
    for part in parts {
        label.push(' ');
        places.push((label.len(), label.len() + part.len()));
        label.push_str(part);
    }
    (label + ")", places)
}
