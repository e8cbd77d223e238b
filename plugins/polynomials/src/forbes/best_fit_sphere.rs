//! The sphere from which slope-orthogonal polynomials depart along its normal.

use turnpath_plugin::prelude::*;

/// The radius of the sphere; a flat without one.
pub const RADIUS: Param<Option<Length>> = Param::length(
    "radius",
    "radius of the best-fit sphere; positive: concave; left out: flat",
)
.nonzero()
.optional();

/// Largest degree of a radial polynomial.
pub const LARGEST_DEGREE: usize = 60;

/// The sphere of a recipe.
pub fn sphere(params: &Params) -> Result<Conicoid> {
    let sphere = Conicoid::new(params.get(RADIUS), 0.0);
    sphere
        .ok_or_else(|| RADIUS.refused("the radius is too small: the formula has no finite values"))
}

/// The height of a sphere with a departure along its normal: z = sphere + departure / cos φ.
#[inline(always)]
pub fn with_departure<S: Scalar>(sphere: Conicoid, square: S, departure: S) -> S {
    let cosine = sphere.root(square);
    square * sphere.curvature / (cosine + 1.0) + departure / cosine
}
