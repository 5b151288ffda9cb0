//! Every request of the protocol that is answered: parameters in, a feature asked, its answer converted.

use lsp_server::{ErrorCode, Request, Response};
use lsp_types::request::{self, Request as _};
use lsp_types::{
    ClientCapabilities, HoverContents, HoverProviderCapability, InitializeResult, MarkupContent, MarkupKind,
    OneOf, ServerCapabilities, ServerInfo, TextDocumentPositionParams, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions, Uri,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::convert::Converter;
use crate::definition::{definition, references};
use crate::hover::hover;
use crate::lines::Encoding;
use crate::server::{Server, key};
use crate::view::View;

/// What the client can do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Client {
    refresh_hints: bool,
    refresh_lenses: bool,
}

impl Client {
    pub(crate) fn new(capabilities: &ClientCapabilities) -> Client {
        let workspace = capabilities.workspace.as_ref();
        let hints = workspace.and_then(|it| it.inlay_hint.as_ref()).and_then(|it| it.refresh_support);
        let lenses = workspace.and_then(|it| it.code_lens.as_ref()).and_then(|it| it.refresh_support);
        Client { refresh_hints: hints == Some(true), refresh_lenses: lenses == Some(true) }
    }

    /// What to ask of it when there is a new verdict.
    pub(crate) fn refreshes(self) -> impl Iterator<Item = &'static str> {
        let hints = self.refresh_hints.then_some(request::InlayHintRefreshRequest::METHOD);
        let lenses = self.refresh_lenses.then_some(request::CodeLensRefresh::METHOD);
        hints.into_iter().chain(lenses)
    }
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
                    contents: HoverContents::Markup(MarkupContent {
                        kind: MarkupKind::Markdown,
                        value: hover.markdown,
                    }),
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
        .finish()
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
