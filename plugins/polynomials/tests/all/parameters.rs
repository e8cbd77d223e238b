//! Coefficients that a model does not have.

use turnpath_core::{ParamValue, Params, Strategy};
use turnpath_polynomials::{Chebyshev, ForbesQ2d, ForbesQbfs, Zernike};

use crate::common::{coefficients, on_unit_disc, refusal, zernike};

#[test]
fn numbers_outside_of_a_convention_are_refused() {
    let says =
        |indexing, number| refusal(Zernike::new(&zernike(indexing, None, &[([number], 1.0)])));
    assert_eq!(
        says("noll", 0),
        "parameter `coefficients`: the number 0 is not from 1 to 1891, the numbers of `noll`"
    );
    assert_eq!(
        says("fringe", 962),
        "parameter `coefficients`: the number 962 is not from 1 to 961, the numbers of `fringe`"
    );
    assert_eq!(
        says("osa", -1),
        "parameter `coefficients`: the number -1 is not from 0 to 1890, the numbers of `osa`"
    );
    assert!(Zernike::new(&zernike("osa", None, &[([0], 1.0)])).is_ok());
}

#[test]
fn degrees_and_orders_that_are_too_large_are_refused() {
    assert_eq!(
        refusal(ForbesQbfs::new(&on_unit_disc(&[([-1], 1.0)]))),
        "parameter `coefficients`: the degree -1 is not a whole number from 0 to 60"
    );
    assert_eq!(
        refusal(ForbesQ2d::new(&on_unit_disc(&[([0, 61], 1.0)]))),
        "parameter `coefficients`: the order m = 61 is not from -60 to 60"
    );
    let mut params = Params::new().with("normalization_x", 1.0);
    params.set("coefficients", coefficients(&[([0, 41], 1.0)]));
    assert_eq!(
        refusal(Chebyshev::new(&params)),
        "parameter `coefficients`: the degree in y 41 is not a whole number from 0 to 40"
    );
}

#[test]
fn a_sphere_without_finite_values_is_refused() {
    let mut params = on_unit_disc(&[([0], 1.0)]);
    params.set("radius", ParamValue::Number(1e-200));
    assert_eq!(
        refusal(ForbesQbfs::new(&params)),
        "parameter `radius`: the radius is too small: the formula has no finite values"
    );
}

/// No term at all is a flat, or the base alone.
#[test]
fn no_coefficients_are_a_flat() {
    let surface = Zernike::new(&zernike("noll", None, &[])).unwrap();
    assert_eq!(turnpath_core::Surface::sag(&surface, 0.3, 0.4), 0.0);
}
