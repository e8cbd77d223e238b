//! What a sum and a pose cost: `cargo bench -p turnpath-pipeline`. Items are points or curves.
//! `docs/benchmarks.md` has the results.

#[path = "../tests/all/common/formulas.rs"]
mod formulas;

use std::hint::black_box;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use formulas::{Conicoid, Segment, Waves};
use turnpath_core::{
    Attitude, GradientSeries, Gradients, Placement, Pose, Scalar, Series, SurfaceModel,
};
use turnpath_pipeline::{PlacedSurface, PosedSurface, SurfaceSum};

/// Points of a call, as of a block of a path.
const COUNT: usize = 1024;
/// Radius of the part, mm.
const RADIUS: f64 = 25.0;

fn main() {
    divan::main();
}

/// The surfaces whose speeds are compared.
#[derive(Debug, Clone, Copy)]
enum Subject {
    /// The paraboloid about its own axis.
    Parent,
    /// The same laid level off its axis.
    PosedParent,
    /// The closed form of that.
    Segment,
    /// The paraboloid and waves that are moved and turned.
    Sum,
    /// The same laid level.
    PosedSum,
}

const SUBJECTS: [Subject; 5] = [
    Subject::Parent,
    Subject::PosedParent,
    Subject::Segment,
    Subject::Sum,
    Subject::PosedSum,
];

fn parent() -> Arc<dyn SurfaceModel> {
    Arc::new(Conicoid {
        curvature: 1.0 / 300.0,
        conic: -1.0,
    })
}

fn sum() -> Arc<dyn SurfaceModel> {
    let waves = Waves {
        height: 1e-3,
        wave: 0.5,
    };
    let placement = Placement {
        scale: -1.0,
        decentre_x: 1.0,
        clocking: 0.5,
        ..Placement::PLAIN
    };
    let waves = PlacedSurface::new(Arc::new(waves), placement);
    Arc::new(SurfaceSum::new(vec![parent(), Arc::new(waves)]))
}

fn posed(surface: Arc<dyn SurfaceModel>) -> Arc<dyn SurfaceModel> {
    let pose = Pose {
        x: 100.0,
        y: 0.0,
        attitude: Attitude::Level,
    };
    match PosedSurface::new(surface, pose) {
        Ok(posed) => Arc::new(posed),
        Err(error) => panic!("{error}"),
    }
}

fn surface(subject: Subject) -> Arc<dyn SurfaceModel> {
    match subject {
        Subject::Parent => parent(),
        Subject::PosedParent => posed(parent()),
        Subject::Segment => Arc::new(Segment {
            vertex: 300.0,
            off_axis: 100.0,
        }),
        Subject::Sum => sum(),
        Subject::PosedSum => posed(sum()),
    }
}

/// Points along a spiral.
fn points() -> (Vec<f64>, Vec<f64>) {
    let place = |i: usize| {
        let (sin, cos) = Scalar::sin_cos(0.1 * i as f64);
        let rho = RADIUS * (1.0 - i as f64 / COUNT as f64);
        (rho * cos, rho * sin)
    };
    (0..COUNT).map(place).unzip()
}

fn curves() -> (Vec<Series>, Vec<Series>) {
    let (x, y) = points();
    let along = |(x, y): (&f64, &f64)| {
        (
            [*x, -y, -0.5 * x, y / 6.0, x / 24.0],
            [*y, *x, 0.0, 0.0, 0.0],
        )
    };
    x.iter().zip(&y).map(along).unzip()
}

#[divan::bench(args = SUBJECTS)]
fn heights(bencher: Bencher<'_, '_>, subject: Subject) {
    let (surface, (x, y)) = (surface(subject), points());
    let mut z = vec![0.0; COUNT];
    bencher
        .counter(ItemsCount::new(COUNT))
        .bench_local(|| surface.heights(black_box(&x), black_box(&y), &mut z));
}

#[divan::bench(args = SUBJECTS)]
fn gradient(bencher: Bencher<'_, '_>, subject: Subject) {
    let (surface, (x, y)) = (surface(subject), points());
    let [mut z, mut zx, mut zy] = [0; 3].map(|_| vec![0.0; COUNT]);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(black_box(&x), black_box(&y), out)
    });
}

#[divan::bench(args = SUBJECTS)]
fn series(bencher: Bencher<'_, '_>, subject: Subject) {
    let (surface, (x, y)) = (surface(subject), curves());
    let [mut z, mut zx, mut zy] = [0; 3].map(|_| vec![[0.0; 5]; COUNT]);
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.series(black_box(&x), black_box(&y), out)
    });
}

#[divan::bench(args = SUBJECTS)]
fn height_series(bencher: Bencher<'_, '_>, subject: Subject) {
    let (surface, (x, y)) = (surface(subject), curves());
    let mut z = vec![[0.0; 5]; COUNT];
    bencher
        .counter(ItemsCount::new(COUNT))
        .bench_local(|| surface.height_series(black_box(&x), black_box(&y), &mut z));
}
