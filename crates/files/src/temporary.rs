//! A file that goes unless it is released.

use std::fs;
use std::path::{Path, PathBuf};

use crate::operation::{Operation, perform};
use crate::registry::{DraftKind, Registration};

/// A file under a temporary name. It is removed when this is dropped, and when a signal ends the
/// process.
#[derive(Debug)]
pub struct Temporary {
    path: PathBuf,
    registration: Option<Registration>,
}

impl Temporary {
    /// A file that was created just now.
    pub fn new(path: PathBuf) -> Self {
        let registration = Some(Registration::new(DraftKind::File, &path));
        Self { path, registration }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Lets the file stay. False if a signal has removed it.
    #[must_use]
    pub fn release(mut self) -> bool {
        self.registration.take().is_none_or(Registration::withdraw)
    }
}

impl Drop for Temporary {
    /// The registration ends last: whenever a signal comes, somebody removes the file.
    fn drop(&mut self) {
        if self.registration.is_some() {
            // Nobody hears of it: the work has failed already, and says why.
            let _ = perform(Operation::RemoveFile, &self.path, || {
                fs::remove_file(&self.path)
            });
        }
    }
}
