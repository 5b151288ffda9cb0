//! Which parts of a form stand on the line of its operator, and where the others go.

use super::tree::{Node, NodeKind, Where};

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
    let body_from = |first: usize| if index < first { Glue::Same } else { Glue::Body };
    match operator(parts).as_str() {
        "define-control-program" | "defclass" => body_from(3),
        "sequence" | "parallel" => {
            body_from(if parts.get(1).is_some_and(|part| is_options(part)) { 2 } else { 1 })
        }
        "with-temporal-constraint" | "dotimes" | "let" | "let*" | "label" | "declare" | "defpackage" => {
            body_from(2)
        }
        "defparameter" | "defconstant" if index == 2 => Glue::Near,
        "defparameter" | "defconstant" => body_from(2),
        "between" if index == 2 => Glue::Fill,
        "between" => body_from(3),
        "duration" if after_keyword => Glue::Same,
        "duration" => body_from(2),
        _ if after_keyword => Glue::Same,
        "simple" if is_delay(part) && index > 1 => Glue::Align,
        "simple" if index > 1 => Glue::Fill,
        _ if matches!(parts[0].kind, NodeKind::Atom(_)) => {
            if index == 1 {
                Glue::Same
            } else {
                Glue::Align
            }
        }
        _ => Glue::Data,
    }
}

/// What the part of a list is.
pub(super) fn role(parts: &[&Node<'_>], role: Role, index: usize) -> Role {
    match (role, operator(parts).as_str()) {
        (Role::Form, "defclass") if index == 3 => Role::List,
        (Role::Form, "let" | "let*") if index == 1 => Role::List,
        (Role::List, _) => Role::Slot,
        _ => Role::Form,
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

/// True for forms that have a body, which stands on lines of its own however short it is.
fn is_always_broken(parts: &[&Node<'_>]) -> bool {
    let count = parts.len();
    match operator(parts).as_str() {
        "define-control-program" => count > 3,
        "defclass" => {
            matches!(parts.get(3).map(|slots| &slots.kind), Some(NodeKind::List(slots)) if !slots.is_empty())
        }
        "sequence" | "parallel" => parts.iter().skip(1).any(|part| !is_options(part)),
        "with-temporal-constraint" | "dotimes" | "let" | "let*" | "declare" | "duration" => count > 2,
        "simple" => parts.iter().skip(2).any(|part| is_delay(part)),
        _ => false,
    }
}

/// The operator of a form, in lower case and without its package; empty if there is none.
fn operator(parts: &[&Node<'_>]) -> String {
    match parts.first().map(|node| &node.kind) {
        Some(NodeKind::Atom(text)) if text.len() <= 64 && !text.starts_with([':', '"', '#']) => {
            text.rsplit(':').next().unwrap_or(text).to_lowercase()
        }
        _ => String::new(),
    }
}

fn is_keyword(node: &Node<'_>) -> bool {
    matches!(node.kind, NodeKind::Atom(text) if text.starts_with(':'))
}

fn is_delay(node: &Node<'_>) -> bool {
    matches!(node.kind, NodeKind::Atom(text) if text.to_lowercase().ends_with("-observation-delay"))
}

/// True for `()` and `(:slack t)`.
fn is_options(node: &Node<'_>) -> bool {
    match &node.kind {
        NodeKind::List(nodes) => nodes.first().is_none_or(is_keyword),
        _ => false,
    }
}
