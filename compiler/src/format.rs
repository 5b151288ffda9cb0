//! The canonical layout of a source text.
//!
//! Where lines break and how far they are indented follows from the forms alone, and not from how they were laid out
//! before. Comments stay where they are, behind what they follow or on lines of their own; a blank line between two
//! forms stays, of several one. Names, numbers and strings are not touched.

mod layout;
mod node;
mod rules;
mod tree;

use crate::code::Code;
use crate::diagnostic::{Diagnostic, Severity};
use crate::form::{Form, write};
use crate::problem::Problems;
use crate::read::read;
use crate::source::Source;

/// How long a line may be, if there is a choice.
pub(crate) const WIDTH: usize = 100;

/// The text in its canonical layout, or why it cannot be read.
///
/// ```
/// let text = "(define-control-program main () (sequence (:slack t) (shower) ; cold\n(eat)))";
/// assert_eq!(
///     kirk_compiler::format(text).unwrap(),
///     "(define-control-program main ()
///   (sequence (:slack t)
///     (shower)  ; cold
///     (eat)))
/// "
/// );
/// ```
pub fn format(text: &str) -> Result<String, Vec<Diagnostic>> {
    let before = forms(text)?;
    let formatted = layout::lay_out(&tree::tree(text));
    // What would mean something else is not worth a pretty layout.
    match forms(&formatted) {
        Ok(after) if after == before => Ok(formatted),
        _ => Ok(text.to_string()),
    }
}

/// The forms of a text as they are read, without places.
fn forms(text: &str) -> Result<Vec<String>, Vec<Diagnostic>> {
    let mut problems = Problems::default();
    let forms: Vec<Form> = read(&Source::new("", text), 0, &mut problems);
    let mut found = problems.into_sorted();
    // Comments alone can be laid out as well.
    found.retain(|problem| problem.severity == Severity::Error && problem.code != Code::EmptySource);
    match found.is_empty() {
        true => Ok(forms.iter().map(write).collect()),
        false => Err(found),
    }
}
