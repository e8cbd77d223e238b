//! The segment of a paraboloid away from the axis, in the frame of the segment's own normal.

use turnpath_plugin::prelude::*;

/// A segment of a paraboloid, turned so that its middle lies flat at the origin.
///
/// The parent has radius R_v at its vertex, and the segment's middle lies x₀ from the parent's
/// axis, on the side of positive x. With α = atan(x₀/R_v), c = cos α, s = sin α,
/// B = R_v/c + s·c·x and q = c²x² + y²: z = q / (B ± sqrt(B² − s²q)), + for R_v > 0 (concave),
/// − for R_v < 0 (convex). Where the paraboloid has no point above (x, y), z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct OffAxisParaboloid {
    /// R_v / cos α.
    slant_radius: f64,
    /// sin α · cos α.
    sin_cos: f64,
    /// sin² α.
    sin_squared: f64,
    /// cos² α.
    cos_squared: f64,
    /// The sign of R_v.
    sign: f64,
}

const VERTEX_RADIUS: Param<Length> = Param::length(
    "vertex_radius",
    "radius at the parent's vertex; positive: concave",
)
.nonzero();
const OFF_AXIS_DISTANCE: Param<Length> = Param::length(
    "off_axis_distance",
    "from the parent's axis to the middle of the segment",
);

impl Strategy for OffAxisParaboloid {
    const NAME: &'static str = "off-axis-paraboloid";
    const SUMMARY: &'static str = "a paraboloid's segment off its axis, laid flat at its middle";
    const SOURCE: &'static str =
        "a parent paraboloid in the frame of the segment's normal: z = q/(B + sqrt(B² − s²q))";
    const PARAMS: &'static [ParamInfo] = &[VERTEX_RADIUS.info(), OFF_AXIS_DISTANCE.info()];

    fn new(params: &Params) -> Result<Self> {
        let vertex_radius = params.get(VERTEX_RADIUS);
        let distance = params.get(OFF_AXIS_DISTANCE);
        let slant_radius = Scalar::hypot(vertex_radius, distance).copysign(vertex_radius);
        let (sin, cos) = (distance / slant_radius, vertex_radius / slant_radius);
        Ok(Self {
            slant_radius,
            sin_cos: sin * cos,
            sin_squared: sin * sin,
            cos_squared: cos * cos,
            sign: vertex_radius.signum(),
        })
    }
}

impl Surface for OffAxisParaboloid {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let b = x * self.sin_cos + self.slant_radius;
        let q = x.squared() * self.cos_squared + y.squared();
        q / (b + (b.squared() - q * self.sin_squared).sqrt() * self.sign)
    }
}
