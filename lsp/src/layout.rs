//! The canonical layout, as `kirk fmt` gives it.

use kirk_compiler::{Span, format};

use crate::analysis::Analysis;

/// The edit that lays a text out; none if it is, `None` if it cannot be read. The ends of its lines stay what they are.
pub fn layout(analysis: &Analysis) -> Option<Vec<(Span, String)>> {
    let text = analysis.text();
    let mut after = format(text).ok()?;
    if text.contains("\r\n") {
        after = after.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    if after == text {
        return Some(Vec::new());
    }
    // Only the lines that differ, so that the cursor stays where it is.
    let (old, new): (Vec<&str>, Vec<&str>) =
        (text.split_inclusive('\n').collect(), after.split_inclusive('\n').collect());
    let shorter = old.len().min(new.len());
    let before = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let behind =
        old.iter().rev().zip(new.iter().rev()).take(shorter - before).take_while(|(a, b)| a == b).count();
    let length = |lines: &[&str]| lines.iter().map(|line| line.len()).sum::<usize>();
    let (start, end) = (length(&old[..before]), text.len() - length(&old[old.len() - behind..]));
    Some(vec![(Span::new(0, start, end), new[before..new.len() - behind].concat())])
}

/// The edits that lay out the top-level forms which a range touches; what cannot be read stays as it is.
pub fn layout_within(analysis: &Analysis, within: Span) -> Vec<(Span, String)> {
    let touched = analysis.forms.iter().map(|form| form.span);
    let touched =
        touched.filter(|form| form.start < within.end.max(within.start + 1) && within.start < form.end);
    let edit = |form: Span| {
        let before = analysis.slice(form);
        let plain = before.replace("\r\n", "\n");
        let mut after = format(&plain).ok()?.trim_end().to_string();
        if before.contains("\r\n") || analysis.text().contains("\r\n") {
            after = after.replace('\n', "\r\n");
        }
        (after != before).then_some((form, after))
    };
    touched.filter_map(edit).collect()
}
