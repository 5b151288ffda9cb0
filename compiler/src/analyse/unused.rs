//! What has a name that nothing means: often a slip, or left over.

use std::cell::Cell;

use super::Labels;
use crate::ast::{Condition, ControlProgram, SlotOf, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::clip;
use crate::problem::Problems;

/// Reports parameters of a program with a body that nothing in it means. Those of a primitive program are for whoever executes
/// it: they are part of the names of its occurrences.
pub(super) fn report_parameters(definition: &ControlProgram, used: &[Cell<bool>], problems: &mut Problems) {
    if definition.primitive {
        return;
    }
    for (parameter, used) in definition.parameters.iter().zip(used) {
        if used.get() || is_in_a_condition(definition, &parameter.name) {
            continue;
        }
        let (name, program) = (clip(&parameter.name), clip(&definition.name.name));
        problems.push(
            Diagnostic::warning(
                Code::NeverUsed,
                parameter.span,
                format!("the parameter `{name}` of `{program}` is never used"),
            )
            .primary("whatever is given for it makes no difference")
            .help("Use it in the body, or take it out here and in the calls."),
        );
    }
}

/// Notes labels that no `between` means. They name events in results all the same.
pub(super) fn report_labels(labels: &Labels, problems: &mut Problems) {
    for (name, label) in labels.iter().filter(|(_, label)| !label.meant.get()) {
        let name = clip(name);
        problems.push(
            Diagnostic::note(Code::NeverUsed, label.first, format!("no `between` means the label `{name}`"))
                .primary("it only gives events another name")
                .help(format!(
                    "If a constraint was to be about it: `(between (end {name}) (start ...) ...)`."
                )),
        );
    }
}

fn is_in_a_condition(definition: &ControlProgram, name: &str) -> bool {
    let means = |value: &Value| matches!(&value.kind, ValueKind::Name(None, known) if known == name);
    let mut open: Vec<&Condition> =
        [&definition.requires, &definition.effect].into_iter().flatten().collect();
    while let Some(condition) = open.pop() {
        let found = match condition {
            Condition::And(parts) | Condition::Or(parts) => {
                open.extend(parts);
                false
            }
            Condition::Not(part)
            | Condition::AtStart(part)
            | Condition::AtEnd(part)
            | Condition::OverAll(part) => {
                open.push(part);
                false
            }
            Condition::Equal(SlotOf { object, .. }, value) => means(object) || means(value),
            Condition::Holds(SlotOf { object, .. }) => means(object),
        };
        if found {
            return true;
        }
    }
    false
}
