//! The conicoid of revolution, which many surfaces have as their base.

use crate::kind::{Length, Number};
use crate::{Param, Params, Result, Scalar};

/// The largest amount of (1 + K)c², 1/mm²: with the fourth powers in a series, and with the places of
/// the largest part, all figures stay far from the end of the numbers.
const MOST_BEND: f64 = 1e40;

/// z = cρ² / (1 + sqrt(1 − (1 + K)c²ρ²)), c the curvature at the vertex, K the conic number.
///
/// K = 0 is a sphere, −1 a paraboloid. Where the conicoid has no point, z is NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conicoid {
    /// c, 1/mm.
    pub curvature: f64,
    /// (1 + K)c², 1/mm².
    pub bend: f64,
}

impl Conicoid {
    /// The parameter of a base that may be a flat: the radius at the vertex.
    pub const RADIUS: Param<Option<Length>> = Param::length(
        "radius",
        "radius of curvature at the vertex; positive: concave; left out: flat",
    )
    .nonzero()
    .optional();

    /// The largest amount of a conic number. Those of designs stay far below it, and the derivatives
    /// of the formula stay numbers.
    pub const MOST_CONIC: f64 = 1e9;

    /// The parameter of every conicoid: the conic number K.
    pub const CONIC: Param<Number> =
        Self::conic_number("conic", "conic number K; 0: sphere, -1: paraboloid");

    /// A parameter that is a conic number.
    pub const fn conic_number(name: &'static str, help: &'static str) -> Param<Number> {
        Param::number(name, help)
            .default(0.0)
            .min(-Self::MOST_CONIC)
            .max(Self::MOST_CONIC)
    }

    /// Why a radius is refused that is too small for the formula.
    pub const TOO_SMALL: &str =
        "the radius is too small for this conic number: the formula has no finite values";

    /// The conicoid of the parameters [`RADIUS`](Self::RADIUS) and [`CONIC`](Self::CONIC).
    ///
    /// # Errors
    /// If the radius is too small for the formula.
    pub fn of(params: &Params) -> Result<Self> {
        Self::new(params.get(Self::RADIUS), params.get(Self::CONIC))
            .ok_or_else(|| Self::RADIUS.refused(Self::TOO_SMALL))
    }

    /// The conicoid of this radius at the vertex, mm, and this conic number. Without a radius it is a
    /// flat. `None` if the formula has no finite values, because the radius is too small.
    pub fn new(radius: Option<f64>, conic: f64) -> Option<Self> {
        let curvature = radius.map_or(0.0, f64::recip);
        let bend = (1.0 + conic) * curvature * curvature;
        (bend.abs() <= MOST_BEND).then_some(Self { curvature, bend })
    }

    /// The height at a squared distance ρ² from the axis, mm².
    #[inline(always)]
    pub fn sag<S: Scalar>(&self, square: S) -> S {
        square * self.curvature / (self.root(square) + 1.0)
    }

    /// sqrt(1 − (1 + K)c²ρ²); of a sphere the cosine of the slope's angle.
    #[inline(always)]
    pub fn root<S: Scalar>(&self, square: S) -> S {
        (-(square * self.bend) + 1.0).sqrt()
    }

    /// Whether the conicoid has a point and a slope at the squared distance ρ² from the axis, mm².
    pub fn reaches(&self, square: f64) -> bool {
        square * self.bend < 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_a_paraboloid_and_a_flat_are_their_closed_forms() {
        let close = |radius, conic, square: f64, expected: f64| {
            let conicoid = Conicoid::new(radius, conic);
            let off = conicoid.map(|conicoid| (conicoid.sag(square) - expected).abs());
            assert!(off.is_some_and(|off| off < 1e-15), "{radius:?} {conic}");
        };
        close(Some(5.0), 0.0, 9.0, 1.0);
        close(Some(-5.0), 0.0, 16.0, -2.0);
        close(Some(4.0), -1.0, 16.0, 2.0);
        close(None, -0.5, 16.0, 0.0);
        let sphere = Conicoid::new(Some(5.0), 0.0);
        assert!(sphere.is_some_and(|sphere| sphere.sag(25.1f64).is_nan()));
        assert_eq!(Conicoid::new(Some(1e-200), 0.0), None);
    }

    #[test]
    fn a_conicoid_reaches_to_its_equator() {
        let sphere = Conicoid::new(Some(5.0), 0.0);
        assert!(sphere.is_some_and(|one| one.reaches(24.9) && !one.reaches(25.0)));
        let hyperboloid = Conicoid::new(Some(5.0), -2.0);
        assert!(hyperboloid.is_some_and(|one| one.reaches(1e9)));
    }
}
