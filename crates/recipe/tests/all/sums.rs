//! Several surfaces in one recipe, and the pose of the part.

#![allow(clippy::unwrap_used, reason = "an unwrap in a helper is a failed test")]

use std::f64::consts::PI;

use crate::common::FULL;
use turnpath_core::{Attitude, DEG, Placement, Pose, Slot};
use turnpath_recipe::{Choice, Recipe};

const SURFACE: &str = "[surface]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\n";

const SUM: &str = r#"[part.pose]
x = "40 mm"
y = "-3 mm"
level = true

[[surface]]
use = "conic"
radius = "600 mm"

[[surface]]
use = "zernike"
radius = "30 mm"
scale = -0.5
decentre_x = "1 mm"
decentre_y = "-2 um"
clocking = "90 deg"
piston = "3 nm"
"#;

fn sum() -> String {
    FULL.replacen(SURFACE, SUM, 1)
}

fn parse(text: &str, sets: &[&str]) -> Recipe {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Recipe::parse(text, "jobs/mirror.toml", &sets).unwrap()
}

fn message(text: &str, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let error = Recipe::parse(text, "jobs/mirror.toml", &sets).unwrap_err();
    error.render(false)
}

fn with(old: &str, new: &str) -> String {
    let text = sum();
    assert!(text.contains(old), "{old}");
    message(&text.replacen(old, new, 1), &[])
}

/// The text of a parameter of a surface.
fn param(recipe: &Recipe, at: usize, name: &str) -> String {
    let span = recipe.surfaces[at].choice.param_span(name);
    span.source().text[span.range()].to_owned()
}

#[test]
fn a_sum_has_its_surfaces_in_the_order_of_the_text() {
    let recipe = parse(&sum(), &[]);
    assert_eq!(recipe.surface_name(), "conic + zernike");
    let paths: Vec<&str> = recipe
        .surfaces
        .iter()
        .map(|one| &*one.choice.path)
        .collect();
    assert_eq!(paths, ["surface.0", "surface.1"]);
    let choices = recipe.choices(Slot::Surface);
    assert_eq!(
        choices.iter().map(|one| one.name()).collect::<Vec<_>>(),
        ["conic", "zernike"]
    );
    assert!(recipe.surfaces[0].placement.is_plain());
    let placement = Placement {
        scale: -0.5,
        decentre_x: 1.0,
        decentre_y: -0.002,
        clocking: 0.5 * PI,
        piston: 3e-6,
    };
    assert_eq!(recipe.surfaces[1].placement, placement);
    // What belongs to the host is no parameter of the strategy.
    let params = &recipe.surfaces[1].choice.params;
    assert_eq!(
        params.iter().map(|one| &*one.key).collect::<Vec<_>>(),
        ["radius"]
    );
}

#[test]
fn a_table_is_a_sum_of_one() {
    let alone = parse(FULL, &[]);
    let listed = FULL.replacen("[surface]", "[[surface]]", 1);
    let listed = parse(&listed, &[]);
    for recipe in [&alone, &listed] {
        let [only] = &recipe.surfaces[..] else {
            panic!("one surface");
        };
        assert_eq!(only.choice.path, "surface");
        assert!(only.placement.is_plain() && recipe.pose.is_none());
        for key in ["surface.k", "surface.0.k"] {
            let span = recipe.span(key).unwrap();
            assert_eq!(&span.source().text[span.range()], "\"0.08 /mm\"");
        }
        for set in ["surface.k=1 /mm", "surface.0.k=1 /mm"] {
            let changed = recipe
                .clone()
                .set(set.split_once('=').unwrap().0, "1 /mm")
                .unwrap();
            assert_eq!(param(&changed, 0, "k"), "1 /mm");
        }
    }
}

#[test]
fn set_changes_one_surface_of_a_sum() {
    let recipe = parse(&sum(), &["surface.1.radius=20 mm", "surface.0.piston=1 um"]);
    assert_eq!(param(&recipe, 0, "radius"), "\"600 mm\"");
    assert_eq!(param(&recipe, 1, "radius"), "20 mm");
    assert_eq!(recipe.surfaces[0].placement.piston, 1e-3);
    let replaced = parse(&sum(), &["surface.0={ use = \"toric\" }"]);
    assert_eq!(replaced.surface_name(), "toric + zernike");
    let single = parse(&sum(), &["surface={ use = \"toric\" }"]);
    assert_eq!(single.surface_name(), "toric");
    let listed = parse(FULL, &["surface=[{ use = \"a\" }, { use = \"b\" }]"]);
    assert_eq!(listed.surface_name(), "a + b");
}

#[test]
fn a_pose_is_level_or_tilted() {
    let level = Pose {
        x: 40.0,
        y: -3.0,
        attitude: Attitude::Level,
    };
    assert_eq!(parse(&sum(), &[]).pose, Some(level));
    let tilted = parse(FULL, &["part.pose.tilt_y=-2 deg"]).pose;
    let attitude = Attitude::Tilted {
        tilt_x: 0.0,
        tilt_y: -2.0 * DEG,
    };
    let (x, y) = (0.0, 0.0);
    assert_eq!(tilted, Some(Pose { x, y, attitude }));
}

macro_rules! says {
    ($($name:ident: $old:expr => $new:expr;)*) => {$(
        #[test]
        fn $name() {
            insta::assert_snapshot!(with($old, $new));
        }
    )*};
}

says! {
    second_without_use: "use = \"zernike\"\n" => "";
    second_with_a_number_for_a_name: "use = \"zernike\"" => "use = 4";
    scale_with_a_unit: "scale = -0.5" => "scale = \"2 mm\"";
    scale_zero: "scale = -0.5" => "scale = 0";
    decentre_as_angle: "decentre_x = \"1 mm\"" => "decentre_x = \"1 deg\"";
    pose_with_level_and_tilt: "level = true" => "level = true\ntilt_x = \"1 deg\"";
    pose_tilted_too_far: "level = true" => "tilt_x = \"85 deg\"";
    pose_key_misspelt: "level" => "levle";
}

#[test]
fn pose_as_word() {
    insta::assert_snapshot!(message(FULL, &["part.pose=level"]));
}

#[test]
fn set_that_says_not_which_surface() {
    insta::assert_snapshot!(message(&sum(), &["surface.radius=20 mm"]));
}

#[test]
fn set_of_a_surface_that_is_not_there() {
    insta::assert_snapshot!(message(&sum(), &["surface.2.radius=20 mm"]));
    insta::assert_snapshot!(message(FULL, &["surface.1={ use = \"conic\" }"]));
}

#[test]
fn lists_of_surfaces_that_are_none() {
    insta::assert_snapshot!(message(FULL, &["surface=[]"]));
    insta::assert_snapshot!(message(FULL, &["surface=[{ use = \"conic\" }, \"conic\"]"]));
}

#[test]
fn parameters_of_the_second_surface() {
    use turnpath_core::{Param, ParamInfo, StrategyInfo, kind::Length};
    const SIZE: Param<Length> = Param::length("size", "how large it is").example("5 mm");
    const PARAMS: &[ParamInfo] = &[SIZE.info()];
    let info = StrategyInfo {
        slot: Slot::Surface,
        name: "zernike",
        summary: "",
        source: "",
        params: PARAMS,
    };
    let recipe = parse(&sum().replacen("scale", "scael", 1), &[]);
    let wrong = |choice: &Choice| choice.bind(&info).unwrap_err().render(false);
    insta::assert_snapshot!(wrong(&recipe.surfaces[1].choice));
}

#[test]
fn ablation_of_a_key_that_says_not_which_surface() {
    let (before, _) = FULL.split_once("[ablation]").unwrap();
    let text = before.replacen(SURFACE, SUM, 1) + "[ablation]\nsurface.radius = [\"1 mm\"]\n";
    let error = parse(&text, &[]).variants().unwrap_err();
    insta::assert_snapshot!(error.render(false));
}

#[test]
fn ablation_of_the_pose_with_an_unknown_key() {
    let (before, _) = FULL.split_once("[ablation]").unwrap();
    let text = format!("{before}[ablation]\npart.pose.z = [\"1 mm\"]\n");
    insta::assert_snapshot!(parse(&text, &[]).variants().unwrap_err().render(false));
}

#[test]
fn ablation_with_an_empty_sum() {
    let (before, _) = FULL.split_once("[ablation]").unwrap();
    let text = format!("{before}[ablation]\nsurface = [[]]\n");
    insta::assert_snapshot!(parse(&text, &[]).variants().unwrap_err().render(false));
}
