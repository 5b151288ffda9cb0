//! The parts of a text that is laid out.

/// A form, or a comment.
#[derive(Debug)]
pub(super) struct Node<'a> {
    pub(super) kind: NodeKind<'a>,
    /// True if there is a blank line before it.
    pub(super) blank: bool,
    /// How long it is on one line; `None` if it needs several.
    pub(super) width: Option<usize>,
}

#[derive(Debug)]
pub(super) enum NodeKind<'a> {
    /// A name, number or string as written.
    Atom(&'a str),
    /// What stands between the parentheses.
    List(Vec<Node<'a>>),
    /// `'` and a form.
    Quote(Box<Node<'a>>),
    /// A comment as written.
    Comment(&'a str, Where),
}

/// Where a comment stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Where {
    /// On lines of its own.
    Alone,
    /// Behind something, to the end of the line.
    Behind,
    /// Behind something, and something may follow on the same line.
    Inside,
}
