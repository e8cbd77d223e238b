//! The polynomial in x and y.

use turnpath_plugin::prelude::*;

use crate::powers::{self, LARGEST_POWER};

/// z = Σ c·xⁱ·yʲ, or Σ c·(x/r)ⁱ·(y/r)ʲ with a normalisation radius r, by Horner's rule.
///
/// Beyond the aperture and beyond r the polynomial goes on.
#[derive(Debug, Clone, PartialEq)]
pub struct XyPolynomial {
    /// 1/r; 1 /mm without a radius.
    scale: f64,
    /// `rows[i][j]` belongs to xⁱ·yʲ; each row ends with its last term.
    rows: Vec<Vec<f64>>,
}

const TERMS: Param<Option<Rows>> = Param::rows(
    "terms",
    3,
    "[i, j, c] for each term c·x^i·y^j; c in mm^(1-i-j); instead of `coefficients`",
)
.optional();
const NORMALIZATION_RADIUS: Param<Option<Length>> = Param::length(
    "normalization_radius",
    "r of `coefficients`, the normalisation length",
)
.positive()
.optional();
const COEFFICIENTS: Param<Option<Coefficients>> = Param::length_coefficients(
    "coefficients",
    2,
    "c of (x/r)^i·(y/r)^j under \"i,j\"; instead of `terms`",
)
.example("{ \"2,0\" = \"1.5 um\", \"0,3\" = \"-40 nm\" }")
.optional();

/// Coefficients of a flat.
const FLAT: &str = "{ \"0,0\" = \"0 mm\" }";

impl Strategy for XyPolynomial {
    const NAME: &'static str = "xy-polynomial";
    const SUMMARY: &'static str = "a polynomial in x and y";
    const SOURCE: &'static str = "z = Σ c xⁱ yʲ, without a conic base; with `coefficients` Zemax \
        Extended Polynomial";
    const PARAMS: &'static [ParamInfo] = &[
        TERMS.info(),
        NORMALIZATION_RADIUS.info(),
        COEFFICIENTS.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let radius = params.get(NORMALIZATION_RADIUS);
        match (params.get(TERMS), params.get(COEFFICIENTS), radius) {
            (Some(_), Some(_), _) => {
                Err(COEFFICIENTS.refused("give `terms` or `coefficients`, not both"))
            }
            (None, None, _) => Err(StrategyError::failed(
                "no term is given: give `terms`, or `coefficients` and `normalization_radius`",
            )),
            (Some(_), None, Some(_)) => Err(NORMALIZATION_RADIUS.refused(
                "`terms` are in mm and know no normalisation; write them as `coefficients`",
            )),
            (None, Some(_), None) => {
                Err(COEFFICIENTS.refused("coefficients need a `normalization_radius`"))
            }
            (Some(terms), None, None) => Ok(Self {
                scale: 1.0,
                rows: rows(terms, TERMS, "[[0, 0, 0]]")?,
            }),
            (None, Some(coefficients), Some(normalization_radius)) => Ok(Self {
                scale: normalization_radius.recip(),
                rows: rows(coefficients, COEFFICIENTS, FLAT)?,
            }),
        }
    }
}

impl Surface for XyPolynomial {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (x, y) = (x * self.scale, y * self.scale);
        let mut rows = self.rows.iter().rev().map(Vec::as_slice);
        let mut sum = powers::sum(rows.next().unwrap_or_default(), y);
        // Not by `fold`, for the reason that `powers::sum` has.
        for row in rows {
            sum = match row {
                [] => sum * x,
                [constant] => sum * x + *constant,
                _ => sum * x + powers::sum(row, y),
            };
        }
        sum
    }
}

/// The terms [i, j, c] as dense rows.
fn rows<K>(terms: &[Vec<f64>], param: Param<K>, flat: &str) -> Result<Vec<Vec<f64>>> {
    if terms.is_empty() {
        return Err(param.refused(format!("no term is given; a flat is {flat}")));
    }
    let mut given: Vec<Vec<Option<f64>>> = Vec::new();
    for (index, term) in terms.iter().enumerate() {
        let number = index + 1;
        let [i, j, c] = term[..] else {
            return Err(param.refused(format!("term {number} is not of the form [i, j, c]")));
        };
        if !c.is_finite() {
            return Err(param.refused(format!("term {number}: the coefficient {c} is not finite")));
        }
        let power = |power| power_of(power, number).map_err(|message| param.refused(message));
        let coefficient = coefficient(&mut given, power(i)?, power(j)?);
        if coefficient.replace(c).is_some() {
            return Err(param.refused(format!("x^{i}·y^{j} stands in two terms")));
        }
    }
    Ok(given.into_iter().map(dense).collect())
}

/// The coefficient of xⁱ·yʲ. The function creates it if it does not exist.
fn coefficient(given: &mut Vec<Vec<Option<f64>>>, i: usize, j: usize) -> &mut Option<f64> {
    if given.len() <= i {
        given.resize(i + 1, Vec::new());
    }
    let row = &mut given[i];
    if row.len() <= j {
        row.resize(j + 1, None);
    }
    &mut row[j]
}

fn dense(row: Vec<Option<f64>>) -> Vec<f64> {
    row.into_iter().map(Option::unwrap_or_default).collect()
}

fn power_of(value: f64, term: usize) -> std::result::Result<usize, String> {
    if value.fract() != 0.0 || !(0.0..=LARGEST_POWER as f64).contains(&value) {
        return Err(format!(
            "term {term}: the power {value} is not a whole number from 0 to {LARGEST_POWER}"
        ));
    }
    Ok(value as usize)
}
