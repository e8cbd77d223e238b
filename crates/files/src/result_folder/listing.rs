//! The files of a result, as its index lists them, and the plan of what a commit does.

use std::collections::BTreeSet;
use std::io;
use std::path::{Component, Path};

use serde::{Deserialize, Serialize};

use crate::bounded::read_bounded;
use crate::contents::Contents;

/// The most bytes of an index or of a plan that are read.
const MOST_BYTES: u64 = 1 << 26;
/// What the names of the writer's own files and folders begin with.
const OWN: &str = ".turnpath";

/// A file of a result.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ListedFile {
    /// Its name in the folder.
    pub file: String,
    /// The number of bytes.
    pub bytes: u64,
    /// Their SHA-256, in lower-case hexadecimal.
    pub sha256: String,
}

impl ListedFile {
    /// A file with these contents.
    pub fn new(file: &str, contents: &Contents) -> Self {
        Self {
            file: file.to_owned(),
            bytes: contents.bytes,
            sha256: contents.sha256.clone(),
        }
    }

    /// Whether a file of a result may have this name: it lies directly in the folder, and is not one of
    /// the writer's own.
    pub fn may_be(name: &str) -> bool {
        is_member(name)
    }

    /// Whether the file of this name in a folder has these bytes. False if it is not there.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn is_in(&self, folder: &Path) -> io::Result<bool> {
        let path = folder.join(&self.file);
        let same =
            |contents: Contents| contents.bytes == self.bytes && contents.sha256 == self.sha256;
        match std::fs::symlink_metadata(&path) {
            Ok(found) if !found.is_file() || found.len() != self.bytes => Ok(false),
            Ok(_) => Contents::of_file(&path).map(same),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }
}

/// The part of an index that says which files belong to the result.
#[derive(Debug, Default, Deserialize)]
struct Index {
    #[serde(default)]
    files: Vec<ListedFile>,
}

/// What remains to be done once a result is whole.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plan {
    /// The index: it goes first and comes last, so where it is, all files are.
    pub index: String,
    /// The other files of the result.
    pub files: Vec<String>,
    /// Files of the result before, which this one does not have.
    pub remove: Vec<ListedFile>,
}

impl Plan {
    /// The plan for these files in a folder that may have a result.
    ///
    /// # Errors
    /// When the index of that result cannot be read now: its files would stay for ever.
    pub fn new(folder: &Path, index: &str, files: &[&str]) -> io::Result<Self> {
        let kept: BTreeSet<&str> = files.iter().copied().chain([index]).collect();
        let remove = listed(&folder.join(index))?.into_iter();
        Ok(Self {
            index: index.to_owned(),
            files: files.iter().map(|file| (*file).to_owned()).collect(),
            remove: remove
                .filter(|old| is_member(&old.file) && !kept.contains(old.file.as_str()))
                .collect(),
        })
    }

    /// The plan in a file. The error is `InvalidData` if it is none, or names files of other folders.
    pub fn read(path: &Path) -> io::Result<Self> {
        let invalid = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        let bytes = read_bounded(path, MOST_BYTES)?;
        let plan: Self =
            serde_json::from_slice(&bytes).map_err(|error| invalid(error.to_string()))?;
        let fits = plan.names().all(is_member);
        match fits {
            true => Ok(plan),
            false => Err(invalid("it names files of other folders".to_owned())),
        }
    }

    /// All names in it.
    fn names(&self) -> impl Iterator<Item = &str> {
        let removed = self.remove.iter().map(|old| old.file.as_str());
        let files = self.files.iter().map(String::as_str);
        files.chain(removed).chain([self.index.as_str()])
    }

    /// The text of the plan's file.
    pub fn text(&self) -> io::Result<Vec<u8>> {
        Ok(serde_json::to_vec_pretty(self)?)
    }
}

/// Whether this is the name of a file directly in a folder, and not one of the writer's own.
pub fn is_member(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    let first = parts.next();
    let is_one = matches!(first, Some(Component::Normal(part)) if part == name);
    is_one && parts.next().is_none() && !name.starts_with(OWN)
}

/// The files that an index lists; none if it is not there, is no file that may be read, is damaged, or
/// is older than lists.
fn listed(index: &Path) -> io::Result<Vec<ListedFile>> {
    use io::ErrorKind::{InvalidData, IsADirectory, NotFound, PermissionDenied};
    let no_list = [InvalidData, IsADirectory, NotFound, PermissionDenied];
    match read_bounded(index, MOST_BYTES) {
        Ok(bytes) => Ok(serde_json::from_slice::<Index>(&bytes)
            .unwrap_or_default()
            .files),
        Err(error) if no_list.contains(&error.kind()) => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_names_are_members() {
        for name in ["toolpath.csv", "a b", "..a", "profile-0deg.csv"] {
            assert!(is_member(name), "{name}");
        }
        for name in [
            "",
            ".",
            "..",
            "a/b",
            "../a",
            "/a",
            "a/",
            ".turnpath",
            ".turnpath.lock",
        ] {
            assert!(!is_member(name), "{name}");
        }
    }

    #[test]
    fn a_plan_names_files_of_its_folder_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan");
        let read = |index: &str, file: &str, remove: &str| {
            let plan = Plan {
                index: index.to_owned(),
                files: vec![file.to_owned()],
                remove: vec![ListedFile {
                    file: remove.to_owned(),
                    bytes: 0,
                    sha256: String::new(),
                }],
            };
            std::fs::write(&path, plan.text().unwrap()).unwrap();
            Plan::read(&path).map_err(|error| error.kind())
        };
        assert!(read("a", "b", "c").is_ok());
        let other = "../../x";
        for (index, file, remove) in [(other, "b", "c"), ("a", other, "c"), ("a", "b", other)] {
            let refused = read(index, file, remove);
            assert_eq!(
                refused,
                Err(io::ErrorKind::InvalidData),
                "{index} {file} {remove}"
            );
        }
    }

    #[test]
    fn an_index_that_is_damaged_or_names_other_folders_removes_nothing_there() {
        let folder = tempfile::tempdir().unwrap();
        let index = folder.path().join("index.json");
        let removed = |text: &str| {
            std::fs::write(&index, text).unwrap();
            let plan = Plan::new(folder.path(), "index.json", &["kept"]);
            plan.unwrap().remove
        };
        assert_eq!(removed("{"), []);
        assert_eq!(removed("{}"), []);
        let file = |name: &str| format!("{{\"file\":{name:?},\"bytes\":1,\"sha256\":\"0\"}}");
        let names = [
            "../a",
            "/etc/passwd",
            "kept",
            "index.json",
            ".turnpath.lock",
            "old",
        ];
        let files = names.map(file).join(",");
        let found = removed(&format!("{{\"files\":[{files}]}}"));
        let names: Vec<&str> = found.iter().map(|old| old.file.as_str()).collect();
        assert_eq!(names, ["old"]);
    }

    /// A link to itself stands for a disk that fails: the file is there, and reading it fails.
    #[cfg(unix)]
    #[test]
    fn an_index_that_cannot_be_read_now_stops_the_plan() {
        let folder = tempfile::tempdir().unwrap();
        let plan = || Plan::new(folder.path(), "index.json", &["kept"]);
        assert!(plan().is_ok());
        std::os::unix::fs::symlink("index.json", folder.path().join("index.json")).unwrap();
        assert!(plan().is_err());
    }
}
