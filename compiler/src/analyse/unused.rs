//! What has a name that nothing means: often a slip, or left over.

use super::problem::Problem;
use super::symbols::Uses;
use crate::ast::Program;
use crate::problem::Problems;

/// Reports parameters of a program with a body that nothing in it means. Those of a primitive program are for whoever executes
/// it: they are part of the names of its occurrences.
pub(super) fn report_parameters(program: &Program, uses: &Uses, problems: &mut Problems) {
    for (index, parameter) in uses.parameters() {
        let definition = &program.programs[index];
        if definition.primitive || parameter.is_used() {
            continue;
        }
        problems.push(Problem::UnusedParameter {
            name: parameter.name.clone(),
            span: parameter.places[0].span,
            program: definition.name.clone(),
        });
    }
}

/// Notes labels that no `between` means. They name events in results all the same.
pub(super) fn report_labels(uses: &Uses, problems: &mut Problems) {
    for label in uses.labels().filter(|label| !label.is_used()) {
        let span = label.places.iter().map(|place| place.span).min().unwrap_or_default();
        problems.push(Problem::UnusedLabel { name: label.name.clone(), span });
    }
}
