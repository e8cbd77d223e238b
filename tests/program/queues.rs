//! An ablation by a queue: planned, made run by run, and merged.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;
use std::process::{Child, Command};

use serde_json::Value;

use crate::support::bench::{Bench, TURNPATH};
use crate::support::recipe::SADDLE;
use crate::support::repository;

/// Three runs, the last of which gouges.
const LISTS: &str = "
[ablation]
mode = \"one-at-a-time\"
velocity = [{ use = \"three-point\" }]
tool.nose_radius = [\"20 mm\"]
";

fn bench() -> Bench {
    Bench::with(&format!("{SADDLE}{LISTS}"))
}

fn plan(bench: &Bench, folder: &str) -> Vec<(String, String)> {
    let said = bench
        .line(&format!("ablate recipe.toml --plan -o {folder}"))
        .ends(0);
    let plan: Value = serde_json::from_str(&said.stdout).unwrap();
    let text = |run: &Value, key: &str| run[key].as_str().unwrap().to_owned();
    let runs = plan["runs"].as_array().unwrap().iter();
    runs.map(|run| (text(run, "key"), text(run, "state")))
        .collect()
}

fn states(bench: &Bench, folder: &str) -> Vec<String> {
    let runs = plan(bench, folder).into_iter();
    runs.map(|(_, state)| state).collect()
}

/// `ablation.json` without the times, which differ from call to call.
fn table(bench: &Bench, folder: &str) -> Value {
    let text = bench.read(format!("{folder}/ablation.json"));
    let mut table: Value = serde_json::from_str(&text).unwrap();
    for run in table["runs"].as_array_mut().unwrap() {
        for key in ["planning_time_s", "measuring_time_s"] {
            run.as_object_mut().unwrap().remove(key);
        }
    }
    table
}

#[test]
fn runs_that_are_made_alone_give_the_table_of_one_call() {
    let bench = bench();
    bench.line("ablate recipe.toml -o whole").ends(0);
    let runs = plan(&bench, "parts");
    assert!(!bench.path("parts").exists(), "a plan writes nothing");
    assert_eq!(states(&bench, "parts"), ["missing"; 3]);
    // All at once: nothing is locked.
    let start = |(key, _): &(String, String)| {
        let words = [
            "ablate",
            "recipe.toml",
            "-o",
            "parts",
            "--quiet",
            "--only",
            key,
        ];
        bench.command(words).spawn().unwrap()
    };
    let started: Vec<Child> = runs.iter().map(start).collect();
    let ended = started
        .into_iter()
        .map(|mut child| child.wait().unwrap().code());
    assert_eq!(ended.collect::<Vec<_>>(), [Some(0), Some(0), Some(2)]);
    assert_eq!(states(&bench, "parts"), ["done", "done", "failed"]);
    // The one that failed is a row with its reason, and counts.
    let said = bench.line("ablate recipe.toml -o parts --merge").ends(1);
    assert!(said.stdout.contains("would gouge"), "{said}");
    assert_eq!(table(&bench, "parts"), table(&bench, "whole"));
    let missing = bench
        .line("ablate recipe.toml --plan=open -o parts")
        .ends(0);
    assert_eq!(missing.stdout, format!("{}\n", runs[2].0));
}

#[test]
fn a_run_that_was_lost_is_a_row_and_can_be_made_again() {
    let bench = bench();
    bench.line("ablate recipe.toml -o out").ends(0);
    let (key, _) = &plan(&bench, "out")[1];
    fs::remove_file(bench.path(format!("out/runs/{key}.json"))).unwrap();
    let said = bench.line("ablate recipe.toml -o out --merge").ends(1);
    assert!(said.stdout.contains("not made yet"), "{said}");
    bench
        .line(&format!("ablate recipe.toml -o out --only {key}"))
        .ends(0);
    assert_eq!(states(&bench, "out")[..2], ["done", "done"]);
}

#[test]
fn a_key_that_no_run_has_is_refused() {
    let said = bench().line("ablate recipe.toml --only 12ab").ends(2);
    assert!(said.stderr.contains("--plan"), "{said}");
}

/// Runs a script of docs/queues in the bench's folder, with the tests' program first on the path. Names
/// have what a shell would take apart.
fn by_script(script: &str) {
    let bench = bench();
    bench
        .line("ablate recipe.toml -o whole --set refine=true")
        .ends(0);
    fs::rename(bench.path("recipe.toml"), bench.path("a part;$x.toml")).unwrap();
    let program = Path::new(TURNPATH).parent().unwrap();
    let path = std::env::var("PATH").unwrap();
    let ended = Command::new(repository().join("docs/queues").join(script))
        .args(["a part;$x.toml", "its parts", "--set", "refine=true"])
        .current_dir(bench.path("."))
        .env("PATH", format!("{}:{path}", program.display()))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(1), "one run gouges: {said}");
    assert_eq!(table(&bench, "its parts"), table(&bench, "whole"));
}

/// A worker that is killed in the middle of a run leaves it begun, and the next one makes it.
#[cfg(unix)]
#[test]
fn a_run_whose_worker_is_killed_is_not_done_and_is_made_again() {
    let bench = bench();
    let key = plan(&bench, "out")[0].0.clone();
    let finer = ["--set", "tolerance.residual=1 nm"];
    let planned = bench.call(
        ["ablate", "recipe.toml", "-o", "out", "--plan=open"]
            .iter()
            .chain(&finer),
    );
    let slow = planned.ends(0).stdout.lines().next().unwrap().to_owned();
    assert_ne!(slow, key, "another value has another key");
    let call = [
        "ablate",
        "recipe.toml",
        "-o",
        "out",
        "--quiet",
        "--only",
        &slow,
    ];
    let mut worker = bench.command(call.iter().chain(&finer)).spawn().unwrap();
    let record = bench.path(format!("out/runs/{slow}.json"));
    while !record.exists() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    worker.kill().unwrap();
    worker.wait().unwrap();
    let plan_again = ["ablate", "recipe.toml", "-o", "out", "--plan"];
    let said = bench.call(plan_again.iter().chain(&finer)).ends(0).json();
    assert_eq!(said["runs"][0]["state"], "begun", "{said}");
    let merge = ["ablate", "recipe.toml", "-o", "out", "--merge"];
    let merged = bench.call(merge.iter().chain(&finer)).ends(1);
    assert!(
        merged.stdout.contains("it was begun and has not ended"),
        "{merged}"
    );
    bench.call(call.iter().chain(&finer)).ends(0);
    let said = bench.call(plan_again.iter().chain(&finer)).ends(0).json();
    assert_eq!(said["runs"][0]["state"], "done", "{said}");
}

#[test]
#[ignore = "needs GNU parallel; `cargo xtask long` runs it where it is installed"]
fn long_queue_gnu_parallel_makes_the_table() {
    by_script("parallel.sh");
}

#[test]
#[ignore = "needs HyperQueue; `cargo xtask long` runs it where it is installed"]
fn long_queue_hyperqueue_makes_the_table() {
    by_script("hyperqueue.sh");
}

#[test]
#[ignore = "needs dask.distributed; `cargo xtask long` runs it where it is installed"]
fn long_queue_dask_makes_the_table() {
    by_script("dask_queue.py");
}

#[test]
#[ignore = "needs Slurm; `cargo xtask long` runs it where it is installed"]
fn long_queue_slurm_makes_the_table() {
    by_script("slurm.sh");
}
