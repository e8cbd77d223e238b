//! The speed of measuring a path: `cargo bench -p turnpath-verify`. Items are positions, segments,
//! passes or cells. `docs/benchmarks.md` has the results.

#[path = "../tests/all/common/mod.rs"]
mod common;

use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

use common::{AST5, astigmatic_path, touch_on};
use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::toolpath::PathBlock;
use turnpath_core::{DEG, Misfit, NM, Params, Part, Strategy, Surface, SurfaceModel, Tool};
use turnpath_grid::GridSag;
use turnpath_surfaces::Conic;
use turnpath_verify::machined::{Grid, Map, Nose};
use turnpath_verify::{FirstTouch, Meter, Subject};

/// The path over AST-5: 110 turns of 25 µm in steps of 9 deg.
const TURNS: usize = 110;
const FEED: f64 = 0.025;
/// Largest error of that path, for the map.
const LARGEST_ERROR: f64 = 100.0 * NM;
/// Cells of a map along each side.
const CELLS: usize = 300;

fn main() {
    divan::main();
}

fn path() -> PathBlock {
    let law = |theta: f64| (2.75 - FEED * theta / TAU, -FEED / TAU);
    astigmatic_path(AST5, 1.0, TURNS * 40, 9.0 * DEG, law)
}

fn touch() -> FirstTouch {
    touch_on(AST5, 2.5, 1.0, true)
}

#[divan::bench]
fn first_touch(bencher: Bencher<'_, '_>) {
    let touch = touch();
    let theta: Vec<f64> = (0..10_000).map(|i| 0.001 * f64::from(i)).collect();
    let x: Vec<f64> = (0..10_000).map(|i| 2.5e-4 * f64::from(i)).collect();
    let mut found = Vec::new();
    bencher
        .counter(ItemsCount::new(x.len()))
        .bench_local(|| touch.find(black_box(&theta), black_box(&x), &mut found));
}

/// A conic, or a map of it.
#[derive(Debug, Clone, Copy)]
enum Sag {
    Conic,
    /// Points along a side of the map.
    Map(usize),
}

/// A sphere of 50 mm, and maps of it with a side of 12 mm.
fn conic(sag: Sag) -> Arc<dyn SurfaceModel> {
    let params = Params::new().with("radius", 50.0).with("conic", 0.0);
    let Ok(conic) = Conic::new(&params) else {
        panic!("the conic has its parameters")
    };
    let Sag::Map(count) = sag else {
        return Arc::new(conic);
    };
    let pitch = 12.0 / (count - 1) as f64;
    let place = |k: usize| pitch * k as f64 - 6.0;
    let heights =
        (0..count * count).map(|k| Surface::sag(&conic, place(k % count), place(k / count)));
    let map = turnpath_maps::Map::new(count, count, pitch, pitch, heights.collect());
    match map.map(|map| GridSag::of(map, None)) {
        Ok(Ok(grid)) => Arc::new(grid),
        _ => panic!("the map of a conic is a map"),
    }
}

#[divan::bench(args = [Sag::Conic, Sag::Map(256), Sag::Map(1024)])]
fn first_touch_on_a_map(bencher: Bencher<'_, '_>, sag: Sag) {
    let subject = Subject {
        surface: conic(sag),
        part: Part {
            aperture_radius: 5.0,
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
    let theta: Vec<f64> = (0..10_000).map(|i| 0.001 * f64::from(i)).collect();
    let x: Vec<f64> = (0..10_000).map(|i| 4.5e-4 * f64::from(i)).collect();
    let mut found = Vec::new();
    bencher
        .counter(ItemsCount::new(x.len()))
        .bench_local(|| touch.find(black_box(&theta), black_box(&x), &mut found));
}

#[divan::bench]
fn playback(bencher: Bencher<'_, '_>) {
    let (touch, path) = (touch(), path());
    bencher
        .counter(ItemsCount::new(path.len() - 1))
        .bench_local(|| Meter::segment_errors(&touch, black_box(&path)));
}

/// The figures of the machined surface from known passes, in one thread.
#[divan::bench]
fn surface_figures(bencher: Bencher<'_, '_>) {
    let (touch, path) = (touch(), path());
    let mut meter = Meter::new(touch.clone());
    let block = Meter::measure(&touch, &path);
    let appended = block.and_then(|block| meter.append(block));
    assert!(appended.is_ok());
    let passes = TURNS * 736;
    bencher
        .counter(ItemsCount::new(passes))
        .bench_local(|| one_thread(|| meter.machined()));
}

/// Cuts a map of 300 × 300 cells in one thread.
fn map(bencher: Bencher<'_, '_>, largest_error: f64) {
    let (touch, path) = (touch(), path());
    let part = touch.subject().part;
    let nose = Nose::new(&touch, largest_error);
    bencher
        .counter(ItemsCount::new(CELLS * CELLS))
        .bench_local(|| {
            let mut map = Map::new(Grid::cartesian(&part, CELLS), part);
            one_thread(|| map.cut(&nose, black_box(&path)))
        });
}

/// Computes only the passes that can be the lowest.
#[divan::bench]
fn map_cells(bencher: Bencher<'_, '_>) {
    map(bencher, LARGEST_ERROR);
}

/// Computes every pass within reach of a cell.
#[divan::bench]
fn map_cells_by_brute_force(bencher: Bencher<'_, '_>) {
    map(bencher, f64::INFINITY);
}

fn one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}
