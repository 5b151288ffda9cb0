//! The original's way: a shell command for each event, whose exit status says whether the event was executed.

use std::process::Stdio;
use std::time::Duration as Real;

use kirk_runtime::{Handover, Sending, original_spelling};
use rustix::process::{Pid, Signal, kill_process_group};
use tokio::process::{Child, Command};
use tokio::sync::mpsc::UnboundedReceiver;

use super::output::Ear;
use super::{Instruction, next};
use crate::desk::{Desk, Failed};

/// What may be in a name that is put between quotes which are not ours.
fn is_harmless(character: char) -> bool {
    character.is_ascii_alphanumeric() || "_+:./#-".contains(character)
}

pub(super) fn check(template: &str, handovers: &[Handover]) -> Result<(), String> {
    if template.trim().is_empty() {
        return Err("the driver command is empty; leave it out if there is no driver".to_string());
    }
    let places = places(template);
    if places > 2 {
        return Err(format!(
            "the driver command has {places} times `~A`; there are two things to put there, the event and its companion"
        ));
    }
    let names = handovers.iter().flat_map(|handover| [Some(&handover.name), handover.companion.as_ref()]);
    let odd: Vec<String> = names
        .flatten()
        .filter(|name| !name.chars().all(is_harmless))
        .map(|name| format!("`{name}`"))
        .collect();
    if odd.is_empty() {
        return Ok(());
    }
    Err(format!(
        "a shell could take the names {} for something else: a driver command is given only names of letters, digits and \
         `_+:./#-`. Rename the programs, or use `--driver stdio:...` or `--driver-url`",
        odd.join(", ")
    ))
}

pub(super) async fn run(
    template: String,
    limit: Real,
    mut inbox: UnboundedReceiver<Instruction>,
    desk: Desk,
    ear: &Ear,
) {
    let local = tokio::task::LocalSet::new();
    let work = async {
        while let Some(sending) = next(&mut inbox).await {
            let (template, desk, ear) = (template.clone(), desk.clone(), ear.clone());
            tokio::task::spawn_local(async move {
                match attempt(&template, &sending, limit, &ear).await {
                    Ok(()) => desk.executed(sending.id, None),
                    Err(failure) => desk.failed(sending.id, failure),
                }
            });
        }
    };
    local.run_until(work).await;
}

async fn attempt(template: &str, sending: &Sending, limit: Real, ear: &Ear) -> Result<(), Failed> {
    let event = original_spelling(&sending.name);
    let companion = sending.companion.as_deref().map_or("NIL".to_string(), original_spelling);
    let cannot = |error| Failed::surely(format!("the shell cannot be started: {error}"));
    let (output, errors) = ear.listen(&sending.name).map_err(cannot)?;
    let mut command = shell(&fill(template, &event, &companion));
    command.stdout(output).stderr(errors);
    command.env("KIRK_EVENT", event).env("KIRK_COMPANION", companion).env("KIRK_DISPATCH_ID", &sending.id);
    let mut child = command.spawn().map_err(cannot)?;
    // It holds the pipe open as well.
    drop(command);
    match tokio::time::timeout(limit, child.wait()).await {
        Ok(Ok(status)) if status.success() => Ok(()),
        Ok(Ok(status)) => Err(Failed::surely(format!("the command ended with {status}"))),
        Ok(Err(error)) => Err(Failed::perhaps(format!("the command is lost: {error}"))),
        Err(_) => {
            kill(&child);
            let _ = child.wait().await;
            let limit = limit.as_secs_f64();
            Err(Failed::perhaps(format!("the command took longer than {limit} s")))
        }
    }
}

/// A command of the shell, in a process group of its own. What it prints goes to standard error unless somebody listens, as
/// standard output is ours.
pub(crate) fn shell(text: &str) -> Command {
    let mut command = Command::new("sh");
    command.arg("-c").arg(text).stdin(Stdio::null()).stdout(std::io::stderr()).stderr(std::io::stderr());
    command.process_group(0).kill_on_drop(false);
    command
}

/// Ends a command and all it has started.
pub(crate) fn kill(child: &Child) {
    if let Some(pid) = child.id().and_then(|id| Pid::from_raw(id as i32)) {
        let _ = kill_process_group(pid, Signal::KILL);
    }
}

/// How often there is something to fill in.
fn places(template: &str) -> usize {
    template.replace("~~", "").to_uppercase().matches("~A").count()
}

/// Fills in the first two `~A`; `~~` is `~`, as for the original.
fn fill(template: &str, event: &str, companion: &str) -> String {
    let mut values = [event, companion].into_iter();
    let mut text = String::new();
    let mut rest = template;
    while let Some(at) = rest.find('~') {
        text.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        match after.chars().next() {
            Some('A' | 'a') => {
                text.push_str(values.next().unwrap_or_default());
                rest = &after[1..];
            }
            Some('~') => {
                text.push('~');
                rest = &after[1..];
            }
            _ => {
                text.push('~');
                rest = after;
            }
        }
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_event_and_its_companion_are_filled_in_and_the_rest_is_left_alone() {
        let field = r#"curl -d '{"start_cmd":"~A","end_cmd":"~a"}' ~/robot "$(cat ~~x)""#;
        assert_eq!(
            fill(field, "+UPLOAD-A::START+", "+UPLOAD-A::END+"),
            r#"curl -d '{"start_cmd":"+UPLOAD-A::START+","end_cmd":"+UPLOAD-A::END+"}' ~/robot "$(cat ~x)""#
        );
        assert_eq!(fill("robot ~A", "E", "C"), "robot E");
        assert_eq!(fill("robot", "E", "C"), "robot");
        assert!(check("~A ~A ~A", &[]).is_err());
        assert!(check("", &[]).is_err() && check(" \n", &[]).is_err());
        assert!(check("~A ~~A ~A", &[]).is_ok());
    }
}
