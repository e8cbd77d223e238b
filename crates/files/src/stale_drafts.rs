//! Drafts beside their files that a killed process left behind.

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use crate::draft::{DRAFT_END, DRAFT_START};
use crate::operation::{Operation, perform};

/// Removes the drafts of single files in a folder that nobody has written to for so long. It is for a
/// folder of many writers, where a younger draft may be one in the making. What cannot be removed stays
/// for the next call: nobody reads it.
pub fn remove_stale_drafts(folder: &Path, age: Duration) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let oldest = SystemTime::now().checked_sub(age);
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_draft = name.starts_with(DRAFT_START) && name.ends_with(DRAFT_END);
        let written = entry.metadata().ok().filter(fs::Metadata::is_file);
        let written = written.and_then(|metadata| metadata.modified().ok());
        let is_stale = written.zip(oldest).is_some_and(|(at, oldest)| at < oldest);
        if is_draft && is_stale {
            let path = entry.path();
            let _ = perform(Operation::RemoveFile, &path, || fs::remove_file(&path));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_draft_goes_and_a_young_one_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        let hour = Duration::from_secs(3600);
        let make = |name: &str, age: Duration| {
            let file = fs::File::create(folder.path().join(name)).unwrap();
            file.set_modified(SystemTime::now() - age).unwrap();
        };
        make(".turnpath-old.part", 2 * hour);
        make(".turnpath-young.part", hour / 2);
        make("record.json", 2 * hour);
        make(".turnpath-old.other", 2 * hour);
        remove_stale_drafts(folder.path(), hour);
        let names = fs::read_dir(folder.path()).unwrap();
        let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        let left = [".turnpath-old.other", ".turnpath-young.part", "record.json"];
        assert_eq!(names, left);
    }
}
