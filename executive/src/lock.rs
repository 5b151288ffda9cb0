//! One executive for one mission: a lock on its journal, and one on the mission itself, which holds whatever becomes of the
//! file, so that no copy of the journal is gone on with meanwhile. Both end with the process.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// How long to wait for a lock: a child that a killed executive had just begun to start may hold it for a moment.
const PATIENCE: Duration = Duration::from_secs(2);
/// How often to try meanwhile.
const PAUSE: Duration = Duration::from_millis(10);

/// Locks an open journal for as long as it is open.
///
/// # Errors
/// A sentence: somebody else has it.
pub(crate) fn lock(file: &File, path: &Path) -> Result<(), String> {
    let locked = wait(|| match file.try_lock() {
        Ok(()) => Some(()),
        Err(TryLockError::WouldBlock) => None,
        // Some file systems cannot lock; that is no reason not to execute.
        Err(TryLockError::Error(_)) => Some(()),
    });
    locked.ok_or_else(|| format!("`{}` is in use: another kirk is executing this mission", path.display()))
}

/// Is held by whoever executes a mission.
#[derive(Debug)]
pub(crate) struct Held {
    _name: Name,
}

/// Locks the mission whose dispatches have ids that begin with `run`.
///
/// # Errors
/// A sentence: somebody else has it.
pub(crate) fn hold(run: &str) -> Result<Held, String> {
    let name = wait(|| match take_name(&format!("kirk mission {run}")) {
        Ok(name) => Some(name),
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => None,
        // Where there are no such names there is the lock on the file.
        Err(_) => Some(Name::default()),
    });
    let name = name.ok_or("another kirk is executing this mission, with another copy of its journal")?;
    Ok(Held { _name: name })
}

/// Tries until it works, or patience ends.
fn wait<T>(mut attempt: impl FnMut() -> Option<T>) -> Option<T> {
    let until = Instant::now() + PATIENCE;
    loop {
        match attempt() {
            None if Instant::now() < until => std::thread::sleep(PAUSE),
            done => return done,
        }
    }
}

#[cfg(target_os = "linux")]
type Name = Option<std::os::unix::net::UnixListener>;

/// Takes a name that only one process of the machine can have, and that is not in any file system.
#[cfg(target_os = "linux")]
fn take_name(name: &str) -> io::Result<Name> {
    use std::os::linux::net::SocketAddrExt;
    use std::os::unix::net::{SocketAddr, UnixListener};
    UnixListener::bind_addr(&SocketAddr::from_abstract_name(name)?).map(Some)
}

#[cfg(not(target_os = "linux"))]
type Name = ();

#[cfg(not(target_os = "linux"))]
fn take_name(_: &str) -> io::Result<Name> {
    Ok(())
}
