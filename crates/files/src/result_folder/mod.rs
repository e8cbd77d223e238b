//! A folder in which a result is whole or not there.
//!
//! No file system renames several files at once. So all files of a result are made in a folder of
//! their own, `.turnpath/next-*`. Renaming that folder to `.turnpath/commit` is the point from which
//! on the result is the new one; the files then get their names, and if that is not done to its end
//! the next writer does it. `docs/decisions/a-result-is-whole.md` has the reasons.

mod claim;
mod commit;
mod error;
mod listing;
mod made_folders;
mod own;
mod staging;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::draft::{Draft, WholeFile};
use crate::file_error::FileError;
use crate::gate;

use claim::FolderClaim;
use commit::{COMMIT, PLAN, sync_folder};
pub use error::FolderError;
pub use listing::ListedFile;
use listing::{Plan, is_member};
use made_folders::MadeFolders;
use staging::Staging;

/// The folder for what is not a result yet.
const HIDDEN: &str = ".turnpath";
/// What the names of drafts begin with that are not part of the result.
const PART: &str = ".turnpath.part-";

/// A folder that this process alone writes into, and the result that is made in it. Without a commit
/// the folder stays as it was: what was made is removed when this is dropped, when a signal ends the
/// process, or by the next writer.
#[derive(Debug)]
pub struct ResultFolder {
    folder: PathBuf,
    parts: AtomicU64,
    /// Files that go when the result gets its names, beside those that the index before lists.
    outdated: Vec<ListedFile>,
    /// Files that stay although the index before lists them.
    kept: Vec<String>,
    // Dropped in this order.
    staging: Staging,
    _hidden: MadeFolders,
    _claim: FolderClaim,
    _made: MadeFolders,
}

impl ResultFolder {
    /// Claims the folder, which is made if it is not there; gives a result that was whole before all
    /// its names; and removes what other writers left.
    ///
    /// # Errors
    /// When another writes into the folder, or when it takes no files.
    pub fn open(folder: &Path) -> Result<Self, FolderError> {
        let _gate = gate::enter();
        let mut made = MadeFolders::default();
        let claim = FolderClaim::take(folder, &mut made)?;
        let hidden_path = folder.join(HIDDEN);
        if own::folder_is_there(&hidden_path)? {
            own::folder_is_there(&hidden_path.join(COMMIT))?;
        }
        commit::complete(folder, &hidden_path).map_err(unfinished(folder))?;
        let mut hidden = MadeFolders::default();
        let begun = hidden.make_or_adopt(&hidden_path);
        let staging = begun.and_then(|()| Staging::new(&hidden_path));
        Ok(Self {
            folder: folder.to_owned(),
            parts: AtomicU64::new(0),
            outdated: Vec::new(),
            kept: Vec::new(),
            staging: staging.map_err(FileError::of(folder))?,
            _hidden: hidden,
            _claim: claim,
            _made: made,
        })
    }

    /// Whether a folder has a whole result whose files did not get their names: the next call of
    /// [`open`](Self::open) gives them.
    pub fn is_unfinished(folder: &Path) -> bool {
        let commit = folder.join(HIDDEN).join(COMMIT);
        fs::symlink_metadata(commit).is_ok_and(|found| found.is_dir())
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Checks that a file of the result may have this name.
    ///
    /// # Errors
    /// When the name belongs to a link, a folder or a device.
    pub fn can_have(folder: &Path, name: &str) -> Result<(), FolderError> {
        let path = folder.join(name);
        match fs::symlink_metadata(&path) {
            Ok(found) if found.is_symlink() => Err(FolderError::Link { path }),
            _ => Ok(Draft::can_be(&path)?),
        }
    }

    /// The name of a file of the result, if this is the path of one: a file directly in the folder.
    pub fn member(folder: &Path, path: &Path) -> Option<String> {
        let name = path.file_name()?.to_str()?;
        let above = path.parent()?;
        let same = above == folder
            || matches!(
                (fs::canonicalize(above), fs::canonicalize(folder)),
                (Ok(above), Ok(folder)) if above == folder
            );
        (same && is_member(name)).then(|| name.to_owned())
    }

    /// Begins a file. Directly in the folder it is part of the result; elsewhere it lies beside its
    /// place and gets its name right before the commit.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn draft(&self, path: &Path) -> Result<Draft, FileError> {
        match Self::member(&self.folder, path) {
            Some(name) => {
                let temporary = self.staging.path().join(&name);
                Draft::begin_as(temporary, path.to_owned(), Some(name))
            }
            None => Draft::begin(path),
        }
    }

    /// Begins a file that gets its name alone. It lies here until then, or beside its place where that
    /// is on another file system: no rename leads there.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn draft_alone(&self, path: &Path) -> Result<Draft, FileError> {
        let above = path.parent().unwrap_or(Path::new("."));
        if !own::same_file_system(self.staging.path(), above) {
            return Draft::begin(path);
        }
        let number = self.parts.fetch_add(1, Ordering::Relaxed);
        let temporary = self.staging.path().join(format!("{PART}{number}"));
        Draft::begin_as(temporary, path.to_owned(), None)
    }

    /// Lets a file of the folder that no index lists go when the result gets its names, if it still has these bytes.
    pub fn outdates(&mut self, file: ListedFile) {
        self.outdated.push(file);
    }

    /// Lets the file of this name stay, although the index before lists it: the new result was made from it.
    pub fn keeps(&mut self, file: String) {
        self.kept.push(file);
    }

    /// Makes the files the result of the folder; `index` is the one that lists them. What only the
    /// index before lists is removed.
    ///
    /// # Errors
    /// When a file cannot be written: then the folder has the result that it had. When a file of the
    /// whole new result cannot get its name: then the next writer gives it.
    pub fn commit(mut self, files: Vec<WholeFile>, index: WholeFile) -> Result<(), FolderError> {
        let (members, others): (Vec<_>, Vec<_>) =
            files.into_iter().partition(|file| file.member().is_some());
        let plan = self.plan(&members, &index)?;
        sync_folder(self.staging.path())?;
        for other in others {
            other.give_name()?;
        }
        let hidden = self.folder.join(HIDDEN);
        let _gate = gate::enter();
        // From here on a signal handler finds none of these files.
        for file in members.into_iter().chain([index, plan]) {
            let path = file.path().to_owned();
            if !file.release() {
                let error = io::Error::other("the process is ending");
                return Err(FileError { path, error }.into());
            }
        }
        let committed = self.staging.rename(&hidden.join(COMMIT));
        committed.map_err(FileError::of(&self.folder))?;
        let named = sync_folder(&hidden).and_then(|()| commit::complete(&self.folder, &hidden));
        named.map_err(unfinished(&self.folder))
    }

    /// What the commit will do, as a file beside the others.
    fn plan(&self, members: &[WholeFile], index: &WholeFile) -> Result<WholeFile, FileError> {
        let path = self.staging.path().join(PLAN);
        let names: Vec<&str> = members.iter().filter_map(WholeFile::member).collect();
        let index = index.member().unwrap_or_default();
        let plan = Plan::new(&self.folder, index, &names);
        let mut plan = plan.map_err(FileError::of(&self.folder.join(index)))?;
        plan.remove.retain(|old| !self.kept.contains(&old.file));
        plan.remove.extend(self.outdated.iter().cloned());
        let mut draft = Draft::begin_as(path.clone(), path.clone(), Some(PLAN.to_owned()))?;
        let written = plan.text().and_then(|text| draft.write_all(&text));
        written.map_err(FileError::of(&path))?;
        draft.finish()
    }
}

fn unfinished(folder: &Path) -> impl FnOnce(FileError) -> FolderError {
    let folder = folder.to_owned();
    |source| match source.path.ends_with(PLAN) && source.error.kind() == io::ErrorKind::InvalidData
    {
        true => FolderError::Plan { source },
        false => FolderError::Unfinished { folder, source },
    }
}

#[cfg(test)]
mod tests;
