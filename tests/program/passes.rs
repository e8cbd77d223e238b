//! `[passes]`: paths before the finishing one, each with what it leaves and with values of its own.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

const PASSES: &str = r#"
[passes.rough]
allowance = "30 um"
tolerance = { residual = "2 um", interpolation = "500 nm" }
spindle.speed = "300 rpm"

[passes.middle]
allowance = "5 um"
feed = { use = "constant", feed = "40 um/rev" }
tolerance.residual = "400 nm"
"#;

/// The saddle with leads and programs of two posts.
fn saddle() -> String {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    let recipe = changed(&recipe, "overrun = \"none\"", "overrun = \"contact\"");
    format!("{recipe}\n[output]\nposts = [\"pmac-pvt\", \"automation1-pvt\"]\n")
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("{pointer} of {value}"))
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/summary.json")).unwrap()
}

/// A program without the line that has the hash of its recipe's text.
fn without_hash(text: &str) -> Vec<&str> {
    let lines = text.lines();
    lines.filter(|line| !line.contains("SHA-256")).collect()
}

#[test]
fn the_finishing_path_has_the_bytes_of_the_recipe_without_passes() {
    let alone = Bench::with(&saddle());
    alone.line("run recipe.toml -o out").ends(0);
    let all = Bench::with(&format!("{}{PASSES}", saddle()));
    all.line("run recipe.toml -o out").ends(0);
    assert_eq!(all.read("out/toolpath.csv"), alone.read("out/toolpath.csv"));
    for file in ["out/recipe.pmc", "out/recipe.ascript"] {
        let (all, alone) = (all.read(file), alone.read(file));
        assert_eq!(without_hash(&all), without_hash(&alone));
    }
}

/// A recipe without passes knows no rough path, so `verify` measures the file against the wanted surface,
/// and not against the lifted one for which it was made.
#[test]
fn a_rough_path_leaves_what_it_says() {
    let bench = Bench::with(&format!("{}{PASSES}", saddle()));
    bench.line("run recipe.toml -o out").ends(0);
    bench.write("wanted.toml", saddle());
    let summary = summary(&bench);
    for (at, name, allowance_nm, tolerance_nm) in
        [(0, "rough", 30_000.0, 500.0), (1, "middle", 5_000.0, 100.0)]
    {
        let rough = &summary["passes"][at];
        assert_eq!(rough["name"], name);
        assert_eq!(number(rough, "/allowance_um") * 1e3, allowance_nm);
        for file in [format!("toolpath-{name}.csv"), format!("recipe-{name}.pmc")] {
            let said = bench.line(&format!("verify wanted.toml out/{file} --format json"));
            let found = said.json();
            let lowest = number(&found, "/surface_error/lowest/error_nm");
            let highest = number(&found, "/surface_error/highest/error_nm");
            let mean = number(&found, "/surface_error/mean_nm");
            assert!(
                (lowest - allowance_nm).abs() < tolerance_nm,
                "{file}: {lowest}"
            );
            assert!(
                highest > lowest && mean > allowance_nm - tolerance_nm,
                "{file}"
            );
            for (key, figure) in [("least", lowest), ("mean", mean), ("most", highest)] {
                let left = number(rough, &format!("/left/{key}_um")) * 1e3;
                assert!((left - figure).abs() < 0.5, "{file}: {key} {left} {figure}");
            }
        }
    }
}

/// With the recipe that has the pass, a file of it is held to the pass's own surface, tolerance and rows.
#[test]
fn verify_compares_a_file_of_a_pass_with_its_own_path() {
    let bench = Bench::with(&format!("{}{PASSES}", saddle()));
    bench.line("run recipe.toml -o out").ends(0);
    for file in [
        "toolpath-rough.csv",
        "toolpath-middle.csv",
        "recipe-rough.pmc",
        "recipe-middle.ascript",
        "recipe.pmc",
    ] {
        let line = format!("verify recipe.toml out/{file} --format json");
        let found = bench.line(&line).ends(0).json();
        assert_eq!(found["anomalies"]["count"], 0, "{file}");
        assert_eq!(found["anomalies"]["compared_with"], "recipe", "{file}");
    }
    // A row of the rough path that is not where the pass has it.
    let table = bench.read("out/toolpath-rough.csv");
    let mut rows: Vec<String> = table.lines().map(str::to_owned).collect();
    let middle = rows.len() / 2;
    let mut cells: Vec<String> = rows[middle].split(',').map(str::to_owned).collect();
    cells[3] = (cells[3].parse::<f64>().unwrap() + 2e-3).to_string();
    rows[middle] = cells.join(",");
    bench.write("toolpath-rough.csv", rows.join("\n"));
    let line = "verify recipe.toml toolpath-rough.csv --format json";
    let found = bench.line(line).ends(1).json();
    assert_eq!(found["anomalies"]["count"], 1);
}

#[test]
fn a_rough_path_has_its_own_values_and_the_files_are_in_the_result() {
    let bench = Bench::with(&format!("{}{PASSES}", saddle()));
    let said = bench.line("run recipe.toml -o out").ends(0);
    assert!(said.stdout.contains("pass rough"), "{said}");
    let summary = summary(&bench);
    assert_eq!(summary["within"]["passes"], true);
    let turns = |pointer: &str| number(&summary, pointer);
    // Cusps of 2 um in place of 0.1 um: the feed is the root of twenty times as large.
    let ratio = turns("/revolutions") / turns("/passes/0/revolutions");
    assert!((4.0..5.0).contains(&ratio), "{ratio}");
    // 2.5 mm at 40 um a turn, and what the contact needs at both ends.
    let middle = turns("/passes/1/revolutions");
    assert!((62.0..75.0).contains(&middle), "{middle}");
    let slow = turns("/passes/0/cutting_time_s") / turns("/passes/0/revolutions");
    assert!((slow - 0.2).abs() < 1e-3, "{slow}");
    let listed: Vec<&str> = summary["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|file| file["file"].as_str())
        .collect();
    for file in [
        "recipe-rough.pmc",
        "recipe-middle.ascript",
        "toolpath-rough.csv",
    ] {
        assert!(listed.contains(&file), "{listed:?}");
    }
    let program = bench.read("out/recipe-rough.pmc");
    assert!(program.starts_with("; Saddle, rough\n"), "{program:.200}");
}

#[test]
fn a_set_changes_a_key_of_a_rough_path() {
    let bench = Bench::with(&format!("{}{PASSES}", saddle()));
    let said = bench.call([
        "run",
        "recipe.toml",
        "-o",
        "out",
        "--set",
        "passes.rough.allowance=12 um",
    ]);
    said.ends(0);
    assert_eq!(number(&summary(&bench), "/passes/0/allowance_um"), 12.0);
}

#[test]
fn a_rough_path_that_holds_no_limit_makes_the_status_1() {
    let limit = "\n[machine]\nz_velocity = \"45 mm/s\"\n";
    let recipe = format!("{}{PASSES}{limit}", saddle());
    let fast = changed(&recipe, "300 rpm", "900 rpm");
    let bench = Bench::with(&changed(
        &fast,
        "speed = \"500 rpm\"",
        "speed = \"200 rpm\"",
    ));
    let said = bench.line("run recipe.toml -o out").ends(1);
    assert!(said.stdout.contains("EXCEEDED: machine"), "{said}");
    assert_eq!(summary(&bench)["within"]["passes"], false);
}

#[test]
fn wrong_passes_are_underlined() {
    for (lines, says) in [
        ("[passes.rough]\n", "lacks `allowance`"),
        ("[passes.rough]\nallowance = \"-1 um\"\n", "allowance"),
        ("[passes]\nrough = 3\n", "`passes.rough` must be a table"),
        (
            "[passes.rough]\nallowance = \"1 um\"\nsurface = { k = 2 }\n",
            "[passes.rough] has no key",
        ),
        (
            "[passes.dry-run]\nallowance = \"1 um\"\n",
            "cannot be the end of a file's name",
        ),
        (
            "[passes.part-1]\nallowance = \"1 um\"\n",
            "cannot be the end of a file's name",
        ),
        (
            "[passes.Part-20]\nallowance = \"1 um\"\n",
            "cannot be the end of a file's name",
        ),
        (
            "[passes.x]\nallowance = \"5 um\"\n[passes.X-part-1]\nallowance = \"1 um\"\n",
            "`X-part-1` is the name of other files of `x`",
        ),
        (
            "[passes.x-dry-run]\nallowance = \"5 um\"\n[passes.x]\nallowance = \"1 um\"\n",
            "`x-dry-run` is the name of other files of `x`",
        ),
        (
            "[passes.x]\nallowance = \"5 um\"\n[passes.X]\nallowance = \"1 um\"\n",
            "`X` and `x` give the same names of parts",
        ),
        (
            "[passes.a]\nallowance = \"10 um\"\n[passes.b]\nallowance = \"50 um\"\n",
            "`b` would cut nothing: it leaves 50 um, and `a` before it only 10 um",
        ),
        (
            "[passes.rough]\nallowance = \"1 um\"\ntolerance.residual = \"1 deg\"\n",
            "is an angle",
        ),
        (
            "[passes.rough]\nallowance = \"1 um\"\nfeed = { use = \"constent\" }\n",
            "constent",
        ),
    ] {
        let bench = Bench::with(&format!("{}\n{lines}", saddle()));
        let said = bench.line("run recipe.toml -o out").ends(2);
        assert!(said.stderr.contains(says), "{lines}: {said}");
        assert_eq!(bench.files(), ["recipe.toml"]);
    }
}

/// What only begins like the names of parts and of dry runs is a name like any other.
#[test]
fn names_that_no_other_file_has_are_taken() {
    for [first, second] in [
        ["part-", "part-1-fine"],
        ["x", "x-part-"],
        ["x", "xpart-1"],
        ["x", "x-dry"],
        ["part-0", "my-dry-run"],
    ] {
        let tables = format!(
            "[passes.{first}]\nallowance = \"5 um\"\n[passes.{second}]\nallowance = \"1 um\"\n"
        );
        let bench = Bench::with(&format!("{}\n{tables}", saddle()));
        bench.line("check recipe.toml").ends(0);
    }
}

/// All paths may lie in one controller, where a second program of a number takes the place of the first.
#[test]
fn no_two_parts_of_a_run_have_one_number_on_a_controller_that_calls_by_numbers() {
    let posts = "posts = [\"pmac-pvt\", \"power-pmac-pvt\"]";
    let recipe = changed(
        &saddle(),
        "posts = [\"pmac-pvt\", \"automation1-pvt\"]",
        posts,
    );
    let tables = ["pmac-pvt", "power-pmac-pvt"]
        .map(|post| format!("\n[output.{post}]\nsplit = \"50 kB\"\n"))
        .concat();
    let alone = Bench::with(&format!("{recipe}{tables}"));
    alone.line("run recipe.toml -o out").ends(0);
    let bench = Bench::with(&format!("{recipe}{tables}{PASSES}"));
    bench.line("run recipe.toml -o out").ends(0);
    for extension in ["pmc", "ppmc"] {
        let mut numbers = Vec::new();
        for (path, hundred) in [("recipe", 1), ("recipe-rough", 2), ("recipe-middle", 3)] {
            let main = bench.read(format!("out/{path}.{extension}"));
            let calls: Vec<u32> = main
                .lines()
                .filter_map(|line| {
                    line.to_ascii_lowercase()
                        .strip_prefix("call")?
                        .trim()
                        .parse()
                        .ok()
                })
                .collect();
            let expected: Vec<u32> = (1..)
                .map(|part| 100 * hundred + part)
                .take(calls.len())
                .collect();
            assert!(calls.len() > 1 || path != "recipe", "{main}");
            assert!(!calls.is_empty(), "{path}: {main}");
            assert_eq!(calls, expected, "{path}");
            for (part, number) in calls.iter().enumerate() {
                let text = bench.read(format!("out/{path}-part-{}.{extension}", part + 1));
                let opens = format!("open prog {number}");
                assert!(text.to_ascii_lowercase().contains(&opens), "{text}");
            }
            numbers.extend(calls);
            bench
                .line(&format!("verify recipe.toml out/{path}.{extension}"))
                .ends(0);
        }
        let count = numbers.len();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), count);
        // The finishing path has the bytes of the recipe without passes, its parts too.
        for file in [
            format!("out/recipe-part-1.{extension}"),
            format!("out/recipe.{extension}"),
        ] {
            let (all, alone) = (bench.read(&file), alone.read(&file));
            assert_eq!(without_hash(&all), without_hash(&alone));
        }
    }
}

/// Beyond the numbers of motion programs there is none for the parts of a path.
#[test]
fn a_ninth_rough_path_has_no_parts_on_a_controller_that_calls_by_numbers() {
    let paths = |count: u32| -> String {
        let table = |k: u32| format!("\n[passes.p{k}]\nallowance = \"{} um\"\n", 20 - k);
        (0..count).map(table).collect()
    };
    let split = "\n[output.pmac-pvt]\nsplit = \"50 kB\"\n";
    for (count, split, status) in [(8, split, 0), (9, split, 2), (9, "", 0)] {
        let bench = Bench::with(&format!("{}{split}{}", saddle(), paths(count)));
        let said = bench.line("check recipe.toml").ends(status);
        let says = "a run has at most 8 rough paths";
        assert_eq!(said.stderr.contains(says), status > 0, "{said}");
    }
}

/// A size of `check` may be 5 % off that of the file.
#[test]
fn check_estimates_each_path_to_5_percent_of_its_files() {
    let bench = Bench::with(&format!("{}{PASSES}", saddle()));
    let said = bench.line("check recipe.toml --format json").ends(0);
    let expected: Value = serde_json::from_str(&said.stdout).unwrap();
    bench.line("run recipe.toml -o out").ends(0);
    for (path, (name, allowance)) in [("rough", 30.0), ("middle", 5.0)].into_iter().enumerate() {
        let path = &expected["passes"][path];
        assert_eq!(path["name"], name);
        assert_eq!(number(path, "/allowance_um"), allowance);
        let programs = path["expected"]["programs"].as_array().unwrap();
        let files = programs.iter().map(|program| &program["file"]);
        let of_path = ["pmc", "ascript"].map(|extension| format!("recipe-{name}.{extension}"));
        assert!(files.eq(&of_path), "{path}");
        let table = (format!("toolpath-{name}.csv"), "/toolpath_bytes".to_owned());
        let sizes = of_path.into_iter().enumerate();
        let sizes = sizes.map(|(k, file)| (file, format!("/programs/{k}/bytes")));
        for (file, key) in sizes.chain([table]) {
            let bytes = bench.read(format!("out/{file}")).len() as f64;
            let ratio = number(&path["expected"], &key) / bytes;
            assert!((0.95..1.05).contains(&ratio), "{file}: {ratio}");
        }
    }
    let text = bench.line("check recipe.toml").ends(0).stdout;
    assert!(text.contains("pass rough"), "{text}");
    assert!(text.contains("recipe-middle.ascript"), "{text}");
    assert!(text.contains("toolpath-middle.csv"), "{text}");
}

#[test]
fn check_refuses_a_program_of_a_rough_path_that_a_run_refuses() {
    let memory = "\n[output.pmac-pvt]\nmemory = \"400 kB\"\n";
    let dense = "\n[passes.dense]\nallowance = \"5 um\"\nspindle.speed = \"600 rpm\"\n\
                 feed = { use = \"constant\", feed = \"1 um/rev\" }\n";
    Bench::with(&format!("{}{memory}", saddle()))
        .line("check recipe.toml")
        .ends(0);
    let bench = Bench::with(&format!("{}{memory}{dense}", saddle()));
    for command in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(command).ends(2);
        assert!(said.stderr.contains("recipe-dense.pmc"), "{said}");
    }
}
