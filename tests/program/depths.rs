//! A loop of the controller over depths, through the whole program. The test plays the loop by its own few
//! lines, apart from turnpath's readers.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// Z of the plane above the rest of the path, mm, by default.
const APPROACH_HEIGHT: f64 = 5.0;
/// A digit of six decimals, mm, and rounding.
const DIGIT: f64 = 1.1e-6;

const THREE: &str = "depths = 3\ndepth_step = \"2 um\"\n";

fn saddle(table: &str) -> String {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    let means = "f_means = \"s\"";
    format!(
        "{recipe}\n[output]\nposts = [\"nanotech-g93\"]\n\n[output.nanotech-g93]\n{means}\n{table}"
    )
}

/// The moves of a program: the place of Z's zero, and C, X and Z from there.
fn played(text: &str) -> Vec<(f64, [f64; 3])> {
    let code: Vec<&str> = text
        .lines()
        .map(|line| line.split(';').next().unwrap_or_default().trim())
        .collect();
    let value = |line: &str| line.rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    let number = |name: &str| {
        code.iter()
            .find(|line| line.starts_with(name))
            .map(|line| value(line))
    };
    let begin = code
        .iter()
        .position(|line| line.starts_with("WHILE[#5 LT #100]"));
    let end = code.iter().position(|line| *line == "END 2");
    let (turns, begin, end) = match begin.zip(end) {
        Some((begin, end)) => (number("#100 =").unwrap() as usize, begin, end),
        None => (1, 0, code.len()),
    };
    let (mut shift, step) = (
        number("#8 =").unwrap_or(0.0),
        number("#103 =").unwrap_or(0.0),
    );
    let (mut at, mut moves) = ([f64::NAN; 3], Vec::new());
    for _ in 0..turns {
        for line in &code[begin..end] {
            if *line == "#8 = #8 - #103" {
                shift -= step;
            }
            if line.starts_with(['#', 'W']) || line.starts_with("G52") || line.is_empty() {
                continue;
            }
            let words = line.split_whitespace();
            let places: Vec<(usize, f64)> = words
                .filter_map(|word| {
                    let axis = ["C", "X", "Z"]
                        .iter()
                        .position(|axis| word.starts_with(axis))?;
                    Some((axis, word[1..].parse().ok()?))
                })
                .collect();
            places.iter().for_each(|(axis, place)| at[*axis] = *place);
            if !places.is_empty() {
                moves.push((shift, at));
            }
        }
    }
    moves
}

#[test]
fn a_loop_plays_the_path_of_the_recipe_three_times_each_deeper() {
    let once = Bench::with(&saddle(""));
    once.line("run recipe.toml -o out").ends(0);
    let bench = Bench::with(&saddle(THREE));
    let said = bench.line("run recipe.toml -o out --dry-run").ends(0);
    assert!(said.stdout.contains("the program plays the path 3 times"));
    assert!(
        said.stdout
            .contains("the first is 4000.00 nm above the path")
    );
    bench.line("verify recipe.toml out/recipe.nc").ends(0);
    let path = played(&once.read("out/recipe.nc"));
    let deep = played(&bench.read("out/recipe.nc"));
    assert_eq!(deep.len(), 3 * path.len());
    let highest_rest = path.iter().map(|(_, at)| at[2]).fold(f64::MIN, f64::max) - APPROACH_HEIGHT;
    for (k, (shift, at)) in deep.iter().enumerate() {
        let (turn, place) = (k / path.len(), k % path.len());
        assert!(
            (shift - 0.002 * (2 - turn) as f64).abs() < DIGIT,
            "{k}: {shift}"
        );
        let (_, of_path) = path[place];
        let is_travel = of_path[2] > highest_rest + DIGIT;
        // The plane is above the first depth, in each turn.
        let rise = if is_travel { 0.004 } else { 0.0 };
        // An axis that has not moved yet in the one program stands at its end in the other.
        let same = |one: f64, other: f64| (one - other).abs() < DIGIT || other.is_nan();
        assert!(
            same(at[0], of_path[0]) && same(at[1], of_path[1]),
            "{k}: {at:?} {of_path:?}"
        );
        assert!(same(at[2], of_path[2] + rise), "{k}: {at:?} {of_path:?}");
    }
    let dry = bench.read("out/recipe-dry-run.nc");
    assert!(!dry.contains("WHILE") && !dry.contains("G52 X"), "{dry}");
    // The finishing path itself does not change.
    assert_eq!(
        once.read("out/toolpath.csv"),
        bench.read("out/toolpath.csv")
    );
}

/// The time of one turn of a loop by the lines of its program, s: F of a line is its seconds, and that of Z's
/// way down is mm/min. Rapid moves take none.
fn time_of_a_turn(text: &str) -> f64 {
    let (mut z, mut seconds) = (f64::NAN, 0.0);
    let mut is_timed = false;
    for line in text.lines().filter(|line| !line.starts_with(';')) {
        let word = |letter: char| {
            let mut words = line.split_whitespace();
            words.find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok())
        };
        is_timed = (is_timed || line.contains("G93")) && !line.contains("G94");
        if let Some(feed) = word('F') {
            let way = |to: f64| (z - to).abs() / feed * 60.0;
            // The way to the first point has F too, and the axes are there.
            seconds += match (is_timed, line.starts_with("G1 C")) {
                (true, false) => feed,
                (true, true) => 0.0,
                (false, _) => word('Z').map_or(0.0, way),
            };
        }
        z = word('Z').unwrap_or(z);
    }
    seconds
}

/// A remark says how long the machine is busy: with leads, and with the approach of each depth.
#[test]
fn the_time_of_all_depths_is_that_of_their_lines() {
    let bench = Bench::with(&saddle(THREE));
    let said = ["check recipe.toml", "run recipe.toml -o out"].map(|command| {
        let report = bench
            .line(&format!("{command} --format json"))
            .ends(0)
            .json();
        let remarks = report["remarks"].as_array().unwrap().clone();
        let of_depths = remarks.iter().find_map(|remark| remark["time_s"].as_f64());
        of_depths.unwrap_or_else(|| panic!("{remarks:?}"))
    });
    let lines = 3.0 * time_of_a_turn(&bench.read("out/recipe.nc"));
    for time in said {
        assert!((time / lines - 1.0).abs() < 1e-3, "{said:?} {lines}");
    }
}

#[test]
fn verify_refuses_a_program_of_other_depths() {
    let bench = Bench::with(&saddle(THREE));
    bench.line("run recipe.toml -o out").ends(0);
    bench.write("recipe.toml", saddle("depths = 4\ndepth_step = \"2 um\"\n"));
    let said = bench.line("verify recipe.toml out/recipe.nc").ends(4);
    let says = "played 3 times, first 0.004 mm and last 0 mm above its place";
    assert!(said.stderr.contains(says), "{said}");
}

/// A rough path has an allowance of its own: its program plays it once.
#[test]
fn the_loop_is_that_of_the_finishing_path() {
    let passes = "\n[passes.rough]\nallowance = \"30 um\"\ntolerance.interpolation = \"1 um\"\n";
    let bench = Bench::with(&format!("{}{passes}", saddle(THREE)));
    bench.line("run recipe.toml -o out").ends(0);
    assert!(bench.read("out/recipe.nc").contains("WHILE"));
    assert!(!bench.read("out/recipe-rough.nc").contains("WHILE"));
    bench.line("verify recipe.toml out/recipe-rough.nc").ends(0);
}

/// A step that the program's six decimals cannot say would be rounded, and all depths with it.
#[test]
fn a_step_of_parts_of_the_last_digit_is_refused() {
    for (step, shown) in [
        ("2.0005 um", "0.0020005 mm"),
        ("0.4 nm", "0.0000004 mm"),
        ("0.1 nm", "mm"),
    ] {
        let bench = Bench::with(&saddle(&format!("depths = 3\ndepth_step = \"{step}\"\n")));
        for command in ["run recipe.toml -o out", "check recipe.toml"] {
            let said = bench.line(command).ends(2);
            let says = "no whole number of last digits of the program: 0.000001 mm";
            assert!(
                said.stderr.contains(says) && said.stderr.contains(shown),
                "{said}"
            );
        }
    }
    // A seventh decimal says the first of them.
    for (step, decimals) in [("1 nm", 6), ("0.3 um", 6), ("2.0005 um", 7)] {
        let table =
            format!("depths = 3\ndepth_step = \"{step}\"\nposition_decimals = {decimals}\n");
        Bench::with(&saddle(&table))
            .line("check recipe.toml")
            .ends(0);
    }
}

#[test]
fn depths_without_leads_or_of_one_key_alone_are_refused() {
    for (table, lead, says) in [
        (
            THREE,
            false,
            "a loop over depths needs a path from rest to rest",
        ),
        ("depths = 3\n", true, "`depths` without `depth_step`"),
        (
            "depth_step = \"2 um\"\n",
            true,
            "`depth_step` without `depths`",
        ),
    ] {
        let recipe = changed(&saddle(table), "lead = true", &format!("lead = {lead}"));
        let bench = Bench::with(&recipe);
        for command in ["run recipe.toml -o out", "check recipe.toml"] {
            let said = bench.line(command).ends(2);
            assert!(said.stderr.contains(says), "{said}");
        }
    }
}
