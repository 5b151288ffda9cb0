//! RMPL source to a delay STNU, or diagnostics.

pub mod analyse;
pub mod ast;
pub mod code;
pub mod diagnostic;
pub mod episode;
pub mod expand;
pub mod explain;
pub mod form;
pub mod lower;
pub mod nearest;
pub mod notes;
pub mod parse;
pub mod problem;
pub mod read;
pub mod sexpr;
pub mod source;
pub mod typed;

pub use code::{Code, explain};
pub use diagnostic::{Diagnostic, Label, Severity};
pub use explain::explain_conflict;
pub use lower::{Origin, OriginKind, Origins, Plan};
pub use notes::notes_on_merging;
pub use sexpr::to_sexpr;
pub use source::{LineIndex, Source, Span};

use problem::Problems;

/// What to compile of the sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The package whose program is started; needed only if there are several.
    pub package: Option<String>,
    /// The program to start from.
    pub entry: String,
}

/// Everything that compiling yields, as far as it got.
#[derive(Clone, Debug)]
pub struct Compilation {
    /// The program as written.
    pub ast: ast::Program,
    /// The program unfolded.
    pub episodes: Option<episode::Episode>,
    /// The network and where it comes from; `None` if there was an error.
    pub plan: Option<Plan>,
    /// What there is to say, sorted by place.
    pub diagnostics: Vec<Diagnostic>,
}

impl Default for Options {
    fn default() -> Options {
        Options { package: None, entry: "main".to_string() }
    }
}

/// Compiles the sources as one program.
pub fn compile(sources: &[Source], options: &Options) -> Compilation {
    let mut problems = Problems::default();
    let mut ast = ast::Program::default();
    for (index, source) in sources.iter().enumerate() {
        let forms = read::read(source, index as u32, &mut problems);
        parse::parse(&forms, &mut ast, &mut problems);
    }
    let model = analyse::analyse(&ast, options, &mut problems);
    let mut episodes = None;
    let mut plan = None;
    if !problems.has_errors() {
        episodes = expand::expand(&model, &mut problems);
    }
    if !problems.has_errors()
        && let Some(root) = &episodes
        && let Some(lowered) = lower::lower(root)
    {
        for note in notes::notes_on_merging(&lowered.network, &lowered.origins, root) {
            problems.push(note);
        }
        plan = Some(lowered);
    }
    Compilation { ast, episodes, plan, diagnostics: problems.into_sorted() }
}
