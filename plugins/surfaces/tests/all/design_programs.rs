//! The surfaces of design programs where they are misread: axes, powers, seams, and their ends.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::models::model;
use turnpath_core::{
    GradientSeries, Gradients, ParamValue, Params, Strategy, StrategyError, Surface, SurfaceModel,
};
use turnpath_surfaces::{
    Biconic, Conic, EvenAsphere, LensletArray, OddAsphere, OffAxisConic, OffAxisParaboloid, Toric,
    ToroidYz, XyPolynomial,
};

fn with_coefficients(mut params: Params, rows: &[&[f64]]) -> Params {
    let rows = rows.iter().map(|row| row.to_vec()).collect();
    params.set("coefficients", ParamValue::Rows(rows));
    params
}

fn refusal<T: std::fmt::Debug>(made: Result<T, StrategyError>) -> String {
    made.unwrap_err().to_string()
}

fn has_value(surface: &dyn SurfaceModel, x: f64, y: f64) -> bool {
    let (mut z, mut zx, mut zy) = ([0.0], [0.0], [0.0]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&[x], &[y], out).unwrap();
    let all = [z[0], zx[0], zy[0]].map(f64::is_finite);
    assert!(all.iter().all(|one| *one == all[0]), "{z:?} {zx:?} {zy:?}");
    all[0]
}

/// The axis of rotation is parallel to y: the radius of rotation is the one along x.
#[test]
fn a_toroid_has_its_radius_of_rotation_along_x() {
    let params = Params::new()
        .with("radius_rotation", 20.0)
        .with("radius", 80.0)
        .with("conic", 0.0);
    let toroid = ToroidYz::new(&params).unwrap();
    let circle = |radius: f64| radius - (radius * radius - 9.0).sqrt();
    assert!((Surface::sag(&toroid, 3.0, 0.0) - circle(20.0)).abs() < 1e-14);
    assert!((Surface::sag(&toroid, 0.0, 3.0) - circle(80.0)).abs() < 1e-14);
    let params = Params::new()
        .with("radius_rotation", 20.0)
        .with("radius_base", 80.0);
    let toric = Toric::new(&params).unwrap();
    for (x, y) in [(1.0, 2.0), (-5.0, 3.0), (4.0, -7.0)] {
        let (one, other) = (Surface::sag(&toroid, x, y), Surface::sag(&toric, x, y));
        assert!((one - other).abs() < 1e-14);
    }
}

#[test]
fn without_a_radius_of_rotation_a_toroid_is_a_cylinder() {
    let params = Params::new().with("radius", 20.0).with("conic", 0.0);
    let cylinder = ToroidYz::new(&params).unwrap();
    assert_eq!(
        Surface::sag(&cylinder, 5.0, 3.0),
        Surface::sag(&cylinder, 0.0, 3.0)
    );
}

#[test]
fn a_segment_of_a_paraboloid_is_the_off_axis_paraboloid() {
    let params = Params::new()
        .with("vertex_radius", -120.0)
        .with("off_axis_distance", 45.0);
    let paraboloid = OffAxisParaboloid::new(&params).unwrap();
    let conic = OffAxisConic::new(&params.with("conic", -1.0)).unwrap();
    for (x, y) in [(0.0, 0.0), (9.0, -4.0), (-12.0, 15.0)] {
        let (one, other) = (Surface::sag(&conic, x, y), Surface::sag(&paraboloid, x, y));
        assert!((one - other).abs() < 1e-14);
    }
}

/// Wherever a segment of a sphere lies, it is the same sphere.
#[test]
fn a_segment_of_a_sphere_is_a_sphere() {
    let sphere = Conic::new(&Params::new().with("radius", 50.0).with("conic", 0.0)).unwrap();
    let params = Params::new().with("vertex_radius", 50.0).with("conic", 0.0);
    let segment = OffAxisConic::new(&params.clone().with("off_axis_distance", 30.0)).unwrap();
    for (x, y) in [(10.0, 5.0), (-20.0, 8.0), (0.0, 30.0)] {
        let (one, other) = (Surface::sag(&segment, x, y), Surface::sag(&sphere, x, y));
        assert!((one - other).abs() < 1e-13);
    }
    assert_eq!(
        refusal(OffAxisConic::new(&params.with("off_axis_distance", 50.0))),
        "parameter `off_axis_distance`: the parent has no point so far from its axis"
    );
}

/// A power stands under its own number; Zemax counts the even ones.
#[test]
fn aspheric_terms_stand_under_their_powers() {
    let flat = Params::new().with("conic", 0.0);
    let even = with_coefficients(flat.clone(), &[&[4.0, 0.5], &[2.0, -1.0]]);
    let even = EvenAsphere::new(&even).unwrap();
    assert_eq!(Surface::sag(&even, 0.0, 2.0), 0.5 * 16.0 - 4.0);
    let odd = with_coefficients(flat.clone(), &[&[3.0, 0.5], &[1.0, 2.0], &[4.0, 1.0]]);
    let odd = OddAsphere::new(&odd).unwrap();
    assert_eq!(Surface::sag(&odd, 0.0, -2.0), 0.5 * 8.0 + 4.0 + 16.0);
    let wrong = |power: f64| with_coefficients(flat.clone(), &[&[power, 1.0]]);
    assert_eq!(
        refusal(EvenAsphere::new(&wrong(3.0))),
        "parameter `coefficients`: the power 3 is not an even whole number from 2 to 40"
    );
    assert_eq!(
        refusal(OddAsphere::new(&wrong(0.0))),
        "parameter `coefficients`: the power 0 is not a whole number from 1 to 40"
    );
}

/// At the axis the odd terms have the mean of the derivatives on both sides, none. A billionth of a
/// nanometre beside it they have their own, and all are finite.
#[test]
fn an_odd_asphere_has_finite_series_at_its_axis() {
    let params = Params::new().with("radius", 10.0).with("conic", 0.0);
    let params = with_coefficients(params, &[&[1.0, 0.1], &[3.0, 0.5]]);
    let odd = model::<OddAsphere>(&params);
    for start in [0.0, 1e-300, 1e-24, 1e-15] {
        let (x, y) = ([[start, 5.0, 1.0, -2.0, 3.0]], [[0.0, 3.0, -1.0, 2.0, 1.0]]);
        let (mut z, mut zx, mut zy) = ([[f64::NAN; 5]], [[f64::NAN; 5]], [[f64::NAN; 5]]);
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        odd.series(&x, &y, out).unwrap();
        let all = [z, zx, zy];
        assert!(
            all.iter().flatten().flatten().all(|c| c.is_finite()),
            "{start}: {all:?}"
        );
    }
    let sphere = model::<Conic>(&Params::new().with("radius", 10.0).with("conic", 0.0));
    let of = |surface: &dyn SurfaceModel| {
        let mut z = [[0.0; 5]];
        let (x, y) = ([[0.0, 1.0, 0.0, 0.0, 0.0]], [[0.0; 5]]);
        surface.height_series(&x, &y, &mut z).unwrap();
        z[0]
    };
    assert_eq!(of(&*odd), of(&*sphere));
}

#[test]
fn beyond_a_base_there_is_no_height_and_beyond_an_aperture_the_formula_goes_on() {
    let base = Params::new().with("radius", 5.0).with("conic", 0.0);
    let terms = with_coefficients(base, &[&[4.0, 1e-3]]);
    let even = model::<EvenAsphere>(&terms);
    let odd = model::<OddAsphere>(&terms);
    assert!(has_value(&*even, 3.0, 3.9) && !has_value(&*even, 3.1, 4.0));
    assert!(has_value(&*odd, 3.0, 3.9) && !has_value(&*odd, 3.1, 4.0));
    let params = Params::new()
        .with("radius_x", 5.0)
        .with("radius_y", 9.0)
        .with("conic_x", 0.0)
        .with("conic_y", 0.0);
    let biconic = model::<Biconic>(&params);
    assert!(has_value(&*biconic, 4.9, 0.5) && has_value(&*biconic, 0.5, 8.9));
    assert!(!has_value(&*biconic, 5.1, 0.0) && !has_value(&*biconic, 4.0, 6.0));
    let params = Params::new()
        .with("radius_rotation", 6.0)
        .with("radius", 4.0)
        .with("conic", 0.0);
    let toroid = model::<ToroidYz>(&params);
    assert!(has_value(&*toroid, 5.9, 0.0) && !has_value(&*toroid, 6.1, 0.0));
    assert!(has_value(&*toroid, 0.0, 3.9) && !has_value(&*toroid, 0.0, 4.1));
    // A curve that has reached the axis of rotation.
    let params = Params::new()
        .with("radius_rotation", 2.0)
        .with("conic", 0.0);
    let steep = model::<ToroidYz>(&with_coefficients(params, &[&[2.0, 1.0]]));
    assert!(has_value(&*steep, 0.0, 1.4) && !has_value(&*steep, 0.0, 1.5));
    // Far to one side the normal of the segment meets the other sheet of its hyperboloid alone; where
    // the segment lies flatter, it meets both.
    let hyperboloid = |conic| {
        let params = Params::new()
            .with("vertex_radius", 10.0)
            .with("conic", conic)
            .with("off_axis_distance", 20.0);
        model::<OffAxisConic>(&params)
    };
    assert!(
        has_value(&*hyperboloid(-1.2), 20.0, 5.0) && !has_value(&*hyperboloid(-1.2), -500.0, 0.0)
    );
    assert!(
        has_value(&*hyperboloid(-4.0), 20.0, 5.0) && has_value(&*hyperboloid(-4.0), -500.0, 0.0)
    );
}

fn lenses(layout: &str, radius: f64) -> Result<LensletArray, StrategyError> {
    LensletArray::new(&lattice(layout, radius))
}

fn lattice(layout: &str, radius: f64) -> Params {
    let mut params = Params::new()
        .with("pitch", 1.0)
        .with("radius", radius)
        .with("conic", 0.0);
    params.set("layout", ParamValue::Text(layout.to_owned()));
    params
}

/// The array has its lenses where its lattice points are, near and far.
#[test]
fn lenses_have_their_vertices_at_the_points_of_the_lattice() {
    let square = lenses("square", 3.0).unwrap();
    let hexagonal = lenses("hexagonal", 3.0).unwrap();
    let row = 3.0f64.sqrt() / 2.0;
    for (i, j) in [
        (0.0, 0.0),
        (1.0, 0.0),
        (0.0, -1.0),
        (-7.0, 5.0),
        (300.0, 200.0),
    ] {
        assert!(Surface::sag(&square, i, j).abs() < 1e-25);
        assert!(Surface::sag(&hexagonal, i + 0.5 * j, row * j).abs() < 1e-25);
    }
    let sphere = |distance: f64| 3.0 - (9.0 - distance * distance).sqrt();
    // The corners of the cells, where they meet.
    let corner = Surface::sag(&square, 0.5, 0.5);
    assert!((corner - sphere(0.5f64.sqrt())).abs() < 1e-14);
    let corner = Surface::sag(&hexagonal, 0.5, 0.5 / 3.0f64.sqrt());
    assert!((corner - sphere(1.0 / 3.0f64.sqrt())).abs() < 1e-14);
}

/// On both sides of a seam the height is the same, and the slope is turned round.
#[test]
fn heights_go_through_a_seam_and_slopes_jump_there() {
    for layout in ["square", "hexagonal"] {
        let surface = model::<LensletArray>(&lattice(layout, -3.0));
        let near = 1e-9;
        let (x, y) = ([0.5 - near, 0.5 + near], [0.05; 2]);
        let (mut z, mut zx, mut zy) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(&x, &y, out).unwrap();
        assert!((z[0] - z[1]).abs() < 1e-15);
        assert!((zx[0] + zx[1]).abs() < 1e-8 && zx[0] < -0.1);
    }
}

#[test]
fn lenses_that_do_not_reach_the_corners_of_their_cells_are_refused() {
    for (layout, corner) in [
        ("square", 0.5f64.sqrt()),
        ("hexagonal", 1.0 / 3.0f64.sqrt()),
    ] {
        assert!(lenses(layout, corner + 1e-6).is_ok());
        assert_eq!(
            refusal(lenses(layout, corner - 1e-6)),
            "parameter `pitch`: the lenses do not reach the corners of their cells"
        );
    }
}

#[test]
fn a_polynomial_has_terms_in_mm_or_normalised_coefficients() {
    let normalised = |radius: Option<f64>| {
        let mut params = with_coefficients(Params::new(), &[&[2.0, 1.0, 0.5], &[0.0, 0.0, 0.25]]);
        if let Some(radius) = radius {
            params = params.with("normalization_radius", radius);
        }
        params
    };
    let surface = XyPolynomial::new(&normalised(Some(4.0))).unwrap();
    assert_eq!(Surface::sag(&surface, 2.0, 4.0), 0.5 * 0.25 + 0.25);
    assert_eq!(
        refusal(XyPolynomial::new(&normalised(None))),
        "parameter `coefficients`: coefficients need a `normalization_radius`"
    );
    let terms = ParamValue::Rows(vec![vec![2.0, 0.0, 1.0]]);
    let mut both = normalised(Some(4.0));
    both.set("terms", terms.clone());
    assert_eq!(
        refusal(XyPolynomial::new(&both)),
        "parameter `coefficients`: give `terms` or `coefficients`, not both"
    );
    let mut scaled = Params::new().with("normalization_radius", 4.0);
    scaled.set("terms", terms);
    assert_eq!(
        refusal(XyPolynomial::new(&scaled)),
        "parameter `normalization_radius`: `terms` are in mm and know no normalisation; write \
         them as `coefficients`"
    );
    assert!(XyPolynomial::new(&Params::new()).is_err());
}
