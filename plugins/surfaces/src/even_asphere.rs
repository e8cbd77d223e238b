//! The even asphere: a conicoid with even powers of ρ on top.

use turnpath_plugin::prelude::*;

use crate::powers;

/// z = conicoid + Σ A_i ρⁱ, i = 2, 4, 6, …
///
/// Beyond the aperture the formula goes on. Where the conicoid has no point, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct EvenAsphere {
    base: Conicoid,
    /// A_2, A_4, …
    terms: Vec<f64>,
}

const COEFFICIENTS: Param<Option<Coefficients>> = Param::coefficients(
    "coefficients",
    1,
    "A_i of ρ^i under the even power i, in mm^(1-i)",
)
.example("{ 4 = 1.2e-6, 6 = -3.5e-9 }")
.optional();

impl Strategy for EvenAsphere {
    const NAME: &'static str = "even-asphere";
    const SUMMARY: &'static str = "a conicoid with even powers of the radius on top";
    const SOURCE: &'static str = "ISO 10110-12 with even powers; Zemax Even Asphere";
    const PARAMS: &'static [ParamInfo] = &[
        Conicoid::RADIUS.info(),
        Conicoid::CONIC.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let dense = powers::dense(params, COEFFICIENTS, 2, 2)?;
        Ok(Self {
            base: Conicoid::of(params)?,
            terms: powers::every_second(&dense, 2),
        })
    }
}

impl Surface for EvenAsphere {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        self.base.sag(square) + square * powers::sum(&self.terms, square)
    }
}
