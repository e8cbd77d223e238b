//! `turnpath sag`: the surface on a grid, against closed forms.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, saddle_with};

/// Rows of the grid as numbers, after the header.
fn grid(bench: &Bench, count: u32) -> Vec<[f64; 5]> {
    let words = format!("sag recipe.toml --grid {count} -o sag.csv");
    let said = bench.line(&words).ends(0);
    assert_eq!((said.stdout.as_str(), said.stderr.as_str()), ("", ""));
    let text = bench.read("sag.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x_mm,y_mm,z_mm,zx,zy"));
    let row = |line: &str| -> [f64; 5] {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        values.try_into().unwrap()
    };
    lines.map(row).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() < 1e-14,
        "{what}: {found}, not {expected}"
    );
}

#[test]
fn height_and_slopes_of_the_saddle_are_those_of_its_closed_form() {
    let rows = grid(&Bench::with(SADDLE), 11);
    assert_eq!(rows.len(), 121);
    for (index, [x, y, z, zx, zy]) in rows.into_iter().enumerate() {
        let at = |i: usize| -2.5 + 0.5 * i as f64;
        near(x, at(index % 11), "x");
        near(y, at(index / 11), "y");
        near(z, 0.16 * x * y, "z");
        near(zx, 0.16 * y, "zx");
        near(zy, 0.16 * x, "zy");
    }
}

#[test]
fn the_smallest_grid_is_the_four_corners_of_the_square_around_the_aperture() {
    let rows = grid(&Bench::with(SADDLE), 2);
    let corners: Vec<(f64, f64)> = rows.iter().map(|row| (row[0], row[1])).collect();
    let expected = [(-2.5, -2.5), (2.5, -2.5), (-2.5, 2.5), (2.5, 2.5)];
    assert_eq!(corners, expected);
    assert_eq!(rows[0][2], 1.0);
    assert_eq!(rows[1][2], -1.0);
}

#[test]
fn where_a_surface_has_no_height_the_grid_has_nan() {
    let sphere = saddle_with("surface", "use = \"conic\"\nradius = \"3 mm\"");
    let rows = grid(&Bench::with(&sphere), 21);
    let mut beyond = 0;
    for [x, y, z, zx, zy] in rows {
        let squared = x * x + y * y;
        if squared > 9.0 {
            assert!(z.is_nan() && zx.is_nan() && zy.is_nan(), "{x}, {y}: {z}");
            beyond += 1;
        } else {
            near(z, 3.0 - (9.0 - squared).sqrt(), "z");
        }
    }
    assert!(beyond >= 4, "the corners lie beyond the sphere");
}

#[test]
fn the_values_are_those_of_the_recipe_with_its_settings() {
    let bench = Bench::with(SADDLE);
    let words = "sag recipe.toml --grid 2 -o sag.csv --set surface.k=0.04/mm";
    bench.line(words).ends(0);
    assert_eq!(
        bench.read("sag.csv").lines().nth(1),
        Some("-2.5,-2.5,0.5,-0.2,-0.2")
    );
}

#[test]
fn a_folder_that_is_not_there_is_named() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("sag recipe.toml --grid 3 -o no/sag.csv").ends(4);
    assert!(said.stderr.contains("no/sag.csv"), "{said}");
    assert!(!said.stderr.contains(".part"), "{said}");
    assert_eq!(bench.files(), ["recipe.toml"]);
}

#[cfg(unix)]
#[test]
fn a_folder_or_pipe_is_not_replaced_by_a_file() {
    let bench = Bench::with(SADDLE);
    let pipe = bench.path("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let said = bench.line("sag recipe.toml --grid 3 -o pipe").ends(4);
    assert_eq!(
        said.stderr,
        "error: cannot write pipe: it is not a regular file\n"
    );
    assert_eq!(bench.files(), ["pipe", "recipe.toml"]);
    assert!(!std::fs::metadata(pipe).unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn a_grid_has_the_permissions_that_the_umask_allows() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::with(SADDLE);
    for (umask, mode) in [("027", 0o640), ("002", 0o664), ("077", 0o600)] {
        let line = format!("umask {umask}; exec \"$0\" sag recipe.toml --grid 3 -o sag.csv");
        let shell = ["-c", &line, crate::support::bench::TURNPATH];
        let status = bench.command_of("sh".as_ref(), shell).status().unwrap();
        assert!(status.success());
        let found = std::fs::metadata(bench.path("sag.csv")).unwrap();
        assert_eq!(found.permissions().mode() & 0o777, mode, "umask {umask}");
    }
}

#[test]
fn a_grid_replaces_the_one_before_it() {
    let bench = Bench::with(SADDLE);
    let first = grid(&bench, 5);
    assert_eq!((first.len(), grid(&bench, 3).len()), (25, 9));
    assert_eq!(bench.files(), ["recipe.toml", "sag.csv"]);
}
