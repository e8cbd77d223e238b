//! The toroid of the design programs: an aspheric curve in YZ that is turned about an axis parallel
//! to y.

use turnpath_plugin::prelude::*;

use crate::powers;
use crate::revolved::revolved;

/// The curve u(y) = cy² / (1 + sqrt(1 − (1 + K)c²y²)) + Σ A_i yⁱ, i = 2, 4, …, turned about an axis
/// parallel to y at the distance R: z = R − sqrt((R − u)² − x²).
///
/// R is the radius of curvature along x. Beyond the aperture the formula goes on. Beyond the conic
/// section and beyond the turned curve, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct ToroidYz {
    /// 1/R.
    curvature: f64,
    section: Conicoid,
    /// A_2, A_4, …
    terms: Vec<f64>,
}

const RADIUS_ROTATION: Param<Option<Length>> = Param::length(
    "radius_rotation",
    "radius of rotation, the one along x; positive: concave; left out: not turned, a cylinder",
)
.nonzero()
.optional();
const RADIUS: Param<Option<Length>> = Param::length(
    "radius",
    "radius of curvature of the curve along y; positive: concave; left out: straight",
)
.nonzero()
.optional();
const COEFFICIENTS: Param<Option<Coefficients>> = Param::coefficients(
    "coefficients",
    1,
    "A_i of y^i under the even power i, in mm^(1-i)",
)
.example("{ 4 = 1.2e-6, 6 = -3.5e-9 }")
.optional();

impl Strategy for ToroidYz {
    const NAME: &'static str = "toroid-yz";
    const SUMMARY: &'static str = "an aspheric curve along y, turned about an axis parallel to y";
    const SOURCE: &'static str = "Zemax Toroidal, without Zernike terms";
    const PARAMS: &'static [ParamInfo] = &[
        RADIUS_ROTATION.info(),
        RADIUS.info(),
        Conicoid::CONIC.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let section = Conicoid::new(params.get(RADIUS), params.get(Conicoid::CONIC));
        let dense = powers::dense(params, COEFFICIENTS, 2, 2)?;
        Ok(Self {
            curvature: params.get(RADIUS_ROTATION).map_or(0.0, f64::recip),
            section: section.ok_or_else(|| RADIUS.refused(Conicoid::TOO_SMALL))?,
            terms: powers::every_second(&dense, 2),
        })
    }
}

impl Surface for ToroidYz {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = y.squared();
        let u = self.section.sag(square) + square * powers::sum(&self.terms, square);
        revolved(u, x, self.curvature)
    }
}
