//! What can be folded: forms and comments of several lines.

use kirk_compiler::form::{Form, FormKind};
use kirk_compiler::read::tokens;

use crate::analysis::Analysis;
use crate::cursor::comments;

/// Lines that can be folded into their first, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fold {
    /// The line that stays.
    pub first: u32,
    /// The last line that goes.
    pub last: u32,
    /// True for comments.
    pub comment: bool,
}

/// Every fold, in source order; of several that begin on one line the longest.
pub fn folding(analysis: &Analysis) -> Vec<Fold> {
    let line = |offset: u32| analysis.lines.line_of(offset) as u32;
    let mut folds = Vec::new();
    let mut open: Vec<&Form> = analysis.forms.iter().collect();
    while let Some(form) = open.pop() {
        match &form.kind {
            FormKind::List(items) => open.extend(items),
            FormKind::Quote(inner) => open.push(inner),
            _ => continue,
        }
        folds.push(Fold { first: line(form.span.start), last: line(form.span.end), comment: false });
    }
    // Line comments on lines that follow one another are one.
    let mut run: Option<Fold> = None;
    for comment in comments(analysis.text(), &tokens(analysis.text())) {
        let (first, last) = (line(comment.start), line(comment.end));
        let alone = analysis.lines.line(analysis.text(), first).is_some_and(|text| {
            let text = text.trim_start();
            text.starts_with(';') || text.starts_with("#|")
        });
        if !alone {
            continue;
        }
        match &mut run {
            Some(fold) if fold.last + 1 == first => fold.last = last,
            _ => {
                folds.extend(run);
                run = Some(Fold { first, last, comment: true });
            }
        }
    }
    folds.extend(run);
    folds.retain(|fold| fold.first < fold.last);
    folds.sort_by_key(|fold| (fold.first, std::cmp::Reverse(fold.last)));
    folds.dedup_by_key(|fold| fold.first);
    folds
}
