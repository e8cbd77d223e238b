//! The odd asphere: a conicoid with all powers of ρ on top.

use turnpath_plugin::prelude::*;

use crate::powers;

/// z = conicoid + Σ A_i ρⁱ, i = 1, 2, 3, …
///
/// A_1 makes a cone with its tip at the axis, and A_3 a jump of the third derivative there. At the
/// axis itself the derivatives are the means of those on both sides, so the odd powers have none.
/// Beyond the aperture the formula goes on. Where the conicoid has no point, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct OddAsphere {
    base: Conicoid,
    /// A_2, A_4, …
    even: Vec<f64>,
    /// A_1, A_3, …
    odd: Vec<f64>,
}

/// ρ² below which a point counts as one of the axis, mm². The fifth derivative of ρ is still
/// finite there, as a product too.
const AXIS: f64 = 1e-50;

const COEFFICIENTS: Param<Option<Coefficients>> = Param::coefficients(
    "coefficients",
    1,
    "A_i of ρ^i under the power i, in mm^(1-i)",
)
.example("{ 3 = 1.2e-5, 4 = -3.5e-7 }")
.optional();

impl Strategy for OddAsphere {
    const NAME: &'static str = "odd-asphere";
    const SUMMARY: &'static str = "a conicoid with all powers of the radius on top";
    const SOURCE: &'static str = "ISO 10110-12 with all powers; Zemax Odd Asphere";
    const PARAMS: &'static [ParamInfo] = &[
        Conicoid::RADIUS.info(),
        Conicoid::CONIC.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let dense = powers::dense(params, COEFFICIENTS, 1, 1)?;
        Ok(Self {
            base: Conicoid::of(params)?,
            even: powers::every_second(&dense, 2),
            odd: powers::every_second(&dense, 1),
        })
    }
}

impl Surface for OddAsphere {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let even = self.base.sag(square) + square * powers::sum(&self.even, square);
        if self.odd.is_empty() {
            return even;
        }
        let at_axis = square.less(S::constant(AXIS));
        let rho = S::select(at_axis, S::constant(1.0), square).sqrt();
        let odd = rho * powers::sum(&self.odd, square);
        even + S::select(at_axis, S::constant(0.0), odd)
    }
}
