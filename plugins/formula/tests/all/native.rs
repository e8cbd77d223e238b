//! Formulas that say what a native model says have its heights, slopes and series.

use turnpath_core::{GradientSeries, ParamValue, Params, Series, Strategy, SurfaceModel};
use turnpath_surfaces::{Astigmatic, Conic, OddAsphere, SinusoidalArray, Toric};

use crate::common::{points, surface};
use crate::models::model;

/// Largest difference of a height, mm.
const HEIGHT: f64 = 1e-12;
/// Largest difference of a coefficient, beside the largest of its series.
const RELATIVE: f64 = 1e-11;

fn height(surface: &dyn SurfaceModel, x: f64, y: f64) -> f64 {
    let mut z = [f64::NAN];
    surface.heights(&[x], &[y], &mut z).unwrap();
    z[0]
}

fn series(surface: &dyn SurfaceModel, x: Series, y: Series) -> [Series; 3] {
    let (mut z, mut zx, mut zy) = ([[0.0; 5]], [[0.0; 5]], [[0.0; 5]]);
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(&[x], &[y], out).unwrap();
    [z[0], zx[0], zy[0]]
}

fn same(formula: &dyn SurfaceModel, native: &dyn SurfaceModel, radius: f64) {
    for (x, y) in points(radius) {
        let (found, expected) = (height(formula, x, y), height(native, x, y));
        assert!((found - expected).abs() <= HEIGHT, "{found} {expected}");
        let (along_x, along_y) = ([x, 0.3, -0.2, 0.1, 0.05], [y, -0.4, 0.1, 0.05, -0.1]);
        let found = series(formula, along_x, along_y);
        let expected = series(native, along_x, along_y);
        for (found, expected) in found.iter().zip(&expected) {
            let most = expected.iter().fold(1e-3f64, |most, c| most.max(c.abs()));
            for (a, b) in found.iter().zip(expected) {
                let off = (a - b).abs();
                assert!(off <= RELATIVE * most, "{x} {y}: {found:?} {expected:?}");
            }
        }
    }
}

#[test]
fn conic() {
    let native = Params::new().with("radius", 40.0).with("conic", -0.7);
    let text = "c*rho^2 / (1 + sqrt(1 - (1 + K)*c^2*rho^2))";
    let formula = surface(text, &[("c", 1.0 / 40.0, -1), ("K", -0.7, 0)]);
    same(&*formula, &*model::<Conic>(&native), 12.0);
}

#[test]
fn waves() {
    let native = |form: &str| {
        let mut params = Params::new()
            .with("amplitude_x", 5e-3)
            .with("frequency_x", 0.4);
        params.set("form", ParamValue::Text(form.to_owned()));
        model::<SinusoidalArray>(&params)
    };
    let constants = [("A", 5e-3, 1), ("f", 0.4, -1)];
    let sum = surface("A*cos(2*pi*f*x) + A*cos(2*pi*f*y)", &constants);
    same(&*sum, &*native("sum"), 6.0);
    let product = surface("A*sin(2*pi*f*x)*sin(2*pi*f*y)", &constants);
    same(&*product, &*native("product"), 6.0);
}

#[test]
fn toric() {
    let native = Params::new()
        .with("radius_rotation", 50.0)
        .with("radius_base", 32.0);
    let formula = surface(
        "R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2)",
        &[("R", 50.0, 1), ("a", 32.0, 1)],
    );
    same(&*formula, &*model::<Toric>(&native), 8.0);
}

/// ρ² sin 2θ has all derivatives at the axis.
#[test]
fn astigmatic() {
    let info = Astigmatic::PARAMS.first().unwrap();
    let native = Params::new().with(info.name, 0.003);
    let formula = surface("k*rho^2*sin(2*theta)", &[("k", 0.003, -1)]);
    same(&*formula, &*model::<Astigmatic>(&native), 10.0);
}

/// Odd powers of ρ: at the axis, too, they are those of the native model.
#[test]
fn odd_asphere() {
    let mut native = Params::new().with("radius", 40.0).with("conic", -1.0);
    let terms = vec![vec![1.0, 2e-3], vec![3.0, 1e-5], vec![4.0, -3e-6]];
    native.set("coefficients", ParamValue::Rows(terms));
    let formula = surface(
        "r^2/(2*R) + a*r + b*r^3 + c*r^4",
        &[
            ("R", 40.0, 1),
            ("a", 2e-3, 0),
            ("b", 1e-5, -2),
            ("c", -3e-6, -3),
        ],
    );
    same(&*formula, &*model::<OddAsphere>(&native), 9.0);
}
