//! `turnpath ablate`: which runs it makes, what it reports of them, and which it does not repeat.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod repeats;
mod tables;

use std::collections::BTreeMap;
use std::fs;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, SystemTime};

use crate::support::bench::{Answer, Bench, answer};
use crate::support::fixtures::plugin_folder;
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::{Value, json};

/// The saddle with an ablation.
fn saddle(lists: &str) -> String {
    format!("{SADDLE}\n[ablation]\n{lists}\n")
}

/// Two feeds, two samplers and two velocity solvers.
fn eight() -> String {
    saddle(
        "feed = [{ use = \"atpg\" }]\nsampler = [{ use = \"equal-angle\", step = \"6 deg\" }]\n\
         velocity = [{ use = \"analytic\" }]",
    )
}

fn ablate(bench: &Bench, rest: &str) -> Answer {
    bench.line(&format!("ablate recipe.toml -o out {rest}"))
}

fn runs(bench: &Bench) -> Vec<Value> {
    let text = bench.read("out/ablation.json");
    let all: Value = serde_json::from_str(&text).unwrap();
    all["runs"].as_array().unwrap().clone()
}

fn varied(bench: &Bench) -> Vec<String> {
    let one = |run: &Value| {
        let varied = run["varied"].as_object().unwrap();
        let values = varied.values().map(|value| value.as_str().unwrap());
        values.collect::<Vec<_>>().join(" | ")
    };
    runs(bench).iter().map(one).collect()
}

/// The first line without the job's name.
fn headline(said: &Answer) -> &str {
    let line = said.stdout.lines().next().unwrap();
    line.split_once(": ").unwrap().1
}

/// The records, each with the time when it was written.
fn records(bench: &Bench) -> BTreeMap<String, SystemTime> {
    let Ok(entries) = fs::read_dir(bench.path("out/runs")) else {
        return BTreeMap::new();
    };
    let entries = entries.map(|entry| entry.unwrap());
    let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), entry));
    let records = named.filter(|(name, _)| name.ends_with(".json"));
    records
        .map(|(name, entry)| (name, entry.metadata().unwrap().modified().unwrap()))
        .collect()
}

/// What differs from call to call.
const TIMES: [&str; 2] = ["planning_time_s", "measuring_time_s"];

/// A run without what differs from call to call.
fn without_times(run: &Value) -> Value {
    let mut run = run.clone();
    for key in TIMES {
        if let Some(time) = run.get_mut(key) {
            assert!(time.as_f64().unwrap() > 0.0, "{key}");
            *time = json!(0);
        }
    }
    run
}

#[test]
fn the_full_product_is_made_with_the_recipe_first() {
    let bench = Bench::with(&eight());
    let said = ablate(&bench, "").ends(0);
    assert_eq!(said.stderr, "");
    assert_eq!(headline(&said), "8 runs");
    let expected = [
        "constant | equal-angle (step = 9 deg) | triangle-rotary",
        "constant | equal-angle (step = 9 deg) | analytic",
        "constant | equal-angle (step = 6 deg) | triangle-rotary",
        "constant | equal-angle (step = 6 deg) | analytic",
        "atpg | equal-angle (step = 9 deg) | triangle-rotary",
        "atpg | equal-angle (step = 9 deg) | analytic",
        "atpg | equal-angle (step = 6 deg) | triangle-rotary",
        "atpg | equal-angle (step = 6 deg) | analytic",
    ];
    assert_eq!(varied(&bench), expected);
    let keys: Vec<String> = runs(&bench)[0]["varied"]
        .as_object()
        .unwrap()
        .keys()
        .cloned()
        .collect();
    assert_eq!(keys, ["feed", "sampler", "velocity"]);
    assert_eq!(records(&bench).len(), 8);
    let files = bench.files();
    let rest = files.iter().filter(|file| !file.starts_with("out/runs/"));
    let rest: Vec<&String> = rest.collect();
    assert_eq!(
        rest,
        [
            "out/ablation.csv",
            "out/ablation.json",
            "out/report.html",
            "recipe.toml"
        ]
    );
}

/// A term of a table of coefficients is a key like any other: of a surface alone, and of one in a sum.
#[test]
fn single_coefficients_of_a_table_can_vary() {
    let asphere =
        "use = \"even-asphere\"\nradius = \"50 mm\"\ncoefficients = { 4 = 1e-6, 6 = 2e-9 }";
    let zernike = "[[surface]]\nuse = \"conic\"\nradius = \"50 mm\"\n\n[[surface]]\nuse = \"zernike\"\n\
                   indexing = \"noll\"\nnormalization_radius = \"2.5 mm\"\n\
                   coefficients = { 5 = \"0.8 um\", 7 = \"0.35 um\" }\n\n[tool]";
    let asphere = with_table(SADDLE, "surface", asphere);
    let sum = changed(
        SADDLE,
        "[surface]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\n\n[tool]",
        zernike,
    );
    for (recipe, key, own, others) in [
        (&asphere, "surface.coefficients.4", "1e-6", ["2e-4", "0"]),
        (
            &sum,
            "surface.1.coefficients.7",
            "0.35 um",
            ["2 um", "0 um"],
        ),
    ] {
        let quoted = match own.contains(' ') {
            true => others.map(|value| format!("{value:?}")),
            false => others.map(str::to_owned),
        };
        let list = quoted.join(", ");
        let bench = Bench::with(&format!("{recipe}\n[ablation]\n{key} = [{list}]\n"));
        assert_eq!(headline(&ablate(&bench, "").ends(0)), "3 runs");
        let runs = runs(&bench);
        for (run, value) in runs.iter().zip([own, others[0], others[1]]) {
            let value = match own.contains(' ') {
                true => format!("{key}={value:?}"),
                false => format!("{key}={value}"),
            };
            let words = [
                "run",
                "recipe.toml",
                "-o",
                "one",
                "--format",
                "json",
                "--set",
                &value,
            ];
            let alone = bench.call(words.iter().chain(&["--set", "refine=false"]));
            let alone = alone.json();
            for figure in ["/surface_error/pv_nm", "/axes/z/max_velocity_mm_per_s"] {
                assert_eq!(
                    run.pointer(figure),
                    alone.pointer(figure),
                    "{value} {figure}"
                );
            }
        }
        let largest = |run: &Value| run["axes"]["z"]["max_velocity_mm_per_s"].clone();
        assert_ne!(largest(&runs[0]), largest(&runs[1]));
        assert_ne!(largest(&runs[0]), largest(&runs[2]));
    }
}

#[test]
fn one_at_a_time_makes_each_change_alone() {
    let recipe = changed(
        &eight(),
        "[ablation]",
        "[ablation]\nmode = \"one-at-a-time\"",
    );
    let bench = Bench::with(&changed(&recipe, "step = \"6 deg\"", "step = \"9 deg\""));
    assert_eq!(headline(&ablate(&bench, "").ends(0)), "3 runs");
    let expected = [
        "constant | equal-angle | triangle-rotary",
        "atpg | equal-angle | triangle-rotary",
        "constant | equal-angle | analytic",
    ];
    assert_eq!(varied(&bench), expected);
}

#[test]
fn a_run_is_what_run_gives_with_the_same_values_set() {
    let bench = Bench::with(&saddle(
        "tolerance.residual = [\"50 nm\"]\nvelocity = [{ use = \"linear\" }]",
    ));
    ablate(&bench, "").ends(0);
    let runs = runs(&bench);
    for (run, residual, velocity) in [
        (&runs[0], "100 nm", "triangle-rotary"),
        (&runs[1], "100 nm", "linear"),
        (&runs[3], "50 nm", "linear"),
    ] {
        let sets = [
            "refine=false".to_owned(),
            format!("tolerance.residual={residual}"),
            format!("velocity={{ use = \"{velocity}\" }}"),
        ];
        let mut args = vec!["run", "recipe.toml", "-o", "single", "--format", "json"];
        args.extend(sets.iter().flat_map(|set| ["--set", set]));
        let single: Value = bench.call(args).json();
        // The files are those of a run alone, and a key says what a run of an ablation was made of.
        let figures = single.as_object().unwrap().iter();
        let figures = figures.filter(|(key, _)| !["files", "recipe"].contains(&key.as_str()));
        for (key, value) in figures {
            assert_eq!(&run[key], value, "{velocity}: {key}");
        }
    }
}

#[test]
fn points_are_those_of_the_program_and_its_size_is_measured() {
    let recipe = changed(
        SADDLE,
        "[feed]",
        "[output]\nposts = [\"pmac-pvt\"]\n\n[feed]",
    );
    let recipe =
        format!("refine = true\n{recipe}\n[ablation]\nvelocity = [{{ use = \"linear\" }}]\n");
    let bench = Bench::with(&recipe);
    let said = ablate(&bench, "").ends(0);
    assert_eq!(headline(&said), "2 runs, 1 failed");
    let single = bench
        .line("run recipe.toml -o single --format json")
        .ends(0);
    let (single, runs) = (single.json(), runs(&bench));
    for key in ["control_points", "interpolation_error", "axes"] {
        assert_eq!(runs[0][key], single[key], "{key}");
    }
    assert!(single["points_added_by_refine"].as_u64().is_some());
    assert_eq!(runs[0]["refine"], true);
    let program = fs::metadata(bench.path("single/recipe.pmc")).unwrap().len();
    let lines = runs[0]["program_bytes"].as_u64().unwrap();
    // Header and footer of the program.
    assert!(
        lines < program && program < lines + 1000,
        "{lines}, {program}"
    );
    let error = runs[1]["error"].as_str().unwrap();
    assert!(error.contains("cannot carry this path"), "{error}");
    assert_eq!(runs[1]["chain"]["velocity"], "linear");
}

#[test]
fn a_failing_chain_is_a_row_with_its_reason() {
    let plugins = plugin_folder(&["panics", "constant-arc"]);
    let bench = Bench::with(&saddle(
        "sampler = [{ use = \"panics-in-call\" }, { use = \"constant-arc\", spacing = \"0.2 mm\" }]",
    ));
    let folder = plugins.path().to_str().unwrap();
    let call = ["ablate", "recipe.toml", "-o", "out", "--plugin-dir", folder];
    let said = bench.call(call).ends(0);
    assert_eq!(headline(&said), "3 runs, 1 failed");
    let row = |name: &str| {
        let mut lines = said.stdout.lines();
        lines
            .find(|line| line.starts_with(name))
            .unwrap()
            .to_owned()
    };
    assert!(
        row("panics-in-call").contains("failed: the sampler `panics-in-call`"),
        "{said}"
    );
    assert!(!row("constant-arc").contains("failed"), "{said}");
    let runs = runs(&bench);
    assert_eq!(runs[1]["chain"]["sampler"], "panics-in-call");
    assert!(runs[1]["error"].as_str().unwrap().contains("panicked"));
    assert_eq!(runs[1].as_object().unwrap().len(), 3);
    let hash = &runs[2]["plugins"].as_array().unwrap();
    assert!(hash.iter().any(|plugin| plugin["sha256"].is_string()));
    // A failure is not recorded, so the run is tried again.
    let said = bench.call(call).ends(0);
    assert_eq!(
        headline(&said),
        "3 runs, 2 taken over from before, 1 failed"
    );
}

#[test]
fn where_all_runs_fail_so_does_the_command() {
    let recipe = changed(SADDLE, "nose_radius = \"1 mm\"", "nose_radius = \"40 mm\"");
    let bench = Bench::with(&format!(
        "{recipe}[ablation]\ntool.nose_radius = [\"50 mm\"]\n"
    ));
    let said = ablate(&bench, "").ends(2);
    assert_eq!(headline(&said), "2 runs, 2 failed");
    assert!(said.stderr.contains("the tool would gouge"), "{said}");
    assert_eq!(runs(&bench).len(), 2);
}

#[test]
fn a_tolerance_that_does_not_hold_is_a_finding_not_a_failure() {
    let bench = Bench::with(&saddle("velocity = [{ use = \"three-point\" }]"));
    let said = ablate(&bench, "").ends(0);
    assert_eq!(runs(&bench)[1]["within"]["interpolation"], false);
    assert!(said.stdout.contains("! exceeds its tolerance"), "{said}");
}

/// The refusal comes before the work: every run would fail here and report it.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_records_is_refused_first() {
    let recipe = saddle("tool.nose_radius = [\"50 mm\"]");
    let recipe = changed(&recipe, "nose_radius = \"1 mm\"", "nose_radius = \"60 mm\"");
    let bench = Bench::with(&recipe);
    fs::create_dir(bench.path("out")).unwrap();
    std::os::unix::fs::symlink("/proc/self", bench.path("out/runs")).unwrap();
    let said = ablate(&bench, "").ends(4);
    assert!(said.stderr.contains("cannot write out/runs: "), "{said}");
    assert!(!said.stderr.contains("gouge"), "{said}");
}

#[test]
fn json_on_standard_output_is_the_file() {
    let bench = Bench::with(&saddle("velocity = [{ use = \"three-point\" }]"));
    let said = ablate(&bench, "--format json").ends(0);
    assert_eq!(said.stdout, bench.read("out/ablation.json"));
}

#[test]
fn any_number_of_threads_gives_the_same_files_but_for_times() {
    let with = |threads: &str| {
        let bench = Bench::with(&eight());
        ablate(&bench, &format!("--threads {threads}")).ends(0);
        let runs: Vec<Value> = runs(&bench).iter().map(without_times).collect();
        let records: Vec<String> = records(&bench).into_keys().collect();
        (runs, records)
    };
    assert_eq!(with("1"), with("3"));
}

#[test]
fn the_folder_is_named_after_the_job() {
    let bench = Bench::with(&saddle("velocity = [{ use = \"area\" }]"));
    bench.line("ablate recipe.toml").ends(0);
    assert!(bench.path("out/Saddle-ablation/ablation.json").is_file());
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_the_work() {
    let bench = Bench::with(&eight());
    bench.line("ablate recipe.toml -o recipe.toml").ends(4);
    fs::create_dir_all(bench.path("out")).unwrap();
    bench.write("out/runs", "a file");
    let said = ablate(&bench, "").ends(4);
    assert!(said.stderr.contains("out/runs"), "{said}");
    fs::create_dir_all(bench.path("other/ablation.csv")).unwrap();
    let said = bench.line("ablate recipe.toml -o other").ends(4);
    assert!(said.stderr.contains("it is a folder"), "{said}");
    assert_eq!(said.stdout, "");
}

#[test]
fn a_mistake_in_a_list_is_shown_there_before_the_work() {
    let bench = Bench::with(&saddle(
        "sampler = [{ use = \"equal-angel\" }, { use = \"equal-angle\", step = \"6 mm\" }]\n\
         feed.fed = [\"1 um\"]",
    ));
    let said = ablate(&bench, "").ends(2);
    insta::assert_snapshot!("wrong_strategies", bench.shown(&said));
    let bench = Bench::with(&saddle("tolerance.residual = [\"50 nm\", \"5 s\"]"));
    let said = ablate(&bench, "").ends(2);
    insta::assert_snapshot!("wrong_value", bench.shown(&said));
    let bench = Bench::with(SADDLE);
    let said = ablate(&bench, "").ends(2);
    insta::assert_snapshot!("no_ablation", bench.shown(&said));
    assert_eq!(bench.files(), ["recipe.toml"]);
}

/// Every spindle strategy is a row with its own time, that of a run of its own.
#[test]
fn spindles_are_compared_by_their_times() {
    let spindles = [
        "{ use = \"per-revolution\" }",
        "{ use = \"surface-speed\", cutting_speed = \"20 mm/s\" }",
    ];
    let machine =
        "[machine]\nz_acceleration = \"300 mm/s^2\"\nc_acceleration = \"100 rad/s^2\"\n\n[path]";
    let recipe = changed(SADDLE, "[path]", machine);
    let lists = format!("[ablation]\nspindle = [{}]\n", spindles.join(", "));
    let bench = Bench::with(&format!("{recipe}\n{lists}"));
    let said = ablate(&bench, "--columns points,time,spindle-max").ends(0);
    for name in ["constant", "per-revolution", "surface-speed", "time"] {
        assert!(said.stdout.contains(name), "no {name}: {said}");
    }
    let times = |runs: &[Value]| -> Vec<f64> {
        let times = runs.iter().map(|run| run["cutting_time_s"].as_f64());
        times.map(Option::unwrap).collect()
    };
    let found = times(&runs(&bench));
    let alone = ["{ use = \"constant\" }", spindles[0], spindles[1]].map(|spindle| {
        let spindle = spindle.replace(" }", ", speed = \"500 rpm\" }");
        let set = format!("spindle={spindle}");
        let args = [
            "run",
            "recipe.toml",
            "--format",
            "json",
            "--set",
            "refine=false",
        ];
        let said = bench.call(args.into_iter().chain(["--set", &set]));
        said.json()
    });
    assert_eq!(found, times(&alone));
    // The rim's 300 mm/s² allow 165 rpm and 26 mm/s.
    assert!(found[0] < found[1] && found[1] < found[2], "{found:?}");
    let shown = |time: &f64| said.stdout.contains(&format!("{time:.2}"));
    assert!(found[1..].iter().all(shown), "{found:?}\n{said}");
}
