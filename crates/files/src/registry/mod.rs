//! The drafts that live: what must go when the process ends before its work.
//!
//! A draft is registered before it can be found on the disk for long, and withdrawn before it gets
//! its name. Whoever withdraws an entry owns it: either the work that registered it, or
//! [`remove_drafts`]. So a file that has got its name is never removed.

mod kind;
#[cfg(not(unix))]
mod list;
#[cfg(unix)]
mod slots;

use std::path::Path;

#[cfg(not(unix))]
use list as entries;
#[cfg(unix)]
use slots as entries;

pub use kind::DraftKind;

/// A path that [`remove_drafts`] removes as long as this lives.
#[derive(Debug)]
pub struct Registration(Option<entries::Entry>);

impl Registration {
    /// Registers a path. Where all places are taken the path stays unknown: then it is removed by
    /// the work that made it, or by the next writer, and not by a signal.
    pub fn new(kind: DraftKind, path: &Path) -> Self {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        Self(entries::Entry::new(kind, &path))
    }

    /// Takes the path back. False if [`remove_drafts`] was faster: then the path is gone, or about
    /// to go.
    #[must_use]
    pub fn withdraw(mut self) -> bool {
        self.0.take().is_none_or(entries::Entry::withdraw)
    }
}

impl Drop for Registration {
    fn drop(&mut self) {
        if let Some(entry) = self.0.take() {
            entry.withdraw();
        }
    }
}

/// Removes all drafts that live, the folders that were made for them, and the claims. For a process
/// that is about to end: each draft is then lost for the work that made it.
///
/// On Unix this may be called from a signal handler. It waits for no mutex, allocates nothing, and calls
/// `unlink` and `rmdir` alone; its frames take less than 2 KiB of the stack.
pub fn remove_drafts() {
    entries::remove_all(true);
}

/// The same without the claims, where a name may still be given: other writers stay away until the
/// process has ended.
pub fn remove_drafts_but_claims() {
    entries::remove_all(false);
}
