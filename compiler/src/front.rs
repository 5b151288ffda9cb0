//! The front of the compiler: from sources to a resolved program, whatever is wrong with them.

use crate::analyse::analyse;
use crate::ast::Program;
use crate::form::Form;
use crate::parse::parse;
use crate::problem::Problems;
use crate::read::read;
use crate::source::Source;
use crate::typed::Model;
use crate::{Options, Uses};

/// What is known of sources before anything is unfolded.
#[derive(Debug)]
pub struct Front {
    /// The top-level forms of each source.
    pub forms: Vec<Vec<Form>>,
    /// The program as written.
    pub program: Program,
    /// The program with every name resolved and every bound checked, and the one to start from.
    pub model: Model,
    /// The names, with every place where they stand.
    pub uses: Uses,
    /// What there is to say.
    pub problems: Problems,
}

/// Reads, parses and analyses the sources as one program.
pub fn front(sources: &[Source], options: &Options) -> Front {
    let order: Vec<usize> = (0..sources.len()).collect();
    front_in_order(sources, &order, options)
}

/// The same for sources that are numbered otherwise than they follow one another: what one defines is known in the later ones.
/// Those that are not in the order are not read.
pub fn front_in_order(sources: &[Source], order: &[usize], options: &Options) -> Front {
    let mut problems = Problems::default();
    let mut program = Program::default();
    let mut all = vec![Vec::new(); sources.len()];
    for &index in order {
        let Some(source) = sources.get(index) else { continue };
        let forms = read(source, index as u32, &mut problems);
        parse(&forms, &mut program, &mut problems);
        all[index] = forms;
    }
    let (model, uses) = analyse(&program, options, &mut problems);
    Front { forms: all, program, model, uses, problems }
}
