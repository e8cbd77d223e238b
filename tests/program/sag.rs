//! `turnpath sag`: the surface on a grid, against closed forms.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath_maps::{Conventions, Map};

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, saddle_with};

/// Rows of the grid as numbers, after the header.
fn grid(bench: &Bench, count: u32) -> Vec<[f64; 5]> {
    let (rows, note) = grid_and_note(bench, count);
    assert_eq!(note, "");
    rows
}

/// The same, and what is said on standard error.
fn grid_and_note(bench: &Bench, count: u32) -> (Vec<[f64; 5]>, String) {
    let words = format!("sag recipe.toml --grid {count} -o sag.csv");
    let said = bench.line(&words).ends(0);
    assert_eq!(said.stdout, "");
    let text = bench.read("sag.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x_mm,y_mm,z_mm,zx,zy"));
    let row = |line: &str| -> [f64; 5] {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        values.try_into().unwrap()
    };
    (lines.map(row).collect(), said.stderr)
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
fn where_a_surface_has_no_height_the_grid_has_nan_and_a_note_counts_them() {
    let sphere = saddle_with("surface", "use = \"conic\"\nradius = \"3 mm\"");
    let bench = Bench::with(&sphere);
    let (rows, note) = grid_and_note(&bench, 21);
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
    let expected =
        format!("note: {beyond} of 441 points have no height: they lie beyond the part\n");
    assert_eq!(note, expected);
    for output in ["sag.gsf", "sag.DAT", "-"] {
        let said = bench.line(&format!("sag recipe.toml --grid 21 -o {output}"));
        assert_eq!(said.ends(0).stderr, expected);
    }
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

/// A map that `sag` wrote, read by the reader of maps.
fn map(bench: &Bench, file: &str) -> Map {
    let bytes = std::fs::read(bench.path(file)).unwrap();
    turnpath_maps::read(file, &bytes, &Conventions::default()).unwrap()
}

/// `.DAT` has all digits; `.gsf` has 32-bit floats of metres.
#[test]
fn the_maps_that_are_written_have_the_heights_of_the_closed_form_at_their_places() {
    let bench = Bench::with(SADDLE);
    for (file, relative) in [("sag.gsf", 6e-8), ("sag.DAT", 1e-15)] {
        let line = format!("sag recipe.toml --grid 21 -o {file} --set surface.decentre_x=0.5mm");
        let said = bench.line(&line).ends(0);
        assert_eq!((said.stdout.as_str(), said.stderr.as_str()), ("", ""));
        let map = map(&bench, file);
        assert_eq!((map.columns(), map.rows()), (21, 21));
        for row in 0..21 {
            for column in 0..21 {
                let (x, y) = (map.x(column), map.y(row));
                assert!(
                    (x - (0.25 * column as f64 - 2.5)).abs() < 1e-12,
                    "{file}: {x}"
                );
                assert!((y - (0.25 * row as f64 - 2.5)).abs() < 1e-12, "{file}: {y}");
                let (found, wanted) = (map.height(column, row), 0.16 * (x - 0.5) * y);
                let bound = relative * wanted.abs() + 1e-15;
                assert!(
                    (found - wanted).abs() <= bound,
                    "{file}: {found}, not {wanted}"
                );
            }
        }
    }
}

/// The header that Zemax describes: `nx ny delx dely unitflag xdec ydec`, then
/// `z dz/dx dz/dy d2z/dxdy nodata` from the upper left point on.
#[test]
fn a_dat_has_the_header_the_order_and_the_holes_of_zemax() {
    let sphere = saddle_with(
        "surface",
        "use = \"conic\"\nradius = \"3 mm\"\ndecentre_x = \"1 mm\"",
    );
    let bench = Bench::with(&sphere);
    bench.line("sag recipe.toml --grid 6 -o sag.DAT").ends(0);
    let text = bench.read("sag.DAT");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), ("6 6 1 1 0 0 0", 37));
    for (index, line) in lines[1..].iter().enumerate() {
        // To the right, rows downwards.
        let (x, y) = ((index % 6) as f64 - 3.5, 2.5 - (index / 6) as f64);
        let inside = 9.0 - x * x - y * y;
        if inside < 0.0 {
            assert_eq!(*line, "0 0 0 0 1");
            continue;
        }
        let (height, rest) = line.split_once(' ').unwrap();
        assert_eq!(rest, "0 0 0 0");
        near(height.parse().unwrap(), 3.0 - inside.sqrt(), "z");
    }
}

/// The saddle's map with a piston of 3 nm, a bump of 40 nm and a hole of 1 point.
fn measured(bench: &Bench) {
    let mut text = "21 21 0.3 0.3 0 0 0\n".to_owned();
    for row in (0..21).rev() {
        for column in 0..21 {
            let (x, y) = (0.3 * (column as f64 - 10.0), 0.3 * (row as f64 - 10.0));
            let bump = if (column, row) == (13, 6) { 40e-6 } else { 0.0 };
            let hole = u8::from((column, row) == (10, 10));
            text += &format!("{:e} 0 0 0 {hole}\n", 0.16 * x * y + 3e-6 + bump);
        }
    }
    bench.write("measured.DAT", text);
}

#[test]
fn a_map_against_the_surface_gives_its_piston_its_bump_and_its_place() {
    let bench = Bench::with(SADDLE);
    measured(&bench);
    let line = "sag recipe.toml --against measured.DAT -o error.csv --format json";
    let json = bench.line(line).ends(0).json();
    let figure = |key: &str| json[key].as_f64().unwrap();
    // Points within 2.5 mm on a grid of 0.3 mm, less the hole.
    let inside = |k: i64| k * k;
    let all = (-10..=10).flat_map(|i| (-10..=10).map(move |j| inside(i) + inside(j)));
    let count = all.filter(|squares| 0.09 * *squares as f64 <= 6.25).count() as f64 - 1.0;
    assert_eq!(figure("points"), count);
    assert_eq!(
        (figure("without_height"), figure("without_surface")),
        (1.0, 0.0)
    );
    assert_eq!(figure("beyond_part"), 441.0 - count - 1.0);
    let close =
        |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-6, "{found} {wanted}");
    close(figure("pv_nm"), 40.0);
    close(figure("mean_nm"), 3.0 + 40.0 / count);
    close(
        figure("rms_nm"),
        ((9.0 * (count - 1.0) + 43.0 * 43.0) / count).sqrt(),
    );
    close(
        figure("rms_without_piston_nm"),
        40.0 * ((count - 1.0) / (count * count)).sqrt(),
    );
    close(json["worst"]["difference_nm"].as_f64().unwrap(), 43.0);
    close(json["worst"]["x_mm"].as_f64().unwrap(), 0.9);
    close(json["worst"]["y_mm"].as_f64().unwrap(), -1.2);
    assert_eq!(bench.read("error.csv").lines().count() as f64, count + 1.0);
    let text = bench
        .line("sag recipe.toml --against measured.DAT")
        .ends(0)
        .stdout;
    insta::assert_snapshot!(text);
}

#[test]
fn the_difference_is_a_map_with_holes_where_nothing_is_compared() {
    let bench = Bench::with(SADDLE);
    measured(&bench);
    for (file, bound) in [("error.gsf", 1e-11), ("error.DAT", 1e-15)] {
        bench
            .line(&format!("sag recipe.toml --against measured.DAT -o {file}"))
            .ends(0);
        let map = map(&bench, file);
        assert_eq!((map.columns(), map.rows()), (21, 21));
        assert!((map.x(0) + 3.0).abs() < 1e-12 && (map.y(20) - 3.0).abs() < 1e-12);
        assert!(
            (map.height(13, 6) - 43e-6).abs() < bound,
            "{}",
            map.height(13, 6)
        );
        assert!((map.height(6, 13) - 3e-6).abs() < bound);
        assert!(map.height(10, 10).is_nan() && map.height(0, 0).is_nan());
    }
}

#[test]
fn what_is_read_is_not_replaced_by_what_is_written() {
    let bench = Bench::with(SADDLE);
    measured(&bench);
    let saddle = SADDLE.replace("[surface]", "[[surface]]");
    let map = "[[surface]]\nuse = \"grid-sag\"\nfile = \"measured.DAT\"\n";
    bench.write("sum.toml", format!("{saddle}\n{map}"));
    let before = bench.read("measured.DAT");
    let recipe = bench.read("sum.toml");
    let mut lines = vec![
        "sag recipe.toml --against measured.DAT -o measured.DAT",
        "sag recipe.toml --against measured.DAT -o ./measured.DAT",
        "sag recipe.toml --against ./measured.DAT -o recipe.toml",
        "sag sum.toml --grid 9 -o measured.DAT",
        "sag sum.toml --grid 9 -o sum.toml",
    ];
    #[cfg(unix)]
    {
        let link = bench.path("link.DAT");
        std::os::unix::fs::symlink(bench.path("measured.DAT"), link).unwrap();
        lines.push("sag recipe.toml --against measured.DAT -o link.DAT");
        lines.push("sag recipe.toml --against link.DAT -o measured.DAT");
    }
    for line in lines {
        let said = bench.line(line).ends(2);
        assert!(said.stderr.contains("is read here"), "{line}: {said}");
        assert_eq!(bench.read("measured.DAT"), before, "{line}");
        assert_eq!(bench.read("sum.toml"), recipe, "{line}");
    }
    bench.line("sag sum.toml --grid 9 -o other.DAT").ends(0);
}

#[test]
fn what_a_maps_file_does_not_say_is_given() {
    let bench = Bench::with(SADDLE);
    let mut text = String::new();
    for i in -8..=8 {
        for j in -8..=8 {
            // Seen from behind: x changes its sign.
            let (x, y) = (0.3 * f64::from(i), 0.3 * f64::from(j));
            text += &format!("{} {} {}\n", -1e3 * x, 1e3 * y, 0.16e6 * x * y);
        }
    }
    bench.write("map.txt", text);
    let line = "sag recipe.toml --against map.txt --map-format xyz --xy-unit um --z-unit nm";
    let json = bench
        .line(&format!("{line} --flip-x --format json"))
        .ends(0)
        .json();
    assert!(json["pv_nm"].as_f64().unwrap() < 1e-6, "{json}");
    let json = bench.line(&format!("{line} --format json")).ends(0).json();
    assert!(json["pv_nm"].as_f64().unwrap() > 1e5, "{json}");
    bench.write(
        "small.DAT",
        format!("3 3 1 1 0 0 0\n{}", "0 0 0 0\n".repeat(9)),
    );
    for (call, wanted) in [
        (
            "sag recipe.toml --against map.txt",
            "map.txt: the format is unknown",
        ),
        (
            "sag recipe.toml --against map.txt --map-format xyz",
            "map.txt: the file does not say its unit",
        ),
        (
            "sag recipe.toml --against map.txt --map-format xyz --pitch 0mm",
            "--pitch: the distance of neighbouring points lies between 1e-9 mm and 1e9 mm",
        ),
        (
            "sag recipe.toml --against small.DAT",
            "small.DAT: line 1: the grid has 3 × 3 points; a map has 6 × 6 at the least",
        ),
        (
            "sag recipe.toml --against map.txt --xy-unit ell",
            "--xy-unit: the unit `ell` is unknown",
        ),
        (
            "sag recipe.toml --against recipe.toml --map-format zemax",
            "recipe.toml: line 1: ",
        ),
        (
            "sag recipe.toml --against map.txt -o -",
            "standard output has the report",
        ),
        (
            "sag recipe.toml --grid 3 -o a --format json",
            "cannot be used with",
        ),
        (
            "sag recipe.toml --grid 3 --against map.txt",
            "cannot be used with",
        ),
        ("sag recipe.toml --grid 3", "--output"),
    ] {
        let said = bench.line(call).ends(2);
        assert!(said.stderr.contains(wanted), "{call}: {said}");
    }
    let said = bench.line("sag recipe.toml --against none.DAT").ends(4);
    assert!(said.stderr.contains("cannot read none.DAT"), "{said}");
    let beyond = "sag recipe.toml --set part.aperture=0.02mm --set part.inner=0.01mm --against";
    measured(&bench);
    let said = bench.line(&format!("{beyond} measured.DAT")).ends(2);
    assert!(
        said.stderr
            .contains("no point of measured.DAT that has a height"),
        "{said}"
    );
}
