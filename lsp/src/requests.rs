//! Every request of the protocol that is answered: parameters in, a feature asked, its answer converted.

use lsp_server::{ErrorCode, Request, Response};
use lsp_types::notification::{self, Notification as _};
use lsp_types::request::{self, Request as _};
use lsp_types::{
    ClientCapabilities, CodeActionKind, CodeActionOptions, CodeActionOrCommand, CodeActionProviderCapability,
    CodeLensOptions, Command, CompletionItem, CompletionOptions, CompletionTextEdit, DocumentSymbolResponse,
    FoldingRangeKind, FoldingRangeProviderCapability, HoverContents, HoverProviderCapability,
    InitializeResult, InlayHintLabel, InlayHintTooltip, InsertTextFormat, OneOf, ParameterInformation,
    ParameterLabel, PrepareRenameResponse, RenameOptions, SemanticTokenModifier, SemanticTokensFullOptions,
    SemanticTokensLegend, SemanticTokensOptions, ServerCapabilities, ServerInfo, SignatureHelpOptions,
    SignatureInformation, TextDocumentPositionParams, TextDocumentSyncCapability, TextDocumentSyncKind,
    TextDocumentSyncOptions, Uri,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::actions::actions;
use crate::completion::{Completion, completion, filled_in};
use crate::convert::{Converter, completion_kind, documentation, legend, markdown};
use crate::definition::{definition, references};
use crate::feedback::shown;
use crate::folding::folding;
use crate::highlight::highlight;
use crate::hints::{hints, lenses};
use crate::hover::hover;
use crate::layout::layout;
use crate::lines::Encoding;
use crate::outline::outline;
use crate::rename::{prepare_rename, rename};
use crate::server::{Server, key};
use crate::signature::signature;
use crate::view::View;

/// What the client can do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Client {
    refresh_hints: bool,
    refresh_lenses: bool,
    snippets: bool,
    watches: bool,
}

impl Client {
    pub(crate) fn new(capabilities: &ClientCapabilities) -> Client {
        let workspace = capabilities.workspace.as_ref();
        let hints = workspace.and_then(|it| it.inlay_hint.as_ref()).and_then(|it| it.refresh_support);
        let lenses = workspace.and_then(|it| it.code_lens.as_ref()).and_then(|it| it.refresh_support);
        let items = capabilities.text_document.as_ref().and_then(|it| it.completion.as_ref());
        let watches =
            workspace.and_then(|it| it.did_change_watched_files).and_then(|it| it.dynamic_registration);
        let snippets = items.and_then(|it| it.completion_item.as_ref()).and_then(|it| it.snippet_support);
        Client {
            refresh_hints: hints == Some(true),
            refresh_lenses: lenses == Some(true),
            snippets: snippets == Some(true),
            watches: watches == Some(true),
        }
    }

    /// True if it says when files change, if it is asked to.
    pub(crate) fn watches_files(self) -> bool {
        self.watches
    }

    /// What to ask of it when there is a new verdict.
    pub(crate) fn refreshes(self) -> impl Iterator<Item = &'static str> {
        let hints = self.refresh_hints.then_some(request::InlayHintRefreshRequest::METHOD);
        let lenses = self.refresh_lenses.then_some(request::CodeLensRefresh::METHOD);
        hints.into_iter().chain(lenses)
    }
}

/// To ask for a word when a program changes on the disk.
pub(crate) fn watchers() -> serde_json::Value {
    let globs = ["**/*.rmpl", "**/*.lisp"].map(|glob| serde_json::json!({ "globPattern": glob }));
    serde_json::json!({ "registrations": [{
        "id": "kirk-files",
        "method": notification::DidChangeWatchedFiles::METHOD,
        "registerOptions": { "watchers": globs },
    }] })
}

/// What the server can do.
pub(crate) fn initialized(encoding: Encoding) -> InitializeResult {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        ..TextDocumentSyncOptions::default()
    };
    InitializeResult {
        server_info: Some(ServerInfo {
            name: "kirk".to_string(),
            version: Some(env!("CARGO_PKG_VERSION").to_string()),
        }),
        capabilities: ServerCapabilities {
            position_encoding: Some(encoding.kind()),
            text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
            hover_provider: Some(HoverProviderCapability::Simple(true)),
            definition_provider: Some(OneOf::Left(true)),
            references_provider: Some(OneOf::Left(true)),
            document_highlight_provider: Some(OneOf::Left(true)),
            rename_provider: Some(OneOf::Right(RenameOptions {
                prepare_provider: Some(true),
                work_done_progress_options: Default::default(),
            })),
            document_symbol_provider: Some(OneOf::Left(true)),
            completion_provider: Some(CompletionOptions {
                trigger_characters: Some(vec!["(".to_string(), ":".to_string(), " ".to_string()]),
                ..CompletionOptions::default()
            }),
            signature_help_provider: Some(SignatureHelpOptions {
                trigger_characters: Some(vec!["(".to_string(), " ".to_string()]),
                ..SignatureHelpOptions::default()
            }),
            document_formatting_provider: Some(OneOf::Left(true)),
            folding_range_provider: Some(FoldingRangeProviderCapability::Simple(true)),
            semantic_tokens_provider: Some(
                SemanticTokensOptions {
                    legend: SemanticTokensLegend {
                        token_types: legend(),
                        token_modifiers: vec![SemanticTokenModifier::DEFINITION],
                    },
                    full: Some(SemanticTokensFullOptions::Bool(true)),
                    ..SemanticTokensOptions::default()
                }
                .into(),
            ),
            code_action_provider: Some(CodeActionProviderCapability::Options(CodeActionOptions {
                code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]),
                ..CodeActionOptions::default()
            })),
            inlay_hint_provider: Some(OneOf::Left(true)),
            code_lens_provider: Some(CodeLensOptions { resolve_provider: Some(false) }),
            ..ServerCapabilities::default()
        },
    }
}

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
            let snippets = server.client.snippets;
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
            server.of(&params.text_document.uri, |view, to| {
                // Without a command to run, it is only a text.
                let lens = |lens: crate::hints::Lens| lsp_types::CodeLens {
                    range: to.range(lens.span),
                    command: Some(Command { title: lens.title, command: String::new(), arguments: None }),
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
