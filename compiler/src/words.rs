//! The words of the language and the forms they begin, in one place: the parser, its guesses, the formatter, completion, hover
//! and signatures know them from here, and the editors are held to them by a test.

mod table;

pub use table::{SLOT, WORDS};

/// A word of the language, with the form it begins.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// Where its form stands.
    pub position: Position,
    /// What stands in the form behind the word, as a signature shows it; the last part may be there again and again.
    pub parts: &'static [(&'static str, Piece)],
    /// The keywords of the form.
    pub keywords: &'static [Keyword],
    /// Where its parts go if they do not fit on one line.
    pub layout: Layout,
    /// What is filled in behind the word, with places such as `${1:name}`.
    filled: &'static str,
    /// What it means.
    pub about: &'static str,
    /// How it is written, in a message about one that is not.
    pub usage: &'static str,
}

/// Where a form stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Position {
    /// At the top level.
    Definition,
    /// At the beginning of a program: `declare`.
    Declare,
    /// In a `declare`.
    Declaration,
    /// In a `define-team`.
    Team,
    /// In the body of a program or of a form.
    Body,
    /// Where a duration is declared: `simple`.
    Duration,
    /// Where a constraint is: `simple-temporal`.
    Constraint,
    /// Where an event is: `start`, `end`.
    Event,
    /// In `requires` and `effect`.
    Condition,
    /// Where a number is.
    Number,
}

/// What stands in a place of a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// A new name, or whatever else only the writer knows.
    Name,
    /// A list of lists: the slots of a class, the names of a `let`.
    List,
    /// A form that stands in this position.
    Form(Position),
    /// What a program consists of: declarations and body forms.
    Content,
    /// A number, or a name for one.
    Number,
    /// The same, or `:infinity`.
    Bound,
    /// `t` or `nil`.
    Flag,
    /// A label or a program.
    Occurrence,
    /// A class.
    Class,
    /// An agent of the team.
    Agent,
    /// Keywords with their values.
    Keywords,
    /// A list of keywords with their values, which may be left out.
    Options,
    /// A list that begins with a keyword.
    Clause,
}

/// A keyword of a form.
#[derive(Clone, Copy, Debug)]
pub struct Keyword {
    /// Its name, without the colon.
    pub name: &'static str,
    /// What its value is.
    pub value: Piece,
    /// The value to be filled in.
    pub filled: &'static str,
    /// What it means.
    pub about: &'static str,
}

/// Where the parts of a form go if they do not fit on one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Below the first argument.
    Aligned,
    /// Below the first argument, as many as fit on each line; a delay begins one.
    Packed,
    /// So many parts, the operator counted, on its line, and the others two columns in.
    Hanging(usize),
    /// The same, and what is two columns in stands there however short it is.
    Block(usize),
}

/// The words that begin a top-level form, as messages list them.
pub const DEFINITIONS: [&str; 7] = [
    "define-control-program",
    "define-team",
    "defpackage",
    "in-package",
    "defclass",
    "defparameter",
    "defconstant",
];

/// The units of time, in microseconds.
pub const UNITS: [(&str, i64); 5] = [
    ("microseconds", 1),
    ("seconds", 1_000_000),
    ("minutes", 60_000_000),
    ("hours", 3_600_000_000),
    ("days", 86_400_000_000),
];

/// The unit of this name, in the plural or in the singular.
pub(crate) fn unit(word: &str) -> Option<(&'static str, i64)> {
    UNITS.into_iter().find(|(name, _)| *name == word || name.strip_suffix('s') == Some(word))
}

/// The word of this name, in any case.
pub fn word(name: &str) -> Option<&'static Word> {
    WORDS.iter().find(|word| word.name.eq_ignore_ascii_case(name))
}

/// What a keyword of this name, in lower case, is in whatever form has it.
pub fn keyword(name: &str) -> Option<&'static Keyword> {
    let known = WORDS.iter().map(|word| word.keywords).chain([SLOT]).flatten();
    known.into_iter().find(|keyword| keyword.name == name)
}

impl Word {
    /// How the form is written.
    pub fn shape(&self) -> String {
        let parts = self.parts.iter().map(|(part, _)| format!(" {part}"));
        format!("({}{})", self.name, parts.collect::<String>())
    }

    /// What stands in the form behind the word, keywords and their values each by itself.
    pub fn pieces(&self) -> impl Iterator<Item = &'static str> {
        let apart = |part: Piece| part == Piece::Keywords;
        self.parts.iter().flat_map(move |&(text, part)| text.split(move |c| c == ' ' && apart(part)))
    }

    /// True if the last part may be there again and again.
    pub fn repeats(&self) -> bool {
        self.parts.last().is_some_and(|(text, _)| text.ends_with("..."))
    }

    /// The form to be filled in, without the parentheses around it.
    pub fn snippet(&self) -> String {
        format!("{}{}", self.name, self.filled)
    }

    /// What stands in a place behind the word, counted from 0.
    pub fn part(&self, index: usize) -> Option<Piece> {
        self.parts.get(index).or(self.parts.last()).map(|(_, part)| *part)
    }
}

impl Position {
    /// The words of the forms that stand here.
    pub fn words(self) -> impl Iterator<Item = &'static Word> {
        // The one word that stands in two places.
        let is_agent = move |word: &Word| self == Position::Team && word.name == "agent";
        WORDS.iter().filter(move |word| word.position == self || is_agent(word))
    }

    /// Their names.
    pub fn names<'a>(self) -> impl Iterator<Item = &'a str> {
        self.words().map(|word| word.name)
    }

    /// True if a form that begins with this word, in lower case, stands here.
    pub fn has(self, name: &str) -> bool {
        self.names().any(|known| known == name)
    }
}

/// How the form of a word is written, for messages. Fails to compile for a word that is not in the table.
pub(crate) const fn usage(name: &str) -> &'static str {
    named(name).usage
}

/// The names of the keywords of a form. Fails to compile if it has not as many.
pub(crate) const fn keywords<const N: usize>(name: &str) -> [&'static str; N] {
    let known = named(name).keywords;
    assert!(known.len() == N);
    let mut names = [""; N];
    let mut at = 0;
    while at < N {
        names[at] = known[at].name;
        at += 1;
    }
    names
}

const fn named(name: &str) -> &'static Word {
    let mut at = 0;
    while !is(WORDS[at].name, name) {
        at += 1;
    }
    &WORDS[at]
}

/// Equality, while the program is compiled.
const fn is(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut at = 0;
    while at < one.len() && at < other.len() && one[at] == other[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}
