//! What a point costs on each surface model: `cargo bench -p turnpath-polynomials`. Items are points
//! or curves. `docs/benchmarks.md` has the results.

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::{
    GradientSeries, Gradients, ParamValue, Params, Result, Scalar, Series, Strategy, SurfaceModel,
};
use turnpath_polynomials::{Chebyshev, ForbesQ2d, ForbesQbfs, ForbesQcon, Zernike};
use turnpath_surfaces::{
    Biconic, Conic, EvenAsphere, LensletArray, OddAsphere, OffAxisConic, ToroidYz, XyPolynomial,
};

/// Points of a call, as of a block of a path.
const COUNT: usize = 1024;
/// Radius of the part, mm.
const RADIUS: f64 = 10.0;

/// The models, with as many terms as parts have: four even powers, the first eleven polynomials of
/// a disc, products up to the fourth degree.
const MODELS: [&str; 13] = [
    "conic",
    "even-asphere",
    "odd-asphere",
    "biconic",
    "toroid-yz",
    "off-axis-conic",
    "lenslet-array",
    "xy-polynomial",
    "zernike",
    "forbes-qbfs",
    "forbes-qcon",
    "forbes-q2d",
    "chebyshev",
];

fn main() {
    divan::main();
}

fn rows<const N: usize>(keys: impl IntoIterator<Item = [i32; N]>) -> ParamValue {
    let row = |key: [i32; N]| key.map(f64::from).into_iter().chain([1e-4]).collect();
    ParamValue::Rows(keys.into_iter().map(row).collect())
}

/// Pairs of which the sum is at most four.
fn pairs() -> impl Iterator<Item = [i32; 2]> {
    (0..=4).flat_map(|i| (0..=4 - i).map(move |j| [i, j]))
}

fn params(model: &str) -> Params {
    let mut params = Params::new().with("conic", -0.5);
    for length in [
        "radius",
        "radius_x",
        "radius_y",
        "radius_rotation",
        "vertex_radius",
    ] {
        params = params.with(length, 80.0);
    }
    for length in ["normalization_radius", "normalization_x", "pitch"] {
        params = params.with(length, RADIUS);
    }
    for number in ["conic_x", "conic_y"] {
        params = params.with(number, -0.5);
    }
    params = params.with("off_axis_distance", 30.0);
    params.set("layout", ParamValue::Text("hexagonal".to_owned()));
    params.set("indexing", ParamValue::Text("noll".to_owned()));
    let coefficients = match model {
        "even-asphere" | "toroid-yz" => rows((2..=5).map(|i| [2 * i])),
        "odd-asphere" => rows((3..=6).map(|i| [i])),
        "zernike" => rows((1..=11).map(|i| [i])),
        "forbes-qbfs" | "forbes-qcon" => rows((0..=5).map(|i| [i])),
        "forbes-q2d" => rows(pairs()),
        _ => rows(pairs()),
    };
    params.set("coefficients", coefficients);
    params
}

fn boxed<T: Strategy + SurfaceModel + 'static>(model: &str) -> Result<Box<dyn SurfaceModel>> {
    Ok(Box::new(T::new(&params(model))?))
}

fn surface(model: &str) -> Box<dyn SurfaceModel> {
    let made = match model {
        "conic" => boxed::<Conic>(model),
        "even-asphere" => boxed::<EvenAsphere>(model),
        "odd-asphere" => boxed::<OddAsphere>(model),
        "biconic" => boxed::<Biconic>(model),
        "toroid-yz" => boxed::<ToroidYz>(model),
        "off-axis-conic" => boxed::<OffAxisConic>(model),
        "lenslet-array" => boxed::<LensletArray>(model),
        "xy-polynomial" => boxed::<XyPolynomial>(model),
        "zernike" => boxed::<Zernike>(model),
        "forbes-qbfs" => boxed::<ForbesQbfs>(model),
        "forbes-qcon" => boxed::<ForbesQcon>(model),
        "forbes-q2d" => boxed::<ForbesQ2d>(model),
        _ => boxed::<Chebyshev>(model),
    };
    made.unwrap_or_else(|error| panic!("{model}: {error}"))
}

/// Points of a spiral.
fn points() -> (Vec<f64>, Vec<f64>) {
    let point = |i: usize| {
        let part = (i as f64 + 0.5) / COUNT as f64;
        let (sin, cos) = Scalar::sin_cos(400.0 * part);
        (RADIUS * part * cos, RADIUS * part * sin)
    };
    (0..COUNT).map(point).unzip()
}

/// Curves through them.
fn curves() -> (Vec<Series>, Vec<Series>) {
    let (x, y) = points();
    let curve = |(x, y): (f64, f64)| {
        (
            [x, -y, -0.5 * x, y / 6.0, x / 24.0],
            [y, x, -0.5 * y, -x / 6.0, y / 24.0],
        )
    };
    x.into_iter().zip(y).map(curve).unzip()
}

#[divan::bench(args = MODELS)]
fn heights(bencher: Bencher<'_, '_>, model: &str) {
    let (surface, (x, y)) = (surface(model), points());
    let mut z = vec![0.0; COUNT];
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let done = surface.heights(black_box(&x), black_box(&y), &mut z);
        black_box(done.is_ok())
    });
}

#[divan::bench(args = MODELS)]
fn heights_and_slopes(bencher: Bencher<'_, '_>, model: &str) {
    let (surface, (x, y)) = (surface(model), points());
    let (mut z, mut zx, mut zy) = (vec![0.0; COUNT], vec![0.0; COUNT], vec![0.0; COUNT]);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        black_box(surface.gradient(black_box(&x), black_box(&y), out).is_ok())
    });
}

#[divan::bench(args = MODELS)]
fn series(bencher: Bencher<'_, '_>, model: &str) {
    let (surface, (x, y)) = (surface(model), curves());
    let (mut z, mut zx, mut zy) = (
        vec![[0.0; 5]; COUNT],
        vec![[0.0; 5]; COUNT],
        vec![[0.0; 5]; COUNT],
    );
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        black_box(surface.series(black_box(&x), black_box(&y), out).is_ok())
    });
}
