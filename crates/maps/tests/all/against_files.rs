//! Every format against the files of tests/reference/grids/files.py, which writes them from the
//! descriptions of the formats: order of rows, units, holes, places.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::Path;

use serde_json::Value;
use turnpath_maps::{Conventions, Map, Origin, length_unit, read};

fn folder() -> &'static Path {
    Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/reference/grids/files"
    ))
}

fn entries() -> Vec<Value> {
    let text = std::fs::read_to_string(folder().join("files.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    all["files"].as_array().unwrap().clone()
}

fn conventions(entry: &Value) -> Conventions {
    let unit = |key: &str| entry[key].as_str().and_then(length_unit);
    let pitch = |axis: usize| entry["pitch"][axis].as_f64();
    Conventions {
        xy_unit: unit("xy_unit"),
        z_unit: unit("z_unit"),
        pitch_x: pitch(0),
        pitch_y: pitch(1),
        ..Conventions::default()
    }
}

fn map(entry: &Value, conventions: &Conventions) -> Map {
    let name = entry["file"].as_str().unwrap();
    let bytes = std::fs::read(folder().join(name)).unwrap();
    read(name, &bytes, conventions).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_file_has_the_heights_and_places_that_the_script_put_there() {
    for entry in entries() {
        let (name, map) = (&entry["file"], map(&entry, &conventions(&entry)));
        let [x, y] = ["x", "y"].map(|axis| entry[axis].as_array().unwrap());
        assert_eq!((map.columns(), map.rows()), (x.len(), y.len()), "{name}");
        for (row, y) in y.iter().enumerate() {
            assert!((map.y(row) - y.as_f64().unwrap()).abs() < 1e-7, "{name}: y");
            for (column, x) in x.iter().enumerate() {
                assert!(
                    (map.x(column) - x.as_f64().unwrap()).abs() < 1e-7,
                    "{name}: x"
                );
                let (found, wanted) = (map.height(column, row), &entry["heights"][row][column]);
                match wanted.as_f64() {
                    // 32-bit floats were read in double precision by the script too.
                    Some(wanted) => {
                        let far = (found - wanted).abs() > 1e-12 * wanted.abs().max(1e-3);
                        assert!(!far, "{name} {row} {column}: {found} {wanted}");
                    }
                    None => assert!(found.is_nan(), "{name} {row} {column}: {found}"),
                }
            }
        }
    }
}

/// The flag of the units counts for distances and heights alike: the same surface in cm, in inches
/// and in metres.
#[test]
fn the_flag_of_zemax_is_the_unit_of_all_lengths() {
    let all = entries();
    let of = |name: &str| {
        let entry = all.iter().find(|entry| entry["file"] == name).unwrap();
        map(entry, &Conventions::default())
    };
    let mm = of("zemax-mm.DAT");
    for name in ["zemax-in.DAT", "zemax-m.DAT"] {
        let other = of(name);
        assert!((mm.pitch_x() - other.pitch_x()).abs() < 1e-12);
        for (one, other) in mm.heights().iter().zip(other.heights()) {
            assert!(
                one.is_nan() == other.is_nan() && (one.is_nan() || (one - other).abs() <= 1e-15),
                "{name}"
            );
        }
    }
    // A unit that is given goes before the flag.
    let bytes = std::fs::read(folder().join("zemax-mm.DAT")).unwrap();
    let given = Conventions {
        z_unit: length_unit("um"),
        ..Conventions::default()
    };
    let scaled = read("a.dat", &bytes, &given).unwrap();
    assert!((scaled.height(0, 0) * 1e3 - mm.height(0, 0)).abs() < 1e-15);
    assert_eq!(scaled.pitch_x(), mm.pitch_x());
}

#[test]
fn an_origin_in_the_middle_and_mirrored_axes() {
    let all = entries();
    let entry = all
        .iter()
        .find(|entry| entry["file"] == "points.xyz")
        .unwrap();
    let as_is = map(entry, &conventions(entry));
    let middle = Conventions {
        origin: Origin::Middle,
        ..conventions(entry)
    };
    let moved = map(entry, &middle);
    assert!((moved.x(0) + moved.x(moved.columns() - 1)).abs() < 1e-12);
    assert!((moved.y(0) + moved.y(moved.rows() - 1)).abs() < 1e-12);
    let mut mirrored = as_is.clone();
    mirrored.flip_x();
    let last = as_is.columns() - 1;
    assert_eq!(mirrored.height(0, 1), as_is.height(last, 1));
    assert!((mirrored.x(0) + as_is.x(last)).abs() < 1e-12);
    mirrored.flip_x();
    assert!((mirrored.x(0) - as_is.x(0)).abs() < 1e-12);
    let mut mirrored = as_is.clone();
    mirrored.flip_y();
    assert_eq!(mirrored.height(1, 0), as_is.height(1, as_is.rows() - 1));
    assert!((mirrored.y(0) + as_is.y(as_is.rows() - 1)).abs() < 1e-12);
}

/// Columns whose coordinates are rounded to some decimals are still the columns of the grid.
#[test]
fn an_xyz_of_a_thousand_rounded_columns_is_even() {
    let conventions = Conventions {
        xy_unit: Some(1.0),
        z_unit: Some(1.0),
        ..Conventions::default()
    };
    for pitch in [0.010377, 0.03307, 0.10533] {
        for decimals in [3, 4, 5] {
            let (columns, rows) = (1000, 7);
            let mut text = String::new();
            for row in 0..rows {
                // Two columns in a row, and 40 in a row, have no point.
                for column in (0..columns).filter(|k| !matches!(k, 17 | 18 | 400..440)) {
                    let x = pitch * (column as f64 - 499.5);
                    let y = pitch * (row as f64 - 3.0);
                    text.push_str(&format!("{x:.decimals$} {y:.decimals$} {column}{row}\n"));
                }
            }
            let map = read("a.xyz", text.as_bytes(), &conventions).unwrap();
            assert_eq!(
                (map.columns(), map.rows()),
                (columns, rows),
                "{pitch} {decimals}"
            );
            assert_eq!(map.height(999, 3), 9993.0);
            assert!(map.height(418, 3).is_nan());
            let digit: f64 = format!("1e-{decimals}").parse().unwrap();
            let off = [map.x(0) + 499.5 * pitch, map.x(999) - 499.5 * pitch];
            // Rounding takes up to half of a digit from each column.
            assert!(off.iter().all(|off| off.abs() < digit), "{off:?}");
        }
    }
}

/// Gwyddion leaves an offset of zero out: one that is there alone counts, with the other as zero.
#[test]
fn one_offset_of_a_gsf_is_enough() {
    let field = |offsets: &str| {
        let sides = "XReal = 0.006\nYReal = 0.003\nXYUnits = m\nZUnits = m\n";
        let mut bytes = format!("Gwyddion Simple Field 1.0\nXRes = 12\nYRes = 6\n{sides}{offsets}")
            .into_bytes();
        bytes.extend(vec![0; 4 - bytes.len() % 4]);
        bytes.extend(1_f32.to_le_bytes().repeat(72));
        let map = read("a.gsf", &bytes, &Conventions::default()).unwrap();
        // The edges of the field, half a pitch beyond its points.
        [map.x(0) - 0.25, -(map.y(5) + 0.25)]
    };
    let near = |found: [f64; 2], wanted: [f64; 2]| {
        let off = [found[0] - wanted[0], found[1] - wanted[1]];
        assert!(
            off.iter().all(|off| off.abs() < 1e-12),
            "{found:?} {wanted:?}"
        );
    };
    near(field(""), [-3.0, -1.5]);
    near(field("XOffset = -0.004\n"), [-4.0, 0.0]);
    near(field("YOffset = -0.0025\n"), [0.0, -2.5]);
    near(field("XOffset = -0.004\nYOffset = 0.001\n"), [-4.0, 1.0]);
}
