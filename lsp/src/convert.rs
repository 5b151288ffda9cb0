//! Places and texts of the compiler in the words of the protocol.

use std::collections::HashMap;

use kirk_compiler::{Severity, Span};
use lsp_types::{
    CompletionItemKind, DiagnosticSeverity, Documentation, Location, MarkupContent, MarkupKind, Position,
    Range, SemanticToken, SemanticTokenType, SymbolKind, TextEdit, Uri, WorkspaceEdit,
};

use crate::analysis::Analysis;
use crate::completion::CompletionKind;
use crate::highlight::{Highlight, HighlightKind};
use crate::lines::Encoding;
use crate::outline::{Outline, OutlineKind};

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

    /// The range of a place in the file it is in.
    pub(crate) fn range(&self, span: Span) -> Range {
        let (lines, text) = (self.analysis.lines_of(span), &self.analysis.source_of(span).text);
        let position = |offset| lines.position(text, offset, self.encoding);
        Range { start: position(span.start), end: position(span.end) }
    }

    /// The address of the file a place is in.
    fn address(&self, span: Span) -> Uri {
        let other = || self.analysis.source_of(span).name.parse().ok();
        if self.analysis.is_here(span) { None } else { other() }.unwrap_or_else(|| self.uri.clone())
    }

    pub(crate) fn location(&self, span: Span) -> Location {
        Location { uri: self.address(span), range: self.range(span) }
    }

    pub(crate) fn edit(&self, (span, new_text): (Span, String)) -> TextEdit {
        TextEdit { range: self.range(span), new_text }
    }

    /// Edits of this document and of those that are one program with it.
    pub(crate) fn workspace_edit(&self, edits: Vec<(Span, String)>) -> WorkspaceEdit {
        // Addresses hold no state that would change where they are.
        #[allow(clippy::mutable_key_type)]
        let mut changes: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
        for edit in edits {
            changes.entry(self.address(edit.0)).or_default().push(self.edit(edit));
        }
        WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }
    }

    pub(crate) fn span(&self, range: Range) -> Span {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        Span { source: 0, start, end: end.max(start) }
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

pub(crate) fn markdown(value: String) -> MarkupContent {
    MarkupContent { kind: MarkupKind::Markdown, value }
}

pub(crate) fn documentation(value: String) -> Option<Documentation> {
    (!value.is_empty()).then(|| Documentation::MarkupContent(markdown(value)))
}

pub(crate) fn completion_kind(kind: CompletionKind) -> CompletionItemKind {
    match kind {
        CompletionKind::Word => CompletionItemKind::KEYWORD,
        CompletionKind::Keyword => CompletionItemKind::PROPERTY,
        CompletionKind::Program => CompletionItemKind::FUNCTION,
        CompletionKind::Number => CompletionItemKind::CONSTANT,
        CompletionKind::Variable => CompletionItemKind::VARIABLE,
        CompletionKind::Label => CompletionItemKind::EVENT,
        CompletionKind::Accessor => CompletionItemKind::FIELD,
        CompletionKind::Class => CompletionItemKind::CLASS,
        CompletionKind::Value => CompletionItemKind::VALUE,
    }
}

impl Converter<'_> {
    /// Something that is defined, for a search over all documents.
    #[allow(deprecated, reason = "the field has no default")]
    pub(crate) fn information(&self, outline: Outline) -> lsp_types::SymbolInformation {
        lsp_types::SymbolInformation {
            name: outline.name,
            kind: symbol_kind(outline.kind),
            tags: None,
            deprecated: None,
            location: self.location(outline.selection),
            container_name: None,
        }
    }

    #[allow(deprecated, reason = "the field has no default")]
    pub(crate) fn symbol(&self, outline: Outline) -> lsp_types::DocumentSymbol {
        let kind = symbol_kind(outline.kind);
        let children: Vec<_> = outline.children.into_iter().map(|child| self.symbol(child)).collect();
        lsp_types::DocumentSymbol {
            name: outline.name,
            detail: (!outline.detail.is_empty()).then_some(outline.detail),
            kind,
            tags: None,
            deprecated: None,
            range: self.range(outline.whole),
            selection_range: self.range(outline.selection),
            children: (!children.is_empty()).then_some(children),
        }
    }

    /// Each piece relative to the one before it.
    pub(crate) fn semantic_tokens(&self, highlights: &[Highlight]) -> Vec<SemanticToken> {
        let mut last = Position::default();
        let mut tokens = Vec::with_capacity(highlights.len());
        for highlight in highlights {
            let start = self.position(highlight.span.start);
            let line = start.line - last.line;
            tokens.push(SemanticToken {
                delta_line: line,
                delta_start: if line == 0 { start.character - last.character } else { start.character },
                length: self.encoding.length(self.analysis.slice(highlight.span)),
                token_type: highlight.kind as u32,
                token_modifiers_bitset: u32::from(highlight.definition),
            });
            last = start;
        }
        tokens
    }
}

fn symbol_kind(kind: OutlineKind) -> SymbolKind {
    match kind {
        OutlineKind::Primitive => SymbolKind::EVENT,
        OutlineKind::Program => SymbolKind::FUNCTION,
        OutlineKind::Number => SymbolKind::CONSTANT,
        OutlineKind::Class => SymbolKind::CLASS,
        OutlineKind::Team => SymbolKind::INTERFACE,
        OutlineKind::Agent => SymbolKind::OBJECT,
        OutlineKind::Slot => SymbolKind::FIELD,
        OutlineKind::Package => SymbolKind::NAMESPACE,
    }
}

/// The types of pieces in the order of their numbers.
pub(crate) fn legend() -> Vec<SemanticTokenType> {
    let kinds = [
        (HighlightKind::Comment, SemanticTokenType::COMMENT),
        (HighlightKind::String, SemanticTokenType::STRING),
        (HighlightKind::Number, SemanticTokenType::NUMBER),
        (HighlightKind::Keyword, SemanticTokenType::KEYWORD),
        (HighlightKind::Operator, SemanticTokenType::OPERATOR),
        (HighlightKind::Function, SemanticTokenType::FUNCTION),
        (HighlightKind::Parameter, SemanticTokenType::PARAMETER),
        (HighlightKind::Variable, SemanticTokenType::VARIABLE),
        (HighlightKind::Property, SemanticTokenType::PROPERTY),
        (HighlightKind::Class, SemanticTokenType::CLASS),
        (HighlightKind::Event, SemanticTokenType::EVENT),
        (HighlightKind::Namespace, SemanticTokenType::NAMESPACE),
    ];
    debug_assert!(kinds.iter().enumerate().all(|(number, (kind, _))| *kind as usize == number));
    kinds.into_iter().map(|(_, name)| name).collect()
}
