//! What can be said of a text by itself and at once: its forms, its names, what is wrong with it.
//!
//! A document in an editor is one file, and a mission may consist of several. So a file without `main` is a library here:
//! instead of `main`, every program without parameters that no other calls is a mission to judge, and a program that is
//! called and not defined is a warning, as it may be defined elsewhere. A file whose packages each have a `main` is several
//! missions. `kirk check` has no such doubts: it is told what to start.

use kirk_compiler::ast::Program;
use kirk_compiler::form::Form;
use kirk_compiler::typed::{Body, Model, Work};
use kirk_compiler::{Code, Diagnostic, Front, Options, Severity, Source, Symbols, front};

use crate::lines::Lines;

/// What is known of a text before anything is unfolded.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// The text.
    pub source: Source,
    /// Its lines.
    pub lines: Lines,
    /// Its top-level forms.
    pub forms: Vec<Form>,
    /// The program as written.
    pub program: Program,
    /// Its names.
    pub symbols: Symbols,
    /// What there is to say about it, sorted by place.
    pub diagnostics: Vec<Diagnostic>,
}

/// What is left to unfold and to judge.
#[derive(Debug)]
pub struct Unjudged {
    /// The resolved program.
    pub model: Model,
    /// The programs to start from; none if there are errors.
    pub roots: Vec<usize>,
}

impl Analysis {
    /// The text itself.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// True if nothing is to be judged before something is put right.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.severity == Severity::Error)
    }
}

/// Analyses a text.
pub fn analyse(text: String) -> (Analysis, Unjudged) {
    let source = Source::new("", text);
    let front = front(std::slice::from_ref(&source), &Options::default());
    let symbols = front.symbols();
    let Front { mut forms, program, model, problems } = front;
    let forms = forms.pop().unwrap_or_default();
    let mut diagnostics = problems.into_sorted();
    let is_library = model.entry.is_none();
    diagnostics.retain(|d| !matches!(d.code, Code::NoEntry | Code::PackageNotChosen));
    let sound = !diagnostics.iter().any(|d| d.severity == Severity::Error);
    for diagnostic in &mut diagnostics {
        match diagnostic.code {
            Code::EmptySource => diagnostic.severity = Severity::Note,
            Code::UnknownProgram if is_library => diagnostic.severity = Severity::Warning,
            _ => {}
        }
    }
    let roots = if sound { roots(&model) } else { Vec::new() };
    let lines = Lines::new(&source.text);
    (Analysis { source, lines, forms, program, symbols, diagnostics }, Unjudged { model, roots })
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
    for program in &model.programs {
        let mut open: Vec<&Body> = match &program.work {
            Work::Body(body) => body.iter().collect(),
            Work::Primitive(_) => Vec::new(),
        };
        while let Some(body) = open.pop() {
            if let Body::Call { program, .. } = body {
                called[*program] = true;
            }
            open.extend(body.parts());
        }
    }
    let is_root = |&index: &usize| {
        let program = &model.programs[index];
        !called[index] && program.parameters.is_empty() && matches!(program.work, Work::Body(_))
    };
    programs().filter(is_root).collect()
}
