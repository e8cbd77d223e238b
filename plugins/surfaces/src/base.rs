//! The base of an asphere: a conicoid, or a flat if its radius is left out.

use turnpath_plugin::prelude::*;

/// Why a radius is refused that is too small for the formula.
pub const TOO_SMALL: &str =
    "the radius is too small for this conic number: the formula has no finite values";

/// The radius of a base that may be a flat.
pub const RADIUS: Param<Option<Length>> = Param::length(
    "radius",
    "radius of curvature at the vertex; positive: concave; left out: flat",
)
.nonzero()
.optional();

/// The conic number of a base.
pub const CONIC: Param<Number> =
    Param::number("conic", "conic number K; 0: sphere, -1: paraboloid").default(0.0);

/// The conicoid of `radius` and `conic`.
pub fn base(params: &Params) -> Result<Conicoid> {
    Conicoid::new(params.get(RADIUS), params.get(CONIC)).ok_or_else(|| RADIUS.refused(TOO_SMALL))
}
