//! A run that a signal ends, at some time: the result is the old or the new, and no draft stays.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

use super::whole::{FolderState, entries, left_behind, state_of};
use super::{Bench, tiny};
use crate::support::bench_with_plugins;
use crate::support::recipe::{SADDLE, with_table};

/// Sends a signal to a process that this test has started.
fn send(signal: i32, process: u32) {
    let sent = Command::new("kill")
        .args([format!("-{signal}"), process.to_string()])
        .stderr(Stdio::null())
        .status();
    // The process may have ended.
    let _ = sent.unwrap();
}

/// Whether programs that this test starts are to ignore a signal, as the test itself is: a script that
/// starts the tests in the background makes them ignore SIGINT.
fn is_ignored(signal: i32) -> bool {
    let kill = format!("kill -{signal} $$");
    let status = Command::new("sh").args(["-c", &kill]).status();
    status.unwrap().signal() != Some(signal)
}

/// Whether a run has begun its table.
fn has_begun(bench: &Bench) -> bool {
    let files = fs::read_dir(bench.path("out/.turnpath"))
        .into_iter()
        .flatten();
    let mut tables = files.flatten().map(|next| next.path().join("toolpath.csv"));
    tables.any(|table| table.exists())
}

#[test]
fn a_run_that_a_signal_ends_leaves_the_result_before_and_ends_by_that_signal() {
    let signals = [SIGINT, SIGTERM, SIGHUP].into_iter();
    for signal in signals.filter(|signal| !is_ignored(*signal)) {
        let bench = Bench::with(&tiny());
        bench.line("run recipe.toml -o out").ends(0);
        bench.write("long.toml", SADDLE);
        let before = state_of(&bench.path("out"));
        let mut command = bench.command(["run", "long.toml", "-o", "out", "--map", "../map.xyz"]);
        command.args(["--set", "sampler.step=0.5deg", "--set", "refine=false"]);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut run = command.spawn().unwrap();
        // It has begun to write.
        let start = Instant::now();
        while !has_begun(&bench) {
            assert!(start.elapsed() < Duration::from_secs(60), "no draft");
            assert_eq!(run.try_wait().unwrap(), None, "it has ended");
            thread::sleep(Duration::from_millis(1));
        }
        send(signal, run.id());
        let status = run.wait().unwrap();
        assert_eq!(status.signal(), Some(signal), "{status}");
        assert_eq!(state_of(&bench.path("out")), before, "{signal}");
        assert_eq!(left_behind(&bench.path("out")), Vec::<String>::new());
        assert_eq!(
            entries(&bench.path("")),
            ["long.toml", "out", "recipe.toml"]
        );
    }
}

#[test]
fn runs_that_a_signal_ends_at_any_time_leave_no_draft() {
    let bench = Bench::with(&tiny());
    let start = Instant::now();
    bench.line("run recipe.toml -o out").ends(0);
    let whole_run = start.elapsed();
    for part in 0..20 {
        let mut command = bench.command(["run", "recipe.toml", "-o", "out", "--set"]);
        command.arg(format!("spindle.speed={}rpm", 300 + part));
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut run = command.spawn().unwrap();
        thread::sleep(whole_run * part / 20);
        send(SIGTERM, run.id());
        let status = run.wait().unwrap();
        assert!(
            status.signal() == Some(SIGTERM) || status.code() == Some(0),
            "{status}"
        );
        let found = state_of(&bench.path("out"));
        assert!(matches!(found, FolderState::Result(_)), "{part}: {found:?}");
        assert_eq!(
            left_behind(&bench.path("out")),
            Vec::<String>::new(),
            "{part}"
        );
    }
}

/// As `nohup` starts it.
#[test]
fn a_signal_that_is_ignored_when_the_program_starts_does_not_end_it() {
    let bench = Bench::with(&tiny());
    let program = crate::support::bench::TURNPATH;
    let script = format!("trap '' HUP; {program:?} run recipe.toml -o out & kill -HUP $!; wait $!");
    let mut shell = bench.command_of("sh".as_ref(), ["-c", &script]);
    crate::support::bench::answer(&mut shell).ends(0);
    assert!(matches!(
        state_of(&bench.path("out")),
        FolderState::Result(_)
    ));
}

#[test]
fn a_plugin_that_never_answers_keeps_nobody_from_interrupting() {
    let recipe = with_table(&tiny(), "sampler", "use = \"never-answers\"");
    let bench = bench_with_plugins::bench(&recipe, &["ends-process"]);
    let before = bench.files();
    let mut command = bench.command(["run", "recipe.toml", "-o", "a/b", "--plugin-dir", "plugins"]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut run = command.spawn().unwrap();
    let start = Instant::now();
    while left_behind(&bench.path("a/b")).len() < 2 {
        assert!(start.elapsed() < Duration::from_secs(60), "no draft");
        assert_eq!(run.try_wait().unwrap(), None, "it has ended");
        thread::sleep(Duration::from_millis(1));
    }
    let signal = if is_ignored(SIGINT) { SIGTERM } else { SIGINT };
    send(signal, run.id());
    assert_eq!(run.wait().unwrap().signal(), Some(signal));
    assert_eq!(bench.files(), before);
    assert!(!bench.path("a").exists(), "a folder is left");
}
