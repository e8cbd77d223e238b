//! The torus: a base arc that is turned about an axis.

use turnpath_plugin::prelude::*;

use crate::revolved::revolved;

/// z = R − sqrt((R − a + sqrt(a² − y²))² − x²): the base arc of radius a in the YZ plane, turned
/// about an axis parallel to Y at the distance R.
///
/// R is the radius of curvature along x and a that along y; each is positive if concave. The
/// formula is evaluated without cancellation: with u = y²/a / (1 + sqrt(1 − y²/a²)) the height of
/// the base arc, z = (2u + (x² − u²)/R) / (1 + sqrt((1 − u/R)² − x²/R²)). Beyond the base arc, and
/// where the arc has reached the axis, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Toric {
    /// 1/R.
    curvature: f64,
    /// 1/a.
    base_curvature: f64,
}

const RADIUS_ROTATION: Param<Length> = Param::length(
    "radius_rotation",
    "radius of curvature along x; positive: concave",
)
.nonzero();
const RADIUS_BASE: Param<Length> = Param::length(
    "radius_base",
    "radius of curvature along y; positive: concave",
)
.nonzero();

impl Strategy for Toric {
    const NAME: &'static str = "toric";
    const SUMMARY: &'static str = "a torus: a base arc along y, turned about an axis parallel to y";
    const SOURCE: &'static str =
        "z = R − sqrt((R − a + sqrt(a² − y²))² − x²), written without cancellation";
    const PARAMS: &'static [ParamInfo] = &[RADIUS_ROTATION.info(), RADIUS_BASE.info()];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            curvature: params.get(RADIUS_ROTATION).recip(),
            base_curvature: params.get(RADIUS_BASE).recip(),
        })
    }
}

impl Toric {
    /// The height u of the base arc at y.
    #[inline(always)]
    fn base_arc<S: Scalar>(&self, y: S) -> S {
        let slope = y * self.base_curvature;
        y * slope / (cosine(slope) + 1.0)
    }
}

impl Surface for Toric {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        revolved(self.base_arc(y), x, self.curvature)
    }
}

/// sqrt(1 − sine²), without cancellation near 1.
#[inline(always)]
fn cosine<S: Scalar>(sine: S) -> S {
    ((-sine + 1.0) * (sine + 1.0)).sqrt()
}
