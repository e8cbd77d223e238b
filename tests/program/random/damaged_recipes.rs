//! Damaged recipes through the whole program: keys dropped, doubled and misspelt, values of other
//! kinds, sizes and units, text that never ends, and bytes as disks and editors spoil them.

use std::path::Path;

use super::call::{Call, End, Outcome, Tally, try_all, words};
use super::damage::damaged;
use super::seeded::SeededNumbers;
use super::valid_recipes::{SPINDLE_PLUGIN, valid_recipe, with_plugins};
use crate::fuzz::recipe::WORDS;
use crate::support::bench::Bench;
use crate::support::fixtures::plugin_folder;

const SEED: u64 = 2_000_003;
/// Recipes of every run of the tests, and of `cargo xtask long`.
const CASES: u64 = 32;
const MANY_CASES: u64 = 1000;
/// From so many points on, a run may take longer than a call of these tests, and is no endless one.
const LONG_WORK: f64 = 1e6;

/// Values in place of others.
const VALUES: [&str; 34] = [
    "0",
    "-1",
    "1",
    "7",
    "1e300",
    "-1e300",
    "1e-300",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "true",
    "\"\"",
    "\"0 mm\"",
    "\"-1 mm\"",
    "\"1 nm\"",
    "\"1e-9 nm\"",
    "\"1 m\"",
    "\"nan mm\"",
    "\"inf deg\"",
    "\"1e300 deg\"",
    "\"1e-300 rad\"",
    "\"1 rpm\"",
    "\"1e6 rpm\"",
    "\"5 kg\"",
    "\"5\"",
    "\"-0 um/rev\"",
    "\"atpg\"",
    "[]",
    "{}",
    "[[0, 0, 1], [40, 40, 1e300]]",
    "1979-05-27T07:32:00Z",
    "\"\\u001b[2J\\u0007\\u0000\"",
    "\"\u{202e}\u{7f}\u{9b}\u{fffd}\"",
];

/// A recipe that was valid before.
fn damaged_recipe(random: &mut SeededNumbers) -> Vec<u8> {
    let recipe = valid_recipe(random).text;
    if random.one_in(4) {
        let other = valid_recipe(random).text;
        return damaged(recipe.as_bytes(), other.as_bytes(), WORDS, random);
    }
    let mut lines: Vec<String> = recipe.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        damage_line(&mut lines, random);
    }
    lines.join("\n").into_bytes()
}

fn damage_line(lines: &mut Vec<String>, random: &mut SeededNumbers) {
    let at = random.below(lines.len());
    let Some(line) = lines.get(at).cloned() else {
        return;
    };
    let key = line.split(" = ").next().unwrap_or_default().to_owned();
    match random.below(8) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, line),
        2 => {
            let other = random.below(lines.len());
            lines.swap(at, other);
        }
        3 => lines[at] = format!("{key}x = 1"),
        4 => lines[at] = format!("{key} = {}", endless(random)),
        _ => lines[at] = format!("{key} = {}", random.pick(&VALUES)),
    }
}

/// Values that are long, or deep.
fn endless(random: &mut SeededNumbers) -> String {
    let count = *random.pick(&[50, 100, 10_000, 100_000]);
    match random.below(5) {
        0 => format!("\"{}\"", "a".repeat(10 * count)),
        1 => format!("{}1{}", "[".repeat(count), "]".repeat(count)),
        2 => format!("{}1{}", "{ a = ".repeat(count), " }".repeat(count)),
        3 => format!("[{}]", "1, ".repeat(count)),
        _ => format!("\"{} mm\"", "9".repeat(count)),
    }
}

/// Calls a command with a damaged recipe.
fn outcome(plugins: &Path, bench: &Bench, case: u64) -> Outcome {
    let mut random = SeededNumbers::of_case(SEED, case);
    let recipe = damaged_recipe(&mut random);
    bench.write("recipe.toml", &recipe);
    let line = *random.pick(&[
        "run recipe.toml -o out --threads 2 --format json",
        "run recipe.toml -o out --threads 2 --format json",
        "check recipe.toml --threads 2 --format json",
        "sag recipe.toml --grid 3 -o sag.csv",
        "ablate recipe.toml -o out --threads 2 --format json",
    ]);
    let text = String::from_utf8_lossy(&recipe);
    let mut args = with_plugins(&text, plugins, words(line));
    if random.one_in(5) {
        let key = random.pick(&["part.aperture", "surface", "feed.feed", "a.b", "", "tool.0"]);
        args.extend([
            "--set".to_owned(),
            format!("{key}={}", random.pick(&VALUES)),
        ]);
    }
    let call = Call::new(bench, &args);
    let mut complaint = call.complaint();
    if call.end == End::Never && is_long_work(bench, &args) {
        complaint = None;
    }
    if matches!(call.end, End::Status(2)) && bench.files() != ["recipe.toml"] {
        complaint = Some(format!("files are left: {:?}: {call}", bench.files()));
    }
    Outcome {
        end: call.end,
        complaint: complaint.map(|wrong| {
            let text: String = text.chars().take(3000).collect();
            format!("{args:?}: {wrong}\n{text}")
        }),
    }
}

/// Whether `check` ends, and says that a run is long work.
fn is_long_work(bench: &Bench, args: &[String]) -> bool {
    if args.first().is_none_or(|command| command == "check") {
        return false;
    }
    let mut check = words("check recipe.toml --format json");
    let is_option = |arg: &String| matches!(arg.as_str(), "--plugin-dir" | "--set");
    if let Some(at) = args.iter().position(is_option) {
        check.extend_from_slice(&args[at..]);
    }
    let check = Call::new(bench, &check);
    let report = check.report();
    let points = report.and_then(|report| report["expected"]["control_points"].as_f64());
    points.is_some_and(|points| points > LONG_WORK)
}

fn try_recipes(cases: u64) -> Tally {
    let plugins = plugin_folder(&[SPINDLE_PLUGIN]);
    try_all("damaged recipe", 0..cases, |bench, case| {
        outcome(plugins.path(), bench, case)
    })
}

#[test]
fn damaged_recipes_are_refused_or_run() {
    let tally = try_recipes(CASES);
    let refused = tally.count(End::Status(2));
    assert!(refused > 0, "no recipe is refused: {tally}");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_thousand_damaged_recipes_are_refused_or_run() {
    let tally = try_recipes(MANY_CASES);
    let refused = tally.count(End::Status(2));
    assert!(refused > 100, "few recipes are refused: {tally}");
}
