//! What a folder has at each point of a commit, and what the next writer makes of it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;
use crate::Contents;

/// The names and texts of all that is in a folder.
fn found(folder: &Path) -> BTreeMap<String, String> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    entries
        .map(|entry| {
            let text = fs::read_to_string(entry.path()).unwrap_or_else(|_| "a folder".to_owned());
            (entry.file_name().into_string().unwrap(), text)
        })
        .collect()
}

fn draft(result: &ResultFolder, name: &str, text: &str) -> WholeFile {
    let mut draft = result.draft(&result.path().join(name)).unwrap();
    draft.write_all(text.as_bytes()).unwrap();
    draft.finish().unwrap()
}

/// Makes a result of these files and an index that lists them.
fn make(folder: &Path, files: &[(&str, &str)]) -> Result<(), FolderError> {
    let result = ResultFolder::open(folder)?;
    let files: Vec<WholeFile> = files
        .iter()
        .map(|(name, text)| draft(&result, name, text))
        .collect();
    let listed: Vec<ListedFile> = files
        .iter()
        .map(|file| ListedFile::new(file.member().unwrap(), file.contents()))
        .collect();
    let text = format!("{{\"files\":{}}}", serde_json::to_string(&listed).unwrap());
    let index = draft(&result, "index.json", &text);
    result.commit(files, index)
}

fn names(folder: &Path) -> Vec<String> {
    found(folder).into_keys().collect()
}

#[test]
fn a_second_result_removes_what_only_the_first_has_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let folder = &folder.path().join("a/b");
    make(folder, &[("table", "1"), ("old", "2"), ("edited", "3")]).unwrap();
    fs::write(folder.join("edited"), "4").unwrap();
    fs::write(folder.join("foreign"), "5").unwrap();
    make(folder, &[("table", "6"), ("new", "7")]).unwrap();
    assert_eq!(
        names(folder),
        ["edited", "foreign", "index.json", "new", "table"]
    );
    assert_eq!(found(folder)["table"], "6");
}

#[test]
fn a_result_that_is_given_up_leaves_nothing_not_even_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b");
    let result = ResultFolder::open(&deep).unwrap();
    let draft = result.draft(&deep.join("table")).unwrap();
    assert!(deep.join(".turnpath").is_dir() && draft.path().ends_with("table"));
    drop((draft, result));
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn a_folder_takes_one_writer_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let first = ResultFolder::open(folder.path()).unwrap();
    let second = ResultFolder::open(folder.path());
    assert!(
        matches!(second, Err(FolderError::OtherWriter { .. })),
        "{second:?}"
    );
    drop(first);
    make(folder.path(), &[]).unwrap();
    assert_eq!(names(folder.path()), ["index.json"]);
}

#[test]
fn what_a_killed_writer_left_goes_with_the_next() {
    let folder = tempfile::tempdir().unwrap();
    make(folder.path(), &[("table", "1")]).unwrap();
    let left = folder.path().join(".turnpath/next-0");
    fs::create_dir_all(&left).unwrap();
    fs::write(left.join("table"), "half").unwrap();
    fs::write(folder.path().join(".turnpath.lock"), "").unwrap();
    drop(ResultFolder::open(folder.path()).unwrap());
    assert_eq!(names(folder.path()), ["index.json", "table"]);
    assert_eq!(found(folder.path())["table"], "1");
}

/// A commit is interrupted after each of its steps by doing them by hand, in their order.
#[test]
fn a_commit_that_was_interrupted_anywhere_is_completed_by_the_next_writer() {
    let steps: [fn(&Path, &Path); 7] = [
        |_, _| {},
        |folder, _| fs::remove_file(folder.join("index.json")).unwrap(),
        |folder, commit| fs::rename(commit.join("table"), folder.join("table")).unwrap(),
        |folder, _| fs::remove_file(folder.join("old")).unwrap(),
        |folder, commit| fs::rename(commit.join("index.json"), folder.join("index.json")).unwrap(),
        |_, commit| fs::remove_file(commit.join(PLAN)).unwrap(),
        |_, commit| fs::remove_dir(commit).unwrap(),
    ];
    for last in 0..steps.len() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        make(folder, &[("table", "1"), ("old", "2")]).unwrap();
        let commit = folder.join(".turnpath/commit");
        fs::create_dir_all(&commit).unwrap();
        let plan = Plan::new(folder, "index.json", &["table"]).unwrap();
        fs::write(commit.join(PLAN), plan.text().unwrap()).unwrap();
        fs::write(commit.join("table"), "3").unwrap();
        fs::write(commit.join("index.json"), "{}").unwrap();
        for step in steps.iter().take(last + 1) {
            step(folder, &commit);
        }
        drop(ResultFolder::open(folder).unwrap());
        assert_eq!(names(folder), ["index.json", "table"], "step {last}");
        assert_eq!(found(folder)["table"], "3", "step {last}");
        assert_eq!(found(folder)["index.json"], "{}", "step {last}");
    }
}

#[test]
fn a_name_that_something_else_has_stops_a_commit_which_then_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make(folder, &[("table", "1")]).unwrap();
    fs::create_dir(folder.join("new")).unwrap();
    let error = make(folder, &[("table", "2"), ("new", "3")]).unwrap_err();
    assert!(matches!(error, FolderError::Unfinished { .. }), "{error}");
    assert!(error.help().unwrap().contains("next call"), "{error}");
    assert!(!folder.join("index.json").exists());
    let again = ResultFolder::open(folder).unwrap_err();
    assert!(matches!(again, FolderError::Unfinished { .. }), "{again}");
    fs::remove_dir(folder.join("new")).unwrap();
    drop(ResultFolder::open(folder).unwrap());
    assert_eq!(names(folder), ["index.json", "new", "table"]);
    assert_eq!(found(folder)["table"], "2");
}

#[test]
fn what_a_result_outdates_goes_with_its_names_and_no_earlier() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make(folder, &[("table", "1")]).unwrap();
    fs::write(folder.join("page"), "2").unwrap();
    let page = Contents::of_file(&folder.join("page")).unwrap();
    let begin = || {
        let mut result = ResultFolder::open(folder).unwrap();
        result.outdates(ListedFile::new("page", &page));
        result
    };
    drop(begin());
    assert_eq!(names(folder), ["index.json", "page", "table"]);
    let result = begin();
    let index = draft(&result, "index.json", "{}");
    result.commit(Vec::new(), index).unwrap();
    assert_eq!(names(folder), ["index.json"]);
    // With other bytes it is somebody else's.
    fs::write(folder.join("page"), "3").unwrap();
    let result = begin();
    let index = draft(&result, "index.json", "{}");
    result.commit(Vec::new(), index).unwrap();
    assert_eq!(names(folder), ["index.json", "page"]);
}

#[test]
fn a_file_elsewhere_gets_its_name_with_the_result_and_is_no_part_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let map = elsewhere.path().join("map");
    let result = ResultFolder::open(folder.path()).unwrap();
    let mut file = result.draft(&map).unwrap();
    file.write_all(b"1").unwrap();
    let file = file.finish().unwrap();
    assert!(file.member().is_none() && !map.exists());
    let index = draft(&result, "index.json", "{}");
    result.commit(vec![file], index).unwrap();
    assert_eq!(names(elsewhere.path()), ["map"]);
    assert_eq!(names(folder.path()), ["index.json"]);
}

/// The plan of somebody else names a file outside of the folder.
#[test]
fn a_plan_that_names_other_folders_removes_nothing_and_says_what_to_do() {
    let above = tempfile::tempdir().unwrap();
    let (folder, outside) = (above.path().join("out"), above.path().join("x"));
    make(&folder, &[("table", "1")]).unwrap();
    fs::write(&outside, "2").unwrap();
    let commit = folder.join(".turnpath/commit");
    fs::create_dir_all(&commit).unwrap();
    fs::write(commit.join("index.json"), "{}").unwrap();
    let mut plan = Plan::new(&folder, "index.json", &[]).unwrap();
    plan.remove = vec![ListedFile::new(
        "../x",
        &crate::Contents::of_file(&outside).unwrap(),
    )];
    fs::write(commit.join(PLAN), plan.text().unwrap()).unwrap();
    let error = ResultFolder::open(&folder).unwrap_err();
    assert!(matches!(error, FolderError::Plan { .. }), "{error}");
    assert!(error.help().unwrap().contains("`.turnpath/commit`"));
    assert_eq!(fs::read_to_string(&outside).unwrap(), "2");
    fs::remove_dir_all(&commit).unwrap();
    make(&folder, &[("table", "3")]).unwrap();
    assert_eq!(found(&folder)["table"], "3");
}

/// Most systems have the memory as a file system of its own here.
#[cfg(target_os = "linux")]
#[test]
fn a_file_alone_gets_its_name_on_another_file_system_too() {
    use std::os::unix::fs::MetadataExt;
    let folder = tempfile::tempdir().unwrap();
    let Ok(memory) = tempfile::tempdir_in("/dev/shm") else {
        return;
    };
    let device = |path: &Path| fs::metadata(path).unwrap().dev();
    let result = ResultFolder::open(folder.path()).unwrap();
    for (place, lies_here) in [
        (
            memory.path(),
            device(memory.path()) == device(folder.path()),
        ),
        (folder.path(), true),
    ] {
        let file = place.join("record");
        let mut draft = result.draft_alone(&file).unwrap();
        draft.write_all(b"1").unwrap();
        assert_eq!(draft.folder() == result.staging.path(), lies_here);
        draft.complete().unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "1");
    }
    drop(result);
    assert_eq!(names(memory.path()), ["record"]);
}

#[cfg(unix)]
#[test]
fn what_lies_behind_a_link_is_not_the_writers_own() {
    use std::os::unix::fs::symlink;
    let above = tempfile::tempdir().unwrap();
    let (folder, other) = (above.path().join("out"), above.path().join("other"));
    for name in [".turnpath", ".turnpath.lock", ".turnpath/commit"] {
        fs::create_dir_all(other.join("next-1")).unwrap();
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(other.join("file"), "1").unwrap();
        let behind = match name {
            ".turnpath.lock" => other.join("file"),
            _ => other.clone(),
        };
        symlink(behind, folder.join(name)).unwrap();
        let error = ResultFolder::open(&folder).unwrap_err();
        let FolderError::Foreign { path } = &error else {
            panic!("{name}: {error}");
        };
        assert_eq!(path, &folder.join(name));
        assert!(error.help().is_some());
        assert_eq!(names(&other), ["file", "next-1"], "{name}");
        fs::remove_dir_all(&folder).unwrap();
    }
    // A link that leads nowhere is one too.
    fs::create_dir(&folder).unwrap();
    symlink(above.path().join("none"), folder.join(".turnpath.lock")).unwrap();
    let error = ResultFolder::open(&folder).unwrap_err();
    assert!(matches!(error, FolderError::Foreign { .. }), "{error}");
    assert!(!above.path().join("none").exists());
}

/// Everybody may read everything as root: then there is nothing to try.
#[cfg(unix)]
#[test]
fn a_file_before_that_nobody_may_read_stays() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make(folder, &[("table", "1"), ("old", "2")]).unwrap();
    let old = folder.join("old");
    fs::set_permissions(&old, fs::Permissions::from_mode(0o000)).unwrap();
    let is_root = fs::read(&old).is_ok();
    make(folder, &[("table", "3")]).unwrap();
    assert_eq!(found(folder)["table"], "3");
    assert_eq!(old.exists(), !is_root);
}

#[cfg(unix)]
#[test]
fn a_link_is_no_file_of_a_result_but_the_folder_may_be_one() {
    let folder = tempfile::tempdir().unwrap();
    let (real, link) = (folder.path().join("real"), folder.path().join("link"));
    fs::create_dir(&real).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    make(&link, &[("table", "1")]).unwrap();
    assert_eq!(names(&real), ["index.json", "table"]);
    assert_eq!(ResultFolder::member(&link, &real.join("x")).unwrap(), "x");
    std::os::unix::fs::symlink("table", real.join("other")).unwrap();
    let error = ResultFolder::can_have(&real, "other").unwrap_err();
    assert!(matches!(error, FolderError::Link { .. }), "{error}");
    ResultFolder::can_have(&real, "table").unwrap();
}
