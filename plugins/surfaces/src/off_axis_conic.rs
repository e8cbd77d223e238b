//! The segment of a conicoid away from the axis, in the frame of the segment's own normal.

use turnpath_plugin::prelude::*;

/// A segment of a conicoid of revolution, turned so that its middle lies flat at the origin.
///
/// The parent X² + Y² − 2RZ + (1 + K)Z² = 0 has the segment's middle at (x₀, 0, z₀), on the side of
/// positive x. With the angle α of the slope there, c = cos α and s = sin α, a point of the segment
/// is X = x₀ + cx − sz, Y = y, Z = z₀ + sx + cz. This is a quadratic equation for z, whose linear
/// terms in x vanish: Az² − 2Bz + q = 0 with A = 1 + Kc², B = L − Kcs·x, q = (1 + Ks²)x² + y² and
/// L² = x₀² + (R − (1 + K)z₀)². So z = q / (B ± sqrt(B² − Aq)), + for R > 0 (concave), − for R < 0
/// (convex). Beyond the aperture the formula goes on. Where the sheet of the vertex has no point
/// above (x, y), z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct OffAxisConic {
    /// A.
    across: f64,
    /// L, with the sign of R.
    lever: f64,
    /// Kcs.
    shear: f64,
    /// 1 + Ks².
    along: f64,
    /// The sign of R.
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

impl Strategy for OffAxisConic {
    const NAME: &'static str = "off-axis-conic";
    const SUMMARY: &'static str = "a conicoid's segment off its axis, laid flat at its middle";
    const SOURCE: &'static str =
        "a parent conicoid in the frame of the segment's normal: z = q/(B + sqrt(B² − Aq))";
    const PARAMS: &'static [ParamInfo] = &[
        VERTEX_RADIUS.info(),
        Conicoid::CONIC.info(),
        OFF_AXIS_DISTANCE.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let (radius, conic) = (params.get(VERTEX_RADIUS), params.get(Conicoid::CONIC));
        let distance = params.get(OFF_AXIS_DISTANCE);
        let parent = Conicoid::new(Some(radius), conic);
        let parent = parent.filter(|parent| parent.reaches(distance * distance));
        let Some(parent) = parent else {
            return Err(OFF_AXIS_DISTANCE.refused("the parent has no point so far from its axis"));
        };
        // R − (1 + K)z₀ is R times the root of the parent's own formula.
        let upright = radius * parent.root(distance * distance);
        let lever = Scalar::hypot(distance, upright).copysign(radius);
        let (sin, cos) = (distance / lever, upright / lever);
        Ok(Self {
            across: 1.0 + conic * cos * cos,
            lever,
            shear: conic * cos * sin,
            along: 1.0 + conic * sin * sin,
            sign: radius.signum(),
        })
    }
}

impl Surface for OffAxisConic {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let b = -(x * self.shear) + self.lever;
        let q = x.squared() * self.along + y.squared();
        let product = q * self.across;
        let below_root = b.squared() - product;
        // Both solutions lie on one side of the segment's plane, the one of the other sheet.
        let zero = S::constant(0.0);
        let other_sheet = (b * self.sign).less(zero) & zero.less(product);
        let root = S::select(other_sheet, S::constant(-1.0), below_root).sqrt();
        q / (b + root * self.sign)
    }
}
