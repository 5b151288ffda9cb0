//! Which parts of a form stand on the line of its operator, and where the others go.

use super::node::{Node, NodeKind, Where};
use crate::words::{Layout, Piece, Word, word};

/// Where a part of a form that does not fit on one line goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Glue {
    /// On the same line.
    Same,
    /// On the same line if it fits there, else below the first argument.
    Fill,
    /// On the same line if it fits there, else two columns in from the form.
    Near,
    /// On a line of its own, two columns in from the form.
    Body,
    /// On a line of its own, below the first argument.
    Align,
    /// On a line of its own, one column in from the form: what stands in a list of data.
    Data,
}

/// What a list is, as far as its operator does not say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Form,
    /// The slots of a class, the names of a `let`.
    List,
    /// A slot of a class.
    Slot,
}

/// Which parts of a list are the value of the keyword before them.
pub(super) fn values(parts: &[&Node<'_>]) -> Vec<bool> {
    let mut after_keyword = false;
    let value = |(index, part): (usize, &&Node<'_>)| {
        let value = after_keyword;
        after_keyword = !value && index > 0 && is_keyword(part);
        value
    };
    parts.iter().enumerate().map(value).collect()
}

/// Where part number `index` of a list goes, counted without comments; number 0 is the operator.
pub(super) fn glue(parts: &[&Node<'_>], values: &[bool], role: Role, index: usize) -> Glue {
    let part = parts[index];
    let after_keyword = values[index];
    match role {
        _ if index == 0 => return Glue::Same,
        Role::List => return Glue::Data,
        Role::Slot if after_keyword => return Glue::Same,
        Role::Slot => return Glue::Data,
        Role::Form => {}
    }
    let Some(word) = operator(parts) else {
        return match parts[0].kind {
            NodeKind::Atom(_) => aligned(index, after_keyword),
            _ if after_keyword => Glue::Same,
            _ => Glue::Data,
        };
    };
    let Some(body) = body_from(word, parts) else {
        let packed = word.layout == Layout::Packed && index > 1 && !after_keyword && !is_delay(part);
        return if packed { Glue::Fill } else { aligned(index, after_keyword) };
    };
    match word.part(index - 1) {
        Some(Piece::Keywords) if after_keyword => Glue::Same,
        _ if index >= body => Glue::Body,
        Some(Piece::Form(_)) if index > 1 => Glue::Fill,
        Some(Piece::Number) => Glue::Near,
        _ => Glue::Same,
    }
}

fn aligned(index: usize, after_keyword: bool) -> Glue {
    if index == 1 || after_keyword { Glue::Same } else { Glue::Align }
}

/// Where the body of a form begins, if it may have one: earlier, if options are left out.
fn body_from(word: &Word, parts: &[&Node<'_>]) -> Option<usize> {
    let (Layout::Hanging(first) | Layout::Block(first)) = word.layout else { return None };
    let left_out = word.part(0) == Some(Piece::Options) && !parts.get(1).is_some_and(|part| is_options(part));
    Some(first - usize::from(left_out))
}

/// What the part of a list is.
pub(super) fn role(parts: &[&Node<'_>], role: Role, index: usize) -> Role {
    let is_list =
        |word: &Word| index > 0 && word.parts.get(index - 1).is_some_and(|(_, part)| *part == Piece::List);
    match role {
        Role::Form if operator(parts).is_some_and(is_list) => Role::List,
        Role::List => Role::Slot,
        Role::Form | Role::Slot => Role::Form,
    }
}

/// How long a form is on one line; `None` if it always has several.
pub(super) fn width(kind: &NodeKind<'_>) -> Option<usize> {
    match kind {
        NodeKind::Atom(text) => (!text.contains('\n')).then(|| text.chars().count()),
        NodeKind::Comment(text, place) => (*place == Where::Inside).then(|| text.chars().count()),
        NodeKind::Quote(inner) => Some(inner.width? + 1),
        NodeKind::List(nodes) => {
            let inside: Option<Vec<usize>> = nodes.iter().map(|node| node.width).collect();
            let inside = inside?;
            let parts = parts(nodes);
            let total = inside.iter().sum::<usize>() + inside.len().saturating_sub(1) + 2;
            (!is_always_broken(&parts)).then_some(total)
        }
    }
}

/// A list without its comments.
pub(super) fn parts<'n, 'a>(nodes: &'n [Node<'a>]) -> Vec<&'n Node<'a>> {
    nodes.iter().filter(|node| !matches!(node.kind, NodeKind::Comment(..))).collect()
}

/// True for forms that have a body, which stands on lines of its own however short it is. A class without slots has none.
fn is_always_broken(parts: &[&Node<'_>]) -> bool {
    let Some(word) = operator(parts) else { return false };
    match word.layout {
        Layout::Block(_) => body_from(word, parts).is_some_and(|body| {
            let has_slots = |first| word.part(body - 1) != Some(Piece::List) || is_filled(first);
            parts.get(body).is_some_and(|first| has_slots(first))
        }),
        Layout::Packed => parts.iter().skip(2).any(|part| is_delay(part)),
        Layout::Hanging(_) | Layout::Aligned => false,
    }
}

/// The word of the language that a form begins with, in any case and with any package.
fn operator(parts: &[&Node<'_>]) -> Option<&'static Word> {
    match parts.first()?.kind {
        NodeKind::Atom(text) if !text.starts_with([':', '"', '#']) => {
            word(text.rsplit(':').next().unwrap_or(text))
        }
        _ => None,
    }
}

fn is_keyword(node: &Node<'_>) -> bool {
    matches!(node.kind, NodeKind::Atom(text) if text.starts_with(':'))
}

fn is_delay(node: &Node<'_>) -> bool {
    matches!(node.kind, NodeKind::Atom(text) if text.to_lowercase().ends_with("-observation-delay"))
}

/// True for a list with something in it.
fn is_filled(node: &Node<'_>) -> bool {
    matches!(&node.kind, NodeKind::List(nodes) if !nodes.is_empty())
}

/// True for `()` and `(:slack t)`.
fn is_options(node: &Node<'_>) -> bool {
    match &node.kind {
        NodeKind::List(nodes) => nodes.first().is_none_or(is_keyword),
        _ => false,
    }
}
