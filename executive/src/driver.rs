//! Drivers: what turns a dispatched event into something that happens in the world.
//!
//! A driver runs on a thread of its own. It gets what is to be sent and answers through the desk, with `executed` or
//! `failed`; it never tries again by itself, that is the executive's to decide.

mod command;
mod output;
mod stdio;
mod url;

use std::io;
use std::sync::mpsc::Sender;
use std::thread::JoinHandle;
use std::time::Duration as Real;

pub(crate) use command::shell;
use kirk_network::Time;
use kirk_runtime::{Execution, Handover, Sending, original_spelling};
pub use output::Said;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use crate::desk::Desk;
use crate::seconds;
use output::Ear;

/// Which driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Driver {
    /// A shell command for each event, a template of the original Kirk.
    Command(String),
    /// A shell command that starts one long-lived child, which speaks JSON in lines.
    Stdio(String),
    /// An HTTP address to which each event is posted.
    Url(String),
}

/// A driver at work.
pub(crate) struct Running {
    instructions: UnboundedSender<Instruction>,
    thread: JoinHandle<()>,
}

/// What a driver is told.
enum Instruction {
    Send(Sending),
    Over(Box<Execution>),
}

impl Driver {
    /// Checks, before anything starts, that this driver can be told of these events.
    ///
    /// # Errors
    /// A sentence.
    pub fn check(&self, handovers: &[Handover]) -> Result<(), String> {
        match self {
            Driver::Command(template) => command::check(template, handovers),
            Driver::Stdio(_) => Ok(()),
            Driver::Url(url) => url::Address::parse(url).map(|_| ()),
        }
    }

    /// An attempt may really take so long. `said` hears what its commands print.
    pub(crate) fn start(
        &self,
        limit: Real,
        greeting: Value,
        desk: Desk,
        said: Sender<Said>,
    ) -> io::Result<Running> {
        let (instructions, inbox) = unbounded_channel();
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let driver = self.clone();
        let thread = std::thread::Builder::new().name("driver".into()).spawn(move || {
            runtime.block_on(async {
                let (ear, silence) = Ear::new(said);
                match driver {
                    Driver::Command(template) => command::run(template, limit, inbox, desk, &ear).await,
                    Driver::Stdio(command) => {
                        stdio::run(command, limit, greeting, inbox, desk, &ear).await;
                    }
                    Driver::Url(url) => url::run(url, limit, inbox, desk).await,
                }
                silence.come(ear).await;
            });
            // Attempts nobody waits for any more do not keep the program from ending.
            runtime.shutdown_background();
        })?;
        Ok(Running { instructions, thread })
    }
}

impl Running {
    pub(crate) fn send(&self, sending: Sending) {
        // The thread ends only when it is told to.
        let _ = self.instructions.send(Instruction::Send(sending));
    }

    /// Tells the driver that the mission is over, and waits until it has heard.
    pub(crate) fn end(self, execution: Execution) {
        let _ = self.instructions.send(Instruction::Over(Box::new(execution)));
        let _ = self.thread.join();
    }
}

/// One dispatch as drivers get it in JSON.
fn dispatch(sending: &Sending) -> Value {
    let seconds = |time: Time| seconds::of(time.since_origin());
    json!({
        "id": sending.id,
        "event": sending.name,
        "companion": sending.companion,
        "name": original_spelling(&sending.name),
        "due": seconds(sending.due),
        "latest": sending.latest.map(seconds),
        "attempt": sending.attempt,
    })
}

/// The next event to send; `None` when the mission is over.
async fn next(inbox: &mut UnboundedReceiver<Instruction>) -> Option<Sending> {
    match inbox.recv().await {
        Some(Instruction::Send(sending)) => Some(sending),
        Some(Instruction::Over(_)) | None => None,
    }
}
