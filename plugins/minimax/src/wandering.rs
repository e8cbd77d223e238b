//! Where steps that are as long as the largest one wander.
//!
//! A span has one step more for it. Where the largest step errs by little, so do the spokes that it
//! leaves; and where the tolerance asks for much shorter steps, wandering changes little. Such spans
//! keep to the largest step as it is.

use turnpath_plugin::hermite::largest_step;
use turnpath_plugin::prelude::*;

use crate::grid::on_locus_step;

/// A span keeps to the largest step if that errs by no more than this part of what it errs by elsewhere,
/// or of the tolerance. So the spoke that stays is less than a fifth of the one that wandering takes
/// away.
const CALM: f64 = 0.15;
/// A span keeps to the largest step if that could err by so many tolerances: where φ⁗ is largest, steps
/// are no longer than 0.6 of it.
const TIGHT: f64 = 8.0;
/// Turns of the path that are looked at, and places within a turn. A place too few makes steps wander
/// that need not.
const TURNS: usize = 64;
const PLACES: usize = 15;

/// The largest step of each span, in revolutions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wandering {
    /// Of calm spans.
    still: f64,
    /// Of all others.
    shorter: f64,
    /// The largest |φ⁗| of calm spans, mm/rad⁴.
    calm: f64,
    /// The largest |φ⁗| of spans that wander, mm/rad⁴.
    tight: f64,
}

impl Wandering {
    /// The steps of a whole path, of which none is longer than `max_step` rad or errs by more than
    /// `allowed` mm.
    ///
    /// # Errors
    /// If the locus has no value on the path.
    pub fn new(path: &Path<'_>, max_step: f64, wander: bool, allowed: f64) -> Result<Self> {
        let decides = fourth_at(allowed, max_step);
        let calm = match wander {
            true => CALM * highest(path)?.min(decides),
            false => 0.0,
        };
        Ok(Self {
            still: max_step / TAU,
            shorter: largest_step(max_step, wander) / TAU,
            calm,
            tight: TIGHT * decides,
        })
    }

    /// The largest step of a span whose steps wander.
    pub fn shorter(&self) -> f64 {
        self.shorter
    }

    /// The largest step of a span with this largest |φ⁗|, mm/rad⁴.
    pub fn step(&self, fourth: f64) -> f64 {
        match fourth > self.calm && fourth <= self.tight {
            true => self.shorter,
            false => self.still,
        }
    }
}

/// The |φ⁗| with which a step of this length errs by `allowed`.
fn fourth_at(allowed: f64, step: f64) -> f64 {
    let ratio = on_locus_step(allowed, 1.0) / step;
    let squared = ratio * ratio;
    squared * squared
}

/// The largest |Z⁗| at some places of the path.
fn highest(path: &Path<'_>) -> Result<f64> {
    let count = TURNS * PLACES;
    let place = |k: usize| path.law.end() * (k as f64 + 0.5) / count as f64;
    let turn = |k: usize| place(k - k % PLACES).floor();
    let within = |k: usize| (k % PLACES) as f64 / PLACES as f64;
    let n = (0..count).map(|k| (turn(k) + within(k)).min(path.law.end()));
    let n: Vec<f64> = n.collect();
    let blank = vec![[f64::NAN; 5]; n.len()];
    let (mut x, mut z) = (blank.clone(), blank);
    path.series_at(&n, &mut x, &mut z)?;
    Ok(z.iter().map(|z| 24.0 * z[4].abs()).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_errs_by_the_tolerance_with_the_fourth_derivative_that_allows_it() {
        let fourth = fourth_at(1e-4, 0.5);
        assert!((on_locus_step(1e-4, fourth) - 0.5).abs() < 1e-12);
    }
}
