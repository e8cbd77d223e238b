//! The axis is a point like any other where the formula has all derivatives there.

use turnpath_core::{Gradients, Series};

use crate::common::{points, surface};

fn gradient(z: &str, x: f64, y: f64) -> [f64; 3] {
    let (mut height, mut zx, mut zy) = ([f64::NAN], [f64::NAN], [f64::NAN]);
    let out = Gradients {
        z: &mut height,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface(z, &[]).gradient(&[x], &[y], out).unwrap();
    [height[0], zx[0], zy[0]]
}

/// The series of the height along a curve through a point.
fn series(z: &str, x: f64, y: f64) -> Series {
    let mut height = [[f64::NAN; 5]];
    let (x, y) = ([x, 0.5, -0.25, 0.125, 0.0], [y, 0.75, 0.5, 0.0, -0.125]);
    surface(z, &[])
        .height_series(&[x], &[y], &mut height)
        .unwrap();
    height[0]
}

/// Each pair is the same surface, in ρ and θ, and in x and y.
const PAIRS: [(&str, &str); 17] = [
    ("rho*cos(theta)", "x"),
    ("rho*sin(theta)", "y"),
    ("rho*cos(-theta) + rho*sin(-theta)", "x - y"),
    ("0.1/mm^2*rho^3*cos(3*theta)", "0.1/mm^2*(x^3 - 3*x*y^2)"),
    ("rho^4*cos(2*theta)/mm^3", "(x^2 + y^2)*(x^2 - y^2)/mm^3"),
    (
        "rho^2/mm*(1 + 0.3*cos(2*theta) - 0.1*sin(2*theta))",
        "(x^2 + y^2 + 0.3*(x^2 - y^2) - 0.2*x*y)/mm",
    ),
    (
        "rho^2*cos(2*(theta - 30*deg))/mm",
        "(0.5*(x^2 - y^2) + sqrt(3)*x*y)/mm",
    ),
    ("rho^4*cos(theta)^2*sin(theta)^2/mm^3", "x^2*y^2/mm^3"),
    ("0.01/mm*hypot(y, x)^2", "0.01/mm*(x^2 + y^2)"),
    (
        "0.01/mm*sqrt((x^2 + y^2)*(4*x^2 + 4*y^2))",
        "0.02/mm*(x^2 + y^2)",
    ),
    ("0.01/mm*(9*x^2 + 9*y^2)^0.5*rho", "0.03/mm*(x^2 + y^2)"),
    ("mm*(rho/(2*mm))^66", "mm*((x^2 + y^2)/(4*mm^2))^33"),
    ("mm*(rho/(2*mm))^2", "(x^2 + y^2)/(4*mm)"),
    ("mm*exp(-(rho/(3*mm))^2)", "mm*exp(-(x^2 + y^2)/(9*mm^2))"),
    (
        "mm*(rho/(2*mm))^3*cos(3*theta)",
        "0.125*(x^3 - 3*x*y^2)/mm^2",
    ),
    ("(rho*x)^2/mm^3", "(x^2 + y^2)*x^2/mm^3"),
    ("(rho*cos(theta))^3/mm^2", "x^3/mm^2"),
];

#[test]
fn waves_on_the_turn_are_polynomials() {
    for (polar, straight) in PAIRS {
        for (x, y) in points(2.0) {
            let (found, expected) = (gradient(polar, x, y), gradient(straight, x, y));
            for (a, b) in found.into_iter().zip(expected) {
                let off = (a - b).abs();
                assert!(
                    off <= 1e-13 * (1.0 + b.abs()),
                    "{polar} at {x}, {y}: {found:?} {expected:?}"
                );
            }
            let (found, expected) = (series(polar, x, y), series(straight, x, y));
            for (a, b) in found.into_iter().zip(expected) {
                let off = (a - b).abs();
                assert!(
                    off <= 1e-12 * (1.0 + b.abs()),
                    "{polar} at {x}, {y}: {found:?} {expected:?}"
                );
            }
        }
    }
}

/// What is left of ρ and θ: derivatives at the axis are 0, and no NaN comes of them.
#[test]
fn nothing_at_the_axis_is_nan() {
    for z in [
        "rho",
        "rho^3/mm^2",
        "rho*cos(3*theta)",
        "rho^2.5/mm^1.5",
        "(x^2 + y^2)^1.5/mm^2",
        "(rho/mm)^3.5*mm",
        "sqrt(rho^5/mm^3)",
        "hypot(x, y)",
        "sqrt(y^2 + x^2)",
        "mm*cos(theta)*rho/mm*sin(3*theta)",
    ] {
        assert_eq!(gradient(z, 0.0, 0.0), [0.0; 3], "{z}");
    }
    assert_eq!(gradient("0*x", 1.0, 1.0), [0.0; 3]);
}

/// cos kρ and cosh kρ are smooth: at the axis their second derivatives are ∓k².
#[test]
fn even_functions_of_rho_have_their_derivatives_at_the_axis() {
    for (z, sign) in [
        ("mm*cos(20*rho/mm)", -1.0),
        ("mm*cosh(-20*rho/mm)", 1.0),
        ("mm*cos(20*hypot(y, x)/mm)", -1.0),
    ] {
        let surface = surface(z, &[]);
        // Along (0.6 t, 0.8 t), ρ² is t².
        let (x, y) = ([0.0, 0.6, 0.0, 0.0, 0.0], [0.0, 0.8, 0.0, 0.0, 0.0]);
        let mut found = [[0.0; 5]];
        surface.height_series(&[x], &[y], &mut found).unwrap();
        let wanted = [1.0, 0.0, sign * 200.0, 0.0, 160_000.0 / 24.0];
        for (found, wanted) in found[0].iter().zip(wanted) {
            assert!(
                (found - wanted).abs() <= 1e-12 * wanted.abs(),
                "{z}: {found} {wanted}"
            );
        }
        // Beside the axis, near and far, it is the function itself.
        for rho in [1e-6, 0.03, 0.0499, 0.0501, 0.2] {
            let wanted = match sign < 0.0 {
                true => libm::cos(20.0 * rho),
                false => libm::cosh(20.0 * rho),
            };
            let [height, slope, _] = gradient(z, rho, 0.0);
            let of_slope = match sign < 0.0 {
                true => -20.0 * libm::sin(20.0 * rho),
                false => 20.0 * libm::sinh(20.0 * rho),
            };
            assert!(
                (height - wanted).abs() < 1e-14 * wanted.abs().max(1.0),
                "{z} {rho}"
            );
            assert!(
                (slope - of_slope).abs() < 1e-13 * of_slope.abs(),
                "{z} {rho}"
            );
        }
    }
    // A power of 64 and more is that of multiplications: negative bases have one too.
    assert_eq!(gradient("mm*(x/mm)^67", -1.0, 0.5), [-1.0, 67.0, 0.0]);
}
