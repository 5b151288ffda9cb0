//! What may be written at the cursor: words of the language, keywords, programs, names.

use std::collections::HashSet;

use kirk_compiler::{Span, Symbol, SymbolKind};

use crate::analysis::Analysis;
use crate::cursor::{Cursor, cursor};
use crate::hover::program;
use crate::vocabulary::{Position, WORDS, Word, keywords, word};

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

/// What may stand in a place.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// A form whose word stands in this position.
    Form(Position),
    /// A name or a number.
    Value,
    /// `t` or `nil`.
    Flag,
    /// A bound that may be infinite.
    UpperBound,
    /// A label or a program.
    Occurrence,
    /// A class.
    Class,
    /// A keyword of the form.
    Keyword(&'static str),
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
fn wanted(cursor: &Cursor<'_>) -> Vec<Wanted> {
    if cursor.first {
        return first(cursor);
    }
    if cursor.open.is_empty() {
        return vec![Wanted::Form(Position::Definition)];
    }
    let head = cursor.head(0);
    let before = cursor.open.last().map_or(0, |open| open.before);
    match cursor.keyword.as_deref() {
        Some("slack" | "contingent" | "finalp") => return vec![Wanted::Flag],
        Some("upper-bound" | "max-observation-delay") => return vec![Wanted::UpperBound, Wanted::Value],
        Some("lower-bound" | "min-observation-delay") => return vec![Wanted::Value],
        Some("type") => return vec![Wanted::Class],
        _ => {}
    }
    match head.as_str() {
        "simple" => vec![Wanted::Keyword("simple")],
        "simple-temporal" => vec![Wanted::Keyword("simple-temporal")],
        "duration" if before == 1 => vec![Wanted::Form(Position::Duration)],
        "duration" => vec![Wanted::Keyword("duration")],
        "start" | "end" => vec![Wanted::Occurrence],
        "between" if before < 3 => vec![Wanted::Form(Position::Event)],
        "between" => vec![Wanted::Form(Position::Constraint)],
        "with-temporal-constraint" if before == 1 => vec![Wanted::Form(Position::Constraint)],
        "delay" => vec![Wanted::Value, Wanted::UpperBound],
        "declare" => vec![Wanted::Form(Position::Declaration)],
        "requires" | "effect" | "and" | "or" | "not" | "over" | "at" => {
            vec![Wanted::Form(Position::Condition)]
        }
        "=" => vec![Wanted::Value],
        "define-control-program" if before < 3 => Vec::new(),
        "label" | "dotimes" | "let" | "let*" if before < 2 => Vec::new(),
        "defpackage" if before > 1 => vec![Wanted::Keyword("defpackage")],
        "defclass" | "defpackage" | "in-package" | "primitive" => Vec::new(),
        "defparameter" | "defconstant" => {
            if before > 1 {
                vec![Wanted::Value]
            } else {
                Vec::new()
            }
        }
        "" | ":slack" if matches!(cursor.head(1).as_str(), "sequence" | "parallel") => {
            vec![Wanted::Keyword("sequence")]
        }
        _ if cursor.is_in_slot() => vec![Wanted::Keyword("slot")],
        _ => match word(&head).map(|word| word.position) {
            Some(Position::Body | Position::Definition) => vec![Wanted::Form(Position::Body)],
            // The argument of a call, or of a calculation.
            _ => vec![Wanted::Value],
        },
    }
}

/// What may stand right behind a `(`, by the form around it.
fn first(cursor: &Cursor<'_>) -> Vec<Wanted> {
    let around = cursor.head(1);
    let before = cursor.open.iter().rev().nth(1).map_or(0, |open| open.before);
    if cursor.open.len() == 1 {
        return vec![Wanted::Form(Position::Definition)];
    }
    match around.as_str() {
        "declare" => vec![Wanted::Form(Position::Declaration)],
        "duration" => vec![Wanted::Form(Position::Duration)],
        "with-temporal-constraint" if before == 2 => vec![Wanted::Form(Position::Constraint)],
        "between" if before < 4 => vec![Wanted::Form(Position::Event)],
        "between" => vec![Wanted::Form(Position::Constraint)],
        "start" | "end" => vec![Wanted::Occurrence],
        "sequence" | "parallel" if before == 2 => {
            vec![Wanted::Keyword("sequence"), Wanted::Form(Position::Body)]
        }
        "requires" | "effect" | "and" | "or" | "not" | "over" | "at" => {
            vec![Wanted::Form(Position::Condition)]
        }
        "=" => vec![Wanted::Form(Position::Condition)],
        "define-control-program" if before == 3 => Vec::new(),
        "dotimes" | "let" | "let*" | "label" if before == 2 => Vec::new(),
        "defpackage" => vec![Wanted::Keyword("defpackage")],
        "defclass" | "" => Vec::new(),
        _ => match word(&around).map(|word| word.position) {
            Some(Position::Body | Position::Definition) => vec![Wanted::Form(Position::Body)],
            _ => vec![Wanted::Form(Position::Number)],
        },
    }
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
    fn add(&mut self, wanted: Wanted) {
        match wanted {
            Wanted::Form(position) => {
                self.words(position);
                match position {
                    Position::Body => self.programs(),
                    Position::Condition => self.accessors(),
                    _ => {}
                }
            }
            Wanted::Value => {
                self.values();
                if !self.cursor.first {
                    self.words(Position::Number);
                }
            }
            Wanted::Flag => ["t", "nil"].iter().for_each(|flag| self.plain(flag, CompletionKind::Value, "")),
            Wanted::UpperBound => self.plain(":infinity", CompletionKind::Value, "No limit."),
            Wanted::Occurrence => {
                for symbol in &self.analysis.symbols.symbols {
                    match symbol.kind {
                        SymbolKind::Label => self.plain(&symbol.name, CompletionKind::Label, "a label"),
                        SymbolKind::Program(_) => {
                            self.plain(
                                &symbol.name,
                                CompletionKind::Program,
                                "the one occurrence of a program",
                            );
                        }
                        _ => {}
                    }
                }
            }
            Wanted::Class => {
                for symbol in &self.analysis.symbols.symbols {
                    if let SymbolKind::Class(_) = symbol.kind {
                        self.plain(&symbol.name, CompletionKind::Class, "a class");
                    }
                }
            }
            Wanted::Keyword(head) => self.keywords(head),
        }
    }

    fn words(&mut self, position: Position) {
        for Word { name, shape, snippet, about, .. } in WORDS.iter().filter(|word| word.position == position)
        {
            if *name == "declare"
                && self.cursor.head(usize::from(self.cursor.first)) != "define-control-program"
            {
                continue;
            }
            self.form(name, CompletionKind::Word, shape, about, snippet);
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
            let words: Vec<&str> = std::iter::once(name)
                .chain(definition.parameters.iter().map(|parameter| &parameter.name))
                .map(String::as_str)
                .collect();
            let about = program(analysis.source_of(definition.span), definition);
            self.form(name, CompletionKind::Program, &format!("({})", words.join(" ")), &about, &snippet);
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

    fn keywords(&mut self, head: &str) {
        for (name, about) in keywords(head) {
            let mut snippet = format!(":{name} ");
            snippet.push_str(match *name {
                "slack" | "contingent" | "finalp" => "${1|t,nil|}",
                "use" => "#:${1:package}",
                "import-from" => "#:${1:package} #:${2:name}",
                "type" => "(member ${1})",
                _ => "${1}",
            });
            // `(:slack t)` is a list of its own.
            let is_list = matches!(head, "sequence" | "defpackage");
            match is_list
                && self.cursor.keyword.is_none()
                && self.cursor.head(0).is_empty() | self.cursor.first
            {
                true => self.form(&format!(":{name}"), CompletionKind::Keyword, "", about, &snippet),
                false => self.push(&format!(":{name}"), CompletionKind::Keyword, "", about, snippet),
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
