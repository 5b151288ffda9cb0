//! Places and texts of the compiler in the words of the protocol.

use kirk_compiler::{Severity, Span};
use lsp_types::{DiagnosticSeverity, Location, Position, Range, Uri};

use crate::analysis::Analysis;
use crate::lines::Encoding;

/// Converts places of one text.
#[derive(Clone, Copy)]
pub(crate) struct Converter<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) uri: &'a Uri,
    pub(crate) encoding: Encoding,
}

impl Converter<'_> {
    pub(crate) fn position(&self, offset: u32) -> Position {
        self.analysis.lines.position(self.analysis.text(), offset, self.encoding)
    }

    pub(crate) fn range(&self, span: Span) -> Range {
        Range { start: self.position(span.start), end: self.position(span.end) }
    }

    pub(crate) fn location(&self, span: Span) -> Location {
        Location { uri: self.uri.clone(), range: self.range(span) }
    }

    pub(crate) fn offset(&self, position: Position) -> u32 {
        self.analysis.lines.offset(self.analysis.text(), position, self.encoding) as u32
    }
}

pub(crate) fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::ERROR,
        Severity::Warning => DiagnosticSeverity::WARNING,
        Severity::Note => DiagnosticSeverity::INFORMATION,
    }
}
