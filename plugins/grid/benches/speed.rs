//! The speed of a map beside that of a conic: `cargo bench -p turnpath-grid`. Items are points, curves
//! or positions. `docs/maps.md` has the results.

use std::hint::black_box;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::{
    GradientSeries, Gradients, Misfit, Params, Part, Series, Strategy, SurfaceModel, Tool,
};
use turnpath_grid::GridSag;
use turnpath_maps::Map;
use turnpath_surfaces::Conic;
use turnpath_verify::{FirstTouch, Subject};

/// Points of a batch.
const POINTS: usize = 4096;
/// Points along a side of the map: its coefficients take 9 MB, more than a core's own cache.
const SIDE: usize = 1024;
/// The radius of the conic, mm.
const RADIUS: f64 = 50.0;
/// The radius of the part, mm.
const APERTURE: f64 = 5.0;

fn main() {
    divan::main();
}

#[derive(Debug, Clone, Copy)]
enum Which {
    Conic,
    Grid,
}

const BOTH: [Which; 2] = [Which::Conic, Which::Grid];

fn surface(which: Which) -> Arc<dyn SurfaceModel> {
    let params = Params::new().with("radius", RADIUS).with("conic", 0.0);
    let Ok(conic) = Conic::new(&params) else {
        panic!("the conic has its parameters")
    };
    match which {
        Which::Conic => Arc::new(conic),
        Which::Grid => {
            let side = 2.4 * APERTURE;
            let pitch = side / (SIDE - 1) as f64;
            let place = |k: usize| pitch * k as f64 - 0.5 * side;
            let x: Vec<f64> = (0..SIDE * SIDE).map(|k| place(k % SIDE)).collect();
            let y: Vec<f64> = (0..SIDE * SIDE).map(|k| place(k / SIDE)).collect();
            let mut z = vec![0.0; x.len()];
            let heights = SurfaceModel::heights(&conic, &x, &y, &mut z);
            let map = heights.map(|()| Map::new(SIDE, SIDE, pitch, pitch, z));
            match map.map(|map| map.map(|map| GridSag::of(map, None))) {
                Ok(Ok(Ok(grid))) => Arc::new(grid),
                _ => panic!("the map of a conic is a map"),
            }
        }
    }
}

/// Points along a spiral, as a path asks for them.
fn points() -> (Vec<f64>, Vec<f64>) {
    (0..POINTS)
        .map(|k| {
            let share = k as f64 / POINTS as f64;
            let (sin, cos) = turnpath_core::Scalar::sin_cos(60.0 * share);
            (APERTURE * share * cos, APERTURE * share * sin)
        })
        .unzip()
}

fn curves() -> (Vec<Series>, Vec<Series>) {
    let (x, y) = points();
    let curve = |at: &f64| [*at, 0.3, -0.2, 0.1, 0.05];
    (x.iter().map(curve).collect(), y.iter().map(curve).collect())
}

#[divan::bench(args = BOTH)]
fn value(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), points());
    let mut z = vec![0.0; POINTS];
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| surface.heights(black_box(&x), &y, &mut z));
}

#[divan::bench(args = BOTH)]
fn gradient(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), points());
    let [mut z, mut zx, mut zy] = [0; 3].map(|_| vec![0.0; POINTS]);
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(black_box(&x), &y, out)
    });
}

#[divan::bench(args = BOTH)]
fn series(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), curves());
    let [mut z, mut zx, mut zy] = [0; 3].map(|_| vec![[0.0; 5]; POINTS]);
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.series(black_box(&x), &y, out)
    });
}

#[divan::bench(args = BOTH)]
fn first_touch(bencher: Bencher<'_, '_>, which: Which) {
    let subject = Subject {
        surface: surface(which),
        part: Part {
            aperture_radius: APERTURE,
            inner_radius: 0.0,
        },
        tool: Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        },
        compensates_nose: true,
    };
    let Ok(touch) = FirstTouch::new(subject) else {
        panic!("a nose of 1 mm fits")
    };
    let theta: Vec<f64> = (0..POINTS).map(|i| 0.001 * i as f64).collect();
    let x: Vec<f64> = (0..POINTS)
        .map(|i| 0.9 * APERTURE * i as f64 / POINTS as f64)
        .collect();
    let mut found = Vec::new();
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| touch.find(black_box(&theta), black_box(&x), &mut found));
}
