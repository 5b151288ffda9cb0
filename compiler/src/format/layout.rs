//! Writes a tree of forms and comments, line by line.

use super::WIDTH;
use super::node::{Node, NodeKind, Where};
use super::rules::{Glue, Role, glue, parts, role, values};

/// Further to the right than this nothing is aligned.
const RIGHTMOST: usize = 60;

/// The text of a tree.
pub(super) fn lay_out(nodes: &[Node<'_>]) -> String {
    let mut writer = Writer { text: String::new(), column: 0 };
    for (index, node) in nodes.iter().enumerate() {
        match &node.kind {
            NodeKind::Comment(text, Where::Behind | Where::Inside) if index > 0 => writer.behind(text),
            _ => {
                if index > 0 {
                    writer.line(0, node.blank);
                }
                writer.node(node, Role::Form, 0);
            }
        }
    }
    if !writer.text.is_empty() {
        writer.text.push('\n');
    }
    writer.text
}

struct Writer {
    text: String,
    /// How much stands on the last line.
    column: usize,
}

impl Writer {
    /// Writes a form, after which `closing` parentheses follow.
    fn node(&mut self, node: &Node<'_>, role: Role, closing: usize) {
        match &node.kind {
            NodeKind::Atom(text) | NodeKind::Comment(text, _) => self.write(text),
            NodeKind::Quote(inner) => {
                self.write("'");
                self.node(inner, Role::Form, closing);
            }
            NodeKind::List(nodes) => match node.width {
                Some(width) if self.column + width + closing <= WIDTH => self.flat(nodes),
                _ => self.list(nodes, role, closing),
            },
        }
    }

    fn flat(&mut self, nodes: &[Node<'_>]) {
        self.write("(");
        for (index, node) in nodes.iter().enumerate() {
            if index > 0 {
                self.write(" ");
            }
            match &node.kind {
                NodeKind::List(nodes) => self.flat(nodes),
                _ => self.node(node, Role::Form, 0),
            }
        }
        self.write(")");
    }

    /// A list on several lines.
    fn list(&mut self, nodes: &[Node<'_>], list: Role, closing: usize) {
        let left = self.column;
        self.write("(");
        let parts = parts(nodes);
        let values = values(&parts);
        let mut align = left + 2;
        let mut index = 0;
        // True after a comment: whatever comes next needs a new line.
        let mut commented = false;
        for (position, node) in nodes.iter().enumerate() {
            let how = match index < parts.len() {
                true => glue(&parts, &values, list, index),
                false => {
                    parts.len().checked_sub(1).map_or(Glue::Data, |last| glue(&parts, &values, list, last))
                }
            };
            let indent = match how {
                Glue::Data => left + 1,
                _ if index == 0 => left + 1,
                Glue::Align | Glue::Fill => align,
                Glue::Same | Glue::Near | Glue::Body => left + 2,
            };
            if let NodeKind::Comment(text, place) = node.kind {
                match place {
                    Where::Behind => self.behind(text),
                    Where::Inside if position == 0 => self.write(text),
                    Where::Inside => self.write(&format!(" {text}")),
                    Where::Alone => {
                        self.line(indent, node.blank && position > 0);
                        self.write(text);
                    }
                }
                commented |= place != Where::Inside;
                continue;
            }
            let last = index + 1 == parts.len();
            let tail = if last { closing + 1 } else { 0 };
            let same = match how {
                _ if commented => false,
                Glue::Same => true,
                Glue::Fill | Glue::Near => self.fits(&parts[index..], tail),
                Glue::Align | Glue::Body | Glue::Data => false,
            };
            if !same {
                self.line(indent, node.blank && position > 0);
            } else if position > 0 {
                self.write(" ");
            }
            if index == 1 && same && self.column <= RIGHTMOST {
                align = self.column;
            }
            self.node(node, role(&parts, list, index), tail);
            commented = false;
            index += 1;
        }
        if commented {
            self.line(if parts.is_empty() { left + 1 } else { align.min(left + 2) }, false);
        }
        self.write(")");
    }

    /// True if a part still fits on this line, with its value if it is a keyword.
    fn fits(&self, parts: &[&Node<'_>], tail: usize) -> bool {
        let keyword = matches!(parts[0].kind, NodeKind::Atom(text) if text.starts_with(':'));
        let count = if keyword { 2 } else { 1 };
        let widths: Option<usize> =
            parts.iter().take(count).map(|part| part.width.map(|width| width + 1)).sum();
        // The value of the last keyword has the closing parentheses behind it.
        let tail = if parts.len() <= count { tail.max(1) } else { tail };
        widths.is_some_and(|width| self.column + width + tail <= WIDTH)
    }

    /// A comment behind what it is about.
    fn behind(&mut self, comment: &str) {
        self.write("  ");
        self.write(comment);
    }

    fn line(&mut self, indent: usize, blank: bool) {
        self.text.push_str(if blank { "\n\n" } else { "\n" });
        self.text.extend(std::iter::repeat_n(' ', indent));
        self.column = indent;
    }

    fn write(&mut self, text: &str) {
        self.text.push_str(text);
        self.column = match text.rsplit_once('\n') {
            Some((_, last)) => last.chars().count(),
            None => self.column + text.chars().count(),
        };
    }
}
