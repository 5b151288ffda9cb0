//! Every request of the protocol that is answered, by whom.

mod answers;

use kirk_compiler::Diagnostic;
use lsp_server::{ErrorCode, Request, RequestId, Response};
use lsp_types::request::{self, *};
use lsp_types::{TextDocumentPositionParams, Uri};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::convert::Converter;
use crate::errands::Question;
use crate::lines::Encoding;
use crate::server::{Server, key};
use crate::view::View;

/// Why there is no answer.
pub(crate) struct Refusal(ErrorCode, String);

type Params<R> = <R as request::Request>::Params;
type Answer<R> = Result<<R as request::Request>::Result, Refusal>;

/// Answers a request, or hands it on to be answered later.
pub(crate) fn answer(server: &mut Server, request: Request) -> Reply {
    let mut router = Router { server, request, reply: None };
    router
        .later::<HoverRequest>(answers::hover)
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
        .later::<InlayHintRequest>(answers::hints)
        .on::<CodeLensRequest>(answers::lenses)
        .later::<CodeActionRequest>(answers::actions)
        .finish()
}

/// What becomes of a request.
pub(crate) enum Reply {
    Now(Response),
    /// Somebody else has to find it out.
    Later(Question),
}

/// How an answer is found without the server.
type Work<R> = Box<dyn FnOnce() -> Answer<R> + Send>;

fn failed(why: String) -> Refusal {
    Refusal(ErrorCode::RequestFailed, why)
}

/// Finds the one who answers.
struct Router<'a> {
    server: &'a mut Server,
    request: Request,
    reply: Option<Reply>,
}

impl Router<'_> {
    fn on<R>(&mut self, answer: impl FnOnce(&mut Server, R::Params) -> Answer<R>) -> &mut Self
    where
        R: request::Request,
        R::Params: DeserializeOwned,
        R::Result: Serialize,
    {
        if let Some(params) = self.params::<R>() {
            let answered = params.and_then(|params| answer(self.server, params));
            self.reply = Some(Reply::Now(response::<R>(self.request.id.clone(), answered)));
        }
        self
    }

    /// What takes a while is found out elsewhere, of what is known now.
    fn later<R>(&mut self, ask: impl FnOnce(&mut Server, R::Params) -> Result<Work<R>, Refusal>) -> &mut Self
    where
        R: request::Request + 'static,
        R::Params: DeserializeOwned,
        R::Result: Serialize,
    {
        if let Some(params) = self.params::<R>() {
            let id = self.request.id.clone();
            self.reply = Some(match params.and_then(|params| ask(self.server, params)) {
                Ok(work) => {
                    let (method, asked) = (R::METHOD.to_string(), id.clone());
                    let answer = Box::new(move || response::<R>(asked, work()));
                    Reply::Later(Question { id, method, answer })
                }
                Err(refusal) => Reply::Now(response::<R>(id, Err(refusal))),
            });
        }
        self
    }

    /// The parameters of the request; nothing if it is another one, or answered.
    fn params<R>(&mut self) -> Option<Result<R::Params, Refusal>>
    where
        R: request::Request,
        R::Params: DeserializeOwned,
    {
        if self.reply.is_some() || self.request.method != R::METHOD {
            return None;
        }
        let wrong = |error| Refusal(ErrorCode::InvalidParams, format!("`{}`: {error}", R::METHOD));
        Some(serde_json::from_value(self.request.params.take()).map_err(wrong))
    }

    fn finish(&mut self) -> Reply {
        let Request { id, method, .. } = &self.request;
        self.reply.take().unwrap_or_else(|| {
            let message = format!("kirk does not know the request `{method}`");
            Reply::Now(Response::new_err(id.clone(), ErrorCode::MethodNotFound as i32, message))
        })
    }
}

fn response<R>(id: RequestId, answered: Answer<R>) -> Response
where
    R: request::Request,
    R::Result: Serialize,
{
    match answered {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    }
}

/// What is known of a document, for whoever answers later.
struct Known {
    view: View,
    uri: Uri,
    encoding: Encoding,
}

impl Known {
    fn converter(&self) -> Converter<'_> {
        Converter { analysis: &self.view.analysis, uri: &self.uri, encoding: self.encoding }
    }
}

impl Server {
    /// Asks a feature about a document.
    fn of<T>(
        &mut self,
        uri: &Uri,
        ask: impl FnOnce(&View, Converter<'_>) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        let known = self.known(uri)?;
        ask(&known.view, known.converter())
    }

    /// What is known of a document.
    fn known(&mut self, uri: &Uri) -> Result<Known, Refusal> {
        let encoding = self.encoding;
        let Some(document) = self.documents.get_mut(&key(uri)) else {
            let message = format!("`{}` is not open", uri.as_str());
            return Err(Refusal(ErrorCode::InvalidParams, message));
        };
        Ok(Known { view: document.view(), uri: uri.clone(), encoding })
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
