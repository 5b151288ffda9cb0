//! Where a place in a half-written text is: the forms that are open there, and the word being written. Looks at tokens
//! only, as there may be no forms yet.

use kirk_compiler::Span;
use kirk_compiler::read::{Token, TokenKind, tokens};
use kirk_compiler::words::{DEFINITIONS, Keyword, SLOT, word};

/// The place in a text.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    /// The forms open here, the outermost first.
    pub(crate) open: Vec<Open<'a>>,
    /// The word at the cursor, empty if there is none.
    pub(crate) word: Span,
    /// True if the last thing before the word is a `(`: the word is the first of its form.
    pub(crate) first: bool,
    /// The keyword right before the word, in lower case, without the colon.
    pub(crate) keyword: Option<String>,
}

/// A form that is open.
#[derive(Clone, Debug)]
pub(crate) struct Open<'a> {
    /// Its first word as written; empty if it begins with something else, or with nothing yet.
    pub(crate) head: &'a str,
    /// How many elements stand before the cursor, its head counted, the word at the cursor not.
    pub(crate) before: usize,
}

/// Looks at a place; `None` inside of strings and comments.
pub(crate) fn cursor(text: &str, offset: u32) -> Option<Cursor<'_>> {
    let offset = offset as usize;
    let tokens = tokens(text);
    if comments(text, &tokens).iter().any(|comment| inside_comment(text, *comment, offset)) {
        return None;
    }
    let mut cursor =
        Cursor { open: Vec::new(), word: Span::new(0, offset, offset), first: false, keyword: None };
    for token in tokens.iter().take_while(|token| token.start < offset) {
        let written = &text[token.start..token.end];
        match token.kind {
            TokenKind::String | TokenKind::UnclosedString
                if offset < token.end || token.kind == TokenKind::UnclosedString =>
            {
                return None;
            }
            TokenKind::Open => {
                if starts_a_line(text, token.start) && begins_definition(text, token.start) {
                    cursor.open.clear();
                }
                cursor.count();
                cursor.open.push(Open { head: "", before: 0 });
                (cursor.first, cursor.keyword) = (true, None);
                continue;
            }
            TokenKind::Close => {
                cursor.open.pop();
            }
            TokenKind::Symbol | TokenKind::Keyword | TokenKind::Number | TokenKind::Uninterned
                if offset <= token.end =>
            {
                cursor.word = Span::new(0, token.start, token.end);
                break;
            }
            TokenKind::Quote => continue,
            _ => {
                if let Some(open) = cursor.open.last_mut().filter(|open| open.before == 0) {
                    open.head = written;
                }
                cursor.count();
            }
        }
        cursor.first = false;
        cursor.keyword = (token.kind == TokenKind::Keyword).then(|| written[1..].to_lowercase());
    }
    Some(cursor)
}

/// Looks at a place that is pointed at: the word that begins there counts as well as the one that ends there.
pub(crate) fn pointed_at(text: &str, offset: u32) -> Option<Cursor<'_>> {
    let next = text.get(offset as usize..)?.chars().next().map_or(0, char::len_utf8) as u32;
    let here = cursor(text, offset).filter(|here| here.word.start < here.word.end);
    here.or_else(|| cursor(text, offset + next))
}

impl Cursor<'_> {
    /// One element more in the innermost form.
    fn count(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.before += 1;
        }
    }

    /// The keywords that may stand here.
    pub(crate) fn keywords(&self) -> &'static [Keyword] {
        let head = self.head(0);
        // `(:slack t)` is a list of its own in the form it belongs to.
        let form = match head.is_empty() || head.starts_with(':') {
            true => self.head(1),
            false if self.is_in_slot() => return SLOT,
            false => head,
        };
        word(&form).map_or(&[], |word| word.keywords)
    }

    /// True in `(defclass name (super...) ((slot here`.
    pub(crate) fn is_in_slot(&self) -> bool {
        self.open.len() == 3 && self.head(1).is_empty() && self.head(2) == "defclass"
    }

    /// The head of the form so many levels out, in lower case and without a package; empty if there is none.
    pub(crate) fn head(&self, level: usize) -> String {
        let open = self.open.len().checked_sub(level + 1).map(|index| &self.open[index]);
        let head = open.map_or("", |open| open.head);
        head.rsplit(':').next().filter(|_| !head.starts_with(':')).unwrap_or(head).to_lowercase()
    }
}

/// All comments of a text, in order.
pub(crate) fn comments(text: &str, tokens: &[Token]) -> Vec<Span> {
    let mut found = Vec::new();
    let mut last = 0;
    let ends = tokens.iter().map(|token| (token.start, token.end, token.kind)).chain([(
        text.len(),
        text.len(),
        TokenKind::End,
    )]);
    for (start, end, kind) in ends {
        let mut at = last;
        while let Some(begin) = text.get(at..start).and_then(|gap| gap.find([';', '#'])) {
            let begin = at + begin;
            let rest = &text[begin..start];
            let length = match rest.starts_with(';') {
                true => rest.find('\n').unwrap_or(rest.len()),
                false => block(rest),
            };
            found.push(Span::new(0, begin, begin + rest[..length].trim_end_matches('\r').len()));
            at = begin + length;
        }
        if kind == TokenKind::UnclosedComment {
            found.push(Span::new(0, start, end));
        }
        last = end;
    }
    found
}

/// The length of the block comment the text begins with.
fn block(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while at < text.len() {
        match &text.as_bytes()[at..] {
            [b'#', b'|', ..] => (depth, at) = (depth + 1, at + 2),
            [b'|', b'#', ..] => (depth, at) = (depth.saturating_sub(1), at + 2),
            _ => at += 1,
        }
        if depth == 0 && text.is_char_boundary(at) {
            return at;
        }
    }
    text.len()
}

/// A line comment reaches to the end of its line, that included.
fn inside_comment(text: &str, comment: Span, offset: usize) -> bool {
    let (start, end) = (comment.start as usize, comment.end as usize);
    let to_the_end = text[start..].starts_with(';') || !text[start..end].ends_with("|#");
    start < offset && (offset < end || to_the_end && offset == end)
}

fn starts_a_line(text: &str, at: usize) -> bool {
    at == 0 || text.as_bytes()[at - 1] == b'\n'
}

/// The reader closes what is open where a definition begins in the first column; so do we.
fn begins_definition(text: &str, at: usize) -> bool {
    let rest = text[at + 1..].get(..30).unwrap_or(&text[at + 1..]).to_ascii_lowercase();
    DEFINITIONS.iter().any(|word| rest.starts_with(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The heads of the open forms, with the elements before the cursor, and the word there.
    fn at(marked: &str) -> String {
        let offset = marked.find('^').unwrap();
        let text = marked.replace('^', "");
        match cursor(&text, offset as u32) {
            None => "nothing".to_string(),
            Some(cursor) => {
                let open: Vec<String> =
                    cursor.open.iter().map(|open| format!("{}/{}", open.head, open.before)).collect();
                let word = &text[cursor.word.start as usize..offset];
                format!("{} | {}{word}", open.join(" "), if cursor.first { "(" } else { "" })
            }
        }
    }

    #[test]
    fn the_open_forms_and_the_word_are_found_in_half_written_text() {
        assert_eq!(at("^"), " | ");
        assert_eq!(at("(def^"), "/0 | (def");
        assert_eq!(at("(a (b c) :k ^"), "a/3 | ");
        assert_eq!(at("(a (b c ^d) e"), "a/2 b/2 | ");
        assert_eq!(at("(a (b c d^) e"), "a/2 b/2 | d");
        assert_eq!(at("(a \"s^\" b)"), "nothing");
        assert_eq!(at("(a \"s^"), "nothing");
        assert_eq!(at("(a ; b^\n)"), "nothing");
        assert_eq!(at("(a ; b\n^)"), "a/1 | ");
        assert_eq!(at("(a #| b^ |# c)"), "nothing");
        assert_eq!(at("(a #| b |#^ c)"), "a/1 | ");
        assert_eq!(at("(x (y (z\n(defparameter ^"), "defparameter/1 | ");
        assert_eq!(at("(a 'b ^)"), "a/2 | ");
        assert_eq!(at(")) (a ^"), "a/1 | ");
    }

    #[test]
    fn comments_are_found_between_the_tokens() {
        let text = "; eins\r\n(a #| zwei #| drei |# |# b) ;;\n\"; kein\" #| ö offen";
        let found: Vec<&str> = comments(text, &tokens(text))
            .iter()
            .map(|span| &text[span.start as usize..span.end as usize])
            .collect();
        assert_eq!(found, ["; eins", "#| zwei #| drei |# |#", ";;", "#| ö offen"]);
    }
}
