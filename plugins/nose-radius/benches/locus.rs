//! What a series and a centre of the tool locus cost: `cargo bench -p turnpath-nose-radius`. Items
//! are samples of a path.

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use turnpath_core::{
    CentreBuffers, CentreSeries, Compensator, Locus, Misfit, ParamValue, Params, Series, Strategy,
    SurfaceModel, Tool, ToolLocus,
};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::{Conic, EvenAsphere, OffAxisParaboloid};

/// Samples of a call, as a sampler asks for them.
const COUNT: usize = 256;

/// Compensators and the surfaces that they follow.
const LOCI: [&str; 5] = [
    "z-direction on an off-axis paraboloid",
    "z-direction on a conic",
    "z-direction on an even asphere",
    "normal on a conic",
    "none on a conic",
];

fn main() {
    divan::main();
}

fn locus(name: &str) -> ToolLocus {
    let compensator: Box<dyn Compensator> = match name {
        "normal on a conic" => Box::new(Normal),
        "none on a conic" => Box::new(Uncompensated),
        _ => Box::new(ZDirection),
    };
    let mut params = Params::new().with("radius", 100.0).with("conic", -0.5);
    params = params.with("vertex_radius", 915.0);
    params = params.with("off_axis_distance", 915.0);
    let coefficients = [[4.0, 1e-7], [6.0, -3e-10], [8.0, 2e-13], [10.0, -1e-17]];
    let coefficients = coefficients.map(|row| row.to_vec()).to_vec();
    params.set("coefficients", ParamValue::Rows(coefficients));
    let surface: turnpath_core::Result<Box<dyn SurfaceModel>> = match name {
        "z-direction on an off-axis paraboloid" => {
            OffAxisParaboloid::new(&params).map(|surface| Box::new(surface) as _)
        }
        "z-direction on an even asphere" => {
            EvenAsphere::new(&params).map(|surface| Box::new(surface) as _)
        }
        _ => Conic::new(&params).map(|surface| Box::new(surface) as _),
    };
    let surface = surface.unwrap_or_else(|error| panic!("{name}: {error}"));
    let tool = Tool {
        nose_radius: 1.04,
        included_angle: None,
        clearance_angle: None,
        misfit: Misfit::Refuse,
    };
    ToolLocus::new(surface.into(), compensator.into(), tool)
}

/// A part of a turn of a spiral.
fn curves() -> (Vec<Series>, Vec<Series>) {
    let curve = |i: usize| {
        let theta = 0.0085 * i as f64;
        let rho = 20.0 - 0.001 * theta;
        ([theta, 1.0, 0.0, 0.0, 0.0], [rho, -0.001, 1e-7, -1e-9, 0.0])
    };
    (0..COUNT).map(curve).unzip()
}

#[divan::bench(args = LOCI)]
fn series(bencher: Bencher<'_, '_>, name: &str) {
    let (locus, (theta, rho)) = (locus(name), curves());
    let (mut x, mut z) = (vec![[0.0; 5]; COUNT], vec![[0.0; 5]; COUNT]);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let out = CentreSeries {
            x: &mut x,
            z: &mut z,
        };
        let done = locus.series(black_box(&theta), black_box(&rho), out);
        black_box(done.is_ok())
    });
}

#[divan::bench(args = LOCI)]
fn centres(bencher: Bencher<'_, '_>, name: &str) {
    let (locus, (theta, rho)) = (locus(name), curves());
    let value = |curves: Vec<Series>| -> Vec<f64> { curves.iter().map(|c| c[0]).collect() };
    let (theta, rho) = (value(theta), value(rho));
    let mut centres = CentreBuffers::default();
    centres.resize(COUNT);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let done = locus.centre(black_box(&theta), black_box(&rho), centres.as_centres());
        black_box(done.is_ok())
    });
}
