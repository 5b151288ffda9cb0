//! Every request of the protocol that is answered: parameters in, a feature asked, its answer converted.

use lsp_server::{ErrorCode, Request, Response};
use lsp_types::request;
use lsp_types::{
    CodeActionKind, CodeActionOrCommand, Command, CompletionItem, CompletionTextEdit,
    DocumentDiagnosticReport, DocumentSymbolResponse, FoldingRangeKind, FullDocumentDiagnosticReport,
    HoverContents, InlayHintLabel, InlayHintTooltip, InsertTextFormat, ParameterInformation, ParameterLabel,
    PrepareRenameResponse, RelatedFullDocumentDiagnosticReport, SignatureInformation,
    TextDocumentPositionParams, Uri, WorkspaceSymbolResponse,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::actions::actions;
use crate::capabilities::VERDICT;
use crate::completion::{Completion, completion, filled_in};
use crate::convert::{Converter, completion_kind, documentation, markdown};
use crate::definition::{definition, references};
use crate::feedback::shown;
use crate::folding::folding;
use crate::highlight::highlight;
use crate::hints::{hints, lenses};
use crate::hover::hover;
use crate::layout::{layout, layout_within};
use crate::outline::outline;
use crate::rename::{prepare_rename, rename};
use crate::server::{Server, key};
use crate::signature::signature;
use crate::view::View;

/// Why there is no answer.
pub(crate) struct Refusal(ErrorCode, String);

type Answer<R> = Result<<R as request::Request>::Result, Refusal>;

/// Answers a request.
pub(crate) fn answer(server: &mut Server, request: Request) -> Response {
    let mut dispatcher = Dispatcher { server, request, response: None };
    dispatcher
        .on::<request::HoverRequest>(|server, params| {
            let at = params.text_document_position_params;
            server.at(&at, |view, offset, to| {
                Ok(hover(view, offset).map(|hover| lsp_types::Hover {
                    contents: HoverContents::Markup(markdown(hover.markdown)),
                    range: Some(to.range(hover.span)),
                }))
            })
        })
        .on::<request::GotoDefinition>(|server, params| {
            let at = params.text_document_position_params;
            server.at(&at, |view, offset, to| {
                let places: Vec<_> =
                    definition(&view.analysis, offset).into_iter().map(|span| to.location(span)).collect();
                Ok((!places.is_empty()).then_some(places.into()))
            })
        })
        .on::<request::References>(|server, params| {
            let with_definitions = params.context.include_declaration;
            server.at(&params.text_document_position, |view, offset, to| {
                let places = references(&view.analysis, offset, with_definitions);
                Ok(Some(places.into_iter().map(|span| to.location(span)).collect()))
            })
        })
        .on::<request::DocumentHighlightRequest>(|server, params| {
            let at = params.text_document_position_params;
            server.at(&at, |view, offset, to| {
                let places = references(&view.analysis, offset, true).into_iter();
                let places = places.filter(|span| view.analysis.is_here(*span));
                let shown = |span| lsp_types::DocumentHighlight { range: to.range(span), kind: None };
                Ok(Some(places.map(shown).collect()))
            })
        })
        .on::<request::PrepareRenameRequest>(|server, params| {
            server.at(&params, |view, offset, to| {
                let span = prepare_rename(&view.analysis, offset).map_err(failed)?;
                Ok(Some(PrepareRenameResponse::Range(to.range(span))))
            })
        })
        .on::<request::Rename>(|server, params| {
            server.at(&params.text_document_position, |view, offset, to| {
                let edits = rename(&view.analysis, offset, &params.new_name).map_err(failed)?;
                Ok(Some(to.workspace_edit(edits)))
            })
        })
        .on::<request::DocumentSymbolRequest>(|server, params| {
            server.of(&params.text_document.uri, |view, to| {
                let symbols = outline(&view.analysis).into_iter().map(|it| to.symbol(it)).collect();
                Ok(Some(DocumentSymbolResponse::Nested(symbols)))
            })
        })
        .on::<request::Completion>(|server, params| {
            let snippets = server.client.takes_snippets();
            server.at(&params.text_document_position, |view, offset, to| {
                let found = completion(&view.analysis, offset).into_iter().enumerate();
                let items: Vec<_> = found.map(|(rank, it)| item(it, rank, snippets, to)).collect();
                Ok(Some(items.into()))
            })
        })
        .on::<request::SignatureHelpRequest>(|server, params| {
            let at = params.text_document_position_params;
            server.at(&at, |view, offset, _| Ok(signature(&view.analysis, offset).map(signature_help)))
        })
        .on::<request::Formatting>(|server, params| {
            server.of(&params.text_document.uri, |view, to| {
                Ok(layout(&view.analysis).map(|edits| edits.into_iter().map(|edit| to.edit(edit)).collect()))
            })
        })
        .on::<request::RangeFormatting>(|server, params| {
            server.of(&params.text_document.uri, |view, to| {
                let edits = layout_within(&view.analysis, to.span(params.range));
                Ok(Some(edits.into_iter().map(|edit| to.edit(edit)).collect()))
            })
        })
        .on::<request::WorkspaceSymbolRequest>(|server, params| {
            let addresses: Vec<Uri> =
                server.documents.values().map(|document| document.uri.clone()).collect();
            let mut found = Vec::new();
            for uri in addresses {
                found.extend(server.of(&uri, |view, to| {
                    let symbols = outline(&view.analysis).into_iter().filter(|it| it.is_like(&params.query));
                    Ok(symbols.map(|it| to.information(it)).collect::<Vec<_>>())
                })?);
            }
            Ok(Some(WorkspaceSymbolResponse::Flat(found)))
        })
        .on::<request::DocumentDiagnosticRequest>(|server, params| {
            let uri = params.text_document.uri;
            let problems =
                server.documents.get_mut(&key(&uri)).map(|it| it.diagnostics()).unwrap_or_default();
            server.of(&uri, |_, to| {
                let items = problems.iter().map(|problem| shown(problem, to)).collect();
                let full = FullDocumentDiagnosticReport { result_id: None, items };
                let report = RelatedFullDocumentDiagnosticReport {
                    full_document_diagnostic_report: full,
                    ..RelatedFullDocumentDiagnosticReport::default()
                };
                Ok(DocumentDiagnosticReport::Full(report).into())
            })
        })
        .on::<request::ExecuteCommand>(|server, params| {
            let argument = |at: usize| params.arguments.get(at).and_then(|it| it.as_str());
            let (VERDICT, Some(uri), Some(program)) = (params.command.as_str(), argument(0), argument(1))
            else {
                return Err(Refusal(
                    ErrorCode::InvalidParams,
                    format!("there is no command `{}` of that kind", params.command),
                ));
            };
            let uri: Uri = uri.parse().map_err(|_| failed(format!("`{uri}` is no address")))?;
            let said = server.of(&uri, |view, _| {
                let lens = lenses(view).into_iter().find(|lens| lens.program == program);
                Ok(lens.map(|lens| format!("`{program}` is {}", lens.title)))
            })?;
            let said = said.unwrap_or_else(|| format!("there is no verdict on `{program}` yet"));
            server.say(&said);
            Ok(Some(serde_json::Value::String(said)))
        })
        .on::<request::FoldingRangeRequest>(|server, params| {
            server.of(&params.text_document.uri, |view, _| {
                let range = |fold: crate::folding::Fold| lsp_types::FoldingRange {
                    start_line: fold.first,
                    end_line: fold.last,
                    kind: fold.comment.then_some(FoldingRangeKind::Comment),
                    ..lsp_types::FoldingRange::default()
                };
                Ok(Some(folding(&view.analysis).into_iter().map(range).collect()))
            })
        })
        .on::<request::SemanticTokensFullRequest>(|server, params| {
            server.of(&params.text_document.uri, |view, to| {
                let data = to.semantic_tokens(&highlight(&view.analysis));
                Ok(Some(lsp_types::SemanticTokens { result_id: None, data }.into()))
            })
        })
        .on::<request::InlayHintRequest>(|server, params| {
            server.of(&params.text_document.uri, |view, to| {
                let hint = |hint: crate::hints::Hint| lsp_types::InlayHint {
                    position: to.position(hint.offset),
                    label: InlayHintLabel::String(hint.label),
                    kind: None,
                    text_edits: None,
                    tooltip: Some(InlayHintTooltip::String(hint.about)),
                    padding_left: Some(true),
                    padding_right: None,
                    data: None,
                };
                Ok(Some(hints(view, to.span(params.range)).into_iter().map(hint).collect()))
            })
        })
        .on::<request::CodeLensRequest>(|server, params| {
            let address = serde_json::json!(params.text_document.uri.as_str());
            server.of(&params.text_document.uri, |view, to| {
                let lens = |lens: crate::hints::Lens| lsp_types::CodeLens {
                    range: to.range(lens.span),
                    command: Some(Command {
                        title: lens.title,
                        command: VERDICT.to_string(),
                        arguments: Some(vec![address.clone(), serde_json::json!(lens.program)]),
                    }),
                    data: None,
                };
                Ok(Some(lenses(view).into_iter().map(lens).collect()))
            })
        })
        .on::<request::CodeActionRequest>(|server, params| {
            let uri = params.text_document.uri;
            let problems =
                server.documents.get_mut(&key(&uri)).map(|it| it.diagnostics()).unwrap_or_default();
            server.of(&uri, |view, to| {
                let wanted = to.span(params.range);
                let here = |it: &kirk_compiler::Diagnostic| {
                    it.span.start <= wanted.end && wanted.start <= it.span.end
                };
                let problems: Vec<_> = problems.into_iter().filter(here).collect();
                let action = |action: crate::actions::Action| {
                    CodeActionOrCommand::CodeAction(lsp_types::CodeAction {
                        title: action.title,
                        kind: Some(CodeActionKind::QUICKFIX),
                        diagnostics: problems.get(action.problem).map(|it| vec![shown(it, to)]),
                        edit: Some(to.workspace_edit(action.edits)),
                        ..lsp_types::CodeAction::default()
                    })
                };
                Ok(Some(actions(view, &problems).into_iter().map(action).collect()))
            })
        })
        .finish()
}

fn failed(why: String) -> Refusal {
    Refusal(ErrorCode::RequestFailed, why)
}

fn item(completion: Completion, rank: usize, snippets: bool, to: Converter<'_>) -> CompletionItem {
    let new_text = if snippets { completion.snippet } else { filled_in(&completion.snippet) };
    CompletionItem {
        kind: Some(completion_kind(completion.kind)),
        detail: (!completion.detail.is_empty()).then_some(completion.detail),
        documentation: documentation(completion.about),
        sort_text: Some(format!("{rank:05}")),
        filter_text: Some(completion.label.clone()),
        insert_text_format: Some(if snippets {
            InsertTextFormat::SNIPPET
        } else {
            InsertTextFormat::PLAIN_TEXT
        }),
        text_edit: Some(CompletionTextEdit::Edit(to.edit((completion.replace, new_text)))),
        label: completion.label,
        ..CompletionItem::default()
    }
}

fn signature_help(signature: crate::signature::Signature) -> lsp_types::SignatureHelp {
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

/// Finds the one who answers.
struct Dispatcher<'a> {
    server: &'a mut Server,
    request: Request,
    response: Option<Response>,
}

impl Dispatcher<'_> {
    fn on<R>(&mut self, answer: impl FnOnce(&mut Server, R::Params) -> Answer<R>) -> &mut Self
    where
        R: request::Request,
        R::Params: DeserializeOwned,
        R::Result: Serialize,
    {
        if self.response.is_some() || self.request.method != R::METHOD {
            return self;
        }
        let id = self.request.id.clone();
        let answered = serde_json::from_value(self.request.params.take())
            .map_err(|error| Refusal(ErrorCode::InvalidParams, format!("`{}`: {error}", R::METHOD)))
            .and_then(|params| answer(self.server, params));
        self.response = Some(match answered {
            Ok(result) => Response::new_ok(id, result),
            Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
        });
        self
    }

    fn finish(&mut self) -> Response {
        let Request { id, method, .. } = &self.request;
        self.response.take().unwrap_or_else(|| {
            let message = format!("kirk does not know the request `{method}`");
            Response::new_err(id.clone(), ErrorCode::MethodNotFound as i32, message)
        })
    }
}

impl Server {
    /// Asks a feature about a document.
    fn of<T>(
        &mut self,
        uri: &Uri,
        ask: impl FnOnce(&View, Converter<'_>) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        let encoding = self.encoding;
        let Some(document) = self.documents.get_mut(&key(uri)) else {
            let message = format!("`{}` is not open", uri.as_str());
            return Err(Refusal(ErrorCode::InvalidParams, message));
        };
        let view = document.view();
        ask(&view, Converter { analysis: &view.analysis, uri, encoding })
    }

    /// Asks a feature about a place in a document.
    fn at<T>(
        &mut self,
        at: &TextDocumentPositionParams,
        ask: impl FnOnce(&View, u32, Converter<'_>) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        self.of(&at.text_document.uri, |view, to| ask(view, to.offset(at.position), to))
    }
}
