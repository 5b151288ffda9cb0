//! What each piece of a text is, for colours that know the names.

use kirk_compiler::read::{TokenKind, tokens};
use kirk_compiler::words::{Position, word};
use kirk_compiler::{Span, SymbolKind};

use crate::analysis::Analysis;
use crate::cursor::comments;
use crate::definition::bare;

/// A piece of the text on one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Highlight {
    /// Where it is.
    pub span: Span,
    /// What it is.
    pub kind: HighlightKind,
    /// True if a name is defined here.
    pub definition: bool,
}

/// What a piece of text may be. The order is that of the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum HighlightKind {
    /// A comment.
    Comment,
    /// A string.
    String,
    /// A number.
    Number,
    /// A word of the language.
    Keyword,
    /// `+` and the like.
    Operator,
    /// A program.
    Function,
    /// A parameter.
    Parameter,
    /// A variable or a named number.
    Variable,
    /// A slot, or what reads one, or a keyword such as `:lower-bound`.
    Property,
    /// A class.
    Class,
    /// A label.
    Event,
    /// A package.
    Namespace,
}

/// All pieces, in source order, none over another.
pub fn highlight(analysis: &Analysis) -> Vec<Highlight> {
    let text = analysis.text();
    let tokens = tokens(text);
    let mut found: Vec<Highlight> = Vec::new();
    let mut plain =
        |span, kind| lines(text, span, |span| Highlight { span, kind, definition: false }, &mut found);
    for comment in comments(text, &tokens) {
        plain(comment, HighlightKind::Comment);
    }
    let mut names = analysis.symbols.places().filter(|(place, _)| analysis.is_here(place.span)).peekable();
    let mut after_open = false;
    for token in &tokens {
        let span = Span::new(0, token.start, token.end);
        let first = std::mem::replace(&mut after_open, token.kind == TokenKind::Open);
        let written = &text[token.start..token.end];
        while names.next_if(|(place, _)| place.span.start < span.start).is_some() {}
        if let Some((place, symbol)) = names.next_if(|(place, _)| place.span == span) {
            let (kind, definition) = (kind_of(symbol.kind), place.definition);
            found.push(Highlight { span: bare(analysis, span), kind, definition });
            continue;
        }
        let kind = match token.kind {
            TokenKind::String | TokenKind::UnclosedString => HighlightKind::String,
            TokenKind::Number => HighlightKind::Number,
            TokenKind::Keyword => HighlightKind::Property,
            TokenKind::Uninterned => HighlightKind::Namespace,
            TokenKind::Symbol => match word(written.rsplit(':').next().unwrap_or(written)) {
                Some(word) if first && word.position == Position::Number => HighlightKind::Operator,
                Some(_) if first => HighlightKind::Keyword,
                None if matches!(written, "t" | "nil" | "T" | "NIL") => HighlightKind::Keyword,
                _ => continue,
            },
            _ => continue,
        };
        lines(text, span, |span| Highlight { span, kind, definition: false }, &mut found);
    }
    found.sort_by_key(|highlight| highlight.span);
    found
}

fn kind_of(symbol: SymbolKind) -> HighlightKind {
    match symbol {
        SymbolKind::Program(_) => HighlightKind::Function,
        SymbolKind::Parameter(_) => HighlightKind::Parameter,
        SymbolKind::Variable | SymbolKind::NamedNumber(_) => HighlightKind::Variable,
        SymbolKind::Label => HighlightKind::Event,
        SymbolKind::Class(_) => HighlightKind::Class,
        SymbolKind::Slot(_) | SymbolKind::Accessor => HighlightKind::Property,
        SymbolKind::Package => HighlightKind::Namespace,
        SymbolKind::Team | SymbolKind::Agent => HighlightKind::Class,
    }
}

/// What goes over several lines is one piece on each.
fn lines(text: &str, span: Span, piece: impl Fn(Span) -> Highlight, found: &mut Vec<Highlight>) {
    let mut at = span.start as usize;
    for line in text[at..span.end as usize].split_inclusive(['\n', '\r']) {
        let length = line.trim_end_matches(['\n', '\r']).len();
        if length > 0 {
            found.push(piece(Span::new(span.source, at, at + length)));
        }
        at += line.len();
    }
}
