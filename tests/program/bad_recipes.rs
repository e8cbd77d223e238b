//! Wrong recipes and wrong calls: the message and the exit status.

use std::fs;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};

/// The program's answer to a wrong recipe; it must leave no file.
#[track_caller]
fn answer(recipe: impl AsRef<[u8]>, words: &str) -> String {
    let bench = Bench::empty();
    bench.write("recipe.toml", recipe);
    let said = bench.line(words);
    assert_eq!(bench.files(), ["recipe.toml"], "{said}");
    // A check reports the part's own shape, even if it refuses the recipe.
    let of_check = words.starts_with("check") && said.stdout.contains("most domed");
    assert!(of_check || said.stdout.is_empty(), "{said}");
    assert!(!said.stderr.contains("panicked"), "{said}");
    bench.shown(&said)
}

/// The answer to the saddle's recipe with one passage changed.
#[track_caller]
fn with_change(from: &str, to: &str) -> String {
    answer(changed(SADDLE, from, to), "run recipe.toml")
}

#[test]
fn a_strategy_that_is_misspelt() {
    insta::assert_snapshot!(with_change("\"equal-angle\"", "\"equal-angel\""));
}

#[test]
fn a_strategy_that_does_not_exist() {
    let recipe = saddle_with("sampler", "use = \"whatever\"");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_strategy_of_another_slot() {
    insta::assert_snapshot!(with_change("\"z-direction\"", "\"analytic\""));
}

#[test]
fn a_key_that_does_not_exist() {
    insta::assert_snapshot!(with_change("nose_radius", "nose_radios"));
}

#[test]
fn a_table_that_does_not_exist() {
    insta::assert_snapshot!(with_change("[spindle]", "[spinddle]"));
}

#[test]
fn a_parameter_that_does_not_exist() {
    insta::assert_snapshot!(with_change(
        "step = \"9 deg\"",
        "step = \"9 deg\"\nspacing = \"1 mm\""
    ));
}

#[test]
fn a_unit_of_another_quantity() {
    insta::assert_snapshot!(with_change("\"1 mm\"", "\"8 ms\""));
}

#[test]
fn a_unit_that_is_missing() {
    insta::assert_snapshot!(with_change("\"9 deg\"", "9"));
}

#[test]
fn a_parameter_that_is_missing() {
    insta::assert_snapshot!(with_change("k = \"0.08 /mm\"\n", ""));
}

#[test]
fn an_aperture_below_zero() {
    insta::assert_snapshot!(with_change("\"5 mm\"", "\"-5 mm\""));
}

#[test]
fn a_hole_as_large_as_the_part() {
    insta::assert_snapshot!(with_change("\"5 mm\"", "\"5 mm\"\ninner = \"5 mm\""));
}

#[test]
fn a_nose_that_would_gouge() {
    insta::assert_snapshot!(with_change(
        "nose_radius = \"1 mm\"",
        "nose_radius = \"7 mm\""
    ));
}

/// Beside it the part has no digits left: it was the compensator that was blamed.
#[test]
fn a_nose_larger_than_any_machine() {
    insta::assert_snapshot!(with_change(
        "nose_radius = \"1 mm\"",
        "nose_radius = \"1e6 m\"\ninterference = \"cut-what-fits\""
    ));
}

#[test]
fn a_tool_whose_edge_ends_before_the_contact() {
    insta::assert_snapshot!(with_change("\"120 deg\"", "\"30 deg\""));
}

#[test]
fn a_tool_whose_flank_would_rub() {
    insta::assert_snapshot!(with_change("\"30 deg\"", "\"10 deg\""));
}

#[test]
fn check_reports_all_three_reasons_why_a_tool_does_not_fit() {
    let recipe = changed(SADDLE, "\"120 deg\"", "\"30 deg\"");
    let recipe = changed(
        &recipe,
        "clearance_angle = \"30 deg\"",
        "clearance_angle = \"10 deg\"",
    );
    let recipe = changed(&recipe, "nose_radius = \"1 mm\"", "nose_radius = \"7 mm\"");
    insta::assert_snapshot!(answer(recipe, "check recipe.toml"));
}

#[test]
fn an_aperture_that_reaches_beyond_the_surface() {
    let recipe = saddle_with("surface", "use = \"conic\"\nradius = \"2 mm\"");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

/// It was the surface's plugin that was blamed.
#[test]
fn a_decentre_that_moves_the_surface_away_from_the_part() {
    let sphere = "use = \"conic\"\nradius = \"20 mm\"\ndecentre_y = \"10 m\"";
    let recipe = saddle_with("surface", sphere);
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

/// Each value is wrong, and each message would show the line.
#[test]
fn ten_thousand_wrong_values_on_a_line_end_in_a_hundred_messages() {
    let posts = "\"x\", ".repeat(10_000);
    let recipe = format!("{SADDLE}\n[output]\nposts = [{posts}]\n");
    let said = answer(recipe, "run recipe.toml");
    assert!(said.starts_with("exit 2"), "{}", said.len());
    assert!(said.ends_with("messages left out: 9900 more\n"));
    assert_eq!(said.matches("error: ").count(), 101);
    assert!(said.len() < 100_000, "{} bytes", said.len());
}

#[test]
fn parameters_that_contradict_each_other() {
    let recipe = saddle_with(
        "sampler",
        "use = \"equal-angle\"\nstep = \"9 deg\"\nmax_step = \"6 deg\"",
    );
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_feed_of_too_many_revolutions() {
    let set = "run recipe.toml --set feed.feed=1e-7um/rev";
    insta::assert_snapshot!(answer(SADDLE, set));
}

#[test]
fn a_step_of_too_many_points() {
    let step = with_change("\"9 deg\"", "\"1e-7 deg\"");
    insta::assert_snapshot!(step);
}

#[test]
fn several_mistakes_are_reported_at_once() {
    let recipe = changed(SADDLE, "\"5 mm\"", "\"5\"");
    let recipe = changed(&recipe, "speed = \"500 rpm\"\n", "");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn wrong_strategies_are_reported_beside_a_missing_key() {
    let recipe = changed(SADDLE, "speed = \"500 rpm\"\n", "");
    let recipe = changed(&recipe, "use = \"astigmatic\"", "use = \"Astigmatic\"");
    let recipe = changed(&recipe, "use = \"equal-angle\"", "use = \"equal_angle\"");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

/// Its plugins are not loaded, so nobody knows which strategies there are.
#[test]
fn strategies_of_a_wrong_recipe_that_lists_plugins_are_not_called_unknown() {
    let recipe = changed(SADDLE, "speed = \"500 rpm\"\n", "");
    let recipe = changed(&recipe, "use = \"astigmatic\"", "use = \"our-own\"");
    let recipe = format!("plugins = [\"lib\"]\n{recipe}");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_file_that_is_no_toml() {
    insta::assert_snapshot!(with_change("[spindle]", "[spindle"));
}

#[test]
fn an_empty_recipe() {
    insta::assert_snapshot!(answer("", "run recipe.toml"));
}

#[test]
fn a_file_that_is_no_text() {
    insta::assert_snapshot!(answer(b"format = 1\nname = \"\xff\"\n", "run recipe.toml"));
}

#[test]
fn a_recipe_that_is_not_there() {
    insta::assert_snapshot!(answer(SADDLE, "run recipes.toml"));
}

#[test]
fn a_folder_in_place_of_a_recipe() {
    insta::assert_snapshot!(answer(SADDLE, "run ."));
}

#[test]
fn an_overrun_that_is_neither_a_word_nor_a_length() {
    insta::assert_snapshot!(with_change("overrun = \"none\"", "overrun = \"contract\""));
}

#[test]
fn an_overrun_for_which_the_surface_ends_too_early() {
    let sphere = SADDLE
        .replace(
            "use = \"astigmatic\"",
            "use = \"conic\"\nradius = \"-2.51 mm\"",
        )
        .replace("k = \"0.08 /mm\"\n", "")
        .replace("included_angle", "# included_angle")
        .replace("overrun = \"none\"", "overrun = \"100 um\"");
    insta::assert_snapshot!(answer(sphere, "run recipe.toml"));
}

/// Within 2.5 mm the nose fits, and with a feed of the radius alone the path does not leave it. ATS's fast
/// angles go on to 3.05 mm, where the section at 105 deg has κ = 1.165/mm by hand.
#[test]
fn a_nose_too_large_where_the_law_follows_the_angle_beyond_the_range() {
    let terms = "use = \"xy-polynomial\"\nterms = [[1, 1, 0.16], [8, 0, 5e-5], [0, 8, 5e-5]]";
    let recipe = with_table(SADDLE, "surface", terms);
    let recipe = with_table(&recipe, "tool", "nose_radius = \"1 mm\"");
    let recipe = with_table(&recipe, "compensator", "use = \"normal\"");
    let recipe = with_table(&recipe, "path", "direction = \"outward\"\nlead = false");
    let bench = Bench::with(&recipe);
    let fits = bench.line("run recipe.toml -o out --set feed.use=\"atpg\" --set refine=true");
    assert_eq!(fits.status, Some(0), "{fits}");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml --set feed.use=\"ats\""));
}

#[test]
fn a_clearance_that_no_machine_has() {
    let lead = "lead = true\nclearance = \"1e12 mm\"";
    insta::assert_snapshot!(with_change("lead = false", lead));
}

#[test]
fn a_program_that_this_version_does_not_write() {
    let recipe = format!("{SADDLE}\n[output]\nposts = [\"pmac-pvd\"]\n");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_program_that_cannot_carry_straight_lines() {
    let recipe = format!("{SADDLE}\n[output]\nposts = [\"pmac-pvt\"]\n");
    let straight = "run recipe.toml --set velocity={use=\"linear\"}";
    insta::assert_snapshot!(answer(recipe, straight));
}

#[test]
fn what_a_program_cannot_carry_is_refused_by_check_too() {
    let recipe = format!("{SADDLE}\n[output]\nposts = [\"pmac-pvt\"]\n");
    let straight = "--set velocity={use=\"linear\"}";
    let of = |command: &str| answer(recipe.clone(), &format!("{command} recipe.toml {straight}"));
    assert_eq!(of("check"), of("run"));
}

#[test]
fn data_that_this_version_does_not_write() {
    let recipe = format!("{SADDLE}\n[output]\ndata = [\"xml\"]\n");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_machine_that_is_not_known() {
    let recipe = format!("{SADDLE}\n[machine]\npreset = \"generic-fts\"\n");
    insta::assert_snapshot!(answer(recipe, "run recipe.toml"));
}

#[test]
fn a_spindle_that_follows_limits_of_which_the_machine_has_none_for_c() {
    let spindle = "use = \"per-revolution\"\nspeed = \"500 rpm\"";
    let recipe = with_table(SADDLE, "spindle", spindle);
    insta::assert_snapshot!(answer(&recipe, "run recipe.toml"));
}

#[test]
fn a_spindle_that_follows_limits_of_which_the_machine_has_none_for_x_and_z() {
    let spindle = "use = \"per-revolution\"\nspeed = \"500 rpm\"";
    let machine = "[machine]\nc_acceleration = \"100 rad/s^2\"\n";
    let recipe = format!("{}\n{machine}", with_table(SADDLE, "spindle", spindle));
    insta::assert_snapshot!(answer(&recipe, "run recipe.toml"));
}

#[test]
fn a_spindle_faster_than_the_machine() {
    let recipe = format!("{SADDLE}\n[machine]\nc_velocity = \"300 rpm\"\n");
    insta::assert_snapshot!(answer(recipe, "check recipe.toml"));
}

#[test]
fn a_set_without_a_value() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --set tool.nose_radius"));
}

#[test]
fn a_set_of_a_key_that_does_not_exist() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --set tool.radius=1mm"));
}

#[test]
fn a_set_with_a_wrong_unit() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --set sampler.step=9mm"));
}

#[test]
fn a_set_that_makes_the_tool_gouge_is_underlined() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --set tool.nose_radius=7mm"));
}

#[test]
fn no_command_at_all() {
    let bench = Bench::empty();
    let said = bench.line("").ends(2);
    assert!(said.stderr.contains("Usage: turnpath <COMMAND>"), "{said}");
}

#[test]
fn a_command_that_does_not_exist() {
    insta::assert_snapshot!(answer(SADDLE, "runn recipe.toml"));
}

#[test]
fn an_option_that_does_not_exist() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --outputs x"));
}

#[test]
fn no_threads() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --threads 0"));
}

#[test]
fn a_format_that_does_not_exist() {
    insta::assert_snapshot!(answer(SADDLE, "run recipe.toml --format yaml"));
}

#[test]
fn a_grid_of_one_point() {
    insta::assert_snapshot!(answer(SADDLE, "sag recipe.toml --grid 1 -o x.csv"));
}

#[test]
fn a_file_where_the_output_folder_should_be() {
    let bench = Bench::with(SADDLE);
    bench.write("out", "a file\n");
    let said = bench.line("run recipe.toml -o out");
    assert_eq!(bench.files(), ["out", "recipe.toml"]);
    insta::assert_snapshot!(bench.shown(&said));
}

#[test]
fn a_file_above_the_output_folder() {
    let bench = Bench::with(SADDLE);
    bench.write("out", "a file\n");
    let said = bench.line("run recipe.toml -o out/deeper");
    assert_eq!(bench.files(), ["out", "recipe.toml"]);
    insta::assert_snapshot!(bench.shown(&said));
}

#[cfg(unix)]
#[test]
fn a_pipe_where_the_summary_should_be_is_refused_before_the_work() {
    let bench = Bench::with(SADDLE);
    fs::create_dir(bench.path("out")).expect("a folder");
    let pipe = bench.path("out/summary.json");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    let said = bench.line("run recipe.toml -o out").ends(4);
    let reported = "error: cannot write out/summary.json: it is not a regular file\n";
    assert_eq!(said.stderr, reported);
    assert_eq!(bench.files(), ["out/summary.json", "recipe.toml"]);
}

#[test]
fn a_folder_where_the_tool_path_should_be() {
    let bench = Bench::with(SADDLE);
    fs::create_dir_all(bench.path("out/toolpath.csv/inner")).unwrap();
    let said = bench.line("run recipe.toml -o out");
    assert_eq!(bench.files(), ["recipe.toml"]);
    insta::assert_snapshot!(bench.shown(&said));
}

/// The saddle's recipe with a formula as its surface.
fn with_formula(lines: &str) -> String {
    let recipe = saddle_with("surface", &format!("use = \"formula\"\n{lines}"));
    answer(recipe, "check recipe.toml")
}

#[test]
fn a_formula_with_a_number_that_has_no_unit() {
    insta::assert_snapshot!(with_formula(
        "z = \"k*x^2 + 0.01*y^2\"\nconstants = { k = \"0.01 /mm\" }"
    ));
}

#[test]
fn a_formula_with_an_unknown_name() {
    insta::assert_snapshot!(with_formula(
        "z = \"\"\"\n  k*x^2\n  + q*y^2\"\"\"\nconstants = { k = \"0.01 /mm\" }"
    ));
}

#[test]
fn a_formula_in_a_text_with_escapes() {
    insta::assert_snapshot!(with_formula("z = \"x\\u002b1\""));
}

#[test]
fn a_formula_without_a_value_on_the_part() {
    insta::assert_snapshot!(with_formula("z = \"mm*sqrt(1 - (rho/mm)^2)\""));
}

#[test]
fn a_formula_with_a_logarithm_of_zero_at_the_axis() {
    insta::assert_snapshot!(with_formula("z = \"um*ln(rho/mm)\""));
}

#[test]
fn a_formula_with_a_division_by_zero_on_the_part() {
    insta::assert_snapshot!(with_formula("z = \"0.01/mm*rho^2 + nm*mm/(x - 1.25*mm)\""));
}

#[test]
fn a_formula_in_a_sum_that_has_no_value_where_it_is_moved_to() {
    let sum = "[[surface]]\nuse = \"conic\"\nradius = \"50 mm\"\n\n[[surface]]\nuse = \"formula\"\n\
               z = \"um*sqrt(2 - x/mm)\"\ndecentre_x = \"-1 mm\"\n\n[tool]";
    let own = "[surface]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\n\n[tool]";
    insta::assert_snapshot!(answer(changed(SADDLE, own, sum), "check recipe.toml"));
}

#[test]
fn a_formula_with_a_valley() {
    insta::assert_snapshot!(with_formula("z = \"0.1*abs(x - 0.3*mm)\""));
}
