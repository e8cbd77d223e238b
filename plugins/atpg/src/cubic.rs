//! The paper's own law: explicit pairs (i, ρ_i), and one least-squares cubic through them.

use nalgebra::{DMatrix, DVector};
use turnpath_plugin::prelude::*;

use turnpath_plugin::ring::FeedTable;

/// More revolutions than any part takes.
const MOST_PAIRS: usize = 1_000_000;
/// Rounds of the search for a root: more than it takes to halve any interval down to rounding.
const ROUNDS: usize = 200;

/// The parameter that chooses this law.
pub const FIT: Param<Choice> = Param::choice(
    "fit",
    &["smooth", "cubic"],
    "smooth: never above the feed that holds the residual; cubic: the paper's single cubic \
             through all revolutions, which may exceed that feed",
)
.default("smooth");

/// ρ_{i+1} = ρ_i + F(ρ_i) from the inner end until it reaches the rim (eq. 5 and 6).
///
/// # Errors
/// If the pairs do not reach the rim.
pub fn explicit_pairs(table: &FeedTable, range: RadialRange) -> Result<Vec<f64>> {
    let mut rho = vec![range.inner];
    let mut last = range.inner;
    while last < range.outer {
        let next = last + table.value(last.abs());
        if next.is_nan() || next <= last || rho.len() == MOST_PAIRS {
            return Err(StrategyError::failed(format!(
                "the feed does not lead beyond ρ = {last} mm, after {} revolutions",
                rho.len() - 1
            )));
        }
        rho.push(next);
        last = next;
    }
    Ok(rho)
}

/// ρ = ℓ(N) as one cubic (eq. 19).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CubicFit {
    /// Coefficients in N, lowest first.
    pub coefficients: [f64; 4],
    /// Sum of the squared residuals, mm².
    pub squared_error: f64,
}

impl CubicFit {
    /// The least-squares cubic through all pairs (i, `rho[i]`).
    ///
    /// # Errors
    /// If there are fewer than five pairs.
    pub fn through(rho: &[f64]) -> Result<Self> {
        let turns = rho.len().saturating_sub(1);
        if turns < 4 {
            return Err(FIT.refused(format!(
                "the part takes {turns} revolutions, too few for a cubic; use \"smooth\""
            )));
        }
        let scale = turns as f64;
        let design = DMatrix::from_fn(rho.len(), 4, |i, power| {
            (0..power).fold(1.0, |product, _| product * (i as f64 / scale))
        });
        let right_side = DVector::from_column_slice(rho);
        let solved = least_squares(design.clone(), right_side.clone()).ok_or_else(|| {
            StrategyError::failed("no cubic can be found: the pairs are not numbers")
        })?;
        let squared_error = (design * &solved - right_side).norm_squared();
        let mut coefficients = [0.0; 4];
        let mut power = 1.0;
        for (coefficient, solved) in coefficients.iter_mut().zip(solved.iter()) {
            *coefficient = solved / power;
            power *= scale;
        }
        Ok(Self {
            coefficients,
            squared_error,
        })
    }

    /// ρ after `n` revolutions, mm.
    pub fn value(&self, n: f64) -> f64 {
        let c = &self.coefficients;
        ((c[3] * n + c[2]) * n + c[1]) * n + c[0]
    }

    fn rate(&self, n: f64) -> f64 {
        let c = &self.coefficients;
        (3.0 * c[3] * n + 2.0 * c[2]) * n + c[1]
    }

    /// The N near `n` at which the cubic reaches `rho`.
    ///
    /// # Errors
    /// If the cubic stops growing before it reaches `rho`.
    pub fn reaches(&self, rho: f64, n: f64) -> Result<f64> {
        let mut n = n;
        for _ in 0..ROUNDS {
            let rate = self.rate(n);
            let step = (self.value(n) - rho) / rate;
            if !(rate > 0.0 && step.is_finite()) {
                break;
            }
            n -= step;
            if step.abs() <= f64::EPSILON * (1.0 + n.abs()) {
                return Ok(n);
            }
        }
        Err(not_monotone(rho))
    }

    /// The law over `range` as one piece.
    ///
    /// # Errors
    /// If the cubic does not grow everywhere in `range`.
    pub fn piece(&self, range: RadialRange, turns: f64, direction: Direction) -> Result<FeedPiece> {
        let from = self.reaches(range.inner, 0.0)?;
        let to = self.reaches(range.outer, turns)?;
        let c = &self.coefficients;
        let bend = if c[3] == 0.0 {
            from
        } else {
            -c[2] / (3.0 * c[3])
        };
        let turning = [from, to, bend.clamp(from.min(to), to.max(from))];
        if from >= to || turning.iter().any(|n| self.rate(*n) <= 0.0) {
            return Err(not_monotone(self.value(bend)));
        }
        let (start, rho, sign) = match direction {
            Direction::Outward => (from, range.inner, 1.0),
            Direction::Inward => (to, range.outer, -1.0),
        };
        let second = c[2] + 3.0 * c[3] * start;
        Ok(FeedPiece {
            length: to - from,
            coefficients: [rho, sign * self.rate(start), second, sign * c[3], 0.0, 0.0],
        })
    }
}

/// Least squares by Householder's QR. nalgebra computes its sums in the same order on every
/// machine.
fn least_squares(design: DMatrix<f64>, mut right_side: DVector<f64>) -> Option<DVector<f64>> {
    let columns = design.ncols();
    let qr = design.qr();
    qr.q_tr_mul(&mut right_side);
    let solved = qr
        .r()
        .solve_upper_triangular(&right_side.rows(0, columns).into_owned())?;
    solved.iter().all(|c| c.is_finite()).then_some(solved)
}

fn not_monotone(rho: f64) -> StrategyError {
    FIT.refused(format!(
        "the cubic does not grow all along the part (near ρ = {rho:.3} mm): the feed varies \
             too much for one cubic; use \"smooth\""
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_on_a_cubic_give_that_cubic() {
        let law = |n: f64| 0.001 + 0.02 * n + 3e-5 * n * n - 1e-7 * n * n * n;
        let rho: Vec<f64> = (0..100).map(|i| law(f64::from(i))).collect();
        let fit = CubicFit::through(&rho).unwrap();
        for (found, exact) in fit.coefficients.iter().zip([0.001, 0.02, 3e-5, -1e-7]) {
            assert!((found / exact - 1.0).abs() < 1e-10, "{found} for {exact}");
        }
        assert!(fit.squared_error < 1e-28);
    }

    #[test]
    fn a_cubic_that_turns_back_is_an_error() {
        let fit = CubicFit {
            coefficients: [0.0, 0.02, -4e-4, 4e-6],
            squared_error: 0.0,
        };
        let range = RadialRange {
            inner: 0.0,
            outer: 2.5,
        };
        assert!(fit.piece(range, 98.0, Direction::Outward).is_ok());
        let fit = CubicFit {
            coefficients: [0.0, 0.02, -8e-4, 8e-6],
            squared_error: 0.0,
        };
        let error = fit.piece(range, 98.0, Direction::Outward).unwrap_err();
        assert!(error.to_string().contains("does not grow"), "{error}");
    }

    #[test]
    fn too_few_pairs_are_an_error() {
        assert!(CubicFit::through(&[0.0, 1.0, 2.0]).is_err());
        assert!(CubicFit::through(&[]).is_err());
    }
}
