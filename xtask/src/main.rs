//! `cargo xtask`: what takes too long, or needs too much, for `.ci/run`.

mod bench;
mod browser;
mod commands;
mod deny;
mod fuzz;
mod latex;
mod long;
mod msrv;
mod python;
mod python_package;
mod reference;
mod step;

use std::process::ExitCode;

use step::{Step, report};

const HELP: &str = "\
cargo xtask COMMAND

  long [NAME…]        every check that `.ci/run` leaves out, or those of these names
  long --list         what they are
  reference [NAME…]   makes the reference figures again, or those of these names
  bench [WORD…]       times the program against scripts of the same chain, for docs/benchmarks.md;
                      `bench --help` has the words
  fuzz [NAME…]        fuzzes the targets of tests/fuzz with cargo-fuzz, or those of these names
  msrv                checks the workspace with the oldest Rust version that it promises
  deny                checks licences, bans and sources of all dependencies with cargo-deny
  python              builds the wheel of the Python package and tests it in an empty environment

A step whose tool or package is not installed is skipped, and the report says so.";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let steps: Vec<Step> = match words.as_slice() {
        ["--help" | "-h" | "help"] => {
            println!("{HELP}");
            return ExitCode::SUCCESS;
        }
        ["long", "--list"] => {
            println!("{}", long::list());
            return ExitCode::SUCCESS;
        }
        ["long", names @ ..] => match long::run_named(names) {
            Ok(steps) => steps,
            Err(unknown) => return refuse(&unknown),
        },
        ["reference", names @ ..] => match reference::run_named(names) {
            Ok(steps) => steps,
            Err(unknown) => return refuse(&unknown),
        },
        ["bench", words @ ..] => bench::run_bench(words),
        ["fuzz", names @ ..] => fuzz::run_targets(names),
        ["msrv"] => msrv::run_checks(),
        ["deny"] => deny::run_checks(),
        ["python"] => python_package::run_checks(),
        _ => return refuse(HELP),
    };
    report(&steps)
}

/// Ends a call that is wrong.
fn refuse(why: &str) -> ExitCode {
    eprintln!("{why}");
    ExitCode::from(2)
}
