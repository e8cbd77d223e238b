//! `turnpath run` and `turnpath check`: what they print and write, and their exit statuses.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::io::Read;
use std::process::Stdio;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::Value;

fn close(found: &Value, expected: f64, relative: f64) {
    let found = found.as_f64().unwrap();
    let within = (found - expected).abs() <= relative * expected.abs();
    assert!(within, "{found}, not {expected}");
}

#[test]
fn run_writes_the_path_and_its_summary() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml -o out").ends(0);
    assert_eq!(said.stderr, "");
    let files = [
        "out/report.html",
        "out/summary.json",
        "out/toolpath.csv",
        "recipe.toml",
    ];
    assert_eq!(bench.files(), files);
    for file in files.iter().take(3) {
        assert!(said.stdout.contains(file), "{said}");
    }
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let rows = bench.read("out/toolpath.csv").lines().count() as u64 - 1;
    assert_eq!(summary["rows"], rows);
    assert_eq!(summary["control_points"], rows);
    assert_eq!(summary["name"], "Saddle");
    assert_eq!(summary["chain"]["velocity"], "triangle-rotary");
}

#[test]
fn the_summary_describes_the_path_that_was_written() {
    let bench = Bench::with(SADDLE);
    let summary = bench
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json();
    let path = bench.read("out/toolpath.csv");
    let row = |line: &str| -> Vec<f64> { line.split(',').map(|v| v.parse().unwrap()).collect() };
    let (first, last) = (
        row(path.lines().nth(1).unwrap()),
        row(path.lines().last().unwrap()),
    );
    assert_eq!(first[..3], [0.0, 0.0, 2.5]);
    assert!(
        last[2].abs() < 1e-12,
        "the path ends on the axis: {}",
        last[2]
    );
    close(&summary["revolutions"], last[1] / 360.0, 1e-12);
    close(&summary["cutting_time_s"], last[0], 1e-12);
}

#[test]
fn json_on_standard_output_is_the_summary_s_file() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml -o out --format json").ends(0);
    assert_eq!(said.stdout, bench.read("out/summary.json"));
    assert_eq!(said.stderr, "");
}

#[test]
fn options_may_follow_or_precede_the_recipe() {
    let bench = Bench::with(SADDLE);
    bench
        .line("run recipe.toml -o one --threads 2 --set refine=false")
        .ends(0);
    bench
        .line("run --set refine=false --threads 2 -o two recipe.toml")
        .ends(0);
    assert_eq!(
        bench.read("one/summary.json"),
        bench.read("two/summary.json")
    );
}

#[test]
fn files_go_to_a_folder_of_the_recipe_s_name() {
    let named = |name: &str| changed(SADDLE, "\"Saddle\"", &format!("{name:?}"));
    for (name, folder) in [
        ("Astigmatic mirror, 5 mm", "Astigmatic mirror, 5 mm"),
        ("labs/mirror 5/7", "labs%2Fmirror 5%2F7"),
        ("../../escape", "%2E.%2F..%2Fescape"),
        ("C:\\mirror", "C%3A%5Cmirror"),
    ] {
        let bench = Bench::with(&named(name));
        let said = bench.line("run recipe.toml").ends(0);
        let file = format!("out/{folder}/toolpath.csv");
        assert!(bench.files().contains(&file), "{:?}\n{said}", bench.files());
    }
}

#[test]
fn a_recipe_without_a_name_has_that_of_its_file() {
    let bench = Bench::with(&changed(SADDLE, "name = \"Saddle\"\n", ""));
    bench.line("run recipe.toml").ends(0);
    assert!(bench.path("out/recipe/toolpath.csv").is_file());
}

#[test]
fn a_second_run_replaces_the_files_of_the_first() {
    let bench = Bench::with(SADDLE);
    bench
        .line("run recipe.toml -o out --set spindle.speed=100rpm")
        .ends(0);
    let slow = bench.read("out/toolpath.csv");
    bench.line("run recipe.toml -o out").ends(0);
    assert_ne!(bench.read("out/toolpath.csv"), slow);
    let fresh = Bench::with(SADDLE);
    fresh.line("run recipe.toml -o out").ends(0);
    assert_eq!(
        bench.read("out/toolpath.csv"),
        fresh.read("out/toolpath.csv")
    );
    assert_eq!(bench.files(), fresh.files());
}

#[test]
fn folders_are_made_as_deep_as_asked() {
    let bench = Bench::with(SADDLE);
    bench.line("run recipe.toml -o a/b/c").ends(0);
    assert!(bench.path("a/b/c/summary.json").is_file());
}

#[test]
fn without_data_only_the_summary_and_the_page_are_written() {
    let bench = Bench::with(&format!("{SADDLE}\n[output]\ndata = []\n"));
    bench.line("run recipe.toml -o out").ends(0);
    let files = ["out/report.html", "out/summary.json", "recipe.toml"];
    assert_eq!(bench.files(), files);
    bench.line("run recipe.toml -o out --no-report").ends(0);
    assert_eq!(bench.files(), ["out/summary.json", "recipe.toml"]);
}

#[test]
fn report_makes_the_pages_of_results_from_their_folders_alone() {
    let bench = Bench::with(SADDLE);
    let lists = "\n[ablation]\nvelocity = [{ use = \"linear\" }]\n";
    bench.write("two.toml", format!("{SADDLE}{lists}"));
    bench.line("run recipe.toml -o one").ends(0);
    bench.line("ablate two.toml -o two").ends(0);
    let pages = ["one/report.html", "two/report.html"];
    let before = pages.map(|page| bench.read(page));
    for file in ["recipe.toml", "two.toml", pages[0], pages[1]] {
        fs::remove_file(bench.path(file)).unwrap();
    }
    let said = bench.line("report one two").ends(0);
    let lines = pages.map(|page| format!("  file            {page}\n"));
    assert_eq!((said.stdout, said.stderr), (lines.concat(), String::new()));
    assert_eq!(bench.read(pages[1]), before[1]);
    assert_eq!(bench.read(pages[0]).len(), before[0].len());
    let none = bench.line("report one/nowhere").ends(4);
    let title = "error: one/nowhere has no summary.json and no ablation.json\n";
    assert!(none.stderr.starts_with(title), "{none}");
}

#[test]
fn a_path_too_coarse_to_hold_its_interpolation_ends_with_1_and_is_written() {
    let bench = Bench::with(&changed(SADDLE, "9 deg", "40 deg"));
    let said = bench
        .line("run recipe.toml -o out --set refine=false")
        .ends(1);
    let line = said
        .stdout
        .lines()
        .find(|line| line.contains("interpolation"));
    assert!(
        line.is_some_and(|line| line.ends_with("EXCEEDED")),
        "{said}"
    );
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["within"]["interpolation"], false);
    assert_eq!(summary["within"]["residual"], true);
    assert!(bench.path("out/toolpath.csv").is_file());
}

#[test]
fn a_feed_too_large_for_its_residual_ends_with_1() {
    let bench = Bench::with(SADDLE);
    let said = bench
        .line("run recipe.toml -o out --set feed.feed=40um/rev")
        .ends(1);
    let line = said.stdout.lines().find(|line| line.contains("residual"));
    assert!(
        line.is_some_and(|line| line.ends_with("EXCEEDED")),
        "{said}"
    );
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["within"]["interpolation"], true);
    assert_eq!(summary["within"]["residual"], false);
}

#[test]
fn a_path_of_one_turn_holds_no_residual_since_none_is_measured() {
    let bench = Bench::with(SADDLE);
    let words = "run recipe.toml -o out --set feed.feed=2.5mm/rev";
    let said = bench.line(words).ends(1);
    assert!(said.stdout.contains("not measured"), "{said}");
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["residual"]["max_nm"], Value::Null);
    assert_eq!(summary["within"]["residual"], false);
}

#[test]
fn check_reports_what_the_part_needs_of_the_tool() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("check recipe.toml").ends(0);
    assert_eq!(said.stderr, "");
    assert_eq!(bench.files(), ["recipe.toml"]);
    insta::assert_snapshot!(said.stdout);
}

/// The closed forms of the part's own shape, on the ways of the program.
#[test]
fn check_reports_the_shape_of_the_part_itself() {
    let part = |surface: &str, sets: &str| {
        let bench = Bench::with(&with_table(SADDLE, "surface", surface));
        let said = bench.line(&format!("check recipe.toml --format json {sets}"));
        said.ends(0).json()["part"].clone()
    };
    let free = "--set tool.included_angle=\"170 deg\" --set tool.clearance_angle=\"60 deg\"";
    let free = free.replace(['"', ' '], "").replace("--set", " --set ");
    // A sphere: 1/r everywhere, the sagitta r − sqrt(r² − a²), the slope asin(a/r).
    let sphere = part("use = \"conic\"\nradius = \"5 mm\"", &free);
    close(
        &sphere["highest"]["height_mm"],
        5.0 - 18.75f64.sqrt(),
        1e-12,
    );
    assert!(sphere["lowest"]["height_mm"].as_f64().unwrap().abs() < 1e-15);
    close(&sphere["steepest"]["angle_deg"], 30.0, 1e-12);
    close(&sphere["most_hollow"]["curvature_per_mm"], 0.2, 1e-11);
    close(&sphere["most_domed"]["curvature_per_mm"], 0.2, 1e-11);
    // A torus: 1/a along the tube, cos φ over the distance from its axis across.
    let tube = "use = \"toric\"\nradius_rotation = \"20 mm\"\nradius_base = \"8 mm\"";
    let torus = part(tube, &free);
    let cos = (1.0f64 - 0.3125 * 0.3125).sqrt();
    close(&torus["most_hollow"]["curvature_per_mm"], 0.125, 1e-11);
    close(
        &torus["most_domed"]["curvature_per_mm"],
        cos / (12.0 + 8.0 * cos),
        1e-11,
    );
    close(&torus["highest"]["height_mm"], 8.0 - 8.0 * cos, 1e-11);
    // A paraboloid: 1/r at the vertex, the slope a/r at the rim.
    let paraboloid = part("use = \"conic\"\nradius = \"-2.5 mm\"\nconic = -1", &free);
    close(&paraboloid["most_domed"]["curvature_per_mm"], -0.4, 1e-11);
    close(&paraboloid["lowest"]["height_mm"], -1.25, 1e-12);
    close(&paraboloid["steepest"]["angle_deg"], 45.0, 1e-12);
    // z = k ρ² sin 2θ: the saddle.
    let saddle = part("use = \"astigmatic\"\nk = \"0.08 /mm\"", "");
    close(&saddle["highest"]["height_mm"], 0.5, 1e-12);
    close(&saddle["lowest"]["height_mm"], -0.5, 1e-12);
    close(&saddle["most_hollow"]["curvature_per_mm"], 0.16, 1e-11);
    close(&saddle["most_domed"]["curvature_per_mm"], -0.16, 1e-11);
}

/// A tool that does not fit, and a feed that no path can have: the part has its shape anyway.
#[test]
fn check_reports_the_shape_of_a_part_that_it_refuses() {
    let bench = Bench::with(SADDLE);
    let shape = bench.line("check recipe.toml --format json").ends(0).json()["part"].clone();
    for refused in ["tool.nose_radius=7mm", "feed.feed=1e-7um/rev"] {
        let line = format!("check recipe.toml --set {refused}");
        let said = bench.line(&format!("{line} --format json")).ends(2);
        assert!(said.stderr.contains("error: "), "{said}");
        let report = said.json();
        assert_eq!(report["part"], shape);
        assert_eq!(report["format"], 2);
        let why = report["refused"].as_str().unwrap();
        assert!(said.stderr.contains(why.lines().next().unwrap()), "{why}");
        let said = bench.line(&line).ends(2);
        let steepest = said.stdout.lines().find(|line| line.contains("steepest"));
        assert!(
            steepest.is_some_and(|line| line.contains("by 21.80 deg")),
            "{said}"
        );
    }
}

/// The largest nose is limited on the part, or on the overrun of so large a nose; both say so. Where
/// the surface ends within the reach of a larger nose, no place limits it.
#[test]
fn the_largest_nose_is_limited_on_the_part_or_on_its_overrun_or_by_the_end_of_the_surface() {
    let angles = "included_angle = \"120 deg\"\nclearance_angle = \"30 deg\"\n";
    for (surface, on) in [
        // The most curved at the vertex; farther out the farther out; and an ellipsoid that ends.
        ("use = \"conic\"\nradius = \"9 mm\"\nconic = -1", "part"),
        ("use = \"formula\"\nz = \"0.002/mm^3*rho^4\"", "overrun"),
        ("use = \"conic\"\nradius = \"9 mm\"\nconic = 0.8", "nowhere"),
    ] {
        let bench = Bench::with(&changed(
            &with_table(SADDLE, "surface", surface),
            angles,
            "",
        ));
        let line = "check recipe.toml --set path.overrun=none";
        let report = bench.line(&format!("{line} --format json")).ends(0).json();
        let nose = &report["margins"]["nose_radius"];
        let text = bench.line(line).ends(0).stdout;
        let row = text
            .lines()
            .find(|line| line.contains("nose radius"))
            .unwrap();
        if on == "nowhere" {
            assert!(
                nose["most_mm"].as_f64() > Some(1.0) && nose["at"].is_null(),
                "{nose}"
            );
            assert!(row.ends_with("to spare"), "{text}");
            continue;
        }
        assert_eq!(nose["at"]["on"], on, "{nose}");
        let rho = nose["at"]["rho_mm"].as_f64().unwrap();
        assert_eq!(rho > 2.5 + 1e-9, on == "overrun", "{nose}");
        assert!(row.ends_with(&format!("({on})")), "{text}");
        let refused = bench
            .line(&format!("{line} --set tool.nose_radius=20mm"))
            .ends(2);
        assert!(refused.stderr.contains(&format!("({on})")), "{refused}");
    }
}

#[test]
fn check_reports_that_a_tool_without_angles_is_not_checked_for_them() {
    let angles = "included_angle = \"120 deg\"\nclearance_angle = \"30 deg\"\n";
    let bench = Bench::with(&changed(SADDLE, angles, ""));
    let said = bench.line("check recipe.toml").ends(0);
    assert_eq!(said.stdout.matches("check not made").count(), 2, "{said}");
}

#[test]
fn check_in_json_agrees_with_closed_forms_and_with_the_run() {
    let bench = Bench::with(SADDLE);
    let checked = bench.line("check recipe.toml --format json").ends(0).json();
    // z = 0.16 x y: curvature 0.16 /mm at the centre, along 45 degrees.
    close(&checked["largest_nose_radius_mm"], 1.0 / 0.16, 1e-6);
    let summary = bench
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json();
    let expected = &checked["expected"];
    assert_eq!(expected["revolutions"], summary["revolutions"]);
    assert_eq!(expected["cutting_time_s"], summary["cutting_time_s"]);
    let points = summary["control_points"].as_f64().unwrap();
    close(&expected["control_points"], points, 0.02);
    let size = fs::metadata(bench.path("out/toolpath.csv")).unwrap().len();
    close(&expected["toolpath_bytes"], size as f64, 0.2);
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let bench = Bench::with(SADDLE);
    for words in [
        "list",
        "check recipe.toml",
        "run recipe.toml -o out --format json",
    ] {
        let mut command = bench.command(words.split_whitespace());
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut messages = String::new();
        let mut stderr = child.stderr.take().unwrap();
        stderr.read_to_string(&mut messages).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{words}: {messages}");
        assert_eq!(messages, "", "{words}");
    }
}

#[test]
fn the_version_is_printed() {
    let said = Bench::empty().line("--version").ends(0);
    assert_eq!(
        said.stdout,
        format!("turnpath {}\n", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn help_lists_every_command_and_the_exit_statuses() {
    let said = Bench::empty().line("--help").ends(0);
    for word in [
        "run",
        "check",
        "verify",
        "sag",
        "list",
        "explain",
        "Exit status",
    ] {
        assert!(said.stdout.contains(word), "`{word}` is missing\n{said}");
    }
}

#[test]
fn every_example_in_the_docs_passes_its_check() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/recipes");
    let mut seen = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        if file
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let bench = Bench::empty();
            let said = bench.call(["check".as_ref(), file.as_os_str()]);
            said.ends(0);
            seen += 1;
        }
    }
    assert!(seen > 0, "there are no recipes in docs/recipes");
}

/// z = 0.16 x y cut to X = 2.5 mm: contact ends at 2.17 mm where the profile falls outward.
#[test]
fn uncut_material_is_reported_and_judged_only_where_the_path_covers_the_part() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml -o out").ends(0);
    assert!(said.stdout.contains("coverage        rim "), "{said}");
    assert!(said.stdout.contains("(overrun = \"none\")"), "{said}");
    assert!(!said.stdout.contains("warning"), "{said}");
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let coverage = &summary["coverage"];
    let rim = coverage["rim"]["height_nm"].as_f64().unwrap();
    assert!((67e3..77e3).contains(&rim), "{rim} nm");
    assert_eq!(coverage["hole"], Value::Null);
    assert!(coverage["centre"]["height_nm"].as_f64().unwrap() > 100.0);
    assert_eq!(summary["within"]["coverage"], Value::Null);
    assert_eq!(summary["axis_crossing"]["x_um"], 0.0);
}

#[test]
fn x_beyond_the_axis_is_a_warning() {
    let tilted = "use = \"xy-polynomial\"\nterms = [[1, 0, 0.1]]";
    let recipe = with_table(SADDLE, "surface", tilted);
    let bench = Bench::with(&with_table(&recipe, "compensator", "use = \"normal\""));
    let said = bench.line("run recipe.toml -o out").ends(0);
    let warning = "  warning         X crosses the axis by ";
    assert!(said.stdout.contains(warning), "{said}");
    assert!(said.stdout.contains("as the normal of a tilted"), "{said}");
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    // At ρ = 0 X is 0.1/sqrt(1.01) mm beyond the axis; the last pass on that side lies up to a
    // feed of 28 um further out.
    let crossing = summary["axis_crossing"]["x_um"].as_f64().unwrap();
    assert!((71.0..99.6).contains(&crossing), "{crossing} um");
    assert!(summary["axis_crossing"]["contact_um"].as_f64().unwrap() < 1e-6);
}

/// Inward the law of `ats` goes on beyond the axis, contact and all.
#[test]
fn a_feed_beyond_the_axis_is_a_warning_of_its_own() {
    let recipe = with_table(SADDLE, "feed", "use = \"ats\"");
    let bench = Bench::with(&recipe);
    let set = "run recipe.toml -o out --set path.direction=inward";
    let said = bench.line(set);
    let why = "since the feed goes on there; beyond it";
    assert!(said.stdout.contains(why), "{said}");
    let said = bench.line(&format!("{set} --set feed.inward=backwards"));
    assert!(!said.stdout.contains("crosses the axis"), "{said}");
}

/// Each program turns the part its own way, and `check` says so for each.
#[test]
fn check_says_which_way_each_program_turns_the_part() {
    let bench = Bench::with(SADDLE);
    let turned = "--set output.posts=[\"pmac-pvt\",\"nanotech-g93\"] --set output.pmac-pvt.c_sign=-1 --set output.nanotech-g93.f_means=s";
    let said = bench.line(&format!("check recipe.toml {turned}")).ends(0);
    let lines: Vec<&str> = said
        .stdout
        .lines()
        .filter(|line| line.contains("turns the part"))
        .collect();
    assert_eq!(lines.len(), 2, "{said}");
    assert!(
        lines[0].contains("anticlockwise") && lines[0].ends_with(".pmc)"),
        "{said}"
    );
    assert!(
        lines[1].contains(" clockwise") && lines[1].ends_with(".nc)"),
        "{said}"
    );
    let said = bench.line("check recipe.toml").ends(0);
    assert_eq!(said.stdout.matches("turns the part").count(), 1, "{said}");
}
