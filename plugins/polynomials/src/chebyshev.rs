//! The sum of products of Chebyshev polynomials in x and in y.

use turnpath_plugin::prelude::*;

use crate::terms::{degree, terms};

/// z = Σ c_ij T_i(x/X) T_j(y/Y), X and Y the half lengths of the rectangle.
///
/// T_0 = 1, T_1(u) = u, T_{k+1}(u) = 2u T_k(u) − T_{k−1}(u). The constant term counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Chebyshev {
    half_x: f64,
    half_y: f64,
    /// The coefficients of each i, by j; the rows end with their last terms.
    rows: Vec<Vec<f64>>,
    /// The most terms of a row.
    longest_row: usize,
}

/// Largest degree in x or y: more than design programs have.
const LARGEST_DEGREE: usize = 40;

const NORMALIZATION_X: Param<Length> = Param::length(
    "normalization_x",
    "x at which the polynomials' own variable is 1: half the length of the rectangle",
)
.positive();
const NORMALIZATION_Y: Param<Option<Length>> = Param::length(
    "normalization_y",
    "the same for y; as normalization_x if left out",
)
.positive()
.optional();
const COEFFICIENTS: Param<Coefficients> = Param::length_coefficients(
    "coefficients",
    2,
    "c of T_i(x)·T_j(y) under \"i,j\"; the constant \"0,0\" counts",
)
.example("{ \"2,0\" = \"1.5 um\", \"0,3\" = \"-40 nm\" }");

impl Strategy for Chebyshev {
    const NAME: &'static str = "chebyshev";
    const SUMMARY: &'static str = "a sum of products of Chebyshev polynomials in x and y";
    const SOURCE: &'static str = "Chebyshev polynomials of the first kind; Zemax Chebyshev \
        Polynomial, without its conic base and with the constant term that Zemax ignores";
    const PARAMS: &'static [ParamInfo] = &[
        NORMALIZATION_X.info(),
        NORMALIZATION_Y.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let half_x = params.get(NORMALIZATION_X);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for ([i, j], coefficient) in terms::<2>(params, COEFFICIENTS) {
            let i = degree(COEFFICIENTS, "degree in x", i, LARGEST_DEGREE)?;
            let j = degree(COEFFICIENTS, "degree in y", j, LARGEST_DEGREE)?;
            if rows.len() <= i {
                rows.resize(i + 1, Vec::new());
            }
            let row = &mut rows[i];
            if row.len() <= j {
                row.resize(j + 1, 0.0);
            }
            row[j] = coefficient;
        }
        Ok(Self {
            half_x,
            half_y: params.get(NORMALIZATION_Y).unwrap_or(half_x),
            longest_row: rows.iter().map(Vec::len).max().unwrap_or(0),
            rows,
        })
    }
}

impl Chebyshev {
    /// The polynomials T_j(v) as far as the longest row needs them, which is at most `N`.
    #[inline(always)]
    fn in_y<S: Scalar, const N: usize>(&self, v: S) -> [S; N] {
        let mut all = [S::constant(1.0); N];
        let (mut before, mut here) = (S::constant(1.0), v);
        for t in all.iter_mut().take(self.longest_row).skip(1) {
            *t = here;
            (before, here) = (here, v * here * 2.0 - before);
        }
        all
    }

    /// The sum, where no row has more than `N` terms.
    #[inline(always)]
    fn sum<S: Scalar, const N: usize>(&self, u: S, v: S) -> S {
        let in_y = self.in_y::<S, N>(v);
        let mut total = S::constant(0.0);
        let (mut here, mut next) = (S::constant(1.0), u);
        for (i, row) in self.rows.iter().enumerate() {
            let mut sum = S::constant(0.0);
            for (t, c) in in_y.iter().zip(row).filter(|(_, c)| **c != 0.0) {
                sum = sum + *t * *c;
            }
            total = match i {
                0 => sum,
                _ if row.is_empty() => total,
                _ => total + here * sum,
            };
            (here, next) = (next, u * next * 2.0 - here);
        }
        total
    }
}

impl Surface for Chebyshev {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (u, v) = (x / self.half_x, y / self.half_y);
        // Room for fewer polynomials is set faster, which counts for series.
        match self.longest_row {
            0..=4 => self.sum::<S, 4>(u, v),
            5..=8 => self.sum::<S, 8>(u, v),
            9..=16 => self.sum::<S, 16>(u, v),
            _ => self.sum::<S, { LARGEST_DEGREE + 1 }>(u, v),
        }
    }
}
