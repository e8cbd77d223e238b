//! `turnpath verify`: the program's own files measured again, and files that were spoiled.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};
use serde_json::Value;

/// A bench with the saddle's run in `out`.
fn made() -> Bench {
    made_of(SADDLE)
}

fn made_of(recipe: &str) -> Bench {
    let bench = Bench::with(recipe);
    bench.line("run recipe.toml -o out").ends(0);
    bench
}

/// The bench's own path, rewritten line by line; the header is line 0.
fn spoiled(change: impl FnOnce(&mut Vec<String>)) -> (Bench, Answer) {
    let bench = made();
    let mut lines: Vec<String> = bench
        .read("out/toolpath.csv")
        .lines()
        .map(String::from)
        .collect();
    change(&mut lines);
    bench.write("spoiled.csv", lines.join("\n") + "\n");
    let said = bench.line("verify recipe.toml spoiled.csv --format json");
    (bench, said)
}

/// A line with one column changed.
fn edit(line: &mut String, column: usize, change: impl FnOnce(f64) -> String) {
    let mut values: Vec<String> = line.split(',').map(String::from).collect();
    values[column] = change(values[column].parse().unwrap());
    *line = values.join(",");
}

const Z: usize = 3;
const VX: usize = 5;

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

#[track_caller]
fn same(one: &Value, other: &Value, pointer: &str) {
    let (one, other) = (number(one, pointer), number(other, pointer));
    let close = (one - other).abs() <= 1e-9 * one.abs();
    assert!(close, "{pointer}: {one}, {other}");
}

#[track_caller]
fn refused_at(said: &Answer, line: usize, word: &str) {
    assert_eq!(said.status, Some(4), "{said}");
    assert_eq!(said.stdout, "");
    assert!(
        said.stderr.contains(&format!("spoiled.csv, line {line}: ")),
        "{said}"
    );
    assert!(said.stderr.contains(word), "{said}");
}

#[test]
fn a_file_of_the_program_gives_the_figures_of_its_summary() {
    let refined = changed(SADDLE, "9 deg", "20 deg");
    let analytic = saddle_with("velocity", "use = \"analytic\"");
    let outward = changed(SADDLE, "overrun", "direction = \"outward\"\noverrun");
    let normal = with_table(&analytic, "compensator", "use = \"normal\"");
    let contact = with_table(&analytic, "compensator", "use = \"none\"");
    for recipe in [SADDLE, &refined, &outward, &normal, &contact] {
        let bench = made_of(recipe);
        let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
        let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
        let verified = said.ends(0).json();
        for pointer in [
            "/control_points",
            "/rows",
            "/interpolation_error/max_nm",
            "/interpolation_error/rms_nm",
            "/interpolation_error/at/c_deg",
            "/interpolation_error/at/x_mm",
            "/residual/max_nm",
            "/coverage/rim/height_nm",
            "/coverage/centre/height_nm",
            "/axes/x/max_velocity_mm_per_s",
            "/axes/z/max_velocity_mm_per_s",
            "/axes/z/max_acceleration_mm_per_s2",
            "/axes/z/rms_acceleration_mm_per_s2",
            "/axes/c/max_velocity_deg_per_s",
        ] {
            same(&summary, &verified, pointer);
        }
        for tolerance in ["interpolation", "residual", "machine"] {
            assert_eq!(summary["within"][tolerance], verified["within"][tolerance]);
        }
        assert_eq!(verified["within"]["reach"], true);
    }
}

/// A nose of 1 mm fits lenses of 10 mm, so nothing is left between them, though the recipe would allow it.
const LENSES: &str = r#"format = 1
name = "Lenses"

[part]
aperture = "3 mm"

[surface]
use = "lenslet-array"
layout = "hexagonal"
pitch = "1.5 mm"
radius = "10 mm"

[tool]
nose_radius = "1 mm"
interference = "cut-what-fits"

[tolerance]
form = "300 nm"

[spindle]
speed = "60 rpm"

[path]
lead = false

[feed]
use = "atpg"

[sampler]
use = "equal-arc"
spacing = "0.1 mm"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"
"#;

#[test]
fn a_nose_that_fits_everywhere_is_measured_as_in_its_run() {
    let bench = made_of(LENSES);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
    let report = said.ends(0).json();
    for pointer in [
        "/form/pv_nm",
        "/interpolation_error/max_nm",
        "/residual/max_nm",
        "/played_cusp/max_nm",
        "/surface_error/pv_nm",
    ] {
        same(&report, &summary, pointer);
    }
    assert_eq!(report["unreached"], summary["unreached"]);
    // The feed strategy need not be there.
    let elsewhere = "verify recipe.toml out/toolpath.csv --format json --set feed.use=elsewhere";
    let report = bench.line(elsewhere).ends(0).json();
    same(&report, &summary, "/form/pv_nm");
}

/// Where a hollow part slopes up to its rim all around, X ends inside of the rim that the contact
/// reaches; on a crown beyond it.
#[test]
fn a_path_whose_contact_goes_to_the_rim_covers_it_wherever_x_is() {
    for radius in ["40 mm", "-40 mm"] {
        let surface = format!("use = \"conic\"\nradius = \"{radius}\"");
        let recipe = with_table(SADDLE, "surface", &surface);
        let bench = made_of(&changed(&recipe, "\"none\"", "\"contact\""));
        let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
        assert_eq!(said.ends(0).json()["within"]["reach"], true);
    }
}

#[test]
fn a_person_gets_the_figures_and_the_verdict() {
    let bench = made();
    let said = bench.line("verify recipe.toml out/toolpath.csv").ends(0);
    assert_eq!(said.stderr, "");
    assert_eq!(said.stdout.matches("holds").count(), 3, "{said}");
    let reach = "  reach           X or contact from 0.000 mm to 2.500 mm; holds\n";
    assert!(said.stdout.contains(reach), "{said}");
}

/// The path from one line to another alone, which holds all tolerances where it cuts.
fn part_of_it(lines: std::ops::Range<usize>) -> Value {
    let (_, said) = spoiled(|all| {
        *all = [&all[..1], &all[lines]].concat();
    });
    let verified = said.ends(1).json();
    assert_eq!(verified["within"]["interpolation"], true);
    assert_eq!(verified["within"]["residual"], true);
    assert_eq!(verified["within"]["reach"], false);
    verified
}

#[test]
fn a_path_that_ends_before_the_axis_does_not_hold() {
    let verified = part_of_it(1..2001);
    assert_eq!(number(&verified, "/reach/outer_mm"), 2.5);
    assert!(number(&verified, "/reach/inner_mm") > 1.0, "{verified}");
}

#[test]
fn a_path_that_begins_inside_the_rim_does_not_hold() {
    let verified = part_of_it(2001..4001);
    assert!(number(&verified, "/reach/outer_mm") < 1.5, "{verified}");
}

#[test]
fn the_path_of_a_smaller_part_does_not_hold_and_reports_where_it_ends() {
    let bench = made();
    let words = "verify recipe.toml out/toolpath.csv --set part.aperture=10mm \
                 --set tool.included_angle=150deg --set tool.clearance_angle=60deg";
    let said = bench.line(words).ends(1);
    let line = "reach           X or contact from 0.000 mm to 2.500 mm; EXCEEDED: the part reaches \
                from 0.000 mm to 5.000 mm\n";
    assert!(said.stdout.contains(line), "{said}");
    assert_eq!(said.stdout.matches("holds").count(), 2, "{said}");
}

#[test]
fn a_path_of_contacts_is_held_to_the_part_by_its_contacts() {
    let normal = saddle_with("compensator", "use = \"normal\"");
    let said = made_of(&normal).line("verify recipe.toml out/toolpath.csv");
    let line = "reach           contact from 0.000 mm to 2.500 mm; holds\n";
    assert!(said.ends(0).stdout.contains(line));
}

#[test]
fn an_x_of_three_hundred_digits_is_shortened() {
    let (bench, _) = spoiled(|lines| {
        edit(&mut lines[2000], 2, |_| "1e300".to_owned());
    });
    let said = bench.line("verify recipe.toml spoiled.csv").ends(1);
    assert!(said.stdout.lines().all(|line| line.len() < 120), "{said}");
}

#[test]
fn a_path_of_another_surface_is_measured_as_one() {
    let bench = made();
    let said = bench.line("verify recipe.toml out/toolpath.csv --set surface.k=0.081/mm");
    assert!(said.ends(1).stdout.contains("EXCEEDED"));
}

#[test]
fn a_point_that_is_moved_by_50_nm_shows_in_the_error_and_still_holds() {
    let before = made()
        .line("verify recipe.toml out/toolpath.csv --format json")
        .json();
    let (_, said) = spoiled(|lines| {
        edit(&mut lines[2000], Z, |z| (z + 50e-6).to_string());
    });
    let after = said.ends(0).json();
    let max = number(&after, "/interpolation_error/max_nm");
    assert!(number(&before, "/interpolation_error/max_nm") < 40.0);
    assert!((45.0..=60.0).contains(&max), "{max} nm");
}

#[test]
fn a_point_that_is_moved_by_500_nm_exceeds_the_tolerance_there() {
    let mut c = 0.0;
    let (_, said) = spoiled(|lines| {
        edit(&mut lines[2000], Z, |z| (z + 500e-6).to_string());
        c = lines[2000].split(',').nth(1).unwrap().parse().unwrap();
    });
    let verified = said.ends(1).json();
    let max = number(&verified, "/interpolation_error/max_nm");
    assert!((490.0..=520.0).contains(&max), "{max} nm");
    let at = number(&verified, "/interpolation_error/at/c_deg");
    assert!((at - c).abs() <= 9.0, "found at {at} deg, moved at {c} deg");
    assert_eq!(verified["within"]["interpolation"], false);
    assert_eq!(verified["within"]["residual"], true);
}

#[test]
fn a_velocity_that_is_wrong_shows_in_the_error() {
    let (_, said) = spoiled(|lines| {
        edit(&mut lines[2000], VX + 1, |vz| (vz + 1.0).to_string());
    });
    said.ends(1);
}

#[test]
fn a_value_that_is_no_number_is_refused() {
    let (_, said) = spoiled(|lines| edit(&mut lines[9], Z, |_| "NaN".to_owned()));
    refused_at(&said, 10, "finite");
    let (_, said) = spoiled(|lines| edit(&mut lines[9], VX, |_| "inf".to_owned()));
    refused_at(&said, 10, "finite");
    let (_, said) = spoiled(|lines| edit(&mut lines[9], Z, |_| "high".to_owned()));
    refused_at(&said, 10, "z_mm");
}

#[test]
fn rows_that_are_swapped_are_refused() {
    let (_, said) = spoiled(|lines| lines.swap(100, 101));
    refused_at(&said, 102, "time");
}

#[test]
fn a_row_that_is_missing_shows_in_the_error() {
    let before = made().line("verify recipe.toml out/toolpath.csv --format json");
    let mut c = 0.0;
    let (_, said) = spoiled(|lines| {
        c = lines
            .remove(2000)
            .split(',')
            .nth(1)
            .unwrap()
            .parse()
            .unwrap();
    });
    let (before, after) = (before.ends(0).json(), said.ends(0).json());
    let max = "/interpolation_error/max_nm";
    assert!(number(&after, max) > 1.3 * number(&before, max), "{after}");
    let at = number(&after, "/interpolation_error/at/c_deg");
    assert!(
        (at - c).abs() <= 9.0,
        "found at {at} deg, removed at {c} deg"
    );
}

#[test]
fn a_revolution_that_is_missing_is_refused() {
    let (_, said) = spoiled(|lines| drop(lines.drain(2000..2045)));
    refused_at(&said, 2001, "C turns");
}

#[test]
fn a_last_line_that_is_cut_is_refused() {
    let mut count = 0;
    let (_, said) = spoiled(|lines| {
        count = lines.len();
        let last = lines.last_mut().unwrap();
        last.truncate(last.len() / 2);
    });
    refused_at(&said, count, "values");
}

#[test]
fn a_last_line_that_is_cut_within_its_last_number_is_refused() {
    let bench = made();
    let text = bench.read("out/toolpath.csv");
    let cut = text.trim_end().strip_suffix(",1").unwrap();
    bench.write("spoiled.csv", cut);
    let said = bench.line("verify recipe.toml spoiled.csv");
    refused_at(&said, text.lines().count(), "values");
}

#[test]
fn another_header_is_refused() {
    let (_, said) = spoiled(|lines| lines[0] = lines[0].replace("c_deg", "c_rad"));
    refused_at(&said, 1, "header");
    let (_, said) = spoiled(|lines| drop(lines.remove(0)));
    refused_at(&said, 1, "header");
}

#[test]
fn an_empty_file_is_refused() {
    let (_, said) = spoiled(Vec::clear);
    refused_at(&said, 1, "header");
    let (_, said) = spoiled(|lines| lines.truncate(1));
    let said = said.ends(4);
    assert!(said.stderr.contains("no cutting section"), "{said}");
}

#[test]
fn a_section_that_does_not_exist_is_refused() {
    let (_, said) = spoiled(|lines| edit(&mut lines[5], 7, |_| "3".to_owned()));
    refused_at(&said, 6, "section");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("verify recipe.toml no.csv").ends(4);
    assert!(said.stderr.contains("no.csv"), "{said}");
    let said = bench.line("verify recipe.toml .").ends(4);
    assert!(said.stderr.starts_with("error: "), "{said}");
}

#[test]
fn a_path_beyond_the_surface_gives_no_number_and_does_not_hold() {
    let sphere = saddle_with("surface", "use = \"conic\"\nradius = \"3 mm\"");
    let bench = Bench::with(&sphere);
    let path = made().read("out/toolpath.csv");
    bench.write("path.csv", path.replace(",2.4", ",9.4"));
    let said = bench.line("verify recipe.toml path.csv").ends(1);
    assert!(said.stdout.contains("no number"), "{said}");
    assert!(!said.stdout.contains("NaN"), "{said}");
}

/// Such a Z overflows the squares of the surface error.
#[test]
fn figures_that_overflow_are_null_and_not_zero() {
    let (_, said) = spoiled(|lines| {
        let middle = lines.len() / 2;
        edit(&mut lines[middle], Z, |_| "1e308".to_owned());
    });
    let error = &said.ends(1).json()["surface_error"];
    assert_eq!(error["rms_nm"], Value::Null, "{error}");
    assert_eq!(error["sq_nm"], Value::Null, "{error}");
}

#[test]
fn a_call_without_a_file_or_with_a_folder_says_what_is_missing() {
    let bench = made();
    let said = bench.line("verify recipe.toml").ends(2);
    assert!(
        said.stderr.contains("`turnpath verify recipe.toml FILE`"),
        "{said}"
    );
    let said = bench.line("verify recipe.toml out").ends(4);
    assert!(
        said.stderr.contains("cannot read out: it is a folder"),
        "{said}"
    );
}

#[test]
fn the_beginning_of_a_path_does_not_reach_the_whole_part() {
    let recipe = changed(SADDLE, "overrun = \"none\"", "overrun = \"contact\"");
    let bench = made_of(&recipe);
    let table = bench.read("out/toolpath.csv");
    let beginning: Vec<&str> = table.lines().take(400).collect();
    bench.write("beginning.csv", beginning.join("\n") + "\n");
    let said = bench.line("verify recipe.toml beginning.csv").ends(1);
    let reached = "coverage         not reached                EXCEEDED";
    assert!(said.stdout.contains(reached), "{said}");
}

/// A bump of 60 nm and 4 um, which no instant of such long steps meets. The machined surface shows it.
#[test]
fn a_gouge_that_no_instant_meets_has_a_warning() {
    let surface = "use = \"formula\"\nz = \"rho^2/(2*R) + B*exp(-((x-x0)^2+(y-y0)^2)/w^2)\"\n\n\
        [surface.constants]\nR = \"60 mm\"\nB = \"60 nm\"\nx0 = \"1.7 mm\"\ny0 = \"1.1 mm\"\nw = \"4 um\"\n";
    let recipe = changed(SADDLE, "use = \"astigmatic\"\nk = \"0.08 /mm\"\n", surface);
    let recipe = changed(&recipe, "step = \"9 deg\"", "step = \"36 deg\"");
    let recipe = changed(
        &recipe,
        "nose_radius = \"1 mm\"",
        "nose_radius = \"0.1 mm\"",
    );
    let bench = Bench::with(&recipe);
    bench.line("run recipe.toml -o out -q").ends(0);
    let said = bench.line("verify recipe.toml out/toolpath.csv").ends(0);
    let warning = "  warning         the machined surface lies 3";
    assert!(said.stdout.contains(warning), "{said}");
    assert!(
        bench
            .read("out/report.html")
            .contains("<li>the machined surface lies 3")
    );
    let said = Bench::with(SADDLE).line("run recipe.toml -o out").ends(0);
    assert!(!said.stdout.contains("warning"), "{said}");
}
