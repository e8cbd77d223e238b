//! `turnpath ablate docs/recipes/ablation-papers*.toml` as a user tries it: the papers' strategies
//! beside a lab's own sampler from a folder, on parts that are made smaller.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use crate::support::bench::{Answer, Bench};
use crate::support::fixtures::plugin_folder;
use crate::support::repository;
use serde_json::Value;

const FEEDS: [&str; 4] = ["atpg", "constant", "ats", "fft-adaptive"];
const SAMPLERS: [&str; 4] = ["atpg", "constant-arc", "ats", "fft-adaptive"];
const VELOCITIES: [&str; 2] = ["analytic", "triangle-rotary"];

/// All feeds of the recipe; of the samplers the lab's own among the papers'.
fn ablate(bench: &Bench, recipe: &str, aperture: &str, plugins: &Path) -> Answer {
    let recipes = repository().join("docs/recipes");
    let sets = [
        &format!("part.aperture={aperture}"),
        "ablation.sampler=[{ use = \"constant-arc\", spacing = \"0.2 mm\" }, { use = \"ats\" }, \
         { use = \"fft-adaptive\" }]",
        "ablation.velocity=[{ use = \"triangle-rotary\" }]",
    ];
    let recipe = recipes.join(recipe);
    let fixed = ["ablate", recipe.to_str().unwrap(), "-o", "out"];
    let folder = ["--plugin-dir", plugins.to_str().unwrap()];
    let set = sets.into_iter().flat_map(|set| ["--set", set]);
    bench.call(fixed.into_iter().chain(folder).chain(set))
}

fn runs(bench: &Bench) -> Vec<Value> {
    let text = bench.read("out/ablation.json");
    let all: Value = serde_json::from_str(&text).unwrap();
    all["runs"].as_array().unwrap().clone()
}

/// Feed, sampler and velocity solver of a run.
fn chain(run: &Value) -> [String; 3] {
    ["feed", "sampler", "velocity"].map(|slot| run["chain"][slot].as_str().unwrap().to_owned())
}

/// Whether the run has a plugin from a folder, which it reports with its hash.
fn has_loaded_plugin(run: &Value) -> bool {
    let plugins = run["plugins"].as_array().unwrap();
    plugins.iter().any(|plugin| plugin["sha256"].is_string())
}

fn number(run: &Value, pointer: &str) -> f64 {
    run.pointer(pointer).and_then(Value::as_f64).unwrap()
}

/// Every chain is there and gives a path that is measured.
fn assert_all_chains(runs: &[Value]) {
    let found: BTreeSet<[String; 3]> = runs.iter().map(chain).collect();
    let expected = FEEDS.iter().flat_map(|feed| {
        let rest = SAMPLERS.iter();
        rest.flat_map(move |sampler| VELOCITIES.map(|velocity| [*feed, *sampler, velocity]))
    });
    let expected: BTreeSet<[String; 3]> = expected.map(|chain| chain.map(str::to_owned)).collect();
    assert_eq!((runs.len(), found), (32, expected));
    for run in runs {
        let [feed, sampler, velocity] = chain(run);
        let what = format!("{feed}, {sampler}, {velocity}");
        assert!(run.get("error").is_none(), "{what}: {run}");
        assert_eq!(has_loaded_plugin(run), sampler == "constant-arc", "{what}");
        assert!(number(run, "/control_points") > 100.0, "{what}");
        // The samplers that predict the error of cubics hold it, with exact rates.
        if velocity == "analytic" && sampler != "constant-arc" {
            assert_eq!(run["within"]["interpolation"], true, "{what}");
        }
        // Where X moves within the turn, a sampler that does not look at X may lose the distance
        // of passes.
        if feed != "ats" || sampler == "ats" && velocity == "analytic" {
            assert_eq!(run["within"]["residual"], true, "{what}");
        }
    }
}

/// The part on which every run of the tests compares all strategies, and its size: a lens as far as its flanks,
/// where its curvature changes its sign.
const LENS_ARRAY: (&str, &str) = ("ablation-papers-mla-5.toml", "1.6 mm");

/// The ablation of the lens array and its answer, made once for all tests.
fn lens_array() -> &'static (Bench, Answer) {
    static LENS_ARRAY_RUNS: OnceLock<(Bench, Answer)> = OnceLock::new();
    LENS_ARRAY_RUNS.get_or_init(|| {
        let (bench, plugins) = (Bench::empty(), plugin_folder(&["constant-arc"]));
        let answer = ablate(&bench, LENS_ARRAY.0, LENS_ARRAY.1, plugins.path());
        (bench, answer.ends(0))
    })
}

/// The table has all chains within its width, and a second call makes no run again.
fn assert_whole(bench: &Bench, answer: &Answer, (recipe, aperture): (&str, &str)) {
    let headline = answer.stdout.lines().next().unwrap();
    assert!(headline.ends_with(": 32 runs"), "{answer}");
    let width = answer.stdout.lines().map(|line| line.chars().count()).max();
    assert!(width <= Some(100), "{answer}");
    let row = |line: &str| line.trim_start().starts_with("atpg, constant-arc");
    assert!(answer.stdout.lines().any(row), "{answer}");
    assert_all_chains(&runs(bench));
    let plugins = plugin_folder(&["constant-arc"]);
    let again = ablate(bench, recipe, aperture, plugins.path()).ends(0);
    let reused = "32 taken over from before";
    assert!(again.stdout.contains(reused), "{again}");
}

#[test]
fn the_papers_strategies_stand_beside_a_labs_own_sampler() {
    let (bench, answer) = lens_array();
    assert_whole(bench, answer, LENS_ARRAY);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_papers_strategies_stand_beside_a_labs_own_sampler_on_the_saddle() {
    let (bench, plugins) = (Bench::empty(), plugin_folder(&["constant-arc"]));
    let saddle = ("ablation-papers.toml", "4 mm");
    let answer = ablate(&bench, saddle.0, saddle.1, plugins.path()).ends(0);
    assert_whole(&bench, &answer, saddle);
}

/// On a lattice of lenslets ATS differs from the other feeds in the acceleration of X.
#[test]
fn ats_pays_with_the_acceleration_of_x() {
    let runs = runs(&lens_array().0);
    let of = |feed: &str| {
        let wanted = [feed, feed, "analytic"].map(str::to_owned);
        let run = runs.iter().find(|run| chain(run) == wanted).unwrap();
        number(run, "/axes/x/rms_acceleration_mm_per_s2")
    };
    assert!(of("ats") > 100.0 * of("atpg"), "{}", of("ats"));
    assert!(of("ats") > 100.0 * of("fft-adaptive"), "{}", of("ats"));
}
