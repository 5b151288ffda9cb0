//! Recognises text that is not RMPL at all, so that it earns one message and not fifty.

use super::problem::{Foreign, ForeignToken, Problem};
use crate::source::Span;
use crate::words::DEFINITIONS;

/// True if the text begins with `(` and the name of a top-level form.
pub(super) fn begins_definition(text: &str) -> bool {
    let Some(rest) = text.strip_prefix('(') else { return false };
    let word =
        rest.as_bytes().iter().take(64).position(|b| b.is_ascii_whitespace() || matches!(b, b'(' | b')'));
    let Some(word) = word.and_then(|end| rest.get(..end)) else { return false };
    let name = word.rsplit(':').next().unwrap_or(word);
    DEFINITIONS.iter().any(|known| known.eq_ignore_ascii_case(name))
}

/// Says what a text is that has nothing to do with RMPL, or is no text.
pub(super) fn foreign_text(text: &str, source: u32) -> Option<Problem<'static>> {
    let odd = |c: char| c == '\u{FFFD}' || (c.is_control() && !matches!(c, '\n' | '\r' | '\t' | '\u{c}'));
    if text.starts_with("%PDF") || text.starts_with("PK\u{3}\u{4}") || text.contains('\0') {
        let at = text.find(odd).unwrap_or(0);
        return Some(not_text(source, text, at));
    }
    if let Some(at) = text.find(odd)
        && text.chars().filter(|c| odd(*c)).count() * 20 > text.chars().count()
    {
        return Some(not_text(source, text, at));
    }
    let (start, line) = first_line(text)?;
    let is = foreign_line(line)?;
    let has_definition = text.match_indices('(').any(|(at, _)| begins_definition(&text[at..]));
    let line = Span::new(source, start, start + line.trim_end().len());
    (!has_definition).then_some(Problem::ForeignText { line, is })
}

/// Names the language of a line that is certainly not RMPL.
pub(super) fn foreign_line(line: &str) -> Option<Foreign> {
    let line = line.trim();
    let first = line.split_whitespace().next().unwrap_or("");
    let starts = |words: &[&str]| words.iter().any(|word| line.starts_with(word));
    Some(if line.starts_with("#!") {
        Foreign::Script
    } else if is_prompt(line) {
        Foreign::Prompt
    } else if starts(&["kirk run", "kirk check", "kirk compile", "cargo ", "git ", "sudo ", "curl "]) {
        Foreign::Command
    } else if starts(&["<<<<<<<", "=======", ">>>>>>>", "|||||||"]) {
        Foreign::MergeMark
    } else if starts(&["--- ", "+++ ", "@@ ", "diff "]) {
        Foreign::Patch
    } else if starts(&["<?xml", "<graphml"]) {
        Foreign::Xml
    } else if starts(&["<!DOCTYPE", "<!doctype", "<html"]) {
        Foreign::Html
    } else if line.starts_with('<') {
        Foreign::XmlOrHtml
    } else if line.starts_with('{') || (line.starts_with('[') && !line.starts_with("[(")) {
        Foreign::Json
    } else if starts(&["(define (domain", "(define (problem"]) {
        Foreign::Pddl
    } else if starts(&["def ", "import ", "from ", "class "]) && (line.ends_with(':') || !line.contains('('))
        || starts(&["for ", "while ", "if ", "with ", "async def "]) && line.ends_with(':')
        || line.starts_with("print(")
    {
        Foreign::Python
    } else if starts(&["let ", "const ", "var ", "function ", "export "]) {
        Foreign::JavaScript
    } else if starts(&["fn ", "use ", "pub ", "impl ", "mod "]) {
        Foreign::Rust
    } else if starts(&["#include", "#define", "int ", "void "]) {
        Foreign::C
    } else if starts(&["package ", "public ", "private "]) {
        Foreign::JavaOrGo
    } else if line == "---" || (first.ends_with(':') && first.len() > 1 && !first.starts_with(':')) {
        Foreign::Yaml
    } else if starts(&["# ", "## ", "```"]) {
        Foreign::Markdown
    } else if line.starts_with("//") || line.starts_with("/*") {
        Foreign::Comment
    } else if line.split_whitespace().nth(1) == Some("=") {
        Foreign::Assignment
    } else {
        return None;
    })
}

/// What it is, its length, and how many bytes of it open and close it.
pub(super) struct Found {
    pub(super) is: ForeignToken,
    pub(super) length: usize,
    pub(super) open: usize,
    pub(super) close: usize,
}

/// A comment or a string as other languages and word processors write them.
pub(super) fn foreign_token(text: &str) -> Option<Found> {
    /// How far the end of a comment is looked for.
    const NEAR: usize = 1_000;
    let line = || text.lines().next().unwrap_or("").len();
    if text.starts_with("/*") {
        let end = text.bytes().take(NEAR).zip(text.bytes().skip(1)).position(|pair| pair == (b'*', b'/'));
        return Some(match end {
            Some(at) => Found { is: ForeignToken::BlockComment, length: at + 2, open: 2, close: 2 },
            None => Found { is: ForeignToken::LineComment, length: line(), open: 2, close: 0 },
        });
    }
    let hash =
        text.strip_prefix('#').is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '\t', '#']));
    if text.starts_with("//") || hash {
        let open = if hash { 1 } else { 2 };
        return Some(Found { is: ForeignToken::LineComment, length: line(), open, close: 0 });
    }
    let first = text.chars().next()?;
    let closing = match first {
        '“' | '„' => ['”', '“'],
        '«' => ['»', '»'],
        '‘' => ['’', '’'],
        _ => return None,
    };
    let open = first.len_utf8();
    let end = text[open..].char_indices().take(NEAR).find(|(_, c)| closing.contains(c) || *c == '\n');
    let (is, length, close) = match end.filter(|(_, c)| *c != '\n') {
        Some((at, c)) => (ForeignToken::String, open + at + c.len_utf8(), c.len_utf8()),
        // One that closes nothing, like the one that a word processor makes of a quote.
        None if first == '‘' => (ForeignToken::Quote, open, 0),
        None => (ForeignToken::UnclosedString, line(), 0),
    };
    Some(Found { is, length, open, close })
}

fn not_text(source: u32, text: &str, at: usize) -> Problem<'static> {
    let length = text[at..].chars().next().map_or(0, char::len_utf8);
    Problem::NotText { at: Span::new(source, at, at + length) }
}

/// The first line that is neither blank nor a comment, and where it begins.
fn first_line(text: &str) -> Option<(usize, &str)> {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{FEFF}');
        if !trimmed.is_empty() && !trimmed.starts_with(';') {
            return Some((at + line.len() - trimmed.len(), trimmed));
        }
        at += line.len();
    }
    None
}

/// True of a line that was typed at the prompt of a shell: `$ kirk check`, `(base) user@host:~$ kirk check`, `~/missions $ kirk`.
pub(super) fn is_prompt(line: &str) -> bool {
    let line = line.trim();
    // The environment of Python or conda that is active, or the bracket some systems begin with.
    let line = match line.strip_prefix('(').and_then(|rest| rest.split_once(") ")) {
        Some((environment, rest)) if !environment.contains([' ', '(']) => rest.trim_start(),
        _ => line.strip_prefix('[').unwrap_or(line),
    };
    let first = line.split(' ').next().unwrap_or("");
    let is_path = first.starts_with('~') || first.starts_with('/');
    matches!(first, "$" | "%" | ">" | ">>>" | "❯" | "➜") && first != line
        || first.len() > 1 && first.ends_with('$') && first != line && !first.contains(['(', ')'])
        || is_path && [" $ ", " % ", " # ", " ❯ "].iter().any(|mark| line.contains(mark))
        || ["PS C:", "C:\\"].iter().any(|start| line.starts_with(start))
        || is_user_prompt(line)
}

/// `user@host:~$ command`.
fn is_user_prompt(line: &str) -> bool {
    let Some((user, rest)) = line.split_once('@') else { return false };
    !user.is_empty()
        && user.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '('))
        && (rest.contains("$ ") || rest.contains("# ") || rest.contains("% ") || rest.ends_with('$'))
}
