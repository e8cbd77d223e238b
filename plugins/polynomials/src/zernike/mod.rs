//! The sum of Zernike polynomials.

mod index;

use turnpath_plugin::prelude::*;

use self::index::Indexing;
use crate::harmonics::{AngularTerm, Harmonics};
use crate::jacobi::jacobi;
use crate::terms::{NORMALIZATION_RADIUS, terms};

/// z = Σ c_j N_j R_n^|m|(ρ) cos mθ, or sin |m|θ where m < 0, with ρ = 1 at the normalisation radius
/// and θ from x to y.
///
/// R_n^m(ρ) = ρᵐ P_k^(0, m)(2ρ² − 1) with k = (n − m)/2, by the recurrence of Jacobi's polynomials.
/// N is 1, or what makes the mean square of each polynomial over the disc 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Zernike {
    normalization_radius: f64,
    harmonics: Harmonics,
}

/// Largest degree: far beyond design and measurement, where 37 or 66 terms are usual.
const LARGEST_DEGREE: i32 = 60;

const INDEXING: Param<Choice> = Param::choice(
    "indexing",
    &["noll", "fringe", "osa"],
    "how the terms are numbered; osa: OSA/ANSI",
);
const NORMALIZATION: Param<Option<Choice>> = Param::choice(
    "normalization",
    &["rms", "peak"],
    "what a coefficient is; \"rms\": the RMS of its term over the disc; \"peak\": the largest height of \
     its term on the disc; left out: \"peak\" for fringe, else \"rms\"",
)
.optional();
const COEFFICIENTS: Param<Coefficients> =
    Param::length_coefficients("coefficients", 1, "c_j of each term under its number j")
        .example("{ 4 = \"0.2 um\", 11 = \"-30 nm\" }");

impl Strategy for Zernike {
    const NAME: &'static str = "zernike";
    const SUMMARY: &'static str = "a sum of Zernike polynomials by Noll, Fringe or OSA/ANSI number";
    const SOURCE: &'static str = "Noll 1976, J. Opt. Soc. Am. 66, doi:10.1364/JOSA.66.000207; ANSI Z80.28; the Fringe list of \
        the University of Arizona";
    const PARAMS: &'static [ParamInfo] = &[
        INDEXING.info(),
        NORMALIZATION.info(),
        NORMALIZATION_RADIUS.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let indexing = match params.get(INDEXING) {
            "fringe" => Indexing::Fringe,
            "osa" => Indexing::Osa,
            _ => Indexing::Noll,
        };
        let usual = match indexing {
            Indexing::Fringe => "peak",
            Indexing::Noll | Indexing::Osa => "rms",
        };
        let unit_rms = params.get(NORMALIZATION).unwrap_or(usual) == "rms";
        let (first, last) = (indexing.first(), indexing.last(LARGEST_DEGREE));
        let mut angular = Vec::new();
        for ([number], coefficient) in terms::<1>(params, COEFFICIENTS) {
            if !(first..=last).contains(&number) {
                let indexing = params.get(INDEXING);
                return Err(COEFFICIENTS.refused(format!(
                    "the number {number} is not from {first} to {last}, the numbers of `{indexing}`"
                )));
            }
            let of = indexing.order(number);
            let norm = if unit_rms {
                rms_norm(of.degree, of.order)
            } else {
                1.0
            };
            angular.push(AngularTerm {
                radial: ((of.degree - of.order.abs()) / 2) as usize,
                order: of.order,
                coefficient: norm * coefficient,
            });
        }
        Ok(Self {
            normalization_radius: params.get(NORMALIZATION_RADIUS),
            harmonics: Harmonics::new(&angular, |order, count| jacobi(order as f64, count)),
        })
    }
}

/// sqrt(n + 1), times sqrt(2) where the polynomial goes with an angle.
fn rms_norm(degree: i32, order: i32) -> f64 {
    let both = if order == 0 { 1 } else { 2 };
    f64::from(both * (degree + 1)).sqrt()
}

impl Surface for Zernike {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (x, y) = (x / self.normalization_radius, y / self.normalization_radius);
        let w = (x.squared() + y.squared()) * 2.0 - 1.0;
        self.harmonics.sum(x, y, w)
    }
}
