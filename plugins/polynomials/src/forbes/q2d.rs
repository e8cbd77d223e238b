//! The freeform by polynomials whose gradients are orthogonal, along the normal of a best-fit
//! sphere.

use turnpath_plugin::prelude::*;

use super::best_fit_sphere::{LARGEST_DEGREE, RADIUS, sphere, with_departure};
use super::round_terms::put;
use super::{q2d_basis, qbfs_basis};
use crate::harmonics::{AngularTerm, Harmonics};
use crate::recurrence::Family;
use crate::terms::{NORMALIZATION_RADIUS, degree, terms};

/// z = cρ² / (1 + cos φ) + (u²(1 − u²) Σ a_n⁰ Q_n⁰(u²) + Σ uᵐ (a_nᵐ cos mθ + b_nᵐ sin mθ) Q_nᵐ(u²)) /
/// cos φ, cos φ = sqrt(1 − c²ρ²), with u = 1 at the normalisation radius and θ from x to y.
///
/// The terms of m = 0 are those of Q^bfs. Beyond the sphere's equator, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct ForbesQ2d {
    sphere: Conicoid,
    normalization_radius: f64,
    /// The terms of m = 0.
    round: Family,
    round_coefficients: Vec<f64>,
    /// The others.
    harmonics: Harmonics,
}

/// Largest order m of the angle.
const LARGEST_ORDER: u32 = 60;

const COEFFICIENTS: Param<Coefficients> = Param::length_coefficients(
    "coefficients",
    2,
    "a_n^m of Q_n^m·cos(m·theta) under \"n,m\"; b_n^m of the sine under \"n,-m\"",
)
.example("{ \"0,2\" = \"1.5 um\", \"1,-1\" = \"-40 nm\" }");

impl Strategy for ForbesQ2d {
    const NAME: &'static str = "forbes-q2d";
    const SUMMARY: &'static str = "a best-fit sphere with Forbes' gradient-orthogonal polynomials";
    const SOURCE: &'static str = "Forbes 2012, Opt. Express 20, 2483, doi:10.1364/OE.20.002483";
    const PARAMS: &'static [ParamInfo] = &[
        RADIUS.info(),
        NORMALIZATION_RADIUS.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let (mut round, mut angular) = (Vec::new(), Vec::new());
        for ([n, order], coefficient) in terms::<2>(params, COEFFICIENTS) {
            let radial = degree(COEFFICIENTS, "degree n", n, LARGEST_DEGREE)?;
            if order.unsigned_abs() > LARGEST_ORDER {
                return Err(COEFFICIENTS.refused(format!(
                    "the order m = {order} is not from -{LARGEST_ORDER} to {LARGEST_ORDER}"
                )));
            }
            if order == 0 {
                put(&mut round, radial, coefficient);
            } else {
                angular.push(AngularTerm {
                    radial,
                    order,
                    coefficient,
                });
            }
        }
        let harmonics = Harmonics::new(&angular, q2d_basis::family);
        Ok(Self {
            sphere: sphere(params)?,
            normalization_radius: params.get(NORMALIZATION_RADIUS),
            round: qbfs_basis::family(round.len()),
            round_coefficients: qbfs_basis::change(&round),
            harmonics: harmonics.changed(q2d_basis::change),
        })
    }
}

impl Surface for ForbesQ2d {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let radius = self.normalization_radius;
        let (x, y, u) = (x / radius, y / radius, square / (radius * radius));
        let round = u * (-u + 1.0) * self.round.sum(&self.round_coefficients, u);
        let departure = round + self.harmonics.sum(x, y, u);
        with_departure(self.sphere, square, departure)
    }
}
