//! What may be written at the cursor: words of the language, keywords, programs, names.

use std::collections::HashSet;

use kirk_compiler::words::{Keyword, Piece, Position, keyword, word};
use kirk_compiler::{Span, Symbol, SymbolKind};

use crate::analysis::Analysis;
use crate::cursor::{Cursor, cursor};
use crate::hover::program;

/// Something that may be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// What is shown and, unless there is a snippet, written.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// How it is written, in short.
    pub detail: String,
    /// What it means, in Markdown.
    pub about: String,
    /// What is written, with places to fill in (`${1:name}`).
    pub snippet: String,
    /// What it replaces.
    pub replace: Span,
}

/// What may be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CompletionKind {
    /// A word of the language.
    Word,
    /// A keyword.
    Keyword,
    /// A program.
    Program,
    /// A name for a number.
    Number,
    /// A parameter or a variable.
    Variable,
    /// A label.
    Label,
    /// What reads a slot.
    Accessor,
    /// A class.
    Class,
    /// A value such as `t`.
    Value,
}

/// Everything that may be written at an offset. The editor narrows it down by what is written of the word.
pub fn completion(analysis: &Analysis, offset: u32) -> Vec<Completion> {
    let text = analysis.text();
    let Some(cursor) = cursor(text, offset) else { return Vec::new() };
    let mut offer = Offer { analysis, cursor: &cursor, offset, found: Vec::new(), known: HashSet::new() };
    for wanted in wanted(&cursor) {
        offer.add(wanted);
    }
    offer.found
}

/// What may stand at the cursor.
fn wanted(cursor: &Cursor<'_>) -> Vec<Piece> {
    let around = cursor.head(usize::from(cursor.first));
    let before = cursor.open.iter().rev().nth(usize::from(cursor.first)).map(|open| open.before);
    // How many parts stand before the cursor, or before the parenthesis it stands behind.
    let Some(before) = before.map(|before| before.saturating_sub(1 + usize::from(cursor.first))) else {
        return vec![Piece::Form(Position::Definition)];
    };
    let value = cursor.keyword.as_deref().and_then(keyword).map(|keyword| keyword.value);
    if let Some(value) = value.filter(|value| *value != Piece::Name) {
        return vec![value];
    }
    let form = word(&around);
    match form.and_then(|form| form.part(before)) {
        Some(Piece::Options) if cursor.first => vec![Piece::Keywords, Piece::Form(Position::Body)],
        Some(Piece::Options) => vec![Piece::Form(Position::Body)],
        Some(Piece::Clause) => vec![Piece::Keywords],
        Some(Piece::Keywords) if cursor.first => vec![Piece::Number],
        Some(part) => vec![part],
        None if form.is_some() || around.is_empty() && cursor.first => Vec::new(),
        None if cursor.is_in_slot() || is_in_options(cursor) => vec![Piece::Keywords],
        // The argument of a call, or of a calculation.
        None => vec![Piece::Number],
    }
}

/// True in `(sequence (here`.
fn is_in_options(cursor: &Cursor<'_>) -> bool {
    let head = cursor.head(0);
    let around = word(&cursor.head(1));
    (head.is_empty() || head.starts_with(':'))
        && around.is_some_and(|form| form.part(0) == Some(Piece::Options))
}

struct Offer<'a> {
    analysis: &'a Analysis,
    cursor: &'a Cursor<'a>,
    offset: u32,
    found: Vec<Completion>,
    /// What was found of each kind.
    known: HashSet<(String, CompletionKind)>,
}

impl Offer<'_> {
    fn add(&mut self, wanted: Piece) {
        match wanted {
            Piece::Form(position) => {
                self.words(position);
                match position {
                    Position::Body => self.programs(),
                    Position::Condition => self.accessors(),
                    _ => {}
                }
            }
            Piece::Content => {
                self.words(Position::Declare);
                self.add(Piece::Form(Position::Body));
            }
            Piece::Number | Piece::Bound if self.cursor.first => self.words(Position::Number),
            Piece::Number => {
                self.values();
                self.words(Position::Number);
            }
            Piece::Bound => {
                self.plain(":infinity", CompletionKind::Value, "No limit.");
                self.add(Piece::Number);
            }
            Piece::Flag => ["t", "nil"].iter().for_each(|flag| self.plain(flag, CompletionKind::Value, "")),
            Piece::Occurrence => self.symbols(|kind| match kind {
                SymbolKind::Label => Some((CompletionKind::Label, "a label")),
                SymbolKind::Program(_) => Some((CompletionKind::Program, "the one occurrence of a program")),
                _ => None,
            }),
            Piece::Class => self.symbols(|kind| {
                matches!(kind, SymbolKind::Class(_)).then_some((CompletionKind::Class, "a class"))
            }),
            Piece::Agent => self.symbols(|kind| {
                (kind == SymbolKind::Agent).then_some((CompletionKind::Class, "an agent of the team"))
            }),
            Piece::Keywords | Piece::Options | Piece::Clause => self.keywords(),
            Piece::Name | Piece::List => {}
        }
    }

    fn symbols(&mut self, wanted: impl Fn(SymbolKind) -> Option<(CompletionKind, &'static str)>) {
        for symbol in &self.analysis.symbols.symbols {
            if let Some((kind, about)) = wanted(symbol.kind) {
                self.plain(&symbol.name, kind, about);
            }
        }
    }

    fn words(&mut self, position: Position) {
        for word in position.words() {
            self.form(word.name, CompletionKind::Word, &word.shape(), word.about, &word.snippet());
        }
    }

    fn programs(&mut self) {
        let analysis = self.analysis;
        for definition in &analysis.program.programs {
            let name = &definition.name.name;
            let mut snippet = escaped(name);
            for (index, parameter) in definition.parameters.iter().enumerate() {
                snippet.push_str(&format!(" ${{{}:{}}}", index + 1, escaped(&parameter.name)));
            }
            let about = program(analysis.source_of(definition.span), definition);
            self.form(name, CompletionKind::Program, &definition.shape(), &about, &snippet);
        }
    }

    /// A form: with parentheses, unless the first is there already and the other comes right after.
    fn form(&mut self, label: &str, kind: CompletionKind, detail: &str, about: &str, snippet: &str) {
        let rest = &self.analysis.text()[self.cursor.word.end as usize..];
        let snippet = match (self.cursor.first, rest.starts_with(')')) {
            (true, true) => snippet.to_string(),
            (true, false) => format!("{snippet})"),
            (false, _) => format!("({snippet})"),
        };
        self.push(label, kind, detail, about, snippet);
    }

    fn keywords(&mut self) {
        // `(:slack t)` is a list of its own.
        let is_list = self.cursor.first && self.cursor.keyword.is_none();
        for Keyword { name, filled, about, .. } in self.cursor.keywords() {
            let (name, snippet) = (format!(":{name}"), format!(":{name} {filled}"));
            match is_list {
                true => self.form(&name, CompletionKind::Keyword, "", about, &snippet),
                false => self.push(&name, CompletionKind::Keyword, "", about, snippet),
            }
        }
    }

    fn accessors(&mut self) {
        for symbol in &self.analysis.symbols.symbols {
            if symbol.kind == SymbolKind::Accessor {
                let snippet = format!("{} ${{1:object}}", escaped(&symbol.name));
                self.form(&symbol.name, CompletionKind::Accessor, "", "reads a slot", &snippet);
            }
        }
    }

    /// The names that stand for values here.
    fn values(&mut self) {
        let analysis = self.analysis;
        let offset = self.offset;
        let inside = analysis
            .program
            .programs
            .iter()
            .position(|program| program.span.start < offset && offset <= program.span.end);
        let within = inside.map(|index| analysis.program.programs[index].span);
        let defined_before = |symbol: &Symbol| {
            symbol.places.iter().any(|place| {
                place.definition
                    && place.span.end < offset
                    && within.is_some_and(|span| span.start <= place.span.start)
            })
        };
        for symbol in &analysis.symbols.symbols {
            match symbol.kind {
                SymbolKind::Parameter(program) if Some(program) == inside => {
                    self.plain(&symbol.name, CompletionKind::Variable, "a parameter");
                }
                SymbolKind::Variable if defined_before(symbol) => {
                    self.plain(&symbol.name, CompletionKind::Variable, "a variable");
                }
                SymbolKind::NamedNumber(index) => {
                    let value = analysis.slice(analysis.program.parameters[index].value.span).to_string();
                    self.push(
                        &symbol.name,
                        CompletionKind::Number,
                        &value,
                        "a named number",
                        escaped(&symbol.name),
                    );
                }
                _ => {}
            }
        }
    }

    fn plain(&mut self, label: &str, kind: CompletionKind, about: &str) {
        self.push(label, kind, "", about, escaped(label));
    }

    fn push(&mut self, label: &str, kind: CompletionKind, detail: &str, about: &str, snippet: String) {
        if !self.known.insert((label.to_string(), kind)) {
            return;
        }
        let (label, detail, about) = (label.to_string(), detail.to_string(), about.to_string());
        self.found.push(Completion { label, kind, detail, about, snippet, replace: self.cursor.word });
    }
}

/// A name as part of a snippet.
fn escaped(name: &str) -> String {
    name.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}")
}

/// A snippet as plain text, for editors that do not know snippets: the defaults filled in.
pub fn filled_in(snippet: &str) -> String {
    let mut text = String::new();
    let mut chars = snippet.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '\\' => text.extend(chars.next()),
            '$' if chars.peek() == Some(&'{') => {
                let place: String = chars.by_ref().skip(1).take_while(|c| *c != '}').collect();
                let default = place.trim_start_matches(|c: char| c.is_ascii_digit());
                let default = default.trim_start_matches([':', '|']).trim_end_matches('|');
                text.push_str(default.split(',').next().unwrap_or(""));
            }
            '}' => {}
            c => text.push(c),
        }
    }
    text
}
