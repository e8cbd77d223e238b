//! What a point costs on each surface model: `cargo bench -p turnpath-polynomials`. Items are points
//! or curves.

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::{
    GradientSeries, Gradients, NamedConstant, ORDER, ParamValue, Params, Result, Scalar, Series,
    SeriesOrders, Strategy, StrategyError, SurfaceModel,
};
use turnpath_formula::Formula;
use turnpath_grid::GridSag;
use turnpath_maps::Map;
use turnpath_polynomials::{Chebyshev, ForbesQ2d, ForbesQbfs, ForbesQcon, Zernike};
use turnpath_surfaces::{
    Astigmatic, Biconic, Conic, EvenAsphere, LensletArray, OddAsphere, OffAxisConic,
    OffAxisParaboloid, SinusoidalArray, Toric, ToroidYz, XyPolynomial,
};

/// Points of a call, as of a block of a path.
const COUNT: usize = 1024;
/// Points along a side of the map.
const SIDE: usize = 256;
/// Radius of the part, mm.
const RADIUS: f64 = 10.0;

/// The models, with as many terms as parts have: four even powers, the first eleven polynomials of
/// a disc, products up to the fourth degree. The formula and the map of 256² points are those of the
/// conic.
const MODELS: [&str; 19] = [
    "conic",
    "astigmatic",
    "sinusoidal-array",
    "toric",
    "off-axis-paraboloid",
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
    "formula",
    "grid-sag",
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
        "radius_base",
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
    params = params.with("off_axis_distance", 30.0).with("k", 1e-3);
    params = params.with("amplitude_x", 5e-3).with("frequency_x", 0.4);
    params.set("form", ParamValue::Text("sum".to_owned()));
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

/// The conic as a formula.
fn formula() -> Result<Box<dyn SurfaceModel>> {
    let constant = |(name, value, length_power): (&str, f64, i32)| NamedConstant {
        name: name.to_owned(),
        value,
        length_power,
    };
    let constants = [("c", 1.0 / 80.0, -1), ("K", -0.5, 0)].map(constant);
    let mut params = Params::new();
    let z = "c*rho^2/(1 + sqrt(1 - (1 + K)*c^2*rho^2))";
    params.set("z", ParamValue::Text(z.to_owned()));
    params.set("constants", ParamValue::Constants(constants.to_vec()));
    Ok(Box::new(Formula::new(&params)?))
}

/// The conic as a map of [`SIDE`]² points.
fn map() -> Result<Box<dyn SurfaceModel>> {
    let conic = Conic::new(&params("conic"))?;
    let half = 1.2 * RADIUS;
    let pitch = 2.0 * half / (SIDE - 1) as f64;
    let place = |k: usize| pitch * k as f64 - half;
    let x: Vec<f64> = (0..SIDE * SIDE).map(|k| place(k % SIDE)).collect();
    let y: Vec<f64> = (0..SIDE * SIDE).map(|k| place(k / SIDE)).collect();
    let mut z = vec![0.0; x.len()];
    conic.heights(&x, &y, &mut z)?;
    let map = Map::new(SIDE, SIDE, pitch, pitch, z);
    let map = map.map_err(|error| StrategyError::failed(error.to_string()))?;
    Ok(Box::new(GridSag::of(map, None)?))
}

fn surface(model: &str) -> Box<dyn SurfaceModel> {
    let made = match model {
        "conic" => boxed::<Conic>(model),
        "astigmatic" => boxed::<Astigmatic>(model),
        "sinusoidal-array" => boxed::<SinusoidalArray>(model),
        "toric" => boxed::<Toric>(model),
        "off-axis-paraboloid" => boxed::<OffAxisParaboloid>(model),
        "formula" => formula(),
        "grid-sag" => map(),
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

/// What the compensator `z-direction` asks of a surface for each of its series.
#[divan::bench(args = MODELS)]
fn series_of_a_foot(bencher: Bencher<'_, '_>, model: &str) {
    bench_series(
        bencher,
        model,
        SeriesOrders {
            heights: ORDER,
            slopes: 2,
        },
    );
}

#[divan::bench(args = MODELS)]
fn series(bencher: Bencher<'_, '_>, model: &str) {
    bench_series(bencher, model, SeriesOrders::ALL);
}

fn bench_series(bencher: Bencher<'_, '_>, model: &str, orders: SeriesOrders) {
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
        black_box(
            surface
                .series_to(orders, black_box(&x), black_box(&y), out)
                .is_ok(),
        )
    });
}
