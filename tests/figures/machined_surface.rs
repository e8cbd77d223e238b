//! Maps, profiles and circles of the machined surface: the files against each other and against
//! the summary, and calls that are wrong.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};
use serde_json::Value;

/// A square map as read from a `.gsf`, in nm; rows from the top.
struct Field {
    count: usize,
    side_mm: f64,
    nm: Vec<f64>,
}

impl Field {
    /// From the format's description: header lines, one to four NULs, floats.
    fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let end = bytes.iter().position(|byte| *byte == 0).unwrap();
        let header = std::str::from_utf8(&bytes[..end]).unwrap();
        assert!(header.starts_with("Gwyddion Simple Field 1.0\n"));
        let value = |name: &str| {
            let mut lines = header.lines().filter_map(|line| line.split_once('='));
            let found = lines.find(|(key, _)| key.trim() == name);
            found.unwrap_or_else(|| panic!("no {name}")).1.trim()
        };
        assert_eq!((value("XYUnits"), value("ZUnits")), ("m", "m"));
        assert_eq!(value("XRes"), value("YRes"));
        let data = &bytes[end + (4 - end % 4)..];
        let of = |four: &[u8]| f64::from(f32::from_le_bytes(four.try_into().unwrap())) * 1e9;
        let count: usize = value("XRes").parse().unwrap();
        assert_eq!(data.len(), 4 * count * count);
        Self {
            count,
            side_mm: value("XReal").parse::<f64>().unwrap() * 1e3,
            nm: data.chunks(4).map(of).collect(),
        }
    }

    /// (x, y, error) of the cells on the part: mm and nm.
    fn cells(&self) -> Vec<[f64; 3]> {
        let at = |i: usize| self.side_mm * ((i as f64 + 0.5) / self.count as f64 - 0.5);
        let cell = |(i, nm): (usize, &f64)| [at(i % self.count), -at(i / self.count), *nm];
        let cells = self.nm.iter().enumerate().map(cell);
        cells.filter(|[_, _, nm]| !nm.is_nan()).collect()
    }
}

fn table(text: &str, separator: char) -> Vec<Vec<f64>> {
    let rows = text
        .lines()
        .filter(|line| !line.starts_with(char::is_alphabetic));
    let numbers = |line: &str| line.split(separator).map(|v| v.parse().unwrap()).collect();
    rows.map(numbers).collect()
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// A run of the saddle with a map in `out`, and its summary.
fn mapped(recipe: &str, options: &str) -> (Bench, Value) {
    let bench = Bench::with(recipe);
    let said = bench.line(&format!("run recipe.toml -o out --format json {options}"));
    assert!(said.status.is_some_and(|status| status <= 1), "{said}");
    let summary = said.json();
    (bench, summary)
}

#[test]
fn a_map_has_the_figures_of_the_summary() {
    let (bench, summary) = mapped(SADDLE, "--map map.gsf --map-size 1500");
    let field = Field::read(&bench.path("out/map.gsf"));
    assert_eq!((field.count, field.side_mm), (1500, 5.0));
    let cells = field.cells();
    assert!(cells.iter().all(|[x, y, _]| x * x + y * y <= 2.5 * 2.5));
    let square: f64 = cells.iter().map(|cell| cell[2] * cell[2]).sum();
    let rms = (square / cells.len() as f64).sqrt();
    let expected = number(&summary, "/surface_error/rms_nm");
    assert!((rms / expected - 1.0).abs() < 0.01, "{rms}, {expected}");
    let higher = |a: &&[f64; 3], b: &&[f64; 3]| a[2].total_cmp(&b[2]);
    let (high, low) = (cells.iter().max_by(higher), cells.iter().min_by(higher));
    let (high, low) = (high.unwrap(), low.unwrap());
    let most = number(&summary, "/surface_error/highest/error_nm");
    let least = number(&summary, "/surface_error/lowest/error_nm");
    assert!(high[2] <= most && high[2] > 0.97 * most, "{high:?}, {most}");
    assert!(low[2] < 0.97 * least, "{low:?}, {least}");
    let pv = number(&summary, "/surface_error/pv_nm");
    assert!((pv - (most - least)).abs() < 1e-6 * pv);
}

/// The saddle rises along y = x: what the nose cannot reach at the rim of a path that ends at
/// X = 2.5 mm lies where it falls, along y = −x.
/// z = k ρ² sin 2θ goes up and down twice a turn; X only feeds.
#[test]
fn z_of_the_saddle_moves_at_twice_the_spindle() {
    let (bench, _) = mapped(SADDLE, "--spectrum");
    let written = bench.read("out/spectrum.csv");
    assert!(written.starts_with("frequency_hz,x_um2_per_hz,z_um2_per_hz\n"));
    let lines = table(&written, ',');
    let top = lines.iter().max_by(|a, b| a[2].total_cmp(&b[2])).unwrap();
    assert!(
        (top[0] / (2.0 * 500.0 / 60.0) - 1.0).abs() < 1e-6,
        "{top:?}"
    );
    bench.line("verify recipe.toml out/toolpath.csv --spectrum -o again");
    assert_eq!(bench.read("again/spectrum.csv"), written);
}

#[test]
fn a_map_has_x_to_the_right_and_y_up() {
    let tilted = saddle_with(
        "surface",
        "use = \"xy-polynomial\"\nterms = [[1, 0, 0.1], [0, 1, 0.05]]",
    );
    let (bench, _) = mapped(&tilted, "--map map.gsf --map-size 64 --map-grid cartesian");
    let cells = Field::read(&bench.path("out/map.gsf")).cells();
    // A plane that rises along (2, 1) is left highest where the contact falls behind X: opposite.
    let higher = |a: &&[f64; 3], b: &&[f64; 3]| a[2].total_cmp(&b[2]);
    let [x, y, _] = *cells.iter().max_by(higher).unwrap();
    assert!(x < -1.5 && y < -0.5 && (y / x - 0.5).abs() < 0.2, "{x} {y}");
}

#[test]
fn both_formats_and_every_count_of_threads_give_the_same_map() {
    let (bench, _) = mapped(SADDLE, "--map map.gsf --map-size 101 --threads 1");
    let verify = "verify recipe.toml out/toolpath.csv --map-size 101 -o again";
    let said = bench.line(&format!("{verify} --map map.gsf --threads 3"));
    assert!(said.stdout.contains("again/map.gsf"), "{said}");
    bench.line(&format!("{verify} --map map.xyz"));
    let [one, other] = ["out/map.gsf", "again/map.gsf"].map(|name| fs::read(bench.path(name)));
    assert!(one.unwrap() == other.unwrap());
    let cells = Field::read(&bench.path("out/map.gsf")).cells();
    let lines = table(&bench.read("again/map.xyz"), ' ');
    assert_eq!(cells.len(), lines.len());
    for (cell, line) in cells.iter().zip(&lines) {
        let [x, y, nm] = [line[0] * 1e3, line[1] * 1e3, line[2] * 1e9];
        assert!((cell[0] - x).abs() < 1e-7 && (cell[1] - y).abs() < 1e-7);
        assert!((cell[2] - nm).abs() <= 1e-5 * nm.abs().max(1.0));
    }
}

#[test]
fn a_polar_map_has_rings_of_angles() {
    let ring = with_table(SADDLE, "part", "aperture = \"5 mm\"\ninner = \"2 mm\"");
    let (bench, _) = mapped(&ring, "--map map.xyz --map-size 24 --map-grid polar");
    let lines = table(&bench.read("out/map.xyz"), ' ');
    assert_eq!(lines.len(), 24 * 24);
    for (i, line) in lines.iter().enumerate() {
        let rho = (line[0] * line[0] + line[1] * line[1]).sqrt() * 1e3;
        let expected = 1.0 + 1.5 * ((i / 24) as f64 + 0.5) / 24.0;
        assert!((rho - expected).abs() < 1e-6, "{rho}, {expected}");
    }
}

/// Where a circle and a profile cross, they agree. The spectrum's integral is the profile's mean
/// square about its mean.
#[test]
fn profiles_circles_and_spectra_agree() {
    let sets = "--profile 90deg --profile -30deg --circle 1mm";
    let (bench, _) = mapped(SADDLE, sets);
    let circle = table(&bench.read("out/circle-1mm.csv"), ',');
    assert_eq!(circle.len(), 36_000);
    let profile = table(&bench.read("out/profile-90deg.csv"), ',');
    let (at, step) = (
        profile.iter().position(|row| row[0] >= 1.0).unwrap(),
        profile[1][0] - profile[0][0],
    );
    let share = (profile[at][0] - 1.0) / step;
    let there = share * profile[at - 1][1] + (1.0 - share) * profile[at][1];
    let here = &circle[9000];
    assert_eq!(here[0], 90.0);
    assert!((here[1] - there).abs() < 3.0, "{here:?}, {there}");
    for row in profile.iter().chain(&circle) {
        assert!((row[3] - row[2] - row[1] * 1e-6).abs() < 2e-12);
    }
    let tilted = bench.read("out/profile--30deg.csv");
    assert!(tilted.starts_with("s_mm,error_nm,wanted_mm,machined_mm\n"));
    let spectrum = table(&bench.read("out/profile-90deg-spectrum.csv"), ',');
    let width = spectrum[1][0] - spectrum[0][0];
    let power: f64 = spectrum.iter().map(|line| line[1] * width).sum();
    let errors: Vec<f64> = profile.iter().map(|row| row[1]).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let square = errors.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / errors.len() as f64;
    assert!((power / square - 1.0).abs() < 0.2, "{power}, {square}");
}

#[test]
fn a_program_is_mapped_from_its_own_text() {
    let with_program = changed(
        SADDLE,
        "[feed]",
        "[output]\nposts = [\"pmac-pvt\"]\n\n[feed]",
    );
    let (bench, _) = mapped(&with_program, "--map map.gsf --map-size 51");
    let said = bench.line("verify recipe.toml out/recipe.pmc --map map.gsf --map-size 51 -o again");
    assert!(said.status.is_some_and(|status| status <= 1), "{said}");
    let maps = ["out/map.gsf", "again/map.gsf"].map(|name| Field::read(&bench.path(name)).cells());
    for (one, other) in maps[0].iter().zip(&maps[1]) {
        assert!((one[2] - other[2]).abs() < 1.0, "{one:?} {other:?}");
    }
    assert_ne!(format!("{:?}", maps[0]), format!("{:?}", maps[1]));
}

/// The conventional path of Zhong et al. on straight segments, whose own error is 58.6 nm: chords
/// cut that much too deep on crests. In troughs they lie that much above, and the nose of 1 mm
/// leaves up to f²/2R = 50 nm more on the last feed before the rim.
#[test]
fn conventional_path_of_the_lens_array_on_straight_segments() {
    let array = with_table(
        &saddle_with("velocity", "use = \"linear\""),
        "surface",
        "use = \"sinusoidal-array\"\namplitude_x = \"5 um\"\namplitude_y = \"5 um\"\n\
         frequency_x = \"0.4 /mm\"\nfrequency_y = \"0.4 /mm\"\nform = \"sum\"",
    );
    let array = with_table(&array, "part", "aperture = \"10 mm\"");
    let array = with_table(&array, "feed", "use = \"constant\"\nfeed = \"10 um\"");
    let array = with_table(
        &array,
        "sampler",
        "use = \"equal-angle\"\nstep = \"1.40625 deg\"",
    );
    let array = with_table(&array, "compensator", "use = \"none\"");
    let array = changed(&array, "name =", "refine = false\nname =");
    let (_, summary) = mapped(&array, "");
    let error = number(&summary, "/interpolation_error/max_nm");
    assert!((error / 58.626 - 1.0).abs() < 5e-4, "{error}");
    let lowest = number(&summary, "/surface_error/lowest/error_nm");
    assert!((lowest / -58.626 - 1.0).abs() < 0.01, "{lowest}");
    let highest = number(&summary, "/surface_error/highest/error_nm");
    assert!((58.6..58.6 + 50.0).contains(&highest), "{highest}");
    let at = |axis: &str| number(&summary, &format!("/surface_error/highest/{axis}_mm"));
    assert!(at("x") * at("x") + at("y") * at("y") > 4.99 * 4.99);
}

/// The message of a wrong call, which must leave no file.
#[track_caller]
fn refused(status: i32, options: &str) -> String {
    let bench = Bench::with(SADDLE);
    let said: Answer = bench.line(&format!("run recipe.toml -o out {options}"));
    assert_eq!(said.status, Some(status), "{said}");
    assert_eq!(bench.files(), ["recipe.toml"], "{said}");
    assert_eq!(said.stdout, "");
    said.stderr
}

#[test]
fn wrong_calls_are_refused_before_the_work() {
    let said = [
        refused(2, "--map map.png"),
        refused(2, "--map map"),
        refused(2, "--map map.gsf --map-grid polar"),
        refused(2, "--profile 45"),
        refused(2, "--profile 45mm"),
        refused(2, "--profile nan"),
        refused(2, "--profile 1e300deg"),
        refused(2, "--profile -361deg"),
        refused(2, "--profile 0deg --profile 1e-9deg"),
        refused(2, "--circle 1mm --circle 1.0000000001mm"),
        refused(2, "--circle 2.6mm"),
        refused(2, "--circle -1mm"),
        refused(2, "--circle 0mm"),
        refused(2, "--map map.gsf --set output.data=[]"),
        refused(4, "--map /no/such/folder/map.gsf"),
    ];
    insta::assert_snapshot!(said.concat());
    for options in [
        "--map map.gsf --map-size 1",
        "--map map.gsf --map-grid round",
    ] {
        assert!(refused(2, options).contains("error: invalid value"));
    }
}
