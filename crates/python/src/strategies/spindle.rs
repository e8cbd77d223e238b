//! Spindle strategies of Python.

use pyo3::prelude::*;
use turnpath_core::{Path, PiecewisePolynomial, Result, SpindleAsk, SpindleLaw, SpindleStrategy};

use super::Callable;
use crate::arrays::{array, rows};
use crate::failure::asked;
use crate::loan::lend_locus;
use crate::views::path::PathView;

/// A piece of a schedule: its length, then its six coefficients.
const PIECE: usize = 7;

/// A spindle strategy that Python asks for the time t(N).
pub struct PySpindle {
    /// Takes a path, the largest speed and the factors.
    pub call: Callable,
    /// Whether it uses the factors.
    pub follows_factors: bool,
}

impl SpindleStrategy for PySpindle {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        let pieces: Vec<[f64; PIECE]> = lend_locus(path.locus, |locus| {
            asked(|py| {
                let factors = array(py, ask.factors.to_vec());
                let call = self.call.bind(py);
                let given = call.call1((PathView::new(path, locus), ask.speed, factors))?;
                rows(&given, "the schedule")
            })
        })?;
        let mut time = PiecewisePolynomial::new();
        for [length, coefficients @ ..] in pieces {
            time.push(length, coefficients);
        }
        Ok(SpindleLaw::from_time(time))
    }

    fn follows_factors(&self) -> bool {
        self.follows_factors
    }
}
