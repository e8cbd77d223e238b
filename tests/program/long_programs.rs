//! Programs of several files, and limits of controllers, through the whole program.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// Posts that may have parts, and the endings of their files.
const POSTS: [(&str, &str); 7] = [
    ("pmac-pvt", "pmc"),
    ("power-pmac-pvt", "ppmc"),
    ("automation1-pvt", "ascript"),
    ("siemens-840d-poly", "mpf"),
    ("beckhoff-poly", "ncp"),
    ("beckhoff-g93", "cnc"),
    ("linuxcnc-g93", "ngc"),
];

/// The saddle with leads and a table for each post.
fn saddle(tables: &str) -> String {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    let names: Vec<String> = POSTS
        .iter()
        .map(|(post, _)| format!("\"{post}\""))
        .collect();
    let mut text = format!("{recipe}\n[output]\nposts = [{}]\n", names.join(", "));
    for (post, _) in POSTS {
        text += &format!("\n[output.{post}]\n{tables}\n");
        if post == "linuxcnc-g93" {
            text += "servo_period = \"0.05 ms\"\n";
        }
    }
    text
}

#[test]
fn parts_measure_as_one_program_and_are_in_the_result() {
    let whole = Bench::with(&saddle(""));
    let one = whole
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json();
    let bench = Bench::with(&saddle("split = \"40 kB\""));
    let check = bench.line("check recipe.toml --format json").ends(0).json();
    let run = bench
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json();
    let listed: Vec<&str> = run["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|file| file["file"].as_str())
        .collect();
    for (k, (_, end)) in POSTS.into_iter().enumerate() {
        assert_eq!(
            run["programs"][k]["interpolation_error_nm"],
            one["programs"][k]["interpolation_error_nm"]
        );
        let part = |number: usize| match end {
            "mpf" => format!("recipe_part_{number}.{end}"),
            _ => format!("recipe-part-{number}.{end}"),
        };
        let parts =
            (1..).take_while(|number| bench.path(format!("out/{}", part(*number))).exists());
        let parts: Vec<String> = parts.map(part).collect();
        assert!(parts.len() > 1, "{end}");
        assert!(
            parts.iter().all(|part| listed.contains(&part.as_str())),
            "{listed:?}"
        );
        // The sizes of `check` are right to 5 %, so the count of parts is right to one.
        let said = check["expected"]["programs"][k]["parts"].as_u64().unwrap();
        assert!(
            said.abs_diff(parts.len() as u64) <= 1 + said / 20,
            "{end}: {said} {}",
            parts.len()
        );
        for part in &parts {
            let bytes = std::fs::metadata(bench.path(format!("out/{part}")))
                .unwrap()
                .len();
            assert!(bytes <= 40_000, "{part}: {bytes}");
        }
        let line = format!("verify recipe.toml out/recipe.{end} --format json");
        let found = bench.line(&line).ends(0).json();
        assert_eq!(found["anomalies"]["count"], 0, "{end}");
        assert_eq!(found["rows"], whole_rows(&whole, end), "{end}");
    }
    // One digit of a height is another, and the path still holds.
    let part = "out/recipe-part-3.cnc";
    let text = bench.read(part);
    let (before, rest) = text.split_once("Z").unwrap();
    let end = rest
        .find(|c: char| !c.is_ascii_digit() && c != '-' && c != '.')
        .unwrap();
    let (digits, behind) = (&rest[..end - 1], &rest[end..]);
    let last = if rest[..end].ends_with('5') { '6' } else { '5' };
    bench.write(part, format!("{before}Z{digits}{last}{behind}"));
    let said = bench
        .line("verify recipe.toml out/recipe.cnc --format json")
        .ends(1);
    let result = &said.json()["result"];
    assert_eq!(result["holds"], false, "{result}");
    let wanted = "the bytes of its part recipe-part-3.cnc are not those that the run wrote";
    assert!(
        result["notes"][0].as_str().unwrap().contains(wanted),
        "{result}"
    );
    let said = bench
        .line("verify recipe.toml out/recipe.mpf --format json")
        .ends(0);
    assert_eq!(said.json()["result"]["holds"], true);
    std::fs::remove_file(bench.path("out/recipe-part-2.pmc")).unwrap();
    let said = bench.line("verify recipe.toml out/recipe.pmc").ends(4);
    assert!(said.stderr.contains("recipe-part-2.pmc"), "{said}");
}

fn whole_rows(whole: &Bench, end: &str) -> Value {
    let line = format!("verify recipe.toml out/recipe.{end} --format json");
    whole.line(&line).ends(0).json()["rows"].clone()
}

/// What a controller does not take is refused by both commands, and nothing is written.
#[test]
fn what_a_controller_does_not_take_is_refused_by_check_and_by_run() {
    for (table, says, helps) in [
        (
            "memory = \"20 kB\"",
            "memory is 20 kB",
            "write `split`, or a smaller one",
        ),
        (
            "memory = \"100 blocks\"",
            "memory is 100 blocks",
            "write `split`, or a smaller one",
        ),
        (
            "split = \"30 kB\"\nmemory = \"20 kB\"",
            "memory is 20 kB",
            "a smaller one",
        ),
        (
            "segments_per_second = 100",
            "segments_per_second is 100",
            "spindle slower",
        ),
        ("c_limit = \"720 deg\"", "c_limit is 720 deg", "c_wrap"),
    ] {
        let recipe = format!(
            "{}\n[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n{table}\n",
            changed(SADDLE, "lead = false", "lead = true")
        );
        let bench = Bench::with(&recipe);
        for line in ["check recipe.toml", "run recipe.toml -o out"] {
            let said = bench.line(line).ends(2);
            assert!(said.stderr.contains("`pmac-pvt` cannot carry"), "{said}");
            assert!(
                said.stderr.contains(says) && said.stderr.contains(helps),
                "{said}"
            );
        }
        assert!(!bench.path("out").exists());
    }
    // Parts that fit, and a C that is wrapped.
    let table = "split = \"15 kB\"\nmemory = \"20 kB\"\nsegments_per_second = 1000\nc_limit = \"720 deg\"\nc_wrap = \"0-360\"";
    let recipe =
        format!("{SADDLE}\n[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n{table}\n");
    let bench = Bench::with(&recipe);
    bench.line("check recipe.toml").ends(0);
    bench.line("run recipe.toml -o out").ends(0);
}

/// The range that TwinCAT's maker documents, and a channel of a lab that reaches farther.
#[test]
fn what_is_beyond_the_numbers_of_twincat_is_refused_by_check_and_by_run() {
    let recipe = |post: &str, changes: &str| {
        let saddle = changed(SADDLE, "lead = false", "lead = true");
        format!("{saddle}\n[output]\nposts = [\"{post}\"]\n\n[output.{post}]\n{changes}\n")
    };
    // The saddle takes some seconds and some turns, so the axis of time is fast.
    for (post, table, says, helps) in [
        (
            "beckhoff-poly",
            "time_axis_speed = \"100000 mm/s\"\ntime_axis_limit = \"1 m\"",
            "W, the axis of time, is at",
            "smaller time_axis_speed",
        ),
        (
            "beckhoff-poly",
            "c_limit = \"720 deg\"",
            "c_limit is 720 deg",
            "your own c_limit",
        ),
        (
            "beckhoff-g93",
            "c_limit = \"720 deg\"",
            "c_limit is 720 deg",
            "c_wrap = \"0-360\"",
        ),
    ] {
        let bench = Bench::with(&recipe(post, table));
        for line in ["check recipe.toml", "run recipe.toml -o out"] {
            let said = bench.line(line).ends(2);
            assert!(
                said.stderr.contains(says) && said.stderr.contains(helps),
                "{said}"
            );
        }
    }
}

/// `memory` of the other unit than `split` counts for the largest file, and for the main program too.
#[test]
fn memory_counts_for_each_file_that_is_written() {
    let recipe = |table: &str| {
        let saddle = changed(SADDLE, "lead = false", "lead = true");
        format!("{saddle}\n[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n{table}\n")
    };
    for (split, unit) in [("16 kB", "blocks"), ("300 blocks", "B")] {
        let split = format!("split = \"{split}\"\n");
        let bench = Bench::with(&recipe(&split));
        let run = bench
            .line("run recipe.toml -o out --format json")
            .ends(0)
            .json();
        let files = run["files"].as_array().unwrap().iter();
        let programs = files.filter_map(|file| file["file"].as_str());
        let size = |file: &str| {
            let text = bench.read(format!("out/{file}"));
            match unit {
                "B" => text.len(),
                _ => text.lines().count(),
            }
        };
        let sizes: Vec<usize> = programs
            .filter(|file| file.ends_with(".pmc"))
            .map(size)
            .collect();
        assert!(sizes.len() > 2, "{sizes:?}");
        let largest = sizes.into_iter().max().unwrap();
        let with = |memory: usize| recipe(&format!("{split}memory = \"{memory} {unit}\"\n"));
        Bench::with(&with(largest))
            .line("run recipe.toml -o out")
            .ends(0);
        let small = Bench::with(&with(largest - 1));
        let said = small.line("run recipe.toml -o out").ends(2);
        assert!(
            said.stderr.contains(&format!("memory is {}", largest - 1)) || unit == "B",
            "{said}"
        );
        assert!(
            said.stderr.contains("memory is") && !small.path("out").exists(),
            "{said}"
        );
        // A sample of the path shows it within some percent.
        let smaller = Bench::with(&with(largest * 19 / 20));
        let said = smaller.line("check recipe.toml").ends(2);
        assert!(said.stderr.contains("memory is"), "{said}");
        Bench::with(&with(largest * 21 / 20))
            .line("check recipe.toml")
            .ends(0);
    }
    // The main program alone is larger.
    let bench = Bench::with(&recipe("split = \"500 B\"\nmemory = \"600 B\"\n"));
    for line in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(line).ends(2);
        assert!(said.stderr.contains("and memory is 600 B"), "{said}");
    }
}

#[test]
fn amounts_that_are_none_and_parts_of_a_rotary_buffer_are_refused() {
    for (table, says) in [
        ("split = \"100\"", "\"100\" is no amount"),
        ("memory = \"1 mile\"", "\"1 mile\" is no amount"),
        (
            "split = \"1 MB\"\nbuffer = \"rotary\"",
            "`buffer` takes no calls",
        ),
    ] {
        let recipe =
            format!("{SADDLE}\n[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n{table}\n");
        let said = Bench::with(&recipe)
            .line("check recipe.toml --trust-recipe")
            .ends(2);
        assert!(said.stderr.contains(says), "{said}");
    }
}
