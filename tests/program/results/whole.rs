//! Whether a folder has a whole result, by its files alone.

use std::fs;
use std::path::Path;

use serde_json::Value;
use turnpath_host::sha256_hex;

/// The page of a result, which no summary lists.
const PAGE: &str = "report.html";

/// What a folder has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FolderState {
    /// A whole result; the changes of its recipe say which.
    Result(String),
    /// No summary: nobody takes the files for a result.
    Nothing,
    /// A summary that does not fit the files beside it.
    Mixed(String),
}

/// What the folder has. Files that no summary lists make a result a mixed one.
pub fn state_of(folder: &Path) -> FolderState {
    let Ok(summary) = fs::read_to_string(folder.join("summary.json")) else {
        return FolderState::Nothing;
    };
    let summary: Value = match serde_json::from_str(&summary) {
        Ok(summary) => summary,
        Err(error) => return FolderState::Mixed(format!("the summary is damaged: {error}")),
    };
    let mut names = vec!["summary.json".to_owned()];
    for listed in summary["files"].as_array().into_iter().flatten() {
        let name = listed["file"].as_str().unwrap_or_default();
        let bytes = fs::read(folder.join(name)).unwrap_or_default();
        if listed["bytes"] != bytes.len() || listed["sha256"] != sha256_hex(&bytes) {
            return FolderState::Mixed(format!("{name} has other bytes than listed"));
        }
        names.push(name.to_owned());
    }
    if let Ok(page) = fs::read_to_string(folder.join(PAGE)) {
        if shown_by(&page) != Some(summary.clone()) {
            return FolderState::Mixed("the page shows another result".to_owned());
        }
        names.push(PAGE.to_owned());
    }
    let foreign = entries(folder).into_iter();
    let foreign = foreign.filter(|name| !names.contains(name) && !name.starts_with(".turnpath"));
    match foreign.collect::<Vec<_>>() {
        none if none.is_empty() => FolderState::Result(summary["recipe"]["sets"].to_string()),
        foreign => FolderState::Mixed(format!("{foreign:?} are not listed")),
    }
}

/// The summary that a page shows.
fn shown_by(page: &str) -> Option<Value> {
    let (_, after) = page.split_once("id=\"data\">")?;
    let (data, _) = after.split_once("</script>")?;
    let mut data: Value = serde_json::from_str(data).ok()?;
    Some(data["report"].take())
}

/// The names of what is directly in a folder, sorted; none if it is not there.
pub fn entries(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

/// The names in a folder that begin with that of the program's own files.
pub fn left_behind(folder: &Path) -> Vec<String> {
    let names = entries(folder).into_iter();
    names.filter(|name| name.starts_with(".turnpath")).collect()
}
