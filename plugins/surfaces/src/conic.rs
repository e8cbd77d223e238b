//! The conicoid of revolution: sphere, ellipsoid, paraboloid, hyperboloid.

use turnpath_plugin::prelude::*;

/// z = cρ² / (1 + sqrt(1 − (1 + K)c²ρ²)), c = 1/radius, K the conic number.
///
/// K = 0 is a sphere, −1 a paraboloid. Where the conicoid has no point, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Conic(Conicoid);

const RADIUS: Param<Length> = Param::length(
    "radius",
    "radius of curvature at the vertex; positive: concave",
)
.nonzero();

impl Strategy for Conic {
    const NAME: &'static str = "conic";
    const SUMMARY: &'static str = "a conicoid of revolution: sphere, ellipsoid, paraboloid, …";
    const SOURCE: &'static str = "ISO 10110-12, the conic section without aspheric terms";
    const PARAMS: &'static [ParamInfo] = &[RADIUS.info(), Conicoid::CONIC.info()];

    fn new(params: &Params) -> Result<Self> {
        let (radius, conic) = (params.get(RADIUS), params.get(Conicoid::CONIC));
        let conicoid = Conicoid::new(Some(radius), conic);
        conicoid
            .map(Self)
            .ok_or_else(|| RADIUS.refused(Conicoid::TOO_SMALL))
    }
}

impl Surface for Conic {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        self.0.sag(x.squared() + y.squared())
    }
}
