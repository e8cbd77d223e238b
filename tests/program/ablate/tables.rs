//! The table of an ablation on a terminal, and as CSV.

use super::*;

/// Widest table.
const WIDEST: usize = 100;

#[test]
fn the_csv_has_the_figures_of_the_json() {
    let bench = Bench::with(&saddle("tool.nose_radius = [\"0.5 mm\", \"50 mm\"]"));
    ablate(&bench, "").ends(0);
    let runs = runs(&bench);
    let csv = bench.read("out/ablation.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let header = &rows[0];
    assert_eq!(
        header[..4],
        [
            "run",
            "tool.nose_radius",
            "points",
            "points_added_by_refine"
        ]
    );
    assert_eq!(rows.len(), 4);
    let column = |name: &str| header.iter().position(|one| *one == name).unwrap();
    for (row, run) in rows[1..3].iter().zip(&runs) {
        for (name, pointer) in [
            ("points", "/control_points"),
            ("cutting_time_s", "/cutting_time_s"),
            ("error_max_nm", "/interpolation_error/max_nm"),
            ("residual_nm", "/residual/max_nm"),
            (
                "z_acceleration_rms_mm_per_s2",
                "/axes/z/rms_acceleration_mm_per_s2",
            ),
            ("program_bytes", "/program_bytes"),
            ("planning_time_s", "/planning_time_s"),
            ("measuring_time_s", "/measuring_time_s"),
        ] {
            let figure: f64 = row[column(name)].parse().unwrap();
            assert_eq!(
                Some(figure),
                run.pointer(pointer).unwrap().as_f64(),
                "{name}"
            );
        }
        assert_eq!(row[column("reason")], "");
    }
    let failed = csv.lines().nth(3).unwrap();
    assert!(failed.starts_with("3,50 mm,,,,"), "{failed}");
    assert!(failed.contains("the tool would gouge"), "{failed}");
}

/// The usual columns without planning times.
const COLUMNS: &str = "--columns points,added,revolutions,time,error-max,error-rms,residual,\
                       x-acceleration-law,z-acceleration,program-size";

/// Over the last 1.25 turns at either end the host lets the feed run out by f n (s³ − s⁴/2) with
/// s = m/n: X accelerates by 1.5 f/n at the most, and a constant feed by nothing between.
#[test]
fn the_x_acceleration_that_is_compared_is_that_of_the_law() {
    let covered = changed(SADDLE, "overrun = \"none\"", "overrun = \"contact\"");
    let feed = "use = \"constant\"\nfeed = \"20 um\"";
    let recipe = with_table(&covered, "feed", feed);
    let bench = Bench::with(&format!(
        "{recipe}\n[ablation]\nvelocity = [{{ use = \"analytic\" }}]\n"
    ));
    ablate(&bench, "").ends(0);
    let run = &runs(&bench)[1];
    let of = |pointer: &str| run.pointer(pointer).unwrap().as_f64().unwrap();
    let turns_per_second = of("/revolutions") / of("/cutting_time_s");
    let running_out = 1.5 * 0.02 / 1.25 * turns_per_second * turns_per_second;
    let whole = of("/axes/x/max_acceleration_mm_per_s2");
    assert!(
        (whole / running_out - 1.0).abs() < 0.01,
        "{whole} {running_out}"
    );
    let own = of("/axes_of_law/x/max_acceleration_mm_per_s2");
    assert!(own < 1e-6 * whole, "{own}");
    let velocity = of("/axes_of_law/x/max_velocity_mm_per_s");
    assert!((velocity / (0.02 * turns_per_second) - 1.0).abs() < 1e-9);
}

#[test]
fn the_table_has_all_columns_within_100() {
    let bench = Bench::with(&saddle(
        "tolerance.residual = [\"50 nm\"]\nvelocity = [{ use = \"three-point\" }]\n\
         tool.nose_radius = [\"50 mm\"]",
    ));
    let said = ablate(&bench, "").ends(0);
    for line in said.stdout.lines() {
        assert!(line.chars().count() <= WIDEST, "{line}");
    }
    // All in one table, the last with its unit.
    assert_eq!(said.stdout.matches("───\n").count(), 1, "{said}");
    assert!(
        said.stdout.lines().nth(6).unwrap().ends_with(" s"),
        "{said}"
    );
    insta::assert_snapshot!(ablate(&bench, COLUMNS).ends(0).stdout);
}

#[test]
fn columns_can_be_chosen() {
    let bench = Bench::with(&saddle("velocity = [{ use = \"three-point\" }]"));
    let said = ablate(&bench, "--columns z-jerk-max,error-max,points").ends(0);
    insta::assert_snapshot!(said.stdout);
    let said = ablate(&bench, "--columns points,eror-max").ends(2);
    assert!(said.stderr.contains("'error-max'"), "{said}");
}

/// What the narrower terminal leaves out of a line follows in a further table.
#[test]
fn a_narrow_terminal_gets_narrow_tables() {
    let bench = Bench::with(&saddle("tool.nose_radius = [\"50 mm\"]"));
    let widths = [
        ("60", 60, 2),
        ("1", 40, 4),
        ("0", WIDEST, 1),
        ("wide", WIDEST, 1),
    ];
    for (columns, widest, tables) in widths {
        let mut command = bench.command(["ablate", "recipe.toml", "-o", "out"]);
        let said = answer(command.env("COLUMNS", columns)).ends(0);
        let table = said.stdout.lines().skip(1);
        let table = table.filter(|line| !line.contains("file"));
        let longest = table.map(|line| line.chars().count()).max();
        assert!(longest.is_some_and(|longest| longest <= widest), "{said}");
        assert_eq!(said.stdout.matches("───\n").count(), tables, "{said}");
        assert!(said.stdout.contains("failed:"), "{said}");
    }
}

/// Every column but those of what this recipe does not ask for: a hole, limits, a nose that does
/// not fit, tolerances of form and servo, rough paths.
#[test]
fn every_figure_of_a_run_has_its_column() {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    let bench = Bench::with(&format!(
        "{recipe}\n[servo]\nbandwidth = \"100 Hz\"\n\n[ablation]\nvelocity = [{{ use = \"three-point\" }}]\n"
    ));
    ablate(&bench, "").ends(0);
    let csv = bench.read("out/ablation.csv");
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (head, row) = (lines.next().unwrap(), lines.next().unwrap());
    let empty: Vec<&str> = head
        .iter()
        .zip(&row)
        .filter(|(_, figure)| figure.is_empty())
        .map(|(name, _)| *name)
        .collect();
    let expected = [
        "unreached_height_um",
        "uncut_at_hole_nm",
        "highest_spindle_rpm",
        "form_error_nm",
        "form_residual_nm",
        "form_interpolation_nm",
        "form_rounds",
        "within_form",
        "within_coverage",
        "within_machine",
        "within_servo",
        "within_passes",
        "reason",
    ];
    assert_eq!(empty, expected);
}
