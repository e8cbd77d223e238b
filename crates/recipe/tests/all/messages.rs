//! What the user sees for each kind of wrong recipe, as snapshots.

#![allow(clippy::unwrap_used, reason = "an unwrap in a helper is a failed test")]

use crate::common::FULL;
use turnpath_core::{DEG, Param, ParamInfo, Slot, StrategyInfo};
use turnpath_recipe::Recipe;

fn message(text: &str, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Recipe::parse(text, "jobs/mirror.toml", &sets)
        .unwrap_err()
        .render(false)
}

fn with(old: &str, new: &str) -> String {
    assert!(FULL.contains(old), "{old}");
    message(&FULL.replacen(old, new, 1), &[])
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
    toml_syntax: "\"500 rpm\"" => "500 rpm";
    toml_key_twice: "refine = true" => "refine = true\nrefine = false";
    toml_string_left_open: "\"500 rpm\"" => "\"500 rpm";
    format_missing: "format = 1\n" => "";
    format_of_the_future: "format = 1" => "format = 2";
    format_as_text: "format = 1" => "format = \"1\"";
    name_empty: "\"Astigmatic mirror, 5 mm\"" => "\"\"";
    refine_as_text: "refine = true" => "refine = \"yes\"";
    plugins_as_text: "[\"plugins\"]" => "\"plugins\"";
    plugins_of_numbers: "[\"plugins\"]" => "[\"plugins\", 3]";
    table_missing: "[tool]\nnose_radius = \"1 mm\"\nincluded_angle = \"120 deg\"\nclearance_angle = \"30 deg\"\ninterference = \"refuse\"\n" => "";
    slot_missing: "[compensator]\nuse = \"z-direction\"\n" => "";
    table_unknown: "[tolerance]" => "[tolerances]";
    key_missing: "residual = \"100 nm\"\n" => "";
    tolerances_missing: "interpolation = \"100 nm\"\nresidual = \"100 nm\"\n" => "";
    tolerance_of_the_servo_without_servo: "residual = \"100 nm\"\n" => "residual = \"100 nm\"\nservo = \"50 nm\"\n";
    form_of_nothing: "residual = \"100 nm\"\n" => "form = \"0 nm\"\n";
    key_unknown: "nose_radius" => "nose_raduis";
    key_of_another_table: "inner = \"0 mm\"" => "overrun = \"none\"";
    key_of_a_table_above_the_first: "format = 1" => "format = 1\naperture = \"5 mm\"";
    unit_of_another_kind: "aperture = \"5 mm\"" => "aperture = \"8 ms\"";
    unit_unknown: "aperture = \"5 mm\"" => "aperture = \"5 mmm\"";
    unit_spelt_out: "interpolation = \"100 nm\"" => "interpolation = \"100 nanometers\"";
    unit_missing: "aperture = \"5 mm\"" => "aperture = \"5\"";
    unit_missing_on_a_bare_number: "aperture = \"5 mm\"" => "aperture = 5";
    quantity_as_list: "aperture = \"5 mm\"" => "aperture = [5]";
    quantity_with_a_decimal_comma: "aperture = \"5 mm\"" => "aperture = \"5,5 mm\"";
    quantity_infinite: "aperture = \"5 mm\"" => "aperture = \"inf mm\"";
    aperture_negative: "aperture = \"5 mm\"" => "aperture = \"-5 mm\"";
    aperture_zero: "aperture = \"5 mm\"" => "aperture = \"0 mm\"";
    hole_too_large: "inner = \"0 mm\"" => "inner = \"5 mm\"";
    hole_negative: "inner = \"0 mm\"" => "inner = \"-1 um\"";
    quantity_that_is_no_number: "residual = \"100 nm\"" => "residual = nan";
    quantity_as_list_of_no_numbers: "residual = \"100 nm\"" => "residual = [nan]";
    tolerance_tiny: "residual = \"100 nm\"" => "residual = \"1e-300 mm\"";
    speed_misspelt: "speed =" => "sped =";
    speed_misspelt_with_a_strategy: "speed =" => "use = \"constant\"\nsped =";
    spindle_not_named: "speed =" => "use = \"fast.so\"\nspeed =";
    speed_huge: "\"500 rpm\"" => "\"1e300 rpm\"";
    tolerance_zero: "interpolation = \"100 nm\"" => "interpolation = \"0 nm\"";
    included_angle_too_large: "\"120 deg\"" => "\"181 deg\"";
    clearance_angle_too_large: "\"30 deg\"" => "\"90 deg\"";
    speed_zero: "\"500 rpm\"" => "\"0 rpm\"";
    speed_along_a_line: "\"500 rpm\"" => "\"500 mm/s\"";
    direction_misspelt: "\"inward\"" => "\"inwards\"";
    strategy_is_a_path: "use = \"z-direction\"" => "use = \"../evil.so\"";
    strategy_not_named: "use = \"z-direction\"\n" => "";
    strategy_as_number: "use = \"z-direction\"" => "use = 3";
    overrun_negative: "overrun = \"none\"" => "overrun = \"-1 mm\"";
    overrun_without_unit: "overrun = \"none\"" => "overrun = 1";
    overrun_as_angle: "overrun = \"none\"" => "overrun = \"1 deg\"";
    overrun_misspelt: "overrun = \"none\"" => "overrun = \"contacts\"";
    lead_as_text: "lead = false" => "lead = \"yes\"";
    clearance_zero: "lead = false" => "clearance = \"0 mm\"";
    machine_empty: "[output]" => "[machine]\n\n[output]";
    machine_preset_misspelt: "[output]" => "[machine]\npreset = \"genric-sts\"\n\n[output]";
    machine_preset_unknown: "[output]" => "[machine]\npreset = \"my lathe\"\n\n[output]";
    machine_preset_as_number: "[output]" => "[machine]\npreset = 5\n\n[output]";
    machine_key_misspelt: "[output]" => "[machine]\nx_accelaration = \"1 m/s^2\"\n\n[output]";
    machine_limit_zero: "[output]" => "[machine]\nz_jerk = \"0 m/s^3\"\n\n[output]";
    machine_limit_of_another_kind: "[output]" => "[machine]\nx_acceleration = \"1 m/s\"\n\n[output]";
    machine_limit_without_unit: "[output]" => "[machine]\nz_velocity = 50\n\n[output]";
    machine_limit_unit_unknown: "[output]" => "[machine]\nc_acceleration = \"100 mm/s^2\"\nc_jerk = \"3 rad/s3\"\n\n[output]";
    machine_slower_than_the_spindle: "[output]" => "[machine]\nc_velocity = \"400 rpm\"\n\n[output]";
    servo_without_bandwidth: "[output]" => "[servo]\ndamping = 0.7\n\n[output]";
    servo_axis_without_bandwidth: "[output]" => "[servo]\nz_bandwidth = \"70 Hz\"\n\n[output]";
    servo_key_misspelt: "[output]" => "[servo]\nbandwith = \"70 Hz\"\n\n[output]";
    servo_bandwidth_of_another_kind: "[output]" => "[servo]\nbandwidth = \"70 mm\"\n\n[output]";
    servo_more_than_whole: "[output]" => "[servo]\nbandwidth = \"70 Hz\"\nvelocity_feed_forward = 1.2\ndelay = \"2 s\"\n\n[output]";
    machine_no_table: "format = 1" => "format = 1\nmachine = \"generic-sts\"";
    interference_misspelt: "\"refuse\"" => "\"cut-what-fit\"";
    post_twice: "posts = []" => "posts = [\"pmac-pvt\", \"pmac-pvt\"]";
    post_unknown: "posts = []" => "posts = [\"pmac-pwt\"]";
    post_key_unknown: "[ablation]" => "[output.pmac-pvt]\nposition_decimal = 7\n\n[ablation]";
    post_decimals: "[ablation]" => "[output.pmac-pvt]\nposition_decimals = 7.5\n\n[ablation]";
    post_c_sign: "[ablation]" => "[output.pmac-pvt]\nc_sign = 2\n\n[ablation]";
    post_c_wrap: "[ablation]" => "[output.pmac-pvt]\nc_wrap = \"0..360\"\n\n[ablation]";
    post_positioning: "[ablation]" => "[output.pmac-pvt]\npositioning = \"incremantal\"\n\n[ablation]";
    post_table_misspelt: "[ablation]" => "[output.pmac-pvd]\nc_sign = 1\n\n[ablation]";
    post_no_table: "posts = []" => "pmac-pvt = 7";
    data_unknown: "data = [\"csv\"]" => "data = [\"csw\"]";
    z_reference_misspelt: "\"tip\"" => "\"center\"";
    control_characters: "aperture = \"5 mm\"" => "aperture = \"5 \\u001b[31m\"";
}

#[test]
fn several_mistakes_at_once_in_the_order_of_the_text() {
    let text = FULL
        .replace("\"500 rpm\"", "\"0 rpm\"")
        .replace("[part]\naperture = \"5 mm\"", "[part]\napertur = \"5 mm\"")
        .replace("refine = true", "refne = true");
    insta::assert_snapshot!(message(&text, &["tool.nose_radius=1 s"]));
}

#[test]
fn table_not_a_table() {
    let text = FULL.replace("[spindle]\nspeed = \"500 rpm\"\n", "");
    insta::assert_snapshot!(message(
        &format!("spindle = \"500 rpm\"\n{text}"),
        &["path=3"]
    ));
}

#[test]
fn empty_recipe() {
    insta::assert_snapshot!(message("", &[]));
}

#[test]
fn set_with_a_wrong_unit() {
    insta::assert_snapshot!(message(FULL, &["tool.nose_radius=0.5 kg"]));
}

#[test]
fn set_of_an_unknown_key() {
    insta::assert_snapshot!(message(FULL, &["tool.nose=1mm"]));
}

#[test]
fn set_without_a_value() {
    insta::assert_snapshot!(message(FULL, &["tool.nose_radius"]));
}

#[test]
fn set_without_a_key() {
    insta::assert_snapshot!(message(FULL, &["tool..nose_radius=3", "=3"]));
}

#[test]
fn set_below_a_value() {
    insta::assert_snapshot!(message(FULL, &["tool.nose_radius.x=3"]));
}

#[test]
fn set_below_a_value_gives_one_message() {
    assert_eq!(message(FULL, &["name.x=3"]).matches("error").count(), 1);
}

#[test]
fn styled_messages_have_colours() {
    let error = Recipe::parse("format = 2", "mirror.toml", &[]).unwrap_err();
    assert!(error.render(true).contains("\u{1b}["));
    assert!(!error.render(false).contains('\u{1b}'));
}

const PARAMS: &[ParamInfo] = &[
    Param::length("spacing", "largest arc between neighbouring points")
        .positive()
        .info(),
    Param::angle("max_step", "largest angle step")
        .default(45.0 * DEG)
        .positive()
        .max(180.0 * DEG)
        .info(),
    Param::count("at_least", "fewest points on a revolution")
        .default(36)
        .min(3)
        .info(),
    Param::choice("form", &["sum", "product"], "how the waves meet")
        .default("sum")
        .info(),
    Param::number("conic", "conic constant").default(0.0).info(),
    Param::flag("smooth", "whether to smooth")
        .default(true)
        .info(),
    Param::rows("terms", 3, "i, j and c of each term")
        .optional()
        .info(),
    Param::per_length("k", "curvature")
        .nonzero()
        .optional()
        .info(),
    Param::feed("feed", "feed per revolution")
        .positive()
        .optional()
        .info(),
    Param::file("map", "heights that were measured")
        .optional()
        .info(),
    Param::length_coefficients("heights", 1, "of each term")
        .optional()
        .info(),
    Param::coefficients("powers", 2, "of each product")
        .optional()
        .info(),
    Param::constants("constants", "of a formula")
        .optional()
        .info(),
];

const SAMPLER: StrategyInfo = StrategyInfo {
    slot: Slot::Sampler,
    name: "waves",
    summary: "for tests",
    source: "",
    params: PARAMS,
};

fn bind_message(lines: &str) -> String {
    let table = format!("[sampler]\nuse = \"waves\"\n{lines}\n");
    let text = FULL.replace("[sampler]\nuse = \"atpg\"\nmax_step = \"45 deg\"\n", &table);
    let recipe = Recipe::parse(&text, "jobs/mirror.toml", &[]).unwrap();
    recipe
        .bind(Slot::Sampler, &SAMPLER)
        .unwrap_err()
        .render(false)
}

macro_rules! bind_says {
    ($($name:ident: $lines:expr;)*) => {$(
        #[test]
        fn $name() {
            insta::assert_snapshot!(bind_message($lines));
        }
    )*};
}

bind_says! {
    constants_as_list: "spacing = \"10 um\"\nconstants = [3]";
    constant_of_time: "spacing = \"10 um\"\nconstants = { a = \"5 s\" }";
    constant_without_unit: "spacing = \"10 um\"\nconstants = { a = \"5\" }";
    constant_with_a_misspelt_unit: "spacing = \"10 um\"\nconstants = { a = \"5 mmm\" }";
    constant_that_no_formula_can_name: "spacing = \"10 um\"\nconstants = { \"a-b\" = 5 }";
    param_missing: "";
    param_unknown: "spacing = \"10 um\"\nmaxstep = \"3 deg\"";
    param_of_another_kind: "spacing = \"8 ms\"";
    param_bare_number: "spacing = 5";
    param_out_of_range: "spacing = \"10 um\"\nmax_step = \"200 deg\"";
    param_zero: "spacing = \"10 um\"\nk = \"0 /mm\"";
    count_too_small: "spacing = \"10 um\"\nat_least = 2";
    count_not_whole: "spacing = \"10 um\"\nat_least = 36.5";
    count_in_quotes: "spacing = \"10 um\"\nat_least = \"36\"";
    number_with_unit: "spacing = \"10 um\"\nconic = \"1 mm\"";
    number_not_finite: "spacing = \"10 um\"\nconic = nan";
    choice_misspelt: "spacing = \"10 um\"\nform = \"prodct\"";
    flag_as_number: "spacing = \"10 um\"\nsmooth = 1";
    row_too_short: "spacing = \"10 um\"\nterms = [[2, 0, 0.01], [0, 2]]";
    rows_flat: "spacing = \"10 um\"\nterms = [2, 0, 0.01]";
    rows_of_text: "spacing = \"10 um\"\nterms = [[2, 0, \"x\"]]";
    feed_with_an_angle: "spacing = \"10 um\"\nfeed = \"3 deg\"";
    file_as_number: "spacing = \"10 um\"\nmap = 3";
    file_without_a_name: "spacing = \"10 um\"\nmap = \"\"";
    coefficients_as_list: "spacing = \"10 um\"\nheights = [\"1 um\", \"2 um\"]";
    coefficients_empty: "spacing = \"10 um\"\nheights = {}";
    rows_empty: "spacing = \"10 um\"\nterms = []";
    coefficient_without_unit: "spacing = \"10 um\"\nheights = { 4 = \"1 um\", 11 = 0.2 }";
    coefficient_with_a_unit: "spacing = \"10 um\"\npowers = { \"2,0\" = \"1 um\" }";
    coefficient_under_a_word: "spacing = \"10 um\"\nheights = { Z4 = \"1 um\" }";
    coefficient_under_a_number_too_large: "spacing = \"10 um\"\nheights = { 99999999999 = \"1 um\" }";
    coefficient_under_a_broken_number: "spacing = \"10 um\"\nheights = { 4.5 = \"1 um\" }";
    coefficient_under_one_number_of_two: "spacing = \"10 um\"\npowers = { 2 = 0.5 }";
    coefficient_twice: "spacing = \"10 um\"\npowers = { \"2,0\" = 0.5, \"2, 0\" = 0.25 }";
    several_params: "spacng = \"10 um\"\nsmooth = 1";
}

#[test]
fn left_over_parameter_after_a_set() {
    let sets = ["sampler.use=plain".to_owned()];
    let recipe = Recipe::parse(FULL, "jobs/mirror.toml", &sets).unwrap();
    let plain = StrategyInfo {
        name: "plain",
        params: &[],
        ..SAMPLER
    };
    insta::assert_snapshot!(
        recipe
            .bind(Slot::Sampler, &plain)
            .unwrap_err()
            .render(false)
    );
}

#[test]
fn unknown_strategy() {
    let text = FULL.replacen(
        "[sampler]\nuse = \"atpg\"",
        "[sampler]\nuse = \"fft-adaptve\"",
        1,
    );
    let recipe = Recipe::parse(&text, "jobs/mirror.toml", &[]).unwrap();
    let known = ["integrated", "fft-adaptive", "atpg", "equal-arc"];
    insta::assert_snapshot!(recipe.unknown_strategy(Slot::Sampler, &known).render(false));
}

#[test]
fn unknown_strategy_and_no_plugin() {
    let recipe = Recipe::parse(FULL, "jobs/mirror.toml", &[]).unwrap();
    insta::assert_snapshot!(recipe.unknown_strategy(Slot::Feed, &[]).render(false));
}

#[test]
fn message_of_a_later_stage() {
    let recipe = Recipe::parse(FULL, "jobs/mirror.toml", &[]).unwrap();
    let span = recipe.span("tool.nose_radius").unwrap();
    let title = "the tool would gouge: nose radius 1.000 mm exceeds 0.420 mm";
    let help = ["choose a smaller tool or a smaller aperture".to_owned()];
    insta::assert_snapshot!(
        recipe
            .diagnostic(span, title, "too large", help)
            .render(false)
    );
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let paths = [
        folder.path().to_owned(),
        file("latin.toml", b"format = 1\nname = \"\xe9\"\n"),
        file("large.toml", &vec![b'#'; (1 << 20) + 1]),
    ];
    let messages: Vec<String> = paths
        .iter()
        .map(|path| Recipe::load(path, &[]).unwrap_err().render(false))
        .map(|text| text.replace(&folder.path().display().to_string(), "DIR"))
        .collect();
    insta::assert_snapshot!(messages.join("\n"));
}
