//! The operations on files, one by one: a test may count them, make one fail, or end the process
//! before it.

use std::io;
use std::path::Path;
use std::sync::OnceLock;

/// An operation that changes files, or that a result depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operation {
    /// A folder is made.
    MakeFolder,
    /// A folder is claimed.
    Claim,
    /// A file is created.
    Create,
    /// Bytes are written.
    Write,
    /// A file or a folder is brought to the disk.
    Sync,
    /// A file is opened and read back.
    Read,
    /// A file or a folder gets another name.
    Rename,
    /// A file is removed.
    RemoveFile,
    /// A folder is removed.
    RemoveFolder,
}

type Watcher = dyn Fn(Operation, &Path) -> io::Result<()> + Send + Sync;

static WATCHER: OnceLock<Box<Watcher>> = OnceLock::new();

/// Calls `watcher` before each operation of this process; an error of it takes the place of the
/// operation's own. For tests of what happens when an operation fails. False if there is a watcher
/// already.
#[doc(hidden)]
pub fn watch_operations(
    watcher: impl Fn(Operation, &Path) -> io::Result<()> + Send + Sync + 'static,
) -> bool {
    WATCHER.set(Box::new(watcher)).is_ok()
}

/// Announces an operation that repeats itself when it is interrupted.
pub fn announce(operation: Operation, path: &Path) -> io::Result<()> {
    WATCHER
        .get()
        .map_or(Ok(()), |watcher| watcher(operation, path))
}

/// Announces an operation and does it, again when a signal interrupts it.
pub fn perform<T>(
    operation: Operation,
    path: &Path,
    mut act: impl FnMut() -> io::Result<T>,
) -> io::Result<T> {
    uninterrupted(|| announce(operation, path).and_then(|()| act()))
}

/// Does this, and does it again when a signal interrupts it.
pub fn uninterrupted<T>(mut act: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    loop {
        match act() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            done => return done,
        }
    }
}
