//! The polynomial in x and y.

use turnpath_plugin::prelude::*;

/// Largest power of x or y: far more than optics use, and small enough for dense coefficients.
const LARGEST_POWER: usize = 40;

/// z = Σ c·xⁱ·yʲ, by Horner's rule.
#[derive(Debug, Clone, PartialEq)]
pub struct XyPolynomial {
    /// `rows[i][j]` belongs to xⁱ·yʲ; each row ends with its last term.
    rows: Vec<Vec<f64>>,
}

const TERMS: Param<Rows> = Param::rows(
    "terms",
    3,
    "[i, j, c] for each term c·x^i·y^j; c in mm^(1-i-j)",
);

impl Strategy for XyPolynomial {
    const NAME: &'static str = "xy-polynomial";
    const SUMMARY: &'static str = "a polynomial in x and y";
    const SOURCE: &'static str = "z = Σ c xⁱ yʲ, without a conic base";
    const PARAMS: &'static [ParamInfo] = &[TERMS.info()];

    fn new(params: &Params) -> Result<Self> {
        let terms = params.get(TERMS);
        if terms.is_empty() {
            return Err(bad_terms(
                "no term is given; a flat is [[0, 0, 0]]".to_owned(),
            ));
        }
        let mut given: Vec<Vec<Option<f64>>> = Vec::new();
        for (index, term) in terms.iter().enumerate() {
            let number = index + 1;
            let [i, j, c] = term[..] else {
                return Err(bad_terms(format!(
                    "term {number} is not of the form [i, j, c]"
                )));
            };
            if !c.is_finite() {
                return Err(bad_terms(format!(
                    "term {number}: the coefficient {c} is not finite"
                )));
            }
            let coefficient = coefficient(&mut given, power(i, number)?, power(j, number)?);
            if coefficient.replace(c).is_some() {
                return Err(bad_terms(format!("x^{i}·y^{j} stands in two terms")));
            }
        }
        Ok(Self {
            rows: given.into_iter().map(dense).collect(),
        })
    }
}

impl Surface for XyPolynomial {
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let mut rows = self.rows.iter().rev().map(Vec::as_slice);
        let highest = in_y(rows.next().unwrap_or_default(), y);
        rows.fold(highest, |sum, row| match row {
            [] => sum * x,
            [constant] => sum * x + *constant,
            _ => sum * x + in_y(row, y),
        })
    }
}

/// The polynomial in y alone, lowest coefficient first.
fn in_y<S: Scalar>(row: &[f64], y: S) -> S {
    match row {
        [] => S::constant(0.0),
        [constant] => S::constant(*constant),
        [lower @ .., next, highest] => lower
            .iter()
            .rev()
            .fold(y * *highest + *next, |sum, c| sum * y + *c),
    }
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

fn power(value: f64, term: usize) -> Result<usize> {
    if value.fract() != 0.0 || !(0.0..=LARGEST_POWER as f64).contains(&value) {
        return Err(bad_terms(format!(
            "term {term}: the power {value} is not a whole number from 0 to {LARGEST_POWER}"
        )));
    }
    Ok(value as usize)
}

fn bad_terms(message: String) -> StrategyError {
    TERMS.refused(message)
}
