//! The spline against scipy and mpmath (tests/reference/grids/splines.py): heights, slopes, series.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;
use turnpath_maps::Map;
use turnpath_plugin::prelude::{Gradients, Series, SurfaceModel};

use crate::sheet::Sheet;
use crate::spline::Spline;
use crate::surface::GridSag;

/// Bound of heights, mm.
const HEIGHT: f64 = 1e-12;
/// Bound of slopes.
const SLOPE: f64 = 1e-11;
/// Bound of each coefficient of a series, relative to the largest of its order in any series of the
/// case: a coefficient may vanish where the terms that it is a sum of do not.
const RELATIVE: f64 = 1e-11;

fn cases() -> Vec<Value> {
    let text = include_str!("../../../tests/reference/grids/splines.json");
    let all: Value = serde_json::from_str(text).unwrap();
    all["cases"].as_array().unwrap().clone()
}

fn pair(case: &Value, key: &str) -> [f64; 2] {
    [0, 1].map(|axis| case[key][axis].as_f64().unwrap())
}

fn heights(case: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(case["heights"].clone()).unwrap()
}

/// The spline through the heights of a case.
fn spline(case: &Value) -> Spline {
    let count = |key: &str| case[key].as_u64().unwrap() as usize;
    let pair = |key: &str| pair(case, key);
    let heights = heights(case);
    let heights = Sheet {
        columns: count("columns"),
        rows: count("rows"),
        values: heights.concat(),
    };
    Spline::through(heights, pair("first"), pair("pitch"))
}

#[test]
fn heights_and_slopes_are_those_of_scipy() {
    for case in cases() {
        let spline = spline(&case);
        for place in case["places"].as_array().unwrap() {
            let [x, y] = ["x", "y"].map(|axis| place[axis].as_f64().unwrap());
            let found = spline.gradient(x, y);
            for (k, bound) in [HEIGHT, SLOPE, SLOPE].into_iter().enumerate() {
                let wanted = place["z_zx_zy"][k].as_f64().unwrap();
                let far = (found[k] - wanted).abs();
                assert!(far <= bound, "{place} {k}: {} off by {far}", found[k]);
            }
            assert_eq!(spline.height(x, y), found[0]);
        }
    }
}

/// The surface as a recipe gets it: where a map is smooth it is the spline of scipy, up to the edges.
#[test]
fn a_smooth_map_is_the_spline_of_scipy_as_a_surface() {
    let all = cases();
    let smooth: Vec<&Value> = all.iter().filter(|case| case["noise"] == 0).collect();
    assert_eq!(smooth.len(), 1);
    for case in smooth {
        let ([pitch_x, pitch_y], [left, bottom]) = (pair(case, "pitch"), pair(case, "first"));
        let heights = heights(case);
        let (columns, rows) = (heights[0].len(), heights.len());
        let map = Map::new(columns, rows, pitch_x, pitch_y, heights.concat()).unwrap();
        let surface = GridSag::of(map, None).unwrap();
        // A map of its own lies around the origin.
        let middle = [
            left + 0.5 * pitch_x * (columns as f64 - 1.0),
            bottom + 0.5 * pitch_y * (rows as f64 - 1.0),
        ];
        for place in case["places"].as_array().unwrap() {
            let [x, y] = ["x", "y"].map(|axis| place[axis].as_f64().unwrap());
            let (mut z, mut zx, mut zy) = ([0.0], [0.0], [0.0]);
            let out = Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            surface
                .gradient(&[x - middle[0]], &[y - middle[1]], out)
                .unwrap();
            for (found, (k, bound)) in [z, zx, zy]
                .iter()
                .zip([HEIGHT, SLOPE, SLOPE].into_iter().enumerate())
            {
                let far = (found[0] - place["z_zx_zy"][k].as_f64().unwrap()).abs();
                assert!(far <= bound, "{place} {k}: off by {far}");
            }
        }
    }
}

#[test]
fn series_along_curves_are_those_of_50_digits() {
    let mut checked = 0;
    for case in cases() {
        let spline = spline(&case);
        let curves = case["curves"].as_array().unwrap();
        let of = |curve: &Value, key: &str| -> Series {
            serde_json::from_value(curve[key].clone()).unwrap()
        };
        // A coefficient is a sum of terms of the size of the largest.
        let size = |key: &str, order: usize| {
            let all = curves.iter().map(|curve| of(curve, key)[order].abs());
            all.fold(0.0, f64::max)
        };
        for curve in curves {
            let (x, y) = (of(curve, "x"), of(curve, "y"));
            let [z, zx, zy] = spline.series::<5, 5, 6>(&x, &y);
            assert_eq!(spline.height_series::<5>(&x, &y), z);
            let low = [
                spline.series::<2, 2, 3>(&x, &y),
                spline.series::<3, 3, 4>(&x, &y),
            ];
            for (to, low) in (1..).zip(low) {
                for (low, all) in low.iter().zip([z, zx, zy]) {
                    assert_eq!(low[..=to], all[..=to]);
                }
            }
            // All heights, with slopes through order 2.
            let low = spline.series::<5, 3, 5>(&x, &y);
            assert_eq!(low[0], z);
            assert_eq!(
                [low[1][..3].to_vec(), low[2][..3].to_vec()],
                [zx[..3].to_vec(), zy[..3].to_vec()]
            );
            assert_eq!(spline.height_series::<3>(&x, &y)[..3], z[..3]);
            for (key, found) in [("z", z), ("zx", zx), ("zy", zy)] {
                for (order, wanted) in of(curve, key).into_iter().enumerate() {
                    let far = (found[order] - wanted).abs() / size(key, order);
                    assert!(far <= RELATIVE, "{key} {order}: {} {wanted}", found[order]);
                    checked += 1;
                }
            }
        }
    }
    assert_eq!(checked, 3 * 4 * 3 * 5);
}
