//! The answers: parameters in, a feature asked, what it says converted.

use lsp_server::ErrorCode;
use lsp_types::request::*;
use lsp_types::{
    CodeActionKind, CodeActionOrCommand, Command, CompletionItem, CompletionTextEdit,
    DocumentDiagnosticReport, DocumentSymbolResponse, FoldingRangeKind, FullDocumentDiagnosticReport,
    HoverContents, InlayHintLabel, InlayHintTooltip, InsertTextFormat, ParameterInformation, ParameterLabel,
    PrepareRenameResponse, RelatedFullDocumentDiagnosticReport, SignatureInformation, Uri,
    WorkspaceSymbolResponse,
};

use super::{Answer, Params, Refusal, Work, failed};
use crate::capabilities::VERDICT;
use crate::convert::{Converter, completion_kind, documentation, markdown};
use crate::feedback::shown;
use crate::server::Server;

/// An answer that is found by work elsewhere.
type Later<R> = Result<Work<R>, Refusal>;

pub(super) fn hover(server: &mut Server, params: Params<HoverRequest>) -> Later<HoverRequest> {
    let at = params.text_document_position_params;
    let known = server.known(&at.text_document.uri)?;
    Ok(Box::new(move || {
        let to = known.converter();
        Ok(crate::hover(&known.view, to.offset(at.position)).map(|hover| lsp_types::Hover {
            contents: HoverContents::Markup(markdown(hover.markdown)),
            range: Some(to.range(hover.span)),
        }))
    }))
}

pub(super) fn definition(server: &mut Server, params: Params<GotoDefinition>) -> Answer<GotoDefinition> {
    let at = params.text_document_position_params;
    server.at(&at, |view, offset, to| {
        let places: Vec<_> =
            crate::definition(&view.analysis, offset).into_iter().map(|span| to.location(span)).collect();
        Ok((!places.is_empty()).then_some(places.into()))
    })
}

pub(super) fn references(server: &mut Server, params: Params<References>) -> Answer<References> {
    let with_definitions = params.context.include_declaration;
    server.at(&params.text_document_position, |view, offset, to| {
        let places = crate::references(&view.analysis, offset, with_definitions);
        Ok(Some(places.into_iter().map(|span| to.location(span)).collect()))
    })
}

pub(super) fn occurrences(
    server: &mut Server,
    params: Params<DocumentHighlightRequest>,
) -> Answer<DocumentHighlightRequest> {
    let at = params.text_document_position_params;
    server.at(&at, |view, offset, to| {
        let places = crate::references(&view.analysis, offset, true).into_iter();
        let places = places.filter(|span| view.analysis.is_here(*span));
        let shown = |span| lsp_types::DocumentHighlight { range: to.range(span), kind: None };
        Ok(Some(places.map(shown).collect()))
    })
}

pub(super) fn prepare_rename(
    server: &mut Server,
    params: Params<PrepareRenameRequest>,
) -> Answer<PrepareRenameRequest> {
    server.at(&params, |view, offset, to| {
        let span = crate::prepare_rename(&view.analysis, offset).map_err(failed)?;
        Ok(Some(PrepareRenameResponse::Range(to.range(span))))
    })
}

pub(super) fn rename(server: &mut Server, params: Params<Rename>) -> Answer<Rename> {
    server.at(&params.text_document_position, |view, offset, to| {
        let edits = crate::rename(&view.analysis, offset, &params.new_name).map_err(failed)?;
        Ok(Some(to.workspace_edit(edits)))
    })
}

pub(super) fn outline(
    server: &mut Server,
    params: Params<DocumentSymbolRequest>,
) -> Answer<DocumentSymbolRequest> {
    server.of(&params.text_document.uri, |view, to| {
        let symbols = crate::outline(&view.analysis).into_iter().map(|it| to.symbol(it)).collect();
        Ok(Some(DocumentSymbolResponse::Nested(symbols)))
    })
}

pub(super) fn completion(server: &mut Server, params: Params<Completion>) -> Answer<Completion> {
    let snippets = server.client.takes_snippets();
    server.at(&params.text_document_position, |view, offset, to| {
        let found = crate::completion(&view.analysis, offset).into_iter().enumerate();
        let items: Vec<_> = found.map(|(rank, it)| item(it, rank, snippets, to)).collect();
        Ok(Some(items.into()))
    })
}

pub(super) fn signature(
    server: &mut Server,
    params: Params<SignatureHelpRequest>,
) -> Answer<SignatureHelpRequest> {
    let at = params.text_document_position_params;
    server.at(&at, |view, offset, _| Ok(crate::signature(&view.analysis, offset).map(signature_help)))
}

pub(super) fn layout(server: &mut Server, params: Params<Formatting>) -> Answer<Formatting> {
    server.of(&params.text_document.uri, |view, to| {
        Ok(crate::layout(&view.analysis).map(|edits| edits.into_iter().map(|edit| to.edit(edit)).collect()))
    })
}

pub(super) fn layout_within(server: &mut Server, params: Params<RangeFormatting>) -> Answer<RangeFormatting> {
    server.of(&params.text_document.uri, |view, to| {
        let edits = crate::layout_within(&view.analysis, to.span(params.range));
        Ok(Some(edits.into_iter().map(|edit| to.edit(edit)).collect()))
    })
}

pub(super) fn symbols(
    server: &mut Server,
    params: Params<WorkspaceSymbolRequest>,
) -> Answer<WorkspaceSymbolRequest> {
    let addresses: Vec<Uri> = server.documents.values().map(|document| document.uri.clone()).collect();
    let mut found = Vec::new();
    for uri in addresses {
        found.extend(server.of(&uri, |view, to| {
            let symbols = crate::outline(&view.analysis).into_iter().filter(|it| it.is_like(&params.query));
            Ok(symbols.map(|it| to.information(it)).collect::<Vec<_>>())
        })?);
    }
    Ok(Some(WorkspaceSymbolResponse::Flat(found)))
}

pub(super) fn diagnostics(
    server: &mut Server,
    params: Params<DocumentDiagnosticRequest>,
) -> Answer<DocumentDiagnosticRequest> {
    let uri = params.text_document.uri;
    let problems = server.problems(&uri);
    server.of(&uri, |_, to| {
        let items = problems.iter().map(|problem| shown(problem, to)).collect();
        let full = FullDocumentDiagnosticReport { result_id: None, items };
        let report = RelatedFullDocumentDiagnosticReport {
            full_document_diagnostic_report: full,
            ..RelatedFullDocumentDiagnosticReport::default()
        };
        Ok(DocumentDiagnosticReport::Full(report).into())
    })
}

pub(super) fn command(server: &mut Server, params: Params<ExecuteCommand>) -> Answer<ExecuteCommand> {
    let argument = |at: usize| params.arguments.get(at).and_then(|it| it.as_str());
    let (VERDICT, Some(uri), Some(program)) = (params.command.as_str(), argument(0), argument(1)) else {
        return Err(Refusal(
            ErrorCode::InvalidParams,
            format!("there is no command `{}` of that kind", params.command),
        ));
    };
    let uri: Uri = uri.parse().map_err(|_| failed(format!("`{uri}` is no address")))?;
    let said = server.of(&uri, |view, _| {
        let lens = crate::lenses(view).into_iter().find(|lens| lens.program == program);
        Ok(lens.map(|lens| format!("`{program}` is {}", lens.title)))
    })?;
    let said = said.unwrap_or_else(|| format!("there is no verdict on `{program}` yet"));
    server.say(&said);
    Ok(Some(serde_json::Value::String(said)))
}

pub(super) fn folds(server: &mut Server, params: Params<FoldingRangeRequest>) -> Answer<FoldingRangeRequest> {
    server.of(&params.text_document.uri, |view, _| {
        let range = |fold: crate::Fold| lsp_types::FoldingRange {
            start_line: fold.first,
            end_line: fold.last,
            kind: fold.comment.then_some(FoldingRangeKind::Comment),
            ..lsp_types::FoldingRange::default()
        };
        Ok(Some(crate::folding(&view.analysis).into_iter().map(range).collect()))
    })
}

pub(super) fn tokens(
    server: &mut Server,
    params: Params<SemanticTokensFullRequest>,
) -> Answer<SemanticTokensFullRequest> {
    server.of(&params.text_document.uri, |view, to| {
        let data = to.semantic_tokens(&crate::highlight(&view.analysis));
        Ok(Some(lsp_types::SemanticTokens { result_id: None, data }.into()))
    })
}

pub(super) fn hints(server: &mut Server, params: Params<InlayHintRequest>) -> Later<InlayHintRequest> {
    let known = server.known(&params.text_document.uri)?;
    Ok(Box::new(move || {
        let to = known.converter();
        let hint = |hint: crate::Hint| lsp_types::InlayHint {
            position: to.position(hint.offset),
            label: InlayHintLabel::String(hint.label),
            kind: None,
            text_edits: None,
            tooltip: Some(InlayHintTooltip::String(hint.about)),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        };
        Ok(Some(crate::hints(&known.view, to.span(params.range)).into_iter().map(hint).collect()))
    }))
}

pub(super) fn lenses(server: &mut Server, params: Params<CodeLensRequest>) -> Answer<CodeLensRequest> {
    let address = serde_json::json!(params.text_document.uri.as_str());
    server.of(&params.text_document.uri, |view, to| {
        let lens = |lens: crate::Lens| lsp_types::CodeLens {
            range: to.range(lens.span),
            command: Some(Command {
                title: lens.title,
                command: VERDICT.to_string(),
                arguments: Some(vec![address.clone(), serde_json::json!(lens.program)]),
            }),
            data: None,
        };
        Ok(Some(crate::lenses(view).into_iter().map(lens).collect()))
    })
}

pub(super) fn actions(server: &mut Server, params: Params<CodeActionRequest>) -> Later<CodeActionRequest> {
    let uri = params.text_document.uri;
    let problems = server.problems(&uri);
    let known = server.known(&uri)?;
    Ok(Box::new(move || {
        let to = known.converter();
        let wanted = to.span(params.range);
        let here =
            |it: &kirk_compiler::Diagnostic| it.span.start <= wanted.end && wanted.start <= it.span.end;
        let problems: Vec<_> = problems.into_iter().filter(here).collect();
        let action = |action: crate::Action| {
            CodeActionOrCommand::CodeAction(lsp_types::CodeAction {
                title: action.title,
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: problems.get(action.problem).map(|it| vec![shown(it, to)]),
                edit: Some(to.workspace_edit(action.edits)),
                ..lsp_types::CodeAction::default()
            })
        };
        Ok(Some(crate::actions(&known.view, &problems).into_iter().map(action).collect()))
    }))
}

fn item(found: crate::Completion, rank: usize, snippets: bool, to: Converter<'_>) -> CompletionItem {
    let new_text = if snippets { found.snippet } else { crate::filled_in(&found.snippet) };
    CompletionItem {
        kind: Some(completion_kind(found.kind)),
        detail: (!found.detail.is_empty()).then_some(found.detail),
        documentation: documentation(found.about),
        sort_text: Some(format!("{rank:05}")),
        filter_text: Some(found.label.clone()),
        insert_text_format: Some(if snippets {
            InsertTextFormat::SNIPPET
        } else {
            InsertTextFormat::PLAIN_TEXT
        }),
        text_edit: Some(CompletionTextEdit::Edit(to.edit((found.replace, new_text)))),
        label: found.label,
        ..CompletionItem::default()
    }
}

fn signature_help(signature: crate::Signature) -> lsp_types::SignatureHelp {
    let text = |(start, end): &(usize, usize)| signature.label[*start..*end].to_string();
    let parameters = signature.parameters.iter().map(|range| ParameterInformation {
        label: ParameterLabel::Simple(text(range)),
        documentation: None,
    });
    let active = signature.active.map(|active| active as u32);
    let information = SignatureInformation {
        parameters: Some(parameters.collect()),
        documentation: documentation(signature.about),
        active_parameter: active,
        label: signature.label.clone(),
    };
    lsp_types::SignatureHelp {
        signatures: vec![information],
        active_signature: Some(0),
        active_parameter: active,
    }
}
