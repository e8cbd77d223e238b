//! Calls of the system that fail, from outside of the program: nothing depends on the counting of the
//! file layer.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};

use super::before::{After, Before, RUN};
use super::whole::{FolderState, state_of};
use crate::support::bench::TURNPATH;

/// The calls that change files, and those that a result depends on.
const CALLS: [&str; 11] = [
    "openat",
    "write",
    "fsync",
    "rename",
    "renameat2",
    "unlink",
    "unlinkat",
    "mkdir",
    "rmdir",
    "flock",
    "lseek",
];
/// What happens to a call, in the words of strace.
const FAULTS: [&str; 3] = ["error=ENOSPC", "error=EIO", "signal=SIGKILL"];
/// More calls than any thread of a run makes.
const MOST: usize = 1000;

fn has_strace() -> bool {
    let version = Command::new("strace")
        .arg("-V")
        .stdout(Stdio::null())
        .status();
    version.is_ok_and(|status| status.success())
}

/// Spoils the n-th call of this name. `None` if no thread of the run makes so many.
fn spoil_call(
    before: &Before,
    new: &FolderState,
    call: &str,
    fault: &str,
    n: usize,
) -> Option<After> {
    let bench = before.copy();
    let inject = format!("inject={call}:{fault}:when={n}");
    let trace = format!("trace={call}");
    let mut words = vec![
        "-f", "-qq", "-o", "trace", "-e", &trace, "-e", &inject, TURNPATH,
    ];
    words.extend(RUN.split_whitespace());
    let mut command = bench.command_of("strace".as_ref(), words);
    let status = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .unwrap();
    let trace = fs::read_to_string(bench.path("trace")).unwrap();
    let was_tried = trace.contains("(INJECTED)") || trace.contains("killed by SIGKILL");
    if !was_tried {
        assert_eq!(status.code(), Some(0), "{inject}: {status}");
        return None;
    }
    let out = bench.path("out");
    if status.code() == Some(0) {
        assert_eq!(state_of(&out), *new, "{inject}");
    }
    Some(before.settle(&out, new, &inject))
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_calls_of_the_system_that_fail_leave_a_whole_result() {
    if !has_strace() {
        println!("skipped: strace is not installed");
        return;
    }
    let before = Before::make();
    let clean = before.copy();
    clean.line(RUN).ends(0);
    let new = state_of(&clean.path("out"));
    let mut table: BTreeMap<(&str, &str), BTreeMap<After, usize>> = BTreeMap::new();
    for call in CALLS {
        for fault in FAULTS {
            let after = (1..MOST).map_while(|n| spoil_call(&before, &new, call, fault, n));
            for after in after {
                *table
                    .entry((call, fault))
                    .or_default()
                    .entry(after)
                    .or_default() += 1;
            }
        }
    }
    let tried: usize = table.values().flat_map(BTreeMap::values).sum();
    println!("{tried} calls spoilt, 0 mixed: {table:#?}");
    for call in ["openat", "write", "fsync", "rename"] {
        assert!(
            table.contains_key(&(call, "error=EIO")),
            "{call} was not tried"
        );
    }
}
