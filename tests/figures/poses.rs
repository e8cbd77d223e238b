//! A part on a sum of surfaces, against the same part in closed form.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Bench, answer};
use crate::support::fixtures::plugin_folder;
use crate::support::recipe::changed;
use crate::support::repository;

/// Largest difference of a column, in its unit. The last digits of positions are 0.1 pm; the rates
/// are those of 500 rpm.
const POSITION: f64 = 1e-9;
const RATE: f64 = 1e-6;

const CLOSED: &str = "[surface]\nuse = \"off-axis-paraboloid\"\nvertex_radius = \"915 mm\"\n\
                      off_axis_distance = \"915 mm\"\n";

/// The parent as a sum of two, with the part on it.
const POSED: &str = r#"[part.pose]
x = "915 mm"
level = true

[[surface]]
use = "conic"
radius = "915 mm"
conic = -1
scale = 1.25

[[surface]]
use = "conic"
radius = "915 mm"
conic = -1
scale = -0.25
clocking = "30 deg"
piston = "5 um"
"#;

fn rows(bench: &Bench) -> Vec<Vec<f64>> {
    let text = bench.read("out/toolpath.csv");
    let lines = text.lines().filter(|line| !line.starts_with(['#', 't']));
    let row = |line: &str| {
        let numbers = line.split(',').map(|one| one.parse().expect("a number"));
        numbers.collect()
    };
    lines.map(row).collect()
}

#[test]
fn a_parent_laid_level_is_cut_like_the_off_axis_paraboloid() {
    let recipe = repository().join("docs/recipes/off-axis-paraboloid-50mm.toml");
    let closed = fs::read_to_string(recipe).expect("the recipe");
    let (closed, posed) = (closed.clone(), changed(&closed, CLOSED, POSED));
    let [closed, posed] = [closed, posed].map(|recipe| {
        let bench = Bench::with(&recipe);
        bench.line("run recipe.toml -o out").ends(0);
        rows(&bench)
    });
    assert_eq!(closed.len(), posed.len());
    for (closed, posed) in closed.iter().zip(&posed) {
        assert_eq!(closed.len(), 8);
        for (i, (closed, posed)) in closed.iter().zip(posed).enumerate() {
            let most = if (4..7).contains(&i) { RATE } else { POSITION };
            assert!((closed - posed).abs() <= most, "{i}: {closed} {posed}");
        }
    }
}

#[test]
fn a_labs_own_surface_in_a_sum_with_a_pose_runs_and_holds() {
    let recipe = repository().join("tests/reference/playback/sums/level-sum.toml");
    let recipe = fs::read_to_string(recipe).expect("the recipe");
    let conic = "use = \"conic\"\nradius = \"150 mm\"\n";
    let rippled = "use = \"rippled-conic\"\nradius = \"150 mm\"\nscale = 0.2\n";
    let recipe = changed(&recipe, conic, rippled);
    // A small part: the whole one stands among the references, with built-in surfaces.
    let recipe = changed(&recipe, "aperture = \"12 mm\"", "aperture = \"2 mm\"");
    let plugins = plugin_folder(&["builds-on"]);
    let bench = Bench::with(&recipe);
    let call = |words: &str| {
        let mut command = bench.command(words.split_whitespace());
        answer(command.arg("--plugin-dir").arg(plugins.path())).ends(0)
    };
    let said = call("run recipe.toml -o out");
    let chain = "rippled-conic + astigmatic + sinusoidal-array > atpg";
    assert!(said.stdout.contains(chain), "{said}");
    call("verify recipe.toml out/toolpath.csv");
    call("verify recipe.toml out/recipe.pmc");
}
