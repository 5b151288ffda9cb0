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
use kirk_runtime::{Execution, Handover, Sending, original_spelling};
pub use output::Said;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use crate::desk::Desk;
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

/// How a driver is treated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Treatment {
    /// How long an attempt may take, really.
    pub(crate) limit: Real,
}

/// A driver at work.
pub(crate) struct Running {
    orders: UnboundedSender<Order>,
    thread: JoinHandle<()>,
}

enum Order {
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

    /// `said` hears what its commands print.
    pub(crate) fn start(
        &self,
        treatment: Treatment,
        greeting: Value,
        desk: Desk,
        said: Sender<Said>,
    ) -> io::Result<Running> {
        let (orders, inbox) = unbounded_channel();
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let driver = self.clone();
        let thread = std::thread::Builder::new().name("driver".into()).spawn(move || {
            runtime.block_on(async {
                let (ear, silence) = Ear::new(said);
                match driver {
                    Driver::Command(template) => command::run(template, treatment, inbox, desk, &ear).await,
                    Driver::Stdio(command) => {
                        stdio::run(command, treatment, greeting, inbox, desk, &ear).await;
                    }
                    Driver::Url(url) => url::run(url, treatment, inbox, desk).await,
                }
                silence.come(ear).await;
            });
            // Attempts nobody waits for any more do not keep the program from ending.
            runtime.shutdown_background();
        })?;
        Ok(Running { orders, thread })
    }
}

impl Running {
    pub(crate) fn send(&self, sending: Sending) {
        // The thread ends only when it is told to.
        let _ = self.orders.send(Order::Send(sending));
    }

    /// Tells the driver that the mission is over, and waits until it has heard.
    pub(crate) fn end(self, execution: Execution) {
        let _ = self.orders.send(Order::Over(Box::new(execution)));
        let _ = self.thread.join();
    }
}

/// One dispatch as drivers get it in JSON.
fn dispatch(sending: &Sending) -> Value {
    let seconds = |time: kirk_network::Time| time.as_micros() as f64 / 1e6;
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
async fn next(inbox: &mut UnboundedReceiver<Order>) -> Option<Sending> {
    match inbox.recv().await {
        Some(Order::Send(sending)) => Some(sending),
        Some(Order::Over(_)) | None => None,
    }
}
