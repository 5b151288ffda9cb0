//! The tokens of a text, one at a time, by the grammar in `grammar/rmpl.pest`.

use pest::Parser;
use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "../grammar/rmpl.pest"]
struct Grammar;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// The end of the text.
    End,
    /// `(`.
    Open,
    /// `)`.
    Close,
    /// `'`.
    Quote,
    /// `"..."`.
    String,
    /// `"...`, to the end of the text.
    UnclosedString,
    /// `#:name`.
    Uninterned,
    /// A number.
    Number,
    /// `:name`.
    Keyword,
    /// A name.
    Symbol,
    /// What has no meaning.
    Unreadable,
    /// `#| ...`, to the end of the text.
    UnclosedComment,
}

/// A token and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Its first byte.
    pub start: usize,
    /// The byte after its last.
    pub end: usize,
}

/// All tokens of a text, without comments, and without the one for its end.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Tokens::new(text);
    std::iter::from_fn(|| Some(tokens.take()).filter(|token| token.kind != TokenKind::End)).collect()
}

/// Reads a text token by token.
pub(crate) struct Tokens<'a> {
    text: &'a str,
    at: usize,
    peeked: Option<Token>,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(text: &'a str) -> Tokens<'a> {
        Tokens { text, at: 0, peeked: None }
    }

    /// The next token; the last one is `End`, again and again.
    pub(crate) fn take(&mut self) -> Token {
        let token = self.peek();
        self.peeked = None;
        self.at = token.end;
        token
    }

    /// The token `take` will return.
    pub(crate) fn peek(&mut self) -> Token {
        let token = self.peeked.unwrap_or_else(|| self.scan(self.at));
        self.peeked = Some(token);
        token
    }

    /// Goes on reading at a byte offset.
    pub(crate) fn seek(&mut self, at: usize) {
        let boundary = (at..self.text.len()).find(|at| self.text.is_char_boundary(*at));
        self.at = boundary.unwrap_or(self.text.len());
        self.peeked = None;
    }

    /// Where the next token is looked for.
    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// The first token at or after `at`, block comments left out.
    fn scan(&self, mut at: usize) -> Token {
        loop {
            let (rule, start, end) = step(Rule::item, self.text, at);
            let kind = match rule {
                Rule::open => TokenKind::Open,
                Rule::close => TokenKind::Close,
                Rule::quote => TokenKind::Quote,
                Rule::string => TokenKind::String,
                Rule::unclosed_string => TokenKind::UnclosedString,
                Rule::uninterned => TokenKind::Uninterned,
                Rule::number => TokenKind::Number,
                Rule::keyword => TokenKind::Keyword,
                Rule::symbol => TokenKind::Symbol,
                Rule::EOI => TokenKind::End,
                Rule::comment_open => {
                    match self.comment_end(end) {
                        Some(after) => at = after,
                        None => {
                            return Token { kind: TokenKind::UnclosedComment, start, end: self.text.len() };
                        }
                    }
                    continue;
                }
                _ => TokenKind::Unreadable,
            };
            return Token { kind, start, end };
        }
    }

    /// Where the block comment ends whose contents begin at `at`.
    fn comment_end(&self, mut at: usize) -> Option<usize> {
        let mut depth = 1_usize;
        while depth > 0 {
            let (rule, _, end) = step(Rule::commented, self.text, at);
            match rule {
                Rule::comment_open => depth += 1,
                Rule::comment_close => depth -= 1,
                _ => return None,
            }
            at = end;
        }
        Some(at)
    }
}

/// Applies one of the two entry rules of the grammar at `at`: the rule of the token found there, its start and end.
fn step(rule: Rule, text: &str, at: usize) -> (Rule, usize, usize) {
    let found = Grammar::parse(rule, &text[at..]).ok().and_then(|pairs| pairs.flatten().nth(1));
    match found {
        Some(pair) => (pair.as_rule(), at + pair.as_span().start(), at + pair.as_span().end()),
        // The entry rules succeed on every text; should one not, the rest is one unreadable token.
        None if at < text.len() => (Rule::unreadable, at, text.len()),
        None => (Rule::EOI, at, at),
    }
}
