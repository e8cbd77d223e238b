//! What reaches the terminal, what may be a pipe, and where nothing can be written.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs::{File, OpenOptions};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::bench::Bench;
use crate::support::bench_with_plugins;
use crate::support::fixtures::file_name;
use crate::support::recipe::{SADDLE, changed};

/// Nothing here takes longer, unless it waits for a pipe.
const LONGEST: Duration = Duration::from_secs(60);

/// The status of a call whose standard error takes nothing.
fn status_without_stderr(bench: &Bench, words: &str, stderr: Stdio) -> Option<i32> {
    let mut command = bench.command(words.split(' '));
    let status = command.stdout(Stdio::null()).stderr(stderr).status();
    status.unwrap().code()
}

#[test]
fn the_status_is_the_same_where_standard_error_takes_nothing() {
    let bench = Bench::with(SADDLE);
    bench.write("wrong.toml", "format = 1");
    let words = [
        "check recipe.toml",
        "check wrong.toml",
        "check none.toml",
        "list --plugin-dir none",
    ];
    for (words, status) in words.into_iter().zip([0, 2, 4, 2]) {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        assert_eq!(
            status_without_stderr(&bench, words, full.into()),
            Some(status),
            "{words}"
        );
        // A descriptor that is open for reading alone fails as a closed one does.
        let closed = File::open("/dev/null").unwrap();
        assert_eq!(
            status_without_stderr(&bench, words, closed.into()),
            Some(status),
            "{words}"
        );
    }
    let mut shell = bench.command_of("sh".as_ref(), ["-c", "\"$0\" check wrong.toml 2>&-"]);
    let status = shell.arg(crate::support::bench::TURNPATH).status();
    // Without a command line of its own the program would print its help.
    assert_eq!(status.unwrap().code(), Some(2));
}

#[test]
fn a_plugin_is_named_by_the_status_where_standard_error_takes_nothing() {
    let recipe = crate::support::recipe::saddle_with("sampler", "use = \"aborts\"");
    let bench = bench_with_plugins::bench(&recipe, &["ends-process"]);
    let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
    let words = "run recipe.toml -o out --plugin-dir plugins";
    assert_eq!(status_without_stderr(&bench, words, full.into()), Some(3));
}

#[test]
fn standard_output_that_takes_nothing_is_a_file_that_cannot_be_written() {
    let bench = Bench::with(SADDLE);
    for words in ["check recipe.toml", "sag recipe.toml --grid 9 -o -", "list"] {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = bench.command(words.split(' '));
        let output = command.stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(4), "{words}");
    }
}

/// ESC, BEL, a control character of C1, and a mark that turns the direction of writing.
const NAME: &str = "a\\u001B[2Jb\\u0007c\\u009B2Jd\\u202Ee";

#[test]
fn control_characters_of_a_recipe_are_shown_and_not_obeyed() {
    let recipe = changed(SADDLE, "\"Saddle\"", &format!("\"{NAME}\""));
    let recipe = changed(&recipe, "step = \"9 deg\"", "step = \"9\\u001B[2J deg\"");
    let bench = Bench::with(&recipe);
    let obeyed = |text: &str| {
        text.chars()
            .any(|c| (c.is_control() && c != '\n') || c == '\u{202e}')
    };
    let said = bench.line("check recipe.toml").ends(2);
    assert!(
        !obeyed(&said.stderr) && said.stderr.contains("\\u{1b}[2J"),
        "{said}"
    );
    let bench = Bench::with(&recipe.replacen("9\\u001B[2J deg", "9 deg", 1));
    for words in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(words).ends(0);
        assert!(!obeyed(&said.stdout), "{said}");
        let shown = "a\\u{1b}[2Jb\\u{7}c\\u{9b}2Jd\\u{202e}e\n";
        assert!(said.stdout.starts_with(shown), "{said}");
        let said = bench.line(&format!("{words} --format json")).ends(0);
        assert!(
            said.stdout.chars().all(|c| !c.is_control() || c == '\n'),
            "{said}"
        );
        assert_eq!(said.json()["name"], "a\u{1b}[2Jb\u{7}c\u{9b}2Jd\u{202e}e");
    }
}

#[test]
fn control_characters_in_the_names_of_files_are_shown_and_not_obeyed() {
    let bench = bench_with_plugins::bench(SADDLE, &["constant-arc", "ends-process"]);
    let odd = format!("lib\u{1b}[2J\n{}", file_name("constant-arc"));
    let plugins = bench.path("plugins");
    std::fs::rename(plugins.join(file_name("constant-arc")), plugins.join(&odd)).unwrap();
    let said = bench.line("list --plugin-dir plugins").ends(0);
    assert!(
        !said.stdout.contains('\u{1b}') && said.stdout.contains("lib\\u{1b}[2J\\n"),
        "{said}"
    );
    let said = bench.call(["check", "none\u{1b}[2J.toml"]).ends(4);
    assert!(!said.stderr.contains('\u{1b}'), "{said}");
    let said = bench.call(["run", "recipe.toml", "-o", "out\u{7}"]).ends(0);
    assert!(!said.stdout.contains('\u{7}'), "{said}");
}

/// A pipe that nobody writes to.
fn pipe(bench: &Bench, name: &str) {
    let status = Command::new("mkfifo").arg(bench.path(name)).status();
    assert!(status.unwrap().success());
}

#[test]
fn pipes_and_devices_are_refused_and_not_waited_for() {
    let bench = bench_with_plugins::bench(SADDLE, &[]);
    let listed = format!("plugins = [\"pipe.so\"]\n{SADDLE}");
    bench.write("lists.toml", listed);
    for name in ["pipe", "pipe.so", "pipe.csv", "pipe.pmc", "plugins/pipe.so"] {
        pipe(&bench, name);
    }
    for (words, status) in [
        ("check pipe", 4),
        ("check /dev/zero", 4),
        ("check plugins", 4),
        ("verify recipe.toml pipe.csv", 4),
        ("verify recipe.toml pipe.pmc", 4),
        ("verify recipe.toml /dev/zero", 4),
        ("list --plugin-dir pipe", 2),
        ("list --plugin-dir plugins", 2),
        ("list --plugins-lock pipe", 4),
        ("check lists.toml --trust-recipe", 2),
        ("sag recipe.toml --grid 9 -o pipe", 4),
        ("run recipe.toml -o pipe", 4),
        ("run recipe.toml -o out --map /dev/full", 2),
        ("run recipe.toml -o out --map pipe.xyz", 0),
    ] {
        let begun = Instant::now();
        let said = bench.line(words);
        assert!(begun.elapsed() < LONGEST, "{words}");
        assert_eq!(said.status, Some(status), "{words}: {said}");
        if status != 0 {
            assert!(said.stderr.starts_with("error: "), "{words}: {said}");
        }
    }
}

/// A pipe, and a file that is larger than the memory that the program may have.
#[test]
fn summaries_and_records_are_not_waited_for_and_not_read_beyond_reason() {
    let tiny = changed(SADDLE, "\"5 mm\"", "\"2 mm\"");
    let tiny = changed(&tiny, "\"100 nm\"", "\"20 um\"");
    let tiny = changed(&tiny, "\"100 nm\"", "\"20 um\"");
    let bench = Bench::with(&tiny);
    bench.line("run recipe.toml -o out").ends(0);
    let ablation = format!("{tiny}\n[ablation]\ntolerance.residual = [\"20 um\"]\n");
    bench.write("ablation.toml", ablation);
    bench.line("ablate ablation.toml -o abl").ends(0);
    let record = std::fs::read_dir(bench.path("abl/runs")).unwrap().next();
    let record = record.unwrap().unwrap().path();
    let record = record.strip_prefix(bench.path("")).unwrap().to_owned();
    for is_pipe in [true, false] {
        for name in [record.to_str().unwrap(), "out/summary.json"] {
            std::fs::remove_file(bench.path(name)).unwrap();
            match is_pipe {
                true => pipe(&bench, name),
                false => File::create(bench.path(name))
                    .and_then(|file| file.set_len(3 << 30))
                    .unwrap(),
            }
        }
        for (words, status) in [
            ("verify recipe.toml out/toolpath.csv", 1),
            ("ablate ablation.toml -o abl", 0),
        ] {
            let begun = Instant::now();
            let script = format!("ulimit -v 1500000; exec \"$0\" {words}");
            let mut shell = bench.command_of("sh".as_ref(), ["-c", &script]);
            let output = shell.arg(crate::support::bench::TURNPATH).output().unwrap();
            assert!(begun.elapsed() < LONGEST, "{words}");
            crate::support::bench::Answer::from(output).ends(status);
        }
        // What is no record cannot be replaced either; the next round begins with a new one.
        if bench
            .path(&record)
            .metadata()
            .is_ok_and(|found| !found.is_file())
        {
            std::fs::remove_file(bench.path(&record)).unwrap();
            bench.line("ablate ablation.toml -o abl").ends(0);
        }
    }
}

#[test]
fn a_huge_library_is_refused_by_its_size_before_it_is_read() {
    let bench = bench_with_plugins::bench(SADDLE, &[]);
    let file = File::create(bench.path("plugins").join(file_name("huge"))).unwrap();
    file.set_len(3 << 30).unwrap();
    // Address space for the program, and not for the library.
    let script = "ulimit -v 1500000; exec \"$0\" list --plugin-dir plugins";
    let mut shell = bench.command_of("sh".as_ref(), ["-c", script]);
    let output = shell.arg(crate::support::bench::TURNPATH).output().unwrap();
    let said = crate::support::bench::Answer::from(output).ends(3);
    assert!(
        said.stderr
            .contains("larger than a plugin may be (256 MiB)"),
        "{said}"
    );
}

#[test]
fn the_surface_goes_to_standard_output_as_to_a_file() {
    let bench = Bench::with(SADDLE);
    bench.line("sag recipe.toml --grid 9 -o sag.csv").ends(0);
    let said = bench.line("sag recipe.toml --grid 9 -o -").ends(0);
    assert_eq!(said.stdout, bench.read("sag.csv"));
    assert_eq!(said.stdout.lines().count(), 82);
    bench.line("sag recipe.toml --grid 9 -o ./-").ends(0);
    assert_eq!(bench.files(), ["-", "recipe.toml", "sag.csv"]);
}

#[test]
fn standard_output_that_has_a_report_is_refused_for_files() {
    let bench = Bench::with(SADDLE);
    for words in [
        "run recipe.toml -o -",
        "run recipe.toml -o out --map -",
        "verify recipe.toml a.csv -o -",
        "ablate recipe.toml -o -",
    ] {
        let said = bench.line(words).ends(2);
        assert!(
            said.stderr.contains("standard output has the report"),
            "{said}"
        );
    }
    assert_eq!(bench.files(), ["recipe.toml"]);
}
