//! Random valid recipes through the whole program: run, read back, checked.

use super::call::{Call, End, Outcome, try_all, words};
use super::seeded::Seeded;
use super::valid_recipes::valid_recipe;
use crate::support::bench::Bench;

const SEED: u64 = 1_000_003;
/// Recipes of every run of the tests, and of `cargo xtask long`.
const CASES: u64 = 25;
const MANY_CASES: u64 = 1000;

/// Runs one recipe, and then another command on what it gave.
fn outcome(bench: &Bench, case: u64) -> Outcome {
    let mut random = Seeded::of_case(SEED, case);
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
    let run = format!("run recipe.toml -o out --threads 2 --format json {plots}");
    let run = Call::new(bench, &words(&run));
    let complaint = run.complaint().or_else(|| match run.end {
        End::Status(0 | 1) => of_next(bench, &run, &mut random),
        _ => Some(format!("a valid recipe is refused: {run}")),
    });
    Outcome {
        end: run.end,
        complaint: complaint.map(|wrong| format!("{wrong}\n{}", recipe.text)),
    }
}

/// What is wrong with another command after the run.
fn of_next(bench: &Bench, run: &Call, random: &mut Seeded) -> Option<String> {
    let line = *random.pick(&[
        "verify recipe.toml out/toolpath.csv --format json",
        "check recipe.toml --format json",
        "sag recipe.toml --grid 5 -o sag.csv",
    ]);
    let next = Call::new(bench, &words(line));
    let fits = match next.end {
        // What was measured on the path itself holds on its file too.
        End::Status(0 | 1) if line.starts_with("verify") => {
            let within = |call: &Call, what: &str| {
                let report: serde_json::Value = serde_json::from_str(&call.stdout).ok()?;
                Some(report["within"][what].clone())
            };
            let same = |what| within(run, what) == within(&next, what);
            ["interpolation", "residual", "coverage"]
                .into_iter()
                .all(same)
        }
        End::Status(0) => true,
        _ => false,
    };
    let wrong = || format!("{line} after {:?}: {next}", run.end);
    next.complaint().or_else(|| (!fits).then(wrong))
}

#[test]
fn random_valid_recipes_are_run() {
    let tally = try_all("valid recipe", 0..CASES, outcome);
    let held = tally.count(End::Status(0));
    assert!(held > 0, "no recipe holds: {tally}");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_thousand_random_valid_recipes_are_run() {
    let tally = try_all("valid recipe", 0..MANY_CASES, outcome);
    let (held, exceeded) = (tally.count(End::Status(0)), tally.count(End::Status(1)));
    assert!(held > 100 && exceeded > 100, "one-sided: {tally}");
}
