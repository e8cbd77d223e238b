//! Two runs into one folder at the same time.

use std::process::{Child, Command, Stdio};

use super::whole::{FolderState, left_behind, state_of};
use super::{Bench, tiny};

/// Begins a run with this speed into `out`.
fn begin(bench: &Bench, speed: &str) -> Child {
    let set = format!("spindle.speed={speed}");
    let mut command: Command = bench.command(["run", "recipe.toml", "-o", "out", "--set", &set]);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Runs so many pairs; gives how often one of a pair was refused.
fn run_pairs(count: usize) -> usize {
    let mut refused = 0;
    let mut bench = Bench::with(&tiny());
    for pair in 0..count {
        // Every other pair finds no folder; the others find a result of another pair.
        if pair % 2 == 0 {
            bench = Bench::with(&tiny());
        }
        let pair_of_runs = ["300rpm", "400rpm"].map(|speed| begin(&bench, speed));
        let statuses = pair_of_runs.map(|run| {
            let said = run.wait_with_output().unwrap();
            let status = said.status.code();
            let text = String::from_utf8_lossy(&said.stderr).into_owned();
            assert!(
                matches!(status, Some(0 | 4)),
                "pair {pair}: {status:?} {text}"
            );
            if status == Some(4) {
                assert!(text.contains("another run is writing into out"), "{text}");
            }
            status
        });
        assert!(statuses.contains(&Some(0)), "pair {pair}");
        refused += usize::from(statuses.contains(&Some(4)));
        let out = bench.path("out");
        let found = state_of(&out);
        assert!(
            matches!(found, FolderState::Result(_)),
            "pair {pair}: {found:?}"
        );
        assert_eq!(left_behind(&out), Vec::<String>::new(), "pair {pair}");
    }
    refused
}

#[test]
fn fifty_pairs_of_runs_leave_one_whole_result_each() {
    let refused = run_pairs(50);
    // Otherwise the pairs did not meet, and the test shows nothing.
    assert!(refused > 0, "no pair met");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_thousand_pairs_of_runs_leave_one_whole_result_each() {
    let refused = run_pairs(1000);
    println!("1,000 pairs: {refused} met, 0 mixed");
    assert!(refused > 0, "no pair met");
}
