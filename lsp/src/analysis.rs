//! What can be said of a text by itself and at once: its forms, its names, what is wrong with it.
//!
//! A document in an editor is one file, and a mission may consist of several. A text that names the others is taken with them,
//! and number 0 among the sources; what is said of it is about the text itself. Else a file without `main` is a library here:
//! instead of `main`, every program without parameters that no other calls is a mission to judge, and a program that is
//! called and not defined is a warning, as it may be defined elsewhere. A file whose packages each have a `main` is several
//! missions. `kirk check` has no such doubts: it is told what to start.

use kirk_compiler::ast::Program;
use kirk_compiler::form::Form;
use kirk_compiler::{Code, Diagnostic, Front, Options, Severity, Source, Span, Symbols, front_in_order};
use kirk_compiler::{Model, Work};

use crate::lines::Lines;
use crate::wording::Problem;

/// What is known of a text before anything is unfolded.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// The text, and those of the files that are one program with it: their names are their addresses.
    pub sources: Vec<Source>,
    /// Its lines.
    pub lines: Lines,
    /// The lines of the other files.
    others: Vec<Lines>,
    /// Its top-level forms.
    pub forms: Vec<Form>,
    /// The program as written.
    pub program: Program,
    /// Its names.
    pub symbols: Symbols,
    /// What there is to say about it, sorted by place.
    pub diagnostics: Vec<Diagnostic>,
    /// True if there is something wrong, here or in the other files.
    broken: bool,
    /// Where the other files are named, and in which order all make up the program.
    places: Vec<Span>,
    order: Vec<usize>,
}

/// The files that are one program with a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Companions {
    /// The others; their names are their addresses.
    pub others: Vec<Source>,
    /// Where the text names each of them.
    pub places: Vec<Span>,
    /// In which order they follow one another: 0 is the text itself.
    pub order: Vec<usize>,
}

impl Default for Companions {
    fn default() -> Companions {
        Companions { others: Vec::new(), places: Vec::new(), order: vec![0] }
    }
}

/// What is left to unfold and to judge.
#[derive(Debug)]
pub struct Unjudged {
    /// The resolved program.
    pub model: Model,
    /// The programs to start from; none if there are errors.
    pub roots: Vec<usize>,
    /// The texts it comes from.
    pub sources: Vec<Source>,
}

impl Analysis {
    /// The text itself.
    pub fn text(&self) -> &str {
        &self.sources[0].text
    }

    /// What is written at a place, in whatever file.
    pub fn slice(&self, span: Span) -> &str {
        self.source_of(span).slice(span)
    }

    /// The file a place is in.
    pub fn source_of(&self, span: Span) -> &Source {
        self.sources.get(span.source as usize).unwrap_or(&self.sources[0])
    }

    /// Its lines.
    pub fn lines_of(&self, span: Span) -> &Lines {
        match span.source.checked_sub(1) {
            Some(other) => self.others.get(other as usize).unwrap_or(&self.lines),
            None => &self.lines,
        }
    }

    /// True if a place is in the text itself.
    pub fn is_here(&self, span: Span) -> bool {
        span.source == 0
    }

    /// The analysis after edits of any of the files.
    pub fn after(&self, edits: &[(Span, String)]) -> (Analysis, Unjudged) {
        let edited = |(index, source): (usize, &Source)| {
            let here: Vec<(Span, String)> =
                edits.iter().filter(|(span, _)| span.source as usize == index).cloned().collect();
            Source::new(source.name.as_str(), edited(&source.text, &here))
        };
        let mut sources: Vec<Source> = self.sources.iter().enumerate().map(edited).collect();
        let text = std::mem::take(&mut sources[0].text);
        analyse_among(
            text,
            &Companions {
                others: sources.split_off(1),
                places: self.places.clone(),
                order: self.order.clone(),
            },
        )
    }

    /// True if nothing is to be judged before something is put right.
    pub fn has_errors(&self) -> bool {
        self.broken
    }
}

/// Analyses a text by itself.
pub fn analyse(text: String) -> (Analysis, Unjudged) {
    analyse_among(text, &Companions::default())
}

/// Analyses a text with the files that are one program with it.
pub fn analyse_among(text: String, companions: &Companions) -> (Analysis, Unjudged) {
    let Companions { others, places, order } = companions;
    let mut sources = vec![Source::new("", text)];
    sources.extend(others.iter().cloned());
    let Front { mut forms, program, model, uses, problems } =
        front_in_order(&sources, order, &Options::default());
    let symbols = uses.sorted();
    let forms = std::mem::take(&mut forms[0]);
    let mut diagnostics = problems.into_sorted();
    let is_library = model.entry.is_none();
    diagnostics.retain(|d| !matches!(d.code, Code::NoEntry | Code::PackageNotChosen));
    let sound = !diagnostics.iter().any(|d| d.severity == Severity::Error);
    for diagnostic in &mut diagnostics {
        match diagnostic.code {
            Code::EmptySource if diagnostic.span.source == 0 => diagnostic.severity = Severity::Note,
            Code::UnknownProgram if is_library => diagnostic.severity = Severity::Warning,
            _ => {}
        }
    }
    let broken = diagnostics.iter().any(|d| d.severity == Severity::Error);
    let elsewhere = errors_elsewhere(&diagnostics, places);
    diagnostics.retain(|d| d.span.source == 0);
    diagnostics.extend(elsewhere);
    let roots = if sound { roots(&model) } else { Vec::new() };
    let lines = Lines::new(&sources[0].text);
    let others = sources[1..].iter().map(|source| Lines::new(&source.text)).collect();
    let (places, order) = (places.clone(), order.clone());
    let unjudged = Unjudged { model, roots, sources: sources.clone() };
    let analysis =
        Analysis { sources, lines, others, forms, program, symbols, diagnostics, broken, places, order };
    (analysis, unjudged)
}

/// The text with edits that do not overlap.
pub fn edited(text: &str, edits: &[(Span, String)]) -> String {
    let mut edits: Vec<&(Span, String)> = edits.iter().collect();
    edits.sort_by_key(|(span, _)| *span);
    let mut after = String::with_capacity(text.len());
    let mut at = 0;
    for (span, new) in edits {
        after.push_str(&text[at..span.start as usize]);
        after.push_str(new);
        at = span.end as usize;
    }
    after.push_str(&text[at..]);
    after
}

/// The first error of each other file, where that is named: nothing is judged before it is put right.
fn errors_elsewhere(diagnostics: &[Diagnostic], places: &[Span]) -> Vec<Diagnostic> {
    let first = |(index, place): (usize, &Span)| {
        let is_error = |d: &&Diagnostic| d.severity == Severity::Error && d.span.source as usize == index + 1;
        diagnostics.iter().find(is_error).map(|error| Problem::Broken(error).at(*place))
    };
    places.iter().enumerate().filter_map(first).collect()
}

/// The programs a mission may start from.
fn roots(model: &Model) -> Vec<usize> {
    if let Some(entry) = model.entry {
        return vec![entry];
    }
    let programs = || 0..model.programs.len();
    let mains: Vec<usize> = programs().filter(|&index| model.programs[index].name.name == "main").collect();
    if !mains.is_empty() {
        return mains;
    }
    let mut called = vec![false; model.programs.len()];
    for (target, _) in model.programs.iter().flat_map(|program| program.calls()) {
        called[target] = true;
    }
    let is_root = |&index: &usize| {
        let program = &model.programs[index];
        !called[index] && program.parameters.is_empty() && matches!(program.work, Work::Body(_))
    };
    programs().filter(is_root).collect()
}
