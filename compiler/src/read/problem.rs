//! What can be wrong with a text. The words for it are in `wording/read.rs`.

use crate::source::Span;

/// What is wrong with a text; the texts in it are as they are written.
#[derive(Clone, Debug)]
pub(crate) enum Problem<'a> {
    /// It is longer than `MAX_LENGTH`: that much is read up to here.
    TooLong { end: Span },
    /// There is nothing in it, or nothing but comments.
    Empty { start: Span, comments: bool },
    /// This is in it, and in no text.
    NotText { at: Span },
    /// All of it is something else, which shows in this line.
    ForeignText { line: Span, is: Foreign },
    /// Lines of something else; these are the beginnings of those that are not blank.
    ForeignLines { first: Span, is: Foreign, lines: Vec<Span> },
    /// Lines outside of all forms, the first of which begins with this word.
    Stray { first: Span, word: &'a str, lines: Vec<Span> },
    /// `#|` without `|#`.
    UnclosedComment { mark: Span },
    /// A form inside of `MAX_NESTING` others.
    TooDeep { at: Span },
    /// `'` before a `)`.
    NothingQuoted { quote: Span },
    /// A form without its `)`.
    Unclosed(Unclosed),
    /// A `)` without its form.
    StrayClose(StrayClose<'a>),
    /// A string without its end, and where it may have ended.
    UnclosedString { mark: Span, end: Option<Span> },
    /// A string with words right behind it: where it begins and ends, and quotation marks that may be inside of it.
    StringGoesOn { start: Span, end: Span, inside: Vec<Span> },
    /// A number with commas in it.
    NumberWithCommas { at: Span, number: &'a str, commas: Commas },
    /// A comment or a string as others write them, with what opens and closes it.
    ForeignToken { at: Span, is: ForeignToken, open: Span, close: Span },
    /// A comma by itself.
    LoneComma { at: Span },
    /// A bracket with the one that closes it.
    Brackets { open: Span, close: Span, bracket: &'a str },
    /// What has no meaning.
    Unreadable { at: Span, text: &'a str },
}

/// A form without its `)`.
#[derive(Clone, Debug)]
pub(crate) struct Unclosed {
    /// Its `(`.
    pub(crate) at: Span,
    /// What it begins with.
    pub(crate) begins: String,
    /// How many `)` are missing.
    pub(crate) missing: usize,
    /// The `(` of the definition it is in, if it is in one.
    pub(crate) definition: Option<Span>,
    /// The `(` of the definition that follows.
    pub(crate) next: Option<Span>,
    /// Where what is open may end.
    pub(crate) close: Option<Span>,
}

/// One `)` or several that close nothing.
#[derive(Clone, Debug)]
pub(crate) struct StrayClose<'a> {
    /// All of them.
    pub(crate) at: Span,
    /// How many they are.
    pub(crate) count: usize,
    /// The `)` of the definition before them.
    pub(crate) closed: Option<Span>,
    /// As many `)` at the end of that definition, if forms follow that belong to it.
    pub(crate) too_early: Option<Span>,
    /// True if nothing shows that another one is too early.
    pub(crate) are_the_ones: bool,
    /// A form and the line that is indented as if it were open.
    pub(crate) indented: Option<(&'a str, Span)>,
}

/// What the commas in a number are there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Commas {
    /// `1,000`.
    Thousands,
    /// `1,2,3`.
    Between,
    /// `1,5`.
    Decimal,
}

/// A comment or a string as other languages and word processors write them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ForeignToken {
    /// `// ...` and `# ...`.
    LineComment,
    /// `/* ... */`.
    BlockComment,
    /// `“...”`.
    String,
    /// `“...`.
    UnclosedString,
    /// `‘`, alone.
    Quote,
}

/// What lines are that are not RMPL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Foreign {
    Script,
    Prompt,
    Command,
    MergeMark,
    Patch,
    Xml,
    Html,
    XmlOrHtml,
    Json,
    Pddl,
    Python,
    JavaScript,
    Rust,
    C,
    JavaOrGo,
    Yaml,
    Markdown,
    Comment,
    Assignment,
}
