//! Points of a part at which a strategy is asked.

use turnpath_core::{Part, Scalar};

use crate::place::OnPart;

/// The golden angle, rad: points at multiples of it repeat no direction.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// So many points over the ring between two radii, evenly by area, none at the ends.
pub fn points(inner: f64, outer: f64, count: usize) -> Vec<OnPart> {
    let place = |i: usize| {
        let share = (i as f64 + 0.5) / count as f64;
        let square = inner * inner + share * (outer * outer - inner * inner);
        let turns = GOLDEN_ANGLE * i as f64 / std::f64::consts::TAU;
        OnPart {
            theta: std::f64::consts::TAU * turns.fract(),
            rho: square.sqrt(),
        }
    };
    (0..count).map(place).collect()
}

/// So many points of a part.
pub fn points_of(part: &Part, count: usize) -> Vec<OnPart> {
    points(part.inner_radius, part.aperture_radius, count)
}

/// Points in x and y.
pub fn cartesian(points: &[OnPart]) -> (Vec<f64>, Vec<f64>) {
    let both = points.iter().map(|point| {
        let (sin, cos) = Scalar::sin_cos(point.theta);
        (point.rho * cos, point.rho * sin)
    });
    both.unzip()
}

/// Points as θ and ρ.
pub fn polar(points: &[OnPart]) -> (Vec<f64>, Vec<f64>) {
    points.iter().map(|point| (point.theta, point.rho)).unzip()
}
