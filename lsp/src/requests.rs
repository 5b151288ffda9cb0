//! Every request of the protocol that is answered, by whom.

mod answers;

use kirk_compiler::Diagnostic;
use lsp_server::{ErrorCode, Request, Response};
use lsp_types::request::{self, *};
use lsp_types::{TextDocumentPositionParams, Uri};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::convert::Converter;
use crate::server::{Server, key};
use crate::view::View;

/// Why there is no answer.
pub(crate) struct Refusal(ErrorCode, String);

type Params<R> = <R as request::Request>::Params;
type Answer<R> = Result<<R as request::Request>::Result, Refusal>;

/// Answers a request.
pub(crate) fn answer(server: &mut Server, request: Request) -> Response {
    let mut router = Router { server, request, response: None };
    router
        .on::<HoverRequest>(answers::hover)
        .on::<GotoDefinition>(answers::definition)
        .on::<References>(answers::references)
        .on::<DocumentHighlightRequest>(answers::occurrences)
        .on::<PrepareRenameRequest>(answers::prepare_rename)
        .on::<Rename>(answers::rename)
        .on::<DocumentSymbolRequest>(answers::outline)
        .on::<Completion>(answers::completion)
        .on::<SignatureHelpRequest>(answers::signature)
        .on::<Formatting>(answers::layout)
        .on::<RangeFormatting>(answers::layout_within)
        .on::<WorkspaceSymbolRequest>(answers::symbols)
        .on::<DocumentDiagnosticRequest>(answers::diagnostics)
        .on::<ExecuteCommand>(answers::command)
        .on::<FoldingRangeRequest>(answers::folds)
        .on::<SemanticTokensFullRequest>(answers::tokens)
        .on::<InlayHintRequest>(answers::hints)
        .on::<CodeLensRequest>(answers::lenses)
        .on::<CodeActionRequest>(answers::actions)
        .finish()
}

fn failed(why: String) -> Refusal {
    Refusal(ErrorCode::RequestFailed, why)
}

/// Finds the one who answers.
struct Router<'a> {
    server: &'a mut Server,
    request: Request,
    response: Option<Response>,
}

impl Router<'_> {
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

    /// What is known to be wrong with a document.
    fn problems(&mut self, uri: &Uri) -> Vec<Diagnostic> {
        self.documents.get_mut(&key(uri)).map(|document| document.diagnostics()).unwrap_or_default()
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
