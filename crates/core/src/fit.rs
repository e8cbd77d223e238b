//! The series of a tool centre by numerical fit, for compensators that give no exact series.
//!
//! The fit evaluates the centre at 9 points t = −4h … 4h along the curve. Central differences of
//! order 8 give c_1 … c_4 with an error of h⁶ to h⁸ times a 9th or 10th derivative. The rounding
//! error grows as h⁻⁴. The h that balances both depends on the surface. The fit therefore tries a
//! ladder of steps and takes, for every coefficient, the value where three neighbouring steps agree
//! best.

use crate::Series;

/// Points of the stencil.
pub const STENCIL: usize = 9;
/// Widest step of the ladder, as a part of the curve's own scale.
const WIDEST: f64 = 0.25;
/// Number of steps of the ladder. Each step is half of the step before.
pub const LADDER: usize = 7;

/// Weights of the values at −4h … 4h for the coefficients c_1 … c_4, without their powers of h: the
/// central differences of the highest order on 9 points, each divided by k!.
const WEIGHTS: [[f64; STENCIL]; 4] = [
    [
        1.0 / 280.0,
        -4.0 / 105.0,
        0.2,
        -0.8,
        0.0,
        0.8,
        -0.2,
        4.0 / 105.0,
        -1.0 / 280.0,
    ],
    [
        -1.0 / 1120.0,
        4.0 / 315.0,
        -0.1,
        0.8,
        -205.0 / 144.0,
        0.8,
        -0.1,
        4.0 / 315.0,
        -1.0 / 1120.0,
    ],
    [
        -7.0 / 1440.0,
        0.05,
        -169.0 / 720.0,
        61.0 / 180.0,
        0.0,
        -61.0 / 180.0,
        169.0 / 720.0,
        -0.05,
        7.0 / 1440.0,
    ],
    [
        7.0 / 5760.0,
        -1.0 / 60.0,
        169.0 / 1440.0,
        -61.0 / 180.0,
        91.0 / 192.0,
        -61.0 / 180.0,
        169.0 / 1440.0,
        -1.0 / 60.0,
        7.0 / 5760.0,
    ],
];

/// The steps of the ladder on a curve (θ(t), ρ(t)) for a nose of the given radius. The widest step
/// moves θ by a quarter of a radian or ρ by a quarter of the nose radius, whichever is reached
/// first.
pub fn steps(theta: &Series, rho: &Series, nose_radius: f64) -> [f64; LADDER] {
    let fastest = theta[1].abs().max(rho[1].abs() / nose_radius);
    let scale = if fastest > 0.0 { 1.0 / fastest } else { 1.0 };
    std::array::from_fn(|i| WIDEST * scale / 4.0 / (1u32 << i) as f64)
}

/// The value of a series at `t`.
pub fn evaluate(series: &Series, t: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// The series at the middle of the stencil, from the values on every step of the ladder.
pub fn fit(steps: &[f64; LADDER], values: &[[f64; STENCIL]; LADDER]) -> Series {
    let mut out = [values[0][STENCIL / 2], 0.0, 0.0, 0.0, 0.0];
    for (order, weights) in (1..).zip(&WEIGHTS) {
        let ladder: [f64; LADDER] =
            std::array::from_fn(|i| difference(weights, &values[i]) / power(steps[i], order));
        out[order as usize] = best_agreement(&ladder);
    }
    out
}

fn difference(weights: &[f64; STENCIL], values: &[f64; STENCIL]) -> f64 {
    weights.iter().zip(values).map(|(w, v)| w * v).sum()
}

fn power(base: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

/// The value on the ladder that differs least from both its neighbours. Two values alone may agree
/// by chance.
fn best_agreement(ladder: &[f64; LADDER]) -> f64 {
    let mut best = (f64::INFINITY, f64::NAN);
    for three in ladder.windows(3) {
        let gap = (three[0] - three[1]).abs().max((three[1] - three[2]).abs());
        if gap < best.0 {
            best = (gap, three[1]);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scalar;

    #[test]
    fn fitted_series_of_a_sine_are_those_of_the_closed_form() {
        let (middle, theta, rho) = (0.7f64, [0.7, 1.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0, 0.0]);
        let steps = steps(&theta, &rho, 1.0);
        let values = steps
            .map(|h| std::array::from_fn(|j| Scalar::sin(2.0 * (middle + (j as f64 - 4.0) * h))));
        let fitted = fit(&steps, &values);
        let (s, c) = Scalar::sin_cos(2.0 * middle);
        let exact = [s, 2.0 * c, -2.0 * s, -4.0 / 3.0 * c, 2.0 / 3.0 * s];
        for (order, allowed) in [(1, 1e-12), (2, 1e-11), (3, 1e-9), (4, 1e-8)] {
            assert!(
                (fitted[order] - exact[order]).abs() < allowed,
                "c_{order}: {fitted:?}"
            );
        }
    }
}
