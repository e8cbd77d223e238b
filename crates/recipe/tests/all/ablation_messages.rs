//! What the user sees for each kind of wrong `[ablation]`, as snapshots.

#![allow(clippy::unwrap_used, reason = "an unwrap in a helper is a failed test")]

use crate::common::FULL;
use turnpath_recipe::Recipe;

/// The message for other lines below `[ablation]`.
fn message(lines: &str) -> String {
    let (before, _) = FULL.split_once("[ablation]").unwrap();
    let recipe = Recipe::parse(&format!("{before}{lines}\n"), "jobs/mirror.toml", &[]).unwrap();
    recipe.variants().unwrap_err().render(false)
}

macro_rules! says {
    ($($name:ident: $lines:expr;)*) => {$(
        #[test]
        fn $name() {
            insta::assert_snapshot!(message(&format!("[ablation]\n{}", $lines)));
        }
    )*};
}

says! {
    mode_unknown: "mode = \"all-pair\"\nrefine = [true]";
    nothing_to_vary: "mode = \"all-pairs\"";
    list_empty: "feed = []";
    one_key_by_two_names: "surface.k = [\"0.1 /mm\"]\nsurface.0.k = [\"0.2 /mm\"]";
    list_missing: "tolerance.residual = \"50 nm\"";
    strategy_without_list: "velocity = { use = \"area\" }";
    strategies_as_text: "velocity = [\"area\", { use = \"linear\" }]";
    strategy_without_name: "velocity = [{ c = 0.5 }]";
    table_unknown: "tolerances.residual = [\"50 nm\"]";
    key_unknown: "tolerance.residal = [\"50 nm\"]";
    key_without_its_table: "residual = [\"50 nm\"]";
    table_without_its_key: "tolerance = [{ residual = \"50 nm\", interpolation = \"5 nm\" }]";
    slot_misspelt: "samplers = [{ use = \"atpg\" }]";
    output_cannot_vary: "output.data = [[\"csv\"], []]";
    name_cannot_vary: "name = [\"a\", \"b\"]";
    key_below_a_value: "sampler.max_step.a = [1]";
    key_of_the_spindle_unknown: "spindle.sped = [\"50 rpm\"]";
    value_of_another_kind: "tolerance.residual = [\"50 nm\", \"5 s\"]\nrefine = [true, false]";
    values_that_contradict_each_other: "part.inner = [\"2 mm\", \"3 mm\"]\npart.aperture = [\"2.5 mm\"]";
    several_mistakes: "mode = \"each\"\nfeed = []\ntolerance.residul = [\"50 nm\"]";
}

#[test]
fn no_table() {
    insta::assert_snapshot!(message(""));
}
