//! The asphere by polynomials that are orthogonal in height, on top of a conicoid.

use turnpath_plugin::prelude::*;

use super::round_terms::{COEFFICIENTS, round_coefficients};
use crate::jacobi::jacobi;
use crate::recurrence::Family;
use crate::terms::NORMALIZATION_RADIUS;

/// z = cρ² / (1 + sqrt(1 − (1 + K)c²ρ²)) + u⁴ Σ a_n Q_n(u²), with u = 1 at the normalisation
/// radius.
///
/// Q_n(x) = P_n^(0, 4)(2x − 1), so that each Q_n is 1 at the normalisation radius. Where the conicoid
/// has no point, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct ForbesQcon {
    base: Conicoid,
    normalization_radius: f64,
    family: Family,
    coefficients: Vec<f64>,
}

impl Strategy for ForbesQcon {
    const NAME: &'static str = "forbes-qcon";
    const SUMMARY: &'static str = "a conicoid with Forbes' polynomials for strong aspheres";
    const SOURCE: &'static str = "Forbes 2007, Opt. Express 15, 5218, doi:10.1364/OE.15.005218; \
        Forbes 2010, Opt. Express 18, 13851, doi:10.1364/OE.18.013851";
    const PARAMS: &'static [ParamInfo] = &[
        Conicoid::RADIUS.info(),
        Conicoid::CONIC.info(),
        NORMALIZATION_RADIUS.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let dense = round_coefficients(params)?;
        Ok(Self {
            base: Conicoid::of(params)?,
            normalization_radius: params.get(NORMALIZATION_RADIUS),
            family: jacobi(4.0, dense.len()),
            coefficients: dense,
        })
    }
}

impl Surface for ForbesQcon {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let radius = self.normalization_radius;
        let u = square / (radius * radius);
        let departure = u.squared() * self.family.sum(&self.coefficients, u * 2.0 - 1.0);
        self.base.sag(square) + departure
    }
}
