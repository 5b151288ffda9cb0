//! When a mission fails: the record of it, and the command that is to hear of it.

use std::time::Duration as Real;

use kirk_network::Time;
use kirk_runtime::{Execution, Failure, Reason};

use crate::driver::shell;

/// How long the command may take.
const LIMIT: Real = Real::from_secs(60);

/// The failure of a mission that was stopped from outside.
pub(crate) fn stopped(execution: &Execution, now: Time, reason: &str) -> Failure {
    Failure {
        event: execution.rows.last().map_or(execution.program.clone(), |row| row.event.clone()),
        time: now,
        reason: Reason::Stopped,
        detail: format!("the mission was stopped: {reason}"),
    }
}

/// The failure of a mission whose end is not in its journal.
pub(crate) fn unrecorded(execution: &Execution, detail: &str) -> Failure {
    Failure {
        event: execution.rows.last().map_or(execution.program.clone(), |row| row.event.clone()),
        time: execution.makespan,
        reason: Reason::JournalFailed,
        detail: format!("all was executed, but that is not recorded: {detail}"),
    }
}

/// Runs a shell command with the failure in its environment.
pub(crate) fn tell(command: &str, program: &str, failure: &Failure) {
    let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
    runtime.block_on(async {
        let mut command = shell(command);
        command
            .env("KIRK_PROGRAM", program)
            .env("KIRK_REASON", failure.reason.word())
            .env("KIRK_EVENT", &failure.event)
            .env("KIRK_TIME", failure.time.to_string())
            .env("KIRK_DETAIL", &failure.detail);
        if let Ok(mut child) = command.spawn() {
            let _ = tokio::time::timeout(LIMIT, child.wait()).await;
        }
    });
}
