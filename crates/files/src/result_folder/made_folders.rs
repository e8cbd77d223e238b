//! Folders that were made for a result, and go with it if it fails.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::operation::{Operation, perform};
use crate::registry::{DraftKind, Registration};

/// Folders that did not exist before, from the outside in. Those that are empty go when this is
/// dropped, and when a signal ends the process.
#[derive(Debug, Default)]
pub struct MadeFolders(Vec<(PathBuf, Registration)>);

impl MadeFolders {
    /// Makes a folder and what is missing above it.
    pub fn make(&mut self, folder: &Path) -> io::Result<()> {
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        if let Some(above) = folder.parent() {
            self.make(above)?;
        }
        match perform(Operation::MakeFolder, folder, || fs::create_dir(folder)) {
            Ok(()) => {
                self.push(folder);
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && folder.is_dir() => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// The same for a folder of the writer's own: one that a writer left which was killed goes too.
    /// A link is no such folder.
    pub fn make_or_adopt(&mut self, folder: &Path) -> io::Result<()> {
        let real = fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir());
        match real {
            true => {
                self.push(folder);
                Ok(())
            }
            false => self.make(folder),
        }
    }

    fn push(&mut self, folder: &Path) {
        let registration = Registration::new(DraftKind::Folder, folder);
        self.0.push((folder.to_owned(), registration));
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for (folder, registration) in self.0.drain(..).rev() {
            // It stays where something has come into it, the result itself among it.
            let _ = perform(Operation::RemoveFolder, &folder, || fs::remove_dir(&folder));
            // The registration ends last: whenever a signal comes, somebody removes the folder.
            drop(registration);
        }
    }
}
