//! Orders, labels and values of variants.

use turnpath_core::Slot;

use super::*;

const BASE: &str = r#"format = 1
[part]
aperture = "5 mm"
[surface]
use = "astigmatic"
k = "0.08 /mm"
[tool]
nose_radius = "1 mm"
[tolerance]
interpolation = "100 nm"
residual = "100 nm"
[spindle]
speed = "500 rpm"
[path]
overrun = "none"
lead = false
[feed]
use = "atpg"
[sampler]
use = "atpg"
max_step = "45 deg"
[compensator]
use = "z-direction"
[velocity]
use = "triangle-rotary"
"#;

fn variants_of(ablation: &str) -> Vec<Variant> {
    let text = format!("{BASE}[ablation]\n{ablation}\n");
    let recipe = Recipe::parse(&text, "mirror.toml", &[]).unwrap();
    recipe
        .variants()
        .unwrap_or_else(|error| panic!("{}", error.render(false)))
}

fn labels(variants: &[Variant]) -> Vec<String> {
    let one = |variant: &Variant| {
        let values = variant.variations.iter().map(|one| one.value.as_str());
        values.collect::<Vec<_>>().join(" | ")
    };
    variants.iter().map(one).collect()
}

#[test]
fn the_product_begins_with_the_recipe_and_its_last_list_varies_fastest() {
    let variants = variants_of(
        "feed = [{ use = \"constant\" }]\ntolerance.residual = [\"50 nm\", \"100 nm\", \"20 nm\"]",
    );
    let expected = [
        "atpg | 100 nm",
        "atpg | 50 nm",
        "atpg | 20 nm",
        "constant | 100 nm",
        "constant | 50 nm",
        "constant | 20 nm",
    ];
    assert_eq!(labels(&variants), expected);
    assert_eq!(variants[4].recipe.choice(Slot::Feed).name(), "constant");
    assert!((variants[4].recipe.tolerance.residual - 50e-6).abs() < 1e-18);
    let keys: Vec<&str> = variants[0]
        .variations
        .iter()
        .map(|one| one.key.as_str())
        .collect();
    assert_eq!(keys, ["feed", "tolerance.residual"]);
}

#[test]
fn one_at_a_time_changes_one_value_of_the_recipe_each() {
    let variants = variants_of(
        "mode = \"one-at-a-time\"\nfeed = [{ use = \"constant\" }]\nvelocity = [{ use = \"area\" }, \
         { use = \"linear\" }]",
    );
    let expected = [
        "atpg | triangle-rotary",
        "constant | triangle-rotary",
        "atpg | area",
        "atpg | linear",
    ];
    assert_eq!(labels(&variants), expected);
}

#[test]
fn lists_keep_the_order_of_the_text_whatever_their_tables() {
    let variants = variants_of(
        "tolerance.residual = [\"50 nm\"]\nfeed = [{ use = \"constant\" }]\n\
         tolerance.interpolation = [\"10 nm\"]",
    );
    let keys: Vec<&str> = variants[0]
        .variations
        .iter()
        .map(|one| one.key.as_str())
        .collect();
    assert_eq!(
        keys,
        ["tolerance.residual", "feed", "tolerance.interpolation"]
    );
}

#[test]
fn a_strategy_takes_the_whole_table_and_a_key_keeps_the_rest() {
    let variants = variants_of("sampler = [{ use = \"equal-angle\", step = \"6 deg\" }]");
    let sampler = variants[1].recipe.choice(Slot::Sampler);
    assert!(sampler.param("step").is_some() && sampler.param("max_step").is_none());
    let variants = variants_of("sampler.max_step = [\"90 deg\"]\nsurface.k = [\"0.04 /mm\"]");
    let sampler = variants[3].recipe.choice(Slot::Sampler);
    assert_eq!((sampler.name(), sampler.params.len()), ("atpg", 1));
    assert_eq!(labels(&variants)[3], "90 deg | 0.04 /mm");
}

#[test]
fn parameters_are_shown_where_several_values_have_one_name() {
    let variants = variants_of(
        "sampler = [{ use = \"atpg\", max_step = \"9 deg\" }, { use = \"equal-angle\", step = \"6 \
         deg\" }]",
    );
    let expected = [
        "atpg (max_step = 45 deg)",
        "atpg (max_step = 9 deg)",
        "equal-angle",
    ];
    assert_eq!(labels(&variants), expected);
}

#[test]
fn a_value_of_the_recipe_is_not_repeated_whatever_the_order_of_its_keys() {
    let variants = variants_of(
        "sampler = [{ max_step = \"45 deg\", use = \"atpg\" }, { use = \"ats\" }, { use = \"ats\" }]",
    );
    assert_eq!(labels(&variants), ["atpg", "ats"]);
}

#[test]
fn a_spindle_without_a_speed_takes_the_recipes() {
    let variants = variants_of(
        "spindle = [{ use = \"per-revolution\" }, { use = \"constant\" }, \
         { use = \"surface-speed\", speed = \"900 rpm\" }]",
    );
    assert_eq!(
        labels(&variants),
        ["constant", "per-revolution", "surface-speed"]
    );
    let rpm =
        |variant: &Variant| (variant.recipe.spindle_speed * 30.0 / std::f64::consts::PI).round();
    let speeds: Vec<f64> = variants.iter().map(rpm).collect();
    assert_eq!(speeds, [500.0, 500.0, 900.0]);
    let variants = variants_of("spindle.speed = [\"400 rpm\"]");
    assert_eq!(labels(&variants), ["500 rpm", "400 rpm"]);
}

#[test]
fn refine_is_off_unless_the_recipe_gives_it() {
    let variants = variants_of("velocity = [{ use = \"area\" }]");
    assert!(variants.iter().all(|variant| !variant.recipe.refine));
    let variants = variants_of("refine = [true, false]");
    assert_eq!(labels(&variants), ["false", "true"]);
    let text = format!("refine = true\n{BASE}[ablation]\nvelocity = [{{ use = \"area\" }}]\n");
    let variants = Recipe::parse(&text, "m.toml", &[]).unwrap().variants();
    assert!(
        variants
            .unwrap()
            .iter()
            .all(|variant| variant.recipe.refine)
    );
}

#[test]
fn a_key_that_the_recipe_leaves_out_is_a_default_first() {
    let variants = variants_of("path.direction = [\"outward\"]");
    assert_eq!(labels(&variants), ["(default)", "outward"]);
}

#[test]
fn a_set_adds_a_list() {
    let sets = ["ablation.tolerance.residual=[\"50 nm\"]".to_owned()];
    let recipe = Recipe::parse(BASE, "mirror.toml", &sets).unwrap();
    assert_eq!(labels(&recipe.variants().unwrap()), ["100 nm", "50 nm"]);
}

#[test]
fn a_million_runs_are_refused() {
    let values: Vec<String> = (1..100).map(|i| format!("\"{i} nm\"")).collect();
    let list = values.join(", ");
    let text = format!(
        "{BASE}[ablation]\ntolerance.residual = [{list}]\ntolerance.interpolation = [{list}]\n"
    );
    let recipe = Recipe::parse(&text, "mirror.toml", &[]).unwrap();
    let said = recipe.variants().unwrap_err().render(false);
    assert!(said.contains("more than 4096 runs"), "{said}");
}

#[test]
fn an_inner_list_is_a_sum() {
    let variants = variants_of(
        "surface = [[{ use = \"conic\" }, { use = \"zernike\" }], { use = \"conic\" }, \
         [{ use = \"conic\" }]]",
    );
    let expected = ["astigmatic", "conic + zernike", "conic"];
    assert_eq!(labels(&variants), expected);
    assert_eq!(variants[1].recipe.surface_name(), "conic + zernike");
    assert_eq!(variants[2].recipe.surface_name(), "conic");
}

#[test]
fn sums_of_one_name_have_their_parameters() {
    let variants = variants_of(
        "surface = [[{ use = \"conic\", scale = 2 }, { use = \"toric\" }], \
         [{ use = \"conic\" }, { use = \"toric\", scale = 3 }]]",
    );
    let expected = [
        "astigmatic",
        "conic (scale = 2) + toric",
        "conic + toric (scale = 3)",
    ];
    assert_eq!(labels(&variants), expected);
}

#[test]
fn keys_of_one_surface_and_of_the_pose_vary() {
    let surfaces = "[[surface]]\nuse = \"conic\"\nradius = \"1 m\"\n[[surface]]\nuse = \"toric\"\n";
    let single = "[surface]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\n";
    let text = BASE.replacen(single, surfaces, 1)
        + "[ablation]\nsurface.0.radius = [\"2 m\"]\nsurface.1 = [{ use = \"flat\" }]\n\
           part.pose.x = [\"3 mm\"]\n";
    let recipe = Recipe::parse(&text, "mirror.toml", &[]).unwrap();
    let variants = recipe.variants().unwrap();
    assert_eq!(variants.len(), 8);
    let keys = variants[0].variations.iter().map(|one| one.key.as_str());
    let expected = ["surface.0.radius", "surface.1", "part.pose.x"];
    assert_eq!(keys.collect::<Vec<_>>(), expected);
    let labels = labels(&variants);
    assert_eq!(labels[0], "1 m | toric | (default)");
    assert_eq!(labels[7], "2 m | flat | 3 mm");
    assert_eq!(variants[7].recipe.surface_name(), "conic + flat");
    assert_eq!(variants[7].recipe.pose.map(|pose| pose.x), Some(3.0));
}
