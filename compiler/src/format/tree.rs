//! A text as a tree that keeps its comments and blank lines. Expects a text that can be read without an error.

use super::node::{Node, NodeKind, Where};
use super::rules::width;
use crate::read::{TokenKind, Tokens};

/// The top level of a text.
pub(super) fn tree(text: &str) -> Vec<Node<'_>> {
    let mut tokens = Tokens::new(text);
    // The open lists, the outermost being the top level; what is waiting in one for a `'` to be followed.
    let mut open: Vec<(Vec<Node<'_>>, bool)> = vec![(Vec::new(), false)];
    let mut quotes: Vec<Vec<bool>> = vec![Vec::new()];
    let mut last_end = 0;
    loop {
        let token = tokens.take();
        let end = if token.kind == TokenKind::End { text.len() } else { token.start };
        let mut gap = Gap { rest: text.get(last_end..end).unwrap_or(""), newlines: 0, first: last_end == 0 };
        while let Some((comment, place, before)) = gap.comment() {
            if let Some((nodes, _)) = open.last_mut() {
                let kind = NodeKind::Comment(comment, place);
                nodes.push(Node { width: width(&kind), kind, blank: before });
            }
        }
        let blank = gap.newlines > 1;
        last_end = token.end;
        match token.kind {
            TokenKind::End => break,
            TokenKind::Open => {
                open.push((Vec::new(), blank));
                quotes.push(Vec::new());
            }
            TokenKind::Quote => quotes.last_mut().into_iter().for_each(|pending| pending.push(blank)),
            TokenKind::Close => {
                let Some((nodes, blank)) = open.pop().filter(|_| !open.is_empty()) else { break };
                quotes.pop();
                finish(&mut open, &mut quotes, NodeKind::List(nodes), blank);
            }
            _ => {
                let atom = text.get(token.start..token.end).unwrap_or("");
                finish(&mut open, &mut quotes, NodeKind::Atom(atom), blank);
            }
        }
    }
    open.into_iter().next().map(|(nodes, _)| nodes).unwrap_or_default()
}

/// Puts a form into the list that is open, with the quotes before it.
fn finish<'a>(open: &mut [(Vec<Node<'a>>, bool)], quotes: &mut [Vec<bool>], kind: NodeKind<'a>, blank: bool) {
    let mut node = Node { width: width(&kind), kind, blank };
    while let Some(blank) = quotes.last_mut().and_then(Vec::pop) {
        let kind = NodeKind::Quote(Box::new(node));
        node = Node { width: width(&kind), kind, blank };
    }
    if let Some((nodes, _)) = open.last_mut() {
        nodes.push(node);
    }
}

/// The blanks and comments between two tokens.
struct Gap<'a> {
    rest: &'a str,
    /// How many lines have ended since the last token or comment.
    newlines: usize,
    /// True at the beginning of the text, where nothing stands before a comment.
    first: bool,
}

impl<'a> Gap<'a> {
    /// The next comment, where it stands, and whether there is a blank line before it.
    fn comment(&mut self) -> Option<(&'a str, Where, bool)> {
        let at = self.rest.find([';', '#']);
        let before = &self.rest[..at.unwrap_or(self.rest.len())];
        self.newlines += before.matches('\n').count();
        let rest = &self.rest[at?..];
        let length =
            if rest.starts_with(';') { rest.find('\n').unwrap_or(rest.len()) } else { block_comment(rest) };
        let comment = &rest[..length];
        let place = match self.newlines {
            0 if self.first => Where::Alone,
            0 if comment.starts_with(';') || comment.contains('\n') => Where::Behind,
            0 => Where::Inside,
            _ => Where::Alone,
        };
        let blank = self.newlines > 1;
        self.rest = &rest[length..];
        self.newlines = 0;
        self.first = false;
        Some((comment.trim_end(), place, blank))
    }
}

/// The length of the block comment the text begins with.
fn block_comment(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        if rest.starts_with(b"#|") {
            depth += 1;
            at += 2;
        } else if rest.starts_with(b"|#") {
            depth = depth.saturating_sub(1);
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}
