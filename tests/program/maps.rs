//! Surfaces through maps, as a person sees them: recipes, remarks, and files that are wrong.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Bench, TURNPATH, answer};
use crate::support::recipe::{SADDLE, changed};
use crate::support::repository;
use serde_json::Value;
use turnpath_maps::{Conventions, length_unit};

/// The saddle's recipe with its surface from a file.
fn recipe(file: &str, more: &str) -> String {
    let table = format!("use = \"grid-sag\"\nfile = \"{file}\"\n{more}");
    changed(SADDLE, "use = \"astigmatic\"\nk = \"0.08 /mm\"\n", &table)
}

/// A map of the saddle z = 0.16 x y in the format of Zemax: a square around the axis.
fn saddle(side: f64, count: usize) -> String {
    let pitch = side / (count - 1) as f64;
    let place = |k: usize| pitch * k as f64 - 0.5 * side;
    let mut text = format!("{count} {count} {pitch} {pitch} 0 0 0\n");
    for row in (0..count).rev() {
        for column in 0..count {
            let z = 0.16 * place(column) * place(row);
            text.push_str(&format!("{z} 0 0 0\n"));
        }
    }
    text
}

fn bench(map: &str) -> Bench {
    let bench = Bench::with(&recipe("map.DAT", ""));
    bench.write("map.DAT", map);
    bench
}

fn remarks(bench: &Bench, line: &str) -> Vec<Value> {
    let json = bench.line(&format!("{line} --format json")).ends(0).json();
    json["remarks"].as_array().unwrap().clone()
}

/// A quadratic is its own spline: the path over its map is the path over its formula.
#[test]
fn a_map_of_the_saddle_gives_the_path_of_the_saddle() {
    let (formula, map) = (Bench::with(SADDLE), bench(&saddle(6.0, 25)));
    for bench in [&formula, &map] {
        bench.line("run recipe.toml -o out").ends(0);
    }
    let rows = |bench: &Bench| -> Vec<Vec<f64>> {
        let text = bench.read("out/toolpath.csv");
        let lines = text.lines().filter(|line| !line.starts_with(['#', 't']));
        let row = |line: &str| line.split(',').map(|one| one.parse().unwrap()).collect();
        lines.map(row).collect()
    };
    let (formula, of_map) = (rows(&formula), rows(&map));
    assert_eq!(formula.len(), of_map.len());
    for (one, other) in formula.iter().zip(&of_map) {
        // C, X, Z in deg and mm.
        for (one, other) in one[1..4].iter().zip(&other[1..4]) {
            assert!(
                (one - other).abs() <= 1e-9 * one.abs().max(1.0),
                "{one} {other}"
            );
        }
    }
    // The part and its overrun lie on the map.
    assert_eq!(remarks(&map, "check recipe.toml"), Vec::<Value>::new());
    let summary: Value = serde_json::from_str(&map.read("out/summary.json")).unwrap();
    assert_eq!(summary["data_files"][0]["file"], "map.DAT");
}

#[test]
fn a_map_that_is_too_small_is_carried_on_and_the_run_says_how_far() {
    // The part has a radius of 2.5 mm, and the cells of the map end at 2.1 mm.
    let bench = bench(&saddle(4.0, 21));
    let all = remarks(&bench, "check recipe.toml");
    let [remark, overrun] = all.as_slice() else {
        panic!("{all:?}");
    };
    assert_eq!(remark["kind"], "beyond_data");
    assert_eq!(remark["on_part"], true);
    let distance = remark["distance_mm"].as_f64().unwrap();
    assert!((distance - 0.4).abs() < 1e-9, "{distance}");
    let said = bench.line("check recipe.toml").ends(0).stdout;
    assert!(
        said.contains(
            "the part leaves the data of the surface by 0.400 mm at radius 2.500 mm, C = 0.0 deg; \
             there it goes on C4, with its slope and curvature"
        ),
        "{said}"
    );
    // On slopes the nose at the rim makes contact beyond it: 0.4 mm farther at a slope of 0.4.
    assert_eq!(overrun["on_part"], false);
    let beyond = overrun["distance_mm"].as_f64().unwrap();
    assert!((0.7..0.9).contains(&beyond), "{beyond}");
    // Moved by its place, the map leaves more on one side.
    let all = remarks(&bench, "check recipe.toml --set surface.decentre_x=0.2mm");
    assert!(
        (all[0]["distance_mm"].as_f64().unwrap() - 0.6).abs() < 1e-9,
        "{all:?}"
    );
}

#[test]
fn points_without_a_height_are_counted() {
    let map = saddle(6.0, 25);
    let mut lines: Vec<String> = map.lines().map(str::to_owned).collect();
    // One on the part, two in a corner beyond it.
    for line in [300, 1, 2] {
        lines[line].push_str(" 1");
    }
    let bench = bench(&(lines.join("\n") + "\n"));
    let all = remarks(&bench, "run recipe.toml -o out");
    let filled = serde_json::json!({ "kind": "filled_points", "filled": 3, "points": 625 });
    assert!(all.contains(&filled), "{all:?}");
}

#[test]
fn the_ready_recipe_runs_at_a_coarse_setting() {
    let folder = repository().join("docs/recipes/surfaces");
    let bench = Bench::with(SADDLE);
    for file in ["grid-sag.toml", "measured-error.gsf"] {
        fs::copy(folder.join(file), bench.path(file)).unwrap();
    }
    let line = "run grid-sag.toml -o out --set tolerance.interpolation=100nm \
                --set tolerance.residual=300nm";
    bench.line(line).ends(0);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["chain"]["surface"], "astigmatic + grid-sag");
    let kinds: Vec<&Value> = summary["remarks"].as_array().unwrap().iter().collect();
    assert!(kinds.iter().any(|remark| remark["kind"] == "filled_points"));
}

/// The maps that `run` writes are read again with the same places and heights: `.xyz` has both as
/// numbers.
#[test]
fn a_map_that_a_run_writes_is_read_as_it_was_written() {
    let bench = Bench::with(&changed(
        SADDLE,
        "speed = \"500 rpm\"",
        "speed = \"400 rpm\"",
    ));
    let write = |map: &str| {
        let line = format!("run recipe.toml -o out --map {map} --map-size 24");
        bench.line(&line).ends(0);
        fs::read(bench.path("out").join(map)).unwrap()
    };
    let gsf = turnpath_maps::read("map.gsf", &write("map.gsf"), &Conventions::default()).unwrap();
    let metres = Conventions {
        xy_unit: length_unit("m"),
        z_unit: length_unit("m"),
        ..Conventions::default()
    };
    let xyz = turnpath_maps::read("map.xyz", &write("map.xyz"), &metres).unwrap();
    let mut compared = 0;
    for row in 0..xyz.rows() {
        for column in 0..xyz.columns() {
            let height = xyz.height(column, row);
            if height.is_nan() {
                continue;
            }
            let of_gsf =
                |place: f64, first: f64, pitch: f64| ((place - first) / pitch).round() as usize;
            let (x, y) = (xyz.x(column), xyz.y(row));
            let other = (
                of_gsf(x, gsf.x(0), gsf.pitch_x()),
                of_gsf(y, gsf.y(0), gsf.pitch_y()),
            );
            assert!((gsf.x(other.0) - x).abs() < 1e-6 && (gsf.y(other.1) - y).abs() < 1e-6);
            let found = gsf.height(other.0, other.1);
            assert!(
                (found - height).abs() < 1e-6 * height.abs().max(1e-5),
                "{found} {height}"
            );
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn a_wrong_flag_of_the_units() {
    let bench = bench(&saddle(6.0, 25).replacen(" 0 0 0\n", " 7 0 0\n", 1));
    let said = bench.line("check recipe.toml").ends(2);
    insta::assert_snapshot!(bench.shown(&said));
}

/// A grid of 0.5 mm over a part of 5 mm whose map has 2 mm.
#[test]
fn heights_beyond_a_map_are_told_as_the_surface_is_written() {
    let notes = |side: f64, output: &str| {
        let bench = bench(&saddle(side, 25));
        let said = bench.line(&format!("sag recipe.toml --grid 11 -o {output}"));
        said.ends(0).stderr
    };
    let at = |k: i32| 0.5 * f64::from(k);
    let places = (-5..=5).flat_map(|j| (-5..=5).map(move |i| [at(i), at(j)]));
    let is_beyond = |[x, y]: &[f64; 2]| x * x + y * y <= 6.25 && x.abs().max(y.abs()) > 1.0;
    let count = places.filter(is_beyond).count();
    for output in ["s.csv", "s.DAT", "s.gsf", "-"] {
        let said = notes(2.0, output);
        let wanted = format!(
            "of the part, {count} points lie beyond the data of the surface, by up to 1.458e0 mm"
        );
        assert!(said.contains(&wanted), "{output}: {said}");
        assert_eq!(notes(6.0, output), "", "{output}");
    }
}

#[test]
fn a_cutoff_that_does_not_suit_the_map() {
    let bench = bench(&saddle(6.0, 25));
    let said = bench
        .line("check recipe.toml --set surface.smooth=0.1mm")
        .ends(2);
    insta::assert_snapshot!(bench.shown(&said));
}

#[test]
fn files_that_are_no_map_end_with_status_2_and_the_line() {
    let good = saddle(6.0, 25);
    let half = good.lines().take(300).collect::<Vec<_>>().join("\n") + "\n";
    let cases: [(&str, Vec<u8>, &str); 6] = [
        (
            "short.DAT",
            half.into(),
            "short.DAT: line 300: the file has 299 points, and its grid has 625",
        ),
        (
            "nan.DAT",
            good.replacen("\n", "\nNaN 0 0 0\n", 1).into(),
            "nan.DAT: line 2: `NaN` is no height; a hole has a number and `nodata` 1",
        ),
        (
            "large.DAT",
            "40000 25000 1 1 0 0 0\n0 0 0 0\n".into(),
            "large.DAT: line 1: the grid has 40000 × 25000 points",
        ),
        (
            "rubbish.DAT",
            vec![0xfe, 0, 7, b'\n'],
            "rubbish.DAT: line 1: this is not a text",
        ),
        (
            "uneven.xyz",
            (0..64)
                .map(|k| format!("{} {} 0\n", (k % 8) * (k % 8), k / 8))
                .collect::<String>()
                .into(),
            "uneven.xyz: line 2: the points lie on no regular grid",
        ),
        (
            "map.png",
            b"\x89PNG".to_vec(),
            "map.png: the format is unknown: give `format`",
        ),
    ];
    for (file, bytes, wanted) in cases {
        let bench = Bench::with(&recipe(file, "xy_unit = \"mm\"\nz_unit = \"mm\""));
        fs::write(bench.path(file), bytes).unwrap();
        let said = bench.line("run recipe.toml -o out").ends(2);
        assert!(said.stderr.contains(wanted), "{file}: {said}");
        assert!(said.stderr.contains("recipe.toml:"), "{file}: {said}");
        assert!(!bench.path("out").exists());
    }
}

/// Points along an edge of the largest maps that are measured.
#[cfg(unix)]
const LARGE: usize = 4096;

/// Pixels of the saddle z = 0.16 x y on 6 × 6 mm. Beyond a disc of data there are none, and grains of
/// dust have left holes.
#[cfg(unix)]
fn large_field() -> Vec<u8> {
    let mut header = format!(
        "Gwyddion Simple Field 1.0\nXRes = {LARGE}\nYRes = {LARGE}\nXReal = 0.006\nYReal = 0.006\n\
         XYUnits = m\nZUnits = m\n"
    )
    .into_bytes();
    // One to four zeros, up to a whole number of words.
    header.resize(header.len() / 4 * 4 + 4, 0);
    header.reserve(4 * LARGE * LARGE);
    let place = |k: usize| 6.0 * ((k as f64 + 0.5) / LARGE as f64 - 0.5);
    for row in 0..LARGE {
        for column in 0..LARGE {
            let (x, y) = (place(column), -place(row));
            let is_dust = row % 512 < 8 && column % 512 < 12;
            let z = match is_dust || x * x + y * y > 2.9 * 2.9 {
                true => f32::NAN,
                false => (0.16e-3 * x * y) as f32,
            };
            header.extend(z.to_le_bytes());
        }
    }
    header
}

/// The limit is that of the address space, three times what the pages say of the memory.
#[cfg(unix)]
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_map_of_sixteen_million_points_with_holes_is_read_in_bounded_memory() {
    let bench = Bench::with(&recipe("map.gsf", ""));
    bench.write("map.gsf", large_field());
    let script = "ulimit -v 2500000; exec \"$0\" sag recipe.toml --grid 41 -o sag.csv";
    let mut shell = bench.command_of("sh".as_ref(), ["-c", script]);
    answer(shell.arg(TURNPATH)).ends(0);
    for line in bench.read("sag.csv").lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|one| one.parse().unwrap()).collect();
        let [x, y, z] = [numbers[0], numbers[1], numbers[2]];
        if x * x + y * y <= 2.5 * 2.5 {
            // A unit in the last place of a 32-bit number of metres, up to 1 mm.
            assert!((z - 0.16 * x * y).abs() < 1.2e-7, "{line}");
        }
    }
}
