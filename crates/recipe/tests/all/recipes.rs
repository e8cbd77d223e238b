//! Recipes that are right: every value is read and keeps its span, and `--set` is applied.

#![allow(clippy::unwrap_used, reason = "an unwrap in a helper is a failed test")]

use std::f64::consts::TAU;

use crate::common::FULL;
use turnpath_core::kind::{
    Angle, Choice, Coefficients, Constants, Count, File, Flag, Number, Rows,
};
use turnpath_core::{
    DEG, Direction, Machine, Misfit, Overrun, Param, ParamInfo, ParamValue, Slot, StrategyInfo,
};
use turnpath_post::post_named;
use turnpath_recipe::{DataFormat, FileProblem, Recipe, RecipeError, ZReference};

fn parse(text: &str, sets: &[&str]) -> Recipe {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    match Recipe::parse(text, "jobs/mirror.toml", &sets) {
        Ok(recipe) => recipe,
        Err(error) => panic!("{}", error.render(false)),
    }
}

fn underlined(recipe: &Recipe, path: &str) -> String {
    let span = recipe.span(path).unwrap();
    span.source().text[span.range()].to_owned()
}

fn with_machine(lines: &str) -> Recipe {
    parse(&format!("{FULL}\n[machine]\n{lines}\n"), &[])
}

#[test]
fn a_machine_is_a_preset_its_own_limits_or_both() {
    let without = parse(FULL, &[]);
    assert_eq!(
        (without.machine, without.preset),
        (Machine::default(), None)
    );

    let preset = with_machine("preset = \"generic-sts\"");
    assert_eq!(preset.preset.map(|preset| preset.name), Some("generic-sts"));
    assert_eq!(preset.machine.z.acceleration, Some(500.0));
    assert_eq!(preset.machine.x, without.machine.x);

    let own = with_machine(
        "x_velocity = \"3 m/min\"\nx_acceleration = \"0.5 m/s²\"\nx_jerk = \"20 m/s^3\"\n\
         c_velocity = \"1000 rpm\"\nc_acceleration = \"600 rpm/s\"\nc_jerk = \"9 rad/s^3\"",
    );
    let (x, c) = (own.machine.x, own.machine.c);
    assert_eq!(x.velocity, Some(50.0));
    assert_eq!((x.acceleration, x.jerk), (Some(500.0), Some(20e3)));
    assert_eq!(c.velocity, Some(1000.0 * TAU / 60.0));
    assert_eq!(
        (c.acceleration, c.jerk),
        (Some(600.0 * TAU / 60.0), Some(9.0))
    );
    assert_eq!((own.machine.z, own.preset), (without.machine.z, None));

    let both = with_machine("preset = \"generic-sts\"\nz_velocity = \"10 mm/s\"");
    assert_eq!(both.machine.z.velocity, Some(10.0));
    assert_eq!(both.machine.z.jerk, preset.machine.z.jerk);
    assert_eq!(both.preset, preset.preset);
}

/// 2/3 of a form for cusps and 1/6 for the interpolation error; a bound beside the form cuts its
/// share, and the other one takes the rest.
#[test]
fn a_form_stands_for_the_tolerances_that_it_leaves_out() {
    let split = |tolerance: &str| {
        let recipe = parse(FULL, &[&format!("tolerance={{ {tolerance} }}")]);
        let nm = |mm: f64| (mm * 1e6 * 1e3).round() / 1e3;
        (
            nm(recipe.tolerance.residual),
            nm(recipe.tolerance.interpolation),
            recipe.tolerances.residual.map(nm),
            recipe.tolerances.form.map(nm),
        )
    };
    let form = "form = \"150 nm\"";
    let asked = Some(150.0);
    assert_eq!(split(form), (100.0, 25.0, None, asked));
    let fine = format!("{form}, residual = \"50 nm\"");
    assert_eq!(split(&fine), (50.0, 50.0, Some(50.0), asked));
    let smooth = format!("{form}, interpolation = \"10 nm\"");
    assert_eq!(split(&smooth), (130.0, 10.0, None, asked));
    let idle = format!("{form}, residual = \"1 um\"");
    assert_eq!(split(&idle), (100.0, 25.0, Some(1000.0), asked));
}

#[test]
fn the_full_example_is_read() {
    let recipe = parse(FULL, &[]);
    assert_eq!(recipe.name, "Astigmatic mirror, 5 mm");
    assert_eq!(
        (recipe.part.aperture_radius, recipe.part.inner_radius),
        (2.5, 0.0)
    );
    assert_eq!(recipe.tool.nose_radius, 1.0);
    assert_eq!(recipe.tool.included_angle, Some(120.0 * DEG));
    assert_eq!(recipe.tool.clearance_angle, Some(30.0 * DEG));
    assert_eq!(recipe.tool.misfit, Misfit::Refuse);
    assert_eq!(
        (recipe.tolerance.interpolation, recipe.tolerance.residual),
        (1e-4, 1e-4)
    );
    assert_eq!(recipe.spindle_speed, 500.0 * TAU / 60.0);
    assert_eq!(recipe.direction, Direction::Inward);
    assert_eq!(recipe.overrun, Overrun::None);
    assert!(!recipe.lead && recipe.refine);
    assert_eq!(recipe.clearance, 1.0);
    assert!(recipe.output.posts.is_empty());
    assert_eq!(recipe.output.data, [DataFormat::Csv]);
    assert_eq!(recipe.output.z_reference, ZReference::Tip);
    assert_eq!(recipe.plugins[0].value, "plugins");
    let names = Slot::ALL.map(|slot| recipe.choice(slot).name().to_owned());
    assert_eq!(
        names,
        [
            "astigmatic",
            "atpg",
            "atpg",
            "z-direction",
            "triangle-rotary",
            "constant"
        ]
    );
    for slot in Slot::ALL {
        assert_eq!(recipe.choice(slot).slot, slot);
    }
}

#[test]
fn what_is_optional_may_be_left_out() {
    let dropped = [
        "name =",
        "plugins",
        "refine",
        "inner",
        "included",
        "clearance",
        "interference",
    ];
    let dropped = [
        &dropped[..],
        &["direction", "[output]", "posts", "data", "z_ref"],
    ]
    .concat();
    let kept = FULL
        .lines()
        .filter(|line| !dropped.iter().any(|start| line.starts_with(start)));
    let text = kept
        .take_while(|line| *line != "[ablation]")
        .collect::<Vec<_>>()
        .join("\r\n");
    let recipe = parse(&text, &[]);
    assert_eq!(recipe.name, "mirror");
    assert_eq!(recipe.tool.included_angle, None);
    assert_eq!(recipe.output.data, [DataFormat::Csv]);
    assert!(recipe.refine && recipe.plugins.is_empty());
    assert_eq!(recipe.span("refine"), None);
}

#[test]
fn words_are_read() {
    let text = FULL
        .replace("\"inward\"", "\"outward\"")
        .replace("\"tip\"", "\"centre\"");
    let recipe = parse(&text.replace("refine = true", "refine = false"), &[]);
    assert_eq!(recipe.direction, Direction::Outward);
    assert_eq!(recipe.output.z_reference, ZReference::Centre);
    assert!(!recipe.refine);
}

#[test]
fn programs_have_the_layout_of_the_recipe_or_the_default() {
    let plain = parse(FULL, &[]);
    let settings = plain.settings_of("pmac-pvt").unwrap();
    assert!(settings.header.is_none() && settings.footer.is_none());
    let post = post_named("pmac-pvt").unwrap();
    let plain = post.format(&settings.params, 0.0, 1e-4);
    assert_eq!((plain.position_decimals, plain.velocity_decimals), (7, 7));
    assert!(!plain.per_minute && !plain.c_reversed && !plain.c_wrapped && !plain.incremental);
    let table = "[output.pmac-pvt]\nposition_decimals = 6\nvelocity_per = \"min\"\nc_sign = -1\n\
                 c_wrap = \"0-360\"\npositioning = \"incremental\"\nheader = \"; {name}\"\n";
    let text = FULL.replace("posts = []", "posts = [\"pmac-pvt\"]") + table;
    let recipe = parse(&text, &["output.pmac-pvt.footer=\"M30\""]);
    let settings = recipe.settings_of("pmac-pvt").unwrap();
    let layout = post.format(&settings.params, 0.0, 1e-4);
    assert_eq!((layout.position_decimals, layout.velocity_decimals), (6, 5));
    assert!(layout.per_minute && layout.c_reversed && layout.c_wrapped && layout.incremental);
    assert_eq!(settings.header.as_ref().unwrap().value, "; {name}");
    assert_eq!(settings.footer.as_ref().unwrap().value, "M30");
    assert_eq!(recipe.output.posts[0].value, "pmac-pvt");
    assert_eq!(recipe.text(), text);
}

#[test]
fn spans_are_those_of_the_text() {
    let recipe = parse(FULL, &["velocity.use=area"]);
    assert_eq!(underlined(&recipe, "tool.nose_radius"), "\"1 mm\"");
    assert_eq!(underlined(&recipe, "tool"), "[tool]");
    assert_eq!(underlined(&recipe, "velocity.use"), "area");
    assert_eq!(underlined(&recipe, "refine"), "true");
    assert_eq!(recipe.span("tool.none"), None);
    assert_eq!(recipe.span("tool.nose_radius.x"), None);
    assert_eq!(
        recipe.nearest_span("tool.none"),
        recipe.span("tool").unwrap()
    );
    assert!(recipe.nearest_span("none").is_whole());
    assert_eq!(
        recipe.table_span(Slot::Sampler),
        recipe.span("sampler").unwrap()
    );
    let sampler = recipe.choice(Slot::Sampler);
    assert_eq!(
        sampler.param_span("max_step"),
        recipe.span("sampler.max_step").unwrap()
    );
    assert_eq!(
        sampler.param_span("step"),
        recipe.span("sampler.use").unwrap()
    );
}

#[test]
fn files_are_relative_to_the_recipe() {
    let recipe = parse(FULL, &[]);
    assert_eq!(recipe.stem(), "mirror");
    assert_eq!(recipe.path(), std::path::Path::new("jobs/mirror.toml"));
    assert_eq!(
        recipe.resolve("plugins"),
        std::path::Path::new("jobs/plugins")
    );
    assert_eq!(
        recipe.resolve("/opt/plugins"),
        std::path::Path::new("/opt/plugins")
    );
}

#[test]
fn the_name_is_safe_as_a_folder() {
    assert_eq!(parse(FULL, &[]).folder_name(), "Astigmatic mirror, 5 mm");
    assert_eq!(
        parse(FULL, &["name=../../etc"]).folder_name(),
        "%2E.%2F..%2Fetc"
    );
    assert_eq!(parse(FULL, &["name=.."]).folder_name(), "%2E%2E");
}

#[test]
fn a_byte_order_mark_moves_no_span() {
    let recipe = parse(&format!("\u{feff}{FULL}"), &[]);
    assert_eq!(underlined(&recipe, "tool.nose_radius"), "\"1 mm\"");
}

#[test]
fn inline_tables_and_dotted_keys_are_the_same_recipe() {
    let text = FULL
        .replace("[spindle]\nspeed = \"500 rpm\"\n", "")
        .replace(
            "[tolerance]\ninterpolation = \"100 nm\"\nresidual = \"100 nm\"\n",
            "",
        );
    let text = format!(
        "spindle = {{ speed = \"500 rpm\" }}\n\
         tolerance.interpolation = \"0.1 um\"\ntolerance.residual = \"1e-7 m\"\n{text}"
    );
    let (dotted, plain) = (parse(&text, &[]), parse(FULL, &[]));
    assert_eq!(dotted.tolerance, plain.tolerance);
    assert_eq!(dotted.spindle_speed, plain.spindle_speed);
}

#[test]
fn set_overrides_and_adds_and_the_later_one_wins() {
    let sets = [
        "tool.nose_radius=0.5 mm",
        "tool.nose_radius = 250um",
        "part.inner=\"1 mm\"",
        "refine=false",
        "name=Zwölf",
        "sampler.use=integrated",
        "sampler.spacing=10 um",
        "surface={ use = \"flat\" }",
    ];
    let recipe = parse(FULL, &sets);
    assert_eq!(recipe.tool.nose_radius, 0.25);
    assert_eq!(recipe.part.inner_radius, 0.5);
    assert!(!recipe.refine);
    assert_eq!(recipe.name, "Zwölf");
    let sampler = recipe.choice(Slot::Sampler);
    assert_eq!(sampler.name(), "integrated");
    let keys: Vec<&str> = sampler
        .params
        .iter()
        .map(|entry| entry.key.as_str())
        .collect();
    assert_eq!(keys, ["max_step", "spacing"]);
    assert_eq!(recipe.choice(Slot::Surface).name(), "flat");
    assert!(recipe.choice(Slot::Surface).params.is_empty());
}

#[test]
fn the_path_has_leads_unless_the_recipe_leaves_them_out() {
    let without = FULL.replace("lead = false\n", "");
    let recipe = parse(&without, &["path.clearance=2.5mm"]);
    assert!(recipe.lead);
    assert_eq!(recipe.clearance, 2.5);
    assert!(parse(FULL, &["path.lead=true"]).lead);
}

#[test]
fn set_makes_a_table_that_is_missing() {
    let text = FULL.replace(
        "[path]\ndirection = \"inward\"\noverrun = \"none\"\nlead = false\n",
        "",
    );
    let recipe = parse(&text, &["path.overrun=none", "path.lead=false"]);
    assert_eq!(recipe.overrun, Overrun::None);
}

#[test]
fn an_overrun_is_a_word_or_a_length_and_defaults_to_contact() {
    let overrun = |set: &str| parse(FULL, &[set, "path.lead=false"]).overrun;
    assert_eq!(overrun("path.overrun=contact"), Overrun::Contact);
    assert_eq!(overrun("path.overrun=250 um"), Overrun::Length(0.25));
    assert_eq!(overrun("path.overrun=0 mm"), Overrun::Length(0.0));
    let left_out = FULL.replace("overrun = \"none\"\n", "");
    assert_eq!(parse(&left_out, &[]).overrun, Overrun::Contact);
}

#[test]
fn limits_are_allowed_themselves_as_they_are_written() {
    for set in [
        "part.aperture=0.1 um",
        "part.aperture=0.0001 mm",
        "tool.nose_radius=100 nm",
        "tool.included_angle=180 deg",
        "tolerance.residual=0.001 nm",
        "tolerance.interpolation=1e-9 mm",
        "spindle.speed=1e-6 rpm",
        "spindle.speed=1e6 rpm",
        "path.overrun=0 mm",
        "path.clearance=1 m",
        "servo.bandwidth=0.001 Hz",
        "servo.bandwidth=1e6 Hz",
        "servo.bandwidth=1000 kHz",
    ] {
        parse(FULL, &[set]);
    }
}

#[test]
fn binding_fills_defaults_and_leaves_optional_ones_absent() {
    const MAX_STEP: Param<Angle> = Param::angle("max_step", "").default(1.0);
    const AT_LEAST: Param<Count> = Param::count("at_least", "").default(36);
    const FORM: Param<Choice> = Param::choice("form", &["sum", "product"], "").default("sum");
    const SMOOTH: Param<Flag> = Param::flag("smooth", "").default(true);
    const CONIC: Param<Option<Number>> = Param::number("conic", "").optional();
    const TERMS: Param<Option<Rows>> = Param::rows("terms", 3, "").optional();
    const MAP: Param<Option<File>> = Param::file("map", "").optional();
    const PARAMS: &[ParamInfo] = &[
        MAX_STEP.info(),
        AT_LEAST.info(),
        FORM.info(),
        SMOOTH.info(),
        CONIC.info(),
        TERMS.info(),
        MAP.info(),
    ];
    let info = StrategyInfo {
        slot: Slot::Sampler,
        name: "atpg",
        summary: "",
        source: "",
        params: PARAMS,
    };
    let terms = "sampler.terms=[[2, 0, 0.5], [0, 2, -1e-3]]";
    let recipe = parse(FULL, &[terms, "sampler.map=maps/one.csv"]);
    let bound = recipe.bind(Slot::Sampler, &info).unwrap();
    let params = &bound.params;
    assert_eq!(params.get(MAX_STEP), 45.0 * DEG);
    assert_eq!(params.get(AT_LEAST), 36);
    assert_eq!(params.get(FORM), "sum");
    assert!(params.get(SMOOTH));
    assert_eq!(params.get(CONIC), None);
    let rows = [vec![2.0, 0.0, 0.5], vec![0.0, 2.0, -1e-3]];
    assert_eq!(params.get(TERMS), Some(&rows[..]));
    let [file] = &bound.files[..] else {
        panic!("one file");
    };
    let (param, path) = (file.param, file.path.value.as_str());
    assert_eq!((param, path), ("map", "maps/one.csv"));
    assert_eq!(
        params
            .iter()
            .filter(|(_, value)| matches!(value, ParamValue::Number(_)))
            .count(),
        2
    );
}

#[test]
fn coefficients_are_rows_of_their_numbers_and_values() {
    const HEIGHTS: Param<Coefficients> = Param::length_coefficients("heights", 1, "");
    const POWERS: Param<Coefficients> = Param::coefficients("powers", 2, "");
    const PARAMS: &[ParamInfo] = &[HEIGHTS.info(), POWERS.info()];
    let info = StrategyInfo {
        slot: Slot::Sampler,
        name: "atpg",
        summary: "",
        source: "",
        params: PARAMS,
    };
    let sets = [
        "sampler={ use = \"atpg\", heights = { 11 = \"-30 nm\", 4 = \"1 um\" }, powers = { \"2,-1\" = 0.5 } }",
        "sampler.heights.4=2 um",
        "sampler.powers.0,3=-1e-3",
    ];
    let bound = parse(FULL, &sets).bind(Slot::Sampler, &info).unwrap();
    assert_eq!(bound.params.get(HEIGHTS), [[11.0, -3e-5], [4.0, 2e-3]]);
    let powers = [[2.0, -1.0, 0.5], [0.0, 3.0, -1e-3]];
    assert_eq!(bound.params.get(POWERS), powers);
}

#[test]
fn constants_have_names_and_powers_of_a_length() {
    const CONSTANTS: Param<Constants> = Param::constants("constants", "");
    const PARAMS: &[ParamInfo] = &[CONSTANTS.info()];
    let info = StrategyInfo {
        slot: Slot::Sampler,
        name: "atpg",
        summary: "",
        source: "",
        params: PARAMS,
    };
    let sets = [
        "sampler={ use = \"atpg\", constants = { R = \"5 m\", n = 4, t = \"180 deg\" } }",
        "sampler.constants.A4=2 /um^3",
        "sampler.constants.R=5 um",
    ];
    let bound = parse(FULL, &sets).bind(Slot::Sampler, &info).unwrap();
    let constants = bound.params.get(CONSTANTS).iter();
    let found: Vec<(&str, f64, i32)> = constants
        .map(|constant| {
            (
                constant.name.as_str(),
                constant.value,
                constant.length_power,
            )
        })
        .collect();
    let expected = [
        ("R", 5e-3, 1),
        ("n", 4.0, 0),
        ("t", std::f64::consts::PI, 0),
        ("A4", 2e9, -3),
    ];
    assert_eq!(found, expected);
}

#[test]
fn files_are_loaded_and_missing_ones_are_another_kind_of_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mirror.toml");
    let missing = Recipe::load(&path, &[]).unwrap_err();
    assert!(matches!(
        missing,
        RecipeError::File {
            problem: FileProblem::Io(_),
            ..
        }
    ));
    std::fs::write(&path, FULL).unwrap();
    assert_eq!(Recipe::load(&path, &[]).unwrap().stem(), "mirror");
    std::fs::write(&path, "format = 1").unwrap();
    assert!(matches!(
        Recipe::load(&path, &[]),
        Err(RecipeError::Wrong(_))
    ));
}

#[test]
fn nesting_without_end_does_not_crash() {
    let dotted = format!("{} = 1", vec!["a"; 200_000].join("."));
    let arrays = format!("name = {}", "[".repeat(200_000));
    let tables = format!("name = {}", "{a=".repeat(200_000));
    let header = format!("[{}]", vec!["a"; 200_000].join("."));
    for text in [dotted, arrays, tables, header] {
        assert!(Recipe::parse(&text, "deep.toml", &[]).is_err());
        // As a `--set`, what is no TOML is a string, here an odd name.
        let _ = Recipe::parse(FULL, "deep.toml", &[text]);
    }
}

#[test]
fn a_set_on_a_recipe_is_the_same_as_a_set_on_its_text() {
    let sets = [
        "tool.nose_radius=0.5 mm",
        "refine=false",
        "path.overrun=250 um",
    ];
    let at_once = parse(FULL, &sets);
    assert_eq!(at_once.sets(), sets);
    let one_by_one = parse(FULL, &sets[..1])
        .set("refine", "false")
        .unwrap()
        .set("path.overrun", "250 um")
        .unwrap();
    assert_eq!(one_by_one, at_once);
    let error = one_by_one.set("tool.nose_radius", "1 s").unwrap_err();
    let RecipeError::Wrong(wrong) = error else {
        panic!("{error}");
    };
    let spans: Vec<_> = wrong
        .messages()
        .iter()
        .filter_map(|one| one.span())
        .collect();
    assert_eq!(spans[0].source().text, "tool.nose_radius=1 s");
    assert_eq!(spans[0].source().rank, 4);
}

#[test]
fn a_set_on_a_variant_keeps_the_variants_values() {
    let variants = parse(FULL, &[]).variants().unwrap();
    let variant = variants.last().unwrap().recipe.clone();
    assert_eq!(variant.choice(Slot::Velocity).name(), "analytic");
    let changed = variant.set("tolerance.residual", "50 nm").unwrap();
    assert_eq!(changed.choice(Slot::Velocity).name(), "analytic");
    assert_eq!(changed.tolerance.residual, 50e-6);
}

#[test]
fn a_key_with_an_equals_sign_is_refused() {
    let error = parse(FULL, &[]).set("name=a", "b").unwrap_err();
    assert!(error.render(false).contains("name=a=b"), "{error}");
}

#[test]
fn errors_have_their_causes_as_sources() {
    use std::error::Error;
    let error = Recipe::load("no/such/recipe.toml", &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cannot read the recipe no/such/recipe.toml"
    );
    let source = error.source().unwrap();
    assert_eq!(
        error.render(false),
        format!("error: cannot read the recipe no/such/recipe.toml: {source}")
    );
}
