//! What is asked of the loop: how many questions at a time, and how long we wait for the answers.

use std::sync::Arc;
use std::time::Duration;

use hyper::body::Bytes;
use tokio::sync::{Mutex, Semaphore, oneshot};
use tokio::time::{Instant, timeout};

use super::Limits;
use crate::desk::{Acknowledgement, Desk, Reply};

pub(super) struct Front {
    pub(super) desk: Desk,
    limits: Limits,
    /// One for each question in the loop's inbox. `Desk` waits when that is full, and we must never wait there.
    questions: Arc<Semaphore>,
    /// The last answer about the state. Locked while the next is awaited, so that many askers ask once.
    state: Mutex<Option<State>>,
}

struct State {
    version: u64,
    asked: Instant,
    json: Bytes,
}

/// Why the loop gave no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Silence {
    /// It is not there any more.
    Over,
    /// Not in time.
    Late(Duration),
    /// It has too many questions to answer as it is.
    Flooded,
}

impl Front {
    pub(super) fn new(desk: Desk, limits: Limits) -> Front {
        Front { desk, limits, questions: Arc::new(Semaphore::new(limits.questions)), state: Mutex::default() }
    }

    /// What became of news.
    pub(super) async fn observe(&self, names: Vec<String>) -> Result<Acknowledgement, Silence> {
        self.in_time(self.ask(|reply| self.desk.report(names, reply))).await
    }

    /// The execution as it stands, in one line of JSON.
    pub(super) async fn state(&self) -> Result<Bytes, Silence> {
        self.in_time(async {
            let mut state = self.state.lock().await;
            // Before the question: what changes in between makes the answer look older than it is, never newer.
            let (version, asked) = (self.desk.version(), Instant::now());
            if let Some(known) = state.as_ref()
                && known.version == version
                && asked - known.asked < self.limits.fresh
            {
                return Ok(known.json.clone());
            }
            let json = self.ask(|reply| self.desk.state(reply)).await? + "\n";
            let json = Bytes::from(json);
            *state = Some(State { version, asked, json: json.clone() });
            Ok(json)
        })
        .await
    }

    async fn ask<T: Send + 'static>(&self, question: impl FnOnce(Reply<T>)) -> Result<T, Silence> {
        let permit = self.questions.clone().try_acquire_owned().map_err(|_| Silence::Flooded)?;
        let (sender, answer) = oneshot::channel();
        question(Box::new(move |answer| {
            drop(permit);
            // Whoever asked may have given up.
            let _ = sender.send(answer);
        }));
        answer.await.map_err(|_| Silence::Over)
    }

    async fn in_time<T>(&self, answer: impl Future<Output = Result<T, Silence>>) -> Result<T, Silence> {
        timeout(self.limits.answer, answer).await.unwrap_or(Err(Silence::Late(self.limits.answer)))
    }
}
