//! Whether a folder has a result: a summary, and all files that it lists, with their hashes.

use std::io;
use std::path::{Path, PathBuf};

use turnpath_files::{ListedFile, read_bounded_text};
use turnpath_host::sha256_hex;
use turnpath_recipe::Recipe;
use turnpath_report::{FormatError, ResultCheck, ResultFile, RunReport, from_json};

use crate::summary::{FolderSummary, MOST_BYTES, SUMMARY, folder_of, names_other_folders};

/// Why a folder has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultError {
    /// There is no summary that can be read.
    #[error("cannot read {}", path.display())]
    Summary {
        /// The summary.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// The summary is none, or not of this form.
    #[error("{} is no summary of this version", path.display())]
    Form {
        /// The summary.
        path: PathBuf,
        /// Why.
        #[source]
        error: FormatError,
    },
    /// The summary is older than lists of files, or was not written into a folder.
    #[error("{} does not list its files", path.display())]
    NoList {
        /// The summary.
        path: PathBuf,
    },
    /// The summary lists files of other folders.
    #[error("{} names files of other folders", path.display())]
    OtherFolders {
        /// The summary.
        path: PathBuf,
    },
    /// A file is not there, or has other bytes than the summary lists.
    #[error("{} is not as {SUMMARY} lists it", path.display())]
    File {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
}

/// The report of the result in a folder. All files that its summary lists are there, with the bytes
/// that it lists.
///
/// # Errors
/// When the folder has no result, or only a part of one.
pub fn read_result(folder: impl AsRef<Path>) -> Result<RunReport, ResultError> {
    let folder = folder.as_ref();
    let path = folder.join(SUMMARY);
    let text = match read_bounded_text(&path, MOST_BYTES) {
        Ok(text) => text,
        Err(error) => return Err(ResultError::Summary { path, error }),
    };
    let report: RunReport = match from_json(&text) {
        Ok(report) => report,
        Err(error) => return Err(ResultError::Form { path, error }),
    };
    let Some(files) = &report.files else {
        return Err(ResultError::NoList { path });
    };
    if names_other_folders(&report) {
        return Err(ResultError::OtherFolders { path });
    }
    for file in files {
        let path = folder.join(&file.file);
        match is_whole(folder, file) {
            Ok(true) => {}
            Ok(false) => return Err(ResultError::File { path }),
            Err(error) => return Err(ResultError::Unreadable { path, error }),
        }
    }
    Ok(report)
}

/// What the summary beside a file says of it, and of the parts that it calls; `None` where there is none that
/// lists it. A summary that cannot be read, or a result that is not finished, holds for no file.
pub fn result_check(file: &Path, parts: &[String], recipe: &Recipe) -> Option<ResultCheck> {
    let folder = folder_of(file);
    let unknown = |note: String| ResultCheck {
        summary: file.with_file_name(SUMMARY).display().to_string(),
        holds: false,
        notes: vec![note],
    };
    match FolderSummary::of(&folder) {
        FolderSummary::None => None,
        FolderSummary::Unfinished => Some(unknown(
            "the result here is not finished: some of its files lack their names, and there is no \
             summary; the next run into the folder gives them"
                .to_owned(),
        )),
        FolderSummary::Damaged(why) => Some(unknown(format!(
            "the summary is damaged, so nobody can say whether the file is whole: {why}"
        ))),
        FolderSummary::Read(report) => check_with(&report, &folder, (file, parts), recipe),
    }
}

fn check_with(
    report: &RunReport,
    folder: &Path,
    (file, parts): (&Path, &[String]),
    recipe: &Recipe,
) -> Option<ResultCheck> {
    let name = file.file_name()?.to_str()?;
    let files = report.files.as_ref()?;
    files.iter().find(|listed| listed.file == name)?;
    let is_own = |listed: &&ResultFile| listed.file == name || parts.contains(&listed.file);
    let (own, others): (Vec<&ResultFile>, Vec<&ResultFile>) = files.iter().partition(is_own);
    let changed = own
        .into_iter()
        .filter(|listed| !is_whole(folder, listed).unwrap_or(false));
    let mut notes: Vec<String> = changed.map(|listed| note_on_own(listed, name)).collect();
    let holds = notes.is_empty();
    notes.extend(
        others
            .into_iter()
            .filter_map(|listed| note_on(folder, listed)),
    );
    notes.extend(note_on_recipe(report, recipe));
    Some(ResultCheck {
        summary: file.with_file_name(SUMMARY).display().to_string(),
        holds,
        notes,
    })
}

/// What is wrong with the file itself, whose name is `name`, or with a part that it calls.
fn note_on_own(listed: &ResultFile, name: &str) -> String {
    match listed.file == name {
        true => "its bytes are not those that the run wrote: the file is not whole, or was changed"
            .to_owned(),
        false => format!(
            "the bytes of its part {} are not those that the run wrote: the part is not whole, or was changed",
            listed.file
        ),
    }
}

/// What is wrong with another file of the result.
fn note_on(folder: &Path, listed: &ResultFile) -> Option<String> {
    let name = &listed.file;
    match is_whole(folder, listed) {
        Ok(true) => None,
        Ok(false) if !folder.join(name).exists() => {
            Some(format!("note: {name} of the same result is not there"))
        }
        Ok(false) => Some(format!(
            "note: {name} of the same result has other bytes than listed"
        )),
        Err(error) => Some(format!(
            "note: {name} of the same result cannot be read: {error}"
        )),
    }
}

/// Whether the result was made from another recipe than the file is measured against.
fn note_on_recipe(report: &RunReport, recipe: &Recipe) -> Option<String> {
    let source = report.recipe.as_ref()?;
    let same =
        source.sha256 == sha256_hex(recipe.text().as_bytes()) && source.sets == recipe.sets();
    (!same).then(|| {
        let sets: String = source
            .sets
            .iter()
            .map(|set| format!(" --set {set:?}"))
            .collect();
        format!(
            "note: it was made from another recipe, or with other changes: {}{sets}",
            source.file
        )
    })
}

fn is_whole(folder: &Path, file: &ResultFile) -> io::Result<bool> {
    let ResultFile {
        file,
        bytes,
        sha256,
    } = file.clone();
    ListedFile {
        file,
        bytes,
        sha256,
    }
    .is_in(folder)
}
