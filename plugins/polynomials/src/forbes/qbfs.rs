//! The asphere by polynomials whose slopes are orthogonal, along the normal of a best-fit sphere.

use turnpath_plugin::prelude::*;

use super::best_fit_sphere::{RADIUS, sphere, with_departure};
use super::qbfs_basis::{change, family};
use super::round_terms::{COEFFICIENTS, round_coefficients};
use crate::recurrence::Family;
use crate::terms::NORMALIZATION_RADIUS;

/// z = cρ² / (1 + cos φ) + u²(1 − u²)/cos φ · Σ a_n Q_n(u²), cos φ = sqrt(1 − c²ρ²), with u = 1 at
/// the normalisation radius.
///
/// The departure from the sphere is zero at the axis and at the normalisation radius. Beyond the
/// sphere's equator, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct ForbesQbfs {
    sphere: Conicoid,
    normalization_radius: f64,
    family: Family,
    /// The coefficients in the family's polynomials.
    coefficients: Vec<f64>,
}

impl Strategy for ForbesQbfs {
    const NAME: &'static str = "forbes-qbfs";
    const SUMMARY: &'static str = "a best-fit sphere with Forbes' slope-orthogonal polynomials";
    const SOURCE: &'static str = "Forbes 2007, Opt. Express 15, 5218; Forbes 2010, Opt. Express \
        18, 19700";
    const PARAMS: &'static [ParamInfo] = &[
        RADIUS.info(),
        NORMALIZATION_RADIUS.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let dense = round_coefficients(params)?;
        Ok(Self {
            sphere: sphere(params)?,
            normalization_radius: params.get(NORMALIZATION_RADIUS),
            family: family(dense.len()),
            coefficients: change(&dense),
        })
    }
}

impl Surface for ForbesQbfs {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let radius = self.normalization_radius;
        let u = square / (radius * radius);
        let departure = u * (-u + 1.0) * self.family.sum(&self.coefficients, u);
        with_departure(self.sphere, square, departure)
    }
}
