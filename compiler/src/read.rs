//! Text to forms. Never fails: damage is reported, and the next top-level form is read all the same.
//!
//! The tokens are those of `grammar/rmpl.pest`, read one at a time; the nesting is kept on a stack of our own, so depth
//! costs memory and not the stack of the machine. A `(` in the first column that begins a definition while an earlier
//! form is open means that the earlier form was never closed.

mod damage;
pub(crate) mod foreign;
pub(crate) mod problem;
mod token;

use crate::form::{Form, FormKind, Symbol};
use crate::problem::Problems;
use crate::source::{Source, Span};
use damage::with_commas;
use foreign::{Found, begins_definition, foreign_text, foreign_token};
use problem::{ForeignToken, Problem};
pub(crate) use token::Tokens;

pub use token::{Token, TokenKind, tokens};

/// How deep forms may be nested.
pub const MAX_NESTING: usize = 1_000;

/// How long a source may be, in bytes: several times what the largest program that can be unfolded needs.
pub const MAX_LENGTH: usize = 16 << 20;

/// Reads the top-level forms of source number `index`.
pub fn read(source: &Source, index: u32, problems: &mut Problems) -> Vec<Form> {
    if source.text.len() > MAX_LENGTH {
        let at = (MAX_LENGTH..source.text.len()).find(|at| source.text.is_char_boundary(*at));
        let end = Span::new(index, at.unwrap_or(0), at.unwrap_or(0));
        problems.push(Problem::TooLong { end });
        problems.lose_definitions();
        return Vec::new();
    }
    if let Some(problem) = foreign_text(&source.text, index) {
        problems.push(problem);
        problems.lose_definitions();
        return Vec::new();
    }
    let clean = !problems.has_errors();
    let mut reader = Reader::new(&source.text, index, problems);
    reader.run();
    let forms = reader.forms;
    if forms.is_empty() && clean && !problems.has_errors() {
        problems.lose_definitions();
        let comments = !source.text.trim().is_empty();
        problems.push(Problem::Empty { start: Span::new(index, 0, 0), comments });
    }
    forms
}

/// A form whose closing parenthesis has not been seen yet.
struct Open {
    at: usize,
    column: usize,
    mark: Mark,
    items: Vec<Form>,
    /// The last thing in it that a line begins with: its column, and where it is.
    line_item: Option<(usize, usize)>,
}

/// A form whose contents are indented as if it had been closed before.
#[derive(Clone, Copy)]
struct Suspect {
    at: usize,
    /// Where it would be closed then.
    end: usize,
}

/// What opened a form.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    /// `(`.
    List,
    /// `[` or `{`, which has been reported.
    Bracket,
    /// `'`.
    Quote,
    /// A mark that has been reported, and so the form after it is lost.
    Lost,
}

impl Mark {
    /// True if it belongs to the one form that follows.
    fn is_prefix(self) -> bool {
        matches!(self, Mark::Quote | Mark::Lost)
    }
}

struct Reader<'a> {
    text: &'a str,
    source: u32,
    tokens: Tokens<'a>,
    problems: &'a mut Problems,
    forms: Vec<Form>,
    stack: Vec<Open>,
    /// How many parentheses beyond the nesting limit are open; what is inside them is not built.
    skipped: usize,
    /// The first form whose contents are indented as if it had been closed.
    suspect: Option<Suspect>,
    /// The first line that is indented as if a form that is closed were still open: that form, and the line.
    closed_early: Option<(usize, usize)>,
    /// True if the nesting limit has been reported for this top-level form.
    too_deep: bool,
    line_start: usize,
    /// True while nothing but blanks has been seen on this line.
    first_on_line: bool,
    /// Where the last token ends that was taken.
    last_end: usize,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, source: u32, problems: &'a mut Problems) -> Reader<'a> {
        Reader {
            text,
            source,
            tokens: Tokens::new(text),
            problems,
            forms: Vec::new(),
            stack: Vec::new(),
            skipped: 0,
            suspect: None,
            closed_early: None,
            too_deep: false,
            line_start: 0,
            first_on_line: true,
            last_end: 0,
        }
    }

    fn run(&mut self) {
        let mut last_end = 0;
        loop {
            let token = self.tokens.take();
            self.note_line(last_end, token.start);
            last_end = token.end;
            match token.kind {
                TokenKind::End => break,
                _ if self.is_at_prompt(token) => self.prompt(token),
                TokenKind::Open => self.open(token),
                TokenKind::Close => self.close(token),
                TokenKind::Quote if self.stack.is_empty() => self.stray(token),
                TokenKind::Quote => self.push(token.start, Mark::Quote),
                TokenKind::UnclosedComment => {
                    let mark = self.span(token.start, token.start + 2);
                    self.problems.push(Problem::UnclosedComment { mark });
                    self.problems.lose_definitions();
                    break;
                }

                _ if self.stack.is_empty() => self.stray(token),
                _ if self.skipped_as_foreign(token) => {}
                TokenKind::Number if self.skipped_as_number(token) => {}
                TokenKind::Unreadable => self.unreadable(token),
                _ => self.atom(token),
            }
            self.first_on_line = false;
            self.last_end = self.tokens.position();
        }
        if !self.stack.is_empty() {
            self.unclosed(None);
        }
    }

    /// Keeps track of the line the next token is on.
    fn note_line(&mut self, from: usize, to: usize) {
        if let Some(newline) = self.text.get(from..to).and_then(|gap| gap.rfind('\n')) {
            self.line_start = from + newline + 1;
            self.first_on_line = true;
        }
    }

    fn open(&mut self, token: Token) {
        let column = token.start - self.line_start;
        if column == 0 && !self.stack.is_empty() && begins_definition(&self.text[token.start..]) {
            self.unclosed(Some(token.start));
        }
        self.push(token.start, Mark::List);
    }

    fn push(&mut self, at: usize, mark: Mark) {
        if self.skipped > 0 || self.stack.len() >= MAX_NESTING {
            if self.skipped == 0 && !std::mem::replace(&mut self.too_deep, true) {
                let span = self.span(at, at + 1);
                self.problems.push(Problem::TooDeep { at: span });
                if let Some(top) = self.stack.last_mut() {
                    top.items.push(Form { span, kind: FormKind::Error });
                }
            }
            if !mark.is_prefix() {
                self.skipped += 1;
            }
            return;
        }
        let column = at - self.line_start;
        if self.first_on_line && self.suspect.is_none() {
            self.suspect = self
                .stack
                .last()
                .filter(|top| !top.mark.is_prefix() && column <= top.column)
                .map(|top| Suspect { at: top.at, end: self.last_end });
        }
        self.note_item(at);
        self.stack.push(Open { at, column, mark, items: Vec::new(), line_item: None });
    }

    /// Keeps track of what the lines begin with, and how far it is indented.
    fn note_item(&mut self, at: usize) {
        let column = at - self.line_start;
        let first = self.first_on_line;
        match self.stack.last_mut() {
            None => self.closed_early = None,
            Some(top) if first => {
                if let Some((before, item)) = top.line_item
                    && before < column
                {
                    self.closed_early.get_or_insert((item, at));
                }
                top.line_item = Some((column, at));
            }
            Some(_) => {}
        }
    }

    fn close(&mut self, token: Token) {
        if self.skipped > 0 {
            self.skipped -= 1;
            return;
        }
        let mut dangling = None;
        while let Some(top) = self.stack.pop_if(|top| top.mark.is_prefix()) {
            dangling = Some(top.at);
        }
        if let Some(at) = dangling {
            self.problems.push(Problem::NothingQuoted { quote: self.span(at, at + 1) });
        }
        match self.stack.pop() {
            Some(mut open) => {
                open.items.shrink_to_fit();
                let span = self.span(open.at, token.end);
                self.finish(Form { span, kind: FormKind::List(open.items) });
            }
            None => self.stray_close(token),
        }
    }

    /// Puts a finished form where it belongs: into the quotes before it, then into the open form or the top level.
    fn finish(&mut self, mut form: Form) {
        while let Some(quote) = self.stack.pop_if(|top| top.mark.is_prefix()) {
            let span = self.span(quote.at, form.span.end as usize);
            let kind =
                if quote.mark == Mark::Quote { FormKind::Quote(Box::new(form)) } else { FormKind::Error };
            form = Form { span, kind };
        }
        match self.stack.last_mut() {
            Some(top) => top.items.push(form),
            None => {
                self.suspect = None;
                self.too_deep = false;
                self.forms.push(form);
            }
        }
    }

    fn atom(&mut self, token: Token) {
        self.note_item(token.start);
        let text = &self.text[token.start..token.end];
        let span = self.span(token.start, token.end);
        let kind = match token.kind {
            TokenKind::String => {
                // A string that runs over the beginning of a definition has lost its closing quote.
                let runaway = text.match_indices('\n').any(|(at, _)| begins_definition(&text[at + 1..]));
                if runaway {
                    self.unclosed_string(token.start);
                    return;
                }
                if self.text[token.end..].starts_with(|c: char| c.is_alphanumeric()) {
                    self.string_goes_on(token);
                    return;
                }
                FormKind::String(unescape(&text[1..text.len() - 1]))
            }
            TokenKind::UnclosedString => {
                self.unclosed_string(token.start);
                return;
            }
            TokenKind::Number => FormKind::Number(text.trim_start_matches('+').to_lowercase()),
            TokenKind::Keyword => FormKind::Keyword(text[1..].to_lowercase()),
            TokenKind::Uninterned => FormKind::Uninterned(text[2..].to_lowercase()),
            _ => FormKind::Symbol(symbol(text)),
        };
        if self.skipped == 0 {
            self.finish(Form { span, kind });
        }
    }

    /// Reports comments and strings as they are written elsewhere, and goes on behind them.
    fn skipped_as_foreign(&mut self, token: Token) -> bool {
        let Some(found) = foreign_token(&self.text[token.start..]) else { return false };
        let Found { is, length, open, close } = found;
        let end = token.start + length;
        let shown = self.text[token.start..end].lines().next().unwrap_or("");
        self.problems.push(Problem::ForeignToken {
            at: self.span(token.start, token.start + shown.len()),
            is,
            open: self.span(token.start, token.start + open),
            close: self.span(end - close, end),
        });
        self.tokens.seek(end);
        // What it was meant for is there all the same.
        match is {
            ForeignToken::Quote => self.push(token.start, Mark::Quote),
            ForeignToken::String if self.skipped == 0 => {
                let words = self.text[token.start + open..end - close].to_string();
                self.finish(Form { span: self.span(token.start, end), kind: FormKind::String(words) });
            }
            _ => {}
        }
        true
    }

    /// Reports what has no meaning, and makes the best of it: brackets hold a list together, a mark of Lisp belongs to
    /// the form after it.
    fn unreadable(&mut self, token: Token) {
        let text = &self.text[token.start..token.end];
        let span = self.span(token.start, token.end);
        if matches!(text, "]" | "}") && self.stack.last().is_some_and(|top| top.mark == Mark::Bracket) {
            self.close(token);
            return;
        }
        let closed = match text {
            "[" | "{" if self.problems.wants(self.source) => self.closing_bracket(),
            _ => None,
        };
        self.problems.push(match (text, closed) {
            // Before a blank it is no mark of Lisp.
            (",", _) if self.text[token.end..].starts_with(char::is_whitespace) => {
                Problem::LoneComma { at: span }
            }
            (bracket, Some(close)) => {
                Problem::Brackets { open: span, close: self.span(close, close + 1), bracket }
            }
            _ => Problem::Unreadable { at: span, text },
        });
        match text {
            "[" | "{" => self.push(token.start, Mark::Bracket),
            "]" | "}" => {}
            "`" | "," => self.push(token.start, Mark::Lost),
            _ if self.skipped == 0 => self.finish(Form { span, kind: FormKind::Error }),
            _ => {}
        }
    }

    /// The bracket that closes the one just taken, if it is a bracket and near.
    fn closing_bracket(&self) -> Option<usize> {
        /// So many tokens are looked at.
        const NEAR: usize = 200;
        let mut tokens = Tokens::new(self.text);
        tokens.seek(self.tokens.position());
        let mut depth = 0_usize;
        for _ in 0..NEAR {
            let token = tokens.take();
            match (&self.text[token.start..token.end], token.kind) {
                (_, TokenKind::End) => return None,
                ("[" | "{", _) | (_, TokenKind::Open) => depth += 1,
                ("]" | "}", _) if depth == 0 => return Some(token.start),
                (_, TokenKind::Close) if depth == 0 => return None,
                ("]" | "}", _) | (_, TokenKind::Close) => depth -= 1,
                _ => {}
            }
        }
        None
    }

    /// Reports a number with a comma in it, and goes on behind it.
    fn skipped_as_number(&mut self, token: Token) -> bool {
        let Some((number, commas)) = with_commas(&self.text[token.start..]) else { return false };
        let end = token.start + number.len();
        let span = self.span(token.start, end);
        self.problems.push(Problem::NumberWithCommas { at: span, number, commas });
        if self.skipped == 0 {
            self.note_item(token.start);
            self.finish(Form { span, kind: FormKind::Error });
        }
        self.tokens.seek(end);
        true
    }

    /// Reports a string that ends in the middle of a line of words: a quotation mark inside of it.
    fn string_goes_on(&mut self, token: Token) {
        let line = self.text[token.end..].lines().next().unwrap_or("");
        let end = line.rfind('"').map_or(token.end, |at| token.end + at + 1);
        // All but the last one are inside.
        let marks = self.text[token.end - 1..end].match_indices('"').map(|(at, _)| token.end - 1 + at);
        let inside = marks.filter(|at| at + 1 < end).map(|at| self.span(at, at)).collect();
        self.problems.push(Problem::StringGoesOn {
            start: self.span(token.start, token.start + 1),
            end: self.span(token.end - 1, token.end),
            inside,
        });
        if self.skipped == 0 {
            self.finish(Form { span: self.span(token.start, end), kind: FormKind::Error });
        }
        self.tokens.seek(end);
    }

    /// Reports a string without an end and goes on with the line after the one it begins on.
    fn unclosed_string(&mut self, at: usize) {
        // Where the forms around it are closed on the same line, it ends before that.
        let line = self.text[at + 1..].lines().next().unwrap_or("").trim_end();
        let words = line.trim_end_matches(')');
        let ends = !words.is_empty() && words.len() < line.len() && !words.contains(['(', ')', '"']);
        let end = at + 1 + words.len();
        self.problems.push(Problem::UnclosedString {
            mark: self.span(at, at + 1),
            end: ends.then(|| self.span(end, end)),
        });
        let line_end = self.text[at..].find('\n').map_or(self.text.len(), |n| at + n);
        if self.skipped == 0 {
            let span = self.span(at, line_end);
            self.finish(Form { span, kind: FormKind::Error });
        }
        self.tokens.seek(line_end);
    }

    /// From `start`, which is on the boundary of a character, to the first boundary from `end` on.
    fn span(&self, start: usize, end: usize) -> Span {
        let end = (end..self.text.len()).find(|end| self.text.is_char_boundary(*end));
        Span::new(self.source, start, end.unwrap_or(self.text.len()))
    }
}

fn symbol(text: &str) -> Symbol {
    let text = text.to_lowercase();
    match text.split_once(':') {
        Some((package, name)) if !package.is_empty() => {
            let name = name.strip_prefix(':').unwrap_or(name).to_string();
            Symbol { package: Some(package.to_string()), name }
        }
        _ => Symbol { package: None, name: text },
    }
}

fn unescape(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        plain.extend(if c == '\\' { chars.next() } else { Some(c) });
    }
    plain
}
