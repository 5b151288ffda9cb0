//! What there is to say about a document, as the editor shows it: everything anew each time, so that what is put right
//! disappears.

use kirk_compiler::{Code, Diagnostic, Label};
use lsp_types::{DiagnosticRelatedInformation, DiagnosticTag, NumberOrString, PublishDiagnosticsParams};

use crate::convert::{Converter, severity};

/// The diagnostics of one version of a document.
pub(crate) fn feedback(
    diagnostics: &[Diagnostic],
    version: i32,
    converter: Converter<'_>,
) -> PublishDiagnosticsParams {
    PublishDiagnosticsParams {
        uri: converter.uri.clone(),
        version: Some(version),
        diagnostics: diagnostics.iter().map(|diagnostic| shown(diagnostic, converter)).collect(),
    }
}

/// One of them. An editor has no place for the text beside the primary place: it is part of the message where it adds to it.
pub(crate) fn shown(diagnostic: &Diagnostic, converter: Converter<'_>) -> lsp_types::Diagnostic {
    let related = |label: &Label| DiagnosticRelatedInformation {
        location: converter.location(label.span),
        message: label.message.clone(),
    };
    let mut message = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        message.push('\n');
        message.push_str(help);
    }
    lsp_types::Diagnostic {
        range: converter.range(diagnostic.span),
        severity: Some(severity(diagnostic.severity)),
        code: Some(NumberOrString::String(diagnostic.code.to_string())),
        source: Some("kirk".to_string()),
        message,
        related_information: (!diagnostic.labels.is_empty())
            .then(|| diagnostic.labels.iter().map(related).collect()),
        tags: (diagnostic.code == Code::NeverUsed).then(|| vec![DiagnosticTag::UNNECESSARY]),
        ..lsp_types::Diagnostic::default()
    }
}
