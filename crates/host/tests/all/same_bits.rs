//! Built-in surfaces give the same bits whether they are linked into the program or loaded.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::PathBuf;

use crate::common::fixtures;
use turnpath_core::{GradientSeries, Gradients, ParamValue, Params, Series, Slot, SurfaceModel};
use turnpath_host::{Catalogue, LoadError};
use turnpath_surfaces as _;

/// Cargo puts the library of a dependency beside the test program.
fn surfaces_library() -> PathBuf {
    let program = std::env::current_exe().unwrap();
    program.with_file_name(fixtures::file_name("turnpath-surfaces"))
}

fn loaded() -> Catalogue {
    crate::common::with_file(&surfaces_library()).unwrap()
}

fn rows(rows: &[&[f64]]) -> ParamValue {
    ParamValue::Rows(rows.iter().map(|row| row.to_vec()).collect())
}

fn params(name: &str) -> Params {
    let mut params = Params::new();
    match name {
        "astigmatic" => return params.with("k", 0.08),
        "conic" => return params.with("radius", 40.0).with("conic", -0.7),
        "toric" => {
            return params
                .with("radius_rotation", 40.0)
                .with("radius_base", 35.0);
        }
        "off-axis-paraboloid" => {
            return params
                .with("vertex_radius", 100.0)
                .with("off_axis_distance", 12.0);
        }
        "xy-polynomial" => {
            let terms = vec![vec![2.0, 0.0, 0.01], vec![1.0, 3.0, -2e-4]];
            params.set("terms", ParamValue::Rows(terms));
        }
        "sinusoidal-array" => {
            params.set("form", ParamValue::Text("sum".into()));
            return params
                .with("amplitude_x", 0.005)
                .with("amplitude_y", 0.004)
                .with("frequency_x", 0.5)
                .with("frequency_y", 0.3);
        }
        "even-asphere" => {
            params = params.with("radius", 62.5).with("conic", -0.85);
            params.set("coefficients", rows(&[&[4.0, 1.35e-6], &[6.0, -4.2e-9]]));
        }
        "odd-asphere" => {
            params = params.with("radius", 180.0).with("conic", 0.0);
            params.set("coefficients", rows(&[&[3.0, 4e-6], &[5.0, -6e-9]]));
        }
        "biconic" => {
            return params
                .with("radius_x", 160.0)
                .with("radius_y", 210.0)
                .with("conic_x", -1.0)
                .with("conic_y", -0.6);
        }
        "toroid-yz" => {
            params = params.with("radius_rotation", 85.0).with("radius", 240.0);
            params.set("conic", ParamValue::Number(-0.4));
            params.set("coefficients", rows(&[&[4.0, -1.5e-7]]));
        }
        "off-axis-conic" => {
            return params
                .with("vertex_radius", 220.0)
                .with("conic", -0.45)
                .with("off_axis_distance", 35.0);
        }
        "lenslet-array" => {
            params = params
                .with("pitch", 1.0)
                .with("radius", 12.0)
                .with("conic", 0.0);
            params.set("layout", ParamValue::Text("hexagonal".into()));
        }
        other => panic!("no parameters here for `{other}`"),
    }
    params
}

/// Points all over the part. Their number is no multiple of a batch.
fn points() -> (Vec<f64>, Vec<f64>) {
    let at = |i: u32, step: f64| (f64::from(i) * step) % 6.0 - 3.0;
    (0..1003).map(|i| (at(i, 0.737), at(i, 0.291))).unzip()
}

fn bits<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u64> {
    values.into_iter().map(|value| value.to_bits()).collect()
}

fn all_bits(surface: &dyn SurfaceModel) -> Vec<u64> {
    let (x, y) = points();
    let blank = vec![0.0; x.len()];
    let (mut sag, mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank.clone(), blank);
    surface.heights(&x, &y, &mut sag).unwrap();
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&x, &y, out).unwrap();
    let mut all = bits(sag.iter().chain(&z).chain(&zx).chain(&zy));
    all.extend(series_bits(surface, &x, &y));
    all
}

fn series_bits(surface: &dyn SurfaceModel, x: &[f64], y: &[f64]) -> Vec<u64> {
    let along = |values: &[f64]| -> Vec<Series> {
        let series = |value: &f64| [*value, 0.3 - value, 0.2 * value, -0.1, 0.05];
        values.iter().map(series).collect()
    };
    let (x, y) = (along(x), along(y));
    let blank = vec![[0.0; 5]; x.len()];
    let (mut h, mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank.clone(), blank);
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(&x, &y, out).unwrap();
    surface.height_series(&x, &y, &mut h).unwrap();
    [h, z, zx, zy]
        .iter()
        .flat_map(|s| bits(s.as_flattened()))
        .collect()
}

#[test]
fn every_surface_gives_the_same_bits_linked_and_loaded() {
    let (linked, loaded) = (Catalogue::linked().unwrap(), loaded());
    let names = linked.names(Slot::Surface);
    assert_eq!(names, loaded.names(Slot::Surface));
    assert!(
        names.contains(&"astigmatic") && names.len() >= 6,
        "{names:?}"
    );
    for name in names {
        let surfaces = [&linked, &loaded].map(|catalogue| {
            let strategy = catalogue.find(Slot::Surface, name).unwrap();
            strategy.offer().surface(&params(name)).unwrap()
        });
        let [linked, loaded] = surfaces.map(|surface| all_bits(surface.as_ref()));
        assert!(linked == loaded, "`{name}` differs");
    }
}

#[test]
fn every_surface_has_the_same_declaration_linked_and_loaded() {
    let (linked, loaded) = (Catalogue::linked().unwrap(), loaded());
    for (one, other) in linked.strategies().zip(loaded.strategies()) {
        assert_eq!(one.info(), other.info());
    }
}

#[test]
fn a_built_in_has_neither_file_nor_hash() {
    let linked = Catalogue::linked().unwrap();
    let [plugin] = linked.plugins() else {
        panic!("one plugin, not {:?}", linked.plugins());
    };
    assert_eq!(plugin.name, "turnpath-surfaces");
    assert!(plugin.file.is_none() && plugin.hash.is_none());
    assert!(plugin.to_string().ends_with("(built in)"), "{plugin}");
}

#[test]
fn a_built_in_and_the_same_plugin_loaded_are_two_of_one_name() {
    let mut catalogue = Catalogue::linked().unwrap();
    let before = catalogue.strategies().count();
    let error = catalogue.add_file(surfaces_library()).unwrap_err();
    assert!(matches!(&error, LoadError::TwoOfOneName { .. }), "{error}");
    let text = error.to_string();
    assert!(text.contains("(built in)"), "{text}");
    assert!(
        text.contains("libturnpath_surfaces") || cfg!(windows),
        "{text}"
    );
    assert_eq!(catalogue.strategies().count(), before);
}
