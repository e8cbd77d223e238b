//! The speed of a map beside that of a conic: `cargo bench -p turnpath-grid`. Items are points or curves.
//! `docs/maps.md` has the results.

use std::hint::black_box;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::{
    GradientSeries, Gradients, Params, Series, SeriesOrders, Strategy, SurfaceModel,
};
use turnpath_grid::GridSag;
use turnpath_maps::Map;
use turnpath_surfaces::Conic;

/// Points of a batch.
const POINTS: usize = 4096;
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
    /// Points along a side of the map. The coefficients of 256² take 0.7 MB, those of 1024² take 9 MB,
    /// which is more than a core's own cache.
    Grid(usize),
}

const ALL: [Which; 3] = [Which::Conic, Which::Grid(256), Which::Grid(1024)];

fn surface(which: Which) -> Arc<dyn SurfaceModel> {
    let params = Params::new().with("radius", RADIUS).with("conic", 0.0);
    let Ok(conic) = Conic::new(&params) else {
        panic!("the conic has its parameters")
    };
    match which {
        Which::Conic => Arc::new(conic),
        Which::Grid(count) => {
            let side = 2.4 * APERTURE;
            let pitch = side / (count - 1) as f64;
            let place = |k: usize| pitch * k as f64 - 0.5 * side;
            let x: Vec<f64> = (0..count * count).map(|k| place(k % count)).collect();
            let y: Vec<f64> = (0..count * count).map(|k| place(k / count)).collect();
            let mut z = vec![0.0; x.len()];
            let heights = SurfaceModel::heights(&conic, &x, &y, &mut z);
            let map = heights.map(|()| Map::new(count, count, pitch, pitch, z));
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

#[divan::bench(args = ALL)]
fn value(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), points());
    let mut z = vec![0.0; POINTS];
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| surface.heights(black_box(&x), &y, &mut z));
}

#[divan::bench(args = ALL)]
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

#[divan::bench(args = ALL)]
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

/// A profile's height, slope and bend: most series of a check are these.
#[divan::bench(args = ALL)]
fn height_series_to_order_2(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), curves());
    let mut z = vec![[0.0; 5]; POINTS];
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| surface.height_series_to(2, black_box(&x), &y, &mut z));
}

/// The heights and slopes that curvatures come from.
#[divan::bench(args = ALL)]
fn series_to_order_1(bencher: Bencher<'_, '_>, which: Which) {
    let (surface, (x, y)) = (surface(which), curves());
    let [mut z, mut zx, mut zy] = [0; 3].map(|_| vec![[0.0; 5]; POINTS]);
    let orders = SeriesOrders {
        heights: 1,
        slopes: 1,
    };
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.series_to(orders, black_box(&x), &y, out)
    });
}
