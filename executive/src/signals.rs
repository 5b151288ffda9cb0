//! The signals by which a mission is stopped from outside: interrupt and terminate. That the terminal hangs up is no reason.

use tokio::signal::unix::{SignalKind, signal};

use crate::desk::Desk;

/// Stops the mission in good order at the first such signal; the second ends the process at once.
pub fn stop_on_signals(desk: Desk) {
    let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
    std::thread::spawn(move || {
        runtime.block_on(async {
            // A file that may not grow any more is an error of writing, not the end of the process.
            let too_large = SignalKind::from_raw(rustix::process::Signal::XFSZ.as_raw());
            let (Ok(mut interrupt), Ok(mut terminate), Ok(mut hangup), Ok(mut too_large)) = (
                signal(SignalKind::interrupt()),
                signal(SignalKind::terminate()),
                signal(SignalKind::hangup()),
                signal(too_large),
            ) else {
                return;
            };
            let mut stopping = false;
            loop {
                let name = tokio::select! {
                    _ = interrupt.recv() => "interrupt",
                    _ = terminate.recv() => "terminate",
                    _ = hangup.recv() => continue,
                    _ = too_large.recv() => continue,
                };
                if stopping {
                    std::process::exit(1);
                }
                stopping = true;
                desk.stop(format!("by a signal ({name})"));
            }
        });
    });
}
