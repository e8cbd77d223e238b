//! Plugins that end the process, never answer, or print: exit status 3 and the strategy's name, or an
//! unspoilt answer.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::{Answer, Bench, answer};
use crate::support::bench_with_plugins::{bench, refused, refused_call};
use crate::support::fixtures::file_name;
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};

const FIXTURE: &str = "ends-process";

fn bench_with(sampler: &str) -> Bench {
    bench(
        &saddle_with("sampler", &format!("use = \"{sampler}\"")),
        &[FIXTURE],
    )
}

/// The sampler ends the process; the message names it, its library, and what it did.
#[track_caller]
fn ends(sampler: &str, what: &str) {
    let said = refused(&bench_with(sampler)).stderr;
    let name = format!("error: the sampler `{sampler}` of {FIXTURE}");
    assert!(said.starts_with(&name), "{said}");
    assert!(said.contains(&file_name(FIXTURE)), "{said}");
    assert!(said.trim_end().ends_with(what), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn one_that_calls_exit() {
    ends("exits", "it called exit");
}

#[test]
fn one_that_calls_exit_on_a_thread_of_its_own() {
    ends(
        "exits-elsewhere",
        " may have, on a thread of its own, ended the program: it called exit",
    );
}

#[test]
fn one_that_calls_abort() {
    ends("aborts", "it called abort (SIGABRT)");
}

#[test]
fn one_that_calls_abort_when_it_is_made() {
    ends("aborts-in-constructor", "it called abort (SIGABRT)");
}

#[test]
fn one_whose_stack_overflows() {
    ends("overflows", "or its stack overflowed (SIGSEGV)");
}

#[test]
fn one_whose_stack_overflows_on_a_worker_and_not_on_the_first_thread() {
    let bench = bench_with("overflows");
    for threads in ["1", "4"] {
        let said = refused_call(
            &bench,
            &format!("run recipe.toml -o out --plugin-dir plugins --threads {threads}"),
        );
        assert!(said.stderr.contains("SIGSEGV"), "{said}");
    }
}

#[test]
fn one_that_writes_to_no_memory() {
    ends("writes-to-null", "or its stack overflowed (SIGSEGV)");
}

#[test]
fn a_surface_that_others_call_is_named_and_not_its_callers() {
    let bench = bench(
        &saddle_with("surface", "use = \"aborting-surface\""),
        &[FIXTURE],
    );
    let said = refused(&bench);
    let name = "error: the surface model `aborting-surface` of ends-process";
    assert!(said.stderr.starts_with(name), "{said}");
}

#[test]
fn one_that_never_answers_ends_with_the_limit() {
    let bench = bench_with("never-answers");
    let words = "run recipe.toml -o out --plugin-dir plugins --plugin-time-limit";
    let begun = std::time::Instant::now();
    let mut call: Vec<&str> = words.split(' ').collect();
    call.push("300 ms");
    let said = bench.call(&call).ends(3);
    assert!(begun.elapsed().as_secs() < 60);
    let name = "the sampler `never-answers` of ends-process";
    assert!(
        said.stderr.contains(name) && said.stderr.contains("within 0.3 s"),
        "{said}"
    );
    assert!(!bench.path("out").exists() && bench.scratch_is_empty());
    assert_eq!(said.stdout, "");
}

#[test]
fn a_limit_that_is_no_time_is_refused() {
    for limit in ["0 s", "5", "2 mm"] {
        let call = ["list", "--plugin-time-limit", limit];
        let said = Bench::empty().call(call).ends(2);
        assert!(said.stderr.contains("--plugin-time-limit"), "{said}");
    }
    Bench::empty().line("list --plugin-time-limit none").ends(0);
}

/// Its lines would break the JSON, and the half line would begin it.
#[test]
fn one_that_prints_spoils_no_answer() {
    let bench = bench_with("prints");
    for command in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench
            .line(&format!("{command} --plugin-dir plugins --format json"))
            .ends(0);
        assert_eq!(said.json()["name"], "Saddle");
    }
    let said = bench
        .line("run recipe.toml -o out --plugin-dir plugins --format json")
        .ends(0);
    assert!(said.stderr.contains("{ \"placing\": true"), "{said}");
    assert_eq!(said.stdout, bench.read("out/summary.json"));
}

#[test]
fn one_that_aborts_while_the_path_is_written_over_another_leaves_the_other() {
    let bench = bench(SADDLE, &[FIXTURE]);
    bench.line("run recipe.toml -o out").ends(0);
    let (files, path) = (bench.files(), bench.read("out/toolpath.csv"));
    for sampler in ["aborts", "exits", "overflows"] {
        bench.write(
            "recipe.toml",
            saddle_with("sampler", &format!("use = \"{sampler}\"")),
        );
        bench
            .line("run recipe.toml -o out --plugin-dir plugins")
            .ends(3);
        assert_eq!(bench.files(), files);
        assert_eq!(bench.read("out/toolpath.csv"), path);
    }
}

/// Nothing is in progress when somebody else sends the signal, or a plugin that did nothing is.
#[test]
fn a_signal_from_outside_blames_no_plugin() {
    use std::os::unix::process::ExitStatusExt;
    let bench = bench_with("never-answers");
    let mut child = bench
        .command(["run", "recipe.toml", "-o", "out", "--plugin-dir", "plugins"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(2));
    let kill = std::process::Command::new("kill")
        .args(["-ABRT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let end = child.wait().unwrap();
    let mut said = String::new();
    std::io::Read::read_to_string(child.stderr.as_mut().unwrap(), &mut said).unwrap();
    assert_eq!((end.signal(), said.as_str()), (Some(6), ""));
}

#[test]
fn commands_without_a_path_name_it_too() {
    let recipe = with_table(SADDLE, "surface", "use = \"aborting-surface\"");
    let recipe = changed(&recipe, "Saddle", "Flat");
    let bench = bench(&recipe, &[FIXTURE]);
    for command in ["check recipe.toml", "sag recipe.toml --grid 9 -o sag.csv"] {
        let said = refused_call(&bench, &format!("{command} --plugin-dir plugins"));
        assert!(said.stderr.contains("`aborting-surface`"), "{said}");
    }
}

/// A call with a library whose initialiser does this.
fn with_initialiser(act: &str, words: &[&str]) -> Answer {
    let bench = bench(SADDLE, &["constant-arc", "acts-when-loaded"]);
    let call = ["list", "surface", "--plugin-dir", "plugins"];
    let mut command = bench.command(call.iter().chain(words));
    let said = answer(command.env("TURNPATH_TEST_INITIALISER", act));
    assert!(bench.scratch_is_empty(), "{said}");
    said
}

#[test]
fn a_library_that_ends_the_process_while_it_is_loaded_is_named_and_no_other() {
    for (act, how) in [("abort", "(SIGABRT)"), ("exit", "(it calls exit)")] {
        let said = with_initialiser(act, &[]).ends(3);
        let message = format!("loading it ends the process {how}");
        assert!(said.stderr.contains(&message), "{said}");
        assert!(
            said.stderr.contains(&file_name("acts-when-loaded")),
            "{said}"
        );
        assert!(!said.stderr.contains(&file_name("constant-arc")), "{said}");
    }
}

#[test]
fn a_library_that_ends_the_process_badly_at_its_end_is_named_before_any_work() {
    let said = with_initialiser("abort-at-end", &[]).ends(3);
    let message = "a process that has loaded it does not end well (SIGABRT)";
    assert!(said.stderr.contains(message), "{said}");
    assert!(
        said.stderr.contains(&file_name("acts-when-loaded")),
        "{said}"
    );
    assert!(!said.stderr.contains(&file_name("constant-arc")), "{said}");
}

/// As if somebody, or a system without memory, had ended the child.
#[test]
fn a_signal_to_the_child_accuses_no_library() {
    for act in ["term-in-trial", "kill-in-trial"] {
        let said = with_initialiser(act, &[]).ends(0);
        assert!(said.stdout.contains("flat-when-loaded"), "{said}");
        let note = "the plugins are not tried before (somebody ended the process";
        assert!(said.stderr.contains(note), "{said}");
    }
}

/// The child waits in the library's initialiser when its parent is killed.
#[test]
fn a_child_whose_parent_is_gone_ends_and_leaves_nothing() {
    for signal in ["-KILL", "-TERM"] {
        let bench = bench(SADDLE, &["acts-when-loaded"]);
        let started = bench.path("started");
        let mut command = bench.command(["list", "surface", "--plugin-dir", "plugins"]);
        command.env("TURNPATH_TEST_INITIALISER", "wait");
        command.env("TURNPATH_TEST_STARTED", &started);
        let mut parent = command.spawn().unwrap();
        let until = |done: &dyn Fn() -> bool| {
            let begun = std::time::Instant::now();
            while !done() {
                assert!(
                    begun.elapsed().as_secs() < 20,
                    "{signal}: {:?}",
                    bench.files()
                );
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
        };
        until(&|| started.exists());
        assert!(!bench.scratch_is_empty());
        let kill = std::process::Command::new("kill")
            .args([signal, &parent.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        parent.wait().unwrap();
        until(&|| bench.scratch_is_empty());
    }
}

#[test]
fn a_library_that_does_not_come_back_while_it_is_loaded_is_named() {
    let said = with_initialiser("wait", &["--plugin-time-limit", "1 s"]).ends(3);
    let message = "loading it does not end within 1 s";
    assert!(said.stderr.contains(message), "{said}");
    assert!(
        said.stderr.contains(&file_name("acts-when-loaded")),
        "{said}"
    );
}

#[test]
fn what_a_library_prints_while_it_is_loaded_spoils_no_answer() {
    let said = with_initialiser("print", &[]).ends(0);
    assert!(said.stdout.contains("flat-when-loaded") && !said.stdout.contains("loaded\":"));
    assert_eq!(said.stderr, "{ \"loaded\": true\n");
}
