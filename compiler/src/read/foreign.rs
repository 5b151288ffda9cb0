//! Recognises text that is not RMPL at all, so that it earns one message and not fifty.

use crate::code::Code;
use crate::diagnostic::Diagnostic;
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
pub(super) fn foreign_text(text: &str, source: u32) -> Option<Diagnostic> {
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
    let what = foreign_line(line)?;
    let has_definition = text.match_indices('(').any(|(at, _)| begins_definition(&text[at..]));
    (!has_definition).then(|| {
        Diagnostic::error(
            Code::NotRmpl,
            Span::new(source, start, start + line.trim_end().len()),
            format!("this is {what}, not RMPL"),
        )
        .primary("a definition in parentheses was expected here")
        .help("A mission begins like `(define-control-program main () (sequence (:slack t) (first) (second)))`.")
    })
}

/// Names the language of a line that is certainly not RMPL.
pub(super) fn foreign_line(line: &str) -> Option<&'static str> {
    let line = line.trim();
    let first = line.split_whitespace().next().unwrap_or("");
    let starts = |words: &[&str]| words.iter().any(|word| line.starts_with(word));
    Some(if line.starts_with("#!") {
        "a script for another program"
    } else if is_prompt(line) {
        "what was typed at a shell prompt"
    } else if starts(&["kirk run", "kirk check", "kirk compile", "cargo ", "git ", "sudo ", "curl "]) {
        "a command for the shell"
    } else if starts(&["<<<<<<<", "=======", ">>>>>>>", "|||||||"]) {
        "the mark of a merge that has not been settled"
    } else if starts(&["--- ", "+++ ", "@@ ", "diff "]) {
        "part of a patch"
    } else if starts(&["<?xml", "<graphml"]) {
        "XML"
    } else if starts(&["<!DOCTYPE", "<!doctype", "<html"]) {
        "HTML"
    } else if line.starts_with('<') {
        "XML or HTML"
    } else if line.starts_with('{') || (line.starts_with('[') && !line.starts_with("[(")) {
        "JSON"
    } else if starts(&["(define (domain", "(define (problem"]) {
        "PDDL"
    } else if starts(&["def ", "import ", "from ", "class "]) && (line.ends_with(':') || !line.contains('('))
        || starts(&["for ", "while ", "if ", "with ", "async def "]) && line.ends_with(':')
        || line.starts_with("print(")
    {
        "Python"
    } else if starts(&["let ", "const ", "var ", "function ", "export "]) {
        "JavaScript or another language with `let` and `=`"
    } else if starts(&["fn ", "use ", "pub ", "impl ", "mod "]) {
        "Rust"
    } else if starts(&["#include", "#define", "int ", "void "]) {
        "C or C++"
    } else if starts(&["package ", "public ", "private "]) {
        "Java or Go"
    } else if line == "---" || (first.ends_with(':') && first.len() > 1 && !first.starts_with(':')) {
        "YAML or a list of settings"
    } else if starts(&["# ", "## ", "```"]) {
        "Markdown, or a comment of another language"
    } else if line.starts_with("//") || line.starts_with("/*") {
        "a comment of another language"
    } else if line.split_whitespace().nth(1) == Some("=") {
        "an assignment of another language"
    } else {
        return None;
    })
}

/// The length of something in the text, how many bytes of it open and close it, what to write instead of those, and what to
/// say about it.
pub(super) struct Found {
    pub(super) length: usize,
    pub(super) open: usize,
    pub(super) close: usize,
    pub(super) instead: [&'static str; 2],
    pub(super) problem: fn(Span) -> Diagnostic,
}

/// A comment or a string as other languages and word processors write them.
pub(super) fn foreign_token(text: &str) -> Option<Found> {
    /// How far the end of a comment is looked for.
    const NEAR: usize = 1_000;
    let line = || text.lines().next().unwrap_or("").len();
    let problem = |span| {
        Diagnostic::error(Code::Unreadable, span, "this is a comment of another language")
            .primary("not RMPL")
            .help("A comment begins with `;` and goes to the end of the line.")
    };
    if text.starts_with("/*") {
        let end = text.bytes().take(NEAR).zip(text.bytes().skip(1)).position(|pair| pair == (b'*', b'/'));
        let (length, close, instead) = match end {
            Some(at) => (at + 2, 2, ["#|", "|#"]),
            None => (line(), 0, [";", ""]),
        };
        return Some(Found { length, open: 2, close, instead, problem });
    }
    let hash =
        text.strip_prefix('#').is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '\t', '#']));
    if text.starts_with("//") || hash {
        let open = if hash { 1 } else { 2 };
        return Some(Found { length: line(), open, close: 0, instead: [";", ""], problem });
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
    match end.filter(|(_, c)| *c != '\n') {
        Some((at, c)) => {
            let (length, close) = (open + at + c.len_utf8(), c.len_utf8());
            let problem = |span| {
                Diagnostic::error(Code::Unreadable, span, "these are not the quotation marks of a program")
                    .primary("not RMPL")
                    .help("A string stands in straight quotation marks: `\"text\"`.")
            };
            Some(Found { length, open, close, instead: ["\"", "\""], problem })
        }
        // One that closes nothing, like the one that a word processor makes of a quote.
        None if first == '‘' => {
            let problem = |span| {
                Diagnostic::error(Code::Unreadable, span, "the character `‘` (U+2018) has no meaning here")
                    .primary("a curly quotation mark")
                    .help("A symbol that stands for itself is quoted with a straight one: `'name`; the name of a program is not quoted.")
            };
            Some(Found { length: open, open, close: 0, instead: ["'", ""], problem })
        }
        None => {
            let problem = |span| {
                Diagnostic::error(Code::Unreadable, span, "this quotation mark is not one of a program")
                    .primary("not RMPL, and never closed")
                    .help("A string stands in straight quotation marks: `\"text\"`.")
            };
            Some(Found { length: line(), open, close: 0, instead: ["", ""], problem })
        }
    }
}

fn not_text(source: u32, text: &str, at: usize) -> Diagnostic {
    let length = text[at..].chars().next().map_or(0, char::len_utf8);
    Diagnostic::error(Code::NotText, Span::new(source, at, at + length), "this is not text")
        .primary("no text contains this")
        .help("kirk reads RMPL programs as UTF-8 text; this looks like a binary file.")
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
