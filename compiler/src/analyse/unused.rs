//! What has a name that nothing means: often a slip, or left over.

use super::symbols::Uses;
use crate::ast::Program;
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::problem::Problems;

/// Reports parameters of a program with a body that nothing in it means. Those of a primitive program are for whoever executes
/// it: they are part of the names of its occurrences.
pub(super) fn report_parameters(program: &Program, uses: &Uses, problems: &mut Problems) {
    for (index, parameter) in uses.parameters() {
        let definition = &program.programs[index];
        if definition.primitive || parameter.is_used() {
            continue;
        }
        let (name, program) = (clip(&parameter.name), clip(&definition.name.name));
        problems.push(
            Diagnostic::warning(
                Code::NeverUsed,
                parameter.places[0].span,
                format!("the parameter `{name}` of `{program}` is never used"),
            )
            .primary("whatever is given for it makes no difference")
            .help("Use it in the body, or take it out here and in the calls."),
        );
    }
}

/// Notes labels that no `between` means. They name events in results all the same.
pub(super) fn report_labels(uses: &Uses, problems: &mut Problems) {
    for label in uses.labels().filter(|label| !label.is_used()) {
        let name = clip(&label.name);
        let first = label.places.iter().map(|place| place.span).min().unwrap_or_default();
        problems.push(
            Diagnostic::note(Code::NeverUsed, first, format!("no `between` means the label `{name}`"))
                .primary("it only gives events another name")
                .help(format!(
                    "If a constraint was to be about it: `(between (end {name}) (start ...) ...)`."
                )),
        );
    }
}
