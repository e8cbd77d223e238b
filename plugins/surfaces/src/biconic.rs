//! The biconic: a conicoid whose curvature and conic number along x are not those along y.

use turnpath_plugin::prelude::*;

/// z = (c_x x² + c_y y²) / (1 + sqrt(1 − (1 + K_x)c_x²x² − (1 + K_y)c_y²y²)).
///
/// Along x and along y it is a conic section. Beyond the aperture the formula goes on. Where the root
/// has no value, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Biconic {
    along_x: Conicoid,
    along_y: Conicoid,
}

const RADIUS_X: Param<Option<Length>> = Param::length(
    "radius_x",
    "radius of curvature along x; positive: concave; left out: straight",
)
.nonzero()
.optional();
const RADIUS_Y: Param<Option<Length>> = Param::length(
    "radius_y",
    "radius of curvature along y; positive: concave; left out: straight",
)
.nonzero()
.optional();
const CONIC_X: Param<Number> = Conicoid::conic_number("conic_x", "conic number along x");
const CONIC_Y: Param<Number> = Conicoid::conic_number("conic_y", "conic number along y");

impl Strategy for Biconic {
    const NAME: &'static str = "biconic";
    const SUMMARY: &'static str = "a conic section along x, and another along y, under one root";
    const SOURCE: &'static str = "Zemax Biconic";
    const PARAMS: &'static [ParamInfo] = &[
        RADIUS_X.info(),
        RADIUS_Y.info(),
        CONIC_X.info(),
        CONIC_Y.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let section = |radius: Param<Option<Length>>, conic| {
            let section = Conicoid::new(params.get(radius), params.get(conic));
            section.ok_or_else(|| radius.refused(Conicoid::TOO_SMALL))
        };
        Ok(Self {
            along_x: section(RADIUS_X, CONIC_X)?,
            along_y: section(RADIUS_Y, CONIC_Y)?,
        })
    }
}

impl Surface for Biconic {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (along_x, along_y) = (self.along_x, self.along_y);
        let (x, y) = (x.squared(), y.squared());
        let root = (-(x * along_x.bend + y * along_y.bend) + 1.0).sqrt();
        (x * along_x.curvature + y * along_y.curvature) / (root + 1.0)
    }
}
