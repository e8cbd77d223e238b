//! Surfaces against plain geometry, outside of their domain, and with wrong parameters.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::models::model;
use turnpath_core::{Gradients, ParamValue, Params, Strategy, StrategyError, Surface};
use turnpath_surfaces::{Conic, OffAxisParaboloid, SinusoidalArray, Toric, XyPolynomial};

/// Two units in the last place of the parent's coordinates, which reach 1 m. Turning the points of
/// the parent in double precision can leave this much.
const TURNED_MM: f64 = 2.3e-13;

#[test]
fn off_axis_paraboloid_is_the_parent_turned() {
    let (radius, distance) = (915.0, 915.0);
    let params = Params::new()
        .with("vertex_radius", radius)
        .with("off_axis_distance", distance);
    let segment = OffAxisParaboloid::new(&params).unwrap();
    let cos = 1.0 / (1.0 + (distance / radius) * (distance / radius)).sqrt();
    let sin = cos * distance / radius;
    for i in -10..=10 {
        for j in -10..=10 {
            let (along, across) = (7.5 * f64::from(i), 10.6 * f64::from(j));
            // From the middle of the segment: Z(x₀ + along) − Z(x₀) without cancellation.
            let up = (along * (2.0 * distance + along) + across * across) / (2.0 * radius);
            let (x, z) = (cos * along + sin * up, cos * up - sin * along);
            let ours = Surface::sag(&segment, x, across);
            assert!(
                (ours - z).abs() <= TURNED_MM,
                "at {x}, {across}: {ours} for {z}"
            );
        }
    }
}

#[test]
fn positive_radii_are_concave() {
    let conic = Conic::new(&Params::new().with("radius", 10.0).with("conic", 0.0)).unwrap();
    assert!(Surface::sag(&conic, 1.0, 0.0) > 0.0);
    let toric = Toric::new(
        &Params::new()
            .with("radius_rotation", 9.0)
            .with("radius_base", -5.0),
    );
    let toric = toric.unwrap();
    assert!(Surface::sag(&toric, 1.0, 0.0) > 0.0);
    assert!(Surface::sag(&toric, 0.0, 1.0) < 0.0);
    let convex = Params::new()
        .with("vertex_radius", -50.0)
        .with("off_axis_distance", 20.0);
    let convex = OffAxisParaboloid::new(&convex).unwrap();
    assert!(Surface::sag(&convex, 1.0, 0.0) < 0.0);
}

#[test]
fn outside_the_domain_height_and_slopes_are_not_numbers() {
    let conic = Params::new().with("radius", 2.0).with("conic", 0.0);
    assert_no_value::<Conic>(&conic, 2.0, 1.0);
    let toric = |rotation, base| {
        Params::new()
            .with("radius_rotation", rotation)
            .with("radius_base", base)
    };
    assert_no_value::<Toric>(&toric(5.0, 3.0), 0.0, 3.5);
    assert_no_value::<Toric>(&toric(5.0, 3.0), 5.5, 0.0);
    // Here the base arc has passed the axis of rotation.
    assert_no_value::<Toric>(&toric(10.0, 100.0), 0.0, 60.0);
    let params = Params::new()
        .with("vertex_radius", 10.0)
        .with("off_axis_distance", 10.0);
    assert_no_value::<OffAxisParaboloid>(&params, -12.0, 40.0);
}

fn assert_no_value<T: Strategy>(params: &Params, x: f64, y: f64) {
    let (mut z, mut zx, mut zy) = ([0.0], [0.0], [0.0]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    let surface = model::<T>(params);
    surface.gradient(&[x], &[y], out).unwrap();
    assert!(
        z[0].is_nan() && zx[0].is_nan() && zy[0].is_nan(),
        "{z:?} {zx:?} {zy:?}"
    );
}

fn polynomial(terms: &[[f64; 3]]) -> Result<XyPolynomial, StrategyError> {
    let mut params = Params::new();
    let rows = terms.iter().map(|term| term.to_vec()).collect();
    params.set("terms", ParamValue::Rows(rows));
    XyPolynomial::new(&params)
}

#[test]
fn polynomial_is_the_sum_of_its_terms() {
    let surface = polynomial(&[[0.0, 0.0, 1.0], [2.0, 1.0, 0.5], [0.0, 3.0, -0.25]]).unwrap();
    assert_eq!(Surface::sag(&surface, 3.0, 2.0), 1.0 + 9.0 - 2.0);
    let constant = polynomial(&[[0.0, 0.0, 0.125]]).unwrap();
    assert_eq!(Surface::sag(&constant, 3.0, 2.0), 0.125);
}

#[test]
fn errors_name_the_wrong_terms() {
    let says = |terms: &[[f64; 3]]| polynomial(terms).unwrap_err().to_string();
    assert_eq!(
        says(&[[1.5, 0.0, 1.0]]),
        "parameter `terms`: term 1: the power 1.5 is not a whole number from 0 to 40"
    );
    assert_eq!(
        says(&[[0.0, 0.0, 1.0], [0.0, -2.0, 1.0]]),
        "parameter `terms`: term 2: the power -2 is not a whole number from 0 to 40"
    );
    assert_eq!(
        says(&[[2.0, 1.0, 1.0], [2.0, 1.0, 3.0]]),
        "parameter `terms`: x^2·y^1 stands in two terms"
    );
    assert_eq!(
        says(&[]),
        "parameter `terms`: no term is given; a flat is [[0, 0, 0]]"
    );
}

#[test]
fn a_product_has_one_amplitude() {
    let params = |amplitude_y: Option<f64>| {
        let mut params = Params::new()
            .with("amplitude_x", 0.05)
            .with("frequency_x", 1.0);
        params.set("form", ParamValue::Text("product".to_owned()));
        amplitude_y.map_or(params.clone(), |value| params.with("amplitude_y", value))
    };
    assert!(SinusoidalArray::new(&params(None)).is_ok());
    assert!(SinusoidalArray::new(&params(Some(0.05))).is_ok());
    let error = SinusoidalArray::new(&params(Some(0.06))).unwrap_err();
    assert!(matches!(error, StrategyError::Parameter { name, .. } if name == "amplitude_y"));
}
