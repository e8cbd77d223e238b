//! The folder in which a result is made.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::operation::{Operation, perform};
use crate::registry::{DraftKind, Registration};

/// What the names of such folders begin with.
const NEXT: &str = "next-";

/// A folder for the drafts of a result. It goes with all that is in it when this is dropped, and,
/// once it is empty, when a signal ends the process.
#[derive(Debug)]
pub struct Staging {
    path: PathBuf,
    /// None once the folder has become a commit.
    registration: Option<Registration>,
}

impl Staging {
    /// Makes the folder, and removes those of writers that did not end well: the folder is claimed, so
    /// none of them lives.
    pub fn new(hidden: &Path) -> io::Result<Self> {
        for entry in fs::read_dir(hidden)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(NEXT) {
                remove_all(&entry.path())?;
            }
        }
        let path = hidden.join(format!("{NEXT}{}", std::process::id()));
        perform(Operation::MakeFolder, &path, || fs::create_dir(&path))?;
        let registration = Some(Registration::new(DraftKind::Folder, &path));
        Ok(Self { path, registration })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the folder another name, under which it stays.
    pub fn rename(&mut self, to: &Path) -> io::Result<()> {
        perform(Operation::Rename, to, || fs::rename(&self.path, to))?;
        self.registration = None;
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if self.registration.is_some() {
            let _ = remove_all(&self.path);
        }
    }
}

fn remove_all(folder: &Path) -> io::Result<()> {
    perform(Operation::RemoveFolder, folder, || {
        fs::remove_dir_all(folder)
    })
}
