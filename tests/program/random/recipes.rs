//! Random valid recipes through the whole program: run, read back, checked.

use std::path::Path;

use super::call::{Call, End, Outcome, Tally, try_all, words};
use super::seeded::SeededNumbers;
use super::valid_recipes::{SPINDLE_PLUGIN, valid_recipe, with_plugins};
use crate::support::bench::Bench;
use crate::support::fixtures::plugin_folder;

const SEED: u64 = 1_000_003;
/// Recipes of every run of the tests, and of `cargo xtask long`.
const CASES: u64 = 5;
const MANY_CASES: u64 = 1000;
/// Verdicts on the path itself, which its table has too.
const OF_THE_PATH: [&str; 5] = ["interpolation", "residual", "form", "servo", "coverage"];

/// Runs one recipe, and then other commands on what it gave.
fn outcome(plugins: &Path, bench: &Bench, case: u64) -> Outcome {
    let mut random = SeededNumbers::of_case(SEED, case);
    let recipe = valid_recipe(&mut random);
    bench.write("recipe.toml", &recipe.text);
    let circle = format!("--profile 10deg --circle {}mm", 0.4 * recipe.aperture);
    let plots = *random.pick(&[
        "",
        "",
        "--map a.gsf --map-size 16",
        "--map a.xyz --map-size 16 --map-grid polar --spectrum",
        &circle,
    ]);
    let call = |line: &str| Call::new(bench, &with_plugins(&recipe.text, plugins, words(line)));
    let run = call(&format!(
        "run recipe.toml -o out --threads 2 --format json {plots}"
    ));
    let complaint = run.complaint().or_else(|| match run.end {
        End::Status(0 | 1) => of_files(bench, &run, call).or_else(|| {
            let line = *random.pick(&[
                "check recipe.toml --format json",
                "sag recipe.toml --grid 5 -o sag.csv",
            ]);
            let next = call(line);
            let refused = || (next.end != End::Status(0)).then(|| format!("{line}: {next}"));
            next.complaint().or_else(refused)
        }),
        _ => Some(format!("a valid recipe is refused: {run}")),
    });
    Outcome {
        end: run.end,
        complaint: complaint.map(|wrong| format!("{wrong}\n{}", recipe.text)),
    }
}

/// What is wrong with the run's table or with its program, read back.
fn of_files(bench: &Bench, run: &Call, call: impl Fn(&str) -> Call) -> Option<String> {
    let files = bench.files();
    let named = ["toolpath.csv", "recipe.pmc"].map(|name| format!("out/{name}"));
    let written = named.iter().filter(|name| files.contains(name));
    let mut wrong = written.filter_map(|file| {
        let said = call(&format!(
            "verify recipe.toml {file} --threads 2 --format json"
        ));
        let fault = said.complaint().or_else(|| of_file(file, run, &said));
        fault.map(|fault| format!("{file} after {:?}: {fault}: {said}", run.end))
    });
    wrong.next()
}

/// What `verify` says of a run's own file and should not: rows of others, parts that lack, bytes that
/// the summary does not list, and of the table verdicts that are not those of the path.
fn of_file(file: &str, run: &Call, said: &Call) -> Option<String> {
    if !matches!(said.end, End::Status(0 | 1)) {
        return Some("not measured".to_owned());
    }
    let report = |call: &Call| call.report().unwrap_or_default();
    let (ran, verified) = (report(run), report(said));
    let (anomalies, within) = (&verified["anomalies"], &verified["within"]);
    let is_table = file.ends_with("csv");
    let differs = |what: &&str| is_table && ran["within"][what] != within[what];
    if anomalies["compared_with"] != "recipe" || anomalies["count"] != 0 {
        return Some(format!("anomalies: {anomalies}"));
    }
    if within["whole"] == false || within["result"] != true {
        return Some(format!("within: {within}"));
    }
    let verdict = OF_THE_PATH.into_iter().find(differs)?;
    Some(format!("{verdict} is {} in the run", ran["within"]))
}

fn try_recipes(cases: u64) -> Tally {
    let plugins = plugin_folder(&[SPINDLE_PLUGIN]);
    try_all("valid recipe", 0..cases, |bench, case| {
        outcome(plugins.path(), bench, case)
    })
}

#[test]
fn random_valid_recipes_are_run() {
    let tally = try_recipes(CASES);
    let held = tally.count(End::Status(0));
    assert!(held > 0, "no recipe holds: {tally}");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_thousand_random_valid_recipes_are_run() {
    let tally = try_recipes(MANY_CASES);
    let (held, exceeded) = (tally.count(End::Status(0)), tally.count(End::Status(1)));
    assert!(held > 100 && exceeded > 100, "one-sided: {tally}");
}
