//! Where a name is defined, and where it is used.

use kirk_compiler::{Span, Symbol};

use crate::analysis::Analysis;

/// The name at an offset and the places where it is defined: several for a label that is given more than once.
pub fn definition(analysis: &Analysis, offset: u32) -> Vec<Span> {
    places(analysis, offset, |definition| definition)
}

/// Every place of the name at an offset, in source order; its definitions only if wanted.
pub fn references(analysis: &Analysis, offset: u32, with_definitions: bool) -> Vec<Span> {
    places(analysis, offset, |definition| with_definitions || !definition)
}

fn places(analysis: &Analysis, offset: u32, wanted: impl Fn(bool) -> bool) -> Vec<Span> {
    let Some((symbol, _)) = analysis.symbols.at(0, offset) else { return Vec::new() };
    of(analysis, symbol, wanted)
}

/// The places of a symbol without the packages before its name.
pub(crate) fn of(analysis: &Analysis, symbol: &Symbol, wanted: impl Fn(bool) -> bool) -> Vec<Span> {
    let places = symbol.places.iter().filter(|place| wanted(place.definition));
    places.map(|place| bare(analysis, place.span)).collect()
}

/// A name without what stands before it: a package, `#:`, a quotation mark.
pub(crate) fn bare(analysis: &Analysis, span: Span) -> Span {
    let text = analysis.slice(span);
    let (inner, end) = match text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        Some(inner) => (inner, span.end - 1),
        None => (text, span.end),
    };
    match inner.rsplit(':').next() {
        Some(name) if !name.is_empty() => Span { start: end - name.len() as u32, end, ..span },
        _ => span,
    }
}
