//! The smallest value of a quantity over all angles at one radius: rings of angles, then a refined
//! search.

use std::f64::consts::TAU;

use crate::{Result, Scalar, StrategyError};

/// Number of angles of a ring.
const ANGLES: usize = 180;
/// Offset of each ring's angles, in steps of a ring. The rings halve each other's gaps.
const RINGS: [f64; 8] = [0.0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875];
/// The search ends with a ring that lowers the smallest value by less than this part of it.
const SETTLED: f64 = 1e-6;
/// How many of a ring's lowest points the search refines.
const CANDIDATES: usize = 3;
/// Rounds of refinement, from 2° to about 0.03°, before a parabola gives the rest.
const ROUNDS: usize = 8;

/// A quantity at each (θ, ρ) of a batch.
pub type Measure<'a> = dyn Fn(&[f64], &[f64], &mut [f64]) -> Result<()> + 'a;

/// The smallest value of `measure` over all angles at `rho`.
///
/// # Errors
/// If `measure` gives NaN somewhere on the ring.
pub fn least_over_angles(measure: &Measure<'_>, rho: f64) -> Result<f64> {
    let mut search = Search::new(measure, rho);
    let mut least = f64::INFINITY;
    for (ring, offset) in RINGS.iter().enumerate() {
        let found = search.ring(*offset)?;
        let gain = least - found;
        least = least.min(found);
        if ring > 0 && gain <= SETTLED * least.abs() {
            break;
        }
    }
    Ok(least)
}

/// A point on the ring that the search refines.
#[derive(Clone, Copy)]
struct Candidate {
    theta: f64,
    value: f64,
    scale: f64,
}

struct Search<'a> {
    measure: &'a Measure<'a>,
    radius: f64,
    theta: Vec<f64>,
    rho: Vec<f64>,
    value: Vec<f64>,
}

impl<'a> Search<'a> {
    fn new(measure: &'a Measure<'a>, radius: f64) -> Self {
        Self {
            measure,
            radius,
            theta: Vec::with_capacity(ANGLES),
            rho: vec![radius; ANGLES],
            value: vec![f64::NAN; ANGLES],
        }
    }

    /// Measures at the present angles. The values are in the order of the angles.
    fn evaluate(&mut self) -> Result<()> {
        let count = self.theta.len();
        self.rho.resize(count, self.radius);
        self.value.clear();
        self.value.resize(count, f64::NAN);
        (self.measure)(&self.theta, &self.rho, &mut self.value)?;
        match self.value.iter().position(|value| value.is_nan()) {
            None => Ok(()),
            Some(at) => Err(no_value(self.theta[at], self.radius)),
        }
    }

    /// The smallest value that a search from one ring of angles finds.
    fn ring(&mut self, offset: f64) -> Result<f64> {
        let step = TAU / ANGLES as f64;
        self.theta.clear();
        self.theta
            .extend((0..ANGLES).map(|j| (j as f64 + offset) * step));
        self.evaluate()?;
        let mut candidates = self.lowest(0.5 * step);
        for _ in 0..ROUNDS {
            self.refine(&mut candidates)?;
        }
        self.evaluate_around(&candidates)?;
        let around = candidates.iter().zip(self.value.chunks(2));
        Ok(around
            .map(|(candidate, sides)| vertex(candidate.value, sides))
            .fold(f64::INFINITY, f64::min))
    }

    fn lowest(&self, scale: f64) -> Vec<Candidate> {
        let value = |j: usize| self.value[j % ANGLES];
        let mut found: Vec<Candidate> = (0..ANGLES)
            .filter(|j| value(*j) <= value(j + 1) && value(*j) <= value(j + ANGLES - 1))
            .map(|j| Candidate {
                theta: self.theta[j],
                value: value(j),
                scale,
            })
            .collect();
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        found.truncate(CANDIDATES);
        found
    }

    /// Measures one step to either side of each candidate.
    fn evaluate_around(&mut self, candidates: &[Candidate]) -> Result<()> {
        self.theta.clear();
        self.theta.extend(
            candidates
                .iter()
                .flat_map(|c| [c.theta - c.scale, c.theta + c.scale]),
        );
        self.evaluate()
    }

    /// Moves each candidate to a lower neighbour. If there is none, halves the candidate's step.
    fn refine(&mut self, candidates: &mut [Candidate]) -> Result<()> {
        self.evaluate_around(candidates)?;
        let neighbours = self.theta.chunks(2).zip(self.value.chunks(2));
        for (candidate, (theta, value)) in candidates.iter_mut().zip(neighbours) {
            let lower = if value[0] <= value[1] { 0 } else { 1 };
            if value[lower] < candidate.value {
                (candidate.theta, candidate.value) = (theta[lower], value[lower]);
            } else {
                candidate.scale *= 0.5;
            }
        }
        Ok(())
    }
}

/// The lowest value of the parabola through a value and those to either side, if it lies between
/// them.
fn vertex(value: f64, sides: &[f64]) -> f64 {
    let [before, after] = sides else {
        return value;
    };
    let (bend, tilt) = (before - 2.0 * value + after, after - before);
    if *before >= value && *after >= value && bend > 0.0 {
        value - tilt * tilt / (8.0 * bend)
    } else {
        value.min(*before).min(*after)
    }
}

fn no_value(theta: f64, rho: f64) -> StrategyError {
    let (sin, cos) = Scalar::sin_cos(theta);
    StrategyError::failed(format!(
        "no feed can be found at x = {:.4} mm, y = {:.4} mm: the surface or the tool centre has \
         no value there; choose a smaller aperture",
        rho * cos,
        rho * sin
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least(value: impl Fn(f64) -> f64) -> Result<f64> {
        let measure = |theta: &[f64], _: &[f64], out: &mut [f64]| {
            for (out, theta) in out.iter_mut().zip(theta) {
                *out = value(*theta);
            }
            Ok(())
        };
        least_over_angles(&measure, 1.0)
    }

    #[test]
    fn the_search_finds_a_minimum_between_the_angles_of_a_ring() {
        for waves in [1.0, 2.0, 7.0, 36.0, 90.0, 180.0, 251.0] {
            let found = least(|theta| 3.0 + Scalar::cos(waves * theta + 0.123)).unwrap();
            assert!((found - 2.0).abs() < 1e-6, "{waves} waves: {found}");
        }
    }

    #[test]
    fn a_value_that_is_not_a_number_is_an_error_that_names_the_position() {
        let error = least(|theta| if theta > 6.2 { f64::NAN } else { 1.0 }).unwrap_err();
        assert!(error.to_string().contains("x = 0.99"), "{error}");
    }
}
