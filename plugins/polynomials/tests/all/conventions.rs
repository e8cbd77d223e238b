//! Where lists of coefficients are misread: numbers, normalisations, the constant term, sine terms.

use std::f64::consts::{PI, TAU};

use turnpath_core::{Dual, ParamValue, Params, Scalar, Strategy, Surface};
use turnpath_polynomials::{Chebyshev, ForbesQ2d, ForbesQbfs, ForbesQcon, Zernike};

use crate::common::{coefficients, height, on_unit_disc, zernike};

fn close(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-13, "{value} for {expected}");
}

/// The same list means another surface in each convention. The closed forms are those of the lists
/// that the conventions print.
#[test]
fn one_list_is_three_surfaces_in_three_conventions() {
    let (rho, theta) = (0.7, 0.4);
    let at = |indexing: &str, number: i32| {
        let params = zernike(indexing, None, &[([number], 1.0)]);
        height(&Zernike::new(&params).unwrap(), rho, theta)
    };
    let (sin, cos) = Scalar::sin_cos(theta);
    let (sin_2, cos_2) = Scalar::sin_cos(2.0 * theta);
    let coma = 3.0 * rho * rho * rho - 2.0 * rho;
    let root = f64::sqrt;
    // Tilts: cosine first, but for OSA/ANSI.
    close(at("noll", 2), 2.0 * rho * cos);
    close(at("fringe", 2), rho * cos);
    close(at("osa", 2), 2.0 * rho * cos);
    close(at("osa", 1), 2.0 * rho * sin);
    // Astigmatism.
    close(at("noll", 5), root(6.0) * rho * rho * sin_2);
    close(at("fringe", 5), rho * rho * cos_2);
    close(at("osa", 5), root(6.0) * rho * rho * cos_2);
    // Coma.
    close(at("noll", 7), root(8.0) * coma * sin);
    close(at("fringe", 7), coma * cos);
    close(at("osa", 7), root(8.0) * coma * sin);
    // Spherical aberration stands under three numbers.
    let square = rho * rho;
    let spherical = 6.0 * square * square - 6.0 * square + 1.0;
    close(at("noll", 11), root(5.0) * spherical);
    close(at("fringe", 9), spherical);
    close(at("osa", 12), root(5.0) * spherical);
}

/// The mean square over the disc, by a rule that is exact for these degrees.
fn mean_square(surface: &impl Surface) -> f64 {
    let (rings, angles) = (4000, 64);
    let mut sum = 0.0;
    for ring in 0..rings {
        let square = (f64::from(ring) + 0.5) / f64::from(rings);
        for k in 0..angles {
            let z = height(
                surface,
                square.sqrt(),
                TAU * f64::from(k) / f64::from(angles),
            );
            sum += z * z;
        }
    }
    sum / f64::from(rings * angles)
}

#[test]
fn a_coefficient_is_the_rms_of_its_term_or_its_height_at_the_rim() {
    for (indexing, number) in [("noll", 11), ("noll", 14), ("osa", 8), ("fringe", 6)] {
        let made = |normalization| {
            let params = zernike(indexing, Some(normalization), &[([number], 0.5)]);
            Zernike::new(&params).unwrap()
        };
        assert!(
            (mean_square(&made("rms")) - 0.25).abs() < 1e-6,
            "{indexing} {number}"
        );
        let around = (0..720).map(|k| height(&made("peak"), 1.0, PI * f64::from(k) / 360.0));
        let highest = around.fold(f64::NEG_INFINITY, f64::max);
        assert!(
            (highest - 0.5).abs() < 1e-4,
            "{indexing} {number}: {highest}"
        );
    }
}

/// The mean square of the gradient over angle and radius, with the weight 1/sqrt(1 − u²) of Forbes:
/// radii u = |cos| of evenly spaced angles make the rule exact.
fn mean_square_gradient(surface: &impl Surface) -> f64 {
    let count = 128;
    let mut sum = 0.0;
    for i in 0..count {
        let u = Scalar::cos(PI * (f64::from(i) + 0.5) / f64::from(count)).abs();
        for k in 0..count {
            let (sin, cos) = Scalar::sin_cos(TAU * f64::from(k) / f64::from(count));
            let z = surface.sag(Dual::variable_x(u * cos), Dual::variable_y(u * sin));
            sum += z.dx * z.dx + z.dy * z.dy;
        }
    }
    sum / f64::from(count * count)
}

/// On a flat base, the mean square gradient is the sum of the squares of the coefficients.
#[test]
fn slope_orthogonal_polynomials_have_unit_mean_square_slope() {
    let params = on_unit_disc(&[([0], 0.3), ([3], -0.4), ([8], 0.2)]);
    let found = mean_square_gradient(&ForbesQbfs::new(&params).unwrap());
    close(found, 0.09 + 0.16 + 0.04);
    let terms = [
        ([0, 1], 0.3),
        ([4, 1], 0.1),
        ([2, -1], -0.2),
        ([5, 3], 0.4),
        ([3, -6], 0.5),
        ([2, 0], 0.6),
    ];
    let found = mean_square_gradient(&ForbesQ2d::new(&on_unit_disc(&terms)).unwrap());
    close(found, terms.iter().map(|(_, a)| a * a).sum());
}

#[test]
fn strong_polynomials_are_one_at_the_normalisation_radius() {
    for n in [0, 1, 5, 20] {
        let mut params = on_unit_disc(&[([n], 0.25)]);
        params.set("conic", ParamValue::Number(0.0));
        close(height(&ForbesQcon::new(&params).unwrap(), 1.0, 0.3), 0.25);
    }
}

/// A negative order is the sine; the order of the angle stands second.
#[test]
fn the_order_of_a_freeform_stands_second_and_is_negative_for_sines() {
    let at = |numbers, theta| {
        let params = on_unit_disc(&[(numbers, 1.0)]);
        height(&ForbesQ2d::new(&params).unwrap(), 0.5, theta)
    };
    // Q_0^2 = 1/sqrt 2: u² cos 2θ has the mean square gradient 4<u²> = 2.
    let front = 0.25 / f64::sqrt(2.0);
    close(at([0, 2], 0.3), front * Scalar::cos(0.6));
    close(at([0, -2], 0.3), front * Scalar::sin(0.6));
    // Q_2 of m = 0 has no angle.
    close(at([2, 0], 0.3), at([2, 0], 1.7));
}

#[test]
fn the_constant_term_of_chebyshev_counts() {
    let made = |terms: &[([i32; 2], f64)]| {
        let mut params = Params::new().with("normalization_x", 2.0);
        params.set("coefficients", coefficients(terms));
        Chebyshev::new(&params).unwrap()
    };
    let with = made(&[([0, 0], 0.25), ([2, 1], 1.0)]);
    let without = made(&[([2, 1], 1.0)]);
    close(with.sag(0.3, 0.8) - without.sag(0.3, 0.8), 0.25);
    // T_2(u) T_1(v) = (2u² − 1) v
    close(without.sag(0.3, 0.8), (2.0 * 0.15 * 0.15 - 1.0) * 0.4);
}
