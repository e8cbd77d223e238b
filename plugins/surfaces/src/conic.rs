//! The conicoid of revolution: sphere, ellipsoid, paraboloid, hyperboloid.

use turnpath_plugin::prelude::*;

/// z = cρ² / (1 + sqrt(1 − (1 + K)c²ρ²)), c = 1/radius, K the conic number.
///
/// K = 0 is a sphere, −1 a paraboloid. Where the conicoid has no point, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Conic {
    curvature: f64,
    /// (1 + K)c².
    bend: f64,
}

const RADIUS: Param<Length> = Param::length(
    "radius",
    "radius of curvature at the vertex; positive: concave",
)
.nonzero();
const CONIC: Param<Number> =
    Param::number("conic", "conic number K; 0: sphere, -1: paraboloid").default(0.0);

impl Strategy for Conic {
    const NAME: &'static str = "conic";
    const SUMMARY: &'static str = "a conicoid of revolution: sphere, ellipsoid, paraboloid, …";
    const SOURCE: &'static str = "ISO 10110-12, the conic section without aspheric terms";
    const PARAMS: &'static [ParamInfo] = &[RADIUS.info(), CONIC.info()];

    fn new(params: &Params) -> Result<Self> {
        let curvature = params.get(RADIUS).recip();
        let bend = (1.0 + params.get(CONIC)) * curvature * curvature;
        if !bend.is_finite() {
            return Err(RADIUS.refused(
                "the radius is too small for this conic number: the formula has no finite values",
            ));
        }
        Ok(Self { curvature, bend })
    }
}

impl Surface for Conic {
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let root = (-(square * self.bend) + 1.0).sqrt();
        square * self.curvature / (root + 1.0)
    }
}
