//! A result is whole or not there: whatever fails, whoever writes beside, and whenever a run ends.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

#[cfg(unix)]
mod before;
#[cfg(unix)]
mod faults;
mod pairs;
#[cfg(unix)]
mod signals;
#[cfg(target_os = "linux")]
mod strace;
mod whole;

use std::fs;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};
use serde_json::Value;
use turnpath_files::ResultFolder;
use whole::{FolderState, entries, left_behind, state_of};

/// A part of 2 mm in 20 turns of 12 points, with all tolerances held: milliseconds of work.
fn tiny() -> String {
    let recipe = changed(SADDLE, "\"5 mm\"", "\"2 mm\"");
    let recipe = changed(&recipe, "\"100 nm\"", "\"20 um\"");
    let recipe = changed(&recipe, "\"100 nm\"", "\"20 um\"");
    let recipe = changed(&recipe, "step = \"9 deg\"", "step = \"30 deg\"");
    let feed = "use = \"constant\"\nfeed = \"50 um/rev\"";
    let recipe = changed(&recipe, "use = \"constant\"", feed);
    format!("{recipe}\n[output]\nposts = [\"pmac-pvt\"]\n")
}

#[test]
fn the_summary_lists_the_files_with_their_hashes_and_says_what_was_run() {
    let bench = Bench::with(&tiny());
    bench
        .line("run recipe.toml -o out --profile 0deg --set spindle.speed=\"400rpm\"")
        .ends(0);
    let out = bench.path("out");
    let names = [
        "profile-0deg-spectrum.csv",
        "profile-0deg.csv",
        "recipe.pmc",
        "report.html",
        "summary.json",
        "toolpath.csv",
    ];
    assert_eq!(entries(&out), names);
    let sets = "[\"spindle.speed=\\\"400rpm\\\"\"]";
    assert_eq!(state_of(&out), FolderState::Result(sets.to_owned()));
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["files"].as_array().unwrap().len(), 4);
    assert_eq!(summary["recipe"]["file"], "recipe.toml");
    let sha256 = turnpath_host::sha256_hex(tiny().as_bytes());
    assert_eq!(summary["recipe"]["sha256"], sha256);
}

#[test]
fn the_same_recipe_gives_the_same_summary_in_another_folder() {
    let bench = Bench::with(&tiny());
    fs::create_dir(bench.path("b")).unwrap();
    fs::copy(bench.path("recipe.toml"), bench.path("b/recipe.toml")).unwrap();
    bench.line("run recipe.toml -o out").ends(0);
    bench.line("run b/recipe.toml -o b/out").ends(0);
    let summary = bench.read("out/summary.json");
    assert_eq!(summary, bench.read("b/out/summary.json"));
}

#[test]
fn a_second_run_removes_what_only_the_first_made() {
    let bench = Bench::with(&tiny());
    let out = bench.path("out");
    bench.line("run recipe.toml -o out --circle 0.5mm").ends(0);
    fs::write(out.join("notes.txt"), "of the user").unwrap();
    bench
        .line("run recipe.toml -o out --set output.posts=[]")
        .ends(0);
    let left = ["notes.txt", "report.html", "summary.json", "toolpath.csv"];
    assert_eq!(entries(&out), left);
}

/// The file's bytes are the user's now.
#[test]
fn a_program_that_was_changed_by_hand_is_not_removed() {
    let bench = Bench::with(&tiny());
    bench.line("run recipe.toml -o out").ends(0);
    bench.write("out/recipe.pmc", "mine");
    bench
        .line("run recipe.toml -o out --set output.posts=[]")
        .ends(0);
    assert_eq!(bench.read("out/recipe.pmc"), "mine");
}

#[test]
fn a_folder_that_another_run_has_is_refused_at_once() {
    let bench = Bench::with(&tiny());
    let out = bench.path("out");
    bench.line("run recipe.toml -o out").ends(0);
    let before = state_of(&out);
    let held = ResultFolder::open(&out).unwrap();
    for command in ["run recipe.toml -o out", "ablate ablation.toml -o out"] {
        bench.write(
            "ablation.toml",
            format!("{}\n[ablation]\ntolerance.residual = [\"20 um\"]\n", tiny()),
        );
        let said = bench.line(command).ends(4);
        let title = "error: another run is writing into out\n";
        assert!(said.stderr.starts_with(title), "{said}");
        let help = "help: wait until it ends, or choose another folder with `-o`";
        assert!(said.stderr.contains(help), "{said}");
        assert_eq!(state_of(&out), before);
    }
    drop(held);
    assert_eq!(left_behind(&out), Vec::<String>::new());
    bench.line("run recipe.toml -o out").ends(0);
}

#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_a_file_is_refused_before_the_work() {
    let bench = Bench::with(&tiny());
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("machine.csv", "before");
    std::os::unix::fs::symlink("../machine.csv", bench.path("out/toolpath.csv")).unwrap();
    let said = bench.line("run recipe.toml -o out").ends(4);
    assert!(
        said.stderr.contains("out/toolpath.csv: it is a link"),
        "{said}"
    );
    assert_eq!(bench.read("machine.csv"), "before");
    assert_eq!(entries(&bench.path("out")), ["toolpath.csv"]);
    std::os::unix::fs::symlink("out", bench.path("link")).unwrap();
    fs::remove_file(bench.path("out/toolpath.csv")).unwrap();
    bench.line("run recipe.toml -o link").ends(0);
    assert!(matches!(
        state_of(&bench.path("out")),
        FolderState::Result(_)
    ));
}

/// A shell with a limit of 300 blocks on files: the table of the saddle is larger.
#[cfg(unix)]
#[test]
fn a_run_that_exceeds_the_limit_on_files_leaves_the_result_before() {
    for trap in ["trap '' XFSZ; ", ""] {
        let bench = Bench::with(SADDLE);
        bench
            .line("run recipe.toml -o out --set sampler.step=20deg --set refine=false")
            .ends(1);
        let before = state_of(&bench.path("out"));
        assert!(matches!(before, FolderState::Result(_)), "{before:?}");
        let program = crate::support::bench::TURNPATH;
        let script = format!("{trap}ulimit -f 300; {program:?} run recipe.toml -o out");
        let mut shell = bench.command_of("sh".as_ref(), ["-c", &script]);
        let said = crate::support::bench::answer(&mut shell).ends(4);
        assert!(said.stderr.contains("cannot write"), "{said}");
        assert_eq!(state_of(&bench.path("out")), before);
        assert_eq!(left_behind(&bench.path("out")), Vec::<String>::new());
    }
}

#[test]
fn verify_compares_a_file_with_the_summary_beside_it() {
    let bench = Bench::with(&tiny());
    bench.line("run recipe.toml -o out").ends(0);
    let verify = |file: &str| bench.line(&format!("verify recipe.toml {file} --format json"));
    for file in ["out/toolpath.csv", "out/recipe.pmc"] {
        let report = verify(file).json();
        assert_eq!(report["result"]["holds"], true, "{report}");
        assert_eq!(report["result"]["summary"], "out/summary.json");
        assert_eq!(report["result"]["notes"], Value::Array(Vec::new()));
        assert_eq!(report["within"]["result"], true);
    }
    let table = bench.read("out/toolpath.csv");
    // A time with one more zero at its end plays the same path.
    let spoilt = table.replacen("0.0,0.0,", "0.00,0.0,", 1);
    assert_ne!(spoilt, table);
    bench.write("out/toolpath.csv", &spoilt);
    let said = verify("out/toolpath.csv").ends(1).json();
    assert_eq!(said["result"]["holds"], false);
    let text = bench.line("verify recipe.toml out/toolpath.csv").ends(1);
    assert!(
        text.stdout.contains("NOT AS out/summary.json lists it"),
        "{text}"
    );
    let beside = verify("out/recipe.pmc").json();
    assert_eq!(beside["result"]["holds"], true);
    let note = "note: toolpath.csv of the same result has other bytes than listed";
    assert_eq!(beside["result"]["notes"][0], note);
    // Elsewhere there is no summary that says anything.
    bench.write("toolpath.csv", &spoilt);
    assert_eq!(verify("toolpath.csv").ends(0).json()["result"], Value::Null);
    let text = bench.line("verify recipe.toml toolpath.csv").ends(0);
    assert!(
        text.stdout.contains("no summary beside it lists it"),
        "{text}"
    );
}

/// The result check of the table, which holds not.
#[track_caller]
fn not_as_listed(bench: &Bench) -> Value {
    let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
    let said = said.ends(1).json();
    assert_eq!(said["within"]["result"], false);
    said["result"].clone()
}

#[test]
fn verify_takes_no_damaged_summary_and_no_unfinished_result() {
    let bench = Bench::with(&tiny());
    bench.line("run recipe.toml -o out").ends(0);
    let whole = bench.read("out/summary.json");
    let outside = whole.replace("\"recipe.pmc\"", "\"../\\u001brecipe.toml\"");
    assert_ne!(outside, whole);
    for (text, why) in [
        (&whole[..whole.len() / 2], "it is not the JSON"),
        ("", "it is not the JSON"),
        (&outside, "names files of other folders"),
    ] {
        bench.write("out/summary.json", text);
        let check = not_as_listed(&bench);
        assert!(check["notes"][0].as_str().unwrap().contains(why), "{check}");
        let error = turnpath::read_result(bench.path("out"));
        assert!(error.is_err(), "{text}");
    }
    // An older version's summary, or another program's, says nothing.
    bench.write("out/summary.json", "{\"title\": \"mine\"}");
    let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
    assert_eq!(said.ends(0).json()["result"], Value::Null);
    fs::remove_file(bench.path("out/summary.json")).unwrap();
    fs::create_dir_all(bench.path("out/.turnpath/commit")).unwrap();
    let check = not_as_listed(&bench);
    let note = check["notes"][0].as_str().unwrap();
    assert!(
        note.starts_with("the result here is not finished"),
        "{note}"
    );
}

#[test]
fn a_summary_acts_on_no_terminal() {
    let bench = Bench::with(&tiny());
    bench.line("run recipe.toml -o out").ends(0);
    let whole = bench.read("out/summary.json");
    let odd = whole.replace("\"recipe.pmc\"", "\"a\\u001b[2J\\nb\"");
    let odd = odd.replacen("\"recipe.toml\"", "\"c\\u009b2Jd\"", 1);
    bench.write("out/summary.json", odd);
    let said = bench.line("verify recipe.toml out/toolpath.csv --set spindle.speed=499rpm");
    let obeyed = |c: char| c.is_control() && c != '\n';
    assert!(!said.stdout.contains(obeyed), "{said}");
    let note = "note: a\\u{1b}[2J\\nb of the same result is not there";
    assert!(said.stdout.contains(note), "{said}");
}

#[test]
fn verify_says_that_a_result_was_made_from_another_recipe() {
    let bench = Bench::with(&tiny());
    bench.line("run recipe.toml -o out").ends(0);
    let said = bench.line("verify recipe.toml out/toolpath.csv --set clearance=\"2 mm\"");
    let said = match said.status {
        Some(2) => bench.line("verify recipe.toml out/toolpath.csv --set spindle.speed=499rpm"),
        _ => said,
    };
    let note = "note: it was made from another recipe, or with other changes: recipe.toml";
    assert!(said.stdout.contains(note), "{said}");
}

#[test]
fn names_that_differ_have_folders_that_differ() {
    let mut folders = Vec::new();
    for name in ["a/b", "a\\nb", "a-b", "a b", "a%2Fb", ".a", "-a", "con"] {
        let bench = Bench::with(&changed(&tiny(), "\"Saddle\"", &format!("\"{name}\"")));
        bench.line("run recipe.toml").ends(0);
        let [folder] = &entries(&bench.path("out"))[..] else {
            panic!("one folder: {:?}", bench.files());
        };
        assert!(!folder.contains(char::is_control), "{folder:?}");
        folders.push(folder.clone());
    }
    let mut distinct = folders.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), folders.len(), "{folders:?}");
}
