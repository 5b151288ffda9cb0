//! The protocol: what the client asks, in its order, and what it is told unasked.
//!
//! Five threads. One reads and one writes, so that neither waits for the client. One judges, as that may take long, and one
//! finds the answers that take a while. The one in the middle, here, has the documents and answers, and waits for nothing but the next event. It takes all events
//! there are at once: of several edits that came meanwhile only the last text is analysed, and of several texts only the
//! newest is judged.

use std::collections::{BTreeMap, HashSet};
use std::io::{BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use kirk_compiler::Diagnostic;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{self, Notification as _};
use lsp_types::request::{self, Request as _};
use lsp_types::{InitializeParams, Uri};
use serde_json::Value;

use crate::analysis::Unjudged;
use crate::capabilities;
use crate::companions::{ReadFile, gather, path_of};
use crate::convert::Converter;
use crate::document::Document;
use crate::errands::{self, Errand};
use crate::feedback::feedback;
use crate::judged::{Judged, judge};
use crate::lines::Encoding;
use crate::requests::{self, Reply};
use crate::transport::{Incoming, Outgoing, read, send, write};

/// What happens to the server.
enum Event {
    Incoming(Incoming),
    Judged(Verdicts),
    /// Nothing more will come.
    End,
}

/// A text to judge.
struct Job {
    uri: String,
    revision: u64,
    text: String,
    unjudged: Unjudged,
}

/// What came of it.
struct Verdicts {
    uri: String,
    revision: u64,
    text: String,
    missions: Vec<Judged>,
    diagnostics: Vec<Diagnostic>,
}

/// Judging deeply nested programs takes a deep stack.
const STACK: usize = 256 << 20;

/// How long what is known is held back for a verdict, so that both appear at once.
const PATIENCE: Duration = Duration::from_millis(150);

/// Serves one client until it leaves; true if it took leave as the protocol wants it. What documents name and the client has not
/// open is read by `files`.
pub fn serve(
    input: impl BufRead + Send + 'static,
    output: impl Write + Send + 'static,
    files: ReadFile,
) -> bool {
    let (events, inbox) = channel();
    let (outbox, outgoing) = channel();
    let (jobs, waiting) = channel();
    let (errands, questions) = channel();
    let reader_events = events.clone();
    thread::spawn(move || {
        read(input, |incoming| reader_events.send(Event::Incoming(incoming)).is_ok());
        let _ = reader_events.send(Event::End);
    });
    let writer = thread::spawn(move || write(output, &outgoing));
    let judge = thread::Builder::new().stack_size(STACK).spawn(move || judge_all(&waiting, &events));
    let answers = outbox.clone();
    let later = thread::Builder::new().stack_size(STACK).spawn(move || errands::run(&questions, &answers));
    if judge.is_err() || later.is_err() {
        return false;
    }
    let server = Server::new(outbox, (jobs, errands), files);
    let middle = thread::Builder::new().stack_size(STACK).spawn(move || server.run(&inbox));
    let polite = middle.is_ok_and(|middle| middle.join().unwrap_or(false));
    // The outbox is gone with the server: what is left in it is written, and no more comes.
    let _ = writer.join();
    polite
}

/// Judges the newest text of each document.
fn judge_all(waiting: &Receiver<Job>, events: &Sender<Event>) {
    while let Ok(first) = waiting.recv() {
        let mut newest = BTreeMap::from([(first.uri.clone(), first)]);
        for job in waiting.try_iter() {
            newest.insert(job.uri.clone(), job);
        }
        for (uri, Job { revision, text, unjudged, .. }) in newest {
            let judged = catch_unwind(AssertUnwindSafe(|| judge(unjudged)));
            let (missions, diagnostics) = judged.unwrap_or_default();
            let verdicts = Verdicts { uri, revision, text, missions, diagnostics };
            if events.send(Event::Judged(verdicts)).is_err() {
                return;
            }
        }
    }
}

/// How far the conversation is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Open,
    ShutDown,
}

/// The documents, and what the client can do.
pub(crate) struct Server {
    outbox: Sender<Outgoing>,
    jobs: Sender<Job>,
    errands: Sender<Errand>,
    state: State,
    pub(crate) encoding: Encoding,
    pub(crate) client: capabilities::Client,
    pub(crate) documents: BTreeMap<String, Document>,
    /// Counts the requests to the client.
    asked: i32,
    files: ReadFile,
    /// Something has changed that documents may name.
    stale: bool,
}

impl Server {
    fn new(
        outbox: Sender<Outgoing>,
        (jobs, errands): (Sender<Job>, Sender<Errand>),
        files: ReadFile,
    ) -> Server {
        Server {
            outbox,
            jobs,
            errands,
            state: State::New,
            encoding: Encoding::default(),
            client: capabilities::Client::default(),
            documents: BTreeMap::new(),
            asked: 0,
            files,
            stale: false,
        }
    }

    /// Handles events until the client leaves; true if it took leave.
    fn run(mut self, inbox: &Receiver<Event>) -> bool {
        loop {
            let held_back = self.documents.values().any(|document| !document.settled);
            let first = match held_back {
                false => inbox.recv().unwrap_or(Event::End),
                true => match inbox.recv_timeout(PATIENCE) {
                    Ok(event) => event,
                    Err(RecvTimeoutError::Disconnected) => Event::End,
                    Err(RecvTimeoutError::Timeout) => {
                        self.guarded(Server::publish_held_back);
                        continue;
                    }
                },
            };
            let events: Vec<Event> = std::iter::once(first).chain(inbox.try_iter()).collect();
            let cancelled = cancelled(&events);
            for event in events {
                match event {
                    Event::Incoming(Incoming::Malformed(answer)) => {
                        let _ = self.outbox.send(Outgoing::Raw(answer));
                    }
                    Event::Incoming(Incoming::Message(Message::Request(request))) => {
                        self.request(request, &cancelled);
                    }
                    Event::Incoming(Incoming::Message(Message::Notification(notification))) => {
                        if notification.method == notification::Exit::METHOD {
                            return self.state == State::ShutDown;
                        }
                        self.guarded(|server| server.notification(notification));
                    }
                    // Answers to what was asked of the client: nothing depends on them.
                    Event::Incoming(Incoming::Message(Message::Response(_))) => {}
                    Event::Judged(verdicts) => self.guarded(|server| server.judged(verdicts)),
                    Event::End => return self.state == State::ShutDown,
                }
            }
            self.guarded(Server::hand_on);
        }
    }

    /// Does something that must not end the session, whatever is wrong with it.
    fn guarded(&mut self, work: impl FnOnce(&mut Server)) {
        if catch_unwind(AssertUnwindSafe(|| work(self))).is_err() {
            self.log("kirk could not follow a change: this is a bug in kirk");
        }
    }

    fn request(&mut self, request: Request, cancelled: &HashSet<RequestId>) {
        let id = request.id.clone();
        let refuse =
            |code: ErrorCode, message: &str| Response::new_err(id.clone(), code as i32, message.to_string());
        let response = match (self.state, request.method.as_str()) {
            (State::New, "initialize") => self.initialize(request),
            (State::New, _) => refuse(ErrorCode::ServerNotInitialized, "`initialize` comes first"),
            (State::ShutDown, _) => refuse(ErrorCode::InvalidRequest, "the server has been shut down"),
            (State::Open, "initialize") => {
                refuse(ErrorCode::InvalidRequest, "the server is initialized already")
            }
            (State::Open, "shutdown") => {
                self.state = State::ShutDown;
                Response::new_ok(id, Value::Null)
            }
            (State::Open, _) if cancelled.contains(&id) => {
                refuse(ErrorCode::RequestCanceled, "the request was cancelled")
            }
            (State::Open, method) => {
                let method = method.to_string();
                match catch_unwind(AssertUnwindSafe(|| requests::answer(self, request))) {
                    Ok(Reply::Now(response)) => response,
                    Ok(Reply::Later(question)) => {
                        let _ = self.errands.send(Errand::Answer(question));
                        return;
                    }
                    Err(_) => {
                        refuse(ErrorCode::InternalError, &format!("`{method}` failed: this is a bug in kirk"))
                    }
                }
            }
        };
        send(&self.outbox, response);
    }

    fn initialize(&mut self, request: Request) -> Response {
        let params: InitializeParams = match serde_json::from_value(request.params) {
            Ok(params) => params,
            Err(error) => {
                return Response::new_err(request.id, ErrorCode::InvalidParams as i32, error.to_string());
            }
        };
        let general = params.capabilities.general.as_ref();
        self.encoding = Encoding::negotiate(general.and_then(|it| it.position_encodings.as_deref()));
        self.client = capabilities::Client::new(&params.capabilities);
        self.state = State::Open;
        Response::new_ok(request.id, capabilities::initialized(self.encoding))
    }

    fn notification(&mut self, notification: Notification) {
        if self.state != State::Open {
            return;
        }
        let Notification { method, params } = notification;
        let understood = match method.as_str() {
            notification::DidOpenTextDocument::METHOD => {
                serde_json::from_value(params).map(|it| self.opened(it))
            }
            notification::DidChangeTextDocument::METHOD => {
                serde_json::from_value(params).map(|it| self.changed(it))
            }
            notification::DidCloseTextDocument::METHOD => {
                serde_json::from_value(params).map(|it| self.closed(it))
            }
            notification::DidChangeWatchedFiles::METHOD => {
                self.stale = true;
                Ok(())
            }
            notification::Cancel::METHOD => {
                if let Some(id) = withdrawn(&params) {
                    let _ = self.errands.send(Errand::Withdraw(id));
                }
                Ok(())
            }
            notification::Initialized::METHOD => {
                self.watch_files();
                Ok(())
            }
            _ => Ok(()),
        };
        if let Err(error) = understood {
            self.log(&format!("`{method}` is not as it should be: {error}"));
        }
    }

    fn opened(&mut self, params: lsp_types::DidOpenTextDocumentParams) {
        let item = params.text_document;
        let document = Document::new(item.uri.clone(), item.version, item.text);
        self.documents.insert(key(&item.uri), document);
        self.accompany(&key(&item.uri));
        self.stale = true;
    }

    fn changed(&mut self, params: lsp_types::DidChangeTextDocumentParams) {
        let (uri, version) = (params.text_document.uri, params.text_document.version);
        match self.documents.get_mut(&key(&uri)) {
            Some(document) => {
                document.change(version, params.content_changes, self.encoding);
                self.accompany(&key(&uri));
                self.stale = true;
            }
            None => self.log(&format!("`{}` was changed and is not open", uri.as_str())),
        }
    }

    fn closed(&mut self, params: lsp_types::DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        if self.documents.remove(&key(&uri)).is_some() {
            self.stale = true;
            let nothing = lsp_types::PublishDiagnosticsParams { uri, diagnostics: Vec::new(), version: None };
            self.notify::<notification::PublishDiagnostics>(nothing);
        }
    }

    /// Asks the client to say when a file changes that it has not open, if it can.
    fn watch_files(&mut self) {
        if self.client.watches_files() {
            self.asked += 1;
            let (id, method) = (RequestId::from(self.asked), request::RegisterCapability::METHOD.to_string());
            send(&self.outbox, Request { id, method, params: capabilities::watchers() });
        }
    }

    /// Gives a document the files it names, as they are open or else as they are on the disk.
    fn accompany(&mut self, uri: &str) {
        let Some(document) = self.documents.get(uri) else { return };
        let open = |path: &Path| {
            let same = |(uri, _): &(&String, &Document)| path_of(uri).is_some_and(|known| known == path);
            self.documents.iter().find(same).map(|(_, document)| document.text().to_string())
        };
        let companions = gather(uri, document.text(), |path| open(path).or_else(|| (self.files)(path)));
        if let Some(document) = self.documents.get_mut(uri) {
            document.accompany(companions);
        }
    }

    /// Hands on every text that is new: to be judged, or, with errors in it, to the client.
    fn hand_on(&mut self) {
        if std::mem::take(&mut self.stale) {
            let all: Vec<String> = self.documents.keys().cloned().collect();
            all.iter().for_each(|uri| self.accompany(uri));
        }
        let mut settled = Vec::new();
        for (uri, document) in &mut self.documents {
            if document.handed_on {
                continue;
            }
            document.handed_on = true;
            match document.take_unjudged() {
                Some(unjudged) => {
                    let (revision, text) = (document.revision(), document.text().to_string());
                    let _ = self.jobs.send(Job { uri: uri.clone(), revision, text, unjudged });
                }
                None => settled.push(uri.clone()),
            }
        }
        settled.iter().for_each(|uri| self.publish(uri));
    }

    fn judged(&mut self, verdicts: Verdicts) {
        let Verdicts { uri, revision, text, missions, diagnostics } = verdicts;
        // Closed meanwhile.
        let Some(document) = self.documents.get_mut(&uri) else { return };
        if document.keep((revision, text), missions, diagnostics) {
            self.publish(&uri);
            for method in self.client.refreshes() {
                self.asked += 1;
                let id = RequestId::from(self.asked);
                send(&self.outbox, Request { id, method: method.to_string(), params: Value::Null });
            }
        }
    }

    /// Publishes what is known while a verdict is still to come.
    fn publish_held_back(&mut self) {
        let waiting: Vec<String> =
            self.documents.iter().filter(|(_, it)| !it.settled).map(|(uri, _)| uri.clone()).collect();
        waiting.iter().for_each(|uri| self.publish(uri));
    }

    fn publish(&mut self, uri: &str) {
        let Some(document) = self.documents.get_mut(uri) else { return };
        document.settled = true;
        if self.client.pulls_diagnostics() {
            return;
        }
        let diagnostics = document.diagnostics();
        let analysis = document.analysis();
        let converter = Converter { analysis: &analysis, uri: &document.uri, encoding: self.encoding };
        let params = feedback(&diagnostics, document.version, converter);
        self.notify::<notification::PublishDiagnostics>(params);
    }

    fn notify<N: notification::Notification>(&self, params: N::Params) {
        send(&self.outbox, Notification::new(N::METHOD.to_string(), params));
    }

    /// Says something to the person at the editor.
    pub(crate) fn say(&self, message: &str) {
        let (typ, message) = (lsp_types::MessageType::INFO, message.to_string());
        self.notify::<notification::ShowMessage>(lsp_types::ShowMessageParams { typ, message });
    }

    fn log(&self, message: &str) {
        let params = lsp_types::LogMessageParams {
            typ: lsp_types::MessageType::WARNING,
            message: message.to_string(),
        };
        self.notify::<notification::LogMessage>(params);
    }
}

/// Documents are told apart by the text of their addresses.
pub(crate) fn key(uri: &Uri) -> String {
    uri.as_str().to_string()
}

/// The requests that are withdrawn by something that came with them.
fn cancelled(events: &[Event]) -> HashSet<RequestId> {
    let id = |event: &Event| match event {
        Event::Incoming(Incoming::Message(Message::Notification(it)))
            if it.method == notification::Cancel::METHOD =>
        {
            withdrawn(&it.params)
        }
        _ => None,
    };
    events.iter().filter_map(id).collect()
}

/// The request that a cancellation is of.
fn withdrawn(params: &Value) -> Option<RequestId> {
    serde_json::from_value(params.get("id")?.clone()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_request_withdrawn_before_it_is_looked_at_is_not_answered() {
        let notification = |method: &str, params| {
            let notification = Notification { method: method.to_string(), params };
            Event::Incoming(Incoming::Message(Message::Notification(notification)))
        };
        let events = [
            notification("$/cancelRequest", json!({"id": 7})),
            notification("$/cancelRequest", json!({"id": "seven"})),
            notification("$/cancelRequest", json!({"nothing": 8})),
            notification("exit", json!({"id": 9})),
        ];
        let withdrawn = cancelled(&events);
        assert_eq!(withdrawn, HashSet::from([RequestId::from(7), RequestId::from("seven".to_string())]));
        let (outbox, outgoing) = channel();
        let (jobs, _waiting) = channel();
        let (errands, _questions) = channel();
        let mut server =
            Server { state: State::Open, ..Server::new(outbox, (jobs, errands), Box::new(|_| None)) };
        let params = json!({"textDocument": {"uri": "file:///x"}, "position": {"line": 0, "character": 0}});
        server
            .request(Request { id: 7.into(), method: "textDocument/hover".to_string(), params }, &withdrawn);
        let Ok(Outgoing::Message(Message::Response(answer))) = outgoing.try_recv() else {
            panic!("no answer")
        };
        assert_eq!(answer.response_result.unwrap_err().code, ErrorCode::RequestCanceled as i32);
    }
}
