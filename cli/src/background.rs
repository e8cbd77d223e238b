//! Threads that wait for something while the rest of the program works.

use std::io;
use std::sync::mpsc;
use std::thread;

/// Starts a thread, and returns when it runs.
///
/// A thread registers destructors when it begins, and the system's loader holds the lock for that as
/// long as it loads a library. A thread that began later would begin only after the library: never, if
/// the library does not come back.
///
/// # Errors
/// When the system gives no thread.
pub fn start(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let (tell, told) = mpsc::sync_channel(1);
    let work = move || {
        // The caller waits for it.
        let _ = tell.send(());
        work();
    };
    thread::Builder::new().name(name.to_owned()).spawn(work)?;
    told.recv().map_err(io::Error::other)
}
