//! One long-lived child that speaks JSON in lines: it gets dispatches on its standard input, and answers and reports
//! observations on its standard output. What it writes to standard error is for people.
//!
//! A child that ends is started again. One that does not answer in time is ended, and started again.

use std::collections::HashMap;
use std::process::Stdio;
use std::time::Duration as Real;

use serde::Deserialize;
use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncWriteExt, BufReader};
use tokio::process::{Child, ChildStdin, ChildStdout, Command};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{Instant, sleep_until, timeout};

use super::command::{kill, shell};
use super::output::Ear;
use super::{Instruction, dispatch};
use crate::desk::{Desk, Failed};
use crate::seconds;

/// What a child may say, one of them in each line.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Said {
    Executed(Executed),
    Failed {
        id: String,
        #[serde(default)]
        reason: String,
    },
    Observed(Observed),
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Executed {
    Id(String),
    Ago { id: String, ago: Option<f64> },
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Observed {
    One(String),
    Several(Vec<String>),
    Event { event: String },
}

const EXPECTED: &str = r#"expected {"executed": {"id": ...}}, {"failed": {"id": ..., "reason": ...}} or {"observed": {"event": ...}}"#;

/// How long a child that has been told that the mission is over may take to end.
const FAREWELL: Real = Real::from_secs(2);
/// How long after its end a child is started again, at first and at most.
const AGAIN: (Real, Real) = (Real::from_millis(100), Real::from_secs(5));

struct Conversation {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    /// The beginning of a line.
    partial: Vec<u8>,
    /// How many lines made no sense.
    nonsense: u32,
}

/// A longer line makes no sense, and is not kept.
const LONGEST_LINE: usize = 64 * 1024;
/// So many lines that make no sense are told of.
const MOST_NONSENSE: u32 = 20;

pub(super) async fn run(
    command: String,
    limit: Real,
    greeting: Value,
    mut inbox: UnboundedReceiver<Instruction>,
    desk: Desk,
    ear: &Ear,
) {
    let (answers, mut to_child) = unbounded_channel::<Value>();
    let mut pending: HashMap<String, Instant> = HashMap::new();
    let mut again = AGAIN.0;
    let mut starts_at = Instant::now();
    let mut conversation: Option<Conversation> = None;
    let mut last_end = "it is not started yet".to_string();
    loop {
        if conversation.is_none() && Instant::now() >= starts_at {
            match start(&command, ear) {
                Ok(started) => {
                    conversation = Some(started);
                    tell(&mut conversation, &json!({ "start": greeting })).await;
                }
                Err(reason) => {
                    desk.warn(format!("the driver cannot be started: {reason}"));
                    last_end = reason;
                    starts_at = Instant::now() + again;
                    again = (again * 2).min(AGAIN.1);
                }
            }
        }
        let deadline =
            pending.values().min().copied().unwrap_or_else(|| Instant::now() + Real::from_secs(3600));
        tokio::select! {
            instruction = inbox.recv() => match instruction {
                Some(Instruction::Send(sending)) if conversation.is_none() => {
                    desk.failed(sending.id, Failed::surely(format!("the driver is not running ({last_end})")));
                }
                Some(Instruction::Send(sending)) => {
                    let line = json!({ "dispatch": dispatch(&sending) });
                    if tell(&mut conversation, &line).await {
                        pending.insert(sending.id, Instant::now() + limit);
                    } else {
                        // Half a line may have been written: nothing more can be said to this child.
                        desk.failed(sending.id, Failed::perhaps("the driver does not take what it is told"));
                        desk.warn("the driver does not take what it is told; it is started again".to_string());
                        give_up(&mut conversation, &mut pending, &desk, "the driver was started again").await;
                        starts_at = Instant::now();
                    }
                }
                Some(Instruction::Over(execution)) => {
                    let line = json!({ "over": { "outcome": execution.outcome, "failure": execution.failure } });
                    tell(&mut conversation, &line).await;
                    ended(conversation).await;
                    return;
                }
                None => {
                    ended(conversation).await;
                    return;
                }
            },
            Some(line) = to_child.recv() => {
                tell(&mut conversation, &line).await;
            }
            () = sleep_until(starts_at), if conversation.is_none() => {}
            line = hear(&mut conversation), if conversation.is_some() => match line {
                Ok(Some(line)) => {
                    again = AGAIN.0;
                    if let Some(conversation) = &mut conversation {
                        listen(&line, conversation, &mut pending, &desk, &answers);
                    }
                }
                Ok(None) | Err(_) => {
                    let why = ended(conversation.take()).await;
                    desk.warn(format!("the driver ended ({why}); it is started again"));
                    fail_all(&mut pending, &desk, &format!("the driver ended ({why})"));
                    starts_at = Instant::now() + again;
                    again = (again * 2).min(AGAIN.1);
                    last_end = format!("it ended: {why}");
                }
            },
            () = sleep_until(deadline), if !pending.is_empty() => {
                let limit = limit.as_secs_f64();
                desk.warn(format!("the driver has not answered within {limit} s; it is started again"));
                give_up(&mut conversation, &mut pending, &desk, &format!("no answer within {limit} s")).await;
                starts_at = Instant::now();
            }
        }
    }
}

/// Ends a child with which nothing can be done any more.
async fn give_up(
    conversation: &mut Option<Conversation>,
    pending: &mut HashMap<String, Instant>,
    desk: &Desk,
    reason: &str,
) {
    fail_all(pending, desk, reason);
    if let Some(hung) = conversation.take() {
        kill(&hung.child);
        ended(Some(hung)).await;
    }
}

/// What the child was told it will not do any more; the executive decides what is tried again.
fn fail_all(pending: &mut HashMap<String, Instant>, desk: &Desk, reason: &str) {
    let mut ids: Vec<String> = std::mem::take(pending).into_keys().collect();
    ids.sort_unstable();
    for id in ids {
        desk.failed(id, Failed::perhaps(reason));
    }
}

fn start(command: &str, ear: &Ear) -> Result<Conversation, String> {
    let (_, errors) = ear.listen("driver").map_err(|error| error.to_string())?;
    let mut command: Command = shell(command);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(errors).kill_on_drop(true);
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    match (child.stdin.take(), child.stdout.take()) {
        (Some(input), Some(output)) => Ok(Conversation {
            child,
            input,
            output: BufReader::new(output),
            partial: Vec::new(),
            nonsense: 0,
        }),
        _ => Err("it has no standard input and output".to_string()),
    }
}

/// Writes a line to the child; false if it does not take it.
async fn tell(conversation: &mut Option<Conversation>, line: &Value) -> bool {
    let Some(Conversation { input, .. }) = conversation else { return false };
    let text = format!("{line}\n");
    // A child that does not read is not worth waiting for: its end is noticed elsewhere.
    let written = timeout(Real::from_secs(1), async {
        input.write_all(text.as_bytes()).await?;
        input.flush().await
    });
    matches!(written.await, Ok(Ok(())))
}

/// The next line of the child, `None` at its end. Nothing is lost if this is given up halfway.
async fn hear(conversation: &mut Option<Conversation>) -> std::io::Result<Option<Vec<u8>>> {
    let Some(Conversation { output, partial, .. }) = conversation else {
        return std::future::pending().await;
    };
    loop {
        let available = output.fill_buf().await?;
        if available.is_empty() {
            return Ok(Some(std::mem::take(partial)).filter(|rest| !rest.is_empty()));
        }
        let end = available.iter().position(|&byte| byte == b'\n');
        let taken = end.map_or(available.len(), |end| end + 1);
        // One byte more than the longest shows that it is too long.
        let room = (LONGEST_LINE + 1).saturating_sub(partial.len());
        partial.extend_from_slice(&available[..taken.min(room)]);
        output.consume(taken);
        if end.is_some() {
            return Ok(Some(std::mem::take(partial)));
        }
    }
}

fn listen(
    line: &[u8],
    conversation: &mut Conversation,
    pending: &mut HashMap<String, Instant>,
    desk: &Desk,
    answers: &UnboundedSender<Value>,
) {
    let line = String::from_utf8_lossy(line);
    let line = line.trim_start_matches('\u{feff}');
    if line.trim().is_empty() {
        return;
    }
    match serde_json::from_str(line.trim()) {
        Ok(Said::Executed(said)) => {
            let (id, ago) = match said {
                Executed::Id(id) => (id, None),
                Executed::Ago { id, ago } => (id, ago.and_then(seconds::read)),
            };
            pending.remove(&id);
            desk.executed(id, ago);
        }
        Ok(Said::Failed { id, reason }) => {
            pending.remove(&id);
            let reason = if reason.is_empty() { "the driver says it failed".to_string() } else { reason };
            desk.failed(id, Failed::surely(reason));
        }
        Ok(Said::Observed(observed)) => {
            let names = match observed {
                Observed::One(event) | Observed::Event { event } => vec![event],
                Observed::Several(events) => events,
            };
            let answers = answers.clone();
            desk.report(
                names,
                Box::new(move |answer| {
                    // The driver may be gone by now.
                    let _ = answers.send(json!({ "news": answer }));
                }),
            );
        }
        Err(error) => {
            conversation.nonsense += 1;
            let start: String = line.chars().take(80).collect();
            let start = start.trim();
            match conversation.nonsense {
                ..MOST_NONSENSE => desk.warn(format!(
                    "the driver said `{start}`, which kirk does not understand ({error}); {EXPECTED}"
                )),
                MOST_NONSENSE => desk.warn(
                    "the driver says more that kirk does not understand; that is not shown any more"
                        .to_string(),
                ),
                _ => {}
            }
        }
    }
}

async fn ended(conversation: Option<Conversation>) -> String {
    let Some(mut conversation) = conversation else { return "it was not running".to_string() };
    drop(conversation.input);
    match timeout(FAREWELL, conversation.child.wait()).await {
        Ok(Ok(status)) => status.to_string(),
        _ => {
            kill(&conversation.child);
            let _ = conversation.child.wait().await;
            "it closed its output and was ended".to_string()
        }
    }
}
