//! The pages of a run and of an ablation in a browser.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{command, repository, run, succeeds, target};
use crate::long::program;
use crate::step::Outcome;

/// Browsers by their names, unless `CHROMIUM` names one.
const BROWSERS: [&str; 2] = ["chromium", "google-chrome"];
/// The script; `NODE_PATH` says where node looks for playwright-core.
const SCRIPT: &str = "tests/reference/report/report.cjs";
/// A run whose cusps are so low that the points of a map differ little from its means.
const RUN: &str = "tests/reference/report/spokes.toml";
const ABLATION: &str = "tests/reference/report/ablation.toml";

/// Makes a page of each kind and has the script look at them.
pub fn report() -> Outcome {
    let module = ["-e", "require.resolve('playwright-core')"];
    if !succeeds(command("node", &["--version"])) {
        return Outcome::Skipped("`node` is not installed".to_owned());
    }
    if !succeeds(command("node", &module)) {
        return Outcome::Skipped("`node` has no playwright-core".to_owned());
    }
    let Some(browser) = browser() else {
        return Outcome::Skipped("Chromium is not installed".to_owned());
    };
    match pages() {
        Ok([run_folder, ablation]) => {
            let pictures = target().join("long").join("report-pictures");
            let mut look = command("node", &[SCRIPT, &browser]);
            look.args([pictures, run_folder, ablation]);
            run(look)
        }
        Err(outcome) => outcome,
    }
}

fn browser() -> Option<String> {
    let asked = std::env::var("CHROMIUM").ok();
    let named = BROWSERS.map(str::to_owned);
    let found = asked.into_iter().chain(named);
    let path = |name: String| {
        let which = Command::new("sh")
            .args(["-c", "command -v \"$0\"", &name])
            .output()
            .ok()?;
        let path = String::from_utf8(which.stdout).ok()?;
        which.status.success().then(|| path.trim().to_owned())
    };
    found.into_iter().find_map(path)
}

/// The folders of a run and of an ablation.
fn pages() -> Result<[PathBuf; 2], Outcome> {
    let program = program()?;
    let made = |words: &[&str], name: &str| {
        let folder = target().join("long").join(name);
        let mut call = Command::new(&program);
        call.current_dir(repository())
            .args(words)
            .arg("-o")
            .arg(&folder);
        finished(call, &folder)
    };
    let run = ["run", RUN, "--map", "map.gsf", "--map-size", "300"];
    Ok([
        made(&run, "report-run")?,
        made(&["ablate", ABLATION], "report-ablation")?,
    ])
}

fn finished(call: Command, folder: &Path) -> Result<PathBuf, Outcome> {
    match run(call) {
        Outcome::Passed => Ok(folder.to_owned()),
        failed => Err(failed),
    }
}
