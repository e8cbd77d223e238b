//! `cargo xtask long`: every check that `.ci/run` leaves out.

use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{cargo, command, repository, run, succeeds, target};
use crate::python::{script, with_packages, with_packages_of};
use crate::step::{Outcome, Step};
use crate::{browser, deny, fuzz, latex, msrv, python_package};

/// How many cases each test on random input tries; `.cargo/config.toml` has the number of `.ci/run`.
/// A larger `PROPTEST_CASES` in the environment counts.
const RANDOM_CASES: u32 = 256;

/// How the names of tests begin that need a queue.
const QUEUES: &str = "long_queue_";

/// The interpreter for which Debian builds LinuxCNC's module `gcode`.
const SYSTEM_PYTHON: &str = "/usr/bin/python3";
/// How long random recipes are measured, s: a sample of them, some seconds each.
const MEASURING_S: &str = "300";

/// A check that `.ci/run` leaves out.
struct Check {
    name: &'static str,
    what: &'static str,
    run: Run,
}

/// How a check runs.
enum Run {
    /// In one step.
    Step(fn() -> Outcome),
    /// In steps of its own.
    Steps(fn() -> Vec<Step>),
}

const CHECKS: &[Check] = &[
    Check {
        name: "tests",
        what: "the tests above",
        run: Run::Step(ignored),
    },
    Check {
        name: "random-input",
        what: "the tests of the crates once more, with eight times as many cases",
        run: Run::Step(random_input),
    },
    Check {
        name: "playback",
        what: "tests/reference/playback/selftest.py, the independent measurement on closed forms",
        run: Run::Step(playback),
    },
    Check {
        name: "random-recipes",
        what: "tests/reference/playback/measure_random.py, those of the test of five hundred",
        run: Run::Step(|| with_packages(&["numba", "numpy"], random_recipes)),
    },
    Check {
        name: "maps",
        what: "tests/reference/maps/check_maps.py, maps of the machined surface by an independent reader",
        run: Run::Step(|| with_packages(&["numpy", "gsffile"], maps)),
    },
    Check {
        name: "correction",
        what: "tests/reference/grids/correction.py, a part that is corrected by its own measured error",
        run: Run::Step(|| with_packages(&["numpy"], correction)),
    },
    Check {
        name: "linuxcnc",
        what: "tests/reference/programs/linuxcnc.py, a program as LinuxCNC's own interpreter reads it",
        run: Run::Step(|| with_packages_of(SYSTEM_PYTHON, &["gcode"], linuxcnc)),
    },
    Check {
        name: "columns",
        what: "tests/reference/data/columns.py, columns of a path by pyarrow and numpy",
        run: Run::Step(|| with_packages(&["numpy", "pyarrow"], columns)),
    },
    Check {
        name: "report",
        what: "tests/reference/report/report.cjs, pages in Chromium by playwright-core",
        run: Run::Step(|| browser::report(program)),
    },
    Check {
        name: "schema",
        what: "tests/reference/schema/schema.py, the schema of recipes by taplo",
        run: Run::Step(schema),
    },
    Check {
        name: "dry-runs",
        what: "tests/reference/programs/dry_run.py, dry runs by an independent reader",
        run: Run::Step(dry_runs),
    },
    Check {
        name: "programs",
        what: "tests/reference/programs/siemens_840d.py and beckhoff_poly.py, independent evaluations of polynomials",
        run: Run::Step(|| with_packages(&[], programs)),
    },
    Check {
        name: "book",
        what: "`mdbook build docs`, the pages as a book, and tests/reference/book/links.py, its links and its search",
        run: Run::Step(|| with_packages(&[], book)),
    },
    Check {
        name: "tables",
        what: "the tables of the ablations as LaTeX, by pdflatex with booktabs",
        run: Run::Step(|| latex::tables(program)),
    },
    Check {
        name: "queues",
        what: "the scripts of docs/queues by GNU parallel, HyperQueue, dask.distributed and Slurm",
        run: Run::Steps(queues),
    },
    Check {
        name: "fuzz",
        what: "`cargo xtask fuzz`, a minute for each target",
        run: Run::Steps(|| fuzz::run_targets(&[])),
    },
    Check {
        name: "msrv",
        what: "`cargo xtask msrv`",
        run: Run::Steps(msrv::run_checks),
    },
    Check {
        name: "deny",
        what: "`cargo xtask deny`",
        run: Run::Steps(deny::run_checks),
    },
    Check {
        name: "python",
        what: "`cargo xtask python`, the wheel of the Python package in an empty environment",
        run: Run::Steps(python_package::run_checks),
    },
];

/// What the checks do, a line each.
pub fn list() -> String {
    let tests = ignored_tests().into_iter();
    let tests = tests.map(|name| format!("test: {name}"));
    let checks = CHECKS.iter();
    let checks = checks.map(|check| format!("{}: {}", check.name, check.what));
    tests.chain(checks).collect::<Vec<_>>().join("\n")
}

/// Runs the checks of these names, or all of them.
pub fn run_named(names: &[&str]) -> Result<Vec<Step>, String> {
    let is_known = |name: &str| CHECKS.iter().any(|check| check.name == name);
    if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
        let known: Vec<&str> = CHECKS.iter().map(|check| check.name).collect();
        return Err(format!("no check `{unknown}`: {}", known.join(", ")));
    }
    let chosen = CHECKS.iter();
    let chosen = chosen.filter(|check| names.is_empty() || names.contains(&check.name));
    let steps = chosen.map(|check| match check.run {
        Run::Step(run) => vec![Step::run(check.name, run)],
        Run::Steps(run) => run(),
    });
    Ok(steps.flatten().collect())
}

fn playback() -> Outcome {
    with_packages(&["numpy"], || {
        run(script("tests/reference/playback/selftest.py", &[]))
    })
}

fn ignored() -> Outcome {
    if ignored_tests().is_empty() {
        return Outcome::Passed;
    }
    let words = [
        "test",
        "--locked",
        "--workspace",
        "--release",
        "--tests",
        // One suite that fails leaves the others to be run.
        "--no-fail-fast",
    ];
    let mut tests = cargo(&words);
    tests.args(["--", "--ignored", "--skip", QUEUES]);
    run(tests)
}

/// The scripts of docs/queues, each where its queue is there.
fn queues() -> Vec<Step> {
    let there = |program: &str, words: &[&str]| succeeds(command(program, words));
    let queues = [
        ("gnu_parallel", there("parallel", &["--version"])),
        ("hyperqueue", there("hq", &["server", "info"])),
        ("dask", there("python3", &["-c", "import dask.distributed"])),
        ("slurm", there("sinfo", &["--noheader"])),
    ];
    let step = |(name, is_there): (&str, bool)| {
        Step::run(format!("queue {name}"), || match is_there {
            true => run(cargo(&[
                "test",
                "--locked",
                "--release",
                "-p",
                "turnpath-cli",
                "--test",
                "program",
                "--",
                "--ignored",
                &format!("{QUEUES}{name}"),
            ])),
            false => Outcome::Skipped("it is not installed, or its server does not run".to_owned()),
        })
    };
    queues.into_iter().map(step).collect()
}

/// The libraries' tests and those that a crate has in `tests/all`.
fn random_input() -> Outcome {
    // A test of the plugin crate loads the example that is a plugin, and `--lib` leaves examples out.
    let plugin = ["-p", "turnpath-plugin", "--example", "constant_arc"];
    let mut example = cargo(&["build", "--locked", "--release"]);
    example.args(plugin);
    let built = run(example);
    if !matches!(built, Outcome::Passed) {
        return built;
    }
    let words = [
        "test",
        "--locked",
        "--workspace",
        "--release",
        "--no-fail-fast",
    ];
    let mut tests = cargo(&words);
    let cases = std::env::var("PROPTEST_CASES").ok();
    let cases = cases.and_then(|cases| cases.parse().ok()).unwrap_or(0);
    tests
        .args(["--lib", "--test", "all"])
        .env("PROPTEST_CASES", RANDOM_CASES.max(cases).to_string());
    run(tests)
}

/// The kept output of LinuxCNC's interpreter is what it says of the program that turnpath writes.
fn linuxcnc() -> Outcome {
    let folder = "tests/reference/programs";
    let [script, program, kept] =
        ["linuxcnc.py", "saddle.ngc", "linuxcnc.csv"].map(|file| format!("{folder}/{file}"));
    run(command(SYSTEM_PYTHON, &[&script, &program, &kept]))
}

/// A run of the saddle with these changes, into a folder of the target folder.
fn saddle(folder: &str, changes: &[&str]) -> Result<PathBuf, Outcome> {
    let folder = target().join("long").join(folder);
    let mut turnpath = std::process::Command::new(program()?);
    turnpath
        .current_dir(repository())
        .args(["run", "tests/reference/programs/saddle.toml"])
        .args(changes)
        .arg("-o")
        .arg(&folder);
    match run(turnpath) {
        Outcome::Passed => Ok(folder),
        failed => Err(failed),
    }
}

/// toolpath.parquet and toolpath.npz, opened by pyarrow and numpy.
fn columns() -> Outcome {
    let data = "output.data=[\"csv\", \"parquet\", \"npz\"]";
    match saddle("columns", &["--set", data]) {
        Ok(folder) => run(script("tests/reference/data/columns.py", &[&folder])),
        Err(outcome) => outcome,
    }
}

/// Ready recipes and damaged ones, checked with the schema as an editor does it.
fn schema() -> Outcome {
    if !succeeds(command("taplo", &["--version"])) {
        return Outcome::Skipped("`taplo` is not installed".to_owned());
    }
    match program() {
        Ok(program) => run(script("tests/reference/schema/schema.py", &[&program])),
        Err(outcome) => outcome,
    }
}

/// The dry runs of all posts, by an independent reader.
fn dry_runs() -> Outcome {
    let posts = "output.posts=[\"pmac-pvt\", \"power-pmac-pvt\", \"automation1-pvt\", \"siemens-840d-poly\", \"beckhoff-poly\", \"beckhoff-g93\", \"nanotech-g93\", \"linuxcnc-g93\"]";
    let f_means = "output.nanotech-g93.f_means=1/min";
    let lead = "path.lead=true";
    let changes = ["--dry-run", "--set", lead, "--set", posts, "--set", f_means];
    let folder = match saddle("dry-runs", &changes) {
        Ok(folder) => folder,
        Err(outcome) => return outcome,
    };
    let files = ["pmc", "ppmc", "ascript", "mpf", "ncp", "cnc", "nc", "ngc"].map(|end| {
        let name = format!("saddle-dry-run.{end}");
        folder.join(name)
    });
    let table = folder.join("toolpath.csv");
    let (nose, clearance) = (PathBuf::from("1"), PathBuf::from("5"));
    let mut arguments: Vec<&Path> = vec![&table, &nose, &clearance];
    arguments.extend(files.iter().map(PathBuf::as_path));
    run(script("tests/reference/programs/dry_run.py", &arguments))
}

/// The table beside each script is what the script makes of the program beside it.
fn programs() -> Outcome {
    let folder = Path::new("tests/reference/programs");
    let played = |name: &str, program: &str| {
        let path = |file: &str| folder.join(file);
        let (program, table) = (path(program), path(&format!("{name}.csv")));
        let script_file = format!("tests/reference/programs/{name}.py");
        run(script(&script_file, &[&program, &table]))
    };
    match played("siemens_840d", "saddle.mpf") {
        Outcome::Passed => played("beckhoff_poly", "cutting-speed.ncp"),
        other => other,
    }
}

/// The pages as a book, whose links and search a script tries.
fn book() -> Outcome {
    if !succeeds(command("mdbook", &["--version"])) {
        return Outcome::Skipped("`mdbook` is not installed".to_owned());
    }
    match run(command("mdbook", &["build", "docs"])) {
        Outcome::Passed => {
            // `book.toml` names the folder, from `docs` on.
            let book = repository().join("target").join("book");
            run(script("tests/reference/book/links.py", &[&book]))
        }
        failed => failed,
    }
}

/// The recipes that the ignored tests leave in their scratch folder, measured with the playback apart,
/// as many as the time allows.
fn random_recipes() -> Outcome {
    let recipes = target().join("tmp").join("fewest-points");
    match program() {
        Ok(program) => {
            let mut measure = script(
                "tests/reference/playback/measure_random.py",
                &[&program, &recipes],
            );
            measure.args(["--seconds", MEASURING_S]);
            run(measure)
        }
        Err(outcome) => outcome,
    }
}

/// The bound of 15 nm RMS on what a correction leaves stands in the script.
fn correction() -> Outcome {
    match program() {
        Ok(program) => run(script("tests/reference/grids/correction.py", &[&program])),
        Err(outcome) => outcome,
    }
}

fn maps() -> Outcome {
    match program() {
        Ok(program) => run(script("tests/reference/maps/check_maps.py", &[&program])),
        Err(outcome) => outcome,
    }
}

/// The program, built with optimisation.
pub fn program() -> Result<PathBuf, Outcome> {
    match run(cargo(&[
        "build",
        "--locked",
        "--release",
        "--bin",
        "turnpath",
    ])) {
        Outcome::Passed => {
            let name = format!("turnpath{}", std::env::consts::EXE_SUFFIX);
            Ok(target().join("release").join(name))
        }
        failed => Err(failed),
    }
}

/// The names of the tests that have the attribute `ignore`, sorted, each once.
fn ignored_tests() -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["cli", "crates", "plugins", "tests"] {
        gather(&repository().join(folder), &mut found);
    }
    found.sort();
    found.dedup();
    found
}

fn gather(folder: &Path, found: &mut Vec<String>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() && !path.ends_with("target") {
            gather(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = fs::read_to_string(&path).unwrap_or_default();
            found.extend(ignored_in(&text));
        }
    }
}

/// The names that begin with `long_` in a file that ignores tests.
fn ignored_in(text: &str) -> Vec<String> {
    if !text.contains("#[ignore") {
        return Vec::new();
    }
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    let long = words.filter(|word| word.starts_with("long_"));
    long.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_tests_are_found_by_their_names() {
        let quick = "#[test]\nfn quick() {}\n\nfn long_way_round() {}\n";
        assert_eq!(ignored_in(quick), Vec::<String>::new());
        let long = "#[test]\n#[ignore = \"40 s\"]\nfn long_one() {}\n";
        assert_eq!(ignored_in(long), ["long_one"]);
    }
}
