//! Answers that take a while, on a thread of their own: in the order they were asked for, but for those that are withdrawn.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender};

use lsp_server::{ErrorCode, RequestId, Response};

use crate::transport::{Outgoing, send};

/// What the thread is told.
pub(crate) enum Errand {
    /// To find an answer.
    Answer(Question),
    /// That an answer is wanted no more.
    Withdraw(RequestId),
}

/// A request, and how it is answered.
pub(crate) struct Question {
    pub(crate) id: RequestId,
    pub(crate) method: String,
    pub(crate) answer: Box<dyn FnOnce() -> Response + Send>,
}

/// Answers until nobody asks any more.
pub(crate) fn run(inbox: &Receiver<Errand>, outbox: &Sender<Outgoing>) {
    let mut waiting: VecDeque<Question> = VecDeque::new();
    loop {
        if waiting.is_empty() {
            match inbox.recv() {
                Ok(errand) => take(errand, &mut waiting, outbox),
                Err(_) => return,
            }
        }
        inbox.try_iter().for_each(|errand| take(errand, &mut waiting, outbox));
        if let Some(Question { id, method, answer }) = waiting.pop_front() {
            let failed = |_| {
                refuse(id, ErrorCode::InternalError, &format!("`{method}` failed: this is a bug in kirk"))
            };
            send(outbox, catch_unwind(AssertUnwindSafe(answer)).unwrap_or_else(failed));
        }
    }
}

fn take(errand: Errand, waiting: &mut VecDeque<Question>, outbox: &Sender<Outgoing>) {
    match errand {
        Errand::Answer(question) => waiting.push_back(question),
        Errand::Withdraw(id) => {
            if let Some(at) = waiting.iter().position(|question| question.id == id) {
                waiting.remove(at);
                send(outbox, refuse(id, ErrorCode::RequestCanceled, "the request was cancelled"));
            }
        }
    }
}

fn refuse(id: RequestId, code: ErrorCode, message: &str) -> Response {
    Response::new_err(id, code as i32, message.to_string())
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn what_is_withdrawn_in_time_is_not_worked_on_and_each_question_has_one_answer() {
        let (errands, inbox) = channel();
        let (outbox, outgoing) = channel();
        let ask = |id: i32, answer: Box<dyn FnOnce() -> Response + Send>| {
            let question = Question { id: id.into(), method: "textDocument/hover".to_string(), answer };
            errands.send(Errand::Answer(question)).unwrap();
        };
        ask(1, Box::new(|| Response::new_ok(1.into(), "one")));
        ask(2, Box::new(|| panic!("it was withdrawn")));
        ask(3, Box::new(|| panic!("as if it were a bug")));
        ask(4, Box::new(|| Response::new_ok(4.into(), "four")));
        errands.send(Errand::Withdraw(2.into())).unwrap();
        errands.send(Errand::Withdraw(9.into())).unwrap();
        drop(errands);
        run(&inbox, &outbox);
        drop(outbox);
        let answers: Vec<(RequestId, Option<i32>)> = outgoing
            .iter()
            .map(|outgoing| match outgoing {
                Outgoing::Message(lsp_server::Message::Response(it)) => {
                    (it.id, it.response_result.err().map(|error| error.code))
                }
                _ => panic!("no answer"),
            })
            .collect();
        let cancelled = Some(ErrorCode::RequestCanceled as i32);
        let failed = Some(ErrorCode::InternalError as i32);
        assert_eq!(answers, [(2.into(), cancelled), (1.into(), None), (3.into(), failed), (4.into(), None)]);
    }
}
