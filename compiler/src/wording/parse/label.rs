//! What is said about labels and events.

use super::{unexpected, wrong};
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::{clip, write};
use crate::parse::problem::LabelSlip;
use crate::words::usage;

pub(super) const LABEL: &str = usage("label");
pub(super) const BETWEEN: &str = usage("between");
pub(super) const EVENT: &str = usage("start");

pub(super) fn told(slip: LabelSlip) -> Diagnostic {
    match slip {
        LabelSlip::OfNothing { event, word } => {
            let message = format!("the `{word}` of what?");
            wrong(event, message, "a label or the name of a program is missing", EVENT)
        }
        LabelSlip::Arguments { event, side, name, all } => {
            let help = format!(
                "The name and its arguments stand in a list of their own: `({side} ({} ...))`.",
                clip(name)
            );
            unexpected(event, "an event", &help)
                .suggest("Put them into a list", [Edit::before(all, "("), Edit::after(all, ")")])
        }
        LabelSlip::NoSide { at, word, near } => {
            let message = format!("`{}` is not an event", clip(word));
            wrong(at, message, "`start` or `end` was expected", EVENT).meant(at, near)
        }
        LabelSlip::Joined { event, side, name, outside } => {
            let short = clip(name);
            let help = match outside {
                true => format!("Inside a program, the event is written `({side} {short})`."),
                false => format!("The event is written `({side} {short})`."),
            };
            unexpected(event, "an event", &help).change(event.span, format!("({side} {name})"))
        }
        LabelSlip::WhichSide { event, name } => {
            let name = clip(name);
            let written = write(event);
            let help = format!("Say which end of it is meant: `(start {name})` or `(end {name})`.");
            unexpected(event, "an event", &help)
                .change(event.span, format!("(start {written})"))
                .change(event.span, format!("(end {written})"))
        }
    }
}
