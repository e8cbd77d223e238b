//! Beyond the normalisation radius, and beyond the sphere from which a surface departs.

use crate::models::model;
use turnpath_core::{Gradients, ParamValue, Params, Strategy, Surface, SurfaceModel};
use turnpath_polynomials::{Chebyshev, ForbesQ2d, ForbesQbfs, ForbesQcon, Zernike};

use crate::common::{coefficients, height, on_unit_disc, zernike};

fn assert_has_value(surface: &dyn SurfaceModel, x: f64, y: f64, has: bool) {
    let (mut z, mut zx, mut zy) = ([0.0], [0.0], [0.0]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&[x], &[y], out).unwrap();
    for number in [z[0], zx[0], zy[0]] {
        assert_eq!(number.is_finite(), has, "{z:?} {zx:?} {zy:?} at {x}, {y}");
    }
}

/// R_4^0 = 6ρ⁴ − 6ρ² + 1 at ρ = 1.5, and T_4 = 8u⁴ − 8u² + 1 at u = 1.5.
#[test]
fn polynomials_go_on_as_polynomials() {
    let surface = Zernike::new(&zernike("fringe", None, &[([9], 1.0)])).unwrap();
    let square = 1.5f64 * 1.5;
    let expected = 6.0 * square * square - 6.0 * square + 1.0;
    assert!((height(&surface, 1.5, 0.8) - expected).abs() < 1e-12);
    let mut params = Params::new().with("normalization_x", 1.0);
    params.set("coefficients", coefficients(&[([4, 0], 1.0)]));
    let expected = 8.0 * square * square - 8.0 * square + 1.0;
    let surface = Chebyshev::new(&params).unwrap();
    assert!((surface.sag(1.5, 0.3) - expected).abs() < 1e-12);
}

#[test]
fn high_degrees_far_beyond_the_normalisation_radius_are_finite() {
    let far = model::<Zernike>(&zernike("noll", None, &[([1891], 1e-3)]));
    assert_has_value(&*far, 3.0, -2.0, true);
    let mut params = Params::new().with("normalization_x", 1.0);
    params.set("coefficients", coefficients(&[([40, 40], 1e-3)]));
    assert_has_value(&*model::<Chebyshev>(&params), 3.0, -2.0, true);
    let qbfs = model::<ForbesQbfs>(&on_unit_disc(&[([60], 1e-3)]));
    assert_has_value(&*qbfs, 2.0, 1.0, true);
    let q2d = model::<ForbesQ2d>(&on_unit_disc(&[([60, 60], 1e-3), ([59, -1], 1e-3)]));
    assert_has_value(&*q2d, 2.0, 1.0, true);
    assert_has_value(&*q2d, 0.0, 0.0, true);
}

#[test]
fn beyond_the_sphere_there_is_no_height_and_no_slope() {
    let mut params = on_unit_disc(&[([1], 1e-3)]);
    params.set("radius", ParamValue::Number(2.0));
    params.set("conic", ParamValue::Number(0.0));
    for at in [1.5, 2.5] {
        let has = at < 2.0;
        assert_has_value(&*model::<ForbesQbfs>(&params), at, 0.1, has);
        assert_has_value(&*model::<ForbesQcon>(&params), at, 0.1, has);
    }
    let mut params = on_unit_disc(&[([1, 2], 1e-3)]);
    params.set("radius", ParamValue::Number(-2.0));
    assert_has_value(&*model::<ForbesQ2d>(&params), 0.1, 1.9, true);
    assert_has_value(&*model::<ForbesQ2d>(&params), 0.1, 2.1, false);
}
