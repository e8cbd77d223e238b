//! The summary in a folder, which may be anything: it is read up to a limit, and judged.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use turnpath_files::{Contents, FileError, ListedFile, ResultFolder, read_bounded_text};
use turnpath_page::is_page;
use turnpath_report::{FormatError, RunReport, from_json};

/// The report of a run, which lists its files.
pub const SUMMARY: &str = "summary.json";
/// The runs of an ablation.
pub const ABLATION: &str = "ablation.json";
/// The page of a run or of an ablation. No summary lists it: it can be made from the result again.
pub const PAGE: &str = "report.html";
/// So many bytes of a page show who made it.
const PAGE_MARK_BYTES: u64 = 256;
/// The most bytes of a summary or a record that are read: far more than any has.
pub const MOST_BYTES: u64 = 1 << 26;

/// What a folder has for a summary.
pub enum FolderSummary {
    /// None, or that of another version.
    None,
    /// None, since a whole result did not get its names.
    Unfinished,
    /// One that cannot be read, or is no summary: why.
    Damaged(String),
    /// That of a run.
    Read(Box<RunReport>),
}

impl FolderSummary {
    /// The summary in a folder.
    pub fn of(folder: &Path) -> Self {
        let text = match read_bounded_text(&folder.join(SUMMARY), MOST_BYTES) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return match ResultFolder::is_unfinished(folder) {
                    true => Self::Unfinished,
                    false => Self::None,
                };
            }
            Err(error) => return Self::Damaged(error.to_string()),
        };
        match from_json::<RunReport>(&text) {
            Ok(report) if names_other_folders(&report) => {
                Self::Damaged("it names files of other folders".to_owned())
            }
            Ok(report) => Self::Read(Box::new(report)),
            Err(FormatError::OtherForm { .. }) => Self::None,
            Err(error) => Self::Damaged(error.to_string()),
        }
    }
}

/// The page that turnpath made in a folder; `None` if there is none, or one that is somebody else's, or a link.
pub fn own_page(folder: &Path) -> Result<Option<ListedFile>, FileError> {
    let path = folder.join(PAGE);
    if path.is_symlink() {
        return Ok(None);
    }
    let mut beginning = Vec::new();
    let read =
        File::open(&path).and_then(|file| file.take(PAGE_MARK_BYTES).read_to_end(&mut beginning));
    match read {
        Ok(_) if is_page(&beginning) => {
            let contents = Contents::of_file(&path).map_err(FileError::of(&path))?;
            Ok(Some(ListedFile::new(PAGE, &contents)))
        }
        _ => Ok(None),
    }
}

/// Whether a summary lists what is no file directly in its folder.
pub fn names_other_folders(report: &RunReport) -> bool {
    let mut files = report.files.iter().flatten();
    !files.all(|file| ListedFile::may_be(&file.file))
}

/// Whether the summary of a folder lists this file.
pub fn lists(report: &RunReport, folder: &Path, file: &Path) -> bool {
    let Some(name) = ResultFolder::member(folder, file) else {
        return false;
    };
    report
        .files
        .iter()
        .flatten()
        .any(|listed| listed.file == name)
}

/// The folder of a file.
pub fn folder_of(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}
